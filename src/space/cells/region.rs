//! Region: the space that a grid covers.

use core::cmp::Ordering;

use super::Ends;
use crate::bodies::Columns3;
use crate::real::Real;
use crate::vec3::Vec3;

/// From this number of bodies on, a few of them far away are left out of account.
const CROWD: usize = 64;

/// What part of the bodies that is, on either side.
const STRAY: usize = 16;

/// How much wider a region must be than its crowd to be cut down to that.
const MUCH_WIDER: i32 = 4;

/// The region that the grid covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region<T> {
    pub lower: Vec3<T>,
    pub upper: Vec3<T>,
    pub ends: Ends,
    /// The greatest coordinate of what may be in the cells, length.
    farthest: T,
}

impl<T: Real> Region<T> {
    /// The region between two corners.
    pub fn new(lower: Vec3<T>, upper: Vec3<T>, ends: Ends) -> Self {
        let corners = [lower, upper].map(Vec3::to_array);
        let farthest = corners.iter().flatten().fold(T::ZERO, |most, c| most.greater(c.abs()));
        Self { lower, upper, ends, farthest }
    }

    /// Of open space, the part in which all but a few bodies are: cells are chosen for
    /// these, and those far away fold into them. A side has at least `least`.
    pub fn crowd(&self, least: T, position: &Columns3<T>) -> Self {
        if position[0].len() < CROWD {
            return *self;
        }
        let mut sides = [self.lower, self.upper].map(Vec3::to_array);
        for (axis, column) in position.iter().enumerate() {
            let mut column = column.to_vec();
            let at = column.len() / STRAY;
            let order = |a: &T, b: &T| a.partial_cmp(b).unwrap_or(Ordering::Equal);
            let low = *column.select_nth_unstable_by(at, order).1;
            let at = column.len() - 1 - at;
            let high = *column.select_nth_unstable_by(at, order).1;
            let wide = (high - low) * T::ratio(5, 4);
            let half = wide.greater(least) * T::ratio(1, 2);
            let middle = low + (high - low) * T::ratio(1, 2);
            if half * T::whole(2 * MUCH_WIDER) < sides[1][axis] - sides[0][axis] {
                (sides[0][axis], sides[1][axis]) = (middle - half, middle + half);
            }
        }
        let [lower, upper] = sides;
        Self { lower: lower.into(), upper: upper.into(), ..*self }
    }

    /// The greatest coordinate of what may be in the cells, length.
    pub fn farthest(&self) -> T {
        self.farthest
    }

    /// The mean distance of `len` bodies, or the greatest at which two touch if
    /// that is more.
    pub fn spacing(&self, reach: T, len: usize) -> T {
        let mean = self.mean_distance(reach, len);
        T::from_f64(if mean > 0.0 { mean } else { 1.0 }).greater(reach)
    }

    /// The mean distance of `len` bodies, each side counted with `least` at least.
    pub fn mean_distance(&self, least: T, len: usize) -> f64 {
        let extent = (self.upper - self.lower).to_array();
        let volume: f64 = extent.iter().map(|side| side.greater(least).to_f64()).product();
        (volume / len.max(1) as f64).cbrt()
    }
}
