//! The event-driven engine: collisions a second and memory, beside the best
//! public code.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven            # two minutes
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven -- small   # up to 10,976 bodies
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven -- full    # longer melting, more rounds
//! ```
//!
//! Each row runs in a process of its own, so that the greatest resident size is
//! its own too; that includes making the scene. All are set up first and then
//! wait; in each round every row has its turn, so that a busy spell of the
//! machine falls on all of them.

#[path = "common/fluid.rs"]
mod fluid;
#[path = "common/process.rs"]
mod process;
#[path = "common/scenes.rs"]
mod scenes;

use std::env;
use std::error::Error;
use std::io::{self, BufRead, BufReader, Lines, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use carom::contact::Surface;
use carom::engine::{Compiled, EventDriven, Execution, Lanes};
use carom::real::Real;
use carom::scene::{Scene, SceneError, Spheres};
use carom::space::PeriodicBox;
use fluid::Fluid;

/// Says to this program that it is to measure one row.
const ROW: &str = "--row";

/// Number of bodies of the rows that compare anything but size and density.
const BODIES: u64 = 10_976;

/// Share of the volume that spheres of number density 0.5 fill.
const PACKING_FRACTION: f64 = 0.5 * std::f64::consts::PI / 6.0;

/// Thousand collisions a second by number density and number of bodies: the
/// best public code, and what carom is to reach. Smallenburg's event-driven
/// molecular dynamics (2022, github.com/FSmallenburg/EDMD), the faster of its
/// two methods, cells at 0.5 and neighbour lists at 0.9, on one core of another
/// machine of this kind (Cascade Lake, 2.5 GHz, shared: ±30 %).
const FIGURES: [(f64, u64, Option<f64>, Option<f64>); 12] = [
    (0.5, 1_372, Some(552.0), Some(1_650.0)),
    (0.5, BODIES, Some(398.0), Some(1_200.0)),
    (0.5, 97_556, Some(171.0), Some(700.0)),
    (0.5, 1_000_188, Some(100.0), Some(500.0)),
    (0.9, 1_372, Some(892.0), Some(2_700.0)),
    (0.9, BODIES, Some(741.0), Some(2_200.0)),
    (0.9, 97_556, Some(217.0), Some(1_000.0)),
    (0.9, 1_000_188, Some(238.0), Some(800.0)),
    (0.1, 1_372, None, None),
    (0.1, BODIES, Some(192.0), Some(600.0)),
    (0.1, 97_556, None, None),
    (0.1, 1_000_188, None, None),
];

/// Bytes a body of the same code and carom's goal.
const BYTES: &str = "2,130 at density 0.5, 412 at 0.9; carom's goal is 250";

/// What moves.
#[derive(Clone, Copy)]
enum Matter {
    Fluid {
        density: f64,
        surface: Surface,
    },
    /// In a closed container under gravity, at the top a third of what there is
    /// at the bottom.
    Gas,
    /// Of sizes 1 to 10, one material.
    Mixture,
}

/// One row of the table.
struct Row {
    name: String,
    matter: Matter,
    bodies: u64,
    is_single: bool,
    lanes: Lanes,
    best_public: Option<f64>,
    goal: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let has = |name| arguments.iter().any(|argument| argument == name);
    let mut rows = rows();
    if let [ROW, index, melting] = arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        let row = rows.swap_remove(index.parse()?);
        let melting = melting.parse()?;
        return if row.is_single {
            serve::<f32>(&row, melting)
        } else {
            serve::<f64>(&row, melting)
        };
    }
    let is_measurement = has("--bench");
    let most = match () {
        () if !is_measurement => 1_372,
        () if has("small") => BODIES,
        () => u64::MAX,
    };
    let rounds = match () {
        () if !is_measurement => 1,
        () if has("full") => 15,
        () => 5,
    };
    table(&rows, most, rounds, has("full"))
}

/// All rows.
fn rows() -> Vec<Row> {
    let others = |name: &str, matter| Row {
        name: name.to_owned(),
        matter,
        bodies: BODIES,
        is_single: false,
        lanes: Lanes::Auto,
        best_public: None,
        goal: None,
    };
    let fluid = |density, surface| Matter::Fluid { density, surface };
    let smooth = fluid(0.5, Surface::Smooth);
    let mut rows: Vec<Row> = FIGURES
        .into_iter()
        .map(|(density, bodies, best_public, goal)| {
            let row = others(&format!("density {density}"), fluid(density, Surface::Smooth));
            Row { bodies, best_public, goal, ..row }
        })
        .collect();
    rows.push(Row { is_single: true, ..others("density 0.5, f32", smooth) });
    rows.push(others("density 0.5, rough", fluid(0.5, Surface::Rough)));
    rows.push(others("gas in a container, gravity", Matter::Gas));
    rows.push(others("mixture, sizes 1:10", Matter::Mixture));
    let lanes = [
        (Lanes::Scalar, "scalar"),
        (Lanes::Four, "4 lanes"),
        (Lanes::Eight, "8 lanes"),
        (Lanes::Sixteen, "16 lanes"),
    ];
    rows.extend(
        lanes.map(|(lanes, name)| Row { lanes, ..others(&format!("density 0.5, {name}"), smooth) }),
    );
    rows
}

