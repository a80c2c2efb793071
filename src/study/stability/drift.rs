//! The energy of a fluid over 10⁸ collisions: does it walk, or drift?

use core::iter;

use super::case::{Case, Curve, Extent, Findings, Studied, Trial, at_points, in_epsilon, trial};
use super::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use super::{Figure, StudyError};
use crate::contact::Surface;
use crate::engine::EventDriven;
use crate::scene::{Precision, Scene, Spheres};
use crate::study::fit::{Estimate, jackknife, mean, mean_square, power};
use crate::study::invariants::energy_change;

pub(super) const CASE: Case = Case {
    name: "energy",
    title: "the energy of 256 spheres, density 0.5, over 16 runs of 6.25·10⁶ collisions each",
    law: "Roundings without a preferred side let the energy walk: the error of 16 runs grows as √n \
          (Brouwer 1937), to within three standard errors and 0.05; one with a side lets it drift, \
          by 0.015 to 0.07 ε of a particle's energy at each of its collisions in carom's first \
          formulas. Now: less than 0.001 ε, beyond three standard errors.",
    trials,
    combine,
    picture: Some(("energy-drift", picture)),
};

/// Runs of each kind of fluid: one run cannot separate √n from n.
const RUNS: u64 = 16;

/// Spheres in each: few, so that the error is soon above the last digit.
const BODIES: u64 = 256;

const DENSITY: f64 = 0.5;

/// Collisions in a run up to the first point.
const FIRST: u64 = 1 << 10;

/// Collisions of a body in which the lattice melts.
const MELTING: u64 = 50;

/// Mean change of a particle's energy in each of its collisions, ε.
const DRIFT: f64 = 1e-3;

/// A kind of fluid.
#[derive(Clone, Copy)]
struct Fluid {
    surface: Surface,
    diameter: f64,
}

/// At a power of two, and elsewhere: see `contact/impulse.rs`.
const FLUIDS: [Fluid; 4] = [
    Fluid { surface: Surface::Smooth, diameter: 1.0 },
    Fluid { surface: Surface::Rough, diameter: 1.0 },
    Fluid { surface: Surface::Smooth, diameter: 1.37 },
    Fluid { surface: Surface::Rough, diameter: 1.37 },
];

impl Fluid {
    fn name(self) -> String {
        format!("{}, diameter {}", self.surface, self.diameter)
    }

    fn scene<T: Studied>(self, seed: u64) -> Result<Scene<T>, StudyError> {
        let spin = if self.surface == Surface::Rough { 1.0 } else { 0.0 };
        let spheres = Spheres::fcc(BODIES)
            .number_density(DENSITY / self.diameter.powi(3))
            .radius(self.diameter / 2.0)
            .temperature(1.0)
            .spin_temperature(spin)
            .seed(seed);
        let scene = Scene::builder().surface(self.surface).periodic_cube().spheres(spheres);
        Ok(scene.build()?)
    }
}

fn trials(extent: Extent) -> Vec<Trial> {
    let collisions = extent.of(6_250_000, 62_500);
    let runs = FLUIDS.into_iter().flat_map(|fluid| (0..RUNS).map(move |seed| (fluid, seed)));
    runs.flat_map(|(fluid, seed)| {
        [run::<f32>(fluid, seed, collisions), run::<f64>(fluid, seed, collisions)]
    })
    .collect()
}

/// The change of the energy in one run, in ε of the energy, after numbers of
/// collisions, each twice the one before.
fn run<T: Studied>(fluid: Fluid, seed: u64, collisions: u64) -> Trial {
    trial::<T, _>(format!("{}, run {seed}", fluid.name()), 6e-7 * collisions as f64, move || {
        let mut world = EventDriven::new(fluid.scene::<T>(seed)?)?;
        world.advance_until(MELTING * BODIES / 2, 1e9)?;
        let (start, molten) = (world.bodies(), world.collisions().total());
        let mut points: Vec<u64> = iter::successors(Some(collisions), |n| Some(n / 2))
            .take_while(|&n| n >= FIRST)
            .collect();
        points.reverse();
        let mut changes = Vec::new();
        for n in points {
            world.advance_until(molten + n - world.collisions().total(), 1e9)?;
            let change = in_epsilon::<T>(energy_change(&world.bodies(), &start));
            changes.push((n as f64, change));
        }
        Ok(vec![Curve::new(T::PRECISION, fluid.name(), changes)])
    })
}

