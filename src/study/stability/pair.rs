//! Two spheres that meet, and how they should part.

use super::StudyError;
use super::case::{Random, Studied, greatest};
use crate::contact::{Party, Rough, Smooth, Surface, collide, contact_time};
use crate::engine::{Event, EventDriven, Partner};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::scene::{Scene, Sphere};
use crate::vec3::Vec3;

/// A sphere in `f64`, to be rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub position: Vec3<f64>,
    pub velocity: Vec3<f64>,
    /// Angular velocity, rad per time.
    pub spin: Vec3<f64>,
    pub radius: f64,
    pub mass: f64,
}

/// How a pair parts: the velocity of each, and that of its surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parting<J> {
    pub velocity: [Vec3<J>; 2],
    pub surface: [Vec3<J>; 2],
}

/// Two spheres, one of which flies at the other at a relative speed of 1, with
/// an offset of its path of `aim` of the sum of the radii, from any direction.
/// Both spin.
pub(super) fn meeting(
    random: &mut Random,
    radii: [f64; 2],
    masses: [f64; 2],
    aim: f64,
) -> [Ball; 2] {
    let way = random.direction();
    let aside = way.cross(random.direction());
    let aside = aside * (1.0 / aside.length());
    let reach = radii[0] + radii[1];
    let ball = |k: usize| Ball {
        position: Vec3::ZERO,
        velocity: Vec3::ZERO,
        spin: Vec3::ZERO,
        radius: radii[k],
        mass: masses[k],
    };
    let mut balls = [ball(0), ball(1)];
    balls[0].position = way * (-3.0 * reach) + aside * (aim * reach);
    balls[0].velocity = way;
    for ball in &mut balls {
        ball.spin = random.direction() * (0.5 / ball.radius);
    }
    balls
}

/// The pair as a scene.
pub(super) fn scene<T: Studied>(
    balls: &[Ball; 2],
    surface: Surface,
) -> Result<Scene<T>, StudyError> {
    let mut builder = Scene::<T>::builder().surface(surface);
    for ball in balls {
        let sphere = Sphere::new(ball.position.to_array()).radius(ball.radius).mass(ball.mass);
        builder =
            builder.sphere(sphere.velocity(ball.velocity.to_array()).spin(ball.spin.to_array()));
    }
    Ok(builder.build()?)
}

/// Two bodies about to meet, in the judging precision.
struct Encounter<J> {
    parties: [Party<J>; 2],
    radii: [J; 2],
    /// From the second centre to the first.
    offset: Vec3<J>,
    relative: Vec3<J>,
    surface: Surface,
}

/// The two bodies of a scene, whose numbers are taken as exact.
fn encounter<T: Studied>(scene: &Scene<T>) -> Encounter<T::Judge> {
    let bodies = &scene.bodies;
    let radii = [0, 1].each(|k| bodies.radius.of(k).cast::<T::Judge>());
    let one = T::Judge::ONE;
    let parties = [0, 1].each(|k| Party {
        velocity: bodies.velocity_of(k).cast(),
        spin: bodies.spin_of(k).cast(),
        inverse_mass: one / bodies.mass.of(k).cast(),
        inverse_inertia: one / bodies.inertia.of(k).cast(),
        share: radii[k] / (radii[0] + radii[1]),
    });
    Encounter {
        radii,
        offset: bodies.position_of(0).cast() - bodies.position_of(1).cast(),
        relative: parties[0].velocity - parties[1].velocity,
        surface: scene.surface,
        parties,
    }
}

impl<J: Real> Encounter<J> {
    /// How they part if they meet at this offset.
    fn parting(&self, offset: Vec3<J>) -> Parting<J> {
        let [mut a, mut b] = self.parties;
        if self.surface == Surface::Rough {
            collide(Rough, offset, &mut a, &mut b);
        } else {
            collide(Smooth, offset, &mut a, &mut b);
        }
        let surface = [a.spin * self.radii[0], b.spin * self.radii[1]];
        Parting { velocity: [a.velocity, b.velocity], surface }
    }
}

