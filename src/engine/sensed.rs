//! Sensed: an engine whose bodies are watched by sensors.
//!
//! A sensor looks at free flights from outside of the engine: those that collisions end, as
//! the listener hears of them, or the ways of whole steps. So it changes no bit of a run,
//! and a scene without sensors has nothing of this. Passages are found in double precision
//! whatever the engine's is. Events are the same in every order, on all lanes and threads:
//! so are counts.
//!
//! On which side of a sensor a body is, is remembered. Where a flight begins it is taken from
//! the place only if it is wrong beyond rounding, and then counted.

use core::marker::PhantomData;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::account::{Effort, Totals};
use super::interface::{Engine, EventEngine, StepEngine, Stretch};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, Snapshot};
use super::{EngineError, Event, Listener, PartTotals, Partner, Plan};
use crate::bodies::{Bodies, Columns3, PerBody};
use crate::contact::FreeFlight;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::surroundings::{Gate, Passages};
use crate::vec3::Vec3;

/// The sensors of a scene, and what they have seen.
#[derive(Debug)]
struct Watch {
    /// By the parts that they are.
    gates: Vec<(u32, Gate<f64>)>,
    pull: Option<Vec3<f64>>,
    /// The relative precision of places.
    rounding: f64,
    /// Of all bodies, or of each.
    radii: Vec<f64>,
    seen: Seen,
}

/// What has to be remembered: a snapshot keeps it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub(super) struct Seen {
    /// By sensor, of the flights that have ended.
    passages: Vec<Passages>,
    /// By body.
    flights: Vec<Begun>,
    /// By body, and of each by sensor: on which side it is where its flight begins.
    is_inside: Vec<bool>,
}

/// A flight from where it begins.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
struct Begun {
    center: [f64; 3],
    velocity: [f64; 3],
    /// Infinite of a body that was taken out.
    since: f64,
}

impl Begun {
    /// Up to another time.
    fn flight(&self, pull: Option<Vec3<f64>>) -> FreeFlight<f64> {
        FreeFlight {
            center: self.center.into(),
            velocity: self.velocity.into(),
            acceleration: pull,
            radius: 0.0,
            is_leaving: false,
        }
    }
}

impl Watch {
    /// Of a scene at its start; `None` without sensors.
    fn of<T: Real>(scene: &Scene<T>) -> Option<Self> {
        let gates = (0..).zip(&scene.surroundings);
        let gates: Vec<(u32, Gate<f64>)> =
            gates.filter_map(|(part, shape)| Some((part, shape.cast().sensed()?))).collect();
        if gates.is_empty() {
            return None;
        }
        let bodies = &scene.bodies;
        let begun = |body| Begun {
            center: bodies.position_of(body).cast().to_array(),
            velocity: bodies.velocity_of(body).cast().to_array(),
            since: 0.0,
        };
        let flights: Vec<Begun> = (0..bodies.len()).map(begun).collect();
        let sides = |begun: &Begun| {
            let center = Vec3::from(begun.center);
            gates.iter().map(move |(_, gate)| gate.is_inside(center))
        };
        let is_inside = flights.iter().flat_map(sides).collect();
        let radii = match &bodies.radius {
            PerBody::Same(radius) => vec![radius.to_f64()],
            PerBody::Each(radii) => radii.iter().map(|radius| radius.to_f64()).collect(),
        };
        let has_field = scene.gravity != Vec3::ZERO;
        Some(Self {
            pull: has_field.then(|| scene.gravity.cast()),
            rounding: T::EPSILON.to_f64(),
            radii,
            seen: Seen { passages: vec![Passages::default(); gates.len()], flights, is_inside },
            gates,
        })
    }

    fn radius(&self, body: usize) -> f64 {
        self.radii.get(body).copied().unwrap_or(self.radii[0])
    }

