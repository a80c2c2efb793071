//! The summary as a person reads it, in 80 columns.

use core::fmt;

use super::{PartSummary, SpheresSummary, Summary, shortest};
use carom::observe::Statistic;
use carom::study::table::{Table, counted, difference, digits, grouped, plain, rounded, seconds};
use carom::surroundings::Passages;

/// The labels of a vector's rows.
const AXES: [&str; 3] = ["  x", "  y", "  z"];

/// Bodies from which a temperature says something.
const A_GAS: usize = 100;

/// So many parts without names are printed at most.
const FEW_PARTS: usize = 8;

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.heading(f)?;
        writeln!(f, "\n{}", self.run())?;
        writeln!(f, "{}", self.conserved())?;
        let gifts = self.momentum_from();
        if !gifts.is_empty() {
            writeln!(f, "{gifts}")?;
        }
        for parts in [self.parts(), self.sensors()] {
            if !parts.is_empty() {
                writeln!(f, "{parts}")?;
            }
        }
        let gas = self.gas();
        if !gas.is_empty() {
            writeln!(f, "{gas}")?;
        }
        for found in &self.analyses {
            writeln!(f, "{}", found.table())?;
        }
        if let Some(conserved) = &self.all_digits {
            writeln!(f, "{}", conserved.table())?;
        }
        writeln!(f, "state hash  {}", self.state_hash)?;
        writeln!(f, "All quantities are in the scene's own units.")
    }
}

impl Summary {
    fn heading(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = format!("{} sphere", self.setup.surface);
        let spheres = counted(self.setup.bodies as u64, &kind);
        writeln!(f, "{}: {spheres} in {}", self.setup.scene, self.setup.precision)
    }

    fn run(&self) -> Table {
        let mut table = Table::of_texts();
        let mut line = |label: &str, text: String| table.row(label, [text]);
        line("  engine", self.engine_words());
        let mut time = self.time_words();
        if let Some(dt) = self.setup.dt {
            time += &format!(" in {} of {}", counted(self.steps, "step"), plain(dt));
        }
        if let Some(equilibrate) = self.equilibrate {
            time += &format!(", measured after {}", plain(equilibrate));
        }
        line("  time", time);
        if let Some(SpheresSummary { came, waits, removed, end, .. }) = self.spheres {
            let mut text = format!("{} came, {} removed", grouped(came), grouped(removed));
            text += &format!("; {} at the end", grouped(end as u64));
            if waits > 0 {
                text += &format!("; {} without room", grouped(waits));
            }
            line("  spheres", text);
        }
        line(
            "  collisions",
            format!(
                "{} between spheres, {} with surroundings",
                grouped(self.collisions.pairs),
                grouped(self.collisions.surroundings)
            ),
        );
        // Only where it is a part that a person would ask about.
        let is_slow = self.setup_seconds > 0.1 && self.setup_seconds > 0.1 * self.wall_seconds;
        let setup = if is_slow {
            format!(", {} of it set-up,", seconds(self.setup_seconds))
        } else {
            String::new()
        };
        line(
            "  run in",
            format!(
                "{}{} on {} with {}",
                seconds(self.wall_seconds),
                setup,
                counted(self.setup.threads as u64, "thread"),
                counted(self.setup.lanes as u64, "lane")
            ),
        );
        let mut speed = Vec::new();
        if self.body_steps_per_second > 0.0 {
            speed.push(format!(
                "{} ns per body and step",
                rounded(1e9 / self.body_steps_per_second)
            ));
        }
        if self.collisions_per_second > 0.0 {
            speed.push(format!("{} collisions per second", rounded(self.collisions_per_second)));
        }
        if !speed.is_empty() {
            line("  speed", speed.join(", "));
        }
        table
    }

    /// The time, in digits of the run's own precision.
    fn time_words(&self) -> String {
        match self.setup.precision {
            "f32" => plain(shortest(self.time as f32)),
            _ => plain(self.time),
        }
    }

    fn engine_words(&self) -> String {
        let (Some(integrator), Some(impact)) = (self.setup.integrator, self.setup.impact) else {
            return "event-driven, every collision at its exact time".to_owned();
        };
        format!("stepped, {integrator}, impacts {impact}")
    }

