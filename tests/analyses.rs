//! Analyses of bodies against what is known of them.

use std::f64::consts::PI;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use carom::engine::{Execution, Lanes, Order, World};
use carom::observe::{Analysis, Figure, Findings, Images, Moment};
use carom::scene::{AnalysisKind, AnalysisSettings, SceneFile};
use carom::{Bodies, PeriodicBox};

/// A smooth fluid of spheres with σ = m = kT = 1 in a periodic box.
fn fluid(count: u64, density: f64) -> SceneFile {
    let text = format!(
        "periodic = \"cube\"\nseed = 7\n[[spheres]]\ncount = {count}\narrangement = \"fcc\"\n\
         number_density = {density:?}\nradius = 0.5\ntemperature = 1.0\n"
    );
    SceneFile::parse("fluid", &text).unwrap()
}

/// What analyses find in looks at a scene at equal times, after a time of equilibration,
/// and the compressibility factor and the collision rate by the engine's own count.
fn found(
    file: &SceneFile,
    execution: Execution,
    (before, every, looks): (f64, f64, u32),
    settings: &[AnalysisSettings],
) -> (Vec<Findings>, [f64; 2]) {
    let scene = file.build::<f64>().unwrap();
    let space = scene.periodic.unwrap();
    let mut world = World::new(scene, execution).unwrap();
    world.advance(before).unwrap();
    let (virial, pairs, start) = (world.virial(), world.collisions().pairs, world.time());
    let mut images = Images::new(space, &world.bodies());
    let mut analyses: Vec<Analysis> = Vec::new();
    for look in 0..=looks {
        if look > 0 {
            let hear = |event: &_| analyses.iter_mut().for_each(|it: &mut Analysis| it.hear(event));
            world.for_each_event(every, hear).unwrap();
        }
        let bodies = world.bodies();
        images.look(&bodies);
        let images = Some(images.counts());
        let moment = Moment { time: world.time(), bodies: &bodies, space: Some(space), images };
        if look == 0 {
            let begin = |settings| Analysis::new(settings, &moment).unwrap();
            analyses.extend(settings.iter().map(begin));
        }
        analyses.iter_mut().for_each(|analysis| analysis.look(&moment));
    }
    let (count, time) = (world.bodies().len() as f64, world.time() - start);
    let temperature = carom::Temperature::of(&world.bodies()).unwrap().translational;
    let factor = 1.0 - 1.0 / count + (world.virial() - virial) / (3.0 * count * temperature * time);
    let rate = 2.0 * (world.collisions().pairs - pairs) as f64 / (count * time);
    (analyses.iter().map(Analysis::findings).collect(), [factor, rate])
}

fn of(kind: AnalysisKind) -> AnalysisSettings {
    AnalysisSettings::of(kind)
}

/// A figure by its name, with its error.
#[track_caller]
fn figure(findings: &Findings, name: &str) -> (f64, f64) {
    let found: Option<&Figure> = findings.figures.iter().find(|figure| figure.name == name);
    let found = found.unwrap_or_else(|| panic!("no {name} in {:?}", findings.figures));
    (found.mean, found.error.unwrap_or(f64::NAN))
}

