//! Report: the summary as a person reads it, in 80 columns.

use core::fmt;

use super::summary::Summary;
use super::table::{Table, counted, difference, digits, grouped, plain, rounded, seconds};
use crate::contact::Surface;
use crate::engine::{EngineKind, Impact};
use crate::motion::Integrator;

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.heading(f)?;
        writeln!(f, "\n{}", self.run())?;
        writeln!(f, "{}", self.energy_table())?;
        writeln!(f, "{}", self.momentum_table())?;
        writeln!(f, "angular momentum about the origin{}", self.what_changes_it())?;
        writeln!(f, "{}", self.angular_momentum_table())?;
        let gas = self.gas_table();
        if !gas.is_empty() {
            writeln!(f, "{gas}")?;
        }
        writeln!(f, "state hash  {}", self.state_hash)?;
        writeln!(f, "All quantities are in the scene's own units.")
    }
}

impl Summary {
    fn heading(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let surface = match self.setup.surface {
            Surface::Smooth => "smooth",
            Surface::Rough => "rough",
        };
        let spheres = counted(self.setup.bodies as u64, &format!("{surface} sphere"));
        writeln!(f, "{}: {spheres} in {}", self.setup.scene, self.setup.precision)
    }

    fn run(&self) -> Table {
        let mut table = Table::of_texts();
        let mut line = |label: &str, text: String| table.row(label, [text]);
        line("  engine", self.engine_words());
        let steps = counted(self.steps, "step");
        line("  time", format!("{} in {steps} of {}", plain(self.time), plain(self.setup.dt)));
        line(
            "  collisions",
            format!(
                "{} between spheres, {} with surroundings",
                grouped(self.collisions.pairs),
                grouped(self.collisions.surroundings)
            ),
        );
        line(
            "  run in",
            format!(
                "{} on {} with {}",
                seconds(self.wall_seconds),
                counted(self.setup.threads as u64, "thread"),
                counted(self.setup.lanes as u64, "lane")
            ),
        );
        let nanoseconds = 1e9 * self.wall_seconds / (self.setup.bodies as f64 * self.steps as f64);
        line(
            "  speed",
            format!(
                "{} ns per body and step, {} collisions per second",
                rounded(nanoseconds),
                rounded(self.collisions_per_second)
            ),
        );
        table
    }

    fn engine_words(&self) -> String {
        match self.setup.engine {
            EngineKind::EventDriven => "event-driven".to_owned(),
            EngineKind::Stepped => {
                let integrator = match self.setup.integrator {
                    Integrator::SemiImplicitEuler => "semi-implicit Euler",
                    Integrator::ExplicitEuler => "explicit Euler",
                    Integrator::VelocityVerlet => "velocity Verlet",
                };
                let impact = match self.setup.impact {
                    Impact::EndOfStep => "impacts at the end of a step",
                    Impact::SubStep => "impacts at their time within a step",
                };
                format!("stepped, {integrator}, {impact}")
            }
        }
    }

    fn energy_table(&self) -> Table {
        let energy = &self.energy;
        let (before, after) = (&energy.initial_parts, &energy.parts);
        let mut table = Table::default();
        table.row("energy", ["initial", "final", "change"].map(str::to_owned));
        let mut part = |label: &str, initial: f64, end: f64| {
            table.row(label, [digits(initial), digits(end), difference(end - initial)]);
        };
        part("  translational", before.translational, after.translational);
        part("  rotational", before.rotational, after.rotational);
        part("  potential", before.potential, after.potential);
        part("  total", energy.initial, energy.end);
        let mut note = |label: &str, value: f64| {
            table.row(label, [String::new(), String::new(), difference(value)]);
        };
        note("  relative", energy.relative_change);
        // Only where there is something to explain.
        if let Some(drift) = energy.integrator_drift.filter(|drift| *drift != 0.0) {
            note("  by integrator", drift);
            note("  unaccounted", (energy.end - energy.initial) - drift);
        }
        table
    }

    fn momentum_table(&self) -> Table {
        let momentum = &self.momentum;
        let mut table = Table::default();
        table.row("momentum", ["x", "y", "z"].map(str::to_owned));
        table.row("  initial", momentum.initial.map(digits));
        if self.setup.fixed_parts > 0 {
            table.row("  surroundings", momentum.from_surroundings.map(digits));
        }
        if self.setup.gravity != [0.0; 3] {
            table.row("  gravity", momentum.from_gravity.map(digits));
        }
        table.row("  final", momentum.end.map(digits));
        table.row("  unaccounted", momentum.balance_error.map(difference));
        table
    }

    fn angular_momentum_table(&self) -> Table {
        let mut table = Table::default();
        table.row("", ["x", "y", "z"].map(str::to_owned));
        table.row("  initial", self.angular_momentum.initial.map(digits));
        table.row("  final", self.angular_momentum.end.map(digits));
        let (initial, end) = (self.angular_momentum.initial, self.angular_momentum.end);
        table.row("  change", core::array::from_fn::<_, 3, _>(|k| difference(end[k] - initial[k])));
        table
    }

    fn what_changes_it(&self) -> &'static str {
        match (self.setup.periodic, self.setup.fixed_parts > 0, self.setup.gravity != [0.0; 3]) {
            (true, _, _) => " (coming back at the other side of the box changes it)",
            (false, true, true) => " (surroundings and gravity change it)",
            (false, true, false) => " (surroundings change it)",
            (false, false, true) => " (gravity changes it)",
            (false, false, false) => "",
        }
    }

    fn gas_table(&self) -> Table {
        let mut table = Table::of_texts();
        if let (Some(factor), Some(rate)) = (self.compressibility, self.collision_rate) {
            table.row("compressibility", [digits(factor)]);
            table.row("collision rate", [format!("{} per body and time", digits(rate))]);
        }
        if let Some(temperature) = self.temperature {
            table.row("temperature", [format!("{temperature}")]);
        }
        table
    }
}
