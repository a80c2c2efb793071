//! Survey: bodies and fixed parts at one moment, to be asked by place.

use super::{Compiled, Event, EventDriven, Partner, Stepped, World};
use crate::bodies::Bodies;
use crate::real::Real;
use crate::scene::{Encounters, Obstacles, Scene};
use crate::space::{Space, SphereTree, along_boxes, unit};
use crate::vec3::Vec3;

/// What is touched: a body or a fixed part. Parts come before bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Touched {
    /// A part of the surroundings, by its index in the scene.
    Part(u32),
    /// A body, by its index in the scene.
    Body(u32),
}

/// A body beside another one, or beside a fixed part.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact<T> {
    /// Index of the body; of two, the lesser one.
    pub a: u32,
    /// What it is beside: a part, or a body with a greater index.
    pub partner: Touched,
    /// Between the two surfaces, length; negative where they overlap.
    pub gap: T,
    /// Half-way between the surfaces, length; beside body `a`, also where it meets the image
    /// of another one.
    pub point: Vec3<T>,
    /// The unit normal, from the partner to body `a`; zero where two centres are one.
    pub normal: Vec3<T>,
}

/// Where a ray first meets a body or a fixed part.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit<T> {
    /// What it meets.
    pub what: Touched,
    /// From the ray's origin, length; 0 inside a body, or inside what is solid.
    pub distance: T,
    /// The point on the surface; the origin, inside. In a periodic box, of the image that is
    /// hit, which the box need not hold.
    pub point: Vec3<T>,
    /// The unit normal there, out of what is hit; zero at the centre of a body.
    pub normal: Vec3<T>,
}

/// The bodies and the fixed parts of a world at one moment, to be asked by place. It is made
/// of them once, in `O(n log n)`, and does not follow them.
///
/// ```
/// use carom::engine::{Execution, Touched, World};
/// use carom::{Plane, Scene, Sphere};
///
/// let ball = |x: f64| Sphere::new([x, 0.0, 0.5]).radius(0.5);
/// let scene = Scene::<f64>::builder()
///     .surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
///     .sphere(ball(0.0))
///     .sphere(ball(1.0))
///     .sphere(ball(2.125))
///     .build()?;
/// let world = World::new(scene, Execution::default())?;
/// let survey = world.survey();
/// // What touches now, and what is as near as 0.125.
/// let (floor, next) = (Touched::Part(0), Touched::Body);
/// let pairs = |gap| -> Vec<_> {
///     survey.contacts(gap).iter().map(|contact| (contact.a, contact.partner)).collect()
/// };
/// assert_eq!(pairs(0.0), [(0, floor), (0, next(1)), (1, floor), (2, floor)]);
/// assert_eq!(pairs(0.125), [(0, floor), (0, next(1)), (1, floor), (1, next(2)), (2, floor)]);
/// // A ray between the balls comes to the floor.
/// let hit = survey.ray([1.5625, 0.0, 4.0], [0.0, 0.0, -1.0], 10.0).ok_or("nothing is hit")?;
/// assert_eq!((hit.what, hit.distance, hit.normal.z), (floor, 4.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Survey<T: Real> {
    spheres: SphereTree<T>,
    obstacles: Obstacles<T>,
    encounters: Encounters,
}

impl<T: Real> Survey<T> {
    pub(super) fn of(bodies: &Bodies<T>, scene: &Scene<T>) -> Self {
        Self {
            spheres: SphereTree::new(bodies, scene.periodic),
            obstacles: Obstacles::new(&scene.surroundings),
            encounters: scene.encounters,
        }
    }

    /// The bodies alone.
    #[must_use]
    pub fn sphere_tree(&self) -> &SphereTree<T> {
        &self.spheres
    }

