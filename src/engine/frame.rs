//! Frame: the origin and the units that an engine computes in.
//!
//! Numbers have most digits near 0, and products of lengths, speeds and masses leave
//! the range of numbers long before these do. A scene that is far from its origin, or
//! in units far from its own sizes, is therefore computed in a frame of its own: moved
//! by a vector that rounds no coordinate, and scaled by powers of two. What comes out is
//! moved and scaled back. All other scenes are computed as they are.

use super::account::{Effort, Totals};
use super::interface::{Engine, EventEngine, StepEngine, Stretch};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot};
use super::{EngineError, Event, Listener, PartTotals, Partner, Plan};
use crate::bodies::{Bodies, Columns3, PerBody};
use crate::column::Column;
use crate::compensated::two_sum;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::Scene;
use crate::space::PeriodicBox;
use crate::surroundings::Placement;
use crate::vec3::Vec3;

/// A scene is far away along an axis where its coordinates are all greater than this
/// many times their differences.
const FAR: i32 = 64;

/// Units are far from a scene's own where a binary exponent is greater than this.
const MOST_EXPONENT: i32 = 20;

/// The greatest change of a unit, as a binary exponent, in a precision with the range of
/// a double, and of a single. What is farther off leaves the range of numbers.
const MOST_SCALING: [i32; 2] = [500, 64];

/// The greatest binary exponent of a factor, so that its square is a number.
const MOST_SCALED: i32 = 120;

/// A change of origin and of units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<T> {
    /// The origin in the scene's coordinates, length.
    origin: Vec3<T>,
    /// Binary exponents of the engine's units of length, time and mass in those of the
    /// scene.
    length: i32,
    time: i32,
    mass: i32,
}

impl<T: Real> Frame<T> {
    /// The frame that a scene asks for; `None` if it is best computed as it is.
    pub fn of(scene: &Scene<T>) -> Option<Self> {
        let origin = origin(scene);
        let radius = scene.bodies.radius.greatest().to_f64();
        let components = scene.bodies.velocity.iter().flat_map(|column| column.iter());
        // Not squared: it must not leave the range of numbers here.
        let bodies = scene.bodies.len().max(1) as f64;
        let speed = components.map(|v| v.to_f64().abs()).sum::<f64>() / bodies;
        let fallen = (scene.gravity.length().to_f64() * radius).sqrt();
        let speed = if speed.is_finite() { speed.max(fallen) } else { 0.0 };
        let distance = radius.max(extent(scene) / bodies.cbrt());
        let frame = Self {
            origin,
            length: far_exponent::<T>(distance),
            time: if speed > 0.0 { far_exponent::<T>(distance / speed) } else { 0 },
            mass: far_exponent::<T>(scene.bodies.mass.greatest().to_f64()),
        };
        let is_needed = [frame.length, frame.time, frame.mass] != [0; 3] || origin != Vec3::ZERO;
        is_needed.then_some(frame)
    }

    /// A scene as the engine sees it.
    pub fn enter(&self, mut scene: Scene<T>) -> Scene<T> {
        let length = factor::<T>(-self.length);
        let moved = |point: Vec3<T>| (point - self.origin) * length;
        scene.gravity = scaled(scene.gravity, 2 * self.time - self.length);
        scene.periodic = scene.periodic.map(|PeriodicBox { lower, upper }| PeriodicBox {
            lower: moved(lower),
            upper: moved(upper),
        });
        let placement = Placement::NONE.scaled(length).moved(-(self.origin * length));
        for shape in &mut scene.surroundings {
            *shape = shape.placed(&placement);
        }
        scene.stepped.dt = scene.stepped.dt.map(|dt| dt * power(-self.time));
        let origin = self.origin.to_array();
        for (column, origin) in scene.bodies.position.iter_mut().zip(origin) {
            column.iter_mut().for_each(|x| *x = (*x - origin) * length);
        }
        self.scale_bodies(&mut scene.bodies, -1);
        scene
    }

    /// Bodies in the scene's own coordinates and units.
    fn leave(&self, mut bodies: Bodies<T>) -> Bodies<T> {
        self.leave_centers(&mut bodies.position);
        self.scale_bodies(&mut bodies, 1);
        bodies.left_by_world()
    }

    /// Centres in the scene's own coordinates and units.
    fn leave_centers(&self, centers: &mut Columns3<T>) {
        let length = factor::<T>(self.length);
        for (column, origin) in centers.iter_mut().zip(self.origin.to_array()) {
            column.iter_mut().for_each(|x| *x = *x * length + origin);
        }
    }

