//! Bodies: the state of all spheres, a column for each component.
//!
//! ```
//! use carom::Bodies;
//!
//! let bodies = Bodies::from_positions(&[[0.0, 0.0, 1.0], [2.0, 0.0, 1.0]])
//!     .velocities(&[[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
//!     .radius(0.5)
//!     .build()?;
//! assert_eq!(bodies.len(), 2);
//! assert_eq!(bodies.velocity_of(0).x, 1.0);
//! assert_eq!(bodies.inertia.of(0), 0.1); // a solid ball of mass 1
//! # Ok::<(), carom::bodies::BodiesError>(())
//! ```

mod builder;
mod edit;
mod origin;

use crate::column::Column;
use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

pub use builder::{BodiesBuilder, BodiesError};
pub(crate) use origin::Origin;

/// The three components of a vector, a column each.
///
/// ```
/// use carom::bodies::Columns3;
/// use carom::column::Column;
///
/// let origin: Columns3<f64> = std::array::from_fn(|_| Column::new(10, 0.0));
/// assert_eq!(origin[2].len(), 10);
/// ```
pub type Columns3<T> = [Column<T>; 3];

/// A figure of each body, stored only where the bodies differ in it.
///
/// ```
/// use carom::bodies::PerBody;
///
/// let equal = PerBody::from_values([0.5, 0.5].into_iter(), 0.0);
/// assert_eq!(equal, PerBody::Same(0.5));
/// let radius = PerBody::from_values([0.5, 2.0].into_iter(), 0.0);
/// assert_eq!(radius.of(1), 2.0);
/// assert_eq!(radius.greatest(), 2.0);
/// assert_eq!(radius.map(|r| 2.0 * r).of(0), 1.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum PerBody<T: Real> {
    /// All bodies have this value.
    Same(T),
    /// Body `i` has element `i`.
    Each(Column<T>),
}

impl<T: Real> PerBody<T> {
    /// The values of all bodies, stored once if they are equal. `padding`
    /// stands behind the last one.
    #[must_use]
    pub fn from_values(values: impl ExactSizeIterator<Item = T> + Clone, padding: T) -> Self {
        let mut others = values.clone();
        match others.next() {
            None => Self::Same(padding),
            Some(first) if others.all(|value| value == first) => Self::Same(first),
            Some(_) => Self::Each(Column::from_values(values, padding)),
        }
    }

    /// The value of body `index`.
    ///
    /// # Panics
    /// If the values differ and there are no more than `index`.
    #[inline(always)]
    #[must_use]
    pub fn of(&self, index: usize) -> T {
        match self {
            Self::Same(value) => *value,
            Self::Each(column) => column[index],
        }
    }

    /// The same figure passed through a function.
    #[must_use]
    pub fn map(&self, function: impl Fn(T) -> T) -> Self {
        match self {
            Self::Same(value) => Self::Same(function(*value)),
            Self::Each(column) => Self::Each(Column::from_values(
                column.iter().map(|value| function(*value)),
                function(T::ONE),
            )),
        }
    }

    /// Gives one of `len` bodies a value of its own.
    pub(crate) fn set(&mut self, len: usize, index: usize, value: T) {
        if let Self::Same(same) = *self {
            if same == value {
                return;
            }
            // What stands behind the last one is divided by.
            *self = Self::Each(Column::from_values((0..len).map(|_| same), T::ONE));
        }
        if let Self::Each(column) = self {
            column[index] = value;
        }
    }

    /// The bytes that the figures hold.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Same(_) => 0,
            Self::Each(column) => column.bytes(),
        }
    }

    /// The greatest value; 0 if there is none.
    #[must_use]
    pub fn greatest(&self) -> T {
        match self {
            Self::Same(value) => *value,
            Self::Each(column) => column.iter().fold(T::ZERO, |most, &value| value.greater(most)),
        }
    }
}

/// A figure of each body as a kernel reads it. The type says at compile time
/// whether it has to be loaded at all.
///
/// ```
/// use carom::bodies::{Figure, Same};
/// use wide::f64x4;
///
/// fn at_pairs<R: Figure<f64>>(radius: R) -> [f64; 4] {
///     radius.gather::<f64x4>(&[3, 0, 1, 1]).to_array()
/// }
/// assert_eq!(at_pairs([1.0, 2.0, 3.0, 4.0].as_slice()), [4.0, 1.0, 2.0, 2.0]);
/// assert_eq!(at_pairs(Same(0.5)), [0.5; 4]);
/// ```
pub trait Figure<T: Real>: Copy + Send + Sync {
    /// Whether it is known to be the same for all bodies.
    const IS_ONE: bool = false;

    /// The figures of the bodies at `indices`.
    fn gather<L: Lane<Scalar = T>>(self, indices: &[u32]) -> L;

    /// The figures of the bodies from `index` on.
    fn load<L: Lane<Scalar = T>>(self, index: usize) -> L;

    /// The same where the last lanes may be past the end; those are 0.
    fn load_tail<L: Lane<Scalar = T>>(self, index: usize) -> L;
}

