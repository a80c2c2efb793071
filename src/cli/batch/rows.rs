//! Rows: one for each scene, as a table.

use std::io::{self, Write};

use carom::output::{Array, write_arrays, write_table};
use carom::study::table::digits;
use serde::{Deserialize, Serialize};

use super::observed::Observed;

/// The figures of every row.
const FIGURES: [&str; 5] = ["state_hash", "collisions", "pairs", "surroundings", "energy_change"];

/// What came of a scene. The journal keeps it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub scene: u64,
    pub seed: u64,
    /// The values of the keys that are varied.
    pub values: Vec<String>,
    /// The bits of the final state.
    pub state_hash: Option<String>,
    pub pairs: Option<u64>,
    pub surroundings: Option<u64>,
    pub energy_change: Option<f64>,
    pub observed: Vec<Option<f64>>,
    /// Why there are no figures.
    pub failure: Option<String>,
}

impl Row {
    /// Of a scene that came to no end.
    pub fn failed(why: String) -> Self {
        Self { failure: Some(why), ..Self::default() }
    }

    /// Collisions of both kinds.
    fn collisions(&self) -> Option<u64> {
        Some(self.pairs? + self.surroundings?)
    }

    fn observed(&self, k: usize) -> Option<f64> {
        self.observed.get(k).copied().flatten()
    }
}

/// All rows, and what their columns are.
pub struct Table<'a> {
    pub keys: Vec<&'a str>,
    pub observed: &'a [Observed],
    pub rows: &'a [Row],
}

impl Table<'_> {
    /// As comma-separated values.
    pub fn write_csv(&self, output: impl Write) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(output);
        let observed = self.observed.iter().map(|observed| observed.name.as_str());
        let header = ["scene", "seed"].into_iter().chain(self.keys.iter().copied());
        let header = header.chain(FIGURES).chain(observed).chain(["failure"]);
        table.write_record(header)?;
        for row in self.rows {
            let whole = |value: Option<u64>| value.map_or_else(String::new, |n| n.to_string());
            let number = |value: Option<f64>| value.map_or_else(String::new, digits);
            let text = |text: &Option<String>| text.clone().unwrap_or_default();
            let fields = [row.scene.to_string(), row.seed.to_string()].into_iter();
            let figures = [
                text(&row.state_hash),
                whole(row.collisions()),
                whole(row.pairs),
                whole(row.surroundings),
                number(row.energy_change),
            ];
            let observed = (0..self.observed.len()).map(|k| number(row.observed(k)));
            let fields = fields.chain(row.values.iter().cloned()).chain(figures).chain(observed);
            table.write_record(fields.chain([text(&row.failure)]))?;
        }
        table.flush()
    }

    /// As arrays of NumPy, the hash as a whole number.
    pub fn write_npz(&self, output: impl Write) -> io::Result<()> {
        let hash = |row: &Row| {
            let digits = row.state_hash.as_ref()?.strip_prefix("0x")?;
            u64::from_str_radix(digits, 16).ok()
        };
        write_arrays(output, &self.columns(self.whole(hash))).map(drop)
    }

    /// As a table of Parquet, the hash as a text.
    pub fn write_parquet(&self, output: impl Write) -> io::Result<()> {
        let hash = self.texts(|row| row.state_hash.clone());
        write_table(output, &self.columns(hash)).map(drop)
    }

    fn whole(&self, of: impl Fn(&Row) -> Option<u64>) -> Array {
        Array::Whole(self.rows.iter().map(of).collect())
    }

    fn numbers(&self, of: impl Fn(&Row) -> Option<f64>) -> Array {
        Array::Numbers(self.rows.iter().map(of).collect())
    }

    fn texts(&self, of: impl Fn(&Row) -> Option<String>) -> Array {
        Array::Texts(self.rows.iter().map(of).collect())
    }

    /// The columns of all formats with types, with this one of hashes.
    fn columns(&self, hashes: Array) -> Vec<(String, Array)> {
        let mut columns = vec![
            ("scene".to_owned(), self.whole(|row| Some(row.scene))),
            ("seed".to_owned(), self.whole(|row| Some(row.seed))),
        ];
        for (k, key) in self.keys.iter().enumerate() {
            let value = |row: &Row| row.values[k].parse().ok();
            let are_numbers = self.rows.iter().all(|row| value(row).is_some());
            let column = match are_numbers {
                true => self.numbers(value),
                false => self.texts(|row| Some(row.values[k].clone())),
            };
            columns.push(((*key).to_owned(), column));
        }
        let [state_hash, collisions, pairs, surroundings, energy_change] = FIGURES;
        columns.extend([
            (state_hash.to_owned(), hashes),
            (collisions.to_owned(), self.whole(Row::collisions)),
            (pairs.to_owned(), self.whole(|row| row.pairs)),
            (surroundings.to_owned(), self.whole(|row| row.surroundings)),
            (energy_change.to_owned(), self.numbers(|row| row.energy_change)),
        ]);
        for (k, observed) in self.observed.iter().enumerate() {
            columns.push((observed.name.clone(), self.numbers(|row| row.observed(k))));
        }
        columns.push(("failure".to_owned(), self.texts(|row| row.failure.clone())));
        columns
    }
}
