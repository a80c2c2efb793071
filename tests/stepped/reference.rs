//! The engine against a program of a page: every pair tested, every contact
//! taken one after another. Not close to it: the same bits.

use carom::bodies::{Bodies, PerBody};
use carom::contact::{Party, Rough, Smooth, Surface, collide};
use carom::engine::Compiled;
use carom::motion::Integrator;
use carom::motion::flight::{Remainders, compensated_flight_and_fastest, flight};
use carom::motion::integrator::SemiImplicitEuler;
use carom::observe::state_hash;
use carom::scene::{Impact, Scene, Sphere, Spheres, Summation};
use carom::space::{OpenSpace, PeriodicBox, Space};
use carom::surroundings::{Cuboid, FixedSphere, Plane};
use carom::vec3::Vec3;

use crate::{FAST, SCALAR, world};

struct Reference<T: Compiled> {
    bodies: Bodies<T>,
    /// What the rounding of positions and of velocities leaves out.
    low: [[Vec<T>; 3]; 2],
    collisions: [u64; 2],
}

impl<T: Compiled> Reference<T> {
    fn party(&self, index: usize, share: T) -> Party<T> {
        Party {
            velocity: self.bodies.velocity_of(index),
            spin: self.bodies.spin_of(index),
            inverse_mass: T::ONE / self.bodies.mass.of(index),
            inverse_inertia: T::ONE / self.bodies.inertia.of(index),
            share,
        }
    }

    fn give(&mut self, index: usize, party: &Party<T>) {
        self.low[1].iter_mut().for_each(|column| column[index] = T::ZERO);
        for axis in 0..3 {
            self.bodies.velocity[axis][index] = party.velocity.to_array()[axis];
            self.bodies.spin[axis][index] = party.spin.to_array()[axis];
        }
    }

    fn step<S: Space<T>>(&mut self, scene: &Scene<T>, space: S) {
        let [x, y, z] = &mut self.bodies.position;
        let [u, v, w] = &mut self.bodies.velocity;
        let dt = T::from_f64(scene.stepped.dt.unwrap());
        if scene.stepped.summation == Summation::Plain {
            flight::<T, SemiImplicitEuler, S>([x, y, z], [u, v, w], scene.gravity, dt, space);
        } else {
            let low = self.low.each_mut().map(|columns| columns.each_mut());
            let [position, velocity] = low.map(|columns| columns.map(Vec::as_mut_slice));
            compensated_flight_and_fastest::<T, SemiImplicitEuler, S>(
                [x, y, z],
                [u, v, w],
                Remainders { position, velocity },
                scene.gravity,
                dt,
                space,
            );
        }
        let collide = |offset, a: &mut Party<T>, b: &mut Party<T>| match scene.surface {
            Surface::Smooth => collide(Smooth, offset, a, b),
            _ => collide(Rough, offset, a, b),
        };
        for a in 0..self.bodies.len() {
            let center = self.bodies.position_of(a);
            let radius = self.bodies.radius.of(a);
            for feature in scene.surroundings.iter().flat_map(|shape| shape.features()) {
                let clearance = feature.clearance::<T>(center, radius);
                if clearance.gap <= T::ZERO {
                    let mut party = self.party(a, T::ONE);
                    let impulse = collide(clearance.arm, &mut party, &mut Party::immovable());
                    if impulse.approaching {
                        self.collisions[1] += 1;
                        self.give(a, &party);
                    }
                }
            }
            for b in a + 1..self.bodies.len() {
                let reach = radius + self.bodies.radius.of(b);
                let offset = space.nearest(center - self.bodies.position_of(b));
                if offset.length_squared() <= reach * reach {
                    let mut first = self.party(a, radius / reach);
                    let mut second = self.party(b, self.bodies.radius.of(b) / reach);
                    let impulse = collide(offset, &mut first, &mut second);
                    if impulse.approaching {
                        self.collisions[0] += 1;
                        self.give(a, &first);
                        self.give(b, &second);
                    }
                }
            }
        }
    }
}

/// Runs both and compares all bits but those of the orientations, which the
/// reference does not turn.
fn agree<T: Compiled>(scene: Scene<T>, steps: u64) {
    let low = core::array::from_fn(|_| core::array::from_fn(|_| vec![T::ZERO; scene.bodies.len()]));
    let mut reference = Reference { bodies: scene.bodies.clone(), low, collisions: [0; 2] };
    for _ in 0..steps {
        match scene.periodic {
            None => reference.step(&scene, OpenSpace),
            Some(space) => reference.step(&scene, space),
        }
    }
    assert!(reference.collisions.iter().sum::<u64>() > 100, "too few contacts to compare");
    for execution in [SCALAR, FAST] {
        let mut engine = world(scene.clone(), execution);
        engine.advance_steps(steps);
        let mut bodies = engine.bodies();
        bodies.orientation = None;
        let found = [engine.collisions().pairs, engine.collisions().surroundings];
        assert_eq!(found, reference.collisions, "{} {execution:?}", scene.name);
        assert_eq!(state_hash(&bodies), state_hash(&reference.bodies), "{}", scene.name);
    }
}

