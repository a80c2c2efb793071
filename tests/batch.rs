//! Batches: each scene of one has the bits of the same scene in a world of its own.

#[path = "batch/changes.rs"]
mod changes;
#[path = "batch/same_bits.rs"]
mod same_bits;
