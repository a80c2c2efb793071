//! Contact time: when two spheres in relative free flight touch.

use crate::lane::Lane;
use crate::real::Real;
use crate::vec3::Vec3;

/// How long ago two spheres came into contact, on straight relative paths: see
/// [`past_contact`].
///
/// ```
/// use carom::Vec3;
/// use carom::contact::past_contact;
///
/// // Unit spheres that have flown into each other by ½, at a speed of 1.
/// let past = past_contact(Vec3::new(1.5, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0), 2.0_f64);
/// assert!(past.met);
/// assert_eq!(past.ago, 0.5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PastContact<L: Lane> {
    /// Whether the paths, followed back, touch at all.
    pub met: L::Mask,
    /// Time since the surfaces first touched; negative if they have yet to.
    pub ago: L,
}

/// In how much time two spheres come into contact, on straight relative paths:
/// see [`contact_time`].
///
/// ```
/// use carom::Vec3;
/// use carom::contact::contact_time;
///
/// let next = contact_time(Vec3::new(5.0, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0), 2.0_f64);
/// assert!(next.meets);
/// assert_eq!(next.time, 3.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ContactTime<L: Lane> {
    /// Whether the spheres approach each other and will touch.
    pub meets: L::Mask,
    /// Time until the surfaces touch, not negative; without meaning where they
    /// never do.
    pub time: L,
}

/// The terms of `|x + Vt|² = s²`, which both directions of time share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactEquation<L> {
    speed_squared: L,
    distance_squared: L,
    /// `x·V`.
    moving_apart: L,
    /// `s² − x·x`.
    overlap: L,
    /// By the vector product, `D = V² s² − |x × V|²`:
    /// `(x·V)² − V²(x·x − s²)` loses half the digits from afar.
    discriminant: L,
}

impl<L: Lane> ContactEquation<L> {
    #[inline(always)]
    pub(crate) fn new(offset: Vec3<L>, relative: Vec3<L>, reach: L) -> Self {
        let speed_squared = relative.length_squared();
        let distance_squared = offset.length_squared();
        let reach_squared = reach * reach;
        Self {
            speed_squared,
            distance_squared,
            moving_apart: offset.dot(relative),
            overlap: reach_squared - distance_squared,
            discriminant: speed_squared * reach_squared - offset.cross(relative).length_squared(),
        }
    }

    /// Whether the spheres would touch if `x·V` were less by `slack`, and `V²` greater by
    /// `stray` across the line of centres. Two at one place never do.
    #[inline(always)]
    pub(crate) fn may_meet(&self, slack: L, stray: L) -> L::Mask {
        let strayed = self.discriminant + stray * self.distance_squared;
        self.moving_apart.lt(slack) & strayed.gt(L::ZERO)
    }

    /// Whether the spheres touch ever.
    #[inline(always)]
    pub(crate) fn meets(&self) -> L::Mask {
        // In contact and approaching, rounding alone can take D to 0.
        let is_deep = self.discriminant.gt(L::ZERO);
        self.moving_apart.lt(L::ZERO) & (is_deep | self.overlap.ge(L::ZERO))
    }

    /// See [`contact_time`].
    #[inline(always)]
    pub(crate) fn contact_time(&self) -> ContactTime<L> {
        let (meets, is_deep) = (self.meets(), self.discriminant.gt(L::ZERO));
        let root = L::select(is_deep, self.discriminant, L::ZERO).sqrt();
        let gap = (-self.overlap).greater(L::ZERO);
        ContactTime { meets, time: gap / (root - self.moving_apart) }
    }

    /// Whether the spheres are all but in contact, and approach each other by no more than
    /// rounding can tell.
    #[inline(always)]
    pub(crate) fn is_touching(&self, reach: L) -> L::Mask {
        let angle = L::splat(L::Scalar::whole(8) * L::Scalar::EPSILON.sqrt());
        (-self.overlap).lt(reach * reach * L::ratio(1, 1024))
            & (-self.moving_apart).lt(angle * reach * self.speed_squared.sqrt())
    }
}

