//! Law: the impulse that two surfaces give each other.
//!
//! What every contact has in common is in [`collide`](super::collide). A law
//! adds two things: the factor `−(1 + e)` of the normal impulse, and the
//! tangential impulse. Each law is one file of `contact/law/`, and one entry of
//! the list in `contact/surface.rs`.

mod rough;
mod smooth;

use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

pub use rough::Rough;
pub use smooth::Smooth;

/// The contact law of the pairs in a pack, with the numbers of each pair in its
/// lane.
///
/// ```
/// use carom::contact::{Closing, Law, Party, Sliding, collide};
/// use carom::lane::Lane;
/// use carom::Vec3;
///
/// /// A frictionless surface that gives back a part of the speed.
/// #[derive(Clone, Copy)]
/// struct Clay<L> {
///     restitution: L,
/// }
///
/// impl<L: Lane> Law<L> for Clay<L> {
///     const CHANGES_SPINS: bool = false;
///
///     fn normal_factor(&self, _: &Closing<L>) -> L {
///         -(L::ONE + self.restitution)
///     }
///
///     fn tangential(&self, _: &Closing<L>, _: L, _: &Sliding<L>) -> Vec3<L> {
///         Vec3::ZERO
///     }
/// }
///
/// let mut ball = Party { velocity: Vec3::new(1.0, 0.0, -2.0), ..Party::immovable() };
/// (ball.inverse_mass, ball.share) = (1.0, 1.0);
/// let clay = Clay { restitution: 0.25 };
/// collide(clay, Vec3::new(0.0, 0.0, 0.5), &mut ball, &mut Party::immovable());
/// assert_eq!(ball.velocity.to_array(), [1.0, 0.0, 0.5]);
/// ```
pub trait Law<L: Lane>: Copy {
    /// Whether collisions read and change spins. Where they do not, no spin is
    /// loaded and `tangential` is not called.
    const CHANGES_SPINS: bool;

    /// `−(1 + e)`: the change of the normal velocity, in units of it.
    fn normal_factor(&self, closing: &Closing<L>) -> L;

    /// The tangential impulse on the first body, mass × length per time.
    /// `normal_factor` is what the law gave for this contact.
    fn tangential(&self, closing: &Closing<L>, normal_factor: L, sliding: &Sliding<L>) -> Vec3<L>;
}

/// How the surfaces of a contact close in on each other.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::Closing;
///
/// // Centres 2 apart that approach each other at a speed of 3.
/// let offset = Vec3::new(2.0, 0.0, 0.0);
/// let closing = Closing { offset, approach: -6.0, rate: -1.5, inverse_masses: 2.0 };
/// assert_eq!(closing.normal_speed_squared(), 9.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Closing<L> {
    /// `x`: from the centre of the second body to that of the first, length.
    pub offset: Vec3<L>,
    /// `V·x`, length² per time; negative where the bodies approach.
    pub approach: L,
    /// `(V·x)/(x·x)`, 1 per time: `x` times it is the normal velocity.
    pub rate: L,
    /// `1/m₁ + 1/m₂`.
    pub inverse_masses: L,
}

impl<L: Lane> Closing<L> {
    /// The square of the normal velocity, without a root.
    #[inline(always)]
    #[must_use]
    pub fn normal_speed_squared(&self) -> L {
        self.approach * self.rate
    }
}

/// How the surfaces of a contact slide on each other.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::{Closing, Law, Rough, Sliding};
///
/// let offset = Vec3::new(1.0, 0.0, 0.0);
/// let closing = Closing { offset, approach: -1.0, rate: -1.0, inverse_masses: 2.0 };
/// let sliding = Sliding { slip: Vec3::new(0.0, 7.0, 0.0), inverse_masses: 7.0 };
/// // Rough surfaces turn the slip round.
/// assert_eq!(Rough.tangential(&closing, -2.0, &sliding).y, -2.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sliding<L> {
    /// `T`: the tangential velocity of the first surface relative to the
    /// second, length per time.
    pub slip: Vec3<L>,
    /// `1/m₁ + 1/m₂ + (l₁²/I₁ + l₂²/I₂) x·x`: the change of the slip for a unit
    /// of tangential impulse.
    pub inverse_masses: L,
}

/// The laws of all contacts of a scene: what [`Law`] holds between two
/// materials.
///
/// A law without numbers is its own `Laws`.
///
/// ```
/// use carom::contact::{Law, Laws, Rough, Smooth};
///
/// fn changes_spins<W: Laws<f64>>(_: W) -> bool {
///     <W::Of<wide::f64x4> as Law<wide::f64x4>>::CHANGES_SPINS
/// }
/// assert!(changes_spins(Rough) && !changes_spins(Smooth));
/// ```
pub trait Laws<T: Real>: Copy + Send + Sync {
    /// See [`Law::CHANGES_SPINS`].
    const CHANGES_SPINS: bool;

    /// The law of a pack of contacts.
    type Of<L: Lane<Scalar = T>>: Law<L>;

    /// The law of a pack of contacts, lane `k` between two `materials(k)`.
    fn between<L: Lane<Scalar = T>>(&self, materials: impl Fn(usize) -> [u32; 2]) -> Self::Of<L>;
}

/// Bodies and fixed parts have no materials yet: there is one.
pub(crate) fn one_material(_: usize) -> [u32; 2] {
    [0; 2]
}
