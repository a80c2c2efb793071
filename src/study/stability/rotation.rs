//! Rotation in small steps: what becomes of an orientation.

use super::Figure;
use super::case::{Case, Curve, Extent, Findings, Random, Studied, Trial, greatest, trial};
use super::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use super::orientation::{
    from_matrix, nearest_orthonormal, normalised, product, quaternion, to_matrix,
};
use crate::mat3::Mat3;
use crate::motion::rotation::{orthonormalised, reference_rotation, turned};
use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::scene::Precision;
use crate::study::fit::power;
use crate::vec3::Vec3;

pub(super) const CASE: Case = Case {
    name: "rotation",
    title: "10⁷ steps of 0.01 rad, the worst of four spins",
    law: "Carom's step, with one Newton step M(3 − MᵗM)/2 in it, holds ‖MᵗM − 1‖ at the rounding of \
          its elements. Its angle walks by √n ε at most, and drifts by less than 0.001 ε a step. M ← R M \
          alone leaves orthonormality in proportion to the steps: 2.2–3.0·10⁻² (f32), 3.9–5.0·10⁻¹¹ \
          (f64) after 10⁶ of them by an independent program, that is 0.18 to 0.25 ε a step. Others to \
          compare with: the polar factor by faer's singular value decomposition, and a renormalised \
          quaternion.",
    trials,
    combine,
    picture: Some(("rotation", picture)),
};

/// Spins that turn at the same time.
const SPINS: usize = 4;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    Newton,
    Bare,
    Polar,
    Quaternion,
}

impl Method {
    const ALL: [Self; 4] = [Self::Newton, Self::Bare, Self::Polar, Self::Quaternion];

    fn name(self) -> &'static str {
        match self {
            Self::Newton => "carom",
            Self::Bare => "M ← R M alone",
            Self::Polar => "R M, polar factor",
            Self::Quaternion => "quaternion",
        }
    }
}

fn trials(extent: Extent) -> Vec<Trial> {
    let steps = extent.of(10_000_000, 100_000);
    let of = |method| [walk::<f32>(method, steps), walk::<f64>(method, steps)];
    let mut trials: Vec<Trial> =
        [Method::Newton, Method::Bare, Method::Quaternion].into_iter().flat_map(of).collect();
    // A singular value decomposition takes 3 µs.
    trials
        .extend((0..SPINS).flat_map(|spin| [polar::<f32>(spin, steps), polar::<f64>(spin, steps)]));
    trials
}

fn walk<T: Studied>(method: Method, steps: i32) -> Trial {
    let seconds = 1e-7 * f64::from(steps);
    trial::<T, _>(method.name(), seconds, move || {
        let runs: Vec<_> = (0..SPINS).map(|k| start::<T>(k)).collect();
        let dt = T::ratio(1, 100);
        let curves = match method {
            Method::Quaternion => {
                let rotations: Vec<_> =
                    runs.iter().map(|(_, spin)| quaternion(*spin, dt)).collect();
                let mut now: Vec<_> = runs.iter().map(|(m, _)| from_matrix(*m)).collect();
                // The start is what the first quaternion says.
                let runs: Vec<_> =
                    runs.iter().zip(&now).map(|(run, q)| (to_matrix(*q), run.1)).collect();
                errors(method, steps, &runs, |k| {
                    now[k] = normalised(product(rotations[k], now[k]));
                    to_matrix(now[k])
                })
            }
            Method::Newton => {
                let mut now: Vec<_> = runs.iter().map(|run| run.0).collect();
                errors(method, steps, &runs, |k| {
                    now[k] = turned(now[k], runs[k].1, dt);
                    now[k]
                })
            }
            _ => {
                let rotations: Vec<_> =
                    runs.iter().map(|run| turned(Mat3::IDENTITY, run.1, dt)).collect();
                let mut now: Vec<_> = runs.iter().map(|run| run.0).collect();
                errors(method, steps, &runs, |k| {
                    now[k] = rotations[k] * now[k];
                    now[k]
                })
            }
        };
        Ok(curves)
    })
}

