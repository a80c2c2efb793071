//! 4,096 billiard tables of 16 balls, played as a vectorised environment of reinforcement
//! learning: `reset`, `step(actions)`, `observe`.
//!
//! An action is an impulse on the cue ball of each table; the reward is the number of
//! collisions that it makes. `cargo run --release --example tables`

use std::error::Error;
use std::time::Instant;

use carom::scene::EngineKind;
use carom::{Batch, Cuboid, Execution, Impact, Scene, Sphere};

const TABLES: usize = 4_096;

/// Steps from one action to the next.
const STEPS: u64 = 50;

/// All tables.
struct Tables {
    start: Scene<f32>,
    batch: Batch<f32>,
    /// Collisions so far on each table.
    collisions: Vec<u64>,
}

impl Tables {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut scene = Scene::<f32>::builder()
            .engine(EngineKind::Stepped)
            .dt(2e-3)
            .impact(Impact::EndOfStep)
            .surroundings(Cuboid::container([0.0; 3], [2.0, 1.0, 0.06]))
            .sphere(Sphere::new([0.5, 0.5, 0.03]).radius(0.03));
        // A rack of five rows.
        for row in 0..5 {
            for ball in 0..=row {
                let x = 1.4 + f64::from(row) * 0.054;
                let y = 0.5 + (f64::from(ball) - 0.5 * f64::from(row)) * 0.062;
                scene = scene.sphere(Sphere::new([x, y, 0.03]).radius(0.03));
            }
        }
        let start = scene.build()?;
        let batch = Batch::varied(&start, TABLES, Execution::new(), |_, _| {})?;
        Ok(Self { start, batch, collisions: vec![0; TABLES] })
    }

    /// Puts the balls of a table back.
    fn reset(&mut self, table: usize) -> Result<(), Box<dyn Error>> {
        self.collisions[table] = 0;
        Ok(self.batch.reset(table, &self.start)?)
    }

    /// Plays the cue ball of each table, and gives the rewards.
    fn step(&mut self, actions: &[[f32; 2]], rewards: &mut [u64]) -> Result<(), Box<dyn Error>> {
        for (table, [x, y]) in actions.iter().enumerate() {
            self.batch.apply_impulse(table, 0, [*x, *y, 0.0])?;
        }
        self.batch.advance_steps(STEPS)?;
        let collisions = self.batch.collisions().map(|collisions| collisions.pairs);
        for ((before, now), reward) in self.collisions.iter_mut().zip(collisions).zip(rewards) {
            *reward = now - *before;
            *before = now;
        }
        Ok(())
    }

    /// Where the cue balls are, straight from the lanes.
    fn observe(&self, places: &mut [[f32; 2]]) {
        for pack in self.batch.packs() {
            for (lane, table) in pack.scenes() {
                let index = pack.index(0, lane);
                places[table] = [pack.position[0][index], pack.position[1][index]];
            }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut tables = Tables::new()?;
    let (mut rewards, mut places) = (vec![0; TABLES], vec![[0.0; 2]; TABLES]);
    let (mut best, mut total) = (0, 0);
    let start = Instant::now();
    let rounds = 20;
    for round in 0..rounds {
        tables.observe(&mut places);
        // A policy that plays to where the rack was, each table a little differently.
        let actions: Vec<[f32; 2]> = places
            .iter()
            .enumerate()
            .map(|(table, [x, y])| {
                let aside = (table as f32 / TABLES as f32 - 0.5) * 0.1;
                [(1.4 - x) * 2.0, (0.5 - y) * 2.0 + aside]
            })
            .collect();
        tables.step(&actions, &mut rewards)?;
        total += rewards.iter().sum::<u64>();
        best = best.max(rewards.iter().copied().max().unwrap_or(0));
        if round % 10 == 9 {
            for table in 0..TABLES {
                tables.reset(table)?;
            }
        }
    }
    let steps = (TABLES * rounds) as f64;
    println!("{total} collisions of balls on {TABLES} tables, the most of one action {best}");
    println!("{:.0} actions a second", steps / start.elapsed().as_secs_f64());
    assert_eq!(tables.batch.faults().count(), 0);
    Ok(())
}
