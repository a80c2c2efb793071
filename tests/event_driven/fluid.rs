//! Statistics of many bodies: the Lorentz gas, the hard-sphere fluid, rough
//! spheres that begin to spin.

use carom::contact::Surface;
use carom::engine::EventDriven;
use carom::observe::{Temperature, collision_rate, compressibility};
use carom::scene::{Encounters, Spheres};
use carom::space::PeriodicBox;
use carom::surroundings::FixedSphere;

use crate::{builder, world};

/// Mean free path of points in the cubic lattice of fixed spheres of radius `a`:
/// `(1 − 4πa³/3)/(πa²)`. Of small spheres, which do not meet each other, the
/// sum of the radii counts.
#[test]
fn lorentz_gas() {
    for (a, exact) in [(0.2, 7.691080), (0.3, 3.136777)] {
        let radius = 1.0 / 64.0;
        let scene = builder::<f64>()
            .encounters(Encounters::Surroundings)
            .periodic(PeriodicBox::new([0.0; 3], [1.0; 3]))
            .surroundings(FixedSphere::solid([0.5; 3], a - radius))
            .spheres(Spheres::random(2000).radius(radius).temperature(1.0).seed(3));
        let mut world = world(scene.build().unwrap());
        world.advance(200.0).unwrap();
        let found = world.mean_free_path().unwrap();
        println!("a = {a}: {found} in {} flights", world.collisions().surroundings);
        assert!((found / exact - 1.0).abs() < 0.01, "a = {a}: {found} for {exact}");
    }
}

/// Smooth spheres of diameter 1 in a periodic cube, in equilibrium.
fn fluid(count: u64, density: f64, seed: u64) -> EventDriven<f64> {
    let spheres = Spheres::fcc(count).radius(0.5).number_density(density).temperature(1.0);
    let scene = builder().periodic_cube().spheres(spheres.seed(seed));
    let mut world = world(scene.build().unwrap());
    // A hundred collisions a sphere melt a lattice.
    world.advance_until(50 * count, 1e9).unwrap();
    world
}

/// Z and Γ at kT = 1, over a number of collisions a sphere.
fn measured(world: &mut EventDriven<f64>, collisions: u64) -> [f64; 2] {
    let bodies = world.bodies();
    let count = bodies.len();
    let temperature = Temperature::of(&bodies).unwrap().translational;
    let (virial, pairs, time) = (world.virial(), world.collisions().pairs, world.time());
    world.advance_until(collisions * count as u64 / 2, 1e9).unwrap();
    let (virial, pairs) = (world.virial() - virial, world.collisions().pairs - pairs);
    let time = world.time() - time;
    let rate = collision_rate(count, pairs, time) / temperature.sqrt();
    [compressibility(count, virial, temperature, time), rate]
}

/// Pressure and collision rate of the hard-sphere fluid, to what a second shows.
#[test]
fn hard_sphere_fluid() {
    for (density, z, rate) in
        [(0.1, 1.23937, 0.81126), (0.5, 3.26870, 7.68082), (0.9, 10.75927, 33.03458)]
    {
        let [found_z, found_rate] = measured(&mut fluid(1372, density, 1), 400);
        println!("ρ = {density}: Z = {found_z:.4} for {z}, Γ = {found_rate:.4} for {rate}");
        assert!((found_z / z - 1.0).abs() < 0.01, "ρ = {density}: Z = {found_z}");
        assert!((found_rate / rate - 1.0).abs() < 0.01, "ρ = {density}: Γ = {found_rate}");
    }
}

