//! The laws of energy and momentum, and the memory of a run.

use carom::contact::Surface;
use carom::engine::{Compiled, Event, Partner};
use carom::motion::Integrator;
use carom::observe::{Energy, Momentum, Temperature, collision_rate, compressibility, total_mass};
use carom::scene::Impact;
use carom::scene::{Scene, Sphere, Spheres};
use carom::surroundings::{Cuboid, FixedSphere};

use crate::{FAST, world};

fn thirty_balls(surface: Surface, integrator: Integrator) -> Scene<f64> {
    Scene::<f64>::builder()
        .surface(surface)
        .integrator(integrator)
        .impact(Impact::EndOfStep)
        .gravity([0.0, 0.3, -9.81])
        .surroundings(Cuboid::container([0.0; 3], [3.0; 3]))
        .spheres(Spheres::random(30).radius(0.25).temperature(20.0).spin_temperature(1.0).seed(8))
        .dt(1e-3)
        .build()
        .unwrap()
}

/// Each step of semi-implicit Euler loses `Δt²|a|²M/2`, whatever collisions
/// happen on the way; explicit Euler gains it; velocity Verlet keeps the energy.
#[test]
fn energy_law_of_the_integrators() {
    let laws = [
        (Integrator::SemiImplicitEuler, -1.0),
        (Integrator::ExplicitEuler, 1.0),
        (Integrator::VelocityVerlet, 0.0),
    ];
    for surface in [Surface::Smooth, Surface::Rough] {
        for (integrator, sign) in laws {
            let scene = thirty_balls(surface, integrator);
            let gravity = scene.gravity;
            let mass = total_mass(&scene.bodies);
            let start = Energy::of(&scene.bodies, gravity).total();
            let mut world = world(scene, FAST);
            world.advance_steps(3_000);
            assert!(world.collisions().pairs > 200, "{:?}", world.collisions());
            let end = Energy::of(&world.bodies(), gravity).total();
            let step = 1e-3_f64.powi(2) * gravity.length_squared() * mass / 2.0;
            let exact = start + sign * 3_000.0 * step;
            let error = ((end - exact) / exact).abs();
            println!("{surface:?} {integrator:?}: {error:.1e}");
            assert!(error < 1e-12, "{surface:?} {integrator:?}: {error:e}");
        }
    }
}

/// What the bodies gain is what gravity and the surroundings gave them.
#[test]
fn momentum_balance_is_exact() {
    for impact in [Impact::EndOfStep, Impact::SubStep] {
        let mut scene = thirty_balls(Surface::Rough, Integrator::VelocityVerlet);
        scene.stepped.impact = impact;
        let gravity = scene.gravity.to_array();
        let mass = total_mass(&scene.bodies);
        let start = Momentum::of(&scene.bodies);
        let mut world = world(scene, FAST);
        world.advance_steps(3_000);
        let end = Momentum::of(&world.bodies());
        let walls = world.impulse_from_surroundings();
        for axis in 0..3 {
            let given = walls[axis] + gravity[axis] * mass * world.time();
            let gained = end.0.to_array()[axis] - start.0.to_array()[axis];
            // The sum of all impulses, not of their remainder, is what rounds.
            let error = (gained - given).abs() / (9.81 * mass * world.time());
            assert!(error < 1e-14, "{impact:?}: {error:e}");
        }
    }
}

/// A gas at restitution 1 keeps its energy to rounding: it is what the peers
/// change by percents.
#[test]
fn gas_keeps_its_energy() {
    fn drift<T: Compiled>(surface: Surface, impact: Impact) -> f64 {
        let side = (1_000.0 * core::f64::consts::PI / 6.0 / 0.1).cbrt();
        let scene = Scene::<T>::builder()
            .surface(surface)
            .impact(impact)
            .surroundings(Cuboid::container([T::ZERO; 3], [T::from_f64(side); 3]))
            .spheres(Spheres::random(1_000).radius(0.5).temperature(1.0).spin_temperature(1.0))
            .dt(0.02 / 3.0_f64.sqrt())
            .build()
            .unwrap();
        let gravity = scene.gravity;
        let start = Energy::of(&scene.bodies, gravity).total();
        let mut world = world(scene, FAST);
        while world.collisions().pairs * 2 < 22_000 {
            world.advance_steps(10);
        }
        (Energy::of(&world.bodies(), gravity).total() - start).abs() / start
    }
    for surface in [Surface::Smooth, Surface::Rough] {
        for impact in [Impact::EndOfStep, Impact::SubStep] {
            let (single, double) = (drift::<f32>(surface, impact), drift::<f64>(surface, impact));
            println!("{surface:?} {impact:?}: f32 {single:.1e}, f64 {double:.1e}");
            assert!(single < 3e-6 && double < 3e-15, "{single:e} {double:e}");
        }
    }
}

