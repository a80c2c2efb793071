//! Change: what a program does to a world between two stretches of time.

mod parts;

use core::ops::Range;

use super::flow::Flow;
use super::handles::{Handles, Names};
#[cfg(feature = "files")]
use super::snapshot::{Misfit, SavedParts, Snapshot};
use super::{BodyHandle, Compiled, EngineError, EventDriven, Execution, Stepped, World};
use crate::bodies::{Bodies, Columns3};
use crate::real::Real;
use crate::scene::{Placed, Room, Scene, SceneError};
use crate::space::{PeriodicBox, Space, SphereTree};
use crate::vec3::Vec3;

pub(super) use parts::KeptParts;
use parts::{ChangedParts, NewParts};

/// Why a world cannot be changed so. It is then as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChangeError {
    /// There is no such body.
    #[error("there is no body {body}: the world has {bodies}, counted from 0")]
    Body {
        /// The index that was given.
        body: usize,
        /// How many bodies there are.
        bodies: usize,
    },
    /// There is no such part of the surroundings.
    #[error("there is no part {part} of the surroundings: the world has {parts}, counted from 0")]
    Part {
        /// The index that was given.
        part: usize,
        /// How many parts there are.
        parts: usize,
    },
    /// There is no such scene in a batch.
    #[error("there is no scene {scene}: the batch has {scenes}, counted from 0")]
    NoScene {
        /// The number that was given.
        scene: usize,
        /// How many scenes there are.
        scenes: usize,
    },
    /// What the change makes is no scene: a body in another one, a mass of 0.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The engine cannot take it.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// What a world is made of again when it is changed.
#[derive(Clone, Debug)]
pub(super) struct Base<T: Real> {
    /// Without bodies.
    scene: Scene<T>,
    pub execution: Execution,
    pub handles: Handles,
    /// Of the parts of the surroundings, once any was added or removed.
    pub part_handles: Option<Handles>,
    /// What comes and goes by the scene, if anything does.
    pub flow: Option<Box<Flow>>,
}

impl<T: Real> Base<T> {
    pub fn new(scene: &Scene<T>, execution: Execution) -> Self {
        let names = Names { bodies: Handles::new(scene.bodies.len()), parts: None };
        Self::later(scene, execution, names)
    }

    /// Of a world that had others before.
    pub fn later(scene: &Scene<T>, execution: Execution, names: Names) -> Self {
        let flow = Flow::of(scene).map(Box::new);
        let Names { bodies: handles, parts: part_handles } = names;
        Self { scene: scene.without_bodies(), execution, handles, part_handles, flow }
    }

    /// Goes on with what another one has seen come and go, whose parts are `kept` so.
    pub fn take_over(&mut self, before: &mut Self, kept: Option<&KeptParts>) {
        self.flow = before.flow.take();
        if let Some(flow) = &mut self.flow {
            flow.forget_mass();
        }
        if let (Some(flow), Some(kept)) = (&mut self.flow, kept) {
            flow.keep_parts(kept, &self.scene.removes);
        }
    }

    /// The parts, of which nothing is changed yet.
    fn changed_parts(&self) -> ChangedParts<T> {
        ChangedParts::new(self.scene.surroundings.len(), self.part_handles.clone())
    }

    pub fn periodic(&self) -> Option<PeriodicBox<T>> {
        self.scene.periodic
    }

    /// Adds what it has to remember to a snapshot.
    #[cfg(feature = "files")]
    pub fn save(&self, saved: &mut Snapshot) {
        if let Some(later) = &mut saved.later {
            later.handles.clone_from(&self.handles);
            let saved = |handles: &Handles| SavedParts::of(&self.scene, handles);
            later.parts = self.part_handles.as_ref().map(saved);
        }
        let out = self.handles.out();
        saved.flow = self.flow.as_ref().map(|flow| Box::new(flow.state.with_out(out)));
    }

    /// Goes on from what a snapshot remembers.
    #[cfg(feature = "files")]
    pub fn restore(&mut self, saved: &Snapshot) -> Result<(), Misfit> {
        if self.flow.is_none() && self.part_handles.is_some() && saved.flow.is_some() {
            // What took spheres out was removed since.
            self.flow = Some(Box::new(Flow::spent(&self.scene)));
        }
        if let Some(state) = &saved.flow {
            self.handles.set_out(state.out());
        }
        match (&mut self.flow, &saved.flow) {
            (None, None) => Ok(()),
            (Some(flow), Some(state)) => flow.restore(state),
            _ => Err(Misfit("spheres that come and go")),
        }
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        let parts = self.part_handles.as_ref().map_or(0, Handles::bytes);
        size_of_val(self.scene.surroundings.as_slice()) + self.handles.bytes() + parts
    }
}

