//! Meet: a contact takes effect in the lanes that touch.

use super::moving::{Moving, Values};
use super::setting::Setting;
use super::step::Events;
use crate::bodies::Columns3;
use crate::column::Column;
use crate::contact::{Laws, Party, collide, one_material};
use crate::engine::Partner;
use crate::engine::event::Struck;
use crate::lane::{Lane, Mask, ones};
use crate::mat3::Mat3;
use crate::motion::rotation::turned;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// Up to this many lanes a contact is worked out lane by lane, not as a pack of which most
/// is thrown away.
const FEW: u32 = 2;

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum With {
    Body(usize),
    Feature(usize),
}

/// A body that touches something in some lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting<L: Lane> {
    /// The body.
    pub a: usize,
    pub with: With,
    /// The body's centre.
    pub center: Vec3<L>,
    /// To it from the second body's centre, or from the point of contact with what is fixed.
    pub offset: Vec3<L>,
    /// The radii of both bodies.
    pub radii: [L; 2],
    pub touching: L::Mask,
}

impl<L: Lane> Meeting<L> {
    /// What of it is in one lane.
    fn in_lane(&self, lane: usize) -> Meeting<L::Scalar> {
        let of = |value: L| value.to_array().as_ref()[lane];
        let vector = |vector: Vec3<L>| Vec3::from(vector.to_array().each(of));
        Meeting {
            a: self.a,
            with: self.with,
            center: vector(self.center),
            offset: vector(self.offset),
            radii: self.radii.each(of),
            touching: self.touching.bits() >> lane & 1 != 0,
        }
    }

    /// The parts of the offset that are the arms of two bodies.
    #[inline(always)]
    fn shares(&self, are_equal: bool) -> [L; 2] {
        if are_equal {
            return [L::ratio(1, 2); 2];
        }
        let [first, second] = self.radii;
        let reach = first + second;
        [first / reach, second / reach]
    }
}

/// Lets a contact take effect in the lanes that approach: lane by lane where they are few.
pub(super) fn take_effect<L: Lane<Scalar = T>, T: Real, W: Laws<T>>(
    setting: &Setting<T>,
    laws: W,
    moving: &mut Moving<T>,
    met: &Meeting<L>,
    mut events: Option<&mut Events<T>>,
) {
    let velocity = |body: usize| load::<L>(&moving.velocity, body * L::WIDTH);
    let relative = match met.with {
        With::Body(b) => velocity(met.a) - velocity(b),
        With::Feature(_) => velocity(met.a),
    };
    // What has collided overlaps for some steps, and goes apart.
    let collided = met.touching & relative.dot(met.offset).lt(L::ZERO);
    let kind = Kind { setting, laws };
    if collided.bits().count_ones() > FEW {
        kind.collide::<L>(moving, 0, &Meeting { touching: collided, ..*met }, events);
        return;
    }
    for lane in ones(collided.bits()) {
        kind.collide::<T>(moving, lane, &met.in_lane(lane), events.as_deref_mut());
    }
}

/// What contacts follow.
#[derive(Clone, Copy, Debug)]
struct Kind<'a, T: Real, W> {
    setting: &'a Setting<T>,
    laws: W,
}

