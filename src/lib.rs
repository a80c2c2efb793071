//! carom simulates rigid spheres in motion.

pub mod bodies;
pub mod column;
pub mod lane;
pub mod mat3;
pub mod real;
pub mod surroundings;
pub mod vec3;
