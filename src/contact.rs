//! Contact: when two surfaces meet, and what they do to each other.

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
