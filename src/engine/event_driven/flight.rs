//! Flight: a body between two collisions.

use crate::lane::Lane;
use crate::motion::integrator::FlightStep;
use crate::real::Real;
use crate::space::pieces::Pieces;
use crate::vec3::Vec3;

/// A body's free flight since its motion last changed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight<L> {
    /// Centre at the start, length; not wrapped on the way.
    pub position: Vec3<L>,
    /// Velocity at the start, length per time.
    pub velocity: Vec3<L>,
    /// The start, time since the period's start.
    pub since: L,
    /// Radius, length.
    pub radius: L,
}

/// The flight of one body as eight reals, on cache lines of its own: centre,
/// velocity, start, radius.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Record<T: Real> {
    reals: [T; 8],
    aligned: [T::Pack8; 0],
}

impl<T: Real> Record<T> {
    pub fn new(flight: Flight<T>) -> Self {
        let [x, y, z] = flight.position.to_array();
        let [u, v, w] = flight.velocity.to_array();
        Self { reals: [x, y, z, u, v, w, flight.since, flight.radius], aligned: [] }
    }

    #[inline(always)]
    pub fn flight(&self) -> Flight<T> {
        Flight::from_columns(self.reals)
    }

    /// When the flight has started.
    #[inline(always)]
    pub fn since(&self) -> T {
        self.reals[6]
    }

    /// The body's radius, length.
    #[inline(always)]
    pub fn radius(&self) -> T {
        self.reals[7]
    }
}

/// The most lanes that are gathered at once.
pub(super) const WIDEST: usize = 16;

impl<L: Lane> Flight<L> {
    /// The flight of one body in every lane.
    #[inline(always)]
    pub fn splat(flight: &Flight<L::Scalar>) -> Self {
        Self {
            position: Vec3::splat(flight.position),
            velocity: Vec3::splat(flight.velocity),
            since: L::splat(flight.since),
            radius: L::splat(flight.radius),
        }
    }

    /// The flights of the bodies at some slots.
    #[inline(always)]
    pub fn gather(records: &Pieces<'_, Record<L::Scalar>>, slots: &[u32]) -> Self {
        let slots = &slots[..L::WIDTH];
        let mut rows = [&records[slots[0] as usize].reals; WIDEST];
        if let Some((run, start)) = records.only_run() {
            for k in 1..L::WIDTH {
                rows[k] = &run[(slots[k] as usize).wrapping_sub(start)].reals;
            }
        } else {
            for k in 1..L::WIDTH {
                rows[k] = &records[slots[k] as usize].reals;
            }
        }
        Self::from_columns(L::transpose(&rows))
    }

    #[inline(always)]
    fn from_columns([x, y, z, u, v, w, since, radius]: [L; 8]) -> Self {
        Self { position: Vec3::new(x, y, z), velocity: Vec3::new(u, v, w), since, radius }
    }

    /// Centre and velocity at a time.
    #[inline(always)]
    pub fn at<F: FlightStep>(&self, time: L, gravity: Vec3<L>) -> (Vec3<L>, Vec3<L>) {
        F::step(self.position, self.velocity, gravity, time - self.since)
    }
}
