//! The event-driven engine: nanoseconds a collision and memory, in strict order of time
//! and in windows, on one thread and on two.
//!
//! ```text
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven            # ten minutes
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven -- small   # up to 10,976 bodies
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven -- full    # longer melting, more rounds
//! cargo bench --manifest-path benches/Cargo.toml --bench event_driven -- "0.5, 97556"    # rows of that name
//! ```
//!
//! Each row runs in a process of its own, so that the greatest resident size is
//! its own too; that includes making the scene. All are set up first and then
//! wait; in each round every row has its turn, so that a busy spell of the
//! machine falls on all of them. Ratios are medians of those of the rounds.

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
use carom::engine::{Compiled, EventDriven, Execution, Lanes, Order};
use carom::scene::{Buildable, Scene, SceneError, Spheres};
use carom::space::PeriodicBox;
use fluid::Fluid;

/// Says to this program that it is to measure one row.
const ROW: &str = "--row";

/// Number of bodies of the rows that compare anything but size and density.
const BODIES: u64 = 10_976;

/// Share of the volume that spheres of number density 0.5 fill.
const PACKING_FRACTION: f64 = 0.5 * std::f64::consts::PI / 6.0;

/// A time that no row comes to.
const END: f64 = 1e9;

/// Number densities and numbers of bodies of the fluids.
const DENSITIES: [f64; 3] = [0.5, 0.9, 0.1];
const SIZES: [u64; 4] = [1_372, BODIES, 97_556, 1_000_188];

/// Orders and threads that are compared, the first with all others.
const WAYS: [(Order, usize); 3] = [(Order::Strict, 1), (Order::Windows, 1), (Order::Windows, 2)];

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
    execution: Execution,
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
    let is_option = |text: &&String| ["--bench", "small", "full"].contains(&text.as_str());
    let names: Vec<_> = arguments.iter().filter(|text| !is_option(text)).collect();
    let is_wanted = |row: &Row| {
        row.bodies <= most
            && (names.is_empty() || names.iter().any(|name| row.name.contains(name.as_str())))
    };
    let wanted = rows.iter().enumerate().filter(|(_, row)| is_wanted(row)).collect();
    table(wanted, rounds, has("full"))
}

/// All rows; those of one name are compared.
fn rows() -> Vec<Row> {
    let strict = Execution::new().threads(1).order(Order::Strict);
    let others = |name: &str, matter| Row {
        name: format!("{name}, {BODIES}"),
        matter,
        bodies: BODIES,
        is_single: false,
        execution: strict,
    };
    let fluid = |density, surface| Matter::Fluid { density, surface };
    let mut rows = Vec::new();
    for density in DENSITIES {
        for bodies in SIZES {
            rows.extend(WAYS.map(|(order, threads)| Row {
                name: format!("density {density}, {bodies}"),
                bodies,
                execution: strict.order(order).threads(threads),
                ..others("", fluid(density, Surface::Smooth))
            }));
        }
    }
    let smooth = fluid(0.5, Surface::Smooth);
    rows.push(Row { is_single: true, ..others("f32, density 0.5", smooth) });
    rows.push(others("rough, density 0.5", fluid(0.5, Surface::Rough)));
    rows.push(others("gas in a container, gravity", Matter::Gas));
    rows.push(others("mixture, sizes 1:10", Matter::Mixture));
    let lanes = [Lanes::Auto, Lanes::Scalar, Lanes::Four, Lanes::Eight, Lanes::Sixteen];
    rows.extend(lanes.map(|lanes| Row {
        execution: strict.lanes(lanes),
        ..others("lanes, density 0.5", smooth)
    }));
    rows
}

impl Row {
    fn scene<T: Buildable>(&self) -> Result<Scene<T>, SceneError> {
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
    let mut world = EventDriven::with_execution(row.scene::<T>()?, row.execution)?;
    world.advance_about(END, melting * row.bodies / 2, None)?;
    println!();
    for line in io::stdin().lines() {
        let collisions = line?.parse()?;
        let (start, before) = (Instant::now(), world.collisions().total());
        world.advance_about(END, collisions, None)?;
        let made = world.collisions().total() - before;
        let time = start.elapsed().as_secs_f64() / made as f64;
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

    /// Ends the process, and gives the row of the table, beside another row's times.
    fn finish(mut self, others: &[f64]) -> Result<String, Box<dyn Error>> {
        drop(self.orders);
        self.child.wait()?;
        let Row { name, execution, .. } = self.row;
        let [engine, process] = self.memory;
        let ratios = others.iter().zip(&self.times).map(|(other, time)| other / time).collect();
        let best = self.times.iter().copied().fold(f64::INFINITY, f64::min);
        let [time, ratio] = [self.times, ratios].map(median);
        Ok(format!(
            "| {name} | {} | {} | {} | {:.0} | {:.0} | {ratio:.2} | {engine:.0} | {process:.0} |",
            execution.order,
            execution.threads,
            execution.lanes,
            best * 1e9,
            time * 1e9,
        ))
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The table of some rows, with their numbers among all.
fn table(rows: Vec<(usize, &Row)>, rounds: usize, is_full: bool) -> Result<(), Box<dyn Error>> {
    println!("{}; {rounds} rounds. Smooth, f64 and in a", process::processor());
    println!("periodic cube unless said. The ratio is the time of the first row of a name to that");
    println!("of a row, the median over the rounds; memory is in bytes a body.");
    println!();
    println!(
        "| | order | threads | lanes | ns a collision, least | median | ratio | engine | process |"
    );
    println!("|---|---|--:|---|--:|--:|--:|--:|--:|");
    let mut running = Vec::new();
    for (index, row) in rows {
        running.push(Running::start(row, index, is_full)?);
    }
    for _ in 0..rounds {
        for row in &mut running {
            row.measure()?;
        }
    }
    let mut first = (String::new(), Vec::new());
    for row in running {
        if row.row.name != first.0 {
            first = (row.row.name.clone(), row.times.clone());
        }
        println!("{}", row.finish(&first.1)?);
    }
    Ok(())
}
