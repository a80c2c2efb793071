//! Display: a report as a person reads it.

use core::fmt;

use super::conclusions::{Found, Order, Theory};
use super::quantity::Quantity;
use super::report::WorkPrecisionReport;
use crate::engine::Execution;
use crate::numbers::array::Each;
use crate::scene::Precision;
use crate::study::fit::quantile;
use crate::study::table::{Table, counted, plain, seconds};

impl WorkPrecisionReport {
    /// Quantities that say something: without spins no body turns.
    fn shown(&self) -> Vec<Quantity> {
        let any = |quantity: &Quantity| {
            let mut moments = self.outcomes.iter().flat_map(|outcome| &outcome.moments);
            moments.any(|moment| moment.deviation.is_some_and(|d| quantity.of(&d) != 0.0))
        };
        Quantity::ALL.into_iter().filter(any).collect()
    }

    fn errors(&self) -> Table {
        let shown = self.shown();
        let mut table = Table::default();
        let heads = shown.iter().map(|quantity| match quantity {
            Quantity::AngularMomentum => "ang. mom.".to_owned(),
            quantity => quantity.to_string(),
        });
        table.row("", ["time", "±"].each(str::to_owned).into_iter().chain(heads));
        for family in self.families() {
            if family.stepping.is_some() {
                table.row(&family.to_string(), []);
            }
            let methods = self.sweep.methods.iter().zip(&self.outcomes);
            for (method, outcome) in methods.filter(|(method, _)| method.family() == family) {
                let (Some(moment), Some(timing)) =
                    (outcome.moments.get(self.judged), outcome.timings.first())
                else {
                    continue;
                };
                let label = match method.stepping {
                    None => family.to_string(),
                    Some(stepping) => format!("  Δt {:.3e}", stepping.dt),
                };
                let uncertain = match timing.is_uncertain() {
                    true => format!("{:.0} % !", timing.uncertainty() * 100.0),
                    false => format!("{:.0} %", timing.uncertainty() * 100.0),
                };
                let errors = shown.iter().map(|&quantity| match self.error(moment, quantity) {
                    Some(error) => size_of(error),
                    None if moment.deviation.is_none() => "not finite".to_owned(),
                    None => "lost".to_owned(),
                });
                let times = [seconds(timing.median), uncertain];
                table.row(&label, times.into_iter().chain(errors));
            }
        }
        table
    }

    fn orders_of_convergence(&self) -> Table {
        let mut table = Table::default();
        let shown = self.shown();
        // Those of momentum and angular momentum follow: the files have them.
        let first = &Quantity::ALL[..4];
        let shown: Vec<_> = self
            .orders
            .iter()
            .filter(|(quantity, _)| first.contains(quantity) && shown.contains(quantity))
            .collect();
        let heads = shown.iter().map(|(quantity, _)| quantity.to_string());
        table.row("", ["theory".to_owned()].into_iter().chain(heads));
        let families = self.families();
        for family in families.iter().filter(|family| family.stepping.is_some()) {
            let of = |orders: &[Order]| orders.iter().find(|o| o.family == *family).copied();
            let theory = shown.iter().find_map(|(_, orders)| of(orders)).map(|o| o.theory);
            let theory = match theory {
                Some(Theory::First) => "1",
                Some(Theory::Exact) => "exact",
                None => "",
            };
            let found = shown.iter().map(|(_, orders)| match of(orders).map(|order| order.found) {
                Some(Found::Power(power)) => format!("{:.2} ± {:.2}", power.value, power.error),
                Some(Found::Rounding(_)) => "rounding".to_owned(),
                Some(Found::Nothing) | None => "–".to_owned(),
            });
            table.row(&format!("  {family}"), [theory.to_owned()].into_iter().chain(found));
        }
        table
    }

    /// How many times as long the other executions take.
    fn executions(&self) -> Table {
        let mut table = Table::default();
        let columns: Vec<(bool, Precision)> = [(false, Precision::F32), (false, Precision::F64)]
            .into_iter()
            .chain([Precision::F32, Precision::F64, Precision::DoubleDouble].each(|p| (true, p)))
            .filter(|(stepped, precision)| {
                self.sweep.methods.iter().any(|method| {
                    method.stepping.is_some() == *stepped && method.precision == *precision
                })
            })
            .collect();
        let heads = columns.iter().map(|(stepped, precision)| {
            format!("{}, {precision}", if *stepped { "stepped" } else { "event-driven" })
        });
        table.row("", heads);
        for (k, Execution { lanes, threads, .. }) in
            self.sweep.executions.iter().enumerate().skip(1)
        {
            let ratio = |(stepped, precision): &(bool, Precision)| {
                let methods = self.sweep.methods.iter().zip(&self.outcomes);
                let ratios: Vec<f64> = methods
                    .filter(|(method, _)| {
                        method.stepping.is_some() == *stepped && method.precision == *precision
                    })
                    .filter_map(|(_, outcome)| {
                        Some(outcome.timings.get(k)?.ratio_to(outcome.timings.first()?).median)
                    })
                    .collect();
                format!("{:.2} ×", quantile(&ratios, 0.5))
            };
            let label = format!("  lanes {lanes}, {}", counted(*threads as u64, "thread"));
            table.row(&label, columns.iter().map(ratio));
        }
        table
    }

    /// Neighbouring bounds with the same method are one line.
    fn advice_lines(&self) -> Table {
        let mut table = Table::of_texts();
        let groups = self.advice.chunk_by(|(_, one), (_, other)| one.method == other.method);
        for group in groups {
            let Some((bound, result)) = group.last() else { continue };
            let label = match bound {
                0.0 => "  any".to_owned(),
                bound => format!("  down to {bound:.0e}"),
            };
            let found = format!("{}, error {}", seconds(result.seconds), size_of(result.error));
            table.row(&label, [result.method.to_string(), found]);
        }
        table
    }
}

/// The size of an error.
fn size_of(error: f64) -> String {
    if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") }
}

impl fmt::Display for WorkPrecisionReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moment = self.outcomes.first().and_then(|outcome| outcome.moments.get(self.judged));
        let collisions = moment.map_or(0.0, |moment| moment.true_collisions);
        writeln!(
            f,
            "{}: errors at time {}, {collisions:.1} collisions of a body, against double-double",
            self.subject.name,
            plain(self.time)
        )?;
        writeln!(f, "{}", self.machine)?;
        if let Some(Execution { lanes, threads, .. }) = self.sweep.executions.first() {
            let threads = counted(*threads as u64, "thread");
            let samples = counted(self.sweep.runs as u64, "sample");
            writeln!(
                f,
                "Times: medians of {samples} or more, lanes {lanes}, {threads}; ± is half"
            )?;
            writeln!(f, "their 95 % interval.")?;
        }
        if !self.limits.is_empty() {
            writeln!(f)?;
        }
        for limit in &self.limits {
            writeln!(f, "{limit}")?;
        }
        if !self.advice.is_empty() {
            let Self { quantity, norm, .. } = self;
            writeln!(f, "\nFor an error of {quantity} ({}) of, use", quantity.unit(*norm))?;
            write!(f, "{}", self.advice_lines())?;
        }
        writeln!(f, "\n{}", self.errors())?;
        writeln!(
            f,
            "Order of convergence, of all times up to there\n{}",
            self.orders_of_convergence()
        )?;
        if self.sweep.executions.len() > 1 {
            writeln!(f, "Time on other executions\n{}", self.executions())?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        Ok(())
    }
}
