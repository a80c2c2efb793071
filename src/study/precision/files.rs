//! Files: what the study leaves in its folder.

use super::report::{PrecisionReport, SeriesRow};
use super::{PRECISIONS, RunPoint};
use crate::numbers::array::Each;
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use crate::study::{Report, Subject};

impl Report for PrecisionReport {
    const NAME: &'static str = "precision";
    type Row<'a> = SeriesRow;

    fn subject(&self) -> Option<&Subject> {
        Some(&self.subject)
    }

    fn rows(&self) -> Vec<SeriesRow> {
        self.series.clone()
    }

    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        let mut pictures = vec![("divergence", self.divergence_chart().into())];
        if !self.drifts.is_empty() {
            pictures.push(("drift", Picture { charts: self.drift_charts() }));
        }
        pictures
    }
}

impl PrecisionReport {
    fn divergence_chart(&self) -> Chart {
        let has_collisions = self.end.collisions_per_body > 0.0;
        let at =
            |point: RunPoint| if has_collisions { point.collisions_per_body } else { point.time };
        let mut series = Vec::new();
        for (k, divergence) in self.divergences.iter().enumerate() {
            let points = self.series.iter().filter_map(|row| {
                let SeriesRow { time, collisions_per_body, .. } = *row;
                let distance = [row.f32_distance, row.f64_distance][k]?;
                Some((at(RunPoint { time, collisions_per_body }), distance))
            });
            series.push(Series::new(PRECISIONS[k], points).color(k).mark(Mark::Line));
            if let Some(growth) = divergence.growth.filter(|growth| growth.power.is_none()) {
                let law = |c: f64| (c, (growth.intercept + growth.rate.value * c).exp());
                let name = format!("{}: e^({:.2} c)", PRECISIONS[k], growth.rate.value);
                let line = Series::new(name, growth.range.each(law));
                series.push(line.color(k).mark(Mark::Dashes));
            }
        }
        let ends = [0.0, at(self.end)].each(|x| (x, self.threshold.distance));
        series.push(Series::new("lost", ends).mark(Mark::Dashes));
        let x = if has_collisions { "collisions per body" } else { "time" };
        Chart {
            title: format!("{}: distance from double-double", self.subject.name),
            x: Axis::new(x, Scale::Linear),
            y: Axis::new("root mean square distance, length", Scale::Logarithmic),
            series,
        }
    }

    /// One for each precision: their drifts are nine orders of magnitude apart.
    fn drift_charts(&self) -> Vec<Chart> {
        let of = |precision: &&str| {
            let drifts = self.drifts.iter().filter(|drift| drift.precision == *precision);
            let series = drifts.enumerate().map(|(color, drift)| {
                let points = drift.points.iter().copied().filter(|point| point.1.is_finite());
                Series::new(format!("{}, {}", drift.invariant, drift.law), points).color(color)
            });
            Chart {
                title: format!("{}: drift in {precision}", self.subject.name),
                x: Axis::new("collisions", Scale::Logarithmic),
                y: Axis::new("relative error, root mean square", Scale::Logarithmic),
                series: series.collect(),
            }
        };
        PRECISIONS.iter().map(of).collect()
    }
}