/// One figure for all bodies: nothing is loaded.
///
/// ```
/// use carom::bodies::{Figure, Same};
/// assert_eq!(Same(0.5).load::<f64>(7), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Same<T>(pub T);

impl<T: Real> Figure<T> for Same<T> {
    const IS_ONE: bool = true;

    #[inline(always)]
    fn gather<L: Lane<Scalar = T>>(self, _: &[u32]) -> L {
        L::splat(self.0)
    }

    #[inline(always)]
    fn load<L: Lane<Scalar = T>>(self, _: usize) -> L {
        L::splat(self.0)
    }

    #[inline(always)]
    fn load_tail<L: Lane<Scalar = T>>(self, _: usize) -> L {
        L::splat(self.0)
    }
}

impl<T: Real> Figure<T> for &[T] {
    #[inline(always)]
    fn gather<L: Lane<Scalar = T>>(self, indices: &[u32]) -> L {
        L::gather(self, indices)
    }

    #[inline(always)]
    fn load<L: Lane<Scalar = T>>(self, index: usize) -> L {
        L::load(&self[index..])
    }

    #[inline(always)]
    fn load_tail<L: Lane<Scalar = T>>(self, index: usize) -> L {
        if index + L::WIDTH <= self.len() {
            L::load(&self[index..])
        } else {
            L::load_tail(&self[index..], T::ZERO)
        }
    }
}

/// Looked at once a pack, for sweeps that need not be compiled for both kinds.
impl<T: Real> Figure<T> for &PerBody<T> {
    #[inline(always)]
    fn gather<L: Lane<Scalar = T>>(self, indices: &[u32]) -> L {
        match self {
            PerBody::Same(value) => L::splat(*value),
            PerBody::Each(column) => L::gather(column, indices),
        }
    }

    #[inline(always)]
    fn load<L: Lane<Scalar = T>>(self, index: usize) -> L {
        match self {
            PerBody::Same(value) => L::splat(*value),
            PerBody::Each(column) => column.padded().load(index),
        }
    }

    #[inline(always)]
    fn load_tail<L: Lane<Scalar = T>>(self, index: usize) -> L {
        match self {
            PerBody::Same(value) => L::splat(*value),
            PerBody::Each(column) => column.padded().load_tail(index),
        }
    }
}

/// All spheres of a scene, in struct-of-arrays form, in the order of the scene
/// file.
///
/// Units are the user's own as long as they agree (SI, or σ = m = kT = 1).
/// Vectors are in the world frame. Every column has [`len`](Bodies::len)
/// elements. Columns are read and written in place; see the
/// [module](self) for how to make bodies from arrays.
///
/// ```
/// use carom::Bodies;
///
/// let positions = [[0.0; 3], [2.0, 0.0, 0.0]];
/// let mut bodies = Bodies::from_positions(&positions).radius(0.5).build()?;
/// bodies.velocity[0].fill(1.0);
/// bodies.position[2][1] = 3.0;
/// assert_eq!(bodies.velocity_of(1).to_array(), [1.0, 0.0, 0.0]);
/// assert_eq!(bodies.position_of(1).z, 3.0);
/// assert_eq!((bodies.len(), bodies.is_empty()), (2, false));
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bodies<T: Real> {
    /// What has put them where they are.
    pub(crate) origin: Origin,
    /// Centres, length.
    pub position: Columns3<T>,
    /// Velocities of the centres, length per time.
    pub velocity: Columns3<T>,
    /// Angular velocities, rad per time.
    pub spin: Columns3<T>,
    /// Body axes to world axes, nine columns in row-major order. `None` while
    /// every body's axes are the world's.
    pub orientation: Option<Box<[Column<T>; 9]>>,
    /// Radii, length.
    pub radius: PerBody<T>,
    /// Masses.
    pub mass: PerBody<T>,
    /// Moments of inertia about the centre, `I = q m r²`.
    pub inertia: PerBody<T>,
}

impl<T: Real> Bodies<T> {
    /// No bodies.
    pub(crate) fn none() -> Self {
        let nothing = || array::from_fn(|_| Column::new(0, T::ZERO));
        Self {
            origin: Origin::Described,
            position: nothing(),
            velocity: nothing(),
            spin: nothing(),
            orientation: None,
            radius: PerBody::Same(T::ONE),
            mass: PerBody::Same(T::ONE),
            inertia: PerBody::Same(T::ONE),
        }
    }

