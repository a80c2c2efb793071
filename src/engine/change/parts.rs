//! Parts: what a change does to the surroundings.

use std::collections::BTreeSet;

use super::{Change, ChangeError};
use crate::engine::handles::Handles;
use crate::engine::{EventDriven, PartHandle, PartTotals, Stepped, World};
use crate::real::Real;
use crate::scene::Scene;
use crate::surroundings::Shape;

/// What is changed of the parts so far.
#[derive(Debug)]
pub(super) struct ChangedParts<T> {
    /// How many there were.
    before: usize,
    /// Behind these, with their names.
    added: Vec<(Option<String>, Shape<T>)>,
    removed: BTreeSet<usize>,
    /// Of the parts before and of those that are added, once any part of the world was
    /// changed.
    handles: Option<Handles>,
}

/// Where parts have come to in a change: by their index before, if they are left.
#[derive(Debug)]
pub(in crate::engine) struct KeptParts(Vec<Option<u32>>);

/// What a change makes of the parts.
#[derive(Debug)]
pub(super) struct NewParts {
    pub handles: Option<Handles>,
    /// `None` if nothing was changed.
    pub kept: Option<KeptParts>,
    /// Whether each was added; empty if none was.
    pub is_added: Vec<bool>,
}

impl<T: Real> ChangedParts<T> {
    pub fn new(before: usize, handles: Option<Handles>) -> Self {
        Self { before, added: Vec::new(), removed: BTreeSet::new(), handles }
    }

    /// How many there are in the change, with those that are removed.
    fn len(&self) -> usize {
        self.before + self.added.len()
    }

    /// Asks the handles of the parts in the change.
    fn ask<V>(&self, ask: impl FnOnce(&Handles) -> V) -> V {
        ask_handles(self.handles.as_ref(), self.before, ask)
    }

    /// Gives a scene the parts as they are changed.
    pub fn take_effect(self, scene: &mut Scene<T>) -> NewParts {
        let Self { before, added, removed, handles } = self;
        if added.is_empty() && removed.is_empty() {
            return NewParts { handles, kept: None, is_added: Vec::new() };
        }
        let mut handles = handles.unwrap_or_else(|| Handles::new(before));
        scene.part_names.resize(before, None);
        scene.removes.resize(before, false);
        let mut is_added = vec![false; before];
        for (name, shape) in added {
            scene.surroundings.push(shape);
            scene.part_names.push(name);
            scene.removes.push(false);
            is_added.push(true);
        }
        let left: Vec<usize> = (0..is_added.len()).filter(|part| !removed.contains(part)).collect();
        keep(&mut scene.surroundings, &removed);
        keep(&mut scene.part_names, &removed);
        keep(&mut scene.removes, &removed);
        keep(&mut is_added, &removed);
        if !removed.is_empty() {
            handles.keep(left.iter().copied());
        }
        let mut kept = vec![None; before];
        for (index, &part) in (0..).zip(&left) {
            if let Some(kept) = kept.get_mut(part) {
                *kept = Some(index);
            }
        }
        NewParts { handles: Some(handles), kept: Some(KeptParts(kept)), is_added }
    }
}

/// Asks the handles of parts: as long as none was changed they are the indices.
fn ask_handles<V>(handles: Option<&Handles>, parts: usize, ask: impl FnOnce(&Handles) -> V) -> V {
    match handles {
        Some(handles) => ask(handles),
        None => ask(&Handles::new(parts)),
    }
}

/// Takes out what is removed, by index.
fn keep<V>(values: &mut Vec<V>, removed: &BTreeSet<usize>) {
    let mut index = 0..;
    values.retain(|_| index.next().is_some_and(|index| !removed.contains(&index)));
}

impl KeptParts {
    /// The index of a part now.
    pub fn index_of(&self, part: u32) -> Option<u32> {
        self.0.get(part as usize).copied().flatten()
    }

    /// The totals of those that are left, under their indices now.
    pub fn totals(&self, totals: Vec<PartTotals>) -> Vec<PartTotals> {
        let of =
            |totals: PartTotals| Some(PartTotals { part: self.index_of(totals.part)?, ..totals });
        totals.into_iter().filter_map(of).collect()
    }
}

