//! Obstacles: what is fixed in a scene, and where it is in the way.

use crate::contact::{FreeFlight, greatest_component};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::{Bounds, Ray, Tree, joined, unit};
use crate::surroundings::{Clearance, Feature, FeatureRef, Features, Shape};
use crate::vec3::Vec3;

/// All features of a scene's surroundings, found by place.
#[derive(Debug)]
pub(crate) struct Obstacles<T: Real> {
    features: Features<T>,
    /// The boxes of those that are no triangles of meshes.
    tree: Tree<T>,
}

/// A sphere that lies in an obstacle, or outside of its container.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misplaced {
    /// The shape.
    pub(super) shape: usize,
    /// The sphere.
    pub(super) body: usize,
    /// By how much, length.
    pub(super) depth: f64,
}

impl<T: Real> Obstacles<T> {
    pub(crate) fn new(shapes: &[Shape<T>]) -> Self {
        let features = Features::new(shapes);
        let tree = Tree::new(features.alone().iter().map(Feature::bounds));
        Self { features, tree }
    }

    /// Whether a sphere overlaps nothing.
    pub(super) fn leave_free(&self, center: Vec3<T>, radius: T) -> bool {
        let overlaps = |feature: u32| self.gap(feature, center, radius) < T::ZERO;
        !self.tree.endless().iter().any(|&feature| overlaps(feature))
            && !self.tree.any(around(center, radius), overlaps)
            && !self.features.any_tile(around(center, radius), overlaps)
    }