/// What lets a change take effect, where it is not known that its precision is compiled.
pub(super) type Apply<T> = fn(Change<'_, T>) -> Result<(), ChangeError>;

/// The world that is changed.
#[derive(Debug)]
enum Target<'a, T: Real> {
    Stepped(&'a mut Stepped<T>),
    EventDriven(&'a mut EventDriven<T>),
}

impl<T: Real> Target<'_, T> {
    fn base(&self) -> &Base<T> {
        match self {
            Self::Stepped(world) => world.base(),
            Self::EventDriven(world) => world.base(),
        }
    }
}

/// A change of a world, under way: all of it takes effect at once, by
/// [`apply`](Change::apply), or none of it. Bodies are named by their indices in the scene.
///
/// Bodies that are added come last, and those that are removed let the ones behind them move
/// up: by [`BodyHandle`]s each is found again. So it is with the parts of the surroundings
/// ([`add_part`](Change::add_part), [`remove_part`](Change::remove_part)), by
/// [`PartHandle`](crate::engine::PartHandle)s.
///
/// A changed world goes on, bit by bit, as a new world that is built in that state: its
/// bodies with what was changed, in the same scene under the gravity and among the parts that
/// it has now. Time, steps and all that is added up go on, but for the mean free path and the
/// effort, which are those since the change.
///
/// What is moved, grown or added is checked against all else; bodies that are left alone may
/// be in each other, and in parts that were there, as a step has left them.
///
/// It costs about as much as to start such a world, whatever is changed: change all that is
/// to be changed at once.
///
/// ```
/// use carom::engine::{Execution, World};
/// use carom::scene::EngineKind;
/// use carom::{Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
/// let scene = Scene::<f64>::builder().engine(EngineKind::EventDriven);
/// let scene = scene.sphere(ball(0.0)).sphere(ball(3.0)).build()?;
/// let mut world = World::new(scene, Execution::default())?;
/// world.advance(1.0)?;
/// // A kick, and the other one out of the way.
/// let mut change = world.change();
/// change.apply_impulse(0, [2.0, 0.0, 0.0]).set_position(1, [5.0, 0.0, 0.0]);
/// change.apply()?;
/// world.for_each_event(3.0, |event| assert_eq!(event.time, 3.0))?;
/// assert_eq!(world.time(), 4.0);
/// // A body cannot be put into another one.
/// let mut change = world.change();
/// change.set_position(0, change.bodies().position_of(1));
/// assert!(change.apply().unwrap_err().to_string().contains("overlap"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
#[must_use = "a change takes effect by `apply`"]
pub struct Change<'a, T: Real> {
    target: Target<'a, T>,
    bodies: Bodies<T>,
    gravity: Vec3<T>,
    /// Which bodies were moved, grown or added.
    placed: Vec<bool>,
    /// Which are to be removed, if any.
    removed: Vec<bool>,
    handles: Handles,
    parts: ChangedParts<T>,
    is_changed: bool,
    mistake: Option<ChangeError>,
}

impl<'a, T: Real> Change<'a, T> {
    fn new(target: Target<'a, T>, bodies: Bodies<T>, gravity: Vec3<T>) -> Self {
        let placed = vec![false; bodies.len()];
        let (removed, handles) = (placed.clone(), target.base().handles.left());
        let parts = target.base().changed_parts();
        Self {
            target,
            bodies,
            gravity,
            placed,
            removed,
            handles,
            parts,
            is_changed: false,
            mistake: None,
        }
    }

    /// The bodies with what is changed so far.
    #[must_use]
    pub fn bodies(&self) -> &Bodies<T> {
        &self.bodies
    }

    /// The gravity that the world will have, length per time².
    #[must_use]
    pub fn gravity(&self) -> Vec3<T> {
        self.gravity
    }

    /// Does this to a body, if there is one of that index; otherwise
    /// [`apply`](Change::apply) says so.
    fn with(&mut self, body: usize, change: impl FnOnce(&mut Self)) -> &mut Self {
        let bodies = self.bodies.len();
        if body < bodies {
            self.is_changed = true;
            change(self);
        } else {
            self.mistake.get_or_insert(ChangeError::Body { body, bodies });
        }
        self
    }

    /// Puts the centre of a body somewhere, length: in a periodic box, within it.
    pub fn set_position(&mut self, body: usize, position: impl Into<Vec3<T>>) -> &mut Self {
        self.with(body, |change| {
            put(&mut change.bodies.position, body, position.into());
            change.placed[body] = true;
        })
    }

