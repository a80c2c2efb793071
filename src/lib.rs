//! carom simulates rigid spheres in motion.

pub mod bodies;
mod broadphase;
pub mod column;
pub mod compensated;
pub mod contact;
pub mod engine;
pub mod lane;
pub mod mat3;
pub mod motion;
pub mod observe;
pub mod output;
pub mod real;
pub mod scene;
pub mod surroundings;
pub mod trigonometry;
pub mod vec3;
mod workers;
