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

use crate::compensated::two_sum;
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

/// What the rounding of a sum leaves out, for each body: it is added in the next
/// step, so that a body that moves by less than the last digit of its position
/// moves nevertheless.
///
/// Columns as those that they belong to; without a field those of the velocity
/// may be empty.
#[derive(Debug)]
pub struct Remainders<'a, T> {
    /// Of the positions, length.
    pub position: [&'a mut [T]; 3],
    /// Of the velocities, length per time.
    pub velocity: [&'a mut [T]; 3],
}

/// [`flight_and_fastest`] by compensated sums: after any number of steps a position
/// is off by a few units in its last digit and a few `ε` of the way flown, not by half
/// a unit for each step (Neumaier, *ZAMM* 54, 1974).
///
/// ```
/// use carom::Vec3;
/// use carom::motion::flight::{Remainders, compensated_flight_and_fastest};
/// use carom::motion::integrator::Coasting;
/// use carom::space::OpenSpace;
///
/// // Each step is less than half a unit in the last digit of 1000.
/// let (mut x, mut y, mut z) = ([1000.0_f32], [0.0], [0.0]);
/// let (mut u, mut v, mut w) = ([1.0], [0.0], [0.0]);
/// let (mut low, mut none) = ([[0.0]; 3], [[]; 3]);
/// for _ in 0..100_000 {
///     let remainders = Remainders {
///         position: low.each_mut().map(|column| column.as_mut_slice()),
///         velocity: none.each_mut().map(|column: &mut [f32; 0]| column.as_mut_slice()),
///     };
///     compensated_flight_and_fastest::<f32, Coasting, _>(
///         [&mut x, &mut y, &mut z],
///         [&mut u, &mut v, &mut w],
///         remainders,
///         Vec3::ZERO,
///         1e-5,
///         OpenSpace,
///     );
/// }
/// assert_eq!(x, [1001.0]);
/// ```
pub fn compensated_flight_and_fastest<L: Lane, I: FlightStep, S: Wrap<L::Scalar>>(
    position: [&mut [L::Scalar]; 3],
    velocity: [&mut [L::Scalar]; 3],
    remainders: Remainders<'_, L::Scalar>,
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) -> L::Scalar {
    let len = shortest(&position).min(shortest(&velocity)).min(shortest(&remainders.position));
    let kicks = if I::CHANGES_VELOCITY { shortest(&remainders.velocity) } else { len };
    let len = len.min(kicks);
    let kicked = if I::CHANGES_VELOCITY { len } else { 0 };
    let (positions, last_positions) = lanes_and_tail::<L, 3>(position, len);
    let (velocities, last_velocities) = lanes_and_tail::<L, 3>(velocity, len);
    let (low, last_low) = lanes_and_tail::<L, 3>(remainders.position, len);
    let (kicks, last_kicks) = lanes_and_tail::<L, 3>(remainders.velocity, kicked);
    let all = [positions, velocities, low, kicks];
    let last = [last_positions, last_velocities, last_low, last_kicks];
    let fastest = compensated_arrays::<L, I, S>(all, acceleration, dt, space);
    fastest.greater(compensated_arrays::<L::Scalar, I, S>(last, acceleration, dt, space))
}

// Not inlined, since every width has the same tail.
#[inline(never)]
fn compensated_arrays<L: Lane, I: FlightStep, S: Wrap<L::Scalar>>(
    [mut positions, mut velocities, mut low, mut kicks]: [Arrays<L, 3>; 4],
    acceleration: Vec3<L::Scalar>,
    dt: L::Scalar,
    space: S,
) -> L::Scalar {
    let (acceleration, dt) = (Vec3::<L>::splat(acceleration), L::splat(dt));
    let at = |[x, y, z]: &Arrays<L, 3>, k: usize| Vec3::<L>::from_arrays([x[k], y[k], z[k]]);
    let put = |[x, y, z]: &mut Arrays<L, 3>, k: usize, value: Vec3<L>| {
        [x[k], y[k], z[k]] = value.to_arrays();
    };
    let mut fastest = L::ZERO;
    for k in 0..positions[0].len() {
        let kick = if I::CHANGES_VELOCITY { at(&kicks, k) } else { Vec3::ZERO };
        let (places, speeds) = ([at(&positions, k), at(&low, k)], [at(&velocities, k), kick]);
        let [places, speeds] = compensated_step::<L, I>(places, speeds, acceleration, dt);
        put(&mut positions, k, space.wrap(places[0]));
        put(&mut low, k, places[1]);
        if I::CHANGES_VELOCITY {
            put(&mut velocities, k, speeds[0]);
            put(&mut kicks, k, speeds[1]);
        }
        fastest = speeds[0].length_squared().greater(fastest);
    }
    greatest(fastest)
}

/// A step of flight by compensated sums: the position and the velocity after it, each with
/// what its rounding leaves out.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::flight::compensated_step;
/// use carom::motion::integrator::Coasting;
///
/// let (far, slow) = (Vec3::new(1e20, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0));
/// let at = [[far, Vec3::ZERO], [slow, Vec3::ZERO]];
/// let after = compensated_step::<f64, Coasting>(at[0], at[1], Vec3::ZERO, 0.5);
/// assert_eq!(after, [[far, slow * 0.5], at[1]]);
/// ```
#[inline(always)]
pub fn compensated_step<L: Lane, I: FlightStep>(
    position: [Vec3<L>; 2],
    velocity: [Vec3<L>; 2],
    acceleration: Vec3<L>,
    dt: L,
) -> [[Vec3<L>; 2]; 2] {
    let sum = |[sum, rest]: [Vec3<L>; 2], term| {
        let (sum, rest) = compensated_sum(sum, rest, term);
        [sum, rest]
    };
    let way = I::mean_velocity(velocity[0], acceleration, dt) * dt;
    let after = if I::CHANGES_VELOCITY { sum(velocity, acceleration * dt) } else { velocity };
    [sum(position, way), after]
}

/// A sum and what its rounding leaves out, once a term is added to both.
///
/// ```
/// use carom::Vec3;
/// use carom::motion::flight::compensated_sum;
/// let one = Vec3::new(1.0, 1.0, 1.0);
/// let (sum, rest) = compensated_sum(one * 1e20, Vec3::ZERO, one);
/// assert_eq!((sum, rest), (one * 1e20, one));
/// ```
#[inline(always)]
pub fn compensated_sum<L: Lane>(sum: Vec3<L>, rest: Vec3<L>, term: Vec3<L>) -> (Vec3<L>, Vec3<L>) {
    let term = term + rest;
    let (x, x_rest) = two_sum(sum.x, term.x);
    let (y, y_rest) = two_sum(sum.y, term.y);
    let (z, z_rest) = two_sum(sum.z, term.z);
    (Vec3::new(x, y, z), Vec3::new(x_rest, y_rest, z_rest))
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

    /// [`compensated_flight_and_fastest`] by the integrator of this name; without a
    /// field, by [`Coasting`].
    pub fn compensated_flight_and_fastest<L: Lane, S: Wrap<L::Scalar>>(
        self,
        position: [&mut [L::Scalar]; 3],
        velocity: [&mut [L::Scalar]; 3],
        remainders: Remainders<'_, L::Scalar>,
        acceleration: Option<Vec3<L::Scalar>>,
        dt: L::Scalar,
        space: S,
    ) -> L::Scalar {
        let run = match (acceleration, self) {
            (None, _) => compensated_flight_and_fastest::<L, Coasting, S>,
            (Some(_), Self::SemiImplicitEuler) => {
                compensated_flight_and_fastest::<L, SemiImplicitEuler, S>
            }
            (Some(_), Self::ExplicitEuler) => compensated_flight_and_fastest::<L, ExplicitEuler, S>,
            (Some(_), Self::VelocityVerlet) => {
                compensated_flight_and_fastest::<L, VelocityVerlet, S>
            }
        };
        run(position, velocity, remainders, acceleration.unwrap_or(Vec3::ZERO), dt, space)
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
    let len = shortest(&position).min(shortest(&velocity));
    let (positions, last_positions) = lanes_and_tail::<L, 3>(position, len);
    let (velocities, last_velocities) = lanes_and_tail::<L, 3>(velocity, len);
    // Few bodies fill no pack: a call spared is 2 % of a step of five.
    let mut fastest = L::Scalar::ZERO;
    if !positions[0].is_empty() {
        fastest = sweep_arrays::<L, I, S, FASTEST>(positions, velocities, acceleration, dt, space);
    }
    if !last_positions[0].is_empty() {
        let (positions, velocities) = (last_positions, last_velocities);
        fastest = fastest.greater(sweep_arrays::<L::Scalar, I, S, FASTEST>(
            positions,
            velocities,
            acceleration,
            dt,
            space,
        ));
    }
    fastest
}

/// The length of the shortest of three columns.
fn shortest<T>([x, y, z]: &[&mut [T]; 3]) -> usize {
    x.len().min(y.len()).min(z.len())
}

/// The greatest lane that is not negative, else 0.
#[inline(always)]
fn greatest<L: Lane>(lanes: L) -> L::Scalar {
    lanes.to_array().as_ref().iter().fold(L::Scalar::ZERO, |most, &value| value.greater(most))
}

// Not inlined, since every width has the same tail.
#[inline(never)]
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
    greatest(fastest)
}