    /// Gives a body a velocity, length per time.
    pub fn set_velocity(&mut self, body: usize, velocity: impl Into<Vec3<T>>) -> &mut Self {
        self.with(body, |change| put(&mut change.bodies.velocity, body, velocity.into()))
    }

    /// Gives a body an angular velocity, rad per time.
    pub fn set_spin(&mut self, body: usize, spin: impl Into<Vec3<T>>) -> &mut Self {
        self.with(body, |change| put(&mut change.bodies.spin, body, spin.into()))
    }

    /// Gives a body another radius, length; its mass stays, and its moment of inertia is
    /// that of the same shape of body.
    pub fn set_radius(&mut self, body: usize, radius: T) -> &mut Self {
        self.with(body, |change| {
            let (bodies, len) = (&mut change.bodies, change.placed.len());
            let growth = radius / bodies.radius.of(body);
            let inertia = bodies.inertia.of(body) * (growth * growth);
            bodies.radius.set(len, body, radius);
            bodies.inertia.set(len, body, inertia);
            change.placed[body] = true;
        })
    }

    /// Gives a body another mass, and with it the moment of inertia of the same shape of
    /// body.
    pub fn set_mass(&mut self, body: usize, mass: T) -> &mut Self {
        self.with(body, |change| {
            let (bodies, len) = (&mut change.bodies, change.placed.len());
            let inertia = bodies.inertia.of(body) * (mass / bodies.mass.of(body));
            bodies.mass.set(len, body, mass);
            bodies.inertia.set(len, body, inertia);
        })
    }

    /// Lets an impulse act on the centre of a body, mass × length per time:
    /// `v ← v + J/m`.
    pub fn apply_impulse(&mut self, body: usize, impulse: impl Into<Vec3<T>>) -> &mut Self {
        self.with(body, |change| {
            let bodies = &mut change.bodies;
            let inverse_mass = T::ONE / bodies.mass.of(body);
            let velocity = bodies.velocity_of(body) + impulse.into() * inverse_mass;
            put(&mut bodies.velocity, body, velocity);
        })
    }

    /// Lets an impulse act on a body at a point in space, mass × length per time, length:
    /// `v ← v + J/m`, `ω ← ω + (p − c) × J / I`; in a periodic box at the image of the
    /// point that is nearest.
    pub fn apply_impulse_at(
        &mut self,
        body: usize,
        impulse: impl Into<Vec3<T>>,
        point: impl Into<Vec3<T>>,
    ) -> &mut Self {
        let (impulse, point) = (impulse.into(), point.into());
        let periodic = self.target.base().periodic();
        self.apply_impulse(body, impulse).with(body, |change| {
            let bodies = &mut change.bodies;
            let arm = point - bodies.position_of(body);
            let arm = periodic.map_or(arm, |space| space.nearest(arm));
            let inverse_inertia = T::ONE / bodies.inertia.of(body);
            let spin = bodies.spin_of(body) + arm.cross(impulse) * inverse_inertia;
            put(&mut bodies.spin, body, spin);
        })
    }

    /// Adds bodies behind the others, and gives their indices in this change: if others are
    /// removed they are less in the world.
    pub fn add(&mut self, bodies: &Bodies<T>) -> Range<usize> {
        let start = self.bodies.len();
        self.bodies.extend(bodies);
        self.handles.add(bodies.len());
        self.placed.resize(self.bodies.len(), true);
        self.removed.resize(self.bodies.len(), false);
        self.is_changed |= !bodies.is_empty();
        start..self.bodies.len()
    }

    /// Removes a body. In this change all keep their indices; in the world those behind it
    /// move up.
    pub fn remove(&mut self, body: usize) -> &mut Self {
        self.with(body, |change| change.removed[body] = true)
    }

    /// Whether a body is to be removed.
    pub(super) fn is_removed(&self, body: usize) -> bool {
        self.removed[body]
    }

    /// What is in the way of spheres that come, besides the bodies.
    pub(super) fn room(&self) -> Room<T> {
        Room::of(&self.target.base().scene)
    }

    /// The name of a body of this change, which it has in the world from then on.
    #[must_use]
    pub fn handle_of(&self, body: usize) -> Option<BodyHandle> {
        self.handles.of(body)
    }

    /// The index that a body of this name has in this change, if there is one.
    #[must_use]
    pub fn index_of(&self, handle: BodyHandle) -> Option<usize> {
        self.handles.index_of(handle)
    }

    /// Gives the world another gravity, length per time².
    pub fn set_gravity(&mut self, gravity: impl Into<Vec3<T>>) -> &mut Self {
        self.gravity = gravity.into();
        self.is_changed = true;
        self
    }
}

