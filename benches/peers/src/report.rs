//! The table.

use comfy_table::{CellAlignment, Table, presets};

use crate::peer::{
    BounceFigures, Collisions, EnergyFigures, PairFigures, SeamFigures, SpinFigures,
};
use crate::rounds::Times;

/// One line of the table: one engine in one scene.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Number of bodies.
    pub bodies: usize,
    /// Name of the engine.
    pub engine: &'static str,
    /// Run time, where it is measured.
    pub times: Option<Times>,
    /// Energy and collisions, where they are measured.
    pub energy: Option<EnergyFigures>,
    /// The other figure of the scene, in words.
    pub result: String,
}

const HEADER: [&str; 8] = [
    "scene",
    "bodies",
    "engine",
    "ns / body / step",
    "ratio",
    "µs / collision",
    "collisions / sphere",
    "result",
];

/// The rows as a Markdown table.
pub fn table(rows: &[Row]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN).set_header(HEADER);
    for row in rows {
        table.add_row(cells(row));
    }
    for numeric in [1, 3, 4, 5, 6] {
        if let Some(column) = table.column_mut(numeric) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

fn cells(row: &Row) -> [String; 8] {
    let collisions = row.energy.and_then(|energy| Some((energy, energy.collisions?)));
    let optional = |text: Option<String>| text.unwrap_or_default();
    [
        row.scene.clone(),
        thousands(row.bodies),
        row.engine.to_owned(),
        optional(row.times.map(|t| format!("{:.1}", t.nanoseconds))),
        optional(row.times.map(|t| format!("{:.2}", t.ratio))),
        optional(row.times.zip(collisions).and_then(|(times, (energy, collisions))| {
            let steps = energy.steps as f64 * row.bodies as f64;
            let all = collisions.pairs + collisions.surroundings;
            (all > 0).then(|| format!("{:.2}", 1e-3 * times.nanoseconds * steps / all as f64))
        })),
        optional(collisions.map(|(_, collisions)| per_sphere(collisions, row.bodies))),
        optional(row.energy.map(energy)) + row.result.as_str(),
    ]
}

/// A collision of two spheres is one for each of them.
fn per_sphere(collisions: Collisions, bodies: usize) -> String {
    let pairs = 2.0 * collisions.pairs as f64 / bodies as f64;
    let walls = collisions.surroundings as f64 / bodies as f64;
    format!("{pairs:.2} + {walls:.2} walls")
}

/// What came of many spheres.
fn energy(figures: EnergyFigures) -> String {
    let energy = format!("energy {:+.1e}", figures.energy_change);
    format!("{energy}, {} escaped", thousands(figures.escaped))
}

/// What came of the seams.
pub fn seams(figures: SeamFigures) -> String {
    let SeamFigures { position, velocity } = figures;
    if position == 0.0 && velocity == 0.0 {
        "no difference".to_owned()
    } else {
        format!("position off by {position:.1e}, velocity by {velocity:.1e}")
    }
}

/// What came of the bounces.
pub fn bounce(figures: BounceFigures) -> String {
    let BounceFigures { bounces, apex, .. } = figures;
    if figures.stopped {
        format!("stops after {bounces} bounces")
    } else {
        format!("apex {apex:.6} after {bounces} bounces (off by {:.1e})", apex - 1.0)
    }
}

/// What came of the spin.
pub fn spin(figures: SpinFigures) -> String {
    format!("angle off by {:.1e} rad", figures.angle_error)
}

/// What came of the single collisions.
pub fn pairs(figures: PairFigures) -> String {
    format!(
        "velocity off by {:.1e} (mean), {:.1e} (largest); energy {:+.1e}",
        figures.mean_velocity_error, figures.largest_velocity_error, figures.mean_energy_change
    )
}

/// A whole number with a comma before every three digits.
pub fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_by_three() {
        assert_eq!(thousands(7), "7");
        assert_eq!(thousands(100), "100");
        assert_eq!(thousands(1_000_188), "1,000,188");
    }
}
