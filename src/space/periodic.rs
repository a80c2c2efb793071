//! Periodic box: space that closes upon itself.

use crate::lane::Lane;
use crate::motion::flight::Wrap;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// How differences of positions are measured: in open space, or to the nearest
/// image in a [`PeriodicBox`].
pub trait Space<T: Real>: Wrap<T> {
    /// The shortest difference between two points' images.
    fn nearest<L: Lane<Scalar = T>>(self, difference: Vec3<L>) -> Vec3<L>;

    /// How many whole boxes a difference spans, to the nearest; fewer than half
    /// of [`Real::WHOLE_FROM`].
    fn turns<L: Lane<Scalar = T>>(self, difference: Vec3<L>) -> Vec3<L>;

    /// The difference that a number of whole boxes makes.
    fn shift<L: Lane<Scalar = T>>(self, turns: Vec3<L>) -> Vec3<L>;

    /// From a point to itself and to its images in the boxes around.
    fn images(self) -> Vec<Vec3<T>>;
}

/// Space without bounds: every point is itself, at no cost.
#[derive(Clone, Copy, Debug)]
pub struct OpenSpace;

impl<T: Real> Wrap<T> for OpenSpace {
    #[inline(always)]
    fn wrap<L: Lane<Scalar = T>>(self, point: Vec3<L>) -> Vec3<L> {
        point
    }
}

impl<T: Real> Space<T> for OpenSpace {
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(self, difference: Vec3<L>) -> Vec3<L> {
        difference
    }

    #[inline(always)]
    fn turns<L: Lane<Scalar = T>>(self, _: Vec3<L>) -> Vec3<L> {
        Vec3::ZERO
    }

    #[inline(always)]
    fn shift<L: Lane<Scalar = T>>(self, _: Vec3<L>) -> Vec3<L> {
        Vec3::ZERO
    }

    fn images(self) -> Vec<Vec3<T>> {
        vec![Vec3::ZERO]
    }
}

/// A box whose opposite faces are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicBox<T> {
    /// The corner with the least coordinates, length.
    pub lower: Vec3<T>,
    /// The corner with the greatest coordinates, length.
    pub upper: Vec3<T>,
}

impl<T: Real> PeriodicBox<T> {
    /// The box between two corners.
    #[must_use]
    pub fn new(lower: [T; 3], upper: [T; 3]) -> Self {
        Self { lower: lower.into(), upper: upper.into() }
    }

    /// The same box in another precision.
    ///
    /// ```
    /// use carom::PeriodicBox;
    /// let box_in_f32 = PeriodicBox::new([0.0_f64; 3], [0.1; 3]).cast::<f32>();
    /// assert_eq!(box_in_f32.upper.x, 0.1_f32);
    /// ```
    #[must_use]
    pub fn cast<B: Real>(self) -> PeriodicBox<B> {
        PeriodicBox { lower: self.lower.cast(), upper: self.upper.cast() }
    }

    /// Whether points are inside, farther than a margin from all faces.
    #[inline(always)]
    pub(crate) fn is_inner<L: Lane<Scalar = T>>(&self, point: Vec3<L>, margin: L) -> L::Mask {
        let lower = point - Vec3::splat(self.lower);
        let upper = Vec3::splat(self.upper) - point;
        let nearest = lower.lesser(upper);
        nearest.x.lesser(nearest.y).lesser(nearest.z).gt(margin)
    }

    /// The lengths of its sides.
    #[must_use]
    pub fn sides(&self) -> Vec3<T> {
        self.upper - self.lower
    }
}

impl<T: Real> Wrap<T> for PeriodicBox<T> {
    /// The image inside the box, however far outside the point is.
    #[inline(always)]
    fn wrap<L: Lane<Scalar = T>>(self, point: Vec3<L>) -> Vec3<L> {
        let wrap = |c: L, low: T, high: T| {
            let side = high - low;
            let middle = L::splat((low + high) * T::ratio(1, 2));
            c - ((c - middle) * L::splat(T::ONE / side)).nearest_whole() * L::splat(side)
        };
        Vec3::new(
            wrap(point.x, self.lower.x, self.upper.x),
            wrap(point.y, self.lower.y, self.upper.y),
            wrap(point.z, self.lower.z, self.upper.z),
        )
    }
}

impl<T: Real> Space<T> for PeriodicBox<T> {
    /// The shortest image of a difference of two points inside the box.
    #[inline(always)]
    fn nearest<L: Lane<Scalar = T>>(self, difference: Vec3<L>) -> Vec3<L> {
        let nearest = |d: L, side: T| {
            let half = L::splat(side * T::ratio(1, 2));
            let side = L::splat(side);
            L::select(d.gt(half), d - side, L::select(d.lt(-half), d + side, d))
        };
        let sides = self.sides();
        Vec3::new(
            nearest(difference.x, sides.x),
            nearest(difference.y, sides.y),
            nearest(difference.z, sides.z),
        )
    }

    #[inline(always)]
    fn turns<L: Lane<Scalar = T>>(self, difference: Vec3<L>) -> Vec3<L> {
        let turns = |d: L, side: T| (d * L::splat(T::ONE / side)).nearest_small_whole();
        let sides = self.sides();
        Vec3::new(
            turns(difference.x, sides.x),
            turns(difference.y, sides.y),
            turns(difference.z, sides.z),
        )
    }

    #[inline(always)]
    fn shift<L: Lane<Scalar = T>>(self, turns: Vec3<L>) -> Vec3<L> {
        let sides = Vec3::splat(self.sides());
        Vec3::new(turns.x * sides.x, turns.y * sides.y, turns.z * sides.z)
    }

    fn images(self) -> Vec<Vec3<T>> {
        let steps = |side: T| [T::ZERO, side, -side];
        let sides = self.sides();
        let mut images = Vec::new();
        for x in steps(sides.x) {
            for y in steps(sides.y) {
                images.extend(steps(sides.z).each(|z| Vec3::new(x, y, z)));
            }
        }
        images
    }
}