    /// Of these spheres, in their order, that overlap something by more than a tolerance,
    /// the first one at the first feature, of the parts that it is to be held against.
    pub(super) fn first_overlap(
        &self,
        bodies: impl Iterator<Item = usize> + Clone,
        is_checked: impl Fn(usize, usize) -> bool,
        sphere: impl Fn(usize) -> (Vec3<T>, T),
        tolerance: impl Fn(FeatureRef<'_, T>, usize, Vec3<T>, T) -> f64,
    ) -> Option<Misplaced> {
        let mut first: Option<(u32, usize, f64)> = None;
        let mut test = |feature: u32, body: usize| {
            if first.is_some_and(|first| (first.0, first.1) <= (feature, body)) {
                return;
            }
            let (center, radius) = sphere(body);
            let gap = self.gap(feature, center, radius);
            if gap < T::ZERO && is_checked(self.features.shape_of(feature) as usize, body) {
                let gap = gap.to_f64();
                if gap < -tolerance(self.features.at(feature), body, center, radius) {
                    first = Some((feature, body, gap));
                }
            }
        };
        for &feature in self.tree.endless() {
            bodies.clone().for_each(|body| test(feature, body));
        }
        for body in bodies {
            let (center, radius) = sphere(body);
            let around = around(center, radius);
            self.tree.for_each(around, |feature| test(feature, body));
            self.features.for_each_tile(around, |_, feature| test(feature, body));
        }
        let (feature, body, gap) = first?;
        Some(Misplaced { shape: self.features.shape_of(feature) as usize, body, depth: -gap })
    }

    /// The part that a feature is of.
    pub(crate) fn part_of(&self, feature: u32) -> u32 {
        self.features.shape_of(feature)
    }

    /// Visits the features that a sphere is as near to as a gap: their parts, and where it
    /// stands to them.
    pub(crate) fn for_each_beside(
        &self,
        (center, radius): (Vec3<T>, T),
        gap: T,
        mut visit: impl FnMut(u32, Clearance<T>),
    ) {
        let mut test = |feature: u32| {
            let clearance = self.features.at(feature).clearance(center, radius);
            if clearance.gap <= gap {
                visit(self.part_of(feature), clearance);
            }
        };
        let around = around(center, radius + gap);
        self.tree.endless().iter().for_each(|&feature| test(feature));
        self.tree.for_each(around, &mut test);
        self.features.for_each_tile(around, |_, feature| test(feature));
    }

    /// The first feature in the way of a ray from a point in a unit direction, up to a
    /// distance, length, and how far it is: the first contact of a sphere without a radius.
    pub(crate) fn first_along(
        &self,
        start: Vec3<T>,
        unit: Vec3<T>,
        longest: T,
    ) -> Option<(T, u32)> {
        let flight = FreeFlight {
            center: start,
            velocity: unit,
            acceleration: None,
            radius: T::ZERO,
            is_leaving: false,
        };
        let mut first: Option<(T, u32)> = None;
        let mut test = |feature: u32| {
            let is_inside = self.gap(feature, start, T::ZERO) < T::ZERO;
            let distance = || self.features.at(feature).contact_time(&flight);
            let distance = if is_inside { Some(T::ZERO) } else { distance() };
            if let Some(distance) = distance.filter(|distance| *distance <= longest)
                && first.is_none_or(|first| {
                    distance < first.0 || distance == first.0 && feature < first.1
                })
            {
                first = Some((distance, feature));
            }
            first.map(|(distance, _)| distance)
        };
        let mut nearest = None;
        for &feature in self.tree.endless() {
            nearest = test(feature);
        }
        let ray = Ray::new(start, unit, nearest.unwrap_or(longest));
        self.tree.for_each_along(ray, |feature| nearest = test(feature));
        self.along_meshes(start, unit, nearest.unwrap_or(longest), &mut test);
        first
    }

    /// Tests the triangles of meshes along a ray, stretch by stretch, up to the first hit.
    fn along_meshes(
        &self,
        start: Vec3<T>,
        unit: Vec3<T>,
        longest: T,
        test: &mut impl FnMut(u32) -> Option<T>,
    ) {
        /// The most stretches.
        const MOST: f64 = 4096.0;
        let Some(bounds) = self.features.mesh_bounds().reduce(joined) else { return };
        let ray = Ray::new(start, unit, longest);
        let Some([enters, leaves]) = ray.span(bounds.each(Vec3::to_array)) else { return };
        // About as long as the triangles of a surface are.
        let triangles = self.features.len() - self.features.alone().len();
        let stretches = (triangles as f64).sqrt().ceil().clamp(1.0, MOST) as i32;
        let length = (leaves - enters) / T::whole(stretches);
        let at = |stretch: i32| start + unit * (enters + length * T::whole(stretch));
        for stretch in 0..stretches {
            let (from, to) = (at(stretch), at(stretch + 1));
            let size = greatest_component(from).greater(greatest_component(to));
            let margin = T::whole(64) * T::EPSILON * (size + greatest_component(start));
            let margin = Vec3::new(margin, margin, margin);
            let (lower, upper) = (from.lesser(to) - margin, from.greater(to) + margin);
            let mut nearest = None;
            self.features.for_each_tile([lower, upper], |_, feature| nearest = test(feature));
            if nearest.is_some_and(|distance| distance <= enters + length * T::whole(stretch + 1)) {
                return;
            }
        }
    }

    /// The unit normal of a feature where a ray meets it, or out of it where the ray starts
    /// inside.
    pub(crate) fn normal_at(
        &self,
        feature: u32,
        start: Vec3<T>,
        direction: Vec3<T>,
        distance: T,
    ) -> Vec3<T> {
        /// Each brings a curved surface's normal nearer by the step over its radius.
        const ROUNDS: usize = 4;
        let at = self.features.at(feature);
        let place = start + direction * distance;
        let size = greatest_component(place).greater(T::from_f64(at.farthest()));
        // At the surface itself, rounding decides on which side of it the place is: the normal
        // is that of a place above it, whose nearest point it is.
        let step = size * T::EPSILON.sqrt();
        let radius = step * T::ratio(1, 1024);
        let above = if distance > T::ZERO { step } else { T::ZERO };
        let mut normal = -direction;
        for _ in 0..ROUNDS {
            match unit(at.clearance(place + normal * above, radius).arm) {
                Some(next) => normal = next,
                None => break,
            }
        }
        normal
    }

    fn gap(&self, feature: u32, center: Vec3<T>, radius: T) -> T {
        self.features.at(feature).clearance(center, radius).gap
    }
}

/// The box around a sphere.
fn around<T: Real>(center: Vec3<T>, radius: T) -> Bounds<T> {
    let reach = Vec3::new(radius, radius, radius);
    [center - reach, center + reach]
}
