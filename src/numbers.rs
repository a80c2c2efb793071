//! Numbers: the precisions, several of them at once, and vectors of them.

pub mod array;
pub mod compensated;
pub mod lane;
pub mod mat3;
pub mod real;
pub mod trigonometry;
pub mod vec3;