/// What all runs of each kind of fluid say together, and their error.
fn combine(runs: Vec<Findings>) -> Findings {
    let runs = Findings::joined(runs);
    let mut all = Findings { figures: runs.figures, curves: Vec::new() };
    for fluid in FLUIDS {
        for precision in [Precision::F32, Precision::F64] {
            let is_one = |run: &&Curve| run.precision == precision && run.name == fluid.name();
            let found: Vec<&Curve> = runs.curves.iter().filter(is_one).collect();
            all.figures.extend(figures(precision, &fluid.name(), &found));
            let points = at_points(&found, |changes| mean_square(changes.iter().copied()).sqrt());
            all.curves.push(Curve::new(precision, fluid.name(), points));
        }
    }
    all
}

fn figures(precision: Precision, name: &str, runs: &[&Curve]) -> Vec<Figure> {
    let errors =
        |runs: &[&Curve]| at_points(runs, |changes| mean_square(changes.iter().copied()).sqrt());
    let spreads = |runs: &[&Curve]| {
        at_points(runs, |changes| {
            let mean = mean(changes);
            mean_square(changes.iter().map(|change| change - mean)).sqrt()
        })
    };
    let exponent = |points: Vec<(f64, f64)>| power(&points).map_or(f64::NAN, |order| order.value);
    let estimate = |figure: &dyn Fn(&[&Curve]) -> f64| {
        jackknife(runs, |runs| figure(&runs.iter().map(|run| **run).collect::<Vec<_>>()))
    };
    let order = estimate(&|runs| exponent(errors(runs)));
    let spread = estimate(&|runs| exponent(spreads(runs)));
    let drift = estimate(&|runs| {
        let means = at_points(runs, mean);
        means.last().map_or(f64::NAN, |(n, change)| change * BODIES as f64 / (2.0 * n))
    });
    let half = |what: &str, order: Estimate| {
        let name = format!("{what}, {name}");
        Figure::near(precision, name, order.value, 0.5, 0.05 + 3.0 * order.error, "")
            .with_law("½ ± (3σ + 0.05)")
    };
    let (n, end) = errors(runs).last().copied().unwrap_or((1.0, f64::NAN));
    let share = end * BODIES as f64 / n.sqrt();
    vec![
        Figure::at_most(precision, format!("at the end, {name}"), share, 8.0, "√n ε"),
        half("exponent", order),
        half("of the spread", spread),
        Figure::at_most(
            precision,
            format!("drift, {name}"),
            drift.value,
            DRIFT + 3.0 * drift.error,
            "ε",
        )
        .with_law("≤ 0.001 ε + 3σ"),
    ]
}

/// A chart for each diameter, in units of the precision's ε, with the two laws
/// that are to be kept apart.
fn picture(curves: &[Curve]) -> Picture {
    let starts = curves.iter().filter_map(|curve| curve.points.first());
    let starts: Vec<(f64, f64)> = starts.copied().collect();
    let (first, start) = (
        starts.first().map_or(1.0, |point| point.0),
        mean(&starts.iter().map(|point| point.1).collect::<Vec<_>>()),
    );
    let last =
        curves.iter().flat_map(|curve| &curve.points).fold(first, |last, point| last.max(point.0));
    let law = |name: &str, power: f64| {
        // The steeper law leaves the chart soon.
        let end = last.min(first * 200.0_f64.powf(1.0 / power));
        let at = |n: f64| (n, start * (n / first).powf(power));
        let mark = if power < 1.0 { Mark::Dashes } else { Mark::Line };
        Series::new(name, [at(first), at(end)]).mark(mark)
    };
    let chart = |diameter: &str| {
        let mut series = vec![law("√n", 0.5), law("n", 1.0)];
        for curve in curves.iter().filter(|curve| curve.name.ends_with(diameter)) {
            let is_rough = curve.name.starts_with("rough");
            let color = match (curve.precision, is_rough) {
                (Precision::F32, false) => 4,
                (Precision::F32, true) => 1,
                (_, false) => 5,
                (_, true) => 0,
            };
            let surface = if is_rough { Surface::Rough } else { Surface::Smooth };
            let name = format!("{}, {surface}", curve.precision);
            let line = Series::new(name, curve.points.iter().copied());
            series.push(line.color(color).mark(Mark::Line));
        }
        Chart {
            title: diameter.to_owned(),
            x: Axis::new("collisions", Scale::Logarithmic),
            y: Axis::new("error of the energy, ε", Scale::Logarithmic),
            series,
        }
    };
    Picture { charts: vec![chart("diameter 1"), chart("diameter 1.37")] }
}
