//! Sweeps of free flight over columns.
//!
//! ```
//! use carom::motion::flight::flight;
//! use carom::motion::integrator::VelocityVerlet;
//! use carom::space::OpenSpace;
//! use carom::vec3::Vec3;
//!
//! // Five bodies of another program, four at a time and one more.
//! let (mut x, mut y, mut z) = ([0.0; 5], [0.0; 5], [0.0; 5]);
//! let (mut u, mut v, mut w) = ([1.0; 5], [0.0; 5], [2.0; 5]);
//! let gravity = Vec3::new(0.0, 0.0, -4.0);
//! flight::<wide::f64x4, VelocityVerlet, _>(
//!     [&mut x, &mut y, &mut z],
//!     [&mut u, &mut v, &mut w],
//!     gravity,
//!     0.5,
//!     OpenSpace,
//! );
//! assert_eq!((x, z, w), ([0.5; 5], [0.5; 5], [0.0; 5]));
//! ```

use crate::lane::Lane;
use crate::motion::integrator::{
    Coasting, ExplicitEuler, FlightStep, Integrator, SemiImplicitEuler, VelocityVerlet,
};
use crate::motion::sweep::{Arrays, lanes_and_tail};
use crate::real::Real;
use crate::vec3::Vec3;

/// Where a point that has left its space is put.
///
/// ```
/// use carom::motion::flight::Wrap;
/// use carom::{PeriodicBox, Vec3};
///
/// let space = PeriodicBox::new([0.0; 3], [10.0; 3]);
/// assert_eq!(space.wrap(Vec3::new(11.0, 5.0, -1.0)), Vec3::new(1.0, 5.0, 9.0));
/// ```
pub trait Wrap<T: Real>: Copy + Send + Sync {
    /// The image of a point that represents it, length.
    fn wrap<L: Lane<Scalar = T>>(self, point: Vec3<L>) -> Vec3<L>;
}

/// Takes one step of flight for every body: whole lanes through `L`, the rest
/// one by one, with the same bits.
///
/// `position` in length, `velocity` in length per time, one column for each
/// component. As many bodies move as the shortest column has.
///
/// See the [module](self) for an example.
pub fn flight<L: Lane, I: FlightStep, S: Wrap<L::Scalar>>(
    position: [&mut [L::Scalar]; 3],
    velocity: [&mut [L::Scalar]; 3],
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) {
    sweep::<L, I, S, false>(position, velocity, acceleration, dt, space);
}

/// [`flight`], and the greatest `v·v` of all bodies after it, in the same
/// sweep. NaN does not count; without bodies it is 0.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::flight::flight_and_fastest;
/// use carom::motion::integrator::Coasting;
/// use carom::space::OpenSpace;
///
/// let (mut x, mut y, mut z) = ([0.0; 2], [0.0; 2], [0.0; 2]);
/// let (mut u, mut v, mut w) = ([3.0, 1.0], [4.0, 0.0], [0.0; 2]);
/// let fastest = flight_and_fastest::<f64, Coasting, _>(
///     [&mut x, &mut y, &mut z],
///     [&mut u, &mut v, &mut w],
///     Vec3::ZERO,
///     0.5,
///     OpenSpace,
/// );
/// assert_eq!((fastest, x), (25.0, [1.5, 0.5]));
/// ```
pub fn flight_and_fastest<L: Lane, I: FlightStep, S: Wrap<L::Scalar>>(
    position: [&mut [L::Scalar]; 3],
    velocity: [&mut [L::Scalar]; 3],
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) -> L::Scalar {
    sweep::<L, I, S, true>(position, velocity, acceleration, dt, space)
}

impl Integrator {
    /// [`flight`] by the integrator of this name; without a field, by
    /// [`Coasting`].
    ///
    /// ```
    /// use carom::space::OpenSpace;
    /// use carom::{Integrator, Vec3};
    ///
    /// let (mut x, mut y, mut z) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    /// let (mut u, mut v, mut w) = ([1.0; 4], [0.0; 4], [0.0; 4]);
    /// Integrator::VelocityVerlet.flight::<wide::f64x4, _>(
    ///     [&mut x, &mut y, &mut z],
    ///     [&mut u, &mut v, &mut w],
    ///     Some(Vec3::new(0.0, 0.0, -8.0)),
    ///     0.5,
    ///     OpenSpace,
    /// );
    /// assert_eq!((x[0], z[0], w[0]), (0.5, -1.0, -4.0));
    /// ```
    pub fn flight<L: Lane, S: Wrap<L::Scalar>>(
        self,
        position: [&mut [L::Scalar]; 3],
        velocity: [&mut [L::Scalar]; 3],
        acceleration: Option<Vec3<L::Scalar>>,
        dt: L::Scalar,
        space: S,
    ) {
        self.sweep::<L, S, false>(position, velocity, acceleration, dt, space);
    }

