//! Time reversed: how much of the start comes back.

use super::case::{
    Case, Curve, Extent, Findings, Studied, Trial, at_points, in_epsilon, t3, trial,
};
use super::chart::{Axis, Chart, Picture, Scale, Series};
use super::{Figure, StudyError, gas};
use crate::contact::Surface;
use crate::engine::EventDriven;
use crate::numbers::array::Each;
use crate::scene::{Precision, Scene, Sphere, Spheres};
use crate::study::fit::{Line, mean, mean_square, power};
use crate::surroundings::{Cuboid, Plane};

pub(super) const CASE: Case = Case {
    name: "reversal",
    title: "to a time and back, with all velocities and spins reversed",
    law: "In a chaotic gas the error of the start that comes back is ε e^(λc), c collisions of each body \
          one way. Of f64, which has room for it, λ is about 0.8 (N = 500, density 0.5, an independent \
          program). It is the gas's own and not the precision's: from c = 3 to 10 both errors grow alike, \
          and the start comes back to 1 % of a diameter up to c = ln(0.01/ε)/λ, less a few. A \
          regular scene loses no more than a power of the collisions, n^(3/2), as speeds walk by √n ε.",
    trials,
    combine,
    picture: Some(("reversal", picture)),
};

fn trials(extent: Extent) -> Vec<Trial> {
    let mut trials = Vec::new();
    let bodies = extent.of(500, 256);
    for surface in [Surface::Smooth, Surface::Rough] {
        for seed in 0..extent.of(8, 6) {
            trials.extend([
                chaotic::<f32>(surface, bodies, seed),
                chaotic::<f64>(surface, bodies, seed),
            ]);
        }
    }
    let bounces = extent.of(1 << 20, 1 << 14);
    for surface in [Surface::Smooth, Surface::Rough] {
        trials.extend([regular::<f32>(surface, bounces), regular::<f64>(surface, bounces)]);
    }
    trials
}

/// A fluid, to ever greater numbers of collisions of each body and back.
fn chaotic<T: Studied>(surface: Surface, bodies: u64, seed: u64) -> Trial {
    let most = if T::PRECISION == Precision::F32 { 32 } else { 64 };
    let name = format!("{surface} gas");
    trial::<T, _>(format!("{name}, {seed}"), 2e-3 * bodies as f64, move || {
        let spin = if surface == Surface::Rough { 1.0 } else { 0.0 };
        let spheres = Spheres::fcc(bodies)
            .number_density(0.5)
            .radius(0.5)
            .temperature(1.0)
            .spin_temperature(spin)
            .seed(seed);
        let scene =
            Scene::<T>::builder().surface(surface).periodic_cube().spheres(spheres).build()?;
        // The lattice melts first.
        let mut world = EventDriven::new(scene.clone())?;
        world.advance_until(20 * bodies / 2, 1e9)?;
        let molten = Scene { bodies: world.bodies(), ..scene };
        let mut points = Vec::new();
        for c in (1..=10).chain((12..=most).step_by(2)) {
            points.push((c as f64, way_off(&molten, c * bodies / 2)?));
        }
        Ok(vec![Curve::new(T::PRECISION, name.clone(), points)])
    })
}

/// A ball in a box, whose three directions know nothing of each other; a rough one
/// only bounces between two planes.
fn regular<T: Studied>(surface: Surface, bounces: u64) -> Trial {
    let name = match surface {
        Surface::Smooth => "a ball in a box",
        _ => "a superball",
    };
    trial::<T, Findings>(name, 1.3e-6 * bounces as f64, move || {
        let ball = Sphere::new([1.0, 1.25, 0.75]).radius(0.5);
        let builder = Scene::<T>::builder()
            .surface(surface)
            .sphere(ball.velocity([0.6180339, 0.4142135, 1.0]));
        let scene = match surface {
            Surface::Smooth => builder.surroundings(Cuboid::container(t3([0.0; 3]), t3([3.0; 3]))),
            _ => builder
                .surroundings(Plane::new(t3([0.0; 3]), t3([0.0, 0.0, 1.0])))
                .surroundings(Plane::new(t3([0.0, 0.0, 3.0]), t3([0.0, 0.0, -1.0]))),
        };
        let scene = scene.build()?;
        let mut points = Vec::new();
        let mut n = 16;
        while n <= bounces {
            points.push((n as f64, way_off(&scene, n)?));
            n *= 4;
        }
        let growth = power(&points).map_or(f64::NAN, |order| order.value);
        let size = |&(n, off): &(f64, f64)| in_epsilon::<T>(off) / n.powf(1.5);
        let worst = super::case::greatest(points.iter().map(size));
        let figures = vec![
            Figure::at_most(T::PRECISION, format!("start off, {name}"), worst, 8.0, "n√n ε"),
            Figure::at_most(T::PRECISION, format!("grows as n to the, {name}"), growth, 1.6, ""),
        ];
        let curve = Curve::new(T::PRECISION, name.to_owned(), points);
        Ok(Findings { figures, curves: vec![curve] })
    })
}

