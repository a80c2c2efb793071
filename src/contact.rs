//! Contact: when two surfaces touch, and what a collision does.
//!
//! Two bodies *meet* where their paths bring them into *contact*: the surfaces
//! touch. A *collision* is a contact at which an impulse acts, since the bodies
//! approach each other. [`contact_time`] and [`past_contact`] say when bodies
//! meet; [`collide`] gives the impulse, by a [`Law`].

mod approach;
mod fall;
mod free_flight;
mod impulse;
mod law;
mod surface;
mod tangent;
mod taylor;
mod time;

pub(crate) use approach::{Approach, greatest_component, hop_of};
pub(crate) use fall::{Start, fall_of_height};
pub(crate) use free_flight::FreeFlight;
pub use impulse::{Impulse, Party, collide, collide_spread};
pub(crate) use law::one_material;
pub use law::*;
pub use surface::Surface;
pub(crate) use surface::with_law;
pub(crate) use tangent::{March, tangent_march};
pub(crate) use taylor::{Expansion, first_fall_of, product};
pub(crate) use time::ContactEquation;
pub use time::{ContactTime, PastContact, contact_time, past_contact};