    /// Scales all but positions by the units or, with -1, by their inverses.
    fn scale_bodies(&self, bodies: &mut Bodies<T>, sign: i32) {
        let each = |columns: &mut Columns3<T>, exponent: i32| {
            for column in columns {
                scale_column(column, sign * exponent);
            }
        };
        let figure = |figure: &mut PerBody<T>, exponent: i32| match figure {
            PerBody::Same(value) => *value = scaled_real(*value, sign * exponent),
            PerBody::Each(column) => scale_column(column, sign * exponent),
        };
        each(&mut bodies.velocity, self.length - self.time);
        each(&mut bodies.spin, -self.time);
        figure(&mut bodies.radius, self.length);
        figure(&mut bodies.mass, self.mass);
        figure(&mut bodies.inertia, self.mass + 2 * self.length);
    }

    /// An event in the scene's own coordinates and units.
    fn leave_event(&self, event: &Event<T>) -> Event<T> {
        let speed = self.length - self.time;
        let impulse = self.mass + speed;
        Event {
            time: event.time * power(self.time),
            a: event.a,
            partner: match event.partner {
                Partner::Body { index, velocity, spin } => Partner::Body {
                    index,
                    velocity: scaled(velocity, speed),
                    spin: scaled(spin, -self.time),
                },
                Partner::Surroundings(part) => Partner::Surroundings(part),
            },
            point: scaled(event.point, self.length) + self.origin,
            normal: event.normal,
            normal_impulse: scaled_real(event.normal_impulse, impulse),
            tangential_impulse: scaled(event.tangential_impulse, impulse),
            velocity: scaled(event.velocity, speed),
            spin: scaled(event.spin, -self.time),
        }
    }

    fn leave_error(&self, error: EngineError) -> EngineError {
        let at = |time: f64| time * power(self.time);
        match error {
            EngineError::Stalled { time, events, body } => {
                EngineError::Stalled { time: at(time), events, body }
            }
            EngineError::TooFast { time } => EngineError::TooFast { time: at(time) },
            EngineError::NoDuration(time) => EngineError::NoDuration(at(time)),
            other => other,
        }
    }
}

/// The corner of a scene's space with the least coordinates along the axes along which
/// it is far away, and 0 along the others.
fn origin<T: Real>(scene: &Scene<T>) -> Vec3<T> {
    let mut origin = [T::ZERO; 3];
    let radius = scene.bodies.radius.greatest();
    let points: Vec<Vec3<T>> = scene
        .periodic
        .map_or(Vec::new(), |PeriodicBox { lower, upper }| vec![lower, upper])
        .into_iter()
        .chain(scene.surroundings.iter().flat_map(|shape| shape.points()))
        .collect();
    for (axis, origin) in origin.iter_mut().enumerate() {
        let points = points.iter().map(|point| point.to_array()[axis]);
        let coordinates = || scene.bodies.position[axis].iter().copied().chain(points.clone());
        let Some([least, greatest]) = ends(coordinates()) else { return Vec3::ZERO };
        let nearest = least.abs().lesser(greatest.abs());
        let is_far = nearest > T::whole(FAR) * ((greatest - least) + radius)
            && (least > T::ZERO) == (greatest > T::ZERO);
        if is_far && coordinates().all(|x| two_sum(x, -least).1 == T::ZERO) {
            *origin = least;
        }
    }
    origin.into()
}

/// The least and the greatest of some coordinates.
fn ends<T: Real>(coordinates: impl Iterator<Item = T>) -> Option<[T; 2]> {
    let pairs = coordinates.map(|x| [x, x]);
    pairs.reduce(|[a, b], [c, d]| [a.lesser(c), b.greater(d)])
}

/// The longest side of the box around all centres, length.
fn extent<T: Real>(scene: &Scene<T>) -> f64 {
    let columns = scene.bodies.position.iter();
    let ends = columns.filter_map(|column| ends(column.iter().copied()));
    ends.map(|[least, greatest]| greatest.to_f64() - least.to_f64()).fold(0.0, f64::max)
}

/// The binary exponent of a figure if it is far from 1, otherwise 0.
fn far_exponent<T: Real>(value: f64) -> i32 {
    if value <= 0.0 || !value.is_finite() {
        return 0;
    }
    // By its bits: a platform's logarithm may round across a whole number.
    let exponent = (value.to_bits() >> 52) as i32 - 1023;
    if exponent.abs() <= MOST_EXPONENT {
        return 0;
    }
    let [double, single] = MOST_SCALING;
    let is_double = factor::<T>(double).is_finite();
    let most = if is_double { double } else { single };
    exponent.clamp(-most, most)
}

/// `2^exponent` as far as an `f64` goes.
fn power(exponent: i32) -> f64 {
    2.0_f64.powi(exponent.clamp(-1022, 1023))
}

