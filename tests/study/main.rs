//! The studies.

mod stability;
