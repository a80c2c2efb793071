//! Neighbours: which spheres are near a point, found in a time that does not
//! grow with their number.
//!
//! Spheres are sorted into levels by size, the greatest first, each half as
//! large as the one before. A level is a grid of cells twice as wide as its
//! greatest spheres, hashed into one table: a sphere reaches into at most two
//! cells a side of every level with spheres as large as itself. So a crowd of
//! small spheres among large ones costs no more than equal ones do, as long as
//! the large ones come first.

use core::ops::RangeInclusive;

use crate::numbers::array::{self, Each};
use crate::space::PeriodicBox;

const NONE: u32 = u32::MAX;

/// The finest level; all spheres smaller than `2⁻³¹` of the greatest share it.
const FINEST: u32 = 31;

/// A sphere of the table. The centre is here and not looked up, to spend one
/// access to memory on it.
#[derive(Clone, Copy, Debug)]
struct Resident {
    center: [f64; 3],
    radius: f64,
    id: u32,
    next: u32,
}

/// Two spheres with the same centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlapping {
    /// Who is there already.
    pub(crate) id: u32,
    /// By how much they overlap, length.
    pub(crate) depth: f64,
}

/// A table of spheres by where they are.
#[derive(Debug)]
pub(crate) struct Neighbours {
    periodic: Option<PeriodicBox<f64>>,
    /// Relative error of a coordinate, for the tolerance.
    epsilon: f64,
    greatest_radius: f64,
    /// How many residents each level has.
    population: [usize; FINEST as usize + 1],
    /// First resident of each bucket.
    heads: Vec<u32>,
    residents: Vec<Resident>,
}

impl Neighbours {
    /// An empty table for `capacity` spheres. Overlaps that rounding explains,
    /// of coordinates with relative error `epsilon`, are none.
    pub(crate) fn new(
        capacity: usize,
        greatest_radius: f64,
        epsilon: f64,
        periodic: Option<PeriodicBox<f64>>,
    ) -> Self {
        Self {
            periodic,
            epsilon,
            greatest_radius,
            population: [0; FINEST as usize + 1],
            heads: vec![NONE; (2 * capacity).next_power_of_two()],
            residents: Vec::with_capacity(capacity),
        }
    }

    /// The level that a sphere of this radius belongs to.
    pub(crate) fn level(&self, radius: f64) -> u32 {
        let mut level = 0;
        let mut half = self.greatest_radius / 2.0;
        while radius <= half && level < FINEST {
            level += 1;
            half /= 2.0;
        }
        level
    }

    /// A key by which points near each other sort together, for the sake of the cache.
    pub(crate) fn order(&self, level: u32, center: [f64; 3]) -> u64 {
        const MASK: u64 = (1 << 21) - 1;
        let [x, y, z] = center.each(|c| self.cell(level, c) as u64 & MASK);
        z << 42 | y << 21 | x
    }

    /// Adds a sphere.
    pub(crate) fn insert(&mut self, id: u32, center: [f64; 3], radius: f64) {
        let level = self.level(radius);
        let cells = center.each(|c| self.cell(level, c));
        let bucket = self.bucket(level, cells);
        let slot = self.residents.len() as u32;
        self.residents.push(Resident { center, radius, id, next: self.heads[bucket] });
        self.heads[bucket] = slot;
        self.population[level as usize] += 1;
    }

    /// A sphere of the table that overlaps this one.
    pub(crate) fn overlapping(&self, center: [f64; 3], radius: f64) -> Option<Overlapping> {
        let Some(periodic) = self.periodic else {
            return self.overlapping_here(center, radius);
        };
        // The images that reach into the box: most spheres have but one.
        let reach = radius + self.greatest_radius;
        let lower = periodic.lower.to_array();
        let upper = periodic.upper.to_array();
        let shifts: [[Option<f64>; 3]; 3] = array::from_fn(|axis| {
            let side = upper[axis] - lower[axis];
            let is_low = center[axis] - reach < lower[axis];
            let is_high = center[axis] + reach > upper[axis];
            [Some(0.0), is_low.then_some(side), is_high.then_some(-side)]
        });
        for x in shifts[0].iter().flatten() {
            for y in shifts[1].iter().flatten() {
                for z in shifts[2].iter().flatten() {
                    let image = [center[0] + x, center[1] + y, center[2] + z];
                    if let Some(found) = self.overlapping_here(image, radius) {
                        return Some(found);
                    }
                }
            }
        }
        None
    }

    fn overlapping_here(&self, center: [f64; 3], radius: f64) -> Option<Overlapping> {
        let mut greatest = self.greatest_radius;
        for level in 0..=FINEST {
            if self.population[level as usize] > 0 {
                let reach = radius + greatest;
                let ranges = center.each(|c| self.cells(level, c, reach));
                let found = self.overlapping_in(level, &ranges, center, radius);
                if found.is_some() {
                    return found;
                }
            }
            greatest /= 2.0;
        }
        None
    }

    /// Looks through the cells of one level; through all residents, if they
    /// are fewer than the cells.
    fn overlapping_in(
        &self,
        level: u32,
        ranges: &[RangeInclusive<i64>; 3],
        center: [f64; 3],
        radius: f64,
    ) -> Option<Overlapping> {
        let cells: f64 =
            ranges.iter().map(|range| *range.end() as f64 - *range.start() as f64 + 1.0).product();
        if cells > self.residents.len() as f64 {
            return self.residents.iter().find_map(|other| self.overlap(other, center, radius));
        }
        // All lists are looked up before the first is gone through: the cache
        // then fetches them side by side.
        let mut lists = [NONE; 27];
        let mut count = 0;
        for z in ranges[2].clone() {
            for y in ranges[1].clone() {
                for x in ranges[0].clone() {
                    let head = self.heads[self.bucket(level, [x, y, z])];
                    lists[count] = head;
                    count += usize::from(head != NONE);
                    if count == lists.len() {
                        if let Some(found) = self.overlap_in_lists(&lists, center, radius) {
                            return Some(found);
                        }
                        count = 0;
                    }
                }
            }
        }
        self.overlap_in_lists(&lists[..count], center, radius)
    }

