//! The studies: what they measure on scenes whose answers are known, and the
//! double-double that they take for the truth.

#[path = "../common/mod.rs"]
mod common;

mod double_double;