    /// [`flight_and_fastest`] by the integrator of this name; without a field,
    /// by [`Coasting`].
    ///
    /// ```
    /// use carom::space::OpenSpace;
    /// use carom::Integrator;
    ///
    /// let (mut x, mut y, mut z) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    /// let (mut u, mut v, mut w) = ([3.0, 1.0], [4.0, 0.0], [0.0; 2]);
    /// let fastest = Integrator::VelocityVerlet.flight_and_fastest::<f64, _>(
    ///     [&mut x, &mut y, &mut z],
    ///     [&mut u, &mut v, &mut w],
    ///     None,
    ///     0.5,
    ///     OpenSpace,
    /// );
    /// assert_eq!((fastest, x), (25.0, [1.5, 0.5]));
    /// ```
    pub fn flight_and_fastest<L: Lane, S: Wrap<L::Scalar>>(
        self,
        position: [&mut [L::Scalar]; 3],
        velocity: [&mut [L::Scalar]; 3],
        acceleration: Option<Vec3<L::Scalar>>,
        dt: L::Scalar,
        space: S,
    ) -> L::Scalar {
        self.sweep::<L, S, true>(position, velocity, acceleration, dt, space)
    }

    fn sweep<L: Lane, S: Wrap<L::Scalar>, const FASTEST: bool>(
        self,
        position: [&mut [L::Scalar]; 3],
        velocity: [&mut [L::Scalar]; 3],
        acceleration: Option<Vec3<L::Scalar>>,
        dt: L::Scalar,
        space: S,
    ) -> L::Scalar {
        let run = match (acceleration, self) {
            (None, _) => sweep::<L, Coasting, S, FASTEST>,
            (Some(_), Self::SemiImplicitEuler) => sweep::<L, SemiImplicitEuler, S, FASTEST>,
            (Some(_), Self::ExplicitEuler) => sweep::<L, ExplicitEuler, S, FASTEST>,
            (Some(_), Self::VelocityVerlet) => sweep::<L, VelocityVerlet, S, FASTEST>,
        };
        run(position, velocity, acceleration.unwrap_or(Vec3::ZERO), dt, space)
    }
}

/// All bodies: the whole lanes, then the tail.
fn sweep<L: Lane, I: FlightStep, S: Wrap<L::Scalar>, const FASTEST: bool>(
    position: [&mut [L::Scalar]; 3],
    velocity: [&mut [L::Scalar]; 3],
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) -> L::Scalar {
    let len = position.iter().chain(&velocity).map(|column| column.len()).min().unwrap_or(0);
    let (positions, last_positions) = lanes_and_tail::<L, 3>(position, len);
    let (velocities, last_velocities) = lanes_and_tail::<L, 3>(velocity, len);
    let fastest = sweep_arrays::<L, I, S, FASTEST>(positions, velocities, acceleration, dt, space);
    let fastest_of_last = sweep_arrays::<L::Scalar, I, S, FASTEST>(
        last_positions,
        last_velocities,
        acceleration,
        dt,
        space,
    );
    fastest.greater(fastest_of_last)
}

#[inline(always)]
fn sweep_arrays<L: Lane, I: FlightStep, S: Wrap<L::Scalar>, const FASTEST: bool>(
    [x, y, z]: Arrays<L, 3>,
    [u, v, w]: Arrays<L, 3>,
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) -> L::Scalar {
    let (acceleration, dt) = (Vec3::<L>::splat(acceleration), L::splat(dt));
    let mut fastest = L::ZERO;
    for (((((x, y), z), u), v), w) in x.iter_mut().zip(y).zip(z).zip(u).zip(v).zip(w) {
        let position = Vec3::<L>::from_arrays([*x, *y, *z]);
        let velocity = Vec3::<L>::from_arrays([*u, *v, *w]);
        let (position, velocity) = I::step(position, velocity, acceleration, dt);
        [*x, *y, *z] = space.wrap(position).to_arrays();
        if I::CHANGES_VELOCITY {
            [*u, *v, *w] = velocity.to_arrays();
        }
        if FASTEST {
            // By comparison, so that neither the order of the bodies nor the
            // width of the lane has a say.
            fastest = velocity.length_squared().greater(fastest);
        }
    }
    fastest.to_array().as_ref().iter().fold(L::Scalar::ZERO, |most, &value| value.greater(most))
}
