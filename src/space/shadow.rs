//! Shadow: where a sphere can be that touches one of a few, seen at one look.

use core::ops::RangeInclusive;

use crate::numbers::array::Each;
use crate::space::PeriodicBox;

/// Bits for each cell that is in it: one in as many others is taken for one of them.
const SPARE: usize = 16;

/// The cells that are nearer than a reach to one of some points, hashed into bits. A place
/// out of reach may be taken for one within it, never the other way round.
#[derive(Debug)]
pub(crate) struct Shadow {
    /// Of a cell, length.
    side: f64,
    words: Vec<u64>,
}

impl Shadow {
    /// Of points in open space, or in a box and through its sides.
    pub fn of(
        points: impl ExactSizeIterator<Item = [f64; 3]>,
        reach: f64,
        periodic: Option<PeriodicBox<f64>>,
    ) -> Self {
        let words = (points.len() * 27 * SPARE).next_power_of_two().max(64) / 64;
        // A little wider, so that rounding takes no cell out of reach.
        let mut shadow = Self { side: reach * 1.01, words: vec![0; words] };
        for point in points {
            match &periodic {
                None => shadow.add(point),
                Some(space) => shadow.add_images(point, reach, space),
            }
        }
        shadow
    }

    /// Adds the images of a point that reach into the box.
    fn add_images(&mut self, point: [f64; 3], reach: f64, space: &PeriodicBox<f64>) {
        let (lower, upper) = (space.lower.to_array(), space.upper.to_array());
        let images = |axis: usize| {
            let side = upper[axis] - lower[axis];
            let inside = lower[axis] - reach..=upper[axis] + reach;
            [0.0, side, -side]
                .map(|shift| point[axis] + shift)
                .into_iter()
                .filter(move |place| inside.contains(place))
        };
        for x in images(0) {
            for y in images(1) {
                images(2).for_each(|z| self.add([x, y, z]));
            }
        }
    }

    fn add(&mut self, point: [f64; 3]) {
        let around =
            |cell: i64| -> RangeInclusive<i64> { cell.saturating_sub(1)..=cell.saturating_add(1) };
        let [x, y, z] = self.cell(point).each(around);
        for z in z {
            for y in y.clone() {
                for x in x.clone() {
                    let (word, bit) = self.place([x, y, z]);
                    self.words[word] |= bit;
                }
            }
        }
    }

    /// Whether a point may be nearer to one of the points than the reach.
    #[inline]
    pub fn covers(&self, point: [f64; 3]) -> bool {
        let (word, bit) = self.place(self.cell(point));
        self.words[word] & bit != 0
    }

    #[inline]
    fn cell(&self, point: [f64; 3]) -> [i64; 3] {
        point.each(|coordinate| (coordinate / self.side).floor() as i64)
    }

    /// The word of a cell and its bit, by Fibonacci hashing (Knuth, volume 3, 6.4).
    #[inline]
    fn place(&self, [x, y, z]: [i64; 3]) -> (usize, u64) {
        const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;
        let mix = |hash: u64, cell: i64| (hash ^ cell as u64).wrapping_mul(GOLDEN).rotate_left(29);
        let hash = mix(mix(mix(0, x), y), z).wrapping_mul(GOLDEN);
        ((hash >> 32) as usize & (self.words.len() - 1), 1 << (hash & 63))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::noise::noise;

    #[test]
    fn what_is_within_reach_is_covered() {
        let mut noise = noise();
        for reach in [1e-6, 0.1, 3.0, 1e9] {
            let mut place = |most: f64| [(); 3].map(|()| most * noise());
            let points: Vec<[f64; 3]> = (0..40).map(|_| place(20.0 * reach)).collect();
            let space = PeriodicBox::new([0.0; 3], [20.0 * reach; 3]);
            for periodic in [None, Some(space)] {
                let shadow = Shadow::of(points.iter().copied(), reach, periodic);
                let mut covered = 0;
                for _ in 0..4000 {
                    let other = place(20.0 * reach);
                    let is_near = points.iter().any(|point| {
                        let square = |axis: usize| {
                            let offset = (point[axis] - other[axis]).abs();
                            let through = (20.0 * reach - offset).abs();
                            let nearest =
                                if periodic.is_some() { offset.min(through) } else { offset };
                            nearest * nearest
                        };
                        square(0) + square(1) + square(2) < reach * reach
                    });
                    let is_covered = shadow.covers(other);
                    assert!(is_covered || !is_near, "{reach}: {other:?}");
                    covered += usize::from(is_covered);
                }
                assert!((100..2000).contains(&covered), "{covered} of 4000");
            }
        }
    }
}
