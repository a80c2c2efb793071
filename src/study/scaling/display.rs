//! The report as a person reads it, in 100 columns.

use core::fmt;

use super::{Measurement, ScalingReport, Settings, SpeedUp};
use crate::engine::Lanes;
use crate::numbers::array::Each;
use crate::scene::EngineKind;
use crate::study::table::{Table, counted, grouped, rounded};

impl fmt::Display for ScalingReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let engine = match self.engine {
            EngineKind::Stepped => "stepped",
            EngineKind::EventDriven => "event-driven",
        };
        writeln!(f, "{}: time and memory against size, {engine} engine", self.subject.name)?;
        for line in self.machine.to_string().lines() {
            writeln!(f, "{line}")?;
        }
        writeln!(f, "\n{}", self.times())?;
        writeln!(f, "{}", self.legend())?;
        if !self.powers.is_empty() {
            writeln!(f, "{}", self.laws())?;
        }
        if self.engine == EngineKind::EventDriven {
            writeln!(
                f,
                "The event-driven engine works on one thread: a collision needs the one before."
            )?;
        }
        if self.differing.is_empty() {
            return writeln!(f, "All variants of a size end in the same bits.");
        }
        writeln!(f, "DIFFERENT BITS, where all have to be the same:")?;
        self.differing.iter().try_for_each(|words| writeln!(f, "  {words}"))
    }
}

impl ScalingReport {
    /// What the columns mean.
    fn legend(&self) -> String {
        let Settings { threads, lanes, runs, .. } = &self.settings;
        let mut over = Vec::new();
        if threads.len() > 1 {
            over.push(format!("threads over {}", counted(threads[0] as u64, "thread")));
        }
        if lanes.len() > 1 {
            let base = if lanes.contains(&Lanes::Scalar) { Lanes::Scalar } else { lanes[0] };
            over.push(format!("lanes over {}", base));
        }
        let speed_up = match over.is_empty() {
            true => String::new(),
            false => format!("Speed-up: {}, within a round.\n", over.join(", ")),
        };
        format!(
            "Medians of {} or more, each with its quartiles; all variants of a size were run in turn.\n\
             {speed_up}Set-up: making the scene and its world, ms. B/body: bytes of the engine.\n\
             Peak: of the process with one world, the making of its scene included.\n",
            counted(*runs as u64, "run"),
        )
    }

    fn times(&self) -> Table {
        let mut table = Table::default();
        let heading = [self.unit(), "", "speed-up", "", "set-up", "B/body", "peak MB"];
        table.row("", heading.each(str::to_owned));
        for rows in &self.points {
            if let Some(first) = rows.first() {
                table.row(&format!("{}, {} bodies", first.precision, grouped(first.bodies)), []);
            }
            for row in rows {
                let time = self.nanoseconds(row);
                let ratio = self.speed_up(row);
                let cells = [
                    rounded(time.median),
                    range(time.lower_quartile, time.upper_quartile),
                    ratio.map_or(String::new(), |ratio| rounded(ratio.median)),
                    ratio.map_or(String::new(), |ratio| {
                        range(ratio.lower_quartile, ratio.upper_quartile)
                    }),
                    row.set_up.map_or(String::new(), |seconds| rounded(seconds * 1e3)),
                    rounded(row.bytes as f64 / row.bodies as f64),
                    row.peak_resident.map_or(String::new(), |bytes| rounded(bytes as f64 * 1e-6)),
                ];
                table.row(&label(row), cells);
            }
        }
        table
    }

    /// What the times are.
    pub(super) fn unit(&self) -> &'static str {
        match self.engine {
            EngineKind::Stepped => "ns/body/step",
            EngineKind::EventDriven => "ns/collision",
        }
    }

    fn speed_up(&self, row: &Measurement) -> Option<&SpeedUp> {
        self.speed_ups.iter().find(|ratio| {
            (&ratio.precision, ratio.bodies, ratio.threads, &ratio.lanes)
                == (&row.precision, row.bodies, row.threads, &row.lanes)
        })
    }

    fn laws(&self) -> Table {
        let mut table = Table::of_texts();
        let of = match self.engine {
            EngineKind::Stepped => "A step of N bodies takes a time ∝ N^p:",
            EngineKind::EventDriven => "A collision among N bodies takes a time ∝ N^p:",
        };
        table.row(of, []);
        for power in &self.powers {
            let label =
                format!("  {}, {}", power.precision, counted(power.threads as u64, "thread"));
            let error = match self.settings.bodies.len() {
                0..=2 => String::new(),
                _ => format!(" ± {:.3}", power.power.error),
            };
            table.row(&label, [format!("p = {:.3}{error}", power.power.value)]);
        }
        table
    }
}

/// What a variant is called.
fn label(row: &Measurement) -> String {
    let unit = if row.lanes.parse::<u32>().is_ok() { " lanes" } else { "" };
    format!("  {}, {}{unit}", counted(row.threads as u64, "thread"), row.lanes)
}

fn range(least: f64, greatest: f64) -> String {
    format!("{}–{}", rounded(least), rounded(greatest))
}
