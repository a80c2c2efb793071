//! Surface: which contact law holds, as a scene names it.

use core::fmt;

use serde::{Deserialize, Serialize};

/// The surfaces of all bodies and surroundings of a scene: the name of a
/// contact [law](super::Law). Both kinds conserve energy.
///
/// ```
/// use carom::Surface;
/// assert_eq!(Surface::default(), Surface::Smooth);
/// assert_eq!(Surface::Rough.to_string(), "rough");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Surface {
    /// [`Smooth`](super::Smooth): a collision pushes along the normal only, and
    /// spins never change.
    #[default]
    Smooth,
    /// [`Rough`](super::Rough): a collision reverses the relative velocity of
    /// the surfaces, the tangential part too.
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
