//! What it costs when 100,000 balls fall on ever more triangles: `cargo run --release
//! --example mesh_cost`. An argument takes another number of balls.

use std::hint::black_box;
use std::time::Instant;

use carom::engine::{Execution, World};
use carom::scene::{Encounters, EngineKind, Scene, Spheres};
use carom::surroundings::{Heightfield, Mesh};

/// Cells along each side of the terrain, one unit wide.
const SIDES: [usize; 4] = [23, 71, 224, 708];

/// Rounds, of which the fastest counts: each goes through all sizes.
const ROUNDS: usize = 3;

/// Heights of about one cell that no formula of few terms has.
fn terrain(side: usize) -> Result<Mesh<f64>, Box<dyn std::error::Error>> {
    let mut state = 1_u64;
    let heights: Vec<f64> = (0..(side + 1) * (side + 1))
        .map(|_| {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 40) as f64 / (1 << 24) as f64
        })
        .collect();
    let field = Heightfield::new([0.0; 3], [1.0; 2], side + 1, &heights)?;
    Ok(field.mesh().clone())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let balls: u64 = std::env::args().nth(1).map_or(Ok(100_000), |count| count.parse())?;
    println!(
        "{:>10}{:>12}{:>12}{:>16}{:>12}{:>16}{:>12}",
        "triangles", "bytes each", "build ns", "event ns", "to first", "step ns", "to first"
    );
    let mut best = [[f64::INFINITY; 3]; SIDES.len()];
    let mut rows = [(0, 0.0); SIDES.len()];
    for _ in 0..ROUNDS {
        for (k, &side) in SIDES.iter().enumerate() {
            let begin = Instant::now();
            let mesh = terrain(side)?;
            let triangles = mesh.triangles().len();
            best[k][0] = best[k][0].min(begin.elapsed().as_secs_f64() * 1e9 / triangles as f64);
            rows[k] = (triangles, mesh.bytes() as f64 / triangles as f64);
            for (column, engine) in [(1, EngineKind::EventDriven), (2, EngineKind::Stepped)] {
                let inner = [0.1 * side as f64, 0.9 * side as f64];
                let scene = Scene::<f64>::builder()
                    .engine(engine)
                    .dt(0.01)
                    .gravity([0.0, 0.0, -10.0])
                    .encounters(Encounters::Surroundings)
                    .surroundings(mesh.clone())
                    .spheres(
                        Spheres::random(balls)
                            .within([inner[0], inner[0], 2.0], [inner[1], inner[1], 4.0])
                            .radius(0.25)
                            .temperature(0.1),
                    )
                    .build()?;
                let mut world = World::new(scene, Execution::new().threads(1))?;
                world.advance(0.6)?;
                let before = world.collisions().surroundings;
                let begin = Instant::now();
                world.advance(0.6)?;
                let time = begin.elapsed().as_secs_f64() * 1e9;
                let events = world.collisions().surroundings - before;
                let done = if engine == EngineKind::EventDriven { events } else { balls * 60 };
                black_box(&world);
                best[k][column] = best[k][column].min(time / done as f64);
            }
        }
    }
    for ((triangles, bytes), [build, event, step]) in rows.into_iter().zip(best) {
        let [first_event, first_step] = [best[0][1], best[0][2]];
        println!(
            "{triangles:>10}{bytes:>12.1}{build:>12.0}{event:>16.0}{:>12.2}{step:>16.1}{:>12.2}",
            event / first_event,
            step / first_step
        );
    }
    Ok(())
}
