//! Report: what was measured, and what it amounts to.

use serde::Serialize;

use super::conclusions::{
    Found, Judged, Motion, Order, Theory, advice, orders, pareto_front, size,
};
use super::measure::{Moment, Outcome};
use super::method::Family;
use super::quantity::Quantity;
use super::reference::is_lost;
use super::sweep::Sweep;
use super::{Method, Scale, WorkPrecision};
use crate::study::{Machine, Subject};

/// What was measured of a scene's methods.
#[derive(Clone, Debug, Serialize)]
pub struct WorkPrecisionReport {
    /// On what.
    pub machine: Machine,
    /// Of what.
    pub subject: Subject,
    /// By what an error is judged.
    pub quantity: Quantity,
    /// The time that is judged.
    pub time: f64,
    /// What errors are small against.
    pub scale: Scale,
    /// What was compared.
    pub sweep: Sweep,
    /// What was measured of each of the sweep's methods.
    pub outcomes: Vec<Outcome>,
    /// The processors that other programs kept busy while this was measured, on the average;
    /// `None` where nothing was measured now, or the system does not say.
    pub others: Option<f64>,
    /// The orders of convergence, for each quantity.
    pub orders: Vec<(Quantity, Vec<Order>)>,
    /// The methods that no other one beats in both time and error.
    pub front: Vec<Judged>,
    /// For an error of so much: the fastest method.
    pub advice: Vec<(f64, Judged)>,
    /// What was cut short, and what is not to be trusted.
    pub limits: Vec<String>,
    /// What else there is to know about it.
    pub notes: Vec<String>,
    #[serde(skip)]
    pub(super) judged: usize,
}

/// Of a processor, so much is always busy with something.
const BUSY: f64 = 0.2;

impl WorkPrecisionReport {
    pub(super) fn new(study: &WorkPrecision, outcomes: Vec<Outcome>, others: Option<f64>) -> Self {
        let WorkPrecision { ref file, ref sweep, ref scale, motion, quantity } = *study;
        let mut report = Self {
            machine: Machine::here(),
            subject: Subject::of(file),
            quantity,
            time: 0.0,
            scale: scale.clone(),
            sweep: sweep.clone(),
            outcomes,
            others,
            orders: Vec::new(),
            front: Vec::new(),
            advice: Vec::new(),
            limits: sweep.notes.clone(),
            notes: Vec::new(),
            judged: sweep.times.len().saturating_sub(1),
        };
        // The last time at which anything can be said.
        while report.judged > 0 && report.results(report.judged, quantity).is_empty() {
            report.judged -= 1;
        }
        report.time = sweep.times.get(report.judged).copied().unwrap_or(0.0);
        report.orders = Quantity::ALL
            .into_iter()
            .map(|quantity| {
                let size = size(quantity, scale.length, scale.speed);
                let results = |time| report.results(time, quantity);
                let times: Vec<_> = (0..=report.judged).map(results).collect();
                (quantity, orders(&times, motion, quantity, size))
            })
            .collect();
        report.front = pareto_front(&report.results(report.judged, quantity));
        report.advice = advice(&report.front);
        report.take_notes(motion);
        report
    }

    fn take_notes(&mut self, motion: Motion) {
        let mut limits = Vec::new();
        let last = self.sweep.times.last().copied().unwrap_or(0.0);
        if let Some(lost) = self.scale.f32_lost {
            limits.push(format!(
                "Chaotic: event-driven f32 has lost the trajectories at time {lost:.3e}. Lost is \
                 what is off by a tenth of a radius; a number there would be noise."
            ));
            if self.subject.duration.is_some_and(|duration| last < duration) && last < lost {
                limits.push(format!(
                    "So methods are compared up to time {last:.3e}; --duration or --times take it \
                     further.",
                ));
            }
        }
        if self.judged + 1 < self.sweep.times.len() {
            limits.push(format!(
                "At time {last:.3e} every method has lost the trajectories: that is past what can \
                 be predicted. Judged is time {:.3e}.",
                self.time
            ));
        }
        if self.results(self.judged, self.quantity).is_empty() {
            limits.push(
                "Every trajectory is lost at every one of the times: only energy and averages \
                 are figures there. Give a shorter --duration."
                    .to_owned(),
            );
        }
        limits.extend(self.disturbances());
        self.limits.append(&mut limits);
        if !motion.has_collisions {
            self.notes.push("Nothing collides: the error is only the integrator's.".to_owned());
        }
        self.notes.append(&mut self.explanations());
        self.notes.push("All lanes and threads gave the same bits.".to_owned());
    }