fn polar<T: Studied>(k: usize, steps: i32) -> Trial {
    let name = Method::Polar.name();
    trial::<T, _>(format!("{name}, spin {k}"), 3.2e-6 * f64::from(steps), move || {
        let run = start::<T>(k);
        let rotation = turned(Mat3::IDENTITY, run.1, T::ratio(1, 100));
        let mut now = run.0;
        let curves = errors(Method::Polar, steps, &[run], |_| {
            now = nearest_orthonormal(rotation * now);
            now
        });
        Ok(curves)
    })
}

/// An orientation and a spin of one radian per time, at random.
fn start<T: Studied>(k: usize) -> (Mat3<T>, Vec3<T>) {
    let mut random = Random(100 + k as u64);
    let m = reference_rotation(random.direction().cast(), T::whole(3));
    let spin: Vec3<T> = random.direction().cast();
    (orthonormalised(m), spin * (T::ONE / spin.length()))
}

/// Steps all of them, and looks at numbers of steps 1, 2, 5, 10, …: the worst
/// `‖MᵗM − 1‖` and the worst angle off, rad.
fn errors<T: Studied>(
    method: Method,
    steps: i32,
    runs: &[(Mat3<T>, Vec3<T>)],
    mut step: impl FnMut(usize) -> Mat3<T>,
) -> Vec<Curve> {
    let mut skewness = Vec::new();
    let mut angle = Vec::new();
    let (mut next, mut decade) = (1, 1);
    for n in 1..=steps {
        let is_looked_at = n == next;
        let mut worst = [0.0, 0.0];
        for (k, &(m, spin)) in runs.iter().enumerate() {
            let found = step(k);
            if is_looked_at {
                let errors = errors_after(found, n, (m, spin));
                worst = array::from_fn(|k| greatest([worst[k], errors[k]]));
            }
        }
        if is_looked_at {
            skewness.push((f64::from(n), worst[0]));
            angle.push((f64::from(n), worst[1]));
            next = match n / decade {
                1 => 2 * decade,
                2 => 5 * decade,
                _ => {
                    decade *= 10;
                    decade
                }
            };
        }
    }
    [("skewness", skewness), ("angle", angle)]
        .each(|(what, points)| {
            let name = format!("{what}, {}", method.name());
            Curve::new(T::PRECISION, name, points)
        })
        .into()
}

/// What has come of an orientation and a spin after this many steps: `‖MᵗM − 1‖` and
/// the angle off.
fn errors_after<T: Studied>(found: Mat3<T>, steps: i32, (m, spin): (Mat3<T>, Vec3<T>)) -> [f64; 2] {
    let found = exact_matrix(found);
    let time = T::ratio(1, 100).cast::<T::Judge>() * T::Judge::whole(steps);
    let expected = reference_rotation(spin.cast(), time) * exact_matrix(m);
    [distance(found.transpose() * found), angle_between(found, expected)]
}

fn exact_matrix<T: Studied>(m: Mat3<T>) -> Mat3<T::Judge> {
    Mat3 { columns: m.columns.each(Vec3::cast) }
}

/// Greatest element of the difference from the identity.
fn distance<T: Real>(m: Mat3<T>) -> f64 {
    greatest((m - Mat3::IDENTITY).rows().each(|element| element.abs().to_f64()))
}

/// Angle of the rotation between two orientations, where it is small: the
/// turning part of what takes one to the other.
fn angle_between<T: Real>(a: Mat3<T>, b: Mat3<T>) -> f64 {
    let [x, y, z] = (a * b.transpose()).columns;
    let twice = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
    (twice.length() * T::ratio(1, 2)).to_f64()
}

