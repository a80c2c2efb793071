//! Conclusions: orders of convergence, and which method to use.

use serde::Serialize;

use super::method::{Family, Method};
use super::quantity::Quantity;
use crate::motion::Integrator;
use crate::scene::{Impact, Precision};
use crate::study::fit::{Estimate, common_power};

/// A method with its time and its error at the last of the times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Which one.
    pub method: Method,
    /// Median wall time, seconds.
    pub seconds: f64,
    /// The 95 % interval of that, as [`Timing::interval`](crate::study::clock::Timing::interval).
    pub interval: [f64; 2],
    /// How far it is off.
    pub error: f64,
}

/// How the error of a family depends on the length of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Order {
    /// Methods that differ in the length of a step only.
    pub family: Family,
    /// What theory says.
    pub theory: Theory,
    /// What was found.
    pub found: Found,
}

/// What theory says of the error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theory {
    /// It grows as the step.
    First,
    /// There is none but rounding, whatever the step.
    Exact,
}

/// What was found of the error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// It grows as this power of the step.
    Power(Estimate),
    /// It does not come of the step, or grows with the number of steps: so much
    /// at most.
    Rounding(f64),
    /// Too few errors are small, but greater than rounding. An order is a law of
    /// small errors: shorter steps or earlier times may show it.
    Nothing,
}

/// What moves the bodies, as far as it decides the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Motion {
    /// Whether velocities change in flight.
    pub(super) has_field: bool,
    /// Whether anything met.
    pub(super) has_collisions: bool,
}

impl Theory {
    /// Both Euler methods take the force of one end of a step for all of it, an
    /// error of first order; velocity Verlet is the exact parabola on a uniform
    /// field. An impact at the end of a step comes late by up to a step, and its
    /// normal is off by the overlap; an impact at its time is exact where the
    /// flight is. Neither takes energy.
    fn of(family: &Family, motion: Motion, quantity: Quantity) -> Self {
        let Some((integrator, impact)) = family.stepping else { return Self::Exact };
        // All integrators change velocities by aΔt, which is exact until a
        // collision comes at a wrong time.
        let flight = motion.has_field
            && integrator != Integrator::VelocityVerlet
            && (quantity != Quantity::Velocity || motion.has_collisions);
        let late =
            motion.has_collisions && impact == Impact::EndOfStep && quantity != Quantity::Energy;
        if flight || late { Self::First } else { Self::Exact }
    }
}

/// An error this many times as great as that of the exact times in the same
/// precision does not come of rounding.
const ABOVE_ROUNDING: f64 = 30.0;

/// An error above this part of its scale is not small.
const SMALL: f64 = 0.1;

/// The order of each family with steps, of the results at several times, judged
/// by a quantity whose error is small against `size`.
///
/// Times have factors of their own, and one order: the error of a time depends
/// on where in a step the last impacts happened to fall, and all together on it
/// less.
pub(super) fn orders(
    times: &[Vec<Judged>],
    motion: Motion,
    quantity: Quantity,
    size: f64,
) -> Vec<Order> {
    let mut families: Vec<Family> = Vec::new();
    for family in times.iter().flatten().map(|result| result.method.family()) {
        if family.stepping.is_some() && !families.contains(&family) {
            families.push(family);
        }
    }
    let order = |family: Family| {
        let exact = Family { stepping: None, ..family };
        let epsilon = family.precision.epsilon();
        let is_reference = family.precision == Precision::DoubleDouble;
        let (mut telling, mut worst) = (Vec::<Vec<(f64, f64)>>::new(), 0.0);
        let mut any_above = false;
        let theory = Theory::of(&family, motion, quantity);
        for results in times {
            let of = |wanted: Family| {
                results.iter().filter(move |result| result.method.family() == wanted)
            };
            // The reference is no method: what it would be off by is in proportion to others.
            let like_exact = results.iter().filter(|result| result.method.stepping.is_none());
            let like_exact = like_exact.filter_map(|result| {
                let Family { precision, .. } = result.method.family();
                let part = epsilon / precision.epsilon();
                (precision == exact.precision || is_reference).then_some(result.error * part)
            });
            let rounding = like_exact.fold(epsilon * size, f64::max);
            let is_above = |error: f64| error > ABOVE_ROUNDING * rounding;
            let mut points: Vec<(f64, f64)> = of(family)
                .filter_map(|result| result.method.stepping.map(|s| (s.dt, result.error)))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            worst = points.iter().map(|(_, error)| *error).fold(worst, f64::max);
            any_above |= points.iter().any(|(_, error)| is_above(*error));
            // Without gaps: to pick the small errors of long steps would pick the
            // lucky ones.
            let from_shortest = points.into_iter().skip_while(|(_, error)| !is_above(*error));
            telling.push(from_shortest.take_while(|(_, error)| *error < SMALL * size).collect());
        }
        let found = match telling.iter().map(Vec::len).sum() {
            _ if !any_above => Found::Rounding(worst),
            0..4_usize => Found::Nothing,
            _ => match common_power(&telling) {
                // Each step rounds.
                Some(power) if theory == Theory::Exact && power.value < 0.25 => {
                    Found::Rounding(worst)
                }
                Some(power) => Found::Power(power),
                None => Found::Nothing,
            },
        };
        Order { family, theory, found }
    };
    families.into_iter().map(order).collect()
}