/// When two spheres at `offset` from each other, moving with `relative`
/// velocity, came into contact; `reach` is the sum of their radii.
///
/// The greater root of `|x − Vτ|² = s²`, each sign of `x·V` in the form that
/// does not cancel.
///
/// ```
/// use carom::Vec3;
/// use carom::contact::past_contact;
///
/// // At the end of a step two spheres overlap by a quarter.
/// let contact = past_contact(Vec3::new(0.75, 0.0, 0.0), Vec3::new(-2.0, 0.0, 0.0), 1.0_f64);
/// assert!(contact.met);
/// assert_eq!(contact.ago, 0.125);
/// ```
#[inline(always)]
pub fn past_contact<L: Lane>(offset: Vec3<L>, relative: Vec3<L>, reach: L) -> PastContact<L> {
    let ContactEquation { speed_squared, moving_apart, overlap, discriminant, .. } =
        ContactEquation::new(offset, relative, reach);
    let met = discriminant.gt(L::ZERO) & speed_squared.gt(L::ZERO);
    let root = L::select(met, discriminant, L::ZERO).sqrt();
    let is_apart = moving_apart.gt(L::ZERO);
    let numerator = L::select(is_apart, moving_apart + root, overlap);
    let denominator = L::select(is_apart, speed_squared, root - moving_apart);
    PastContact { met: met & denominator.gt(L::ZERO), ago: numerator / denominator }
}

/// When two spheres at `offset` from each other, moving with `relative`
/// velocity, will come into contact; `reach` is the sum of their radii.
///
/// The lesser root of `|x + Vt|² = s²` for approaching spheres, `x·V < 0`:
/// `t = (x·x − s²)/(√D − x·V)`. Spheres that overlap and approach touch now,
/// `t = 0`; spheres that do not approach never touch, nor do those that graze
/// without depth, `D = 0`. Two spheres in one uniform field move straight
/// relative to each other.
///
/// ```
/// use carom::contact::contact_time;
/// use carom::vec3::Vec3;
///
/// // Five apart, the radii together one, closing at two per unit of time.
/// let contact = contact_time(Vec3::new(5.0, 0.0, 0.0), Vec3::new(-2.0, 0.0, 0.0), 1.0_f64);
/// assert!(contact.meets);
/// assert_eq!(contact.time, 2.0);
/// ```
#[inline(always)]
pub fn contact_time<L: Lane>(offset: Vec3<L>, relative: Vec3<L>, reach: L) -> ContactTime<L> {
    ContactEquation::new(offset, relative, reach).contact_time()
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

    #[test]
    fn finds_the_entry_ahead() {
        let velocity = Vec3::new(2.0, 0.0, 0.0);
        for (x, time) in [(-2.0, 0.5), (-1.0, 0.0), (-0.5, 0.0)] {
            let contact = contact_time(Vec3::new(x, 0.0, 0.0), velocity, 1.0_f64);
            assert!(contact.meets);
            assert_eq!(contact.time.to_bits(), f64::to_bits(time), "at {x}");
        }
        for never in [Vec3::new(0.5, 0.0, 0.0), Vec3::new(-3.0, 1.0, 0.0), Vec3::ZERO] {
            assert!(!contact_time(never, velocity, 1.0_f64).meets);
        }
        assert!(!contact_time(Vec3::new(0.5, 0.0, 0.0), Vec3::ZERO, 1.0_f64).meets);
    }

    #[test]
    fn keeps_the_digits_from_afar() {
        // b² − ac would be off by 9e-5 here (f32).
        let contact = contact_time(Vec3::new(1e4_f32, 0.6, 0.0), Vec3::new(-1.0, 0.0, 0.0), 1.0);
        assert!(contact.meets);
        assert!((contact.time - 9999.2).abs() <= 9999.2 * f32::EPSILON);
    }
}
