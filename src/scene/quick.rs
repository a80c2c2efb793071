//! Quick: whether a scene that was made of another one is right beyond doubt. What is in
//! doubt is checked in full.

use super::check_bodies::has_narrow_slab;
use super::checked::Scene;
use super::compiled::Buildable;
use super::error::SceneError;
use super::settings::{Encounters, MOST_STEPS};
use crate::bodies::{Bodies, PerBody};
use crate::column::Column;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::surroundings::{Feature, Features, Shape};
use crate::vec3::Vec3;

/// The most pairs of bodies, and of bodies and features, that are looked at one by one.
const MOST_PAIRS: usize = 10_000;

/// A scene that is right, and what others that are made of it need not be asked again.
#[derive(Debug)]
pub(crate) struct QuickCheck<T: Real> {
    scene: Scene<T>,
    features: Features<T>,
    /// Whether it is so simple that all pairs can be looked at.
    is_simple: bool,
}

impl<T: Real> QuickCheck<T> {
    /// For scenes that are made of this one.
    pub fn new(scene: &Scene<T>) -> Self {
        let features = Features::new(&scene.surroundings);
        let bodies = scene.bodies.len();
        let pairs = bodies * (bodies + features.len());
        let is_simple = scene.periodic.is_none()
            && pairs <= MOST_PAIRS
            && !features.has_meshes()
            && !scene.surroundings.iter().any(Shape::is_thin)
            && !has_narrow_slab(&scene.surroundings, &scene.bodies);
        Self { scene: scene.clone(), features, is_simple }
    }

    /// Whether there is no doubt that a scene is right.
    pub fn accepts(&self, scene: &Scene<T>) -> bool {
        let (first, bodies) = (&self.scene, &scene.bodies);
        let is_of_this_kind = self.is_simple
            && bodies.len() == first.bodies.len()
            && (&bodies.radius, &bodies.mass) == (&first.bodies.radius, &first.bodies.mass)
            && bodies.inertia == first.bodies.inertia
            && bodies.orientation == first.bodies.orientation
            && (scene.engine, scene.surface) == (first.engine, first.surface)
            && scene.encounters == first.encounters
            && scene.periodic.is_none()
            && scene.surroundings == first.surroundings;
        is_of_this_kind && self.has_right_times(scene) && self.has_right_places(scene)
    }

    fn has_right_times(&self, scene: &Scene<T>) -> bool {
        let is_length = |time: Option<f64>| time.is_none_or(|time| time.is_finite() && time > 0.0);
        let (dt, duration) = (scene.stepped.dt, scene.duration);
        let steps = duration.zip(dt).map_or(0.0, |(duration, dt)| duration / dt);
        let is_number = |dt: f64| T::from_f64(dt) > T::ZERO && T::from_f64(dt).is_finite();
        is_length(dt)
            && is_length(duration)
            && dt.is_some() == self.scene.stepped.dt.is_some()
            && dt.is_none_or(is_number)
            && steps < MOST_STEPS / 2.0
            && scene.gravity.to_array().iter().all(|g| g.is_finite())
    }

    fn has_right_places(&self, scene: &Scene<T>) -> bool {
        let bodies = &scene.bodies;
        let mut columns = bodies.position.iter().chain(&bodies.velocity).chain(&bodies.spin);
        let is_right = |column: &Column<T>| {
            column.len() == bodies.len() && column.iter().all(|value| value.is_finite())
        };
        if !columns.all(is_right) {
            return false;
        }
        (0..bodies.len()).all(|body| {
            let (center, radius) = (bodies.position_of(body), bodies.radius.of(body));
            let is_outside =
                |feature: &Feature<T>| feature.clearance(center, radius).gap >= T::ZERO;
            (scene.encounters == Encounters::None || self.features.alone().iter().all(is_outside))
                && (scene.encounters != Encounters::All || is_apart(bodies, body))
        })
    }
}

/// Whether a body is apart from all before it.
fn is_apart<T: Real>(bodies: &Bodies<T>, body: usize) -> bool {
    let [x, y, z] = bodies.position.refs().each(|column| &column[..body]);
    let (center, radius) = (bodies.position_of(body), bodies.radius.of(body));
    let mut is_near = false;
    // Without a branch, so that several are looked at at once.
    let mut look = |other: usize, reach: T| {
        let offset = center - Vec3::new(x[other], y[other], z[other]);
        let is_apart = offset.length_squared() > reach * reach;
        is_near |= !is_apart;
    };
    match &bodies.radius {
        PerBody::Same(other) => {
            let reach = radius + *other;
            (0..body).for_each(|k| look(k, reach));
        }
        PerBody::Each(others) => (0..body).for_each(|k| look(k, radius + others[k])),
    }
    !is_near
}

impl<T: Buildable> Scene<T> {
    /// The same scene, if all of it is right.
    pub(crate) fn checked_again(&self) -> Result<Self, SceneError> {
        self.with_bodies(self.bodies.clone())
    }
}