    /// Bodies with these centres, length; what else they have is set by the
    /// methods of [`BodiesBuilder`].
    ///
    /// ```
    /// use carom::Bodies;
    /// use carom::bodies::BodiesError;
    ///
    /// let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
    /// let bodies = Bodies::from_positions(&positions).radii(&[1.0, 0.5]).build()?;
    /// assert_eq!(bodies.position_of(1).x, 3.0);
    /// assert_eq!(bodies.radius.of(1), 0.5);
    ///
    /// let error = Bodies::from_positions(&positions).radii(&[1.0]).build().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "there are 1 radii for 2 positions; give one for each body"
    /// );
    /// # Ok::<(), BodiesError>(())
    /// ```
    pub fn from_positions(positions: &[[T; 3]]) -> BodiesBuilder<'_, T> {
        BodiesBuilder::new(positions)
    }

    /// How many bodies there are.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.position[0].len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The bytes that the columns hold.
    pub(crate) fn bytes(&self) -> usize {
        let state = self.position.iter().chain(&self.velocity).chain(&self.spin);
        let orientation = self.orientation.iter().flat_map(|rows| rows.iter());
        state.chain(orientation).map(Column::bytes).sum::<usize>()
            + self.radius.bytes()
            + self.mass.bytes()
            + self.inertia.bytes()
    }

    /// The same bodies, every number the nearest of another precision.
    ///
    /// ```
    /// # use carom::Bodies;
    /// let ball = Bodies::from_positions(&[[0.1_f64; 3]]).radius(0.5).build()?;
    /// assert_eq!(ball.cast::<f32>().position_of(0).x, 0.1_f32);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    #[must_use]
    pub fn cast<B: Real>(&self) -> Bodies<B> {
        let column = |column: &Column<T>| {
            Column::from_values(column.iter().map(|value| value.cast()), B::ZERO)
        };
        let figure = |figure: &PerBody<T>| match figure {
            PerBody::Same(value) => PerBody::Same(value.cast()),
            // What stands behind the last one is divided by.
            PerBody::Each(values) => {
                PerBody::Each(Column::from_values(values.iter().map(|value| value.cast()), B::ONE))
            }
        };
        let columns = |columns: &Columns3<T>| columns.refs().each(column);
        Bodies {
            origin: self.origin,
            position: columns(&self.position),
            velocity: columns(&self.velocity),
            spin: columns(&self.spin),
            orientation: self.orientation.as_ref().map(|rows| Box::new(rows.refs().each(column))),
            radius: figure(&self.radius),
            mass: figure(&self.mass),
            inertia: figure(&self.inertia),
        }
    }

    /// Multiplies all velocities, of centres and angular ones, by a factor: −1
    /// turns the motion back.
    ///
    /// ```
    /// # use carom::Bodies;
    /// let ball = Bodies::from_positions(&[[0.0; 3]]).velocities(&[[1.0, 2.0, 0.0]]).radius(0.5);
    /// let mut back = ball.build()?;
    /// back.scale_motion(-1.0);
    /// assert_eq!(back.velocity_of(0).to_array(), [-1.0, -2.0, 0.0]);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    pub fn scale_motion(&mut self, factor: T) {
        for column in self.velocity.iter_mut().chain(&mut self.spin) {
            for value in column.iter_mut() {
                *value = *value * factor;
            }
        }
    }

    /// Centre of body `index`, length.
    ///
    /// ```
    /// # use carom::Bodies;
    /// let ball = Bodies::from_positions(&[[1.0, 2.0, 3.0]]).spins(&[[0.0, 0.0, 4.0]]);
    /// let ball = ball.radius(0.5).build()?;
    /// assert_eq!(ball.position_of(0).to_array(), [1.0, 2.0, 3.0]);
    /// assert_eq!(ball.velocity_of(0).to_array(), [0.0; 3]);
    /// assert_eq!(ball.spin_of(0).z, 4.0);
    /// assert_eq!(ball.orientation_of(0), carom::mat3::Mat3::IDENTITY);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    ///
    /// # Panics
    /// If there are no more than `index` bodies, as the next three.
    #[must_use]
    pub fn position_of(&self, index: usize) -> Vec3<T> {
        at(&self.position, index)
    }

    /// Velocity of body `index`, length per time.
    #[must_use]
    pub fn velocity_of(&self, index: usize) -> Vec3<T> {
        at(&self.velocity, index)
    }

    /// Angular velocity of body `index`, rad per time.
    #[must_use]
    pub fn spin_of(&self, index: usize) -> Vec3<T> {
        at(&self.spin, index)
    }

    /// `m v` of body `index`, mass × length per time.
    pub(crate) fn momentum_of(&self, index: usize) -> Vec3<f64> {
        self.velocity_of(index).cast::<f64>() * self.mass.of(index).to_f64()
    }

    /// `½ m v²`, `½ I w²` and `−m g·c` of body `index`, mass × length² per time².
    pub(crate) fn energy_of(&self, index: usize, gravity: Vec3<f64>) -> [f64; 3] {
        let mass = self.mass.of(index).to_f64();
        let inertia = self.inertia.of(index).to_f64();
        [
            0.5 * mass * self.velocity_of(index).cast::<f64>().length_squared(),
            0.5 * inertia * self.spin_of(index).cast::<f64>().length_squared(),
            -mass * gravity.dot(self.position_of(index).cast()),
        ]
    }

    /// Orientation of body `index`: body axes to world axes.
    #[must_use]
    pub fn orientation_of(&self, index: usize) -> Mat3<T> {
        match &self.orientation {
            None => Mat3::IDENTITY,
            Some(rows) => Mat3::from_rows(array::from_fn(|k| rows[k][index])),
        }
    }
}

/// Element `index` of three columns.
#[inline(always)]
pub(crate) fn at<T: Real>(columns: &Columns3<T>, index: usize) -> Vec3<T> {
    Vec3::new(columns[0][index], columns[1][index], columns[2][index])
}
