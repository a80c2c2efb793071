//! Files: what the study leaves in its folder.

use super::report::PrecisionReport;
use super::{PRECISIONS, RunPoint};
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use crate::study::{Folder, StudyError};

impl PrecisionReport {
    /// Writes tables, pictures, the report and the scene into the folder.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, folder: &Folder) -> Result<(), StudyError> {
        folder.write_csv("precision.csv", &self.series)?;
        folder.write_json("precision.json", self)?;
        folder.write("report.txt", self.to_string().as_bytes())?;
        self.subject.write(folder)?;
        Picture { charts: vec![self.divergence_chart()] }.write(folder, "divergence")?;
        if !self.drifts.is_empty() {
            Picture { charts: self.drift_charts() }.write(folder, "drift")?;
        }
        Ok(())
    }

    fn divergence_chart(&self) -> Chart {
        let has_collisions = self.end.collisions_per_body > 0.0;
        let at =
            |point: RunPoint| if has_collisions { point.collisions_per_body } else { point.time };
        let mut series = Vec::new();
        for (k, divergence) in self.divergences.iter().enumerate() {
            let points = self.series.iter().filter_map(|row| {
                let RunPoint { time, collisions_per_body } =
                    RunPoint { time: row.time, collisions_per_body: row.collisions_per_body };
                let distance = [row.f32_distance, row.f64_distance][k]?;
                Some((at(RunPoint { time, collisions_per_body }), distance))
            });
            series.push(Series {
                name: PRECISIONS[k].to_owned(),
                color: Some(k),
                mark: Mark::Line,
                points: points.collect(),
                ..Series::default()
            });
            if let Some(growth) = divergence.growth.filter(|growth| growth.power.is_none()) {
                let law = |c: f64| (c, (growth.intercept + growth.rate.value * c).exp());
                series.push(Series {
                    name: format!("{}: e^({:.2} c)", PRECISIONS[k], growth.rate.value),
                    color: Some(k),
                    mark: Mark::Dashes,
                    points: growth.range.map(law).to_vec(),
                    ..Series::default()
                });
            }
        }
        let ends = [0.0, at(self.end)];
        series.push(Series {
            name: "lost".to_owned(),
            color: None,
            mark: Mark::Dashes,
            points: ends.map(|x| (x, self.threshold.distance)).to_vec(),
            ..Series::default()
        });
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
            let series = drifts.enumerate().map(|(color, drift)| Series {
                name: format!("{}, {}", drift.invariant, drift.law),
                color: Some(color),
                mark: Mark::LineAndMarkers,
                points: drift.points.iter().copied().filter(|point| point.1.is_finite()).collect(),
                ..Series::default()
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
