//! Coming: the spheres of inlets as they come, and whether there is room for them.

use super::checked::Scene;
use super::figures::Figures;
use super::filling::{Filling, thermal};
use super::inlet::{Inlet, Opening};
use super::obstacles::Obstacles;
use super::random::{Purpose, Random, Seed};
use super::settings::Encounters;
use crate::bodies::Bodies;
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// What sets the random numbers of inlets apart from those of groups of spheres.
const BEYOND_GROUPS: u64 = 1 << 40;

impl Inlet {
    /// The sphere of a number of the inlet of an index, where its attempt of a number puts it.
    /// All of it but its place is the same at each attempt.
    pub(crate) fn sphere<T: Real>(&self, index: usize, number: u64, attempt: u64) -> Bodies<T> {
        let group = BEYOND_GROUPS * (index as u64 + 1);
        let seed = self.seed.unwrap_or_default();
        let own = Seed { seed, group: group + number };
        let figures = Figures::new(&self.make, 1, own);
        let mut make = self.make.clone();
        for (temperature, inertia, purpose, motion) in [
            (self.temperature, &figures.mass, Purpose::Velocity, &mut make.velocity),
            (self.spin_temperature, &figures.inertia, Purpose::Spin, &mut make.spin),
        ] {
            thermal(1, temperature, inertia, own.random(purpose), |_, drawn| {
                for (component, drawn) in motion.iter_mut().zip(drawn) {
                    *component += drawn;
                }
            });
        }
        let random = Seed { seed, group: group + attempt }.random(Purpose::Position);
        let mut filling = Filling::new(1);
        filling.figures(0, 1, &figures);
        filling.place(0, self.opening.draw(random));
        filling.start(0, &make);
        filling.into_bodies()
    }
}

impl Opening {
    /// A place in it.
    fn draw(&self, mut random: Random) -> [f64; 3] {
        match *self {
            Self::At(place) => place,
            Self::Box([lower, upper]) => {
                array::from_fn(|axis| random.between(lower[axis], upper[axis]))
            }
            Self::Disc(center, axis, reach) => {
                let axis = Vec3::from(axis);
                let axis = axis * (1.0 / axis.length());
                // Across the axis, from the coordinate axis that it is farthest from.
                let [x, y, z] = axis.to_array().each(f64::abs);
                let other = if x <= y && x <= z {
                    Vec3::new(1.0, 0.0, 0.0)
                } else if y <= z {
                    Vec3::new(0.0, 1.0, 0.0)
                } else {
                    Vec3::new(0.0, 0.0, 1.0)
                };
                let first = axis.cross(other);
                let first = first * (1.0 / first.length());
                let second = axis.cross(first);
                loop {
                    let [a, b] = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
                    if a * a + b * b <= 1.0 {
                        let offset = first * (a * reach) + second * (b * reach);
                        return (Vec3::from(center) + offset).to_array();
                    }
                }
            }
        }
    }
}

/// What is in the way of spheres that come.
pub(crate) struct Room<T: Real> {
    obstacles: Obstacles<T>,
    encounters: Encounters,
}

impl<T: Real> Room<T> {
    pub(crate) fn of(scene: &Scene<T>) -> Self {
        let met: &[_] = match scene.encounters {
            Encounters::None => &[],
            _ => &scene.surroundings,
        };
        Self { obstacles: Obstacles::new(met), encounters: scene.encounters }
    }

    /// Whether a sphere overlaps nothing, nor any of these bodies that `is_there`.
    pub(crate) fn takes(
        &self,
        sphere: &Bodies<T>,
        bodies: &Bodies<T>,
        is_there: impl Fn(usize) -> bool,
    ) -> bool {
        let (center, radius) = (sphere.position_of(0), sphere.radius.of(0));
        let is_apart = |body: usize| {
            let reach = radius + bodies.radius.of(body);
            (center - bodies.position_of(body)).length_squared() >= reach * reach
        };
        let meets = self.encounters == Encounters::All;
        self.obstacles.leave_free(center, radius)
            && (!meets || (0..bodies.len()).all(|body| !is_there(body) || is_apart(body)))
    }
}
