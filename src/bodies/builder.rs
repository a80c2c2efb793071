//! Bodies from a program's own arrays.

use super::{Bodies, Columns3, Origin, PerBody};
use crate::column::Column;
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// Why arrays make no bodies.
///
/// ```
/// use carom::Bodies;
/// use carom::bodies::BodiesError;
/// assert_eq!(Bodies::from_positions(&[[0.0; 3]]).build(), Err(BodiesError::NoRadius));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BodiesError {
    /// An array has more or fewer elements than there are positions.
    #[error("there are {found} {figures} for {bodies} positions; give one for each body")]
    Length {
        /// What the array holds.
        figures: &'static str,
        /// How many elements it has.
        found: usize,
        /// How many positions there are.
        bodies: usize,
    },
    /// There is no radius.
    #[error("the bodies have no radius; set one with `.radius()`, or one for each with `.radii()`")]
    NoRadius,
}

/// A figure as it is given.
#[derive(Clone, Copy, Debug)]
enum Given<'a, T> {
    Same(T),
    Each(&'a [T]),
}

impl<T: Real> Given<'_, T> {
    fn of(&self, index: usize) -> T {
        match self {
            Self::Same(value) => *value,
            Self::Each(values) => values[index],
        }
    }

    /// How many there are, if they are counted.
    fn count(&self) -> Option<usize> {
        match self {
            Self::Same(_) => None,
            Self::Each(values) => Some(values.len()),
        }
    }
}

/// Bodies in the making, from slices: see [`Bodies::from_positions`].
///
/// Nothing but the positions and the radius must be given. Without more the
/// bodies are at rest, of mass 1, and solid: `I = 2/5 m r²`.
///
/// ```
/// use carom::Bodies;
///
/// let quarter_turn = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
/// let bodies = Bodies::from_positions(&[[0.0; 3], [3.0, 0.0, 0.0]])
///     .velocities(&[[1.0, 0.0, 0.0], [0.0; 3]])
///     .spins(&[[0.0, 0.0, 2.0], [0.0; 3]])
///     .orientations(&[quarter_turn; 2])
///     .radii(&[1.0, 0.5]) // or .radius(1.0)
///     .masses(&[8.0, 1.0]) // or .mass(1.0)
///     .inertia_factor(0.5)
///     .build()?;
/// assert_eq!((bodies.inertia.of(0), bodies.inertia.of(1)), (4.0, 0.125));
/// assert_eq!(bodies.orientation_of(1).rows(), quarter_turn);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct BodiesBuilder<'a, T: Real> {
    positions: &'a [[T; 3]],
    velocities: Option<&'a [[T; 3]]>,
    spins: Option<&'a [[T; 3]]>,
    orientations: Option<&'a [[T; 9]]>,
    radius: Option<Given<'a, T>>,
    mass: Given<'a, T>,
    inertia_factor: T,
}

impl<'a, T: Real> BodiesBuilder<'a, T> {
    pub(super) fn new(positions: &'a [[T; 3]]) -> Self {
        Self {
            positions,
            velocities: None,
            spins: None,
            orientations: None,
            radius: None,
            mass: Given::Same(T::ONE),
            inertia_factor: T::ratio(2, 5),
        }
    }

    /// The velocity of each body, length per time.
    pub fn velocities(mut self, velocities: &'a [[T; 3]]) -> Self {
        self.velocities = Some(velocities);
        self
    }

    /// The angular velocity of each body, rad per time, world frame.
    pub fn spins(mut self, spins: &'a [[T; 3]]) -> Self {
        self.spins = Some(spins);
        self
    }

    /// The orientation of each body: body axes to world axes, row by row.
    pub fn orientations(mut self, orientations: &'a [[T; 9]]) -> Self {
        self.orientations = Some(orientations);
        self
    }

    /// One radius for all bodies, length.
    pub fn radius(mut self, radius: T) -> Self {
        self.radius = Some(Given::Same(radius));
        self
    }

    /// The radius of each body, length.
    pub fn radii(mut self, radii: &'a [T]) -> Self {
        self.radius = Some(Given::Each(radii));
        self
    }

    /// One mass for all bodies.
    pub fn mass(mut self, mass: T) -> Self {
        self.mass = Given::Same(mass);
        self
    }

    /// The mass of each body.
    pub fn masses(mut self, masses: &'a [T]) -> Self {
        self.mass = Given::Each(masses);
        self
    }

    /// `q` in `I = q m r²`: 2/5 for a solid ball, 2/3 for a shell.
    pub fn inertia_factor(mut self, factor: T) -> Self {
        self.inertia_factor = factor;
        self
    }

    /// Copies the slices to columns. Values are not checked here: a scene does
    /// that when it is [built](crate::SceneBuilder::build).
    ///
    /// # Errors
    /// If no radius is given, or an array has another length than the
    /// positions.
    pub fn build(self) -> Result<Bodies<T>, BodiesError> {
        let len = self.positions.len();
        let radius = self.radius.ok_or(BodiesError::NoRadius)?;
        for (figures, found) in [
            ("velocities", self.velocities.map(<[_]>::len)),
            ("spins", self.spins.map(<[_]>::len)),
            ("orientations", self.orientations.map(<[_]>::len)),
            ("radii", radius.count()),
            ("masses", self.mass.count()),
        ] {
            if let Some(found) = found.filter(|&found| found != len) {
                return Err(BodiesError::Length { figures, found, bodies: len });
            }
        }
        let figure = |value: &dyn Fn(usize) -> T| PerBody::from_values((0..len).map(value), T::ONE);
        let (factor, mass) = (self.inertia_factor, self.mass);
        Ok(Bodies {
            origin: Origin::Described,
            position: columns(self.positions),
            velocity: self.velocities.map_or_else(|| zeros(len), columns),
            spin: self.spins.map_or_else(|| zeros(len), columns),
            orientation: self.orientations.map(|rows| Box::new(columns(rows))),
            radius: figure(&|k| radius.of(k)),
            mass: figure(&|k| mass.of(k)),
            inertia: figure(&|k| factor * mass.of(k) * radius.of(k) * radius.of(k)),
        })
    }
}

/// A column for each component.
fn columns<T: Real, const N: usize>(vectors: &[[T; N]]) -> [Column<T>; N]
where
    [Column<T>; N]: Each<Column<T>, N>,
{
    array::from_fn(|axis| Column::from_values(vectors.iter().map(|vector| vector[axis]), T::ZERO))
}

fn zeros<T: Real>(len: usize) -> Columns3<T> {
    array::from_fn(|_| Column::new(len, T::ZERO))
}
