//! The event-driven engine: every collision at its exact time, in order.
//!
//! Between two collisions a body's path is known in closed form, so nothing is
//! computed until something happens (Alder and Wainwright 1959). Of what is
//! ahead each body keeps its first contacts ([`agenda`]); the calendar says
//! whose turn it is ([`calendar`]); cells say who is near whom ([`cells`]).
//!
//! A contact time is a function of the two flights that lead to it, and of
//! nothing else: not of when it was found, by whom, or in which lanes. Flights
//! start anew at collisions and where a period of time begins; to look at the
//! bodies in between changes no bit of them.

mod agenda;
mod calendar;
mod cells;
mod coarse;
mod collide;
mod crossing;
mod features;
mod flight;
mod look;
mod meeting;
mod near;
mod period;
mod search;
mod turns;

use super::plan::Plan;
use super::tallies::Tallies;
use super::{Collisions, EngineError, Event, Execution, Listener};
use crate::bodies::{Bodies, PerBody};
use crate::compensated::CompensatedSum;
use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::real::Real;
use crate::scene::{EngineKind, Scene};
use crate::space::{OpenSpace, PeriodicBox, Space};
use crate::surroundings::{Feature, features_of};
use crate::vec3::Vec3;
use agenda::{Agenda, Mark};
use calendar::Calendar;
use cells::Cells;
use coarse::Coarse;
use flight::Record;
use meeting::Meetings;
use near::Near;
use search::{Search, further, searcher};

/// What it took to find collisions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Effort {
    /// Pairs whose contact was looked for.
    pub tried: u64,
    /// Those of them that the coarse precision left to the full one.
    pub remaining: u64,
    /// How often bodies crossed from one cell to the next.
    pub crossings: u64,
    /// How often a body's contacts were looked for again, since all that it
    /// knew of had been overtaken.
    pub searches: u64,
}

/// A scene in motion, from collision to collision.
///
/// ```
/// use carom::engine::EventDriven;
/// use carom::scene::{Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
///     .sphere(Sphere::new([2.0, 0.0, 0.0]).radius(0.5))
///     .build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.for_each_event(3.0, |event| assert_eq!(event.time, 1.0))?;
/// assert_eq!(world.bodies().position_of(0).x, 1.0);
/// assert_eq!(world.bodies().position_of(1).x, 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EventDriven<T: Real> {
    plan: Plan,
    gravity: Vec3<T>,
    periodic: Option<PeriodicBox<T>>,
    features: Vec<Feature<T>>,
    /// The part of the surroundings that each feature belongs to.
    parts: Vec<u32>,
    /// The periodic images of a feature.
    images: Vec<Vec3<T>>,
    /// The images of a pair besides the nearest one, and that one itself, in
    /// whole boxes.
    further: Vec<Vec3<T>>,
    near: Near,

    // By place: neighbours in space are neighbours in memory.
    records: Vec<Record<T>>,
    agendas: Vec<Agenda<T>>,
    marks: Vec<Mark>,
    /// Where contacts change spins: those of the bodies.
    spins: Vec<Vec3<T>>,
    /// Where contacts change spins: orientations, and since when they are true.
    turned: Vec<(Mat3<T>, T)>,
    /// The scene's index of the body at each place.
    index: Vec<u32>,

    /// Masses, inertia and radii by index, and the start's spins and orientations
    /// where they are not above. Centres and velocities are in the records.
    bodies: Bodies<T>,
    inverse_mass: PerBody<T>,
    inverse_inertia: PerBody<T>,

    cells: Cells<T>,
    has_cells: bool,
    calendar: Calendar<T>,
    search_bodies: Search<T>,
    found: Vec<u32>,
    meetings: Meetings<T>,
    coarse: Coarse<T::Coarse>,
    /// `further` in the coarse precision.
    coarse_further: Vec<Vec3<T::Coarse>>,

    /// Mean distance of bodies or the greatest diameter, length.
    spacing: T,
    /// The present period's start, time.
    origin: CompensatedSum,
    period: T,
    /// The square of the speed from which a period is too long.
    too_fast: T,
    is_too_fast: bool,
    /// Time of the last collision in this period.
    last_time: T,
    /// Time that has been asked for.
    time: f64,
    /// Turns taken in this period.
    turns: u64,
    /// Time has advanced when it is past this one.
    progress: T,
    /// Turns since it did.
    standstill: u64,

    collisions: Collisions,
    tallies: Tallies,
    effort: Effort,
}

impl<T: Real> EventDriven<T> {
    /// A scene at its start, to be run with the fastest lanes.
    ///
    /// # Errors
    /// None yet for a checked scene.
    pub fn new(scene: Scene<T>) -> Result<Self, EngineError> {
        Self::with_execution(scene, Execution::default())
    }