impl<T: Real> Change<'_, T> {
    /// Adds a fixed part behind the others, and gives its index in this change: if others are
    /// removed it is less in the world. Where a body is already it is refused.
    ///
    /// It has no name, and takes no sphere out of the world; a
    /// [`Sensor`](crate::surroundings::Sensor) counts from then on.
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{Plane, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0, 0.0, 2.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
    /// let mut world =
    ///     World::new(Scene::<f64>::builder().dt(0.125).sphere(ball).build()?, Execution::default())?;
    /// let floor = |height| Plane::new([0.0, 0.0, height], [0.0, 0.0, 1.0]);
    /// let mut change = world.change();
    /// let part = change.add_part(floor(0.5));
    /// let handle = change.part_handle_of(part).ok_or("it is there")?;
    /// change.apply()?;
    /// world.advance(2.0)?;
    /// assert_eq!(world.bodies().position_of(0).z, 2.0);
    /// // It goes again, and the ball on its way.
    /// let part = world.part_index_of(handle).ok_or("it is there still")?;
    /// let mut change = world.change();
    /// change.remove_part(part);
    /// change.apply()?;
    /// assert!(world.scene().surroundings.is_empty());
    /// // Not where the ball is.
    /// let mut change = world.change();
    /// change.add_part(floor(2.0));
    /// assert!(change.apply().unwrap_err().to_string().contains("solid"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_part(&mut self, shape: impl Into<Shape<T>>) -> usize {
        self.push_part(None, shape.into())
    }

    /// [`add_part`](Change::add_part) under a name, which no other part has.
    pub fn add_named_part(&mut self, name: impl Into<String>, shape: impl Into<Shape<T>>) -> usize {
        self.push_part(Some(name.into()), shape.into())
    }

    fn push_part(&mut self, name: Option<String>, shape: Shape<T>) -> usize {
        let parts = &mut self.parts;
        let part = parts.len();
        parts.handles.get_or_insert_with(|| Handles::new(part)).add(1);
        parts.added.push((name, shape));
        self.is_changed = true;
        part
    }

    /// Removes a part of the surroundings. In this change all keep their indices; in the world
    /// those behind it move up, and its [totals](World::parts) are no longer listed.
    pub fn remove_part(&mut self, part: usize) -> &mut Self {
        let parts = self.parts.len();
        if part < parts {
            self.parts.removed.insert(part);
            self.is_changed = true;
        } else {
            self.mistake.get_or_insert(ChangeError::Part { part, parts });
        }
        self
    }

    /// The name of a part of this change, which it has in the world from then on.
    #[must_use]
    pub fn part_handle_of(&self, part: usize) -> Option<PartHandle> {
        self.parts.ask(|handles| handles.of_part(part))
    }

    /// The index that a part of this name has in this change, if there is one.
    #[must_use]
    pub fn part_index_of(&self, handle: PartHandle) -> Option<usize> {
        self.parts.ask(|handles| handles.index_of_part(handle))
    }
}

impl<T: Real> World<T> {
    /// The scene without its bodies, as it is now: with the gravity and the parts that a
    /// change has given it.
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{FixedSphere, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]);
    /// let mut world = World::new(Scene::<f64>::builder().sphere(ball).build()?, Execution::default())?;
    /// let mut change = world.change();
    /// change.add_named_part("stone", FixedSphere::solid([3.0, 0.0, 0.0], 0.5));
    /// change.apply()?;
    /// assert_eq!(world.scene().part_names[0].as_deref(), Some("stone"));
    /// // With its bodies it is a scene for a new world, which goes on alike.
    /// let scene = world.scene().with_bodies(world.bodies())?;
    /// let mut again = World::new(scene, Execution::default())?;
    /// world.advance(3.0)?;
    /// again.advance(3.0)?;
    /// assert_eq!(again.bodies(), world.bodies());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn scene(&self) -> &Scene<T> {
        &self.base().scene
    }

    /// A name of the part of the surroundings with an index, which it keeps when others are
    /// added or removed; `None` if there is no such part.
    #[must_use]
    pub fn part_handle_of(&self, part: usize) -> Option<PartHandle> {
        self.ask_parts(|handles| handles.of_part(part))
    }

    /// The index of the part of this name now; `None` if it was removed.
    #[must_use]
    pub fn part_index_of(&self, handle: PartHandle) -> Option<usize> {
        self.ask_parts(|handles| handles.index_of_part(handle))
    }

    fn ask_parts<V>(&self, ask: impl FnOnce(&Handles) -> V) -> V {
        let base = self.base();
        ask_handles(base.part_handles.as_ref(), base.scene.surroundings.len(), ask)
    }
}

impl<T: Real> Stepped<T> {
    /// The scene as it is now. See [`World::scene`].
    #[must_use]
    pub fn scene(&self) -> &Scene<T> {
        &self.base().scene
    }
}

impl<T: Real> EventDriven<T> {
    /// The scene as it is now. See [`World::scene`].
    #[must_use]
    pub fn scene(&self) -> &Scene<T> {
        &self.base().scene
    }
}