/// How the two bodies of a scene should part; `None` if they miss each other. By
/// the crate's own formulas, in a precision with twice the digits:
/// `tests/collisions.rs` holds them to exact rationals.
pub(super) fn expected<T: Studied>(scene: &Scene<T>) -> Option<Parting<T::Judge>> {
    let encounter = encounter(scene);
    let Encounter { radii, offset, relative, .. } = encounter;
    let contact = contact_time(offset, relative, radii[0] + radii[1]);
    contact.meets.then(|| encounter.parting(offset + relative * contact.time))
}

/// How far the path of one goes into the sum of the radii, as a part of that;
/// negative if it misses.
pub(super) fn depth<T: Studied>(scene: &Scene<T>) -> f64 {
    let Encounter { radii, offset, relative, .. } = encounter(scene);
    let aim = offset.cross(relative).length() / relative.length();
    (T::Judge::ONE - aim / (radii[0] + radii[1])).to_f64()
}

/// How they would part if the sum of the radii just reached from one path to
/// the other.
pub(super) fn touching<T: Studied>(scene: &Scene<T>) -> Parting<T::Judge> {
    let encounter = encounter(scene);
    let Encounter { offset, relative, .. } = encounter;
    let along = offset.dot(relative) / relative.length_squared();
    let aside = offset - relative * along;
    // A little before the least distance: they still approach.
    let before = T::Judge::from_f64(1e-10) * aside.length() / relative.length();
    encounter.parting(aside - relative * before)
}

/// How they part when nothing happens.
pub(super) fn untouched<T: Studied>(scene: &Scene<T>) -> Parting<T::Judge> {
    let bodies = &scene.bodies;
    Parting {
        velocity: [0, 1].each(|k| bodies.velocity_of(k).cast()),
        surface: [0, 1].each(|k| bodies.spin_of(k).cast() * bodies.radius.of(k).cast()),
    }
}

/// How they part in the event-driven engine; `None` if they miss each other.
pub(super) fn found<T: Studied>(
    scene: Scene<T>,
    duration: f64,
) -> Result<Option<Parting<T::Judge>>, StudyError> {
    let radii = [0, 1].each(|k| scene.bodies.radius.of(k).cast::<T::Judge>());
    let mut world = EventDriven::new(scene)?;
    let mut parting = None;
    world.for_each_event(duration, |event: &Event<T>| {
        if let Partner::Body { velocity, spin, .. } = event.partner {
            parting = Some(Parting {
                velocity: [event.velocity, velocity].each(Vec3::cast),
                surface: [event.spin.cast() * radii[0], spin.cast() * radii[1]],
            });
        }
    })?;
    Ok(parting)
}

/// How far off each body of a pair is, and how the pair should part.
pub(super) type Judged<J> = ([f64; 2], Parting<J>);

/// How far off each body of a pair is after it has met, and how it should part;
/// infinitely far where the engine misses the contact. `None` if they miss each
/// other.
pub(super) fn measured<T: Studied>(
    balls: &[Ball; 2],
    surface: Surface,
    duration: f64,
) -> Result<Option<Judged<T::Judge>>, StudyError> {
    let scene = scene::<T>(balls, surface)?;
    let Some(expected) = expected(&scene) else { return Ok(None) };
    let off = match found(scene, duration)? {
        Some(found) => found.off(&expected),
        None => [f64::INFINITY; 2],
    };
    Ok(Some((off, expected)))
}

impl<J: Real> Parting<J> {
    /// How far off each body is, the faster of its centre and its surface.
    pub fn off(&self, other: &Self) -> [f64; 2] {
        [0, 1].each(|k| {
            let velocity = (self.velocity[k] - other.velocity[k]).length().to_f64();
            let surface = (self.surface[k] - other.surface[k]).length().to_f64();
            greatest([velocity, surface])
        })
    }

    /// How fast each body is.
    pub fn speeds(&self) -> [f64; 2] {
        [0, 1].each(|k| greatest([self.velocity[k], self.surface[k]].each(|v| v.length().to_f64())))
    }
}
