//! Within: contacts take effect at their times inside a step.
//!
//! Lanes fly to the end of a step, and find there what has met on the way: the first contact
//! of each pair, and of each body with what is fixed. A scene in which anything has met leaves
//! its lane for a stage ([`Stage`]), where contacts take effect in their order; the bodies that
//! have collided go back into the lane.

use super::moving::Values;
use super::pack::Pack;
use super::setting::Setting;
use super::step::Events;
use crate::bodies::PerBody;
use crate::column::Column;
use crate::contact::PastContact;
use crate::engine::stepped::{ContactInStep, Path, Rank, Stage, State, Steps, met_since};
use crate::engine::{EngineError, Event};
use crate::lane::{Lane, Mask, ones};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::Scene;
use crate::vec3::Vec3;

/// What one worker has for the contacts within a step of one pack after the other.
#[derive(Debug)]
pub struct Meetings<T: Real> {
    /// The first contacts of the step, by lane.
    found: Vec<Vec<ContactInStep<T>>>,
    stage: Stage<T>,
}

impl<T: Real> Meetings<T> {
    /// For scenes of the shape of this one.
    pub fn new(scene: &Scene<T>, width: usize) -> Result<Self, EngineError> {
        let found = (0..width).map(|_| Vec::with_capacity(Stage::room(scene))).collect();
        Ok(Self { found, stage: Stage::new(scene)? })
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        let found: usize = self.found.iter().map(Vec::capacity).sum();
        found * size_of::<ContactInStep<T>>() + self.stage.bytes()
    }
}

/// Finds what has met in the step that a pack has just taken, and lets it take effect.
#[inline(never)]
pub(super) fn contacts<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    pack: &mut Pack<T>,
    meetings: &mut Meetings<T>,
    mut events: Option<&mut Events<T>>,
) {
    let change = change::<L, T>(setting, pack);
    let fastest = fastest::<L, T>(pack, change);
    find::<L, T>(setting, pack, [change, fastest], &mut meetings.found);
    let Meetings { found, stage } = meetings;
    let fastest = fastest.to_array();
    for (lane, found) in found.iter_mut().enumerate().filter(|(_, found)| !found.is_empty()) {
        enter::<L, T>(setting, pack, lane, stage.state(), events.is_some());
        let moving = &mut pack.moving;
        let (exact_dt, scene) = (moving.seats[lane].exact_dt, moving.seats[lane].scene);
        let gravity = pack.gravity.refs().each(|column| column[lane]).into();
        let steps = Steps { taken: moving.steps(lane), exact_dt, dt: moving.dt[lane], gravity };
        let fastest = fastest.as_ref()[lane];
        let collided = match (&mut events, scene) {
            (Some(events), Some(scene)) => {
                let mut on_event = |event: &Event<T>| events.push((scene, *event));
                stage.collide(steps, found, fastest, Some(&mut on_event))
            }
            _ => stage.collide(steps, found, fastest, None),
        };
        let collisions = &mut moving.seats[lane].collisions;
        collisions.pairs += collided.pairs;
        collisions.surroundings += collided.surroundings;
        leave::<L, T>(pack, lane, stage);
        found.clear();
    }
}

/// How much the field changes a velocity in a step.
#[inline(always)]
fn change<L: Lane<Scalar = T>, T: Real>(setting: &Setting<T>, pack: &Pack<T>) -> L {
    if !setting.plan.has_field {
        return L::ZERO;
    }
    let [x, y, z] = pack.gravity.refs().each(|column| L::load(column));
    Vec3::new(x, y, z).length_squared().sqrt() * L::load(&pack.moving.dt)
}

/// A speed that a body has not exceeded in a step, with a margin for rounding.
#[inline(always)]
fn bound<L: Lane>(speed_squared: L, change: L) -> L {
    (speed_squared.sqrt() + change) * L::ratio(65, 64)
}

/// A speed that no body of a scene has exceeded in the step.
#[inline(always)]
fn fastest<L: Lane<Scalar = T>, T: Real>(pack: &Pack<T>, change: L) -> L {
    let [x, y, z] = pack.moving.velocity.refs().each(|column| L::arrays(column).0);
    let mut most = L::ZERO;
    for body in 0..x.len() {
        let velocity = Vec3::<L>::from_arrays([x[body], y[body], z[body]]);
        most = most.greater(velocity.length_squared());
    }
    bound(most, change)
}

