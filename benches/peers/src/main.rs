//! Measures carom and other rigid-body engines on the same scenes and prints
//! one table.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- --quick
//! ```
//!
//! Run time is a median over rounds in which the engines take turns; `ratio`
//! is to the first engine of the same precision. Accuracy is measured in runs
//! of its own, once: the engines are deterministic. `peer.rs` says what each
//! figure means, `scene.rs` what is in each scene.

mod carom_engine;
mod measure;
mod mesh;
mod peer;
mod rapier_engine;
mod reference;
mod report;
mod rounds;
mod scene;
mod several;

use std::process::ExitCode;

use clap::{Parser, ValueEnum};

use peer::{Peer, PeerError, Timing};
use report::Row;
use scene::Scene;

/// Measure carom and other rigid-body engines on the same scenes.
#[derive(Parser)]
struct Arguments {
    /// Few bodies, steps and rounds: a look, no measurement.
    #[arg(long)]
    quick: bool,
    /// Only these scenes (may be repeated).
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<SceneName>,
    /// Numbers of bodies of the gas, of free flight and over hills, with commas between.
    #[arg(long, value_delimiter = ',', value_name = "N")]
    bodies: Vec<usize>,
    /// Threads of the timed runs.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    threads: u16,
    /// Timed rounds.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: Option<u16>,
    /// Also measure rapier with its default solver settings.
    #[arg(long)]
    defaults: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SceneName {
    /// Gas in a container: time, energy, collisions.
    Gas,
    /// Many small gases: time.
    Batch,
    /// Bodies that never meet: time.
    FreeFlight,
    /// A ball on a floor: apex after 1,000 bounces.
    Bounce,
    /// A sphere that spins: angle after 10⁶ steps.
    Spin,
    /// Single collisions: velocities.
    Pairs,
    /// Spheres over hills of triangles: time, energy, spheres that fall through.
    Terrain,
    /// A ball on a flat mesh and on a plane: how they differ.
    Seams,
}

/// How much is measured.
struct Extent {
    gas: Vec<usize>,
    /// No more bodies than this in a gas whose energy is followed.
    gas_accuracy: usize,
    /// Small gases of a batch.
    scenes: usize,
    free_flight: Vec<usize>,
    /// Body-steps of one timed run.
    body_steps: usize,
    rounds: usize,
    bounces: usize,
    spin_steps: usize,
    pairs: usize,
    terrain: Vec<usize>,
    /// Steps in which the energy over hills is followed.
    terrain_steps: usize,
}

/// The fast spheres over hills: their diameters a step.
const FAST: f64 = 1000.0;

/// How many there are, and their steps, in each of which one meets dozens of
/// triangles.
const FAST_SPHERES: usize = 100;
const FAST_STEPS: usize = 4;

/// Bodies of each of many small gases.
const TABLE: usize = 16;

/// Steps in which a sphere of the gas collides 22 times with others by
/// Enskog's theory: 4 √(π/3) n σ² χ times the distance of 1,080 · 0.02 σ.
const ACCURACY_STEPS: usize = 1080;

impl Extent {
    fn new(arguments: &Arguments) -> Self {
        let mut extent = if arguments.quick {
            Self {
                gas: vec![1_000],
                gas_accuracy: 1_000,
                scenes: 64,
                free_flight: vec![10_000],
                body_steps: 200_000,
                rounds: 3,
                bounces: 100,
                spin_steps: 10_000,
                pairs: 1_000,
                terrain: vec![100],
                terrain_steps: 200,
            }
        } else {
            Self {
                gas: vec![1_000, 10_000, 100_000],
                gas_accuracy: 10_000,
                scenes: 1_024,
                free_flight: vec![100_000, 1_000_000],
                body_steps: 2_000_000,
                rounds: 5,
                bounces: 1_000,
                spin_steps: 1_000_000,
                pairs: 4_000,
                terrain: vec![1_000],
                terrain_steps: 1_000,
            }
        };
        if !arguments.bodies.is_empty() {
            extent.gas.clone_from(&arguments.bodies);
            extent.free_flight.clone_from(&arguments.bodies);
            extent.terrain.clone_from(&arguments.bodies);
        }
        if let Some(rounds) = arguments.rounds {
            extent.rounds = usize::from(rounds);
        }
        extent
    }

