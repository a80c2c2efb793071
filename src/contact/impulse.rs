//! Impulse: what two bodies in contact give each other.
//!
//! One formula serves two spheres of any masses, radii and inertia, and a sphere
//! with anything immovable, whose inverse mass and inertia are zero. It needs
//! no unit normal and no root: with the offset `x` from the second centre to
//! the first,
//!
//! ```text
//! V   = v₁ − v₂ − (l₁ w₁ + l₂ w₂) × x            lᵢ = rᵢ/(r₁ + r₂)
//! J_n = −2 (V·x) x / (x·x (1/m₁ + 1/m₂))
//! T   = V − (V·x) x / (x·x)
//! J_t = −2 T / (1/m₁ + 1/m₂ + (l₁²/I₁ + l₂²/I₂) x·x)
//! ```
//!
//! What a law changes is the factor −2 of either impulse ([`law`](super::law)).
//!
//! A normalised normal would bias the energy by up to 0.76 ε per collision
//! where `|x|` is near a power of two. The arms `lᵢ x` are in proportion to the
//! true distance, so angular momentum is conserved also where rounding or a
//! step has left an overlap.
//!
//! Source: the elastic maps of smooth and perfectly rough spheres (Bryan 1894;
//! Chapman and Cowling, *The Mathematical Theory of Non-uniform Gases*, §11.6).

use super::law::{Closing, Law, Sliding};
use crate::lane::Lane;
use crate::vec3::Vec3;

/// One of the two bodies of a contact.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::{Party, Rough, collide};
///
/// // A rolling ball comes to a rough wall, turning with its motion.
/// let mut ball = Party {
///     velocity: Vec3::new(1.0, 0.0, 0.0),
///     spin: Vec3::new(0.0, 2.0, 0.0),
///     inverse_mass: 1.0,
///     inverse_inertia: 10.0,
///     share: 1.0,
/// };
/// let from_wall = Vec3::new(-0.5, 0.0, 0.0);
/// collide(Rough, from_wall, &mut ball, &mut Party::immovable());
/// assert_eq!(ball.velocity.x, -1.0);
/// assert!(ball.velocity.z > 0.0); // the grip lifts it
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Party<L> {
    /// Velocity of the centre, length per time.
    pub velocity: Vec3<L>,
    /// Angular velocity, rad per time.
    pub spin: Vec3<L>,
    /// `1/m`; 0 for an immovable body.
    pub inverse_mass: L,
    /// `1/I`; 0 for an immovable body.
    pub inverse_inertia: L,
    /// The part of the offset between the centres that is this body's arm:
    /// `r/(r₁ + r₂)`.
    pub share: L,
}

impl<L: Lane> Party<L> {
    /// What never moves. The offset of a contact with it is the other body's
    /// arm, whose share is then 1.
    ///
    /// ```
    /// use carom::contact::Party;
    /// assert_eq!(Party::<f64>::immovable().inverse_mass, 0.0);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn immovable() -> Self {
        Self {
            velocity: Vec3::ZERO,
            spin: Vec3::ZERO,
            inverse_mass: L::ZERO,
            inverse_inertia: L::ZERO,
            share: L::ZERO,
        }
    }

    /// Adds an impulse to the body's motion.
    #[inline(always)]
    fn receive<W: Law<L>>(&mut self, normal: Vec3<L>, tangential: Vec3<L>, torque: Vec3<L>) {
        if W::CHANGES_SPINS {
            self.velocity += (normal + tangential) * self.inverse_mass;
            self.spin -= torque * (self.share * self.inverse_inertia);
        } else {
            self.velocity += normal * self.inverse_mass;
        }
    }
}

/// The impulses of a collision on the first body; the second one receives the
/// opposite.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::{Party, Smooth, collide};
///
/// let mut ball = Party { velocity: Vec3::new(0.0, 0.0, -2.0_f64), ..Party::immovable() };
/// (ball.inverse_mass, ball.share) = (0.5, 1.0);
/// let up = Vec3::new(0.0, 0.0, 0.5);
/// let impulse = collide(Smooth, up, &mut ball, &mut Party::immovable());
/// assert!(impulse.approaching);
/// assert_eq!((impulse.normal.z, impulse.tangential), (8.0, Vec3::ZERO));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Impulse<L: Lane> {
    /// Whether the bodies approached each other. Elsewhere both impulses are zero.
    pub approaching: L::Mask,
    /// Normal impulse, mass × length per time.
    pub normal: Vec3<L>,
    /// Tangential impulse, mass × length per time; zero between smooth bodies.
    pub tangential: Vec3<L>,
}