    pub(super) fn find_contacts(&self, gap: T) -> Vec<Contact<T>> {
        let mut found = Vec::new();
        let mut near = Vec::new();
        let images = self.spheres.periodic().map_or_else(|| vec![Vec3::ZERO], Space::images);
        for a in 0..self.spheres.len() as u32 {
            let (center, radius) = self.spheres.sphere(a);
            if self.encounters != Encounters::None {
                self.beside_parts(a, gap, &images, &mut found);
            }
            if self.encounters != Encounters::All {
                continue;
            }
            near.clear();
            self.spheres.for_each_near(center, radius + gap, |other| {
                if other > a {
                    near.push(other);
                }
            });
            near.sort_unstable();
            near.dedup();
            for &other in &near {
                let (place, own) = self.spheres.sphere(other);
                let offset = self.spheres.nearest_way(place, center);
                let apart = offset.length() - (radius + own);
                if apart <= gap {
                    let normal = unit(offset).unwrap_or(Vec3::ZERO);
                    let partner = Touched::Body(other);
                    found.push(Contact::new((a, partner), (center, radius), apart, normal));
                }
            }
        }
        found
    }

    /// The parts that a body is beside, each by its nearest feature.
    fn beside_parts(&self, a: u32, gap: T, images: &[Vec3<T>], found: &mut Vec<Contact<T>>) {
        let (center, radius) = self.spheres.sphere(a);
        let first = found.len();
        for &image in images {
            self.obstacles.for_each_beside((center + image, radius), gap, |part, clearance| {
                let partner = Touched::Part(part);
                let of_part = found[first..].iter_mut().find(|other| other.partner == partner);
                if of_part.as_ref().is_some_and(|other| other.gap <= clearance.gap) {
                    return;
                }
                let normal = unit(clearance.arm).unwrap_or(Vec3::ZERO);
                let contact = Contact::new((a, partner), (center, radius), clearance.gap, normal);
                match of_part {
                    Some(other) => *other = contact,
                    None => found.push(contact),
                }
            });
        }
        found[first..].sort_unstable_by_key(|contact| contact.partner);
    }

    pub(super) fn first_hit(
        &self,
        origin: Vec3<T>,
        direction: Vec3<T>,
        longest: T,
    ) -> Option<Hit<T>> {
        let unit = unit(direction)?;
        let body = self.spheres.ray(origin, unit, longest);
        let longest = body.map_or(longest, |hit| hit.distance);
        let mut first: Option<(T, u32, Vec3<T>)> = None;
        let mut from = |shift: Vec3<T>, longest: T| {
            let start = self.spheres.wrapped(origin) - shift;
            let nearest = first.map_or(longest, |(nearest, ..)| nearest);
            if let Some((distance, feature)) = self.obstacles.first_along(start, unit, nearest)
                && first.is_none_or(|(nearest, ..)| distance < nearest)
            {
                first = Some((distance, feature, start));
            }
            first.map(|(distance, ..)| distance)
        };
        match self.spheres.periodic() {
            None => {
                from(Vec3::ZERO, longest);
            }
            Some(_) if !longest.is_finite() => {}
            Some(space) => {
                along_boxes(space, self.spheres.wrapped(origin), unit, longest, from);
            }
        }
        let part = first.filter(|(distance, ..)| body.is_none_or(|hit| *distance < hit.distance));
        match (part, body) {
            (Some((distance, feature, start)), _) => Some(Hit {
                what: Touched::Part(self.obstacles.part_of(feature)),
                distance,
                point: origin + unit * distance,
                normal: self.obstacles.normal_at(feature, start, unit, distance),
            }),
            (None, Some(hit)) => Some(Hit {
                what: Touched::Body(hit.body as u32),
                distance: hit.distance,
                point: hit.point,
                normal: hit.normal,
            }),
            (None, None) => None,
        }
    }
}

impl<T: Compiled> Survey<T> {
    /// What is beside what: the pairs of bodies, and of a body and a fixed part, whose surfaces
    /// are as near as a gap, length; 0 for those that touch or overlap. They are in the order
    /// of their bodies, and of one body parts before bodies.
    ///
    /// Each pair is there once: with a part that a body touches at several places, in a corner
    /// of a box, by the nearest of them. What cannot meet in a scene is left out, as are
    /// [sensors](crate::surroundings::Sensor). Rounding leaves bodies that have just collided
    /// apart or in each other by some units in the last digit of their places: a gap somewhat
    /// greater than that finds them all.
    #[must_use]
    pub fn contacts(&self, gap: T) -> Vec<Contact<T>> {
        T::contacts(self, gap)
    }

