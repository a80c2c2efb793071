//! The scenes, as plain numbers. Every coordinate, velocity and spin is a
//! value that an `f32` holds exactly, so that engines of either precision get
//! the same input. Lengths are in sphere diameters, masses in sphere masses.

use std::sync::Arc;

use oorandom::Rand64;

use crate::mesh::{Mesh, Terrain};

/// Radius of every sphere.
pub const RADIUS: f64 = 0.5;

/// Δt of every scene but the bounces: near the 1/60 that games use and their
/// engines are tuned for, and exact in binary.
pub const DT: f64 = 1.0 / 64.0;

/// Root mean square of the distance that a sphere moves in one step, diameters.
pub const DIAMETERS_A_STEP: f64 = 0.02;

/// Share of the container's volume that the spheres of the gas fill.
pub const PACKING_FRACTION: f64 = 0.1;

/// Angular velocity of the spin scene: |(2, 3, 6)| = 7, so it turns by
/// 1309 / 131072 ≈ 0.01 rad a step, exactly.
pub const SPIN: [f64; 3] = [2.0 * 187.0 / 2048.0, 3.0 * 187.0 / 2048.0, 6.0 * 187.0 / 2048.0];

/// One sphere: uniform, solid, of mass 1.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre.
    pub position: [f64; 3],
    /// Velocity of the centre.
    pub velocity: [f64; 3],
    /// Angular velocity in the world frame, radians per unit of time.
    pub spin: [f64; 3],
}

/// What surrounds the spheres.
#[derive(Clone, Debug)]
pub enum Surroundings {
    /// Nothing.
    None,
    /// The cubic container from the origin to (`side`, `side`, `side`), closed.
    Container {
        /// Its inner side.
        side: f64,
    },
    /// The floor z = 0.
    Floor,
    /// The floor z = 0, of triangles.
    FlatMesh(Arc<Mesh>),
    /// Hills in a closed room, of triangles.
    Terrain(Arc<Terrain>),
}

/// What spheres can collide with. Engines need not look for other collisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encounters {
    /// Nothing.
    None,
    /// The surroundings.
    Surroundings,
    /// The surroundings and each other.
    All,
}

/// Smooth, elastic spheres: restitution 1, friction 0.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// What surrounds them.
    pub surroundings: Surroundings,
    /// Acceleration along z; 0 without gravity.
    pub gravity: f64,
    /// Time step.
    pub dt: f64,
    /// What spheres can collide with.
    pub encounters: Encounters,
}

impl Scene {
    /// An equilibrated gas in a container: centres at random without overlap,
    /// Maxwellian velocities of zero mean, no spin.
    pub fn gas(bodies: usize) -> Self {
        Self::gas_of(bodies, 1)
    }

    /// The gas of a seed.
    pub fn gas_of(bodies: usize, seed: u128) -> Self {
        let mut random = Rand64::new(seed);
        let volume = bodies as f64 * std::f64::consts::PI / 6.0 / PACKING_FRACTION;
        let side = single(volume.cbrt());
        let positions = random_positions(bodies, side, &mut random);
        let velocities = maxwellian(bodies, DIAMETERS_A_STEP / DT, &mut random);
        Self {
            spheres: positions
                .into_iter()
                .zip(velocities)
                .map(|(position, velocity)| Sphere { position, velocity, spin: [0.0; 3] })
                .collect(),
            surroundings: Surroundings::Container { side },
            ..Self::empty()
        }
    }

    /// Spheres four diameters apart that all move at the same velocity and
    /// spin by 0.01 rad a step about axes of their own: they never meet.
    pub fn free_flight(bodies: usize, collisions: bool) -> Self {
        let mut random = Rand64::new(2);
        let speed = DIAMETERS_A_STEP / DT;
        let velocity = [1.0, 2.0, 2.0].map(|c| single(c / 3.0 * speed));
        Self {
            spheres: lattice(bodies, 4.0)
                .map(|position| Sphere {
                    position,
                    velocity,
                    spin: direction(&mut random).map(|c| single(c * 0.01 / DT)),
                })
                .collect(),
            encounters: if collisions { Encounters::All } else { Encounters::None },
            ..Self::empty()
        }
    }

