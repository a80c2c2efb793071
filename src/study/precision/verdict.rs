//! Verdict: what the figures say, in sentences.

use super::PRECISIONS;
use super::divergence::Divergence;
use super::drift::Law;
use super::report::{PrecisionReport, far, short};
use crate::numbers::array::Each;
use crate::scene::EngineKind;

/// From this number of standard errors on an average is another one: the errors of two
/// runs, from a few blocks each, which do not know them well.
const DIFFERENT: f64 = 6.0;

/// What of a conserved average may be lost, of the average.
const KEPT: f64 = 1e-3;

/// What the figures say.
pub(super) fn verdict(report: &PrecisionReport) -> Vec<String> {
    let mut said = Vec::new();
    if report.end.collisions_per_body == 0.0 {
        said.push(match report.engine {
            EngineKind::Stepped => {
                "No collision happened: the error is only the integrator's, the \
                                    same in all precisions, and rounding's, shown here."
                    .to_owned()
            }
            EngineKind::EventDriven => "No collision happened: paths are exact, and the error is \
                                        only rounding's, shown here."
                .to_owned(),
        });
    }
    said.push(trajectories(report));
    if let Some(lost) = report.reference_lost
        && lost.collisions_per_body < report.end.collisions_per_body
    {
        said.push(format!(
            "Reference: even the double-double is lost from about time {} ({} collisions per \
                 body) on.",
            short(lost.time),
            short(lost.collisions_per_body)
        ));
    }
    said.extend(averages(report));
    said.extend(invariants(report));
    said
}

fn trajectories(report: &PrecisionReport) -> String {
    let each = report.divergences.refs().each(|divergence| {
        let precision = divergence.precision;
        match divergence {
            Divergence { stopped: Some(_), .. } => format!("{precision} does not come to the end"),
            Divergence { lost: Some(point), .. } => format!(
                "{precision} up to t = {} ({} collisions per body)",
                short(point.time),
                short(point.collisions_per_body)
            ),
            Divergence { would_be_lost: Some(point), .. } => format!(
                "{precision} to the end, and up to about t = {} by its growth",
                far(point.time)
            ),
            _ => format!("{precision} to the end"),
        }
    });
    format!("Trajectories: {}.", each.join("; "))
}

fn averages(report: &PrecisionReport) -> Option<String> {
    if report.averages.is_empty() {
        return None;
    }
    let lost = [0, 1].each(|k| {
        let is_lost = report.averages.iter().filter(|average| {
            average.others[k].is_none_or(|other| match other.in_errors {
                Some(errors) => errors.abs() > DIFFERENT,
                None => other.difference.abs() > KEPT * average.truth.abs(),
            })
        });
        is_lost.map(|average| average.name).collect::<Vec<_>>()
    });
    Some(match (lost[0].as_slice(), lost[1].as_slice()) {
        ([], _) => "Averages: f32 suffices; nothing is lost that the length of the run does not \
                    hide."
            .to_owned(),
        (single, []) => {
            format!("Averages: f64 suffices; in f32 {} would be others.", single.join(", "))
        }
        (_, double) => format!("Averages: not even f64 keeps {}.", double.join(", ")),
    })
}

fn invariants(report: &PrecisionReport) -> Option<String> {
    let worst = PRECISIONS.each(|precision| {
        let drifts = report.drifts.iter().filter(|drift| drift.precision == precision);
        drifts.max_by(|a, b| a.at_end.total_cmp(&b.at_end))
    });
    let [Some(single), Some(double)] = worst else { return None };
    let linear: Vec<String> = report
        .drifts
        .iter()
        .filter(|drift| drift.law == Law::Linear)
        .map(|drift| format!("{} in {}", drift.invariant, drift.precision))
        .collect();
    let grows = match linear.as_slice() {
        [] => String::new(),
        linear => format!(" As n grows: {}; roundings have a preferred side.", linear.join(", ")),
    };
    Some(format!(
        "Invariants: f32 keeps them to {:.0e} ({}), f64 to {:.0e} ({}).{grows}",
        single.at_end, single.invariant, double.at_end, double.invariant
    ))
}
