//! The studies: what they measure on scenes whose answers are known, and the
//! double-double that they take for the truth.

mod double_double;
mod precision;
