//! Contact: what two surfaces do to each other when they meet.

mod surface;

pub use surface::Surface;
