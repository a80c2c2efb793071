//! Surface: the list of contact laws, by the names that a scene gives them.

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::law::Laws;

/// The surfaces of all bodies and surroundings of a scene: the name of a
/// contact [law](super::Law). Both kinds conserve energy.
///
/// ```
/// use carom::Surface;
/// assert_eq!(Surface::default(), Surface::Smooth);
/// assert_eq!(Surface::Rough.to_string(), "rough");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "program", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "files", serde(rename_all = "kebab-case"))]
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

/// An expression with `$law` as the [`Laws`] of a surface: one instance of it
/// for each law.
macro_rules! with_law {
    ($surface:expr, $law:ident => $expression:expr) => {
        match $surface {
            $crate::contact::Surface::Smooth => {
                let $law = $crate::contact::Smooth;
                $expression
            }
            $crate::contact::Surface::Rough => {
                let $law = $crate::contact::Rough;
                $expression
            }
        }
    };
}
pub(crate) use with_law;

impl fmt::Display for Surface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Smooth => "smooth",
            Self::Rough => "rough",
        })
    }
}

impl Surface {
    /// Whether collisions read and change spins.
    ///
    /// ```
    /// use carom::Surface;
    /// assert!(Surface::Rough.changes_spins() && !Surface::Smooth.changes_spins());
    /// ```
    #[must_use]
    pub fn changes_spins(self) -> bool {
        with_law!(self, law => changes_spins(law))
    }
}

fn changes_spins<W: Laws<f64>>(_: W) -> bool {
    W::CHANGES_SPINS
}
