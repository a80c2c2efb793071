//! Crystals near close packing.

use core::f64::consts::SQRT_2;

use super::case::{Case, Extent, Findings, Studied, Trial, greatest, in_epsilon, trial};
use super::{Figure, gas};
use crate::engine::EventDriven;
use crate::observe::{Momentum, Temperature, compressibility};
use crate::scene::{Scene, Spheres};
use crate::space::Space;
use crate::study::invariants::energy_change;

pub(super) const CASE: Case = Case {
    name: "crystal",
    title: "face-centred cubic crystals; close packing is at density √2",
    law: "No ball leaves its cage: no centre is ever half of the distance to its neighbours away from its \
          place in the lattice. Pressure by free volume, Z = 3/a + 2.566 + 0.55 a, a = √2/ρ − 1 \
          (Alder, Hoover and Young 1968), to 1 %. Energy and momentum walk by less than 12 √n ε of \
          one body's share; overlaps are 4 δ at most, the rounding of a place and of the time. Where gaps of a/3 are less than 32 \
          roundings of a place, the precision cannot hold it. Normals lie in planes of the lattice to \
          within a: where a² is within three decades of ε, the least of the squares in x·x is lost \
          again and again, and the energy drifts.",
    trials,
    combine: Findings::joined,
    picture: None,
};

/// Spheres in the crystal, `4·6³`.
const BODIES: u64 = 864;

/// How often the positions are looked at.
const LOOKS: u64 = 32;

fn trials(extent: Extent) -> Vec<Trial> {
    let collisions = extent.of(10_000_000, 100_000);
    [1.3, 1.41, 1.414]
        .into_iter()
        .flat_map(|density| {
            [crystal::<f32>(density, collisions), crystal::<f64>(density, collisions)]
        })
        .collect()
}

fn crystal<T: Studied>(density: f64, collisions: u64) -> Trial {
    trial::<T, _>(format!("density {density}"), 1.5e-6 * collisions as f64, move || {
        let excess = SQRT_2 / density - 1.0;
        let spheres = Spheres::fcc(BODIES).number_density(density).radius(0.5).temperature(1.0);
        let scene = Scene::<T>::builder().periodic_cube().spheres(spheres).build()?;
        let (lattice, space) = (scene.bodies.clone(), scene.periodic);
        let side = space.map_or(f64::NAN, |space| space.sides().x.to_f64());
        let is_lost = excess / 3.0 < 32.0 * T::EPSILON.to_f64() * side;

        let mut world = EventDriven::new(scene)?;
        // From the lattice to what lasts.
        world.advance_until(collisions / 4, 1e9)?;
        let (start, before) = (world.time(), [world.virial(), world.collisions().total() as f64]);
        let [mut farthest, mut overlap] = [0.0, 0.0];
        for _ in 0..LOOKS {
            world.advance_until(collisions / LOOKS, 1e9)?;
            let now = world.bodies();
            farthest = greatest([farthest, greatest(gas::distances(&now, &lattice, space))]);
            let nearest = |offset| space.map_or(offset, |space| space.nearest(offset));
            let depth = gas::overlap(&now, &[], nearest);
            overlap = greatest([overlap, depth / gas::rounding::<T>(side, world.time())]);
        }
        let end = world.bodies();
        let temperature = Temperature::of(&end).map_or(f64::NAN, |t| t.translational);
        let virial = world.virial() - before[0];
        let z = compressibility(end.len(), virial, temperature, world.time() - start);
        let free_volume = 3.0 / excess + 2.566 + 0.55 * excess;

        let walk = (world.collisions().total() as f64).sqrt() / BODIES as f64;
        let energy = in_epsilon::<T>(energy_change(&end, &lattice)).abs() / walk;
        let momentum =
            in_epsilon::<T>(Momentum::of(&end).0.length() / (3.0_f64.sqrt() * BODIES as f64))
                / walk;
        let name = |what: &str| format!("{what}, ρ = {density}");
        let spacing = (SQRT_2 / density).cbrt();
        let figures = vec![
            Figure::at_most(
                T::PRECISION,
                name("farthest from its place"),
                farthest / spacing,
                0.5,
                "",
            ),
            Figure::near(T::PRECISION, name("Z, of free volume's"), z / free_volume, 1.0, 0.01, ""),
            Figure::at_most(T::PRECISION, name("energy"), energy, gas::WALK, "√n ε")
                .beyond_precision_if(gas::rounds_alike::<T>(excess * excess)),
            Figure::at_most(T::PRECISION, name("momentum"), momentum, gas::WALK, "√n ε"),
            Figure::at_most(T::PRECISION, name("overlap"), overlap, 4.0, "δ"),
        ];
        Ok(figures
            .into_iter()
            .map(|figure| figure.beyond_precision_if(is_lost))
            .collect::<Vec<_>>())
    })
}
