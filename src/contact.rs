//! Contact: what two surfaces do to each other when they meet.

mod impulse;
mod surface;
mod time;

pub use impulse::{Impulse, Party, collide};
pub use surface::Surface;
pub use time::{PastContact, past_contact};
