//! Obstacles: what is fixed in a scene, and where it is in the way.

use crate::real::Real;
use crate::space::{Bounds, Tree};
use crate::surroundings::{Feature, FeatureRef, Features, Shape};
use crate::vec3::Vec3;

/// All features of a scene's surroundings, found by place.
#[derive(Debug)]
pub(super) struct Obstacles<T: Real> {
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
    pub(super) fn new(shapes: &[Shape<T>]) -> Self {
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

    fn gap(&self, feature: u32, center: Vec3<T>, radius: T) -> T {
        self.features.at(feature).clearance(center, radius).gap
    }
}

/// The box around a sphere.
fn around<T: Real>(center: Vec3<T>, radius: T) -> Bounds<T> {
    let reach = Vec3::new(radius, radius, radius);
    [center - reach, center + reach]
}
