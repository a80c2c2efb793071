//! Arrangements: where many spheres are put.

use core::f64::consts::PI;

use super::error::Problem;
use super::obstacles::Obstacles;
use super::random::Random;
use super::spheres::{Arrangement, Spread};
use crate::numbers::array::{self, Each};
use crate::space::neighbours::Neighbours;

/// The packing fraction where random sequential insertion of equal spheres
/// ends: 0.3841 (Zhang and Torquato, Physical Review E 88, 053312, 2013).
const SATURATION: f64 = 0.385;

/// The densest packing of equal spheres, `π/√18`, somewhat rounded up.
const DENSEST: f64 = 0.75;

/// How many random places a group of this size tries before it counts as having
/// no room. Equal spheres get to a packing fraction of 0.33 on 150 places
/// each; from there the number grows without end.
pub(super) fn attempts(count: u64) -> u64 {
    2_000_000 + 200 * count
}

/// The box that spheres fill: the periodic one, or one with walls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub(super) lower: [f64; 3],
    pub(super) upper: [f64; 3],
    pub(super) is_periodic: bool,
}

impl Region {
    fn sides(&self) -> [f64; 3] {
        array::from_fn(|axis| self.upper[axis] - self.lower[axis])
    }

    /// Between which bounds the centre of a sphere can be.
    fn bounds(&self, radius: f64) -> [[f64; 2]; 3] {
        let margin = if self.is_periodic { 0.0 } else { radius };
        array::from_fn(|axis| [self.lower[axis] + margin, self.upper[axis] - margin])
    }

    /// Whether `count` spheres have room by their volume, and each by its
    /// diameter. `limit` is the packing fraction where it ends.
    fn has_room(&self, count: u64, radius: &Spread, limit: f64) -> Result<f64, Problem> {
        let greatest = radius.greatest();
        let sides = self.sides();
        if let Some(side) = sides.iter().find(|side| **side < 2.0 * greatest) {
            let reason =
                format!("the box is {side:?} wide and the greatest diameter {:?}", 2.0 * greatest);
            return Err(Problem::NoRoom { count, reason });
        }
        // The mean of r³ between two bounds, without cancellation.
        let (a, b) = (radius.least(), greatest);
        let cube = (a + b) * (a * a + b * b) / 4.0;
        let volume: f64 = sides.iter().product();
        let packing = 4.0 / 3.0 * PI * cube * count as f64 / volume;
        if packing > limit {
            let reason = format!(
                "the spheres would fill {packing:.3} of the box, and the arrangement ends at \
                 {limit}; take fewer or smaller ones, or a larger box"
            );
            return Err(Problem::NoRoom { count, reason });
        }
        Ok(packing)
    }
}

/// How one group is put.
#[derive(Clone, Copy, Debug)]
pub(super) enum Layout {
    Lattice(Lattice),
    Random(Region),
}

impl Layout {
    /// The layout of `count` spheres, if it has room for them. Spheres that
    /// cannot meet need none.
    pub(super) fn new(
        arrangement: Arrangement,
        count: u64,
        radius: &Spread,
        region: Region,
        can_meet: bool,
    ) -> Result<Self, Problem> {
        let limit = match (arrangement, radius) {
            _ if !can_meet => f64::INFINITY,
            (Arrangement::Random, Spread::Same(_)) => SATURATION,
            _ => DENSEST,
        };
        region.has_room(count, radius, limit)?;
        if arrangement == Arrangement::Random {
            return Ok(Self::Random(region));
        }
        let lattice = Lattice::new(arrangement, count, radius.greatest(), &region);
        let diameter = 2.0 * radius.greatest();
        let nearest = lattice.nearest(region.is_periodic);
        if can_meet && nearest < diameter * (1.0 - 1e-12) {
            let reason = format!(
                "on this lattice they would stand {nearest:?} apart, and the greatest diameter \
                 is {diameter:?}; take fewer or smaller ones, or a larger box"
            );
            return Err(Problem::NoRoom { count, reason });
        }
        Ok(Self::Lattice(lattice))
    }
}

/// Sites on planes across each axis. A cubic lattice has a site wherever three
/// planes meet, a face-centred one wherever the sum of their numbers is even.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    is_centred: bool,
    planes: [u64; 3],
    first: [f64; 3],
    spacing: [f64; 3],
    count: u64,
}

impl Lattice {
    /// The lattice with at least `count` sites whose cells are as near to
    /// cubes as the region allows.
    fn new(arrangement: Arrangement, count: u64, radius: f64, region: &Region) -> Self {
        // A single sphere goes to the middle.
        let is_centred = arrangement == Arrangement::Fcc && count > 1;
        let sites_in_cell = if is_centred { 4 } else { 1 };
        let sides = region.sides();
        let mut cells = [1_u64; 3];
        while cells.iter().product::<u64>().saturating_mul(sites_in_cell) < count {
            let width = |axis: usize| sides[axis] / cells[axis] as f64;
            let mut widest = 0;
            for axis in 1..3 {
                if width(axis) > width(widest) {
                    widest = axis;
                }
            }
            cells[widest] += 1;
        }
        let planes = cells.each(|n| if is_centred { 2 * n } else { n });
        let mut first = [0.0; 3];
        let mut spacing = [0.0; 3];
        for axis in 0..3 {
            let even = sides[axis] / planes[axis] as f64;
            // Half a spacing to the walls, where that leaves room for a sphere.
            let margin = if region.is_periodic { even / 2.0 } else { radius.max(even / 2.0) };
            first[axis] = region.lower[axis] + margin;
            spacing[axis] = if region.is_periodic || planes[axis] == 1 {
                even
            } else {
                (sides[axis] - 2.0 * margin) / (planes[axis] - 1) as f64
            };
        }
        Self { is_centred, planes, first, spacing, count }
    }