/// The worst of all spins, judged.
fn combine(trials: Vec<Findings>) -> Findings {
    let found = Findings::joined(trials);
    let mut all = Findings { figures: found.figures, curves: Vec::new() };
    for precision in [Precision::F32, Precision::F64] {
        for method in Method::ALL {
            let [skewness, angle] = ["skewness", "angle"].each(|what| {
                let name = format!("{what}, {}", method.name());
                let is_one = |curve: &&Curve| curve.precision == precision && curve.name == name;
                worst(precision, &name, found.curves.iter().filter(is_one))
            });
            all.figures.extend(judged(precision, method, &skewness, &angle));
            all.curves.extend([skewness, angle]);
        }
    }
    all
}

fn worst<'a>(precision: Precision, name: &str, curves: impl Iterator<Item = &'a Curve>) -> Curve {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for curve in curves {
        for (k, &(n, value)) in curve.points.iter().enumerate() {
            match points.get_mut(k) {
                Some(point) => point.1 = greatest([point.1, value]),
                None => points.push((n, value)),
            }
        }
    }
    Curve::new(precision, name.to_owned(), points)
}

fn judged(precision: Precision, method: Method, skewness: &Curve, angle: &Curve) -> Vec<Figure> {
    let epsilon = precision.epsilon();
    let name = |what: &str| format!("{what}, {}", method.name());
    let (steps, last) = angle.points.last().copied().unwrap_or((1.0, f64::NAN));
    let most = greatest(skewness.points.iter().map(|point| point.1)) / epsilon;
    match method {
        Method::Newton => vec![
            Figure::at_most(precision, name("‖MᵗM − 1‖"), most, 2.0, "ε"),
            Figure::at_most(
                precision,
                name("angle off"),
                last / epsilon / steps.sqrt(),
                1.0,
                "√n ε",
            ),
            Figure::at_most(
                precision,
                name("angle off per step"),
                last / epsilon / steps,
                1e-3,
                "ε",
            ),
        ],
        Method::Bare => {
            // Above the rounding of the start, and far below 1.
            let is_small = |point: &&(f64, f64)| (1e2..=1e6).contains(&point.0);
            let small: Vec<_> = skewness.points.iter().filter(is_small).copied().collect();
            let grown = power(&small).map_or(f64::NAN, |order| order.value);
            vec![
                Figure::near(precision, name("‖MᵗM − 1‖ grows as n to the"), grown, 1.0, 0.1, ""),
                Figure::at_most(precision, name("‖MᵗM − 1‖ per step"), most / steps, 0.25, "ε")
                    .compared(),
                Figure::at_most(precision, name("angle off"), last, 0.0, "rad").compared(),
            ]
        }
        _ => vec![
            Figure::at_most(precision, name("‖MᵗM − 1‖"), most, 2.0, "ε").compared(),
            Figure::at_most(precision, name("angle off"), last, 0.0, "rad").compared(),
        ],
    }
}

/// Orthonormality and angle against the number of steps.
fn picture(curves: &[Curve]) -> Picture {
    let chart = |what: &str, label: &str| {
        let of_kind = curves.iter().filter(|curve| curve.name.starts_with(what));
        let series = of_kind.map(|curve| {
            let method = curve.name.trim_start_matches(what).trim_start_matches(", ");
            let mark = if curve.precision == Precision::F32 { Mark::Line } else { Mark::Dashes };
            let name = format!("{method}, {}", curve.precision);
            let line = Series::new(name, curve.points.iter().copied()).mark(mark);
            Series { color: Method::ALL.iter().position(|one| one.name() == method), ..line }
        });
        Chart {
            title: label.to_owned(),
            x: Axis::new("steps of 0.01 rad", Scale::Logarithmic),
            y: Axis::new(label, Scale::Logarithmic),
            series: series.collect(),
        }
    };
    Picture {
        charts: vec![chart("skewness", "‖MᵗM − 1‖"), chart("angle", "angle off, rad")]
    }
}