    /// Steps of a timed run: as many as make up `body_steps`, but some.
    fn steps(&self, bodies: usize) -> usize {
        (self.body_steps / bodies.max(1)).max(5)
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match measured(&arguments) {
        Ok(rows) => {
            println!("{}", report::table(&rows));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("carom-peers: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measured(arguments: &Arguments) -> Result<Vec<Row>, PeerError> {
    let extent = Extent::new(arguments);
    let threads = usize::from(arguments.threads);
    let mut peers = carom_engine::engines();
    peers.extend(rapier_engine::engines(rapier_engine::Settings::Tuned));
    if arguments.defaults {
        peers.extend(rapier_engine::engines(rapier_engine::Settings::Defaults));
    }
    let mut with_meshes = carom_engine::with_meshes();
    with_meshes.extend(rapier_engine::with_meshes());
    let mut batches = carom_engine::batches();
    batches.extend(rapier_engine::engines(rapier_engine::Settings::Tuned));
    let mut rows = Vec::new();
    for &scene in SceneName::value_variants() {
        if !arguments.scenes.is_empty() && !arguments.scenes.contains(&scene) {
            continue;
        }
        match scene {
            SceneName::Gas => {
                for &bodies in &extent.gas {
                    rows.extend(gas(&peers, &extent, bodies, threads)?);
                }
            }
            SceneName::Batch => rows.extend(batch(&batches, &extent, threads)?),
            SceneName::FreeFlight => {
                for &bodies in &extent.free_flight {
                    for detection in [true, false] {
                        rows.extend(free_flight(&peers, &extent, bodies, threads, detection)?);
                    }
                }
            }
            SceneName::Bounce => rows.extend(single(&peers, "bounce", 1, |peer| {
                Ok(report::bounce(peer.bounce(extent.bounces)?))
            })?),
            SceneName::Spin => rows.extend(single(&peers, "spin", 1, |peer| {
                Ok(report::spin(peer.spin(extent.spin_steps)?))
            })?),
            SceneName::Pairs => rows.extend(single(&peers, "pairs", 2 * extent.pairs, |peer| {
                Ok(report::pairs(peer.pairs(extent.pairs)?))
            })?),
            SceneName::Terrain => {
                let hops = [200, extent.terrain_steps];
                for &bodies in &extent.terrain {
                    rows.extend(terrain(&with_meshes, "terrain", &extent, bodies, None, hops)?);
                }
                let steps = [FAST_STEPS; 2];
                let (scene, speed) = ("terrain, fast", Some(FAST));
                rows.extend(terrain(&with_meshes, scene, &extent, FAST_SPHERES, speed, steps)?);
            }
            SceneName::Seams => {
                for (scene, drop) in
                    [("seams, hops", 0.25), ("seams, low hops", 0.01), ("seams, slides", 0.0)]
                {
                    rows.extend(single(&with_meshes, scene, 1, |peer| {
                        Ok(peer.seams(drop).map_or_else(|error| error.brief(), report::seams))
                    })?);
                }
            }
        }
    }
    Ok(rows)
}

fn gas(
    peers: &[Box<dyn Peer>],
    extent: &Extent,
    bodies: usize,
    threads: usize,
) -> Result<Vec<Row>, PeerError> {
    let steps = extent.steps(bodies);
    let times = rounds::interleaved(peers, extent.rounds, |peer| peer.gas(bodies, steps, threads))?;
    let mut rows = Vec::new();
    for (peer, times) in peers.iter().zip(times) {
        let follow_energy = bodies <= extent.gas_accuracy;
        rows.push(Row {
            scene: "gas".to_owned(),
            bodies,
            engine: peer.name(),
            times: Some(times),
            energy: follow_energy.then(|| peer.gas_accuracy(bodies, ACCURACY_STEPS)).transpose()?,
            ..Row::default()
        });
    }
    Ok(rows)
}

/// Many small gases, each of its own seed.
fn batch(peers: &[Box<dyn Peer>], extent: &Extent, threads: usize) -> Result<Vec<Row>, PeerError> {
    let scenes: Vec<_> = (0..extent.scenes).map(|k| Scene::gas_of(TABLE, k as u128 + 1)).collect();
    let bodies = scenes.len() * TABLE;
    let steps = extent.steps(bodies);
    let times =
        rounds::interleaved(peers, extent.rounds, |peer| peer.gases(&scenes, steps, threads))?;
    let row = |(peer, times): (&Box<dyn Peer>, _)| Row {
        scene: format!("{} gases", scenes.len()),
        bodies,
        engine: peer.name(),
        times: Some(times),
        ..Row::default()
    };
    Ok(peers.iter().zip(times).map(row).collect())
}

/// Spheres over hills: steps of a timed run, and of one whose energy is
/// followed. An engine that gives up goes on with the next scene.
fn terrain(
    peers: &[Box<dyn Peer>],
    scene: &str,
    extent: &Extent,
    bodies: usize,
    speed: Option<f64>,
    [timed_steps, steps]: [usize; 2],
) -> Result<Vec<Row>, PeerError> {
    let times = rounds::interleaved(peers, extent.rounds, |peer| {
        let unknown = Timing { nanoseconds: f64::NAN };
        Ok(peer.terrain(bodies, speed, timed_steps).unwrap_or(unknown))
    })?;
    Ok(peers
        .iter()
        .zip(times)
        .map(|(peer, times)| {
            let (energy, result) = match peer.terrain_accuracy(bodies, speed, steps) {
                Ok(energy) => (Some(energy), String::new()),
                Err(error) => (None, error.brief()),
            };
            let times = Some(times).filter(|times| times.nanoseconds.is_finite());
            Row { scene: scene.to_owned(), bodies, engine: peer.name(), times, energy, result }
        })
        .collect())
}

fn free_flight(
    peers: &[Box<dyn Peer>],
    extent: &Extent,
    bodies: usize,
    threads: usize,
    detection: bool,
) -> Result<Vec<Row>, PeerError> {
    let steps = extent.steps(bodies);
    let times = rounds::interleaved(peers, extent.rounds, |peer| {
        peer.free_flight(bodies, steps, threads, detection)
    })?;
    let scene = if detection { "free flight" } else { "free flight, no detection" };
    Ok(peers
        .iter()
        .zip(times)
        .map(|(peer, times)| Row {
            scene: scene.to_owned(),
            bodies,
            engine: peer.name(),
            times: Some(times),
            ..Row::default()
        })
        .collect())
}

fn single(
    peers: &[Box<dyn Peer>],
    scene: &str,
    bodies: usize,
    result: impl Fn(&dyn Peer) -> Result<String, PeerError>,
) -> Result<Vec<Row>, PeerError> {
    peers
        .iter()
        .map(|peer| {
            Ok(Row {
                scene: scene.to_owned(),
                bodies,
                engine: peer.name(),
                result: result(peer.as_ref())?,
                ..Row::default()
            })
        })
        .collect()
}
