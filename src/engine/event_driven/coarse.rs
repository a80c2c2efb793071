//! Coarse: flights in a coarser precision, to tell quickly which bodies a body cannot
//! meet.
//!
//! Of a body's two dozen neighbours it can meet two or three. The others are
//! passed over in the coarse precision, twice as many at once, with radii that
//! are greater by more than all its rounding errors: a body that can be met is
//! never passed over, and what remains is tried in the full precision, so that
//! no bit of any contact time depends on this.

use super::flight::{Flight, Record};
use super::meeting::{TOGETHER, meeting};
use crate::lane::{Lane, Mask, ones};
use crate::motion::integrator::FlightStep;
use crate::real::Real;
use crate::space::pieces::Pieces;
use crate::space::{PeriodicBox, Space};
use crate::vec3::Vec3;

/// What speeds by lengths may be, so that their squares are far from both ends
/// of the range of an `f32`.
const LEAST_PRODUCT: f64 = 1e-15;
const MOST_PRODUCT: f64 = 1e18;

/// How bodies are put down in coarse precision.
#[derive(Debug)]
pub(super) struct Screening<C: Real> {
    /// Whether it is fine enough for the scene.
    pub is_useful: bool,
    gravity: Vec3<C>,
    pub periodic: Option<PeriodicBox<C>>,
    /// What is added to each radius, length.
    margin: C,
    /// Up to this `x·V` two bodies may approach each other.
    slack: C,
    /// What is added to each `V²` for the part of `V` that rounding takes or turns.
    stray: C,
}

/// The scales that the rounding errors are measured by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    /// Greatest coordinate, length.
    pub extent: f64,
    /// Distance within which neighbours are, length.
    pub neighbourhood: f64,
    /// Least sum of two radii, length.
    pub reach: f64,
    /// Greatest speed, length per time.
    pub speed: f64,
    /// Length of a period, time.
    pub period: f64,
}

impl<C: Real> Screening<C> {
    pub fn new<T: Real>(gravity: Vec3<T>, periodic: Option<PeriodicBox<T>>) -> Self {
        Self {
            is_useful: false,
            gravity: gravity.cast(),
            periodic: periodic.map(PeriodicBox::cast),
            margin: C::ZERO,
            slack: C::ZERO,
            stray: C::ZERO,
        }
    }

    /// Begins a period: chooses the margins, and whether any are small enough.
    pub fn begin<T: Real>(&mut self, scales: &Scales) {
        let Scales { extent, neighbourhood, reach, speed, period } = *scales;
        let epsilon = C::EPSILON.to_f64();
        // Positions, the way of a period and the products of the discriminant.
        let ways = 16.0 * epsilon * (extent + speed * period);
        let products = 16.0 * epsilon * neighbourhood * neighbourhood / reach;
        let margin = ways + products;
        // Velocities are off by δ = 8 ε of the greatest: a slow pair turns by far, and misses
        // by `f s` more, `f = 2 δ x / s`. The margin of a radius, `a = 2 margin / s`, makes up
        // for it where `(1 + a) (V² + stray) ≥ (V + f)²`: for each V if `stray ≥ f² (1 + 1/a)`.
        let turned = 16.0 * epsilon * speed * neighbourhood / reach;
        let stray = turned * turned * (1.0 + reach / (2.0 * margin));
        // The products of a meeting are squares of a speed by a length.
        let most = speed * (neighbourhood + speed * period);
        let is_in_range = speed * reach > LEAST_PRODUCT && most < MOST_PRODUCT;
        let is_finer = size_of::<C>() < size_of::<T>();
        self.is_useful = is_finer && is_in_range && margin < reach / 32.0;
        self.margin = C::from_f64(margin);
        self.slack = C::from_f64(4.0 * speed * margin);
        self.stray = C::from_f64(stray);
    }

    /// A flight in coarse precision.
    #[inline(always)]
    pub fn record<T: Real>(&self, flight: &Flight<T>) -> Record<C> {
        Record::new(Flight {
            position: flight.position.cast(),
            velocity: flight.velocity.cast(),
            since: flight.since.cast(),
            radius: flight.radius.cast::<C>() + self.margin,
        })
    }
}

/// A screening of the bodies found near one, for contacts with an image of each.
pub(super) struct Screen<'a, C: Real, S> {
    pub records: &'a Pieces<'a, Record<C>>,
    /// The body's slot.
    pub slot: u32,
    pub now: C,
    pub space: S,
    /// Which image, in whole boxes.
    pub further: Vec3<C>,
}

impl<C: Real, S: Space<C>> Screen<'_, C, S> {
    /// Puts those of the bodies found that the body might meet down as `remaining`, and
    /// returns how many. `found` holds whole packs. Those whose flights start now or
    /// later are put down as `later` besides, if asked for.
    ///
    /// Flights that start later are followed back: two that come near each other on
    /// their lines are kept, wherever on them they are now.
    #[inline(always)]
    pub fn run<L, F, const STARTS: bool>(
        &self,
        screening: &Screening<C>,
        found: &[u32],
        remaining: &mut [u32],
        mut later: Option<&mut Vec<u32>>,
    ) -> usize
    where
        L: Lane<Scalar = C>,
        F: FlightStep,
    {
        let &Self { records, slot, now, space, further } = self;
        let flight = Flight::<L>::splat(&records[slot as usize].flight());
        let (now, further) = (L::splat(now), Vec3::<L>::splat(further));
        let gravity = Vec3::<L>::splat(screening.gravity);
        let (slack, stray) = (L::splat(screening.slack), L::splat(screening.stray));
        let mut len = 0;
        for together in found.chunks(TOGETHER) {
            // Looked at when all are worked out: which packs have hits cannot be predicted.
            let (mut hits, mut starts_later) = (0, 0);
            for (k, pack) in together.chunks_exact(L::WIDTH).enumerate() {
                let others = Flight::<L>::gather(records, pack);
                let met =
                    meeting::<L, F, S, STARTS>(&flight, &others, gravity, space, further, now);
                hits |= u64::from(met.may_meet(slack, stray).bits()) << (k * L::WIDTH);
                starts_later |= u64::from(others.since.ge(now).bits()) << (k * L::WIDTH);
            }
            for k in ones(hits) {
                remaining[len] = together[k];
                len += 1;
            }
            if let Some(later) = &mut later {
                later.extend(ones(starts_later).map(|k| together[k]));
            }
        }
        len
    }
}
