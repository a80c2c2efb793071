//! The files of the report: tables and pictures.

use serde::Serialize;

use super::{Measurement, ScalingReport};
use crate::scene::EngineKind;
use crate::study::chart::{Axis, Chart, Mark, Picture, Scale, Series};
use crate::study::table::counted;
use crate::study::{Report, StudyError, Subject};

/// A row of `scaling.csv`.
#[derive(Debug, Serialize)]
pub struct Line<'a> {
    precision: &'a str,
    bodies: u64,
    threads: usize,
    lanes: &'a str,
    runs: usize,
    work_per_run: u64,
    nanoseconds: f64,
    lower_quartile: f64,
    upper_quartile: f64,
    bytes_per_body: f64,
    peak_resident_bytes: Option<u64>,
    set_up_seconds: Option<f64>,
    state_hash: &'a str,
}

impl Report for ScalingReport {
    const NAME: &'static str = "scaling";
    type Row<'a> = Line<'a>;

    fn subject(&self) -> Option<&Subject> {
        Some(&self.subject)
    }

    fn rows(&self) -> Vec<Line<'_>> {
        self.points.iter().flatten().map(|row| self.line(row)).collect()
    }

    /// The pictures `time`, `memory` and, where lanes were compared, `lanes`.
    fn pictures(&self) -> Vec<(&'static str, Picture)> {
        let mut pictures =
            vec![("time", self.time_chart().into()), ("memory", self.memory_chart().into())];
        if self.settings.lanes.len() > 1 {
            pictures.push(("lanes", self.lanes_chart().into()));
        }
        pictures
    }

    /// All variants have to end in the same bits.
    fn verdict(&self) -> Result<(), StudyError> {
        match &self.differing[..] {
            [] => Ok(()),
            differing => Err(StudyError::DifferentBits(differing.join("; "))),
        }
    }
}

impl ScalingReport {
    fn line<'a>(&self, row: &'a Measurement) -> Line<'a> {
        let time = self.nanoseconds(row);
        Line {
            precision: &row.precision,
            bodies: row.bodies,
            threads: row.threads,
            lanes: &row.lanes,
            runs: row.timing.runs.len(),
            work_per_run: row.work,
            nanoseconds: time.median,
            lower_quartile: time.lower_quartile,
            upper_quartile: time.upper_quartile,
            bytes_per_body: row.bytes as f64 / row.bodies as f64,
            peak_resident_bytes: row.peak_resident,
            set_up_seconds: row.set_up,
            state_hash: &row.state_hash,
        }
    }

    fn time_axis(&self, scale: Scale) -> Axis {
        match self.engine {
            EngineKind::Stepped => Axis::new("time / ns per body and step", scale),
            EngineKind::EventDriven => Axis::new("time / ns per collision", scale),
        }
    }

    /// Time against size, by precision and threads.
    fn time_chart(&self) -> Chart {
        let mut series = Vec::new();
        for &precision in &self.settings.precisions {
            for &threads in &self.settings.threads {
                let name = precision.name();
                let rows = self.sweep(name, threads);
                let points = rows.map(|row| (row.bodies as f64, self.nanoseconds(row).median));
                let label = format!("{name}, {}", counted(threads as u64, "thread"));
                series.push(Series::new(label, points).color(series.len()));
            }
        }
        Chart {
            title: format!("{}: time", self.subject.name),
            x: Axis::new("bodies", Scale::Logarithmic),
            y: self.time_axis(Scale::Logarithmic),
            series,
        }
    }

    /// Memory against size: what the engine holds, and the peak of the process.
    fn memory_chart(&self) -> Chart {
        let mut series: Vec<Series> = Vec::new();
        for (color, &precision) in self.settings.precisions.iter().enumerate() {
            let name = precision.name();
            let rows: Vec<&Measurement> = self.sweep(name, self.settings.threads[0]).collect();
            let per_body = |row: &Measurement, bytes: u64| {
                (row.bodies as f64, bytes as f64 / row.bodies as f64)
            };
            let peaks = rows.iter().filter_map(|row| Some(per_body(row, row.peak_resident?)));
            let held = rows.iter().map(|row| per_body(row, row.bytes));
            let held = Series::new(format!("{name}, held by the engine"), held);
            let peaks = Series::new(format!("{name}, peak of the process"), peaks);
            series.extend([held.color(color), peaks.color(color).mark(Mark::Dashes)]);
        }
        series.retain(|series| !series.points.is_empty());
        Chart {
            title: format!("{}: memory", self.subject.name),
            x: Axis::new("bodies", Scale::Logarithmic),
            y: Axis::new("bytes per body", Scale::Logarithmic),
            series,
        }
    }

    /// Time against lanes at the size where they were compared, and with the
    /// widths that the engine chooses itself.
    fn lanes_chart(&self) -> Chart {
        let threads = self.settings.threads[0];
        let (mut series, mut ticks) = (Vec::new(), Vec::new());
        for (color, &precision) in self.settings.precisions.iter().enumerate() {
            let name = precision.name();
            let Some(rows) = self.points.iter().find(|rows| {
                rows.iter()
                    .any(|row| row.precision == name && row.lanes != self.settings.lanes[0].name())
            }) else {
                continue;
            };
            let of_one_thread = rows.iter().filter(|row| row.threads == threads);
            let mut widths: Vec<(f64, f64)> = Vec::new();
            let mut auto = None;
            for row in of_one_thread {
                let time = self.nanoseconds(row).median;
                match row.lanes.as_str() {
                    "auto" => auto = Some(time),
                    "scalar" => widths.push((1.0, time)),
                    width => widths.extend(width.parse().ok().map(|width: f64| (width, time))),
                }
            }
            widths.sort_by(|a, b| a.0.total_cmp(&b.0));
            ticks = widths.iter().map(|(width, _)| *width).collect();
            if let (Some(auto), Some(first), Some(last)) = (auto, widths.first(), widths.last()) {
                let ends = [(first.0, auto), (last.0, auto)];
                let line = Series::new(format!("{name}, auto"), ends).mark(Mark::Dashes);
                series.push(line.color(color));
            }
            series.push(Series::new(name, widths).color(color));
        }
        Chart {
            title: format!("{}: lanes", self.subject.name),
            x: Axis::new("lanes", Scale::Logarithmic).with_ticks(ticks),
            y: self.time_axis(Scale::Linear),
            series,
        }
    }
}
