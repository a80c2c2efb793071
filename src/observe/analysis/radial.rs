//! Radial distribution: how many bodies are at a distance from another, over how many
//! there would be if places were at random, `g(r) = n₂(r)/ρ²`.

use core::f64::consts::PI;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::tally::{Sums, Tally, columns};
use super::{Bins, Chosen, Findings, Members, Moment, Unfit};
use crate::bodies::{Bodies, PerBody};
use crate::space::{PeriodicBox, Space, for_each_near_pair};

/// How many bins, by default.
const BINS: usize = 200;

/// How many diameters it goes to, by default, if the box is large enough.
const DIAMETERS: f64 = 3.0;

/// Up to how many diameters `g` is extrapolated from to contact.
const NEAR: f64 = 1.1;

/// By what part of it rounding may have a distance below contact.
const ROUNDING: f64 = 1e-6;

/// The radial distribution under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct RadialDistribution {
    bins: Bins,
    /// For each body, in which of the two species it is; `None` if all are in both.
    of: Option<Vec<[bool; 2]>>,
    /// Pairs in a unit of volume around the bodies, at random.
    pairs: f64,
    /// The distance at which all pairs touch, if it is one.
    contact: Option<f64>,
    /// For equal spheres, how many there are and their number density.
    gas: Option<(f64, f64)>,
    tally: Tally,
    /// Pairs of one look, by bin.
    counts: Vec<u64>,
}

