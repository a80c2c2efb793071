//! Histogram: how the values of a column are distributed.

use carom::study::chart::{Axis, Chart, Mark, Scale, Series};

/// The most bins that are chosen for a column.
const MOST_BINS: f64 = 400.0;

/// Whole numbers have a bin each up to this range of them.
const MOST_WHOLE: f64 = 100.0;

/// The densities of values in bins of one width.
#[derive(Debug)]
struct Histogram {
    first: f64,
    width: f64,
    /// Per unit of the column, so that the area is 1.
    densities: Vec<f64>,
}

impl Histogram {
    /// Of values, of which there is at least one, all finite. Without a number of bins their
    /// width is `2 IQR / n^⅓` (Freedman and Diaconis 1981), or 1 for whole numbers of a short
    /// range.
    fn of(values: &mut [f64], bins: Option<u32>) -> Self {
        values.sort_by(f64::total_cmp);
        let (least, most) = (values[0], values[values.len() - 1]);
        let range = most - least;
        let are_whole = values.iter().all(|value| value.fract() == 0.0);
        let (first, width, count) = match bins {
            Some(bins) => (least, range / f64::from(bins), f64::from(bins)),
            None if are_whole && range < MOST_WHOLE => (least - 0.5, 1.0, range + 1.0),
            None if range == 0.0 => (least, 0.0, 1.0),
            None => {
                let quartile = |part: usize| values[part * (values.len() - 1) / 4];
                let wanted = 2.0 * (quartile(3) - quartile(1)) / (values.len() as f64).cbrt();
                let count = (range / wanted).ceil().clamp(1.0, MOST_BINS);
                (least, range / count, count)
            }
        };
        let width = if width > 0.0 { width } else { 1.0 };
        let mut densities = vec![0.0; count as usize];
        let last = densities.len() - 1;
        for value in &*values {
            let bin = ((value - first) / width) as usize;
            densities[bin.min(last)] += 1.0 / (width * values.len() as f64);
        }
        Self { first, width, densities }
    }

    /// Its outline.
    fn outline(&self) -> Vec<(f64, f64)> {
        let edge = |k: usize| self.first + self.width * k as f64;
        let tops = self.densities.iter().enumerate();
        let mut outline = vec![(edge(0), 0.0)];
        outline.extend(tops.flat_map(|(k, &density)| [(edge(k), density), (edge(k + 1), density)]));
        outline.push((edge(self.densities.len()), 0.0));
        outline
    }
}

/// A chart for each column that has numbers.
pub fn charts(
    title: &str,
    columns: &[(String, Vec<Option<f64>>)],
    bins: Option<u32>,
) -> Vec<Chart> {
    let chart = |(name, column): &(String, Vec<Option<f64>>)| {
        let mut values: Vec<f64> = column.iter().flatten().copied().collect();
        if values.is_empty() {
            return None;
        }
        let outline = Histogram::of(&mut values, bins).outline();
        Some(Chart {
            title: format!("{title}, {} values", values.len()),
            x: Axis::new(name, Scale::Linear),
            y: Axis::new("probability density", Scale::Linear),
            series: vec![Series::new(name, outline).color(0).mark(Mark::Line)],
        })
    };
    columns.iter().filter_map(chart).collect()
}

#[cfg(test)]
mod tests {
    use super::Histogram;

    fn area(histogram: &Histogram) -> f64 {
        histogram.densities.iter().sum::<f64>() * histogram.width
    }

    #[test]
    fn whole_numbers_have_a_bin_each() {
        let histogram = Histogram::of(&mut [3.0, 1.0, 3.0, 3.0], None);
        assert_eq!(histogram.densities, [0.25, 0.0, 0.75]);
        assert_eq!((histogram.first, histogram.width), (0.5, 1.0));
        assert_eq!(histogram.outline()[..3], [(0.5, 0.0), (0.5, 0.25), (1.5, 0.25)]);
    }

    #[test]
    fn the_area_is_one_for_any_bins() {
        let mut values: Vec<f64> = (0..1000).map(|k| f64::from(k * k % 997) / 7.0).collect();
        for bins in [None, Some(1), Some(7), Some(1000)] {
            let histogram = Histogram::of(&mut values, bins);
            assert!((area(&histogram) - 1.0).abs() < 1e-12, "{bins:?}");
            assert!(bins.is_none_or(|bins| histogram.densities.len() == bins as usize));
        }
    }

    #[test]
    fn equal_values_are_one_bin() {
        for value in [2.5, -1e300, 0.0] {
            let histogram = Histogram::of(&mut [value; 5], None);
            assert_eq!(histogram.densities, [1.0]);
        }
    }
}