    /// A ball that falls on a floor from a height of 1 (its lowest point), at
    /// gravity 1, with Δt = 1/240.
    pub fn bounce() -> Self {
        Self {
            spheres: vec![Sphere {
                position: [0.0, 0.0, RADIUS + 1.0],
                velocity: [0.0; 3],
                spin: [0.0; 3],
            }],
            surroundings: Surroundings::Floor,
            gravity: -1.0,
            dt: 1.0 / 240.0,
            ..Self::empty()
        }
    }

    /// A sphere that spins at [`SPIN`] about an axis that is none of the
    /// coordinate axes.
    pub fn spin() -> Self {
        Self {
            spheres: vec![Sphere { position: [0.0; 3], velocity: [0.0; 3], spin: SPIN }],
            ..Self::empty()
        }
    }

    /// Pairs of spheres, bodies 2 i and 2 i + 1, far from all other pairs, that
    /// collide between steps 5 and 30: random direction, impact parameter
    /// uniform on the disc, and the relative speed of the gas.
    pub fn pairs(pairs: usize) -> Self {
        let mut random = Rand64::new(3);
        let relative_speed = std::f64::consts::SQRT_2 * DIAMETERS_A_STEP / DT;
        let mut spheres = Vec::with_capacity(2 * pairs);
        for centre in lattice(pairs, 8.0) {
            let approach = direction(&mut random);
            let across = perpendicular(approach, &mut random);
            // Up to 0.998 diameters: at a full diameter they would only graze.
            let impact = 0.998 * random.rand_float().sqrt();
            let path = (5.0 + 25.0 * random.rand_float()) * relative_speed * DT;
            let along = (1.0 - impact * impact).sqrt() + path;
            let drift = direction(&mut random).map(|c| c * DIAMETERS_A_STEP / DT / 2.0);
            for side in [-0.5, 0.5] {
                let at = |k: usize| side * (along * approach[k] + impact * across[k]);
                let moves = |k: usize| drift[k] - side * relative_speed * approach[k];
                spheres.push(Sphere {
                    position: [0, 1, 2].map(|k| single(centre[k] + at(k))),
                    velocity: [0, 1, 2].map(|k| single(moves(k))),
                    spin: [0.0; 3],
                });
            }
        }
        Self { spheres, ..Self::empty() }
    }

    /// Spheres over hills, on four cells each, that do not meet each other. They
    /// fall from up to 12 diameters at gravity 10, or fly in all directions
    /// without gravity, at `diameters_a_step`.
    pub fn terrain(bodies: usize, diameters_a_step: Option<f64>) -> Self {
        let mut random = Rand64::new(6);
        let edge = (bodies as f64).sqrt().ceil() as usize;
        let spheres = (0..bodies)
            .map(|i| {
                let mut near = |middle: f64| single(middle + 0.8 * (random.rand_float() - 0.5));
                let [x, y] = [i % edge, i / edge].map(|k| near(2.0 * k as f64 + 1.0));
                let z = single(Terrain::HIGHEST + 1.0 + 4.0 * random.rand_float());
                let speed = diameters_a_step.unwrap_or(0.0) / DT;
                let velocity = direction(&mut random).map(|c| single(speed * c));
                Sphere { position: [x, y, z], velocity, spin: [0.0; 3] }
            })
            .collect();
        Self {
            spheres,
            surroundings: Surroundings::Terrain(Arc::new(Terrain::new(2 * edge))),
            gravity: if diameters_a_step.is_some() { 0.0 } else { -10.0 },
            encounters: Encounters::Surroundings,
            ..Self::empty()
        }
    }

    /// A ball that hops over a floor from a height of `drop`, or slides on it
    /// if that is 0: across a flat mesh in [`Self::SEAMS_STEPS`] steps.
    pub fn seams(drop: f64, surroundings: Surroundings) -> Self {
        Self {
            spheres: vec![Sphere {
                position: [-6.0, -13.0, single(RADIUS + drop)],
                velocity: [0.5, 1.125, 0.0],
                spin: [0.0; 3],
            }],
            surroundings,
            gravity: -1.0,
            encounters: Encounters::Surroundings,
            ..Self::empty()
        }
    }

