//! Gate: a surface by its two sides, and when a centre passes through it.
//!
//! A centre is a sphere without a radius. From outside it meets the solid, from inside the
//! container of the same shape, by the finders of the first contact that spheres have; after
//! each passage the other one is asked. So none is missed, and what has come in less what has
//! gone out is what is inside.

use core::ops::AddAssign;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::solid::Obstacle;
use super::{Feature, Plane};
use crate::contact::{FreeFlight, greatest_component};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// How often centres have passed through a surface.
///
/// ```
/// use carom::surroundings::Passages;
/// let mut passages = Passages { inward: 3, outward: 1 };
/// passages += Passages { inward: 0, outward: 2 };
/// assert_eq!((passages.inward, passages.outward), (3, 3));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Passages {
    /// Into what is closed; against the normal of a plane or a triangle, or the axis of a
    /// disc.
    pub inward: u64,
    /// The other way.
    pub outward: u64,
}

impl AddAssign for Passages {
    fn add_assign(&mut self, other: Self) {
        self.inward += other.inward;
        self.outward += other.outward;
    }
}

impl Passages {
    /// Those after an earlier count.
    ///
    /// ```
    /// use carom::surroundings::Passages;
    /// let now = Passages { inward: 3, outward: 1 };
    /// assert_eq!(now.since(Passages { inward: 2, outward: 1 }).inward, 1);
    /// ```
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self { inward: self.inward - earlier.inward, outward: self.outward - earlier.outward }
    }

    fn count(&mut self, was_inside: bool) {
        let count = if was_inside { &mut self.outward } else { &mut self.inward };
        *count += 1;
    }
}

/// A surface by its sides.
#[derive(Clone, Debug)]
pub(crate) struct Gate<T> {
    /// What a centre outside meets, and what one inside does.
    sides: [Vec<Feature<T>>; 2],
    /// Of something flat: the part of its plane that it is.
    opening: Option<Opening<T>>,
}

/// A part of a plane.
#[derive(Clone, Copy, Debug)]
pub(super) enum Opening<T> {
    /// About a centre, between two radii.
    Ring([T; 2], Vec3<T>),
    /// A triangle, and its normal of any length.
    Triangle([Vec3<T>; 3], Vec3<T>),
}

impl<T: Real> Opening<T> {
    /// Whether a place on the plane is in it.
    fn holds(&self, place: Vec3<T>) -> bool {
        match *self {
            Self::Ring([inner, outer], center) => {
                let distance = (place - center).length();
                inner <= distance && distance <= outer
            }
            Self::Triangle([a, b, c], normal) => [(a, b), (b, c), (c, a)]
                .into_iter()
                .all(|(from, to)| (to - from).cross(place - from).dot(normal) >= T::ZERO),
        }
    }
}

impl<T: Real> Gate<T> {
    /// All of a plane, or a part of it.
    pub(super) fn flat(plane: Plane<T>, opening: Option<Opening<T>>) -> Self {
        let behind = Plane { normal: -plane.normal, ..plane };
        Self { sides: [vec![plane.into()], vec![behind.into()]], opening }
    }

    /// What is closed, by its features as a solid and as a container.
    pub(super) fn closed(features: impl Fn(bool) -> Vec<Feature<T>>) -> Self {
        Self { sides: [false, true].each(features), opening: None }
    }

    /// Whether a place is inside, or behind something flat.
    pub(crate) fn is_inside(&self, place: Vec3<T>) -> bool {
        self.gap(place, false) < T::ZERO
    }

    /// How far a place on a side is from the surface, length; negative on the other side.
    fn gap(&self, place: Vec3<T>, is_inside: bool) -> T {
        let gaps = self.sides[usize::from(is_inside)].iter();
        gaps.map(|feature| feature.clearance(place, T::ZERO).gap)
            .reduce(T::lesser)
            .unwrap_or(T::ZERO)
    }

    /// The passages of a centre that begins a flight, without a radius, on a side, and on
    /// which side it ends after a duration, which is included.
    pub(crate) fn passages(
        &self,
        flight: &FreeFlight<T>,
        duration: T,
        mut is_inside: bool,
    ) -> (Passages, bool) {
        let mut passages = Passages::default();
        let way = (flight.velocity.length() + flight.pull().length() * (T::ratio(1, 2) * duration))
            * duration;
        let margin = T::ONE + T::whole(16) * T::EPSILON;
        if self.gap(flight.center, is_inside) > way * margin {
            return (passages, is_inside);
        }
        let (mut now, mut here, mut stays) = (T::ZERO, *flight, 0);
        // Rounding can leave a centre on the surface, but not on both sides again and again.
        while stays < 3 {
            let features = self.sides[usize::from(is_inside)].iter();
            let waits = features.filter_map(|feature| Obstacle::contact_time(feature, &here));
            let Some(wait) = waits.reduce(T::lesser) else { break };
            // Not an end before: a sum of none must be within.
            if now + wait > duration {
                break;
            }
            stays = if wait > T::ZERO { 0 } else { stays + 1 };
            now = now + wait;
            let center = flight.position(now);
            if self.opening.is_none_or(|opening| opening.holds(center)) {
                passages.count(is_inside);
            }
            is_inside = !is_inside;
            let velocity = flight.velocity_at(now);
            here = FreeFlight { center, velocity, is_leaving: true, ..*flight };
        }
        (passages, is_inside)
    }

    /// Whether a place is clearly on the other side than is known, beyond what rounding of
    /// places to a relative precision leaves in doubt; and whether that is a passage.
    pub(crate) fn corrects(
        &self,
        place: Vec3<T>,
        is_inside: bool,
        rounding: T,
    ) -> Option<Passages> {
        let gap = self.gap(place, is_inside);
        if gap >= T::ZERO {
            return None;
        }
        let farthest = self.sides.iter().flatten().map(Feature::farthest).fold(0.0, f64::max);
        let size = greatest_component(place).greater(T::from_f64(farthest));
        if -gap <= T::whole(64) * rounding * size {
            return None;
        }
        let mut passages = Passages::default();
        if self.opening.is_none_or(|opening| opening.holds(place)) {
            passages.count(is_inside);
        }
        Some(passages)
    }
}