impl Row {
    fn scene<T: Real>(&self) -> Result<Scene<T>, SceneError> {
        match self.matter {
            Matter::Fluid { density, surface } => {
                Fluid { bodies: self.bodies, density, diameter: 1.0, surface, seed: 1 }.scene()
            }
            Matter::Gas => {
                let mut scene = scenes::gas(self.bodies as usize, Surface::Smooth)?;
                scene.gravity.z = -T::ratio(1, 40);
                Ok(scene)
            }
            Matter::Mixture => {
                let (least, greatest): (f64, f64) = (0.05, 0.5);
                let cubes = (greatest.powi(4) - least.powi(4)) / (4.0 * (greatest - least));
                let volume = self.bodies as f64 * 4.0 / 3.0 * std::f64::consts::PI * cubes;
                let side = T::from_f64((volume / PACKING_FRACTION).cbrt());
                let spheres =
                    Spheres::random(self.bodies).radius(least..=greatest).density(1.0).seed(1);
                Scene::builder()
                    .periodic(PeriodicBox::new([T::ZERO; 3], [side; 3]))
                    .spheres(spheres.temperature(1.0))
                    .build()
            }
        }
    }

    /// Collisions of a body before anything is measured. A dense lattice of few
    /// bodies takes 30 to melt; the same for a million bodies takes a minute.
    fn melting(&self, is_full: bool) -> u64 {
        match self.matter {
            Matter::Fluid { density, .. } if density > 0.8 && self.bodies < 1_000_000 => 30,
            _ if is_full => 30,
            _ if self.bodies < 1_000_000 => 10,
            _ => 5,
        }
    }
}

/// Sets a row up, says so, and then lets as many collisions happen as each line
/// of the input asks for. Every answer is the time of a collision in seconds,
/// the engine's memory and that of the process, bytes a body.
fn serve<T: Compiled>(row: &Row, melting: u64) -> Result<(), Box<dyn Error>> {
    let execution = Execution::new().lanes(row.lanes).threads(1);
    let mut world = EventDriven::with_execution(row.scene::<T>()?, execution)?;
    world.advance_until(melting * row.bodies / 2, 1e9)?;
    println!();
    for line in io::stdin().lines() {
        let collisions = line?.parse()?;
        let start = Instant::now();
        let collisions = world.advance_until(collisions, 1e9)?;
        let time = start.elapsed().as_secs_f64() / collisions as f64;
        let bodies = row.bodies as f64;
        let peak = process::peak_resident().unwrap_or(f64::NAN) / bodies;
        println!("{time} {} {peak}", world.bytes() as f64 / bodies);
    }
    Ok(())
}

/// A row that is being measured, in its process.
struct Running<'a> {
    row: &'a Row,
    child: Child,
    orders: ChildStdin,
    answers: Lines<BufReader<ChildStdout>>,
    times: Vec<f64>,
    memory: [f64; 2],
}

impl<'a> Running<'a> {
    /// Starts a row, and waits until it is ready.
    fn start(row: &'a Row, index: usize, is_full: bool) -> Result<Self, Box<dyn Error>> {
        let mut child = Command::new(env::current_exe()?)
            .args([ROW, &index.to_string(), &row.melting(is_full).to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (Some(orders), Some(answers)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("a process without input and output".into());
        };
        let answers = BufReader::new(answers).lines();
        let mut running =
            Self { row, child, orders, answers, times: Vec::new(), memory: [f64::NAN; 2] };
        running.answer()?;
        Ok(running)
    }

    fn answer(&mut self) -> Result<String, Box<dyn Error>> {
        let name = &self.row.name;
        Ok(self.answers.next().ok_or_else(|| format!("{name}: the process has ended"))??)
    }

    /// One measurement more. A million bodies are measured over a collision of
    /// each with two others, since some of the work is done once in a while.
    fn measure(&mut self) -> Result<(), Box<dyn Error>> {
        writeln!(self.orders, "{}", self.row.bodies.max(200_000))?;
        let answer = self.answer()?;
        let figures: Vec<f64> = answer.split(' ').map(str::parse).collect::<Result<_, _>>()?;
        let [time, engine, process] = figures[..] else {
            return Err(format!("not an answer: {answer}").into());
        };
        self.times.push(time);
        self.memory = [engine, process];
        Ok(())
    }

    /// Ends the process, and gives the row of the table.
    fn finish(self) -> Result<String, Box<dyn Error>> {
        let Self { row, mut child, orders, mut times, memory: [engine, process], .. } = self;
        drop(orders);
        child.wait()?;
        times.sort_by(f64::total_cmp);
        let (best, median) = (times[0], times[times.len() / 2]);
        let thousands = |time: f64| 1e-3 / time;
        let share = |figure: Option<f64>| {
            figure.map_or("|".to_owned(), |figure| {
                format!("{figure:.0} | {:.2}", thousands(median) / figure)
            })
        };
        Ok(format!(
            "| {} | {} | {:.0} | {:.0} | {:.0} | {engine:.0} | {process:.0} | {} | {} |",
            row.name,
            row.bodies,
            thousands(best),
            thousands(median),
            median * 1e9,
            share(row.best_public),
            share(row.goal),
        ))
    }
}

/// The table of all rows up to a number of bodies.
fn table(rows: &[Row], most: u64, rounds: usize, is_full: bool) -> Result<(), Box<dyn Error>> {
    println!("Thousand collisions a second, one thread, {rounds} rounds; f64, smooth and in a");
    println!("periodic cube unless said. The best public code and the goal are figures of");
    println!("another machine. Ratios and ns are of the median. Its bytes a body: {BYTES}.");
    println!();
    println!(
        "| | N | best | median | ns a collision | engine, bytes a body | process, bytes a body \
         | best public | ratio | goal | ratio |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    let mut running = Vec::new();
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| row.bodies <= most) {
        running.push(Running::start(row, index, is_full)?);
    }
    for _ in 0..rounds {
        for row in &mut running {
            row.measure()?;
        }
    }
    for row in running {
        println!("{}", row.finish()?);
    }
    Ok(())
}
