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
mod meeting;
mod near;
mod period;
mod search;

use super::plan::{Plan, Turning};
use super::tallies::Tallies;
use super::{Collisions, EngineError, EngineKind, Event, Execution, Listener};
use crate::bodies::{Bodies, PerBody};
use crate::column::Column;
use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::motion::integrator::{Coasting, VelocityVerlet};
use crate::motion::rotation::turned;
use crate::observe::{CompensatedSum, Energy};
use crate::real::Real;
use crate::scene::Scene;
use crate::surroundings::{Feature, OpenSpace, PeriodicBox, Space};
use crate::vec3::Vec3;
use agenda::{Agenda, Mark, Next};
use calendar::{Calendar, Turn};
use cells::Cells;
use coarse::Coarse;
use flight::Record;
use meeting::Meetings;
use near::Near;
use search::{Search, rank};

/// Turns that may pass while time stands still, for scenes of few bodies.
const PATIENCE: u64 = 1 << 20;

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
    spins: Vec<Vec3<T>>,
    /// Where contacts change spins: orientations, and since when they are true.
    turned: Vec<(Mat3<T>, T)>,
    /// The scene's index of the body at each place.
    index: Vec<u32>,

    /// Masses, inertia and radii by index, and the start's orientations.
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
    tried: u64,
    crossings: u64,
    screened: u64,
    searches: u64,
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
        let mut features = Vec::new();
        let mut parts = Vec::new();
        if plan.features > 0 {
            for (part, shape) in scene.surroundings.iter().enumerate() {
                features.extend(shape.features());
                parts.resize(features.len(), part as u32);
            }
        }
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
        let near = Near::new(&features, &images, &cells, region.ends, radius);
        let (further, coarse_further) = (further(&cells), further(&cells));
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
            search_bodies: searcher(&plan, scene.periodic.is_some()),
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
            tried: 0,
            crossings: 0,
            screened: 0,
            searches: 0,
            plan,
            bodies,
        };
        world.settle();
        Ok(world)
    }

    /// What the scene needs.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Time since the start.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The energy of all bodies now.
    #[must_use]
    pub fn energy(&self) -> Energy {
        Energy::of(&self.bodies(), self.gravity)
    }

    /// Collisions since the start.
    #[must_use]
    pub fn collisions(&self) -> Collisions {
        self.collisions
    }

    /// The sum of all impulses of the surroundings on the bodies since the
    /// start, mass × length per time.
    #[must_use]
    pub fn impulse_from_surroundings(&self) -> [f64; 3] {
        self.tallies.impulse()
    }

    /// `Σ J_n·(c_a − c_b)` over all collisions of pairs since the start, mass ×
    /// length² per time: the collisions' part of the virial pressure.
    #[must_use]
    pub fn virial(&self) -> f64 {
        self.tallies.virial()
    }

    /// Mean length of the flights between collisions, those under way counted
    /// up to now: the sum of all ways over the number of their ends. `None`
    /// before the first collision. In a field the ways are taken as straight.
    #[must_use]
    pub fn mean_free_path(&self) -> Option<f64> {
        let ends = 2 * self.collisions.pairs + self.collisions.surroundings;
        let now = self.now();
        let under_way: CompensatedSum = (0..self.records.len())
            .map(|place| {
                let flight = self.records[place].flight();
                (flight.velocity.length() * (now - flight.since)).to_f64()
            })
            .collect();
        (ends > 0).then(|| (self.tallies.path() + under_way.value()) / ends as f64)
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
        if duration >= 0.0 {
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
            let ahead = time - self.origin.value();
            let ends_here = ahead < self.period.to_f64();
            let limit = if ends_here { T::from_f64(ahead) } else { self.period };
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

    /// Sees to it that time advances.
    #[inline(always)]
    fn check_progress(&mut self, turn: Turn<T>) -> Result<(), EngineError> {
        if turn.time > self.progress {
            self.progress = turn.time + self.period * (T::EPSILON * T::whole(64));
            self.standstill = 0;
            return Ok(());
        }
        self.standstill += 1;
        if self.standstill <= PATIENCE + 64 * self.records.len() as u64 {
            return Ok(());
        }
        self.time = self.origin.value() + turn.time.to_f64();
        let (events, time) = (self.standstill, self.time);
        Err(EngineError::Stalled { time, events, body: self.index[turn.place as usize] })
    }

    /// Now, since the period's start.
    fn now(&self) -> T {
        T::from_f64(self.time - self.origin.value())
    }

    #[inline(always)]
    fn next_turn(&mut self) -> Option<Turn<T>> {
        let (agendas, index) = (&self.agendas, &self.index);
        self.calendar.next(
            |turn| agendas[turn.place as usize].next_time() == turn.time,
            |a, b| order(agendas, index, a).cmp(&order(agendas, index, b)),
        )
    }

    /// Enters the next turn of the body at a place.
    #[inline(always)]
    fn enter(&mut self, place: u32) {
        let time = self.agendas[place as usize].next_time();
        if time < self.period {
            let (agendas, index) = (&self.agendas, &self.index);
            self.calendar.enter(Turn { time, place }, |a, b| {
                order(agendas, index, a).cmp(&order(agendas, index, b))
            });
        }
    }

    #[inline(always)]
    fn take_turn(&mut self, turn: Turn<T>, on_event: &mut Listener<'_, T>) {
        let Turn { time, place } = turn;
        self.turns += 1;
        match self.agendas[place as usize].next() {
            Next::LeavesCell => self.cross(place, time),
            Next::Searches => {
                self.searches += 1;
                self.search(place, time);
            }
            Next::Meets(expected) => match expected.partner.decoded() {
                Err(feature) => {
                    self.collide_with_feature(place, feature, time, on_event);
                    return;
                }
                Ok(other) if self.marks[other as usize].changes == expected.changes => {
                    self.collide_pair(place, other, time, on_event);
                    return;
                }
                Ok(_) => self.agendas[place as usize].drop_first(),
            },
        }
        self.enter(place);
    }

    /// Numbers that tell what the engine does: pairs tried, crossings of cells,
    /// searches anew.
    #[doc(hidden)]
    pub fn work(&self) -> [u64; 4] {
        [self.tried, self.crossings, self.searches, self.screened]
    }

    /// The bodies now, in the scene's order.
    #[must_use]
    pub fn bodies(&self) -> Bodies<T> {
        let len = self.records.len();
        let mut bodies = self.bodies.clone();
        let now = self.now();
        let tracks = self.plan.turning == Turning::FromLastContact;
        if tracks || self.plan.turning == Turning::FromStart {
            let rows = Mat3::<T>::IDENTITY.rows();
            bodies
                .orientation
                .get_or_insert_with(|| Box::new(rows.map(|element| Column::new(len, element))));
        }
        for place in 0..len {
            let at = self.index[place] as usize;
            let (position, velocity) = self.state_of(place, now);
            let position = self.periodic.map_or(position, |space| space.wrap(position));
            let spin = self.spins[place];
            for k in 0..3 {
                bodies.position[k][at] = position.to_array()[k];
                bodies.velocity[k][at] = velocity.to_array()[k];
                bodies.spin[k][at] = spin.to_array()[k];
            }
            let orientation = if tracks {
                let (orientation, since) = self.turned[place];
                turned(orientation, spin, now - since)
            } else {
                turned(self.bodies.orientation_of(at), spin, T::from_f64(self.time))
            };
            if let Some(rows) = &mut bodies.orientation {
                for (column, element) in rows.iter_mut().zip(orientation.rows()) {
                    column[at] = element;
                }
            }
        }
        bodies
    }

    /// Centre and velocity of the body at a place, at a time of this period.
    #[inline(always)]
    fn state_of(&self, place: usize, time: T) -> (Vec3<T>, Vec3<T>) {
        let flight = self.records[place].flight();
        if self.plan.has_field {
            flight.at::<VelocityVerlet>(time, self.gravity)
        } else {
            flight.at::<Coasting>(time, self.gravity)
        }
    }

    /// The bytes of memory that the engine holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.records.capacity() * size_of::<Record<T>>()
            + self.agendas.capacity() * size_of::<Agenda<T>>()
            + self.marks.capacity() * size_of::<Mark>()
            + self.spins.capacity() * size_of::<Vec3<T>>()
            + self.turned.capacity() * size_of::<(Mat3<T>, T)>()
            + self.index.capacity() * size_of::<u32>()
            + self.coarse.bytes()
            + self.cells.bytes()
            + self.calendar.bytes()
            + self.near.bytes()
    }
}

