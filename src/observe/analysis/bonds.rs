//! Bond order: how the directions to the neighbours of a body are arranged,
//! `q_l = √(4π/(2l+1) Σ_m |⟨Y_lm⟩|²)` with the mean over its neighbours (Steinhardt, Nelson
//! and Ronchetti 1983), and the same over all bonds together, `Q_l`.

use core::f64::consts::PI;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::radial::for_each_pair_within;
use super::tally::Tally;
use super::{Bins, Chosen, Findings, Members, Moment, Unfit};
use crate::numbers::array::Each;
use crate::space::Space;
use crate::vec3::Vec3;

/// How many bins, by default.
const BINS: usize = 100;

/// How far neighbours are, in units of `ρ^(−1/3)`, by default: between the first and
/// the second shell of fcc and hcp (1.12 and 1.59), and behind the second of bcc (1.26).
const REACH: f64 = 1.4;

/// The degrees.
const DEGREES: [usize; 2] = [4, 6];

/// Of both degrees together, the orders from 0 up.
const ORDERS: usize = 5 + 7;

/// Real and imaginary part of `Y_lm` without its factor that is one for all `m`, for each
/// degree and its orders from 0 up.
type Harmonics = [[f64; 2]; ORDERS];

/// The bond order under way. Behind the channels of the bins of `q₆` are those of the
/// figures.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct BondOrder {
    bins: Bins,
    reach: f64,
    members: Members,
    tally: Tally,
}

/// What the channels behind the bins are called.
const FIGURES: [&str; 5] = ["q4", "q6", "mean_q4", "mean_q6", "neighbours"];

impl BondOrder {
    pub fn new(chosen: &Chosen<'_>, moment: &Moment<'_>) -> Result<Self, Unfit> {
        let (volume, side) = moment.cell()?;
        chosen.begins_at_zero()?;
        let half = 0.5 * side;
        let usual = half.min(REACH * (volume / moment.bodies.len() as f64).cbrt());
        let reach = chosen.range()[1].unwrap_or(usual);
        if reach > half {
            let wanted = format!("neighbours are within half of the shortest side, {half:?}");
            return Err(Unfit::new("range", format!("{reach:?}"), wanted));
        }
        let bins = Bins::new(0.0, 1.0, chosen.bins(BINS));
        Ok(Self { bins, reach, members: chosen.only(), tally: Tally::default() })
    }

    pub fn look(&mut self, moment: &Moment<'_>) {
        let Some(space) = moment.space else { return };
        let bodies = moment.bodies;
        let mut of = vec![([[0.0; 2]; ORDERS], 0_u32); bodies.len()];
        for_each_pair_within(bodies, space, self.reach, |a, b, _| {
            let [a, b] = [a as usize, b as usize];
            let way = space.nearest(bodies.position_of(b) - bodies.position_of(a));
            // Of even degree: the same from both ends.
            let harmonics = harmonics(way);
            for index in [a, b] {
                let (sums, count) = &mut of[index];
                *count += 1;
                for (sum, it) in sums.as_flattened_mut().iter_mut().zip(harmonics.as_flattened()) {
                    *sum += it;
                }
            }
        });
        let mut counts = vec![0_u64; self.bins.count];
        let (mut all, mut bonds) = ([[0.0; 2]; ORDERS], 0_u32);
        let (mut local, mut having) = ([0.0; 2], 0_u32);
        for index in self.members.indices() {
            let (sums, count) = &of[index];
            if *count == 0 {
                continue;
            }
            let q = order(sums, *count);
            local[0] += q[0];
            local[1] += q[1];
            having += 1;
            bonds += count;
            for (all, it) in all.as_flattened_mut().iter_mut().zip(sums.as_flattened()) {
                *all += it;
            }
            // At 1 it is in the last bin.
            let q6 = q[1].min(1.0 - f64::EPSILON);
            counts[self.bins.of(q6).unwrap_or(0)] += 1;
        }
        if having > 0 {
            let first = self.bins.count;
            for (bin, count) in counts.into_iter().enumerate() {
                self.tally.add_weighted(bin, count as f64, f64::from(having));
            }
            for (k, q) in order(&all, bonds).into_iter().enumerate() {
                self.tally.add(first + k, q);
                self.tally.add_weighted(first + 2 + k, local[k], f64::from(having));
            }
            let count = self.members.count as f64;
            self.tally.add_weighted(first + 4, f64::from(bonds), count);
        }
        self.tally.end_look();
    }