    /// A scene at its start, to be run in the given lanes, which change no bit
    /// of the result. Events are worked off on one thread.
    ///
    /// # Errors
    /// None yet for a checked scene.
    pub fn with_execution(scene: Scene<T>, execution: Execution) -> Result<Self, EngineError> {
        let plan = Plan::new(&scene, EngineKind::EventDriven, execution, 1);
        let bodies = scene.bodies;
        let met: &[_] = if plan.features > 0 { &scene.surroundings } else { &[] };
        let (features, parts) = features_of(met);
        let images = scene.periodic.map_or_else(|| OpenSpace.images(), Space::images);
        let len = bodies.len();
        let radius = bodies.radius.greatest();
        let interiors = scene.surroundings.iter().filter_map(|shape| shape.interior());
        let region = match scene.periodic {
            Some(PeriodicBox { lower, upper }) => {
                cells::Region { lower, upper, ends: cells::Ends::Joined }
            }
            None => near::region(
                // Wide enough for cells that do not all neighbour each other.
                radius * T::whole(9),
                interiors.filter(|_| plan.features > 0),
                &features,
                (0..len).map(|index| bodies.position_of(index)),
            ),
        };
        let (cells, spacing) = Cells::fitting(region, radius + radius, len);
        let is_periodic = scene.periodic.is_some();
        let near = Near::new(&features, &images, &cells, region.ends, radius);
        let (further, coarse_further) =
            (further(&cells, is_periodic), further(&cells, is_periodic));
        let found = vec![0; cells.most()];
        let has_cells = plan.has_pairs || near.has_cells();
        let mut world = Self {
            gravity: scene.gravity,
            periodic: scene.periodic,
            features,
            parts,
            images,
            further,
            near,
            records: Vec::new(),
            agendas: Vec::new(),
            marks: Vec::new(),
            spins: Vec::new(),
            turned: Vec::new(),
            index: (0..len as u32).collect(),
            inverse_mass: bodies.mass.map(|mass| T::ONE / mass),
            inverse_inertia: bodies.inertia.map(|inertia| T::ONE / inertia),
            cells,
            has_cells,
            calendar: Calendar::new(),
            search_bodies: searcher(&plan, is_periodic),
            found,
            meetings: Meetings::new(),
            coarse: Coarse::new(scene.gravity, scene.periodic),
            coarse_further,
            spacing,
            origin: CompensatedSum::default(),
            period: T::ZERO,
            too_fast: T::ZERO,
            is_too_fast: false,
            last_time: T::ZERO,
            time: 0.0,
            turns: 0,
            progress: T::ZERO,
            standstill: 0,
            collisions: Collisions::default(),
            tallies: Tallies::default(),
            effort: Effort::default(),
            plan,
            bodies,
        };
        world.settle();
        Ok(world)
    }

    /// Lets time pass, and handles all events up to its end, which is included.
    ///
    /// Two advances are one, bit by bit: to stop in between changes nothing.
    ///
    /// # Errors
    /// If the duration is negative or no number, if time no longer advances from
    /// event to event, or if the motion leaves the range of numbers; the world
    /// is then where it stopped.
    pub fn advance(&mut self, duration: f64) -> Result<(), EngineError> {
        self.advance_to(self.after(duration)?, u64::MAX, None).map(|_| ())
    }

    /// Lets time pass up to the given number of collisions from now, at most
    /// `longest`, and returns how many there were.
    ///
    /// # Errors
    /// As [`advance`](EventDriven::advance).
    pub fn advance_until(&mut self, events: u64, longest: f64) -> Result<u64, EngineError> {
        let before = self.collisions.total();
        self.advance_to(self.after(longest)?, events, None)?;
        Ok(self.collisions.total() - before)
    }

    /// [`advance`](EventDriven::advance), and tells of every collision on the
    /// way, in order of time, those of equal times by the bodies' indices.
    ///
    /// # Errors
    /// As [`advance`](EventDriven::advance).
    pub fn for_each_event(
        &mut self,
        duration: f64,
        mut on_event: impl FnMut(&Event<T>),
    ) -> Result<(), EngineError> {
        self.advance_to(self.after(duration)?, u64::MAX, Some(&mut on_event)).map(|_| ())
    }

    /// The time that is a duration away.
    fn after(&self, duration: f64) -> Result<f64, EngineError> {
        if duration >= 0.0 && duration.is_finite() {
            return Ok(self.time + duration);
        }
        Err(EngineError::NoDuration(duration))
    }

    /// Lets time pass up to `time`, counted from the start, or up to the given
    /// number of collisions from now if that comes first, and tells of every
    /// collision on the way. Returns whether all up to that time is done.
    ///
    /// The other ways to advance are this one. Stretches to given times end
    /// there exactly; a sum of durations would be rounded.
    ///
    /// ```
    /// # use carom::engine::EventDriven;
    /// # use carom::scene::{Scene, Sphere};
    /// # use carom::surroundings::Cuboid;
    /// # let scene = Scene::<f64>::builder()
    /// #     .surroundings(Cuboid::container([0.0; 3], [2.0; 3]))
    /// #     .sphere(Sphere::new([1.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
    /// #     .build()?;
    /// let mut world = EventDriven::new(scene)?;
    /// while !world.advance_to(10.0, 3, None)? {
    ///     println!("{} collisions up to {}", world.collisions().total(), world.time());
    /// }
    /// assert_eq!(world.collisions().surroundings, 10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the time is past or no number, otherwise as
    /// [`advance`](EventDriven::advance).
    pub fn advance_to(
        &mut self,
        time: f64,
        events: u64,
        mut on_event: Listener<'_, T>,
    ) -> Result<bool, EngineError> {
        self.after(time - self.time)?;
        let last = self.collisions.total().saturating_add(events);
        loop {
            let ahead = self.in_period(time);
            let ends_here = ahead < self.period;
            let limit = if ends_here { ahead } else { self.period };
            while self.collisions.total() < last && !self.is_too_fast {
                let Some(turn) = self.next_turn() else { break };
                if turn.time > limit {
                    break;
                }
                self.check_progress(turn)?;
                self.calendar.take();
                self.take_turn(turn, &mut on_event);
            }
            if self.collisions.total() == last {
                let now = self.origin.value() + self.last_time.to_f64();
                // Not beyond the end, up to which it may have been rounded.
                self.time = self.time.max(now).lesser(time);
                return Ok(false);
            }
            if self.is_too_fast {
                self.begin_period(self.last_time);
            } else if ends_here {
                self.time = time;
                return Ok(true);
            } else {
                self.begin_period(self.period);
            }
            if !self.too_fast.is_finite() {
                self.time = self.origin.value();
                return Err(EngineError::TooFast { time: self.time });
            }
        }
    }
}
