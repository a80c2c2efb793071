//! Step: all scenes of a pack take steps together.
//!
//! Contacts take effect inside a step (`within`) or at its end. There no body moves while they
//! do, so a contact is found and acts at once, in the order that it has in a scene alone: body
//! by body, what is fixed before other bodies, each by its index. An impulse reaches only the
//! lanes that touch.

use super::meet::{Meeting, With, take_effect};
use super::moving::{Moving, Values};
use super::pack::Pack;
use super::setting::Setting;
use super::within::{self, Meetings};
use crate::bodies::Columns3;
use crate::contact::with_law;
use crate::engine::Event;
use crate::engine::stepped::in_lanes;
use crate::lane::{Lane, Mask};
use crate::motion::Integrator;
use crate::motion::flight::compensated_step;
use crate::motion::integrator::{
    Coasting, ExplicitEuler, FlightStep, SemiImplicitEuler, VelocityVerlet,
};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::Summation;
use crate::vec3::Vec3;

/// The collisions of a pack, each with the number of its scene.
pub type Events<T> = Vec<(usize, Event<T>)>;

/// What a pack's contacts do in a step.
type Contacts<'a, T> = &'a mut dyn FnMut(&mut Pack<T>, Option<&mut Events<T>>);

/// Takes steps with a pack, with contacts within them if there are `meetings`, and writes the
/// collisions down where that is asked for.
pub fn advance<T: Real>(
    setting: &Setting<T>,
    pack: &mut Pack<T>,
    meetings: Option<&mut Meetings<T>>,
    steps: u64,
    events: Option<&mut Events<T>>,
) {
    in_lanes!(sweep setting.width, take_steps::<T>(setting, pack, meetings, steps, events));
}

fn take_steps<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    pack: &mut Pack<T>,
    meetings: Option<&mut Meetings<T>>,
    steps: u64,
    mut events: Option<&mut Events<T>>,
) {
    let is_compensated = setting.plan.summation == Summation::Compensated;
    let fly = match (setting.plan.has_field, setting.plan.integrator) {
        (false, _) => flight::<L, Coasting>(is_compensated),
        (true, Integrator::SemiImplicitEuler) => flight::<L, SemiImplicitEuler>(is_compensated),
        (true, Integrator::ExplicitEuler) => flight::<L, ExplicitEuler>(is_compensated),
        (true, Integrator::VelocityVerlet) => flight::<L, VelocityVerlet>(is_compensated),
    };
    pack.moving.begin();
    let mut step = |contacts: Contacts<'_, T>| {
        for _ in 0..steps {
            fly(pack);
            pack.moving.count_step();
            contacts(pack, events.as_deref_mut());
        }
    };
    match meetings {
        Some(meetings) => step(&mut |pack, events| {
            within::contacts::<L, T>(setting, pack, meetings, events);
        }),
        None => with_law!(setting.plan.surface, law => {
            let act = |moving: &mut Moving<T>, met: &Meeting<L>, events: Option<&mut Events<T>>| {
                take_effect(setting, law, moving, met, events);
            };
            step(&mut |pack, events| contacts::<L, T>(setting, pack, &act, events));
        }),
    }
    pack.moving.end();
    let broken = !finite::<L>(pack);
    if broken.any() {
        pack.note_broken(broken.bits());
    }
}

/// The lanes in which all places and velocities are numbers.
fn finite<L: Lane>(pack: &Pack<L::Scalar>) -> L::Mask {
    let mut sum = L::ZERO;
    for column in pack.position.iter().chain(&pack.moving.velocity) {
        for &values in L::arrays(column).0 {
            sum = sum + L::from_array(values) * L::ZERO;
        }
    }
    sum.same(L::ZERO)
}

/// How all bodies of a pack fly through a step.
fn flight<L: Lane, I: FlightStep>(is_compensated: bool) -> fn(&mut Pack<L::Scalar>) {
    if is_compensated { fly_compensated::<L, I> } else { fly::<L, I> }
}

/// Vectors of the same body of all scenes, one after the other.
type Rows<'a, L> = [&'a mut [<L as Lane>::Array]; 3];

#[inline(always)]
fn rows<L: Lane>(columns: &mut Columns3<L::Scalar>) -> Rows<'_, L> {
    columns.muts().each(|column| L::arrays_mut(column).0)
}

#[inline(always)]
fn row<L: Lane>([x, y, z]: &Rows<'_, L>, body: usize) -> Vec3<L> {
    Vec3::from_arrays([x[body], y[body], z[body]])
}

#[inline(always)]
fn set_row<L: Lane>([x, y, z]: &mut Rows<'_, L>, body: usize, value: Vec3<L>) {
    [x[body], y[body], z[body]] = value.to_arrays();
}

