//! Contact: when two surfaces touch, and what a collision does.
//!
//! *Contact* is that surfaces touch; a *collision* is a contact at which an
//! impulse acts, since the bodies approach each other. [`contact_time`] and
//! [`past_contact`] say when; [`collide`] gives the impulse, by a [`Law`].

mod approach;
mod fall;
mod impulse;
mod law;
mod surface;
mod time;

pub(crate) use approach::{Approach, greatest_component};
pub(crate) use fall::{Start, fall_of_height};
pub use impulse::{Impulse, Party, collide, collide_spread};
pub use law::{Closing, Law, Laws, Rough, Sliding, Smooth};
pub use surface::Surface;
pub(crate) use time::Encounter;
pub use time::{ContactTime, PastContact, contact_time, past_contact};
