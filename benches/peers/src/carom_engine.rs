//! carom as a peer: to be filled in when its stepped engine exists.
//!
//! What it has to be: a type per precision that implements
//! [`Peer`](crate::peer::Peer) (name, precision, `world`) and a
//! [`World`](crate::peer::World) around the stepped engine; then [`engines`]
//! returns both.

use crate::peer::Peer;

/// The carom engines to measure.
pub fn engines() -> Vec<Box<dyn Peer>> {
    Vec::new()
}