    /// A collision ends the flights of its bodies.
    fn collision<T: Real>(&mut self, event: &Event<T>) {
        let point = event.point.cast::<f64>();
        let normal = event.normal.cast::<f64>();
        let mut ends = |body: u32, sign: f64, velocity: Vec3<T>| {
            let body = body as usize;
            let center = point + normal * (sign * self.radius(body));
            self.ends(body, (event.time, self.pull), center, velocity.cast());
        };
        ends(event.a, 1.0, event.velocity);
        if let Partner::Body { index, velocity, .. } = event.partner {
            ends(index, -1.0, velocity);
        }
    }

    /// The flight of a body, in a field or none, ends at a time; the next one begins there.
    fn ends(
        &mut self,
        body: usize,
        (time, pull): (f64, Option<Vec3<f64>>),
        center: Vec3<f64>,
        velocity: Vec3<f64>,
    ) {
        let Seen { passages, flights, is_inside } = &mut self.seen;
        let begun = flights[body];
        let flight = begun.flight(pull);
        let sides = is_inside.chunks_exact_mut(self.gates.len()).nth(body);
        let sides = sides.into_iter().flatten();
        for (((_, gate), side), passages) in self.gates.iter().zip(sides).zip(passages) {
            let (passed, now_inside) = gate.passages(&flight, time - begun.since, *side);
            *passages += passed;
            *side = now_inside;
            if let Some(missed) = gate.corrects(center, now_inside, self.rounding) {
                *passages += missed;
                *side = !now_inside;
            }
        }
        flights[body] =
            Begun { center: center.to_array(), velocity: velocity.to_array(), since: time };
    }

    /// Bodies have moved in a step, each on a straight way.
    fn step<T: Real>(&mut self, centers: &Columns3<T>) {
        let [x, y, z] = centers;
        for (body, ((x, y), z)) in x.iter().zip(y.iter()).zip(z.iter()).enumerate() {
            let center = Vec3::new(x.to_f64(), y.to_f64(), z.to_f64());
            let begun = &mut self.seen.flights[body];
            begun.velocity = (center - Vec3::from(begun.center)).to_array();
            begun.since = 0.0;
            self.ends(body, (1.0, None), center, Vec3::ZERO);
        }
    }

    /// Fills in what was counted; with the flights under way up to now.
    fn count(&self, parts: &mut [PartTotals], now: Option<f64>) {
        let mut counts = self.seen.passages.clone();
        let sides = self.seen.is_inside.chunks_exact(self.gates.len());
        let flights = self.seen.flights.iter().zip(sides);
        for (begun, sides) in flights.filter(|(begun, _)| begun.since.is_finite()) {
            let Some(now) = now else { break };
            let flight = begun.flight(self.pull);
            for (((_, gate), side), count) in self.gates.iter().zip(sides).zip(&mut counts) {
                *count += gate.passages(&flight, now - begun.since, *side).0;
            }
        }
        for ((part, _), count) in self.gates.iter().zip(counts) {
            if let Ok(at) = parts.binary_search_by_key(part, |totals| totals.part) {
                parts[at].passages = Some(count);
            }
        }
    }

    fn bytes(&self) -> usize {
        let Seen { passages, flights, is_inside } = &self.seen;
        size_of_val(passages.as_slice())
            + size_of_val(flights.as_slice())
            + size_of_val(is_inside.as_slice())
            + size_of_val(self.radii.as_slice())
    }
}

/// An engine that is watched.
#[derive(Debug)]
pub(super) struct Sensed<T: Real, E: ?Sized> {
    watch: Watch,
    precision: PhantomData<T>,
    engine: Box<E>,
}

/// The engine that `start` makes of a scene, watched by its sensors if it has any.
pub(super) fn event_driven<T: Real>(
    scene: Scene<T>,
    start: impl FnOnce(Scene<T>) -> Result<Box<dyn EventEngine<T>>, EngineError>,
) -> Result<Box<dyn EventEngine<T>>, EngineError> {
    let Some(watch) = Watch::of(&scene) else { return start(scene) };
    Ok(Box::new(Sensed { watch, precision: PhantomData, engine: start(scene)? }))
}