    /// How far apart the nearest sites are.
    fn nearest(&self, is_periodic: bool) -> f64 {
        let mut nearest = f64::INFINITY;
        for axis in 0..3 {
            let next = (axis + 1) % 3;
            let [a, b] = [self.spacing[axis], self.spacing[next]];
            if self.is_centred {
                nearest = nearest.min((a * a + b * b).sqrt());
                if is_periodic || self.planes[axis] > 2 {
                    nearest = nearest.min(2.0 * a);
                }
            } else if self.planes[axis] > 1 {
                nearest = nearest.min(a);
            }
        }
        nearest
    }

    /// The site of sphere `index`. Sites that stay empty are spread evenly.
    pub(super) fn site(&self, index: u64) -> [f64; 3] {
        let [across, middle, deep] = self.planes;
        let row = if self.is_centred { across / 2 } else { across };
        let sites = u128::from(row) * u128::from(middle) * u128::from(deep);
        let site = (u128::from(index) * sites / u128::from(self.count)) as u64;
        let y = site / row % middle;
        let z = site / row / middle;
        let x = if self.is_centred { 2 * (site % row) + (y + z) % 2 } else { site % row };
        let at = [x, y, z];
        array::from_fn(|axis| self.first[axis] + at[axis] as f64 * self.spacing[axis])
    }
}

/// A random place in a region where a sphere overlaps nothing, neither what is
/// fixed nor its neighbours. `None` if none was found in the attempts left.
pub(super) fn free_place(
    region: &Region,
    radius: f64,
    fixed: &Obstacles<f64>,
    neighbours: Option<&Neighbours>,
    random: &mut Random,
    attempts: &mut u64,
) -> Option<[f64; 3]> {
    let bounds = region.bounds(radius);
    while *attempts > 0 {
        *attempts -= 1;
        let center = bounds.each(|[least, greatest]| random.between(least, greatest));
        let is_free = fixed.leave_free(center.into(), radius)
            && neighbours.is_none_or(|table| table.overlapping(center, radius).is_none());
        if is_free {
            return Some(center);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Layout, Region};
    use crate::scene::spheres::{Arrangement, Spread};

    fn lattice(
        arrangement: Arrangement,
        count: u64,
        radius: f64,
        sides: [f64; 3],
        is_periodic: bool,
    ) -> Option<Vec<[f64; 3]>> {
        let region = Region { lower: [0.0; 3], upper: sides, is_periodic };
        match Layout::new(arrangement, count, &Spread::Same(radius), region, true) {
            Ok(Layout::Lattice(lattice)) => Some((0..count).map(|k| lattice.site(k)).collect()),
            _ => None,
        }
    }

    /// No two sites of any lattice are nearer than a diameter, and no site is
    /// nearer to a wall than a radius.
    #[test]
    fn sites_keep_their_distance() {
        for arrangement in [Arrangement::Fcc, Arrangement::Cubic] {
            for is_periodic in [false, true] {
                for (count, radius, sides) in [
                    (1, 0.5, [1.0, 1.0, 1.0]),
                    (4, 0.35, [2.0, 2.0, 2.0]),
                    (7, 0.5, [3.0, 4.0, 5.0]),
                    (100, 0.4, [12.0, 3.0, 6.0]),
                    (500, 0.3, [5.0, 5.0, 5.0]),
                    (256, 0.4, [6.0, 6.0, 6.0]),
                ] {
                    let Some(sites) = lattice(arrangement, count, radius, sides, is_periodic)
                    else {
                        assert_eq!(arrangement, Arrangement::Cubic);
                        continue;
                    };
                    for (i, a) in sites.iter().enumerate() {
                        for axis in 0..3 {
                            let margin = if is_periodic { 0.0 } else { radius - 1e-12 };
                            assert!(a[axis] >= margin && a[axis] <= sides[axis] - margin);
                        }
                        for b in &sites[..i] {
                            let mut square = 0.0;
                            for axis in 0..3 {
                                let d = (a[axis] - b[axis]).abs();
                                let d = if is_periodic { d.min(sides[axis] - d) } else { d };
                                square += d * d;
                            }
                            assert!(square.sqrt() >= 2.0 * radius - 1e-12, "{count} {sides:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_lattice_in_a_cube_is_the_textbook_one() {
        let sites = lattice(Arrangement::Fcc, 10_976, 0.5, [28.0; 3], true).unwrap();
        // 14 cells a side, four sites each.
        for [x, y, z] in sites {
            assert!([x, y, z].iter().all(|c| (c - 0.5).fract() == 0.0));
            assert_eq!((x + y + z - 1.5) % 2.0, 0.0);
        }
    }
}