    /// The first body or fixed part in the way of a ray from a point, length, in a direction of
    /// any length, up to a distance, length: a part as the engines find the first contact of a
    /// sphere without a radius on a straight path, so that a graze is none.
    ///
    /// A container is solid all around its hollow. A ray meets no
    /// [sensor](crate::surroundings::Sensor), and without a direction nothing, nor in a
    /// periodic box without a finite distance.
    #[must_use]
    pub fn ray(
        &self,
        origin: impl Into<Vec3<T>>,
        direction: impl Into<Vec3<T>>,
        longest: T,
    ) -> Option<Hit<T>> {
        T::ray(self, [origin.into(), direction.into()], longest)
    }
}

impl<T: Real> Contact<T> {
    fn new(
        (a, partner): (u32, Touched),
        (center, radius): (Vec3<T>, T),
        gap: T,
        normal: Vec3<T>,
    ) -> Self {
        let point = center - normal * (radius + gap * T::ratio(1, 2));
        Self { a, partner, gap, point, normal }
    }
}

impl<T: Compiled> World<T> {
    /// The bodies and the fixed parts now, to be asked by place. See [`Survey`].
    #[must_use]
    pub fn survey(&self) -> Survey<T> {
        T::survey(&self.bodies(), self.scene())
    }

    /// What is beside what now, as near as a gap, length. See [`Survey::contacts`].
    ///
    /// ```
    /// use carom::engine::{Execution, World};
    /// use carom::{Scene, Sphere};
    ///
    /// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5);
    /// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(1.25)).build()?;
    /// let world = World::new(scene, Execution::default())?;
    /// assert!(world.contacts(0.125).is_empty());
    /// let [contact] = world.contacts(0.25)[..] else { return Err("one pair".into()) };
    /// assert_eq!((contact.gap, contact.point.x, contact.normal.x), (0.25, 0.625, -1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn contacts(&self, gap: T) -> Vec<Contact<T>> {
        self.survey().contacts(gap)
    }
}

impl<T: Compiled> EventDriven<T> {
    /// The bodies and the fixed parts now, to be asked by place. See [`Survey`].
    #[must_use]
    pub fn survey(&self) -> Survey<T> {
        T::survey(&self.bodies(), self.scene())
    }
}

impl<T: Compiled> Stepped<T> {
    /// The bodies and the fixed parts now, to be asked by place. See [`Survey`].
    #[must_use]
    pub fn survey(&self) -> Survey<T> {
        T::survey(&self.bodies(), self.scene())
    }
}

impl<T: Real> Stepped<T> {
    /// Takes one step, and gives the pairs that have collided in it, each once, in the order of
    /// [`Survey::contacts`]. With impacts within the step they may be apart again. Other steps
    /// remember no pairs, and cost nothing for it.
    ///
    /// ```
    /// use carom::engine::Touched;
    /// use carom::{Scene, Sphere, Stepped};
    ///
    /// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
    /// let scene = Scene::<f64>::builder().dt(0.375).sphere(ball(0.0)).sphere(ball(2.0)).build()?;
    /// let mut world = Stepped::new(scene)?;
    /// assert!(world.step_with_contacts().is_empty());
    /// assert_eq!(world.step_with_contacts(), [(0, Touched::Body(1))]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn step_with_contacts(&mut self) -> Vec<(u32, Touched)> {
        let mut pairs = Vec::new();
        let mut note = |event: &Event<T>| {
            let partner = match event.partner {
                Partner::Body { index, .. } => Touched::Body(index),
                Partner::Surroundings(part) => Touched::Part(part),
            };
            pairs.push((event.a, partner));
        };
        self.take_steps(1, Some(&mut note));
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