/// Collides two bodies whose surfaces touch: changes their motion and returns
/// the impulses on `a`. Bodies that do not approach each other, `V·x ≥ 0`, are
/// left as they are, bit by bit.
///
/// `offset` points from the centre of `b` to the centre of `a`; from the point
/// of contact to the centre of `a` if `b` is immovable. Its length must be
/// within the square root of the precision's range.
///
/// ```
/// use carom::contact::{Party, Smooth, collide};
/// use carom::vec3::Vec3;
///
/// let rest = Party {
///     velocity: Vec3::new(0.0, 0.0, 0.0),
///     spin: Vec3::new(0.0, 0.0, 0.0),
///     inverse_mass: 1.0,
///     inverse_inertia: 10.0,
///     share: 0.5,
/// };
/// let mut a = Party { velocity: Vec3::new(1.0, 0.0, 0.0), ..rest };
/// let mut b = rest;
/// collide(Smooth, Vec3::new(-1.0, 0.0, 0.0), &mut a, &mut b);
/// assert_eq!(a.velocity.x, 0.0);
/// assert_eq!(b.velocity.x, 1.0);
/// ```
#[inline(always)]
pub fn collide<L: Lane, W: Law<L>>(
    law: W,
    offset: Vec3<L>,
    a: &mut Party<L>,
    b: &mut Party<L>,
) -> Impulse<L> {
    let relative = a.velocity - b.velocity;
    let distance_squared = offset.length_squared();
    let approach = relative.dot(offset);
    let approaching = approach.lt(L::ZERO);
    let rate = approach / distance_squared;
    let along = offset * rate;

    let inverse_masses = a.inverse_mass + b.inverse_mass;
    let closing = Closing { offset, approach, rate, inverse_masses };
    let normal_factor = law.normal_factor(&closing);
    let mut normal = along * (normal_factor / inverse_masses);
    normal = Vec3::select(approaching, normal, Vec3::ZERO);
    let mut tangential = Vec3::ZERO;
    let mut torque = Vec3::ZERO;
    if W::CHANGES_SPINS {
        let slip = relative - (a.spin * a.share + b.spin * b.share).cross(offset) - along;
        let arms = a.share * a.share * a.inverse_inertia + b.share * b.share * b.inverse_inertia;
        let inverse_masses = inverse_masses + arms * distance_squared;
        tangential = law.tangential(&closing, normal_factor, &Sliding { slip, inverse_masses });
        tangential = Vec3::select(approaching, tangential, Vec3::ZERO);
        torque = offset.cross(tangential);
    }

    let before = (*a, *b);
    a.receive::<W>(normal, tangential, torque);
    b.receive::<W>(-normal, -tangential, torque);
    // Not left to adding zeros: −0 + 0 is another bit pattern.
    a.velocity = Vec3::select(approaching, a.velocity, before.0.velocity);
    b.velocity = Vec3::select(approaching, b.velocity, before.1.velocity);
    if W::CHANGES_SPINS {
        a.spin = Vec3::select(approaching, a.spin, before.0.spin);
        b.spin = Vec3::select(approaching, b.spin, before.1.spin);
    }
    Impulse { approaching, normal, tangential }
}

/// [`collide`], in other units for each contact, so that roundings do not add
/// up.
///
/// Equal spheres always touch at one distance, and equal masses have one sum:
/// `x·x` and `−2/(1/m₁ + …)` then are the same numbers in every collision, and
/// round to the same side. The energy of a gas drifts with that, by up to
/// 0.07 ε of a particle's in each of its collisions, linearly in their number.
/// Here lengths and inverse masses are multiplied by `λ = 1 + V_x²/V²` first,
/// which the impulse does not depend on: what is rounded differs from one
/// contact to the next, and errors grow as the square root of the number.
///
/// ```
/// use carom::contact::{Party, Smooth, collide_spread};
/// use carom::vec3::Vec3;
///
/// let rest = Party {
///     velocity: Vec3::new(0.0, 0.0, 0.0),
///     spin: Vec3::new(0.0, 0.0, 0.0),
///     inverse_mass: 1.0,
///     inverse_inertia: 10.0,
///     share: 0.5,
/// };
/// let mut a = Party { velocity: Vec3::new(1.0, 0.0, 0.0), ..rest };
/// let mut b = rest;
/// let impulse = collide_spread(Smooth, Vec3::new(-1.0, 0.0, 0.0), &mut a, &mut b);
/// assert_eq!(impulse.normal.x, -1.0);
/// assert_eq!(b.velocity.x, 1.0);
/// ```
#[inline(always)]
pub fn collide_spread<L: Lane, W: Law<L>>(
    law: W,
    offset: Vec3<L>,
    a: &mut Party<L>,
    b: &mut Party<L>,
) -> Impulse<L> {
    let relative = a.velocity - b.velocity;
    let speed_squared = relative.length_squared();
    let is_moving = speed_squared.gt(L::ZERO);
    let part = relative.x * relative.x / L::select(is_moving, speed_squared, L::ONE);
    let factor = L::ONE + part;
    let scaled = |party: &Party<L>| Party {
        inverse_mass: party.inverse_mass * factor,
        inverse_inertia: party.inverse_inertia * factor,
        share: party.share / factor,
        ..*party
    };
    let (mut first, mut second) = (scaled(a), scaled(b));
    let impulse = collide(law, offset * factor, &mut first, &mut second);
    (a.velocity, a.spin) = (first.velocity, first.spin);
    (b.velocity, b.spin) = (second.velocity, second.spin);
    Impulse {
        approaching: impulse.approaching,
        normal: impulse.normal * factor,
        tangential: impulse.tangential * factor,
    }
}