/// The results that no other one beats in both time and error, from the fastest
/// to the most accurate (Pareto).
pub(super) fn pareto_front(results: &[Judged]) -> Vec<Judged> {
    let mut sorted = results.to_vec();
    sorted.sort_by(|a, b| a.seconds.total_cmp(&b.seconds).then(a.error.total_cmp(&b.error)));
    let mut front: Vec<Judged> = Vec::new();
    for result in sorted {
        if front.last().is_none_or(|best| result.error < best.error) {
            front.push(result);
        }
    }
    front
}

/// For each power of ten of the error, from the greatest down: the fastest
/// method that is no farther off.
pub(super) fn advice(front: &[Judged]) -> Vec<(f64, Judged)> {
    let errors = || front.iter().map(|result| result.error);
    let (least, greatest) = (errors().fold(f64::MAX, f64::min), errors().fold(0.0, f64::max));
    if greatest <= 0.0 || front.is_empty() {
        return front.first().map(|result| (0.0, *result)).into_iter().collect();
    }
    let from = greatest.log10().ceil() as i32;
    // An exact result is as good as any.
    let to = least.max(greatest * 1e-40).log10().ceil() as i32;
    (to..=from)
        .rev()
        .filter_map(|power| {
            let bound = 10.0_f64.powi(power);
            let fastest = front.iter().find(|result| result.error <= bound);
            fastest.map(|result| (bound, *result))
        })
        .collect()
}

/// The size that rounding errors are measured by, for a quantity.
pub(super) fn size(quantity: Quantity, length: f64, speed: f64) -> f64 {
    match quantity {
        Quantity::Position => length,
        Quantity::Velocity => speed,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::work_precision::method::Stepping;

    fn result(dt: Option<f64>, seconds: f64, error: f64) -> Judged {
        let stepping = dt.map(|dt| Stepping {
            integrator: Integrator::SemiImplicitEuler,
            impact: Impact::EndOfStep,
            dt,
        });
        let method = Method { precision: Precision::F64, stepping };
        Judged { method, seconds, interval: [seconds; 2], error }
    }

    #[test]
    fn an_order_is_found_above_the_rounding() {
        let motion = Motion { has_field: true, has_collisions: false };
        let mut results: Vec<Judged> = (1..8)
            .map(|k| 0.5_f64.powi(k))
            .map(|dt| result(Some(dt), 1.0 / dt, 0.3 * dt))
            .collect();
        results.push(result(None, 1.0, 1e-15));
        // One at the rounding does not spoil the fit.
        results.push(result(Some(1e-9), 1e9, 1e-15));
        let orders = orders(&[results], motion, Quantity::Position, 1.0);
        assert_eq!(orders.len(), 1);
        assert_eq!(orders[0].theory, Theory::First);
        let Found::Power(power) = orders[0].found else { panic!("{:?}", orders[0].found) };
        assert!((power.value - 1.0).abs() < 1e-12 && power.error < 1e-12);
    }

    #[test]
    fn what_does_not_depend_on_the_step_is_rounding() {
        let motion = Motion { has_field: false, has_collisions: false };
        let results: Vec<Judged> = (1..8)
            .map(|k| result(Some(0.5_f64.powi(k)), 1.0, f64::from(k) * 0.5_f64.powi(53)))
            .collect();
        let orders = orders(&[results], motion, Quantity::Position, 1.0);
        assert_eq!(
            (orders[0].theory, orders[0].found),
            (Theory::Exact, Found::Rounding(7.0 * 0.5_f64.powi(53)))
        );
    }

    #[test]
    fn the_front_leaves_out_what_is_beaten() {
        let (quick, beaten, good) =
            (result(Some(0.1), 1.0, 1e-2), result(Some(0.01), 4.0, 1e-3), result(None, 2.0, 1e-14));
        assert_eq!(pareto_front(&[beaten, good, quick]), [quick, good]);
        let advice = advice(&[quick, good]);
        assert_eq!(advice[0], (1e-2, quick));
        assert!(advice[1..].iter().all(|(_, result)| *result == good));
        assert_eq!(advice.len(), 13);
    }
}