/// The same by steps.
pub(super) fn stepped<T: Real>(
    scene: Scene<T>,
    start: impl FnOnce(Scene<T>) -> Result<Box<dyn StepEngine<T>>, EngineError>,
) -> Result<Box<dyn StepEngine<T>>, EngineError> {
    let Some(watch) = Watch::of(&scene) else { return start(scene) };
    Ok(Box::new(Sensed { watch, precision: PhantomData, engine: start(scene)? }))
}

impl<T: Real, E: Engine<T> + ?Sized> Engine<T> for Sensed<T, E> {
    fn plan(&self) -> &Plan {
        self.engine.plan()
    }

    fn gravity(&self) -> Vec3<T> {
        self.engine.gravity()
    }

    fn time(&self) -> f64 {
        self.engine.time()
    }

    fn totals(&self) -> Totals {
        self.engine.totals()
    }

    fn parts(&self) -> Vec<PartTotals> {
        let mut parts = self.engine.parts();
        let is_stepped = self.plan().engine == EngineKind::Stepped;
        self.watch.count(&mut parts, (!is_stepped).then(|| self.time()));
        parts
    }

    fn bodies(&self) -> Bodies<T> {
        self.engine.bodies()
    }

    #[cfg(feature = "files")]
    fn save(&self) -> Snapshot {
        Snapshot { seen: Some(Box::new(self.watch.seen.clone())), ..self.engine.save() }
    }

    #[cfg(feature = "files")]
    fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        let own = &mut self.watch.seen;
        let seen = saved.seen.as_ref().filter(|seen| {
            seen.passages.len() == own.passages.len()
                && seen.flights.len() == own.flights.len()
                && seen.is_inside.len() == own.is_inside.len()
        });
        own.clone_from(seen.ok_or(Misfit("sensors"))?);
        self.engine.restore(saved)
    }

    fn finer_bodies(&self) -> Option<Bodies<f64>> {
        self.engine.finer_bodies()
    }

    fn bytes(&self) -> usize {
        self.watch.bytes() + self.engine.bytes()
    }
}

impl<T: Real> StepEngine<T> for Sensed<T, dyn StepEngine<T>> {
    fn dt(&self) -> T {
        self.engine.dt()
    }

    fn exact_dt(&self) -> f64 {
        self.engine.exact_dt()
    }

    fn steps(&self) -> u64 {
        self.engine.steps()
    }

    fn centers(&self) -> Columns3<T> {
        self.engine.centers()
    }

    fn take_steps(&mut self, steps: u64, mut on_event: Listener<'_, T>) {
        for _ in 0..steps {
            match &mut on_event {
                None => self.engine.take_steps(1, None),
                Some(on_event) => self.engine.take_steps(1, Some(&mut **on_event)),
            }
            self.watch.step(&self.engine.centers());
        }
    }
}

impl<T: Real> EventEngine<T> for Sensed<T, dyn EventEngine<T>> {
    fn advance_to(
        &mut self,
        time: f64,
        stretch: Stretch,
        mut on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        let Self { watch, engine, .. } = self;
        let mut listener = |event: &Event<T>| {
            watch.collision(event);
            if let Some(on_event) = &mut on_event {
                on_event(event);
            }
        };
        engine.advance_to(time, stretch, Some(&mut listener))
    }

    fn mean_free_path(&self) -> Option<f64> {
        self.engine.mean_free_path()
    }

    fn effort(&self) -> Effort {
        self.engine.effort()
    }

    fn take_out(&mut self, index: u32) -> Option<Bodies<T>> {
        self.watch.seen.flights[index as usize].since = f64::INFINITY;
        self.engine.take_out(index)
    }
}
