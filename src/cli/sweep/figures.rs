//! Figures: what a run of a sweep gives, as numbers under names.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::cli::analyses::Found;
use crate::cli::summary::Summary;

/// A figure of a summary.
struct Figure {
    name: &'static str,
    of: fn(&Summary) -> Option<f64>,
}

/// Names a figure and says what it is.
macro_rules! figures {
    ($($name:literal: $of:expr,)*) => {
        &[$(Figure { name: $name, of: $of }),*]
    };
}

/// All figures. A mean over the run is one where the summary has that.
const FIGURES: &[Figure] = figures! {
    "bodies": |summary| Some(summary.setup.bodies as f64),
    "time": |summary| Some(summary.time),
    "steps": |summary| Some(summary.steps as f64),
    "pairs": |summary| Some(summary.collisions.pairs as f64),
    "surroundings": |summary| Some(summary.collisions.surroundings as f64),
    "energy": |summary| Some(summary.energy.end),
    "energy_change": |summary| Some(summary.energy.relative_change),
    "temperature": |summary| {
        mean(summary, "temperature").or(Some(summary.temperature?.translational))
    },
    "spin_temperature": |summary| {
        mean(summary, "spin_temperature").or(Some(summary.temperature?.rotational))
    },
    "compressibility": |summary| summary.compressibility,
    "pressure": |summary| mean(summary, "pressure"),
    "collision_rate": |summary| summary.collision_rate,
    "mean_free_path": |summary| summary.mean_free_path,
};

fn mean(summary: &Summary, name: &str) -> Option<f64> {
    summary.statistics.get(name).map(|statistic| statistic.mean)
}

/// The names of all figures, in the order of the tables.
pub fn names() -> impl Iterator<Item = &'static str> {
    FIGURES.iter().map(|figure| figure.name)
}

/// The names of figures that analyses have found in some of these runs.
pub fn found_names<'a>(runs: impl Iterator<Item = &'a Outcome>) -> BTreeSet<&'a str> {
    let all = runs.flat_map(|run| run.figures.keys().map(String::as_str));
    all.filter(|name| !names().any(|known| known == *name)).collect()
}

/// What came of a run. The journal keeps it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The figures that it has.
    pub figures: BTreeMap<String, f64>,
    /// The statistical errors that the run itself gives.
    pub errors: BTreeMap<String, f64>,
    /// The bits of the final state.
    pub state_hash: Option<String>,
    /// Wall time, seconds.
    pub seconds: f64,
    /// Why there are no figures.
    pub failure: Option<String>,
    /// The files of its analyses.
    #[serde(default)]
    pub files: Vec<String>,
}

impl Outcome {
    /// Of a run that came to its end.
    pub fn of(summary: &Summary) -> Self {
        let figures = FIGURES.iter();
        let figures =
            figures.filter_map(|Figure { name, of }| Some(((*name).to_owned(), of(summary)?)));
        let errors = summary.statistics.iter();
        Self {
            figures: figures.collect(),
            errors: errors.map(|(name, one)| ((*name).to_owned(), one.error)).collect(),
            state_hash: Some(summary.state_hash.to_string()),
            seconds: summary.wall_seconds,
            failure: None,
            files: Vec::new(),
        }
    }
}

impl Outcome {
    /// The same with what its analyses have found: figures, by the entry of each in the scene.
    pub fn with_found(mut self, found: &[Found], files: Vec<String>) -> Self {
        self.files = files;
        for (index, found) in found.iter().enumerate() {
            for (name, figure) in &found.figures {
                let name = format!("analyse[{index}].{name}");
                if let Some(error) = figure.error {
                    self.errors.insert(name.clone(), error);
                }
                self.figures.insert(name, figure.mean);
            }
        }
        self
    }
}

/// The mean of a figure over some runs and its standard error: that of the mean over seeds,
/// `s/√n`, or that which one run gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    pub mean: f64,
    pub error: Option<f64>,
}

impl Mean {
    /// Over the runs that have the figure; `None` if none has.
    pub fn of(name: &str, runs: &[Outcome]) -> Option<Self> {
        let values: Vec<f64> =
            runs.iter().filter_map(|run| run.figures.get(name).copied()).collect();
        let count = values.len() as f64;
        if values.is_empty() {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count;
        if let [_] = values[..] {
            let error = runs.iter().find_map(|run| run.errors.get(name).copied());
            return Some(Self { mean, error });
        }
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Some(Self { mean, error: Some((squares / (count - 1.0) / count).sqrt()) })
    }

    /// For people: as many digits as the error leaves.
    pub fn shown(self) -> String {
        let Self { mean, error } = self;
        let Some(error) = error.filter(|error| *error > 0.0) else { return plainly(mean) };
        let digits = (0..12).find(|&digits| error * 10_f64.powi(digits) >= 9.5);
        match digits {
            Some(digits) if mean.abs() < 1e9 => {
                let digits = digits as usize;
                format!("{mean:.digits$} ± {error:.digits$}")
            }
            _ => format!("{mean:.3e} ± {error:.1e}"),
        }
    }
}

/// A number of which no error is known, in few digits.
fn plainly(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if value.fract() == 0.0 && size < 1e9 => format!("{value}"),
        size if (1e-3..1e6).contains(&size) => format!("{value:.5}"),
        _ => format!("{value:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(value: f64, error: f64) -> Outcome {
        let named = |value: f64| BTreeMap::from([("temperature".to_owned(), value)]);
        Outcome { figures: named(value), errors: named(error), ..Outcome::default() }
    }

    #[test]
    fn errors_are_those_of_means() {
        let mean = |runs: &[Outcome]| Mean::of("temperature", runs);
        assert_eq!(mean(&[]), None);
        assert_eq!(mean(&[run(2.0, 0.25)]), Some(Mean { mean: 2.0, error: Some(0.25) }));
        // s² = 8/2 of three values.
        let three = mean(&[run(1.0, 9.0), run(3.0, 9.0), run(5.0, 9.0), Outcome::default()]);
        assert_eq!(three, Some(Mean { mean: 3.0, error: Some((4.0_f64 / 3.0).sqrt()) }));
        assert_eq!(Mean::of("pressure", &[run(1.0, 1.0)]), None);
    }

    #[test]
    fn people_see_the_digits_that_mean_something() {
        let shown = |mean, error| Mean { mean, error }.shown();
        assert_eq!(shown(10.3537, Some(0.0168)), "10.354 ± 0.017");
        assert_eq!(shown(12345.6, Some(120.0)), "12346 ± 120");
        assert_eq!(shown(1.5e-14, Some(2e-15)), "1.500e-14 ± 2.0e-15");
        assert_eq!(shown(0.5, None), "0.50000");
        assert_eq!(shown(12.0, Some(0.0)), "12");
    }
}