/// Finds the first contacts of all pairs, and of all bodies with what is fixed.
#[inline(always)]
fn find<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    pack: &Pack<T>,
    [change, fastest]: [L; 2],
    found: &mut [Vec<ContactInStep<T>>],
) {
    let Pack { position, radius, moving, .. } = pack;
    let dt = L::load(&moving.dt);
    let way = fastest * dt;
    let place = position.refs().each(|column| L::arrays(column).0);
    let velocity = moving.velocity.refs().each(|column| L::arrays(column).0);
    let of =
        |rows: [&[L::Array]; 3], body: usize| Vec3::<L>::from_arrays(rows.each(|row| row[body]));
    let bodies = place[0].len();
    for a in 0..bodies {
        let (center, own) = (of(place, a), radius.load::<L>(a));
        for (feature, fixed) in setting.features.alone().iter().enumerate() {
            let gap = fixed.clearance(center, own).gap;
            let mut is_near = gap.le(way);
            if is_near.any() {
                is_near = gap.le(bound(of(velocity, a).length_squared(), change) * dt);
            }
            for lane in ones(is_near.bits()) {
                at_feature(setting, pack, (a, feature as u32), lane, &mut found[lane]);
            }
        }
        if !setting.plan.has_pairs {
            continue;
        }
        let reach_of_way = own + (way + way);
        for b in a + 1..bodies {
            let offset = center - of(place, b);
            let other = radius.load::<L>(b);
            let swept = reach_of_way + other;
            let is_near = offset.length_squared().le(swept * swept);
            if is_near.any() {
                let relative = of(velocity, a) - of(velocity, b);
                let PastContact { met, ago } = met_since(offset, relative, own + other, dt);
                let met = met & is_near & ago.ge(L::ZERO);
                for lane in ones(met.bits()) {
                    let ago = ago.to_array().as_ref()[lane];
                    let rank = Rank::of_pair(a as u32, b as u32);
                    found[lane].push(ContactInStep { rank, a: a as u32, b: b as u32, ago });
                }
            }
        }
    }
}

/// The first contact of a body with something fixed.
#[inline(never)]
fn at_feature<T: Real>(
    setting: &Setting<T>,
    pack: &Pack<T>,
    (body, number): (usize, u32),
    lane: usize,
    found: &mut Vec<ContactInStep<T>>,
) {
    let moving = &pack.moving;
    let gravity = pack.gravity.refs().each(|column| column[lane]).into();
    let dt = moving.dt[lane];
    let path = Path::new(setting.plan.integrator, setting.plan.impact, gravity, dt);
    let end = (pack.position_of(body, lane), path.end_velocity(moving.velocity_of(body, lane)));
    let radius = pack.radius.column[pack.radius.index(moving.width, body, lane)];
    let feature = setting.features.at(number);
    let ago = path.contact(&feature, end, radius, dt, false);
    if let Some(ago) = ago.filter(|ago| *ago >= T::ZERO) {
        let a = body as u32;
        let rank = Rank::of_surroundings(a, setting.features.surface_of(number));
        found.push(ContactInStep { rank, a, b: number, ago });
    }
}

/// Puts the scene of a lane onto the stage; spins also where only events tell them.
#[inline(never)]
fn enter<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    pack: &mut Pack<T>,
    lane: usize,
    state: &mut State<T>,
    has_events: bool,
) {
    let Pack { position, low, radius, moving, .. } = pack;
    let width = L::WIDTH;
    let copy = |from: &Column<T>, to: &mut Column<T>| {
        let from = L::arrays(from).0;
        for body in 0..to.len().min(from.len()) {
            to[body] = from[body].as_ref()[lane];
        }
    };
    let copy_all = |from: &[Column<T>], to: &mut [Column<T>]| {
        to.iter_mut().zip(from).for_each(|(to, from)| copy(from, to));
    };
    copy_all(position, &mut state.position);
    copy_all(&moving.velocity, &mut state.velocity);
    if let Some(lows) = &mut state.low {
        copy_all(low, &mut lows.position);
        copy_all(&moving.low, &mut lows.velocity);
    }
    let len = setting.plan.bodies;
    let figure = |values: &Values<T>, to: &mut PerBody<T>, of: fn(T) -> T| match to {
        PerBody::Each(column) if !values.is_same => {
            copy(&values.column, column);
            column.iter_mut().for_each(|value| *value = of(*value));
        }
        _ => *to = values.of((width, len), lane).map(of),
    };
    figure(radius, &mut state.radius, |radius| radius);
    figure(&moving.mass, &mut state.inverse_mass, |mass| T::ONE / mass);
    if setting.plan.changes_spins {
        figure(&moving.inertia, &mut state.inverse_inertia, |inertia| T::ONE / inertia);
        if let Some(rows) = &mut state.orientation {
            copy_all(&moving.orientation, &mut **rows);
        }
        let orientations = &mut moving.seats[lane].orientations;
        core::mem::swap(&mut state.orientations, orientations);
    }
    if setting.plan.changes_spins || has_events {
        match moving.spin[0].is_empty() {
            true => state.spin.iter_mut().for_each(|column| column.fill(T::ZERO)),
            false => copy_all(&moving.spin, &mut state.spin),
        }
    }
}

/// Puts the bodies that have collided back into their lane.
#[inline(never)]
fn leave<L: Lane<Scalar = T>, T: Real>(pack: &mut Pack<T>, lane: usize, stage: &mut Stage<T>) {
    let Pack { position, low, moving, .. } = pack;
    let (struck, state) = stage.outcome();
    let put = |from: &[Column<T>], to: &mut [Column<T>]| {
        for (from, to) in from.iter().zip(to).filter(|(from, _)| !from.is_empty()) {
            let to = L::arrays_mut(to).0;
            for &body in struck {
                to[body as usize].as_mut()[lane] = from[body as usize];
            }
        }
    };
    put(&state.position, position);
    put(&state.velocity, &mut moving.velocity);
    if let Some(lows) = &state.low {
        put(&lows.position, low);
        put(&lows.velocity, &mut moving.low);
    }
    if let (true, Some(rows)) = (state.orientations.is_counted(), &state.orientation) {
        put(&state.spin, &mut moving.spin);
        put(&**rows, &mut moving.orientation);
        core::mem::swap(&mut state.orientations, &mut moving.seats[lane].orientations);
    }
}