    fn conserved(&self) -> Table {
        let energy = &self.energy;
        let (before, after) = (&energy.initial_parts, &energy.parts);
        let mut table = Table::default();
        table.row("", ["initial", "final", "change"].map(str::to_owned));
        table.row("energy", []);
        let mut row = |label: &str, initial: f64, end: f64| {
            table.row(label, [digits(initial), digits(end), difference(end - initial)]);
        };
        row("  translational", before.translational, after.translational);
        row("  rotational", before.rotational, after.rotational);
        row("  potential", before.potential, after.potential);
        row("  total", energy.initial, energy.end);
        let mut note = |label: &str, value: f64| {
            table.row(label, [String::new(), String::new(), difference(value)]);
        };
        note("  relative", energy.relative_change);
        // Only where there is something to explain.
        if let Some(drift) = energy.integrator_drift.filter(|drift| *drift != 0.0) {
            note("  by integrator", drift);
            note("  unaccounted", (energy.end - energy.initial) - drift);
        }
        let (momentum, angular) = (&self.momentum, &self.angular_momentum);
        for (label, initial, end) in [
            ("momentum", momentum.initial, momentum.end),
            ("angular momentum about the origin", angular.initial, angular.end),
        ] {
            table.row(label, []);
            for (axis, (initial, end)) in AXES.iter().zip(initial.into_iter().zip(end)) {
                table.row(axis, [digits(initial), digits(end), difference(end - initial)]);
            }
        }
        table
    }

    /// What gave the momentum that the end has and the start has not.
    fn momentum_from(&self) -> Table {
        let mut table = Table::default();
        let momentum = &self.momentum;
        let mut givers = Vec::new();
        if self.setup.fixed_parts > 0 {
            givers.push(("surroundings", momentum.from_surroundings));
        }
        if self.setup.gravity != [0.0; 3] {
            givers.push(("gravity", momentum.from_gravity));
        }
        if givers.is_empty() {
            return table;
        }
        let names = givers.iter().map(|(name, _)| (*name).to_owned());
        table.row("momentum from", names.chain(["unaccounted".to_owned()]));
        for (k, axis) in AXES.iter().enumerate() {
            let given = givers.iter().map(|(_, given)| digits(given[k]));
            table.row(axis, given.chain([difference(momentum.balance_error[k])]));
        }
        table
    }

    /// What parts did, where they have names, or are few but more than one.
    fn parts(&self) -> Table {
        let mut table = Table::default();
        let hit = || self.parts.iter().filter(|part| part.passages.is_none());
        let is_named = hit().any(|part| part.name.is_some());
        if !is_named && !(2..=FEW_PARTS).contains(&hit().count()) {
            return table;
        }
        let heads = ["collisions", "impulse x", "y", "z"];
        table.row("parts", heads.map(str::to_owned));
        for part in hit().filter(|part| !is_named || part.name.is_some()) {
            let counts = [grouped(part.collisions)].into_iter();
            table.row(&label(part), counts.chain(part.impulse.map(digits)));
        }
        table
    }

    /// How often centres passed through sensors.
    fn sensors(&self) -> Table {
        let mut table = Table::default();
        for part in &self.parts {
            let Some(Passages { inward, outward }) = part.passages else { continue };
            if table.is_empty() {
                table.row("sensors", ["inward", "outward"].map(str::to_owned));
            }
            table.row(&label(part), [inward, outward].map(grouped));
        }
        table
    }

    fn gas(&self) -> Table {
        let mut table = Table::of_texts();
        let with_error = |name: &str, value: f64| match self.statistics.get(name) {
            None => digits(value),
            Some(Statistic { error, drifts, .. }) => {
                let drift = if *drifts { ", still drifting" } else { "" };
                format!("{} ± {}{drift}", digits(value), rounded(*error))
            }
        };
        if let (Some(factor), Some(rate)) = (self.compressibility, self.collision_rate) {
            table.row("compressibility", [with_error("compressibility", factor)]);
            let rate = with_error("collision_rate", rate);
            table.row("collision rate", [format!("{rate} per body and time")]);
        }
        if let Some(path) = self.mean_free_path {
            table.row("mean free path", [with_error("mean_free_path", path)]);
        }
        if let Some(temperature) = self.temperature.filter(|_| self.setup.bodies >= A_GAS) {
            table.row("temperature", [format!("{temperature}")]);
        }
        table
    }
}

/// What a part is called, by its number where it has no name.
fn label(part: &PartSummary) -> String {
    let number = format!("{}", part.index);
    format!("  {}", part.name.as_ref().unwrap_or(&number))
}
