//! The properties of the tests, for the fuzz targets and for `seeded`.

#[path = "../../tests/common/mod.rs"]
pub mod common;
#[path = "../../tests/common/properties/mod.rs"]
pub mod properties;