    pub fn findings(&self) -> Findings {
        let count = self.bins.count;
        let (density, error) = self.bins.density(&self.tally);
        let figure = |(k, name): (usize, &&'static str)| {
            self.tally.figure(name, |sums| sums.mean(count + k))
        };
        Findings {
            columns: vec![("q6", self.bins.middles()), ("density", density), ("error", error)],
            figures: FIGURES.iter().enumerate().filter_map(figure).collect(),
            looks: self.tally.looks(),
        }
    }
}

/// `q₄` and `q₆` of sums over a number of bonds.
fn order(sums: &Harmonics, bonds: u32) -> [f64; 2] {
    let mut orders = sums.iter();
    DEGREES.each(|degree| {
        let own = orders.by_ref().take(degree + 1).enumerate();
        // Orders below 0 have the absolute values of those above.
        let square: f64 =
            own.map(|(m, [re, im])| if m == 0 { re * re } else { 2.0 * (re * re + im * im) }).sum();
        (4.0 * PI / (2 * degree + 1) as f64 * square).sqrt() / f64::from(bonds)
    })
}

/// `Y_lm` of a direction, for each degree and its orders from 0 up.
///
/// With the associated Legendre functions that are normalised for all orders alike (Holmes
/// and Featherstone 2002): `P_mm` from `P_m−1,m−1`, then upwards in `l`; `exp(imφ) sinᵐθ` are
/// powers of `(x + iy)/r`.
fn harmonics(way: Vec3<f64>) -> Harmonics {
    let unit = way * (1.0 / way.length());
    let mut found = [[0.0; 2]; ORDERS];
    let mut power = [1.0, 0.0];
    let mut sectorial = (0.25 / PI).sqrt();
    let last = DEGREES[1];
    for m in 0..=last {
        if m > 0 {
            let k = m as f64;
            sectorial *= -((2.0 * k + 1.0) / (2.0 * k)).sqrt();
            power = [power[0] * unit.x - power[1] * unit.y, power[0] * unit.y + power[1] * unit.x];
        }
        let (mut before, mut now) = (0.0, sectorial);
        for l in m..=last {
            if l > m {
                let (l, m) = (l as f64, m as f64);
                let square = l * l - m * m;
                let along = ((4.0 * l * l - 1.0) / square).sqrt();
                let back =
                    (2.0 * l + 1.0) * ((l - 1.0) * (l - 1.0) - m * m) / ((2.0 * l - 3.0) * square);
                // Of l = m + 1 there is nothing behind.
                let back = if back > 0.0 { back.sqrt() } else { 0.0 };
                (before, now) = (now, along * unit.z * now - back * before);
            }
            let place = match l {
                4 => m,
                6 => 5 + m,
                _ => continue,
            };
            found[place] = [now * power[0], now * power[1]];
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Y_lm` as tables have them.
    #[test]
    fn harmonics_are_those_of_tables() {
        let (x, y, z) = (0.36, 0.48, 0.8);
        let found = harmonics(Vec3::new(3.0 * x, 3.0 * y, 3.0 * z));
        let y40 = 3.0 / 16.0 / PI.sqrt() * (35.0 * z * z * z * z - 30.0 * z * z + 3.0);
        let y60 = (13.0 / PI).sqrt() / 32.0
            * (231.0 * z.powi(6) - 315.0 * z.powi(4) + 105.0 * z * z - 5.0);
        let y66 = (3003.0 / PI).sqrt() / 64.0;
        let (mut re, mut im) = (1.0, 0.0);
        for _ in 0..6 {
            (re, im) = (re * x - im * y, re * y + im * x);
        }
        for (found, expected) in
            [(found[0], [y40, 0.0]), (found[5], [y60, 0.0]), (found[11], [y66 * re, y66 * im])]
        {
            for (found, expected) in found.into_iter().zip(expected) {
                approx::assert_abs_diff_eq!(found, expected, epsilon = 1e-14);
            }
        }
        // The sum over all orders of |Y_lm|² is (2l + 1)/4π: one bond has q = 1.
        for q in order(&found, 1) {
            approx::assert_abs_diff_eq!(q, 1.0, epsilon = 1e-14);
        }
    }
}