    fn overlap_in_lists(
        &self,
        lists: &[u32],
        center: [f64; 3],
        radius: f64,
    ) -> Option<Overlapping> {
        for &head in lists {
            let mut slot = head;
            while slot != NONE {
                let other = &self.residents[slot as usize];
                let found = self.overlap(other, center, radius);
                if found.is_some() {
                    return found;
                }
                slot = other.next;
            }
        }
        None
    }

    fn overlap(&self, other: &Resident, center: [f64; 3], radius: f64) -> Option<Overlapping> {
        let reach = other.radius + radius;
        let [x, y, z] = array::from_fn(|axis| other.center[axis] - center[axis]);
        let square = x * x + y * y + z * z;
        if square >= reach * reach {
            return None;
        }
        let depth = reach - square.sqrt();
        let is_real =
            depth > tolerance(self.epsilon, largest(center).max(largest(other.center)), reach);
        is_real.then_some(Overlapping { id: other.id, depth })
    }

    /// The cells of a level that a sphere can reach into along one axis.
    fn cells(&self, level: u32, center: f64, reach: f64) -> RangeInclusive<i64> {
        let own = self.cell(level, center);
        if own.unsigned_abs() >= FAR {
            return own..=own;
        }
        self.cell(level, center - reach)..=self.cell(level, center + reach)
    }

    /// The cell of a level that a coordinate is in. Where a number is no
    /// longer finer than a cell, the number itself stands for it.
    fn cell(&self, level: u32, coordinate: f64) -> i64 {
        let width = 4.0 * self.greatest_radius / f64::from(1_u32 << level);
        let cell = (coordinate / width).floor();
        if cell.abs() < FAR as f64 { cell as i64 } else { (cell.to_bits() >> 1 | FAR) as i64 }
    }

    /// Cells beside each other along `x` have buckets beside each other, for
    /// the sake of the cache.
    fn bucket(&self, level: u32, [x, y, z]: [i64; 3]) -> usize {
        let hash = x
            .wrapping_add(y.wrapping_mul(0x1f3d_5b79_a1c3))
            .wrapping_add(z.wrapping_mul(0x2c1b_3c6d_9e37_79b9))
            .wrapping_add(i64::from(level).wrapping_mul(0x5851_f42d_4c95));
        hash as usize & (self.heads.len() - 1)
    }
}

/// From this cell on, cells are no longer counted.
const FAR: u64 = 1 << 52;

/// The overlap that rounding of coordinates up to `coordinate` can make of a
/// touch at distance `reach`: some units in the last digit, and never more than
/// a hundredth of `reach`, or spheres too far away for their precision would
/// lie in each other unseen.
pub(crate) fn tolerance(epsilon: f64, coordinate: f64, reach: f64) -> f64 {
    (8.0 * epsilon * (coordinate + reach)).min(0.01 * reach)
}

/// The largest coordinate.
pub(crate) fn largest(point: [f64; 3]) -> f64 {
    point.iter().fold(0.0, |most: f64, c| most.max(c.abs()))
}

#[cfg(test)]
mod tests {
    use super::Neighbours;
    use crate::space::PeriodicBox;
    use crate::space::noise::noise;

    /// Every overlap is found, as a search of all pairs finds it, over four
    /// decades of radii.
    #[test]
    fn agrees_with_a_search_of_all_pairs() {
        let mut noise = noise();
        for (periodic, trial) in [false, true].into_iter().zip(0..).cycle().take(20) {
            let side = 10.0;
            let space = periodic.then(|| PeriodicBox::new([0.0; 3], [side; 3]));
            let mut table = Neighbours::new(400, 2.0, 0.0, space);
            let mut all: Vec<([f64; 3], f64)> = Vec::new();
            let mut overlaps = 0;
            for id in 0..400 {
                let power = noise();
                let radius = if trial % 2 == 0 { 2.0 * power * power * power } else { 0.3 };
                let center = [(); 3].map(|()| side * noise());
                let depth = |other: &([f64; 3], f64)| {
                    let mut square = 0.0;
                    for (a, b) in center.iter().zip(other.0) {
                        let mut d = f64::abs(a - b);
                        if periodic {
                            d = d.min(side - d);
                        }
                        square += d * d;
                    }
                    radius + other.1 - f64::sqrt(square)
                };
                let expected = all.iter().any(|other| depth(other) > 1e-12);
                let found = table.overlapping(center, radius);
                assert_eq!(found.is_some(), expected);
                if let Some(found) = found {
                    overlaps += 1;
                    assert!((depth(&all[found.id as usize]) - found.depth).abs() < 1e-12);
                }
                all.push((center, radius));
                table.insert(id, center, radius);
            }
            assert!(overlaps > 0);
        }
    }

    #[test]
    fn far_away_is_no_trouble() {
        let mut table = Neighbours::new(4, 0.5, 0.0, None);
        for (id, x) in [(0, 1e300), (1, -1e300), (2, 4.5e15 * 2.0), (3, 1e18)] {
            assert!(table.overlapping([x; 3], 0.5).is_none());
            table.insert(id, [x; 3], 0.5);
            assert_eq!(table.overlapping([x; 3], 0.25).map(|found| found.id), Some(id));
        }
    }
}
