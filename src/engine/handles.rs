//! Handles: names of bodies, and of parts of the surroundings, that stay when others are
//! added and removed.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

/// The name of a body of a world, which no other body of it ever has.
///
/// Those that a world starts with have their indices; see
/// [`World::handle_of`](super::World::handle_of).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct BodyHandle(u64);

impl BodyHandle {
    /// Its number: of those that a world starts with, their indices; then in the order in
    /// which they come.
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0; 3]).radius(0.5);
    /// let world = World::new(Scene::<f64>::builder().sphere(ball).build()?, Execution::default())?;
    /// assert_eq!(world.handle_of(0).map(|handle| handle.number()), Some(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn number(self) -> u64 {
        self.0
    }
}

/// The name of a part of the surroundings of a world, which no other part of it ever has.
///
/// Those that a world starts with have their indices; see
/// [`World::part_handle_of`](super::World::part_handle_of).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct PartHandle(u64);

impl PartHandle {
    /// Its number: of those that a world starts with, their indices; then in the order in
    /// which they come.
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{Plane, Scene, Sphere};
    ///
    /// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5);
    /// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
    /// let scene = Scene::<f64>::builder().surroundings(floor).sphere(ball).build()?;
    /// let world = World::new(scene, Execution::default())?;
    /// assert_eq!(world.part_handle_of(0).map(|handle| handle.number()), Some(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn number(self) -> u64 {
        self.0
    }
}

/// The handles of all bodies, or of all parts, by index. What is added comes last and has
/// the next one, so that they rise.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub(super) struct Handles {
    /// `None` as long as nothing was removed: they are the indices.
    listed: Option<Vec<BodyHandle>>,
    /// Those from here on are new.
    next: u64,
    /// Of those that an engine has, the ones that were taken out since it started, by its
    /// indices, which rise.
    out: Vec<u32>,
}

impl Handles {
    /// Of a world at its start.
    pub fn new(bodies: usize) -> Self {
        Self { listed: None, next: bodies as u64, out: Vec::new() }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count_of_engine() - self.out.len()
    }

    /// How many an engine has, with those that were taken out.
    pub fn count_of_engine(&self) -> usize {
        self.listed.as_ref().map_or(self.next as usize, Vec::len)
    }

    pub fn of(&self, index: usize) -> Option<BodyHandle> {
        // Each one that is out before it moves it on.
        let moved = |at: usize| self.out[at] as usize - at <= index;
        let (mut low, mut high) = (0, self.out.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            if moved(middle) { low = middle + 1 } else { high = middle }
        }
        self.of_engine(index + low)
    }

    fn of_engine(&self, index: usize) -> Option<BodyHandle> {
        match &self.listed {
            Some(listed) => listed.get(index).copied(),
            None => Some(BodyHandle(index as u64)).filter(|handle| handle.0 < self.next),
        }
    }

    /// The number of the body that has an index in the engine.
    pub fn number_of(&self, index: u32) -> u32 {
        self.of_engine(index as usize).map_or(index, |handle| handle.0 as u32)
    }

    pub fn index_of(&self, handle: BodyHandle) -> Option<usize> {
        let index = match &self.listed {
            Some(listed) => listed.binary_search(&handle).ok(),
            None => Some(handle.0 as usize).filter(|_| handle.0 < self.next),
        };
        let index = index?;
        let before = self.out.binary_search(&(index as u32)).err()?;
        Some(index - before)
    }

    /// Takes the body out that has an index in the engine, which keeps those of the others.
    pub fn take_out(&mut self, index: u32) {
        if let Err(at) = self.out.binary_search(&index) {
            self.out.insert(at, index);
        }
    }

    /// Those that were taken out, by their indices in the engine.
    #[cfg(feature = "files")]
    pub fn out(&self) -> &[u32] {
        &self.out
    }

    /// As they were taken out before a snapshot.
    #[cfg(feature = "files")]
    pub fn set_out(&mut self, out: &[u32]) {
        out.clone_into(&mut self.out);
    }

    /// Of the bodies that there are, for an engine that starts with them.
    #[must_use]
    pub fn left(&self) -> Self {
        let mut left = self.clone();
        if !self.out.is_empty() {
            left.keep(0..self.count());
        }
        left
    }

    /// The handle of a part, of those of parts.
    pub fn of_part(&self, index: usize) -> Option<PartHandle> {
        self.of(index).map(|handle| PartHandle(handle.0))
    }

    /// The index of a part, of those of parts.
    pub fn index_of_part(&self, handle: PartHandle) -> Option<usize> {
        self.index_of(BodyHandle(handle.0))
    }

    /// Names some more of them.
    pub fn add(&mut self, count: usize) {
        let end = self.next + count as u64;
        if let Some(listed) = &mut self.listed {
            listed.extend((self.next..end).map(BodyHandle));
        }
        self.next = end;
    }

    /// Forgets all but those of these indices, which rise.
    pub fn keep(&mut self, kept: impl IntoIterator<Item = usize>) {
        self.listed = Some(kept.into_iter().filter_map(|index| self.of(index)).collect());
        self.out.clear();
    }

    /// The bytes that they hold.
    pub fn bytes(&self) -> usize {
        let listed = self.listed.as_ref().map_or(0, |listed| size_of_val(listed.as_slice()));
        listed + size_of_val(self.out.as_slice())
    }
}

/// Who is who in a world.
#[derive(Clone, Debug)]
pub(super) struct Names {
    pub bodies: Handles,
    /// `None` as long as no part was added or removed: they are the indices.
    pub parts: Option<Handles>,
}