/// How far off the start is, root mean square over the bodies, after a number of
/// collisions in all and as long back, length.
fn way_off<T: Studied>(scene: &Scene<T>, collisions: u64) -> Result<f64, StudyError> {
    let mut world = EventDriven::new(scene.clone())?;
    world.advance_until(collisions, 1e9)?;
    // Nothing happens just now.
    let time = world.time() * (1.0 + 1e-6);
    world.advance(time - world.time())?;
    let mut back = Scene::<T>::builder().surface(scene.surface).gravity(scene.gravity);
    if let Some(space) = scene.periodic {
        back = back.periodic(space);
    }
    for shape in &scene.surroundings {
        back = back.surroundings(shape.clone());
    }
    let mut bodies = world.bodies();
    bodies.scale_motion(-T::ONE);
    let mut world = EventDriven::new(back.bodies(bodies).build()?)?;
    world.advance(time)?;
    let distances = gas::distances(&world.bodies(), &scene.bodies, scene.periodic);
    Ok(mean_square(distances.into_iter()).sqrt())
}

/// The mean of the logarithms over all starts, and what it grows by.
fn combine(trials: Vec<Findings>) -> Findings {
    let found = Findings::joined(trials);
    let mut all = Findings { figures: Vec::new(), curves: Vec::new() };
    for surface in [Surface::Smooth, Surface::Rough] {
        let name = format!("{surface} gas");
        let curves = [Precision::F32, Precision::F64].each(|precision| {
            let is_one = |curve: &&Curve| curve.precision == precision && curve.name == name;
            let runs: Vec<&Curve> = found.curves.iter().filter(is_one).collect();
            let points = at_points(&runs, |errors| {
                mean(&errors.iter().map(|error| error.ln()).collect::<Vec<_>>()).exp()
            });
            Curve::new(precision, name.clone(), points)
        });
        all.figures.extend(judged(&name, &curves));
        all.curves.extend(curves);
    }
    all.figures.extend(found.figures);
    all.curves.extend(found.curves.into_iter().filter(|curve| !curve.name.ends_with("gas")));
    all
}

fn judged(name: &str, [single, double]: &[Curve; 2]) -> Vec<Figure> {
    // Where the error has found its direction, up to where it is no longer small.
    let long = rate(double, 6.0, |error| error < 1e-2);
    let rates = [single, double].each(|curve| {
        let early: Vec<_> = curve.points.iter().filter(|point| point.0 <= 10.0).copied().collect();
        rate(&Curve::new(curve.precision, String::new(), early), 3.0, |_| true)
    });
    let mut figures = vec![Figure::near(Precision::F64, format!("λ, {name}"), long, 0.8, 0.25, "")];
    for (curve, early) in [single, double].into_iter().zip(rates) {
        let is = curve.precision;
        let epsilon = is.epsilon();
        let mean = 0.5 * (rates[0] + rates[1]);
        // Up to where a hundredth of a diameter comes back.
        let end = curve.points.iter().take_while(|point| point.1 < 1e-2).last();
        let end = end.map_or(f64::NAN, |point| point.0) * long / (1e-2 / epsilon).ln();
        let law = "their mean ± 0.2";
        figures.push(
            Figure::near(is, format!("growth, c = 3 to 10, {name}"), early, mean, 0.2, "")
                .with_law(law),
        );
        figures.push(Figure::near(
            is,
            format!("c to 1 %, of ln(0.01/ε)/λ, {name}"),
            end,
            0.85,
            0.25,
            "",
        ));
    }
    figures
}

/// The rate by which the logarithm of an error grows from `c` on, where it is
/// wanted.
fn rate(curve: &Curve, c: f64, is_wanted: impl Fn(f64) -> bool) -> f64 {
    let wanted = curve.points.iter().filter(|point| point.0 >= c && is_wanted(point.1));
    let points: Vec<_> = wanted.map(|(c, off)| (*c, off.ln())).collect();
    Line::through(&points).map_or(f64::NAN, |line| line.slope.value)
}

/// The error against the collisions, of the gases and of the regular scenes.
fn picture(curves: &[Curve]) -> Picture {
    let chart = |title: &str, x: Axis, is_shown: &dyn Fn(&Curve) -> bool| {
        let shown = curves.iter().filter(|curve| is_shown(curve));
        let series = shown.enumerate().map(|(color, curve)| {
            let name = format!("{}, {}", curve.name, curve.precision);
            Series::new(name, curve.points.iter().copied()).color(color)
        });
        Chart {
            title: title.to_owned(),
            x,
            y: Axis::new("error of the start, diameters", Scale::Logarithmic),
            series: series.collect(),
        }
    };
    let gases = Axis::new("collisions of each body, one way", Scale::Linear);
    let others = Axis::new("collisions, one way", Scale::Logarithmic);
    Picture {
        charts: vec![
            chart("chaotic", gases, &|curve| curve.name.ends_with("gas")),
            chart("regular", others, &|curve| !curve.name.ends_with("gas")),
        ],
    }
}
