//! Surface: what happens to the slip of two surfaces when they meet.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

/// The surfaces of all bodies and surroundings of a scene. Both kinds conserve
/// energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
pub enum Surface {
    /// Frictionless, `e = 1, β = −1`: a contact pushes along the normal only,
    /// and spins never change.
    #[default]
    Smooth,
    /// Perfectly rough, `e = β = 1`: a contact reverses the relative velocity
    /// of the surfaces, the tangential part too.
    Rough,
}

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Smooth => "smooth",
            Self::Rough => "rough",
        })
    }
}
