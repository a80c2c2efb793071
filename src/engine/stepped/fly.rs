//! Fly: free flight of all bodies through one step.

use core::slice::ChunksMut;

use super::lanes::in_lanes;
use super::setting::Setting;
use super::state::{Low, State};
use crate::lane::Lane;
use crate::motion::flight::{Remainders, Wrap};
use crate::motion::turning::turn;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::OpenSpace;
use crate::vec3::Vec3;

/// Bodies flown as one piece of work.
const FLOWN: usize = 1 << 11;

/// Flies all bodies through one step and returns how far any has moved at most,
/// with a margin for the rounding.
pub(super) fn fly<T: Real>(setting: &Setting<T>, state: &mut State<T>) -> T {
    let [mut x, mut y, mut z] = state.position.muts().each(|column| column.chunks_mut(FLOWN));
    let mut velocity = state.velocity.muts().each(|column| column.chunks_mut(FLOWN));
    let mut low = state.low.as_mut().map(|low| {
        let Low { position, velocity } = &mut **low;
        [position, velocity].each(|columns| columns.muts().each(|column| column.chunks_mut(FLOWN)))
    });
    let mut chunks = Vec::with_capacity(setting.plan.bodies.div_ceil(FLOWN));
    while let (Some(x), Some(y), Some(z)) = (x.next(), y.next(), z.next()) {
        let low = low.as_mut().map(|[position, velocity]| [next(position), next(velocity)]);
        chunks.push(([x, y, z], next(&mut velocity), low, T::ZERO));
    }
    setting.workers.each(&mut chunks, |(position, velocity, low, fastest)| {
        let position = position.muts().each(|column| &mut **column);
        let velocity = velocity.muts().each(|column| &mut **column);
        let remainders = low.as_mut().map(|[position, velocity]| Remainders {
            position: position.muts().each(|column| &mut **column),
            velocity: velocity.muts().each(|column| &mut **column),
        });
        let lanes = setting.plan.sweep_lanes;
        *fastest = in_lanes!(sweep lanes, fly_some::<T>(setting, position, velocity, remainders));
    });
    let fastest = chunks.iter().fold(T::ZERO, |most, chunk| chunk.3.greater(most));
    let field = setting.acceleration.map_or(T::ZERO, Vec3::length) * setting.dt;
    (Lane::sqrt(fastest) + field) * setting.dt * T::ratio(65, 64)
}

/// The next chunk of each column.
fn next<'a, T>(columns: &mut [ChunksMut<'a, T>; 3]) -> [&'a mut [T]; 3] {
    columns.muts().each(|column| column.next().unwrap_or_default())
}

/// Flies some bodies through one step and returns the greatest `v·v`.
fn fly_some<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    position: [&mut [T]; 3],
    velocity: [&mut [T]; 3],
    remainders: Option<Remainders<'_, T>>,
) -> T {
    match setting.periodic {
        None => fly_in::<L, T, _>(setting, position, velocity, remainders, OpenSpace),
        Some(space) => fly_in::<L, T, _>(setting, position, velocity, remainders, space),
    }
}

fn fly_in<L: Lane<Scalar = T>, T: Real, S: Wrap<T>>(
    setting: &Setting<T>,
    position: [&mut [T]; 3],
    velocity: [&mut [T]; 3],
    remainders: Option<Remainders<'_, T>>,
    space: S,
) -> T {
    let &Setting { dt, acceleration, integrator, .. } = setting;
    match remainders {
        None => integrator.flight_and_fastest::<L, _>(position, velocity, acceleration, dt, space),
        Some(remainders) => integrator.compensated_flight_and_fastest::<L, _>(
            position,
            velocity,
            remainders,
            acceleration,
            dt,
            space,
        ),
    }
}

/// `M ← R M` for every body.
pub(super) fn rotate<T: Real>(setting: &Setting<T>, state: &mut State<T>) {
    let Some(rows) = &mut state.orientation else { return };
    let mut rows = rows.muts().each(|row| row.chunks_mut(FLOWN));
    let mut spins = state.spin.refs().each(|column| column.chunks(FLOWN));
    let mut chunks: Vec<_> = (0..setting.plan.bodies.div_ceil(FLOWN))
        .map(|_| {
            let rows = rows.muts().each(|row| row.next().unwrap_or_default());
            (rows, spins.muts().each(|column| column.next().unwrap_or_default()))
        })
        .collect();
    setting.workers.each(&mut chunks, |(rows, spin)| {
        let rows = rows.muts().each(|row| &mut **row);
        let lanes = setting.plan.sweep_lanes;
        in_lanes!(sweep lanes, turn_some::<T>(rows, *spin, setting.dt));
    });
}

fn turn_some<L: Lane<Scalar = T>, T: Real>(rows: [&mut [T]; 9], spin: [&[T]; 3], dt: T) {
    turn::<L>(rows, spin, dt);
}
