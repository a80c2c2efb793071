//! Studies: what a method costs and how far off it is.

pub mod fit;
