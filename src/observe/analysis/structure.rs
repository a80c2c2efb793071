//! Structure factor: how strong the density is in waves of a length,
//! `S(k) = ⟨|Σ exp(−i k·r)|²⟩/N`, of the wave vectors that a periodic box has.

use core::f64::consts::PI;
use std::collections::BTreeSet;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::tally::{Tally, columns};
use super::{Bins, Chosen, Findings, Members, Moment, Unfit};
use crate::numbers::array;
use crate::trigonometry::sin_cos;

/// How many bins, by default.
const BINS: usize = 100;

/// How far wave numbers go, over the diameter of the smallest body, by default.
const DIAMETERS: f64 = 20.0;

/// How many directions of a wave number are looked at, at most.
const DIRECTIONS: usize = 24;

/// The most waves along a side.
const MOST: f64 = 100_000.0;

/// The structure factor under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct StructureFactor {
    /// Wave vectors, in waves along each side, by bin.
    waves: Vec<[i32; 3]>,
    /// Where those of each bin with any end, and the mean of their wave numbers.
    bins: Vec<(usize, f64)>,
    members: Members,
    tally: Tally,
}

impl StructureFactor {
    pub fn new(chosen: &Chosen<'_>, moment: &Moment<'_>) -> Result<Self, Unfit> {
        moment.cell()?;
        let sides = moment.space.map_or([1.0; 3], |space| space.sides().to_array());
        let members = chosen.only();
        let radii = members.indices().map(|index| moment.bodies.radius.of(index));
        let smallest = radii.fold(f64::INFINITY, f64::min);
        let [from, to] = chosen.range();
        let to = to.unwrap_or(DIAMETERS / (2.0 * smallest));
        let longest = sides.into_iter().fold(0.0, f64::max);
        let most = MOST * 2.0 * PI / longest;
        if to > most {
            let wanted = format!("it can go to {most:?}, {MOST} waves along the longest side");
            return Err(Unfit::new("range", format!("to {to:?}"), wanted));
        }
        let bins = Bins::new(from.unwrap_or(0.0), to, chosen.bins(BINS));
        let number = |waves: &[i32; 3]| {
            let k: [f64; 3] =
                array::from_fn(|axis| 2.0 * PI * f64::from(waves[axis]) / sides[axis]);
            (k[0] * k[0] + k[1] * k[1] + k[2] * k[2]).sqrt()
        };
        // For each bin directions that are spread over half of a sphere along a spiral, each
        // with the nearest vector that the box has.
        let mut waves: Vec<[i32; 3]> = Vec::new();
        let mut filled = Vec::new();
        for bin in 0..bins.count {
            let middle = bins.middle(bin);
            let near: BTreeSet<[i32; 3]> = directions()
                .map(|way| {
                    array::from_fn(|axis| {
                        (middle * way[axis] * sides[axis] / (2.0 * PI)).round() as i32
                    })
                })
                .filter(|waves| bins.of(number(waves)) == Some(bin) && *waves != [0; 3])
                .collect();
            if near.is_empty() {
                continue;
            }
            let mean = near.iter().map(number).sum::<f64>() / near.len() as f64;
            waves.extend(near);
            filled.push((waves.len(), mean));
        }
        if waves.is_empty() {
            let least = 2.0 * PI / longest;
            let wanted = format!("the longest wave in the box has {least:?}");
            return Err(Unfit::new("range", format!("to {to:?}"), wanted));
        }
        Ok(Self { waves, bins: filled, members, tally: Tally::default() })
    }

    pub fn look(&mut self, moment: &Moment<'_>) {
        let Some(space) = moment.space else { return };
        let (lower, sides) = (space.lower.to_array(), space.sides().to_array());
        let most: [usize; 3] = array::from_fn(|axis| {
            let most = self.waves.iter().map(|waves| waves[axis].unsigned_abs()).max();
            most.unwrap_or(0) as usize
        });
        let mut sums = vec![[0.0; 2]; self.waves.len()];
        let mut phases: [Vec<[f64; 2]>; 3] = [const { Vec::new() }; 3];
        for index in self.members.indices() {
            let place = moment.bodies.position_of(index).to_array();
            for axis in 0..3 {
                let turn = (place[axis] - lower[axis]) / sides[axis];
                let (sine, cosine) = sin_cos(2.0 * PI * turn);
                let powers = &mut phases[axis];
                powers.clear();
                powers.push([1.0, 0.0]);
                for wave in 0..most[axis] {
                    powers.push(product(powers[wave], [cosine, sine]));
                }
            }
            let [x, y, z] = &phases;
            for (sum, waves) in sums.iter_mut().zip(&self.waves) {
                let phase = product(product(of(x, waves[0]), of(y, waves[1])), of(z, waves[2]));
                sum[0] += phase[0];
                sum[1] += phase[1];
            }
        }
        let count = self.members.count as f64;
        let mut first = 0;
        for (bin, (end, _)) in self.bins.iter().enumerate() {
            let squares = sums[first..*end].iter().map(|[re, im]| re * re + im * im);
            self.tally.add_weighted(bin, squares.sum::<f64>() / count, (end - first) as f64);
            first = *end;
        }
        self.tally.end_look();
    }

    pub fn findings(&self) -> Findings {
        let factor = self.tally.figures(self.bins.len(), "factor", |sums, bin| sums.mean(bin));
        let (factor, error) = columns(&factor);
        Findings {
            columns: vec![
                ("k", self.bins.iter().map(|(_, mean)| Some(*mean)).collect()),
                ("factor", factor),
                ("error", error),
            ],
            figures: Vec::new(),
            looks: self.tally.looks(),
        }
    }
}

/// Directions that are spread over half of a sphere, along a spiral of golden angles.
fn directions() -> impl Iterator<Item = [f64; 3]> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..DIRECTIONS).map(move |k| {
        let z = (k as f64 + 0.5) / DIRECTIONS as f64;
        let (sine, cosine) = sin_cos(golden * k as f64);
        let across = (1.0 - z * z).sqrt();
        [across * cosine, across * sine, z]
    })
}

/// The phase of a number of waves, which may run backwards.
fn of(phases: &[[f64; 2]], waves: i32) -> [f64; 2] {
    let [cosine, sine] = phases[waves.unsigned_abs() as usize];
    if waves < 0 { [cosine, -sine] } else { [cosine, sine] }
}

/// The product of two complex numbers.
fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}