    /// What times are not to be trusted, and why.
    fn disturbances(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(others) = self.others.filter(|others| *others > BUSY) {
            notes.push(format!(
                "The machine was busy: other programs used {others:.1} processors while times \
                 were measured."
            ));
        }
        let timings = || self.outcomes.iter().flat_map(|outcome| &outcome.timings);
        let uncertain = timings().filter(|timing| timing.is_uncertain()).count();
        if uncertain > 0 {
            notes.push(format!(
                "{uncertain} of {} times are uncertain by more than 10 % (!): measure them again, \
                 with --restart, on a quiet machine or with more --runs.",
                timings().count()
            ));
        }
        notes
    }

    /// Why orders of the position are not those of theory, where they are not.
    fn explanations(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let orders = self.orders.iter().filter(|(quantity, _)| *quantity == Quantity::Position);
        let orders: Vec<&Order> = orders.flat_map(|(_, orders)| orders).collect();
        let is_below = |order: &&Order| {
            let Found::Power(power) = order.found else { return false };
            order.theory == Theory::First
                && power.value < 0.75
                && power.value + 3.0 * power.error < 1.0
        };
        let mut deviations = self.outcomes.iter().flat_map(|outcome| {
            outcome.moments.get(self.judged).and_then(|moment| moment.deviation)
        });
        let few = deviations.any(|deviation| deviation.position_worst > 8.0 * deviation.position);
        if few && orders.iter().any(is_below) {
            notes.push(
                "An order below 1: the mean square is that of the few spheres that met another one \
                 than they should. Their number has order 1, so the root of the mean has order ½."
                    .to_owned(),
            );
        }
        let is_inexact = |order: &&Order| {
            order.theory == Theory::Exact && matches!(order.found, Found::Power(_))
        };
        if orders.iter().any(is_inexact) {
            notes.push(
                "An error where theory has none: in long steps a graze of something fixed can be \
                 missed, and impacts of three spheres can take effect out of order. Short steps \
                 have none of it."
                    .to_owned(),
            );
        }
        notes
    }

    /// Whether a trajectory is lost.
    pub(super) fn is_lost(&self, moment: &Moment) -> bool {
        let far = |deviation| is_lost(&deviation, self.scale.length);
        self.scale.f32_lost.is_some() && moment.deviation.is_some_and(far)
    }

    /// The error of a quantity; `None` where it is lost or not finite.
    pub(super) fn error(&self, moment: &Moment, quantity: Quantity) -> Option<f64> {
        let is_told = quantity == Quantity::Energy || !self.is_lost(moment);
        moment.deviation.filter(|_| is_told).map(|deviation| quantity.of(&deviation))
    }

    /// Wall times and errors of all methods that are not lost at one of
    /// the times.
    pub(super) fn results(&self, time: usize, quantity: Quantity) -> Vec<Judged> {
        let methods = self.sweep.methods.iter().zip(&self.outcomes);
        methods
            .filter_map(|(method, outcome)| {
                let error = self.error(outcome.moments.get(time)?, quantity)?;
                let timing = outcome.timings.first()?;
                let (seconds, interval) = (timing.median, timing.interval());
                Some(Judged { method: *method, seconds, interval, error })
            })
            .collect()
    }

    /// All families, in the order of the methods.
    pub(super) fn families(&self) -> Vec<Family> {
        let mut families = Vec::new();
        for family in self.sweep.methods.iter().map(Method::family) {
            if !families.contains(&family) {
                families.push(family);
            }
        }
        families
    }
}
