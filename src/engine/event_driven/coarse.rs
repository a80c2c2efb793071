//! Coarse: flights in a coarser precision, to tell quickly which bodies a body cannot
//! meet.
//!
//! Of a body's two dozen neighbours it can meet two or three. The others are
//! passed over in the coarse precision, twice as many at once, with radii that
//! are greater by more than all its rounding errors: a body that can be met is
//! never passed over, and what remains is tried in the full precision, so that
//! no bit of any contact time depends on this.

use super::flight::{Flight, Record};
use super::meeting::meeting;
use crate::lane::{Lane, Mask};
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
        // The products of a meeting are squares of a speed by a length.
        let most = speed * (neighbourhood + speed * period);
        let is_in_range = speed * reach > LEAST_PRODUCT && most < MOST_PRODUCT;
        let is_finer = size_of::<C>() < size_of::<T>();
        self.is_useful = is_finer && is_in_range && margin < reach / 32.0;
        self.margin = C::from_f64(margin);
        self.slack = C::from_f64(4.0 * speed * margin);
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

    /// Keeps of the bodies found those that the body at a slot might meet, and
    /// returns how many. `found` holds whole packs. Those whose flights start now or
    /// later are put down as `later` besides, if asked for.
    ///
    /// Flights that start later are followed back: two that come near each other on
    /// their lines are kept, wherever on them they are now.
    #[inline(always)]
    pub fn screen<L, F, S, const STARTS: bool>(
        &self,
        records: &Pieces<'_, Record<C>>,
        slot: u32,
        found: &mut [u32],
        now: C,
        (space, further): (S, &[Vec3<C>]),
        mut later: Option<&mut Vec<u32>>,
    ) -> usize
    where
        L: Lane<Scalar = C>,
        F: FlightStep,
        S: Space<C>,
    {
        let flight = Flight::<L>::splat(&records[slot as usize].flight());
        let (gravity, now) = (Vec3::<L>::splat(self.gravity), L::splat(now));
        let slack = L::splat(self.slack);
        let mut kept = 0;
        for start in (0..found.len()).step_by(L::WIDTH) {
            let others = Flight::<L>::gather(records, &found[start..start + L::WIDTH]);
            if let Some(later) = &mut later {
                put_down(others.since.ge(now).bits(), &found[start..], later);
            }
            let mut hits = 0;
            for further in further {
                let further = Vec3::<L>::splat(*further);
                let met =
                    meeting::<L, F, S, STARTS>(&flight, &others, gravity, space, further, now);
                hits |= met.may_meet(slack).bits();
            }
            while hits != 0 {
                let k = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                found[kept] = found[start + k];
                kept += 1;
            }
        }
        kept
    }
}

/// Puts down the slots of a pack whose bits are set.
#[inline(always)]
pub(super) fn put_down(mut bits: u32, pack: &[u32], later: &mut Vec<u32>) {
    while bits != 0 {
        later.push(pack[bits.trailing_zeros() as usize]);
        bits &= bits - 1;
    }
}