fn factor<T: Real>(exponent: i32) -> T {
    T::from_f64(power(exponent))
}

/// A real times a power of two, in two steps where the power itself is no number.
fn scaled_real<T: Real>(value: T, exponent: i32) -> T {
    let first = exponent.clamp(-MOST_SCALED, MOST_SCALED);
    let rest = exponent - first;
    let value = value * factor(first);
    if rest == 0 { value } else { scaled_real(value, rest) }
}

fn scaled<T: Real>(vector: Vec3<T>, exponent: i32) -> Vec3<T> {
    vector.to_array().each(|x| scaled_real(x, exponent)).into()
}

fn scale_column<T: Real>(column: &mut Column<T>, exponent: i32) {
    if exponent != 0 {
        column.iter_mut().for_each(|x| *x = scaled_real(*x, exponent));
    }
}

/// An engine that computes in a frame of its own.
#[derive(Debug)]
pub(super) struct Framed<T, E: ?Sized> {
    pub frame: Frame<T>,
    pub engine: Box<E>,
}

impl<T: Real, E: Engine<T> + ?Sized> Engine<T> for Framed<T, E> {
    fn plan(&self) -> &Plan {
        self.engine.plan()
    }

    fn gravity(&self) -> Vec3<T> {
        scaled(self.engine.gravity(), self.frame.length - 2 * self.frame.time)
    }

    fn time(&self) -> f64 {
        self.engine.time() * power(self.frame.time)
    }

    fn totals(&self) -> Totals {
        let Frame { length, time, mass, .. } = self.frame;
        let Totals { collisions, virial, impulse } = self.engine.totals();
        Totals {
            collisions,
            virial: virial * power(mass + 2 * length - time),
            impulse: impulse.each(|impulse| impulse * power(mass + length - time)),
        }
    }

    fn parts(&self) -> Vec<PartTotals> {
        let Frame { length, time, mass, .. } = self.frame;
        let mut parts = self.engine.parts();
        for part in &mut parts {
            let unit = power(mass + length - time);
            part.impulse = part.impulse.each(|impulse| impulse * unit);
            part.normal_impulse *= unit;
            part.area = part.area.map(|area| area * power(2 * length));
        }
        parts
    }

    fn bodies(&self) -> Bodies<T> {
        self.frame.leave(self.engine.bodies())
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        self.engine.save()
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        self.engine.restore(saved)
    }

    fn finer_bodies(&self) -> Option<Bodies<f64>> {
        let Frame { origin, length, time, mass } = self.frame;
        let is_finer = T::EPSILON.to_f64() > f64::EPSILON && origin != Vec3::ZERO;
        let frame = Frame { origin: origin.cast::<f64>(), length, time, mass };
        is_finer.then(|| frame.leave(self.engine.bodies().cast()))
    }

    fn bytes(&self) -> usize {
        self.engine.bytes()
    }
}

impl<T: Real, E: StepEngine<T> + ?Sized> StepEngine<T> for Framed<T, E> {
    fn dt(&self) -> T {
        scaled_real(self.engine.dt(), self.frame.time)
    }

    fn exact_dt(&self) -> f64 {
        self.engine.exact_dt() * power(self.frame.time)
    }

    fn steps(&self) -> u64 {
        self.engine.steps()
    }

    fn centers(&self) -> Columns3<T> {
        let mut centers = self.engine.centers();
        self.frame.leave_centers(&mut centers);
        centers
    }

    fn take_steps(&mut self, steps: u64, on_event: Listener<'_, T>) {
        let Self { engine, frame } = self;
        match on_event {
            None => engine.take_steps(steps, None),
            Some(on_event) => {
                engine.take_steps(steps, Some(&mut |event| on_event(&frame.leave_event(event))));
            }
        }
    }
}

impl<T: Real, E: EventEngine<T> + ?Sized> EventEngine<T> for Framed<T, E> {
    fn advance_to(
        &mut self,
        time: f64,
        stretch: Stretch,
        on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        let Self { engine, frame } = self;
        let time = time * power(-frame.time);
        let done = match on_event {
            None => engine.advance_to(time, stretch, None),
            Some(on_event) => {
                let mut listener = |event: &Event<T>| on_event(&frame.leave_event(event));
                engine.advance_to(time, stretch, Some(&mut listener))
            }
        };
        done.map_err(|error| frame.leave_error(error))
    }

    fn mean_free_path(&self) -> Option<f64> {
        self.engine.mean_free_path().map(|path| path * power(self.frame.length))
    }

    fn effort(&self) -> Effort {
        self.engine.effort()
    }

    fn take_out(&mut self, index: u32) -> Option<Bodies<T>> {
        self.engine.take_out(index).map(|taken| self.frame.leave(taken))
    }
}
