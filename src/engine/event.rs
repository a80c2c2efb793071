//! Event: one collision, as an engine reports it.

use crate::real::Real;
use crate::vec3::Vec3;

/// What a body met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Partner<T> {
    /// Another body, with a greater index, and its motion just after.
    Body {
        /// Its index in the scene.
        index: u32,
        /// Its velocity just after, length per time.
        velocity: Vec3<T>,
        /// Its angular velocity just after, rad per time.
        spin: Vec3<T>,
    },
    /// A part of the surroundings, by its index in the scene.
    Surroundings(u32),
}

/// What receives the collisions, if anything does.
pub type Listener<'a, T> = Option<&'a mut dyn FnMut(&Event<T>)>;

/// One collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event<T: Real> {
    /// Time of the collision since the start.
    pub time: f64,
    /// Index of the first body in the scene.
    pub a: u32,
    /// What it met.
    pub partner: Partner<T>,
    /// Point of contact, length.
    pub point: Vec3<T>,
    /// Unit normal, from the partner to body `a`.
    pub normal: Vec3<T>,
    /// Normal impulse on body `a`, mass × length per time; not negative.
    pub normal_impulse: T,
    /// Tangential impulse on body `a`, mass × length per time.
    pub tangential_impulse: Vec3<T>,
    /// Velocity of body `a` just after, length per time.
    pub velocity: Vec3<T>,
    /// Angular velocity of body `a` just after, rad per time.
    pub spin: Vec3<T>,
}
