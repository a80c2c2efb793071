//! First contacts with meshes against exact ones, by both engines.

use carom::engine::{Compiled, Execution, World};
use carom::scene::{EngineKind, Scene, Sphere};
use carom::surroundings::{Heightfield, Mesh, Shape};

struct Shot {
    part: String,
    kind: String,
    is_short: bool,
    center: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
    radius: f64,
    /// Time, normal, speed of approach.
    contact: Option<(f64, [f64; 3], f64)>,
}

fn shots() -> Vec<Shot> {
    let text = include_str!("../data/mesh_shots.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    rows.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let vector = |k: usize| [number(k), number(k + 1), number(k + 2)];
        Shot {
            part: fields[0].to_owned(),
            kind: fields[1].to_owned(),
            is_short: fields[2] == "f32",
            center: vector(3),
            velocity: vector(6),
            acceleration: vector(9),
            radius: number(12),
            contact: (fields[13] != "none").then(|| (number(13), vector(14), number(17))),
        }
    })
    .collect()
}

fn part<T: Compiled>(name: &str) -> Shape<T> {
    if name != "heightfield" {
        let text = include_str!("../data/icosphere.obj");
        return Mesh::from_obj(text.as_bytes()).unwrap().into();
    }
    let words = include_str!("../data/heights.csv").split([',', '\n']);
    let heights = words.filter(|word| !word.is_empty()).map(|word| word.parse::<f64>().unwrap());
    let heights: Vec<T> = heights.map(T::from_f64).collect();
    Heightfield::new([T::ZERO; 3], [T::ONE; 2], 6, &heights).unwrap().into()
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// The worst error of all shots as a gap, in ε of the lengths.
fn worst<T: Compiled>(engine: EngineKind, allowed: f64, is_fit: impl Fn(&Shot) -> bool) -> usize {
    let epsilon = T::EPSILON.to_f64();
    let (mut count, mut wrong) = (0, Vec::new());
    for shot in shots().iter().filter(|shot| is_fit(shot)) {
        count += 1;
        let scene = Scene::<T>::builder()
            .engine(engine)
            .dt(0.015625)
            .gravity(shot.acceleration.map(T::from_f64))
            .surroundings(part::<T>(&shot.part))
            .sphere(Sphere::new(shot.center).radius(shot.radius).velocity(shot.velocity))
            .build()
            .unwrap();
        let mut world = World::new(scene, Execution::new().threads(1)).unwrap();
        let mut found = None;
        let longest = shot.contact.map_or(20.0, |(time, ..)| time + 0.1);
        world
            .for_each_event(longest, |event| {
                found.get_or_insert((event.time, event.normal.to_array().map(T::to_f64)));
            })
            .unwrap();
        let at = || {
            format!(
                "{} {} {engine:?} {:?} {:?} {:?}: {found:?} for {:?}",
                shot.part, shot.kind, shot.center, shot.velocity, shot.radius, shot.contact
            )
        };
        let (Some((found, normal)), Some((time, exact, approach))) = (found, shot.contact) else {
            if found.is_some() != shot.contact.is_some() {
                wrong.push(at());
            }
            continue;
        };
        let way = length(shot.velocity) * time + 0.5 * length(shot.acceleration) * time * time;
        let scale = epsilon * (length(shot.center) + way + shot.radius + 8.0);
        let error = (found - time).abs() * approach / scale;
        if shot.kind != "touch" && error > allowed || found > time + 1e-3 {
            wrong.push(format!("{error} ε: {}", at()));
        }
        let off = length(core::array::from_fn(|k| normal[k] - exact[k]));
        let late = error * scale / approach * length(shot.velocity).max(1.0);
        if off > 32.0 * (late + allowed * scale) / shot.radius {
            wrong.push(format!("normal off by {off:e}: {}", at()));
        }
    }
    assert!(wrong.is_empty(), "{} of {count} in {}:\n{}", wrong.len(), T::NAME, wrong.join("\n"));
    count
}

#[test]
fn contacts_with_meshes_are_the_exact_ones() {
    let double = worst::<f64>(EngineKind::EventDriven, 4.0, |_| true);
    let single = worst::<f32>(EngineKind::EventDriven, 4.0, |shot| shot.is_short);
    assert!(double > 60 && single > 30, "{double} {single}");
}

/// Each step rounds the place once more.
#[test]
fn contacts_within_steps_are_the_exact_ones() {
    // What is a graze is one of the path as the steps have rounded it.
    let is_clear = |shot: &Shot| !shot.kind.starts_with("graze");
    let double = worst::<f64>(EngineKind::Stepped, 300.0, is_clear);
    assert!(double > 40, "{double}");
}