/// A column by its name.
#[track_caller]
fn column(findings: &Findings, name: &str) -> Vec<f64> {
    let found = findings.columns.iter().find(|(other, _)| *other == name).unwrap();
    found.1.iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// The mean square of how far values are from a law, in their errors.
fn off(values: &[f64], errors: &[f64], law: &[f64]) -> f64 {
    let squares: Vec<f64> = values
        .iter()
        .zip(errors)
        .zip(law)
        .filter(|((_, error), _)| **error > 0.0)
        .map(|((value, error), law)| ((value - law) / error).powi(2))
        .collect();
    assert!(squares.len() > values.len() / 2, "{} of {} have errors", squares.len(), values.len());
    squares.iter().sum::<f64>() / squares.len() as f64
}

/// Numbers from 0 to 1 without an order.
fn noise() -> impl FnMut() -> f64 {
    let mut state: u64 = 1;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What one look finds of bodies in a box of some cells of a lattice.
fn of_lattice(cell: [f64; 3], sites: &[[f64; 3]], cells: usize, kind: AnalysisKind) -> Findings {
    let mut places = Vec::new();
    for index in 0..cells.pow(3) {
        let corner = [index % cells, index / cells % cells, index / cells / cells];
        for site in sites {
            // Off the faces, where rounding would choose the side.
            places.push(core::array::from_fn(|k| (corner[k] as f64 + site[k] + 0.13) * cell[k]));
        }
    }
    let bodies = Bodies::from_positions(&places).radius(0.25).build().unwrap();
    let sides = cell.map(|side| side * cells as f64);
    let space = Some(PeriodicBox::new([0.0; 3], sides));
    let moment = Moment { time: 0.0, bodies: &bodies, space, images: None };
    let mut analysis = Analysis::new(&of(kind), &moment).unwrap();
    analysis.look(&moment);
    analysis.findings()
}

/// Steinhardt, Nelson and Ronchetti, Physical Review B 28, 784 (1983), table I.
#[test]
fn crystals_have_the_bond_order_of_tables() {
    let fcc = [[0.0; 3], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    let bcc = [[0.0; 3], [0.5; 3]];
    let third = 1.0 / 3.0;
    let hcp = [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.5 + third, 0.5], [0.0, third, 0.5]];
    let hexagonal = [1.0, 3.0_f64.sqrt(), (8.0_f64 / 3.0).sqrt()];
    for (name, cell, sites, neighbours, q4, q6) in [
        ("fcc", [1.5; 3], &fcc[..], 12.0, 0.19094, 0.57452),
        ("bcc", [1.2; 3], &bcc[..], 14.0, 0.03637, 0.51069),
        ("hcp", hexagonal, &hcp[..], 12.0, 0.09722, 0.48476),
    ] {
        let findings = of_lattice(cell, sites, 4, AnalysisKind::BondOrder);
        assert_eq!(figure(&findings, "neighbours").0, neighbours, "{name}");
        for (figures, expected) in [(["q4", "mean_q4"], q4), (["q6", "mean_q6"], q6)] {
            for figures in figures {
                assert_abs_diff_eq!(figure(&findings, figures).0, expected, epsilon = 1e-5);
            }
        }
        // All bodies are in one bin of a hundredth.
        let density = column(&findings, "density");
        assert_eq!(density.iter().filter(|density| **density > 0.0).count(), 1, "{name}");
    }
}

/// Distances of fcc: twelve neighbours, six √2 as far, twenty-four √3 as far.
#[test]
fn a_crystal_has_its_shells() {
    let side = 2.0_f64.sqrt();
    let sites = [[0.0; 3], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    let findings = of_lattice([side; 3], &sites, 4, AnalysisKind::RadialDistribution);
    let (r, g) = (column(&findings, "r"), column(&findings, "g"));
    let width = r[1] - r[0];
    let density = 4.0 / side.powi(3);
    for (distance, expected) in [(1.0, 12.0), (side, 6.0)] {
        let count: f64 = r
            .iter()
            .zip(&g)
            .filter(|(r, _)| (*r - distance).abs() < 2.0 * width)
            .map(|(r, g)| {
                let (near, far) = (r - 0.5 * width, r + 0.5 * width);
                g * density * 4.0 / 3.0 * PI * (far.powi(3) - near.powi(3))
            })
            .sum();
        assert_relative_eq!(count, expected, max_relative = 1e-9);
    }
}

/// Points without an order: `g = 1 − 1/N` and `S = 1`.
#[test]
fn an_ideal_gas_has_no_structure() {
    let mut noise = noise();
    let space = Some(PeriodicBox::new([-2.0, 1.0, 0.0], [6.0, 11.0, 9.0]));
    let sides = [8.0, 10.0, 9.0];
    let settings = [
        AnalysisSettings {
            range: Some([Some(0.0), Some(4.0)]),
            bins: Some(40),
            ..of(AnalysisKind::RadialDistribution)
        },
        AnalysisSettings {
            range: Some([None, Some(12.0)]),
            bins: Some(60),
            ..of(AnalysisKind::StructureFactor)
        },
    ];
    let mut analyses: Vec<Analysis> = Vec::new();
    for look in 0..256 {
        let place = |_| core::array::from_fn(|k| [-2.0, 1.0, 0.0][k] + sides[k] * noise());
        let places: Vec<[f64; 3]> = (0..400).map(place).collect();
        let bodies = Bodies::from_positions(&places).radius(0.1).build().unwrap();
        let moment = Moment { time: f64::from(look), bodies: &bodies, space, images: None };
        if look == 0 {
            analyses.extend(settings.iter().map(|it| Analysis::new(it, &moment).unwrap()));
        }
        analyses.iter_mut().for_each(|analysis| analysis.look(&moment));
    }
    let [radial, structure] = [0, 1].map(|k: usize| analyses[k].findings());
    let (g, errors) = (column(&radial, "g"), column(&radial, "error"));
    let far = off(&g, &errors, &[1.0 - 1.0 / 400.0; 40]);
    assert!(far < 2.0, "{far}");
    assert!(errors[39] < 0.01, "{}", errors[39]);
    let (factor, errors) = (column(&structure, "factor"), column(&structure, "error"));
    let far = off(&factor, &errors, &[1.0; 60]);
    assert!(factor.len() > 50 && far < 2.0, "{far} of {}", factor.len());
}

/// The structure factor of Percus and Yevick (Wertheim 1963) for hard spheres with σ = 1.
fn percus_yevick(k: f64, density: f64) -> f64 {
    let eta = PI / 6.0 * density;
    let fourth = (1.0 - eta).powi(4);
    let (a, b) =
        ((1.0 + 2.0 * eta).powi(2) / fourth, -6.0 * eta * (1.0 + 0.5 * eta).powi(2) / fourth);
    // −c(r) = a + b r + η a r³/2 within a diameter; its transform by Simpson's rule.
    let direct = |r: f64| -(a + b * r + 0.5 * eta * a * r.powi(3));
    let steps = 2000;
    let width = 1.0 / f64::from(steps);
    let sum: f64 = (0..=steps)
        .map(|step| {
            let r = f64::from(step) * width;
            let weight =
                if step == 0 || step == steps { 1.0 } else { 2.0 + 2.0 * f64::from(step % 2) };
            weight * direct(r) * r * (k * r).sin() / k
        })
        .sum();
    1.0 / (1.0 - density * 4.0 * PI * sum * width / 3.0)
}

#[test]
fn a_dilute_fluid_has_the_structure_of_percus_and_yevick() {
    let settings = [AnalysisSettings {
        range: Some([Some(1.0), Some(16.0)]),
        bins: Some(60),
        ..of(AnalysisKind::StructureFactor)
    }];
    let (findings, _) = found(&fluid(500, 0.1), Execution::default(), (10.0, 1.0, 256), &settings);
    let [k, factor, error] = ["k", "factor", "error"].map(|name| column(&findings[0], name));
    let law: Vec<f64> = k.iter().map(|k| percus_yevick(*k, 0.1)).collect();
    let far = off(&factor, &error, &law);
    assert!(far < 2.0, "{far}");
    // It is something else than a gas without structure.
    let ideal = off(&factor, &error, &vec![1.0; k.len()]);
    assert!(ideal > 20.0, "{ideal}");
}

/// Z = 1 + (2π/3) ρσ³ g(σ⁺), and the speeds of Maxwell.
#[test]
fn contacts_give_the_pressure_and_speeds_are_those_of_maxwell() {
    let radial = AnalysisSettings {
        range: Some([None, Some(1.5)]),
        bins: Some(50),
        ..of(AnalysisKind::RadialDistribution)
    };
    let settings = [radial, of(AnalysisKind::SpeedDistribution)];
    let (findings, [pressure, _]) =
        found(&fluid(500, 0.5), Execution::default(), (5.0, 0.25, 512), &settings);
    let (factor, error) = figure(&findings[0], "compressibility");
    assert!(error < 0.02 * factor, "{error}");
    assert!((factor - pressure).abs() < 3.0 * error, "{factor} ± {error}, {pressure}");
    let (contact, _) = figure(&findings[0], "contact");
    assert_relative_eq!(
        factor,
        1.0 - 1.0 / 500.0 + 2.0 / 3.0 * PI * 0.5 * contact,
        max_relative = 1e-12
    );
    let [density, error, maxwell] =
        ["density", "error", "maxwell"].map(|name| column(&findings[1], name));
    let far = off(&density, &error, &maxwell);
    assert!(far < 2.0, "{far}");
    let all: f64 = density.iter().sum::<f64>() * 0.05;
    assert_abs_diff_eq!(all, 1.0, epsilon = 1e-4);
    // Of 500 bodies with a fixed energy −2/(3N + 2) or so is the mean.
    let (sonine, error) = figure(&findings[1], "sonine");
    assert!((sonine + 2.0 / 1500.0).abs() < 4.0 * error && error < 4e-3, "{sonine} ± {error}");
}

/// What Enskog's theory says of flights, in bins of a width: each body of a speed has a
/// rate of its own, `Γ(v) ∝ ⟨|v − v'|⟩`, and collisions come at random. `mean` is the mean
/// free time, in units of σ = m = kT = 1.
fn enskog_flights(mean: f64, width: f64, bins: usize, of_paths: bool) -> Vec<f64> {
    let maxwell = |v: f64| (2.0 / PI).sqrt() * v * v * (-0.5 * v * v).exp();
    let (steps, most) = (1600, 8.0);
    let step = most / f64::from(steps);
    // The error function by the trapezoidal rule on the way.
    let (mut error, mut speeds) = (0.0, Vec::new());
    for k in 1..=steps {
        let v = step * f64::from(k);
        let ends = (-0.5 * v * v).exp() + (-0.5 * (v - step) * (v - step)).exp();
        error += (2.0 / PI).sqrt() * 0.5 * step * ends;
        let relative = (2.0 / PI).sqrt() * (-0.5 * v * v).exp() + (v + 1.0 / v) * error;
        speeds.push((v, maxwell(v) * step, relative));
    }
    let whole: f64 = speeds.iter().map(|(_, weight, rate)| weight * rate).sum();
    let density = |bin: usize| {
        let ends = [width * bin as f64, width * (bin + 1) as f64];
        let of_speed = |(v, weight, relative): &(f64, f64, f64)| {
            let rate = relative / whole / mean;
            let per = if of_paths { rate / v } else { rate };
            weight * relative / whole * ((-per * ends[0]).exp() - (-per * ends[1]).exp()) / width
        };
        speeds.iter().map(of_speed).sum()
    };
    (0..bins).map(density).collect()
}

/// Within what this number of flights tells: the theory leaves out that a body shields the one that
/// it has just met, which more flights would show.
#[test]
fn flights_are_those_of_enskog() {
    let settings = [AnalysisSettings { bins: Some(60), ..of(AnalysisKind::CollisionStatistics) }];
    let (findings, [_, rate]) =
        found(&fluid(500, 0.02), Execution::default(), (50.0, 20.0, 96), &settings);
    let (time, error) = figure(&findings[0], "mean_free_time");
    assert!((time * rate - 1.0).abs() < 3.0 * error * rate + 2e-3, "{time} ± {error}, {rate}");
    for (kind, of_paths) in [("time", false), ("path", true)] {
        let name = |rest: &str| format!("{kind}{rest}");
        let [middle, density, error, random] =
            ["", "_density", "_error", "_at_random"].map(|rest| column(&findings[0], &name(rest)));
        let law = enskog_flights(time, middle[1] - middle[0], 60, of_paths);
        let (far, at_random) = (off(&density, &error, &law), off(&density, &error, &random));
        assert!(far < 1.6, "{kind}: {far}");
        println!("{kind}: {far:.2}, at random {at_random:.2}");
        // Times are those of collisions at random too, as far as this number of flights tells.
        assert!(!of_paths || at_random > 2.0 * far, "{kind}: {at_random}");
    }
}

/// Bodies that meet nothing: ⟨r²⟩ = ⟨v²⟩t², and all of a velocity is left, through any
/// number of boxes.
#[test]
fn free_flight_keeps_its_velocity() {
    let file = fluid(108, 0.1).with_values(&["encounters=none"]).unwrap();
    let settings =
        [of(AnalysisKind::MeanSquaredDisplacement), of(AnalysisKind::VelocityAutocorrelation)];
    let (findings, _) = found(&file, Execution::default(), (0.0, 0.25, 300), &settings);
    let square = column(&findings[1], "correlation")[0];
    let times = column(&findings[0], "time");
    // Sixteen looks, then up to twice as many with each level.
    assert_eq!(times[..3], [0.25, 0.5, 0.75]);
    assert!(times[times.len() - 1] >= 30.0, "{times:?}");
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    for (time, found) in times.iter().zip(column(&findings[0], "displacement")) {
        assert_relative_eq!(found, square * time * time, max_relative = 1e-9);
    }
    assert!(column(&findings[1], "correlation").iter().all(|it| (it - square).abs() < 1e-12));
    let diffusion = column(&findings[1], "diffusion");
    assert_relative_eq!(diffusion[3], square * 0.75 / 3.0, max_relative = 1e-12);
}

#[test]
fn einstein_and_green_and_kubo_agree() {
    let settings = [AnalysisKind::MeanSquaredDisplacement, AnalysisKind::VelocityAutocorrelation]
        .map(|kind| AnalysisSettings { range: Some([None, Some(3.0)]), ..of(kind) });
    let (findings, _) = found(&fluid(500, 0.5), Execution::default(), (5.0, 0.03, 4000), &settings);
    let [einstein, kubo] = [0, 1].map(|k: usize| figure(&findings[k], "diffusion"));
    let apart = (einstein.0 - kubo.0).abs();
    assert!(apart < 3.0 * einstein.1.hypot(kubo.1), "{einstein:?} {kubo:?}");
    assert!(einstein.1 < 0.03 * einstein.0, "{einstein:?}");
    // Of 500 spheres some 0.235: many have 0.265, and 2.84 kT/6πηL less is in a box of 10.
    assert!((0.21..0.26).contains(&einstein.0), "{einstein:?}");
}

#[test]
fn lanes_and_threads_change_no_bit() {
    let file = fluid(256, 0.5);
    let settings = AnalysisKind::ALL.map(AnalysisSettings::of);
    let run = |execution| found(&file, execution, (0.5, 0.05, 40), &settings).0;
    let one = run(Execution::new().lanes(Lanes::Scalar).threads(1).order(Order::Strict));
    let other = run(Execution::new().lanes(Lanes::Sixteen).threads(3).order(Order::Windows));
    assert_eq!(one, other);
    assert_eq!(one.len(), 7);
}

#[test]
fn settings_that_do_not_fit_are_refused() {
    let places = [[1.0, 1.0, 1.0], [3.0, 1.0, 1.0]];
    let bodies = Bodies::from_positions(&places).radii(&[0.5, 0.25]).build().unwrap();
    let space = Some(PeriodicBox::new([0.0; 3], [4.0; 3]));
    let moment = Moment { time: 0.0, bodies: &bodies, space, images: None };
    let says = |settings: AnalysisSettings, moment: &Moment<'_>| {
        Analysis::new(&settings, moment).unwrap_err().to_string()
    };
    let radial = || of(AnalysisKind::RadialDistribution);
    let far = AnalysisSettings { range: Some([None, Some(3.0)]), ..radial() };
    assert_eq!(
        says(far, &moment),
        "range is to 3.0; it can go to half of the shortest side of the box, 2.0"
    );
    let none = AnalysisSettings { bins: Some(0), ..radial() };
    assert_eq!(says(none, &moment), "bins is 0; it is a number from 1 to 100000");
    let third = AnalysisSettings { species: Some(vec![1, 3]), ..radial() };
    assert_eq!(
        says(third, &moment),
        "species is [1, 3]; it is one or two of the species 1 to 2, as [1, 2]"
    );
    let backwards = AnalysisSettings { range: Some([Some(2.0), Some(1.0)]), ..radial() };
    assert!(says(backwards, &moment).starts_with("range is [2.0, 1.0]; "));
    let open = Moment { space: None, ..moment };
    for kind in
        [AnalysisKind::RadialDistribution, AnalysisKind::BondOrder, AnalysisKind::StructureFactor]
    {
        assert_eq!(
            says(of(kind), &open),
            "kind is in open space; it is of bodies in a periodic box"
        );
    }
    let between = AnalysisSettings { species: Some(vec![1, 2]), bins: Some(10), ..radial() };
    let mut analysis = Analysis::new(&between, &moment).unwrap();
    analysis.look(&moment);
    // At the distance of 2, half of the box, there is nothing yet.
    assert!(column(&analysis.findings(), "g").iter().all(|g| *g == 0.0));
}