/// The acceleration and the length of a step of each scene.
#[inline(always)]
fn field<L: Lane>(pack: &Pack<L::Scalar>) -> (Vec3<L>, L) {
    let [x, y, z] = pack.gravity.refs().each(|column| L::load(column));
    (Vec3::new(x, y, z), L::load(&pack.moving.dt))
}

#[inline(never)]
fn fly<L: Lane, I: FlightStep>(pack: &mut Pack<L::Scalar>) {
    let (acceleration, dt) = field::<L>(pack);
    let mut position = rows::<L>(&mut pack.position);
    let mut velocity = rows::<L>(&mut pack.moving.velocity);
    for body in 0..position[0].len() {
        let (center, before) = (row(&position, body), row(&velocity, body));
        let (center, after) = I::step(center, before, acceleration, dt);
        set_row(&mut position, body, center);
        if I::CHANGES_VELOCITY {
            set_row(&mut velocity, body, after);
        }
    }
}

#[inline(never)]
fn fly_compensated<L: Lane, I: FlightStep>(pack: &mut Pack<L::Scalar>) {
    let (acceleration, dt) = field::<L>(pack);
    let mut position = rows::<L>(&mut pack.position);
    let mut low = rows::<L>(&mut pack.low);
    let mut velocity = rows::<L>(&mut pack.moving.velocity);
    let mut kicks = rows::<L>(&mut pack.moving.low);
    for body in 0..position[0].len() {
        let places = [row(&position, body), row(&low, body)];
        let kick = if I::CHANGES_VELOCITY { row(&kicks, body) } else { Vec3::ZERO };
        let velocities = [row(&velocity, body), kick];
        let [places, velocities] = compensated_step::<L, I>(places, velocities, acceleration, dt);
        set_row(&mut position, body, places[0]);
        set_row(&mut low, body, places[1]);
        if I::CHANGES_VELOCITY {
            set_row(&mut velocity, body, velocities[0]);
            set_row(&mut kicks, body, velocities[1]);
        }
    }
}

/// What a contact does.
type Act<'a, L, T> = &'a dyn Fn(&mut Moving<T>, &Meeting<L>, Option<&mut Events<T>>);

/// Finds what touches, body by body, and lets it take effect. Laws have no kernels of their
/// own here.
#[inline(never)]
fn contacts<L: Lane<Scalar = T>, T: Real>(
    setting: &Setting<T>,
    pack: &mut Pack<T>,
    act: Act<'_, L, T>,
    mut events: Option<&mut Events<T>>,
) {
    let Pack { position, radius, moving, .. } = pack;
    let [x, y, z] = position.refs().each(|column| L::arrays(column).0);
    for a in 0..x.len() {
        let center = Vec3::<L>::from_arrays([x[a], y[a], z[a]]);
        let own = radius.load::<L>(a);
        for (feature, fixed) in setting.features.alone().iter().enumerate() {
            let clearance = fixed.clearance(center, own);
            let touching = clearance.gap.le(L::ZERO);
            if touching.any() {
                let with = With::Feature(feature);
                let radii = [own; 2];
                let met = Meeting { a, with, center, offset: clearance.arm, radii, touching };
                act(moving, &met, events.as_deref_mut());
            }
        }
        if setting.plan.has_pairs {
            let places = [x, y, z];
            let events = events.as_deref_mut();
            match radius.is_same {
                true => pairs::<L, T, true>(places, radius, a, moving, act, events),
                false => pairs::<L, T, false>(places, radius, a, moving, act, events),
            }
        }
    }
}

/// The bodies behind a body that touch it; `SAME`: in each scene all have one radius.
#[inline(always)]
fn pairs<L: Lane<Scalar = T>, T: Real, const SAME: bool>(
    [x, y, z]: [&[L::Array]; 3],
    radius: &Values<T>,
    a: usize,
    moving: &mut Moving<T>,
    act: Act<'_, L, T>,
    mut events: Option<&mut Events<T>>,
) {
    let center = Vec3::<L>::from_arrays([x[a], y[a], z[a]]);
    let radii = L::arrays(&radius.column).0;
    let own = radius.load::<L>(a);
    let others = x[a + 1..].iter().zip(&y[a + 1..]).zip(&z[a + 1..]);
    for (b, ((x, y), z)) in (a + 1..).zip(others) {
        let offset = center - Vec3::from_arrays([*x, *y, *z]);
        let other = if SAME { own } else { L::from_array(radii[b]) };
        let reach = own + other;
        let touching = offset.length_squared().le(reach * reach);
        if touching.any() {
            let with = With::Body(b);
            let met = Meeting { a, with, center, offset, radii: [own, other], touching };
            act(moving, &met, events.as_deref_mut());
        }
    }
}