    /// Steps in which a ball comes to the other side of the flat mesh.
    pub const SEAMS_STEPS: usize = 1500;

    fn empty() -> Self {
        Self {
            spheres: Vec::new(),
            surroundings: Surroundings::None,
            gravity: 0.0,
            dt: DT,
            encounters: Encounters::All,
        }
    }
}

/// The nearest value that an `f32` holds.
pub fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Points of a cubic lattice around the origin.
fn lattice(points: usize, spacing: f64) -> impl Iterator<Item = [f64; 3]> {
    let edge = (points as f64).cbrt().ceil() as usize;
    let place = move |i: usize| spacing * (i as f64 - (edge / 2) as f64);
    (0..points).map(move |i| [place(i % edge), place(i / edge % edge), place(i / edge / edge)])
}

/// Centres of spheres put into the container one after the other, each where
/// it overlaps none of those before. At the packing fraction used here this
/// is close to the equilibrium distribution.
fn random_positions(bodies: usize, side: f64, random: &mut Rand64) -> Vec<[f64; 3]> {
    // Cells of at least a diameter: neighbours are in the 27 cells around.
    let edge = (side as usize).max(1);
    let cell = |x: f64| ((x / side * edge as f64) as usize).min(edge - 1);
    let mut cells: Vec<Vec<[f64; 3]>> = vec![Vec::new(); edge * edge * edge];
    let mut positions = Vec::with_capacity(bodies);
    while positions.len() < bodies {
        let point = [(); 3].map(|()| single(RADIUS + (side - 2.0 * RADIUS) * random.rand_float()));
        let [i, j, k] = point.map(cell);
        let around = |c: usize| c.saturating_sub(1)..=(c + 1).min(edge - 1);
        let free = around(i).all(|i| {
            around(j).all(|j| {
                around(k).all(|k| {
                    cells[(i * edge + j) * edge + k].iter().all(|other| {
                        let d = [0, 1, 2].map(|a| point[a] - other[a]);
                        d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 4.0 * RADIUS * RADIUS
                    })
                })
            })
        });
        if free {
            cells[(i * edge + j) * edge + k].push(point);
            positions.push(point);
        }
    }
    positions
}

/// Velocities of a Maxwellian distribution, moved and scaled to zero mean and
/// exactly the root mean square `speed`.
fn maxwellian(bodies: usize, speed: f64, random: &mut Rand64) -> Vec<[f64; 3]> {
    let mut velocities: Vec<[f64; 3]> = (0..bodies).map(|_| normal(random)).collect();
    let count = bodies as f64;
    let mean = [0, 1, 2].map(|k| velocities.iter().map(|v| v[k]).sum::<f64>() / count);
    for v in &mut velocities {
        *v = [0, 1, 2].map(|k| v[k] - mean[k]);
    }
    let squares: f64 = velocities.iter().flatten().map(|c| c * c).sum();
    let scale = speed / (squares / count).sqrt();
    for v in &mut velocities {
        *v = v.map(|c| single(c * scale));
    }
    velocities
}

/// Three independent normal numbers (Box and Muller).
fn normal(random: &mut Rand64) -> [f64; 3] {
    [(); 3].map(|()| {
        let radius = (-2.0 * (1.0 - random.rand_float()).ln()).sqrt();
        radius * (std::f64::consts::TAU * random.rand_float()).cos()
    })
}

/// A random unit vector.
fn direction(random: &mut Rand64) -> [f64; 3] {
    let v = normal(random);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| c / length)
}

/// A random unit vector perpendicular to the unit vector `a`.
fn perpendicular(a: [f64; 3], random: &mut Rand64) -> [f64; 3] {
    let v = direction(random);
    let along = a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
    let rest = [0, 1, 2].map(|k| v[k] - along * a[k]);
    let length = (rest[0] * rest[0] + rest[1] * rest[1] + rest[2] * rest[2]).sqrt();
    rest.map(|c| c / length)
}