/// The order of turns at equal times: what is no collision first, so that all
/// collisions of that time are known before one happens.
fn order<T: Real>(agendas: &[Agenda<T>], index: &[u32], place: u32) -> Option<(u32, bool, u32)> {
    match agendas[place as usize].next() {
        Next::Meets(expected) => Some(rank(index, place, expected.partner)),
        _ => None,
    }
}

/// The search of a plan.
fn searcher<T: Real>(plan: &Plan, is_periodic: bool) -> Search<T> {
    type Pack4<T> = <<T as Real>::Coarse as Real>::Pack4;
    type Pack8<T> = <<T as Real>::Coarse as Real>::Pack8;
    type Pack16<T> = <<T as Real>::Coarse as Real>::Pack16;
    match (plan.gather_lanes, plan.sweep_lanes) {
        (1, _) => searcher_in::<T, T, T::Coarse>(plan, is_periodic),
        (4, 4) => searcher_in::<T, T::Pack4, Pack4<T>>(plan, is_periodic),
        (8, 8) => searcher_in::<T, T::Pack8, Pack8<T>>(plan, is_periodic),
        (4, _) => searcher_in::<T, T::Pack4, Pack16<T>>(plan, is_periodic),
        (_, _) => searcher_in::<T, T::Pack8, Pack16<T>>(plan, is_periodic),
    }
}

fn searcher_in<T, L, C>(plan: &Plan, is_periodic: bool) -> Search<T>
where
    T: Real,
    L: Lane<Scalar = T>,
    C: Lane<Scalar = T::Coarse>,
{
    match (plan.has_field, is_periodic) {
        (false, false) => EventDriven::search_open::<L, C, Coasting>,
        (false, true) => EventDriven::search_periodic::<L, C, Coasting>,
        (true, false) => EventDriven::search_open::<L, C, VelocityVerlet>,
        (true, true) => EventDriven::search_periodic::<L, C, VelocityVerlet>,
    }
}

/// The images of a pair that can be near at once.
fn further<T: Real, R: Real>(cells: &Cells<T>) -> Vec<Vec3<R>> {
    let along = |axis: usize| if cells.is_narrow(axis) { -1..=1 } else { 0..=0 };
    let mut further = Vec::new();
    for z in along(2) {
        for y in along(1) {
            let whole = R::whole;
            further.extend(along(0).map(|x| Vec3::new(whole(x), whole(y), whole(z))));
        }
    }
    further
}
