//! Studies, from the outside.

mod scaling;