/// The same against the independent measurements and their errors, which takes
/// minutes: `cargo test --test event_driven -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn hard_sphere_fluid_to_four_digits() {
    let table: [(f64, [f64; 2], [f64; 2]); 6] = [
        (0.1, [1.23937, 0.81126], [0.00007, 0.00022]),
        (0.2, [1.55317, 1.87376], [0.00020, 0.00054]),
        (0.4, [2.52067, 5.14931], [0.00065, 0.00218]),
        (0.5, [3.26870, 7.68082], [0.00068, 0.00215]),
        (0.7, [5.72660, 16.00007], [0.00202, 0.00674]),
        (0.9, [10.75927, 33.03458], [0.00302, 0.01078]),
    ];
    for (density, exact, errors) in table {
        let mut world = fluid(4000, density, 2);
        // Parts are as good as independent: their spread gives the error.
        let parts: Vec<[f64; 2]> = (0..20).map(|_| measured(&mut world, 500)).collect();
        for (what, name) in ["Z", "Γ"].into_iter().enumerate() {
            let values = parts.iter().map(|part| part[what]);
            let mean = values.clone().sum::<f64>() / 20.0;
            let square = values.map(|value| (value - mean).powi(2)).sum::<f64>();
            let error = (square / (20.0 * 19.0)).sqrt();
            let both = (error.powi(2) + errors[what].powi(2)).sqrt();
            let off = (mean - exact[what]) / both;
            println!("ρ = {density}: {name} = {mean:.5} ± {error:.5}, {off:+.1} σ");
            assert!(off.abs() < 4.0, "ρ = {density}: {name} = {mean} for {}", exact[what]);
        }
    }
}

/// Rough spheres from no spin: T_rot/T_trans after some collisions a sphere.
#[test]
fn rough_spheres_begin_to_spin() {
    let exact = [(0.5, 0.1369), (1.0, 0.2664), (2.0, 0.4836), (4.0, 0.7747), (8.0, 0.9601)];
    let mut sums = [0.0; 5];
    let seeds = 8;
    for seed in 0..seeds {
        let spheres = Spheres::fcc(10_976).radius(0.5).number_density(0.2).temperature(1.0);
        let scene = builder::<f64>().periodic_cube().spheres(spheres.seed(seed)).build().unwrap();
        let space = scene.periodic.unwrap();
        // Smooth at first, until the lattice has melted.
        let mut smooth = world(scene);
        smooth.advance_until(10 * 10_976, 1e9).unwrap();
        let rough = builder().surface(Surface::Rough).periodic(space).bodies(smooth.bodies());
        let mut world = world(rough.build().unwrap());
        for ((collisions, _), sum) in exact.iter().zip(&mut sums) {
            let pairs = (collisions * 10_976.0 / 2.0) as u64;
            world.advance_until(pairs - world.collisions().pairs, 1e9).unwrap();
            let temperature = Temperature::of(&world.bodies()).unwrap();
            *sum += temperature.rotational / temperature.translational / f64::from(seeds as u32);
        }
    }
    for ((collisions, exact), found) in exact.into_iter().zip(sums) {
        println!("after {collisions}: {found:.4} for {exact}");
        assert!((found / exact - 1.0).abs() < 0.02, "after {collisions}: {found} for {exact}");
    }
}

/// In a periodic box the spins of rough spheres come to have `N/(N − 1)` of the
/// energy of their centres.
#[test]
fn rough_spheres_share_their_energy() {
    let count = 32;
    let spheres = Spheres::fcc(count).radius(0.5).number_density(0.4).temperature(1.0).seed(5);
    let scene = builder::<f64>().surface(Surface::Rough).periodic_cube().spheres(spheres);
    let mut world = world(scene.build().unwrap());
    world.advance(20.0).unwrap();
    let mut energy = [0.0; 2];
    for _ in 0..20_000 {
        world.advance(0.5).unwrap();
        let now = world.energy();
        energy[0] += now.rotational;
        energy[1] += now.translational;
    }
    let (found, exact) = (energy[0] / energy[1], count as f64 / (count as f64 - 1.0));
    println!("E_rot/E_trans = {found:.4} for {exact:.4}");
    assert!((found / exact - 1.0).abs() < 0.01, "{found}");
}
