//! What several tests share.
#![allow(dead_code)] // No test uses all of it.

pub mod known;
pub mod numbers;