impl RadialDistribution {
    pub fn new(chosen: &Chosen<'_>, moment: &Moment<'_>) -> Result<Self, Unfit> {
        let (volume, side) = moment.cell()?;
        let [first, second] =
            [&chosen.members[0], chosen.members.last().unwrap_or(&chosen.members[0])];
        let radii = |members: &Members| {
            let radii = members.indices().map(|index| moment.bodies.radius.of(index));
            radii.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), radius| {
                (least.min(radius), most.max(radius))
            })
        };
        let (a, b) = (radii(first), radii(second));
        let (least, most) = (a.0 + b.0, a.1 + b.1);
        let [from, to] = chosen.range();
        let half = 0.5 * side;
        if let Some(to) = to.filter(|to| *to > half) {
            let wanted = format!("it can go to half of the shortest side of the box, {half:?}");
            return Err(Unfit::new("range", format!("to {to:?}"), wanted));
        }
        let from = from.unwrap_or(least);
        let to = to.unwrap_or_else(|| half.min(DIAMETERS * most));
        if from >= to {
            let wanted = format!(
                "give it as [from, to], from below a distance of at most half of the box, {half:?}"
            );
            return Err(Unfit::new("range", format!("from {from:?} to {to:?}"), wanted));
        }
        let is_same = first == second;
        let count = first.count as f64 * second.count as f64;
        let of = (first.some.is_some() || second.some.is_some()).then(|| {
            let mut of = vec![[false; 2]; moment.bodies.len()];
            first.indices().for_each(|index| of[index][0] = true);
            second.indices().for_each(|index| of[index][1] = true);
            of
        });
        let contact = (least == most).then_some(least);
        let all = moment.bodies.len() as f64;
        let gas =
            (contact.is_some() && is_same && first.some.is_none()).then(|| (all, all / volume));
        let bins = Bins::new(from, to, chosen.bins(BINS));
        Ok(Self {
            bins,
            of,
            pairs: if is_same { 0.5 * count / volume } else { count / volume },
            contact,
            gas,
            tally: Tally::default(),
            counts: vec![0; bins.count],
        })
    }

    pub fn look(&mut self, moment: &Moment<'_>) {
        let Some(space) = moment.space else { return };
        self.counts.fill(0);
        let Self { bins, of, counts, .. } = self;
        let bodies = moment.bodies;
        for_each_pair_within(bodies, space, bins.edge(bins.count), |a, b, distance| {
            let is_of = of.as_ref().is_none_or(|of| {
                let (a, b) = (of[a as usize], of[b as usize]);
                (a[0] && b[1]) || (a[1] && b[0])
            });
            let is_near = distance < bins.from && distance > bins.from * (1.0 - ROUNDING);
            let distance = if is_near { bins.from } else { distance };
            if let Some(bin) = bins.of(distance).filter(|_| is_of) {
                counts[bin] += 1;
            }
        });
        for (bin, count) in self.counts.iter().enumerate() {
            self.tally.add(bin, *count as f64);
        }
        self.tally.end_look();
    }

    fn g(&self, sums: &Sums, bin: usize) -> Option<f64> {
        let [near, far] = [self.bins.edge(bin), self.bins.edge(bin + 1)];
        let shell = 4.0 / 3.0 * PI * (far * far * far - near * near * near);
        Some(sums.mean(bin)? / (self.pairs * shell))
    }

    /// `g` where spheres touch: `ln g` is a parabola near contact, found from the bins up
    /// to 1.1 diameters by least squares, each with the weight of its pairs.
    fn at_contact(&self, sums: &Sums, contact: f64) -> Option<f64> {
        let is_near = |bin: &usize| {
            let ends = [self.bins.edge(*bin), self.bins.edge(bin + 1)];
            ends[0] > contact * (1.0 - ROUNDING) && ends[1] < contact * NEAR * (1.0 + ROUNDING)
        };
        let reach = contact * (NEAR - 1.0);
        let mut moments = [0.0; 5];
        let mut right = [0.0; 3];
        let mut bins = 0;
        for bin in (0..self.bins.count).filter(is_near) {
            let g = self.g(sums, bin)?;
            if g == 0.0 {
                continue;
            }
            bins += 1;
            let (weight, x) = (sums.sum(bin), (self.bins.middle(bin) - contact) / reach);
            let powers = [1.0, x, x * x, x * x * x, x * x * x * x];
            moments.iter_mut().zip(powers).for_each(|(moment, power)| *moment += weight * power);
            right.iter_mut().zip(powers).for_each(|(it, power)| *it += weight * power * g.ln());
        }
        if bins < 6 {
            return None;
        }
        let [m0, m1, m2, m3, m4] = moments;
        let determinant = |c: [[f64; 3]; 3]| {
            c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1])
                - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0])
                + c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0])
        };
        // Cramer's rule for the constant.
        let whole = determinant([[m0, m1, m2], [m1, m2, m3], [m2, m3, m4]]);
        let own = determinant([[right[0], m1, m2], [right[1], m2, m3], [right[2], m3, m4]]);
        Some((own / whole).exp()).filter(|g| g.is_finite())
    }

    pub fn findings(&self) -> Findings {
        let g = self.tally.figures(self.bins.count, "g", |sums, bin| self.g(sums, bin));
        let (g, error) = columns(&g);
        let contact = self.contact.and_then(|contact| {
            self.tally.figure("contact", |sums| self.at_contact(sums, contact))
        });
        // Z = 1 − 1/N + (2π/3) ρ σ³ g(σ⁺), as the summary has it: 1/N is that of `compressibility`.
        let factor = self.contact.zip(self.gas).and_then(|(contact, (count, density))| {
            let volume = 2.0 / 3.0 * PI * density * contact * contact * contact;
            self.tally.figure("compressibility", |sums| {
                Some(1.0 - 1.0 / count + volume * self.at_contact(sums, contact)?)
            })
        });
        Findings {
            columns: vec![("r", self.bins.middles()), ("g", g), ("error", error)],
            figures: contact.into_iter().chain(factor).collect(),
            looks: self.tally.looks(),
        }
    }
}

/// Visits all pairs of centres that are nearer to each other than `reach`, at most half of
/// the shortest side, with their distance.
pub fn for_each_pair_within(
    bodies: &Bodies<f64>,
    space: PeriodicBox<f64>,
    reach: f64,
    mut visit: impl FnMut(u32, u32, f64),
) {
    // Spheres of that diameter overlap where centres are as near.
    let spheres = Bodies { radius: PerBody::Same(0.5 * reach), ..bodies.clone() };
    for_each_near_pair(&spheres, Some(space), 0.0, |a, b| {
        let way = bodies.position_of(b as usize) - bodies.position_of(a as usize);
        visit(a, b, space.nearest(way).length());
    });
}