impl<T: Real, W: Laws<T>> Kind<'_, T, W> {
    /// In some of the lanes from `lane` on.
    #[inline(never)]
    fn collide<L: Lane<Scalar = T>>(
        self,
        moving: &mut Moving<T>,
        lane: usize,
        met: &Meeting<L>,
        events: Option<&mut Events<T>>,
    ) {
        let Meeting { offset, touching, .. } = *met;
        let mut a = self.party::<L>(moving, met.a, lane);
        let mut b = Party::immovable();
        a.share = L::ONE;
        if let With::Body(other) = met.with {
            b = self.party::<L>(moving, other, lane);
            [a.share, b.share] = met.shares(moving.has_equal_radii);
        }
        let before = [a.velocity, b.velocity];
        let impulse = collide(self.laws.between(one_material), offset, &mut a, &mut b);
        self.give(moving, met.a, lane, touching, &a, before[0]);
        if let With::Body(other) = met.with {
            self.give(moving, other, lane, touching, &b, before[1]);
        }
        for k in ones(touching.bits()) {
            let collisions = &mut moving.seats[lane + k].collisions;
            match met.with {
                With::Body(_) => collisions.pairs += 1,
                With::Feature(_) => collisions.surroundings += 1,
            }
        }
        if let Some(events) = events {
            let impulses = [impulse.normal, impulse.tangential];
            self.record(moving, lane, met, impulses, events);
        }
    }

    /// A body of the lanes from `lane` on; its share is still open.
    #[inline(always)]
    fn party<L: Lane<Scalar = T>>(self, moving: &Moving<T>, body: usize, lane: usize) -> Party<L> {
        let start = body * moving.width + lane;
        let inverse = |values: &Values<T>| {
            L::ONE / L::load(&values.column[values.index(moving.width, body, lane)..])
        };
        let spins = W::CHANGES_SPINS;
        Party {
            velocity: load(&moving.velocity, start),
            spin: if spins { load(&moving.spin, start) } else { Vec3::ZERO },
            inverse_mass: inverse(&moving.mass),
            inverse_inertia: if spins { inverse(&moving.inertia) } else { L::ZERO },
            share: L::ZERO,
        }
    }

    /// Gives a body its new motion in the lanes that have collided.
    #[inline(always)]
    fn give<L: Lane<Scalar = T>>(
        self,
        moving: &mut Moving<T>,
        body: usize,
        lane: usize,
        collided: L::Mask,
        party: &Party<L>,
        before: Vec3<L>,
    ) {
        let start = body * moving.width + lane;
        if W::CHANGES_SPINS {
            moving.catch_up::<L>(body, lane, collided);
            let spin = Vec3::select(collided, party.spin, load(&moving.spin, start));
            store(&mut moving.spin, start, spin);
        }
        store(&mut moving.velocity, start, Vec3::select(collided, party.velocity, before));
        if !moving.low[0].is_empty() {
            let low = Vec3::select(collided, Vec3::ZERO, load::<L>(&moving.low, start));
            store(&mut moving.low, start, low);
        }
    }

    /// Writes the events of the lanes that have collided down.
    #[cold]
    fn record<L: Lane<Scalar = T>>(
        self,
        moving: &Moving<T>,
        lane: usize,
        met: &Meeting<L>,
        impulses: [Vec3<L>; 2],
        events: &mut Events<T>,
    ) {
        let [center, offset, normal, tangential] =
            [met.center, met.offset, impulses[0], impulses[1]].each(Vec3::to_arrays);
        for k in (0..L::WIDTH).filter(|k| met.touching.bits() >> k & 1 != 0) {
            let seat = &moving.seats[lane + k];
            let Some(scene) = seat.scene else { continue };
            let of = |arrays: &[L::Array; 3]| Vec3::from(arrays.refs().each(|x| x.as_ref()[k]));
            let [velocity, spin] = moving.motion(met.a, lane + k);
            let (partner, share) = match met.with {
                With::Feature(feature) => {
                    (Partner::Surroundings(self.setting.features.shape_of(feature as u32)), None)
                }
                With::Body(b) => {
                    let [velocity, spin] = moving.motion(b, lane + k);
                    let [share, _] = met.in_lane(k).shares(moving.has_equal_radii);
                    (Partner::Body { index: b as u32, velocity, spin }, Some(share))
                }
            };
            let struck = Struck {
                a: met.a as u32,
                center: of(&center),
                offset: of(&offset),
                share,
                normal: of(&normal),
                tangential: of(&tangential),
                velocity,
                spin,
            };
            let time = moving.steps(lane + k) as f64 * seat.exact_dt;
            events.push((scene, struck.event(time, partner)));
        }
    }
}

impl<T: Real> Moving<T> {
    /// Brings the orientation of a body up to the end of the present step, before its spin
    /// changes, in the lanes that have collided.
    #[inline(always)]
    fn catch_up<L: Lane<Scalar = T>>(&mut self, body: usize, lane: usize, collided: L::Mask) {
        let start = body * self.width + lane;
        let bits = collided.bits();
        let since = L::from_fn(|k| {
            let seat = &self.seats[lane + k];
            let (steps, dt) = (self.steps(lane + k), self.dt[lane + k]);
            let has_collided = bits >> k & 1 != 0;
            if has_collided { seat.orientations.since(body, steps, dt, T::ZERO) } else { T::ZERO }
        });
        let stored = self.orientation.refs().each(|column| L::load(&column[start..]));
        let stored = Mat3::from_rows(stored);
        let after = turned(stored, load(&self.spin, start), since);
        let after = Mat3::select(collided, after, stored).rows();
        for (column, element) in self.orientation.iter_mut().zip(after) {
            element.store(&mut column[start..]);
        }
        for k in (0..L::WIDTH).filter(|k| bits >> k & 1 != 0) {
            let steps = self.steps(lane + k);
            self.seats[lane + k].orientations.mark(body, steps, T::ZERO);
        }
    }

    /// Velocity and angular velocity of a body.
    fn motion(&self, body: usize, lane: usize) -> [Vec3<T>; 2] {
        let index = body * self.width + lane;
        let of = |columns: &Columns3<T>| {
            let value = |column: &Column<T>| column.get(index).copied().unwrap_or(T::ZERO);
            Vec3::from(columns.refs().each(value))
        };
        [of(&self.velocity), of(&self.spin)]
    }
}

#[inline(always)]
fn load<L: Lane>(columns: &Columns3<L::Scalar>, start: usize) -> Vec3<L> {
    let [x, y, z] = columns.refs().each(|column| L::load(&column[start..]));
    Vec3::new(x, y, z)
}

#[inline(always)]
fn store<L: Lane>(columns: &mut Columns3<L::Scalar>, start: usize, value: Vec3<L>) {
    for (column, component) in columns.iter_mut().zip(value.to_array()) {
        component.store(&mut column[start..]);
    }
}
