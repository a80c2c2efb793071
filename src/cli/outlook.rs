//! Outlook: how long a run will take, and whether it can come to an end.

use core::time::Duration;
use std::thread;

use carom::engine::{Execution, LONGEST_RUN};
use carom::observe::{Energy, total_mass};
use carom::real::Real;
use carom::scene::{Encounters, EngineKind, MOST_STEPS, Scene};
use indicatif::HumanDuration;

use super::failure::Failure;

/// Less than any machine takes for a body and step on one thread, seconds: the
/// fastest loops over columns in the first-level cache take four times as long.
const LEAST: f64 = 5e-11;

/// A run that takes longer is refused, years.
const MOST_YEARS: f64 = 10.0;

const YEAR: f64 = 3.156e7;

/// Refuses a run that no machine would bring to its end, or whose end f64 could
/// not tell from chance. What is counted here is certain: steps, and how often
/// bodies cross the space that encloses them.
pub fn check<T: Real>(
    scene: &Scene<T>,
    duration: f64,
    execution: Execution,
) -> Result<(), Failure> {
    match (scene.engine, scene.stepped.dt) {
        (EngineKind::Stepped, Some(dt)) => {
            let cores = thread::available_parallelism().map_or(1, usize::from);
            let threads = if execution.threads == 0 { cores } else { execution.threads };
            let (steps, bodies) = (duration / dt, scene.bodies.len());
            let years = steps * bodies as f64 * LEAST / threads as f64 / YEAR;
            if years > MOST_YEARS {
                return Err(Failure::Argument(format!(
                    "{}: {steps:.1e} steps of {bodies} bodies would take more than {MOST_YEARS} \
                     years; take a shorter duration (--duration) or a longer step (--dt)",
                    scene.name
                )));
            }
        }
        _ => {
            if duration > LONGEST_RUN {
                return Err(Failure::Argument(format!(
                    "{}: the duration {duration:?} is longer than the {LONGEST_RUN:e} that the \
                     event-driven engine can count; take a shorter one (--duration), or a larger \
                     unit of time",
                    scene.name
                )));
            }
            let crossings = crossings(scene, duration);
            if crossings > MOST_STEPS {
                return Err(Failure::Argument(format!(
                    "{}: until the duration {duration:?} is over, bodies cross the space that \
                     encloses them some {crossings:.1e} times, and after 2^53 times nothing is left \
                     of where they are; take a shorter one (--duration)",
                    scene.name
                )));
            }
        }
    }
    Ok(())
}

/// How often a body crosses the periodic box, or the container, in the mean: at
/// least this.
fn crossings<T: Real>(scene: &Scene<T>, duration: f64) -> f64 {
    let containers = scene.surroundings.iter().filter_map(|shape| shape.interior());
    let has_walls = scene.encounters != Encounters::None;
    let containers =
        containers.filter(|_| has_walls).map(|[lower, upper]| (upper - lower).cast::<f64>());
    let space = match &scene.periodic {
        Some(space) => Some(space.sides().cast::<f64>()),
        None => containers.reduce(|a, b| if a.length() < b.length() { a } else { b }),
    };
    let Some(across) = space.map(|sides| sides.length()) else { return 0.0 };
    let motion = Energy::of(&scene.bodies, scene.gravity).translational;
    // What gravity takes away on the way up.
    let climb = scene.gravity.cast::<f64>().length() * across;
    let square = 2.0 * (motion / total_mass(&scene.bodies) - climb);
    square.max(0.0).sqrt() * duration / across
}

/// A length of time on the wall that is ahead, in words.
pub fn ahead(seconds: f64) -> String {
    if seconds > MOST_YEARS * YEAR {
        return "no end in sight".to_owned();
    }
    let duration = Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or_default();
    format!("about {} ahead", HumanDuration(duration))
}