fn scenes_agree<T: Compiled>(summation: Summation) {
    let t = |value: f64| T::from_f64(value);
    let corner = |value: f64| [t(value); 3];
    for surface in [Surface::Smooth, Surface::Rough] {
        let builder = || {
            Scene::<T>::builder()
                .surface(surface)
                .integrator(Integrator::SemiImplicitEuler)
                .impact(Impact::EndOfStep)
                .summation(summation)
                .dt(0.01)
        };
        let gas = Spheres::random(150).radius(0.4).temperature(1.0).spin_temperature(1.0).seed(3);
        let container = Cuboid::container(corner(0.0), corner(6.0));
        agree(
            builder().name("container").surroundings(container).spheres(gas).build().unwrap(),
            300,
        );

        let mixed = Spheres::random(150)
            .radius(0.05..=0.5)
            .density(1.0..=3.0)
            .temperature(1.0)
            .spin_temperature(1.0)
            .seed(4);
        let falling = builder()
            .name("mixed sizes, solids, gravity")
            .gravity([T::ZERO, T::ZERO, t(-2.0)])
            .surroundings(Cuboid::container(corner(0.0), corner(7.0)))
            .surroundings(Cuboid::solid(corner(1.5), corner(2.5)))
            .surroundings(FixedSphere::solid(corner(5.0), t(0.8)))
            .surroundings(Plane::new([t(3.0), T::ZERO, T::ZERO], [t(1.0), t(0.2), t(2.0)]))
            .spheres(mixed.clone().within([3.0, 3.0, 2.5], [7.0, 7.0, 7.0]));
        agree(falling.build().unwrap(), 400);

        let periodic = builder()
            .name("periodic, mixed sizes")
            .periodic(PeriodicBox::new(corner(-2.0), corner(2.5)))
            .spheres(mixed);
        agree(periodic.build().unwrap(), 200);

        // Bodies that leave the box come back right in front of the solid.
        let lattice = builder()
            .name("periodic, a solid at the boundary")
            .periodic(PeriodicBox::new(corner(0.0), corner(6.0)))
            .surroundings(FixedSphere::solid([t(1.21), t(3.0), t(3.0)], t(1.0)))
            .spheres(Spheres::random(200).radius(0.2).temperature(4.0).seed(9));
        agree(lattice.build().unwrap(), 600);

        // More solids than are tested one by one, of sizes 1 to 20, with bodies
        // that leave the box in front of some.
        let mut posts = builder()
            .name("periodic, many solids")
            .periodic(PeriodicBox::new(corner(0.0), corner(6.0)))
            .surroundings(Cuboid::solid([t(0.3), t(1.0), t(2.0)], [t(5.7), t(1.2), t(2.2)]));
        for k in 0..64 {
            let center = [k % 4, k / 4 % 4, k / 16].map(|c| t(0.9 + 1.4 * f64::from(c)));
            let radius = if k % 3 == 0 { t(0.65) } else { t(0.05) };
            posts = posts.surroundings(FixedSphere::solid(center, radius));
        }
        let small = Spheres::random(150).radius(0.05..=0.2).temperature(4.0).seed(10);
        agree(posts.spheres(small).build().unwrap(), 300);

        let dense = Spheres::fcc(108).radius(0.5).number_density(1.1).temperature(1.0).seed(5);
        agree(builder().name("dense").periodic_cube().spheres(dense).build().unwrap(), 200);

        // One so far away that no grid of so few bodies could span them all.
        let stray = Sphere::new([1e6, -1e6, 3e5]).radius(0.4).velocity([-3.0, 0.5, 0.0]);
        let gas =
            Spheres::random(100).within([0.0; 3], [5.0; 3]).radius(0.4).temperature(1.0).seed(6);
        let open = builder()
            .name("a stray body")
            .surroundings(FixedSphere::container(corner(2.0), t(2e6)))
            .sphere(stray)
            .spheres(gas);
        agree(open.build().unwrap(), 300);
    }
}

#[test]
fn same_bits_as_one_contact_after_another() {
    for summation in [Summation::Plain, Summation::Compensated] {
        scenes_agree::<f32>(summation);
        scenes_agree::<f64>(summation);
    }
}

/// Overlaps that a step left are resolved in the scene's order, also in long
/// chains of contacts that share bodies.
#[test]
fn chains_of_contacts_keep_the_scenes_order() {
    let mut builder = Scene::<f64>::builder()
        .dt(0.05)
        .impact(Impact::EndOfStep)
        .summation(Summation::Plain)
        .surface(Surface::Rough);
    for k in 0..60 {
        let x = f64::from((k * 37) % 60);
        let sphere = Sphere::new([x, 0.01 * x, 0.0]).radius(0.5).spin([0.0, 1.0, 0.3]);
        builder = builder.sphere(sphere.velocity([30.0 - x, 0.0, 0.0]));
    }
    let scene = builder.build().unwrap();
    assert!(matches!(scene.bodies.radius, PerBody::Same(_)));
    assert_eq!(scene.bodies.velocity_of(0), Vec3::new(30.0, 0.0, 0.0));
    agree(scene, 100);
}
