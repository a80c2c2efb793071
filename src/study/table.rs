//! Table: numbers in columns, and numbers and sentences as people read them.

use core::fmt;

/// Rows of a label and some cells; each column is as wide as its widest cell. A
/// label without cells is a heading, and may be wider than its column.
#[derive(Debug, Default)]
pub struct Table {
    rows: Vec<(String, Vec<String>)>,
    holds_texts: bool,
}

impl Table {
    /// Adds a row.
    pub fn row(&mut self, label: &str, cells: impl IntoIterator<Item = String>) {
        self.rows.push((label.to_owned(), cells.into_iter().collect()));
    }

    /// A table whose cells are texts, and start where their column starts;
    /// numbers end where it ends.
    pub fn of_texts() -> Self {
        Self { holds_texts: true, ..Self::default() }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    fn label_width(&self) -> usize {
        let labels = self.rows.iter().filter(|(_, cells)| !cells.is_empty());
        labels.map(|(label, _)| label.chars().count()).max().unwrap_or(0)
    }

    fn cell_width(&self, column: usize) -> usize {
        let cells = self.rows.iter().filter_map(|(_, cells)| cells.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let label_width = self.label_width();
        for (label, cells) in &self.rows {
            let mut line = format!("{label:label_width$}");
            for (column, cell) in cells.iter().enumerate() {
                let width = self.cell_width(column);
                line.push_str(&match self.holds_texts {
                    true => format!("  {cell:width$}"),
                    false => format!("  {cell:>width$}"),
                });
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// All digits of a number: the shortest that read back as the same one.
pub fn digits(value: f64) -> String {
    format!("{value:?}")
}

/// All digits, and no `.0` behind a whole number.
pub fn plain(value: f64) -> String {
    let digits = digits(value);
    digits.strip_suffix(".0").map_or(digits.clone(), str::to_owned)
}

/// A small difference: its sign and three digits.
pub fn difference(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:+.2e}") }
}

/// A whole number with commas between the thousands.
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A count of things: `1 thread`, `20,000 threads`.
pub fn counted(count: u64, thing: &str) -> String {
    format!("{} {thing}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// Three digits of a positive number, in words from a million up.
pub fn rounded(value: f64) -> String {
    match value {
        v if v >= 1e15 || (v > 0.0 && v < 1e-3) => format!("{v:.2e}"),
        v if v >= 0.9995e9 => format!("{} billion", three_digits(v / 1e9)),
        v if v >= 0.9995e6 => format!("{} million", three_digits(v / 1e6)),
        v if v >= 999.5 => grouped(v.round() as u64),
        v => three_digits(v),
    }
}

fn three_digits(value: f64) -> String {
    let decimals = match value {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        v if v >= 0.9995 || v == 0.0 => 2,
        v if v >= 0.09995 => 3,
        v if v >= 0.009995 => 4,
        _ => 5,
    };
    format!("{value:.decimals$}")
}

/// A length of wall time.
pub fn seconds(value: f64) -> String {
    match value {
        v if v < 0.9995e-3 => format!("{} µs", three_digits(v * 1e6)),
        v if v < 0.9995 => format!("{} ms", three_digits(v * 1e3)),
        v => format!("{} s", three_digits(v)),
    }
}

/// A text in lines of at most `width` letters.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// `10ᵏ` as it is written.
pub fn power_of_ten(k: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |digit: char| match digit.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '⁻',
    };
    format!("10{}", k.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::default();
        table.row("energy", ["initial".to_owned(), "final".to_owned()]);
        table.row("  potential", ["1.0".to_owned(), "-123.25".to_owned()]);
        table.row("  total", ["".to_owned(), "2.5".to_owned()]);
        let expected = "energy       initial    final\n  potential      1.0  -123.25\n  total                   2.5\n";
        assert_eq!(table.to_string(), expected);
    }

    #[test]
    fn numbers_as_people_say_them() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(counted(1, "step"), "1 step");
        assert_eq!(counted(2000, "step"), "2,000 steps");
        let said = [0.0, 0.0123, 0.5, 16.14, 999.4, 999.6, 12_345.0, 999_999.0, 4.136e6, 2e12];
        let words = said.map(rounded);
        let expected = [
            "0.00",
            "0.0123",
            "0.500",
            "16.1",
            "999",
            "1,000",
            "12,345",
            "1.00 million",
            "4.14 million",
            "2000 billion",
        ];
        assert_eq!(words, expected);
        assert_eq!(seconds(3.2141), "3.21 s");
        assert_eq!(seconds(0.0123), "12.3 ms");
        assert_eq!(seconds(4e-7), "0.400 µs");
        assert_eq!(difference(-1.234e-13), "-1.23e-13");
        assert_eq!(plain(10.0), "10");
        assert_eq!(plain(1e-9), "1e-9");
    }
}
