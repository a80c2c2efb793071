//! Fly: free flight of all bodies through one step.

use super::setting::Setting;
use super::state::State;
use crate::lane::Lane;
use crate::motion::turning::turn;
use crate::real::Real;
use crate::space::OpenSpace;
use crate::vec3::Vec3;

/// Bodies flown as one piece of work.
const FLOWN: usize = 1 << 14;

/// Flies all bodies through one step and returns how far any has moved at most,
/// with a margin for the rounding.
pub(super) fn fly<L: Lane<Scalar = T>, T: Real>(setting: &Setting<T>, state: &mut State<T>) -> T {
    let &Setting { dt, acceleration, integrator, periodic, .. } = setting;
    let [x, y, z] = state.position.each_mut().map(|column| column.chunks_mut(FLOWN));
    let [u, v, w] = state.velocity.each_mut().map(|column| column.chunks_mut(FLOWN));
    let mut chunks: Vec<_> = x
        .zip(y)
        .zip(z)
        .zip(u.zip(v).zip(w))
        .map(|(((x, y), z), ((u, v), w))| ([x, y, z], [u, v, w], T::ZERO))
        .collect();
    setting.workers.each(&mut chunks, |(position, velocity, fastest)| {
        let position = position.each_mut().map(|column| &mut **column);
        let velocity = velocity.each_mut().map(|column| &mut **column);
        *fastest = match periodic {
            None => integrator.flight_and_fastest::<L, _>(
                position,
                velocity,
                acceleration,
                dt,
                OpenSpace,
            ),
            Some(space) => {
                integrator.flight_and_fastest::<L, _>(position, velocity, acceleration, dt, space)
            }
        };
    });
    let fastest = chunks.iter().fold(T::ZERO, |most, chunk| chunk.2.greater(most));
    let field = acceleration.map_or(T::ZERO, Vec3::length) * dt;
    (Lane::sqrt(fastest) + field) * dt * T::ratio(65, 64)
}

/// `M ← R M` for every body.
pub(super) fn rotate<L: Lane<Scalar = T>, T: Real>(setting: &Setting<T>, state: &mut State<T>) {
    let Some(rows) = &mut state.orientation else { return };
    let mut rows = rows.each_mut().map(|row| row.chunks_mut(FLOWN));
    let mut spins = state.spin.each_ref().map(|column| column.chunks(FLOWN));
    let mut chunks: Vec<_> = (0..setting.plan.bodies.div_ceil(FLOWN))
        .map(|_| {
            let rows = rows.each_mut().map(|row| row.next().unwrap_or_default());
            (rows, spins.each_mut().map(|column| column.next().unwrap_or_default()))
        })
        .collect();
    setting.workers.each(&mut chunks, |(rows, spin)| {
        turn::<L>(rows.each_mut().map(|row| &mut **row), *spin, setting.dt);
    });
}
