//! Momentum and angular momentum of a state.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::bodies::Bodies;
use crate::compensated::CompensatedSum;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// Momentum of all bodies, `Σ m v`, mass × length per time.
///
/// ```
/// use carom::{Momentum, Vec3};
/// assert_eq!(Momentum(Vec3::new(1.0, 0.0, 2.5)).to_string(), "(1, 0, 2.5)");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum(pub Vec3<f64>);

/// Angular momentum of all bodies about the origin, `Σ (m c × v + I w)`,
/// mass × length² per time.
///
/// ```
/// use carom::{AngularMomentum, Vec3};
/// assert_eq!(AngularMomentum(Vec3::new(1.0, 0.0, 2.5)).to_string(), "(1, 0, 2.5)");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AngularMomentum(pub Vec3<f64>);

impl Momentum {
    /// The momentum of bodies.
    ///
    /// ```
    /// use carom::{Bodies, Momentum};
    /// let ball = Bodies::from_positions(&[[0.0; 3]]).velocities(&[[3.0, 0.0, 0.0]]);
    /// let ball = ball.radius(0.5).mass(2.0).build()?;
    /// assert_eq!(Momentum::of(&ball).0.to_array(), [6.0, 0.0, 0.0]);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>) -> Self {
        Self(total(bodies, |index| bodies.momentum_of(index)))
    }
}

impl AngularMomentum {
    /// The angular momentum of bodies about the origin.
    ///
    /// ```
    /// use carom::{AngularMomentum, Bodies};
    /// let ball = Bodies::from_positions(&[[0.0; 3]]).spins(&[[0.0, 0.0, 10.0]]);
    /// let ball = ball.radius(0.5).build()?;
    /// assert_eq!(AngularMomentum::of(&ball).0.z, 1.0);
    /// # Ok::<(), carom::bodies::BodiesError>(())
    /// ```
    #[must_use]
    pub fn of<T: Real>(bodies: &Bodies<T>) -> Self {
        Self(total(bodies, |index| {
            let orbital = bodies
                .position_of(index)
                .cast::<f64>()
                .cross(bodies.velocity_of(index).cast::<f64>());
            orbital * bodies.mass.of(index).to_f64()
                + bodies.spin_of(index).cast::<f64>() * bodies.inertia.of(index).to_f64()
        }))
    }
}

/// The sum over the bodies of a vector of each.
fn total<T: Real>(bodies: &Bodies<T>, term: impl Fn(usize) -> Vec3<f64>) -> Vec3<f64> {
    let mut sums = [CompensatedSum::default(); 3];
    for index in 0..bodies.len() {
        for (sum, component) in sums.iter_mut().zip(term(index).to_array()) {
            sum.add(component);
        }
    }
    // A sum of negative zeros is a zero like any other.
    sums.each(|sum| sum.value() + 0.0).into()
}

macro_rules! shown_as_vector {
    ($type:ident) => {
        impl fmt::Display for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "({}, {}, {})", self.0.x, self.0.y, self.0.z)
            }
        }

        #[cfg(feature = "files")]
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.0.to_array().serialize(serializer)
            }
        }

        #[cfg(feature = "files")]
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                <[f64; 3]>::deserialize(deserializer).map(|vector| Self(vector.into()))
            }
        }
    };
}

shown_as_vector!(Momentum);
shown_as_vector!(AngularMomentum);