/// `I w − (r/R) m c × v` of a rough ball inside a fixed sphere, `R = Rc − r`.
#[test]
fn rough_ball_in_a_sphere_keeps_its_generalised_spin() {
    let (radius, fixed) = (0.3, 2.0);
    let scene = Scene::<f64>::builder()
        .surface(Surface::Rough)
        .impact(Impact::SubStep)
        .surroundings(FixedSphere::container([0.0; 3], fixed))
        .sphere(
            Sphere::new([0.1, 0.2, -0.3])
                .radius(radius)
                .velocity([1.0, -2.0, 0.5])
                .spin([3.0, 1.0, -2.0]),
        )
        .dt(1e-2)
        .build()
        .unwrap();
    let inertia = scene.bodies.inertia.of(0);
    let mut world = world(scene, FAST);
    let mut all = Vec::new();
    for _ in 0..20 {
        world.advance_steps(500);
        let bodies = world.bodies();
        let orbit = bodies.position_of(0).cross(bodies.velocity_of(0));
        all.push(bodies.spin_of(0) * inertia - orbit * (radius / (fixed - radius)));
    }
    assert!(world.collisions().surroundings > 50, "{:?}", world.collisions());
    for value in &all {
        let error = (*value - all[0]).length() / all[0].length();
        assert!(error < 1e-12, "{error:e}");
    }
}

/// A periodic fluid at density 0.5 has the pressure and the collision rate of
/// the literature (mKLM: Z = 3.2694, Γ = (6/√π)(Z − 1)), to what a short run of
/// 2,048 spheres can show.
#[test]
fn hard_sphere_fluid_has_the_published_pressure() {
    let scene = Scene::<f64>::builder()
        .periodic_cube()
        .spheres(Spheres::fcc(2_048).radius(0.5).number_density(0.5).temperature(1.0).seed(1))
        .impact(Impact::SubStep)
        .dt(2e-3)
        .build()
        .unwrap();
    let mut world = world(scene, FAST);
    world.advance(1.0).unwrap();
    let (virial, pairs, time) = (world.virial(), world.collisions().pairs, world.time());
    world.advance(4.0).unwrap();
    let time = world.time() - time;
    let bodies = world.bodies();
    let temperature = Temperature::of(&bodies).unwrap().translational;
    let z = compressibility(bodies.len(), world.virial() - virial, temperature, time);
    // The published rate is that at kT = 1.
    let rate =
        collision_rate(bodies.len(), world.collisions().pairs - pairs, time) / temperature.sqrt();
    println!("Z = {z}, Γ = {rate}");
    assert!((z - 3.2687).abs() < 0.03, "Z = {z}");
    assert!((rate - 7.681).abs() < 0.1, "Γ = {rate}");
}

/// Events come in order, add up to the counters, and the last one of each body
/// leaves it with the velocity that it has at the end.
#[test]
fn events_tell_the_whole_story() {
    for impact in [Impact::EndOfStep, Impact::SubStep] {
        let scene = Scene::<f64>::builder()
            .surface(Surface::Rough)
            .impact(impact)
            .surroundings(Cuboid::container([0.0; 3], [8.0; 3]))
            .spheres(Spheres::random(200).radius(0.5).temperature(1.0).seed(2))
            .dt(5e-3)
            .build()
            .unwrap();
        let mut last: Vec<_> =
            (0..200).map(|k| (scene.bodies.velocity_of(k), scene.bodies.spin_of(k))).collect();
        let mut world = world(scene, FAST);
        let mut before = (0.0, 0, -1);
        let mut counted = [0, 0];
        for _ in 0..500 {
            world.take_steps(
                1,
                Some(&mut |event: &Event<f64>| {
                    assert!(event.normal_impulse > 0.0);
                    assert!((event.normal.length() - 1.0).abs() < 1e-14);
                    assert!(event.normal.dot(event.tangential_impulse).abs() < 1e-12);
                    let (a, b) = match event.partner {
                        Partner::Surroundings(part) => {
                            assert_eq!(part, 0);
                            (event.a as usize, -1)
                        }
                        Partner::Body { index, velocity, spin } => {
                            assert!(event.a < index);
                            last[index as usize] = (velocity, spin);
                            (event.a as usize, i64::from(index))
                        }
                        other => panic!("{other:?}"),
                    };
                    counted[usize::from(b < 0)] += 1;
                    last[a] = (event.velocity, event.spin);
                    let now = (event.time, a, b);
                    assert!(before <= now, "{before:?} then {now:?}");
                    before = now;
                }),
            );
        }
        let found = world.collisions();
        assert_eq!(counted, [found.pairs, found.surroundings]);
        let bodies = world.bodies();
        for (k, (velocity, spin)) in last.into_iter().enumerate() {
            assert_eq!(velocity, bodies.velocity_of(k), "{impact:?} body {k}");
            assert_eq!(spin, bodies.spin_of(k));
        }
    }
}

#[test]
fn memory_is_linear_and_small() {
    fn bytes<T: Compiled>(count: u64) -> f64 {
        let side = (count as f64 * core::f64::consts::PI / 6.0 / 0.1).cbrt();
        let scene = Scene::<T>::builder()
            .surroundings(Cuboid::container([T::ZERO; 3], [T::from_f64(side); 3]))
            .spheres(Spheres::cubic(count).radius(0.5).temperature(1.0))
            .impact(Impact::EndOfStep)
            .dt(0.0115)
            .build()
            .unwrap();
        let mut world = world(scene, FAST);
        world.advance_steps(60);
        world.bytes() as f64 / count as f64
    }
    let (small, large) = (bytes::<f32>(4_000), bytes::<f32>(64_000));
    println!("{small:.0} bytes a body among 4,000, {large:.0} among 64,000");
    assert!(large <= 130.0 && large <= small * 1.2, "{small} {large}");
}
