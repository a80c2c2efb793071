//! Contact time: when two spheres in relative free flight touch.

use crate::lane::Lane;
use crate::vec3::Vec3;

/// How long ago two spheres came into contact, on straight relative paths.
#[derive(Clone, Copy, Debug)]
pub struct PastContact<L: Lane> {
    /// Whether the paths, followed back, touch at all.
    pub met: L::Mask,
    /// Time since the surfaces first touched; negative if they have yet to.
    pub ago: L,
}

/// When two spheres at `offset` from each other, moving with `relative`
/// velocity, came into contact; `reach` is the sum of their radii.
///
/// The greater root of `|x − Vτ|² = s²`, each sign of `x·V` in the form that
/// does not cancel, with the discriminant by the vector product,
/// `D = V² s² − |x × V|²`: `b² − V²(x² − s²)` loses half the digits from afar.
#[inline(always)]
pub fn past_contact<L: Lane>(offset: Vec3<L>, relative: Vec3<L>, reach: L) -> PastContact<L> {
    let speed_squared = relative.length_squared();
    let moving_apart = offset.dot(relative);
    let reach_squared = reach * reach;
    let overlap = reach_squared - offset.length_squared();
    let discriminant = speed_squared * reach_squared - offset.cross(relative).length_squared();
    let met = discriminant.gt(L::ZERO) & speed_squared.gt(L::ZERO);
    let root = L::select(met, discriminant, L::ZERO).sqrt();
    let is_apart = moving_apart.gt(L::ZERO);
    let numerator = L::select(is_apart, moving_apart + root, overlap);
    let denominator = L::select(is_apart, speed_squared, root - moving_apart);
    PastContact { met: met & denominator.gt(L::ZERO), ago: numerator / denominator }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::Mask;

    #[test]
    fn finds_the_entry_behind_and_inside() {
        // Relative speed 2 along x, reach 1, contact at x = −1.
        let velocity = Vec3::new(2.0, 0.0, 0.0);
        for (x, ago) in [(-2.0, -0.5), (-1.0, 0.0), (-0.5, 0.25), (0.5, 0.75), (3.0, 2.0)] {
            let contact = past_contact(Vec3::new(x, 0.0, 0.0), velocity, 1.0_f64);
            assert!(contact.met);
            assert_eq!(contact.ago, ago, "at {x}");
        }
        let aside = Vec3::new(0.0, 1.5, 0.0);
        assert!(!past_contact(aside, velocity, 1.0_f64).met);
        assert!(!past_contact(Vec3::new(0.5, 0.0, 0.0), Vec3::ZERO, 1.0_f64).met.any());
    }
}