impl<T: Compiled> Change<'_, T> {
    /// Lets all of it take effect, and the world go on from there.
    ///
    /// # Errors
    /// If a body or a part does not exist, if a body is put into another one or out of its
    /// container, a part to where a body is, if a figure cannot be, or if no body is left: the
    /// world is then as it was before the change.
    pub fn apply(self) -> Result<(), ChangeError> {
        T::apply(self)
    }

    pub(super) fn take_effect(self) -> Result<(), ChangeError> {
        let Self { target, mut bodies, gravity, mut placed, removed, mut handles, parts, .. } =
            self;
        if let Some(mistake) = self.mistake {
            return Err(mistake);
        }
        if !self.is_changed {
            return Ok(());
        }
        if removed.contains(&true) {
            let kept: Vec<usize> = (0..bodies.len()).filter(|body| !removed[*body]).collect();
            bodies = bodies.only(&kept);
            placed = kept.iter().map(|&body| placed[body]).collect();
            handles.keep(kept.iter().copied());
        }
        let mut base = Scene { gravity, ..target.base().scene.clone() };
        let NewParts { handles: part_handles, kept, is_added } = parts.take_effect(&mut base);
        let scene = base.with_placed(bodies, Placed { bodies: &placed, parts: &is_added })?;
        let names = Names { bodies: handles, parts: part_handles };
        match target {
            Target::Stepped(world) => world.go_on(scene, names, kept.as_ref())?,
            Target::EventDriven(world) => world.go_on(scene, names, kept.as_ref())?,
        }
        Ok(())
    }
}

/// Writes a vector to element `index` of three columns.
fn put<T: Real>(columns: &mut Columns3<T>, index: usize, value: Vec3<T>) {
    for (column, component) in columns.iter_mut().zip(value.to_array()) {
        column[index] = component;
    }
}

impl<T: Real> World<T> {
    /// Begins a change of the world. See [`Change`].
    pub fn change(&mut self) -> Change<'_, T> {
        match self {
            Self::Stepped(world) => world.change(),
            Self::EventDriven(world) => world.change(),
        }
    }
}

impl<T: Real> Stepped<T> {
    /// Begins a change of the world. See [`Change`].
    pub fn change(&mut self) -> Change<'_, T> {
        let (bodies, gravity) = (self.bodies(), self.gravity());
        Change::new(Target::Stepped(self), bodies, gravity)
    }

    /// The bodies now, to be asked by place. See [`World::sphere_tree`].
    #[must_use]
    pub fn sphere_tree(&self) -> SphereTree<T> {
        SphereTree::new(&self.bodies(), self.base().periodic())
    }
}

impl<T: Real> EventDriven<T> {
    /// Begins a change of the world. See [`Change`].
    pub fn change(&mut self) -> Change<'_, T> {
        let (bodies, gravity) = (self.bodies(), self.gravity());
        Change::new(Target::EventDriven(self), bodies, gravity)
    }

    /// The bodies now, to be asked by place. See [`World::sphere_tree`].
    #[must_use]
    pub fn sphere_tree(&self) -> SphereTree<T> {
        SphereTree::new(&self.bodies(), self.base().periodic())
    }
}

impl<T: Real> World<T> {
    pub(super) fn base(&self) -> &Base<T> {
        match self {
            Self::Stepped(world) => world.base(),
            Self::EventDriven(world) => world.base(),
        }
    }

    /// A name of the body with an index, which it keeps when others are added or removed;
    /// `None` if there is no such body.
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{Bodies, Scene, Sphere};
    ///
    /// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
    /// let scene = Scene::<f64>::builder().dt(0.125).sphere(ball(0.0)).sphere(ball(3.0)).build()?;
    /// let mut world = World::new(scene, Execution::default())?;
    /// let second = world.handle_of(1).ok_or("it is there")?;
    /// let mut change = world.change();
    /// let added = change.add(&Bodies::from_positions(&[[6.0, 0.0, 0.0]]).radius(0.5).build()?);
    /// let third = change.handle_of(added.start).ok_or("it is there")?;
    /// change.remove(0);
    /// change.apply()?;
    /// assert_eq!((world.index_of(second), world.index_of(third)), (Some(0), Some(1)));
    /// assert_eq!(world.bodies().position_of(1).x, 6.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn handle_of(&self, body: usize) -> Option<BodyHandle> {
        self.base().handles.of(body)
    }

    /// The index of the body of this name now; `None` if it was removed.
    #[must_use]
    pub fn index_of(&self, handle: BodyHandle) -> Option<usize> {
        self.base().handles.index_of(handle)
    }
}
