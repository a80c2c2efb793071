//! Blocks: the mean of a figure over a run, and its statistical error.

#[cfg(feature = "files")]
use serde::Serialize;

/// A mean over a run, with what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize))]
#[non_exhaustive]
pub struct Statistic {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
    /// Whether the halves of the run differ by more than chance: it was not in
    /// equilibrium.
    pub drifts: bool,
}

/// Halvings of the number of blocks that the error is looked for in.
const HALVINGS: u32 = 3;

/// The least number of blocks that an error is taken from.
const FEWEST: usize = 8;

/// Standard errors by which halves have to differ before a figure counts as drifting.
const APART: f64 = 3.0;

impl Statistic {
    /// The mean of blocks, means over equal parts of a run, one after the other; `None`
    /// for fewer than 32.
    ///
    /// The error of the mean of `n` independent blocks is `s/√n`. Where neighbours are
    /// alike that is too little, and of neighbours taken together it is more (Flyvbjerg
    /// and Petersen 1989): the error is the greatest of the blocks as they are, of pairs
    /// and of fours of them.
    ///
    /// ```
    /// use carom::observe::Statistic;
    /// let noise = |k: i32| f64::from(k * k * 7919 % 101) / 101.0;
    /// let blocks: Vec<f64> = (0..32).map(noise).collect();
    /// let statistic = Statistic::of(&blocks).ok_or("too few")?;
    /// assert!((statistic.mean - 0.5).abs() < 3.0 * statistic.error);
    /// assert!(!statistic.drifts);
    /// let melting: Vec<f64> = (0..32).map(|k| noise(k) + f64::from(k)).collect();
    /// assert!(Statistic::of(&melting).is_some_and(|statistic| statistic.drifts));
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn of(blocks: &[f64]) -> Option<Self> {
        if blocks.len() < FEWEST << (HALVINGS - 1) {
            return None;
        }
        let error = greatest_error(blocks);
        let [first, second] = [&blocks[..blocks.len() / 2], &blocks[blocks.len() / 2..]];
        let apart = mean(first) - mean(second);
        let expected = greatest_error(first).hypot(greatest_error(second));
        Some(Self { mean: mean(blocks), error, drifts: apart.abs() > APART * expected })
    }

    /// The same about another mean, which is known better than that of the blocks.
    #[must_use]
    pub fn about(self, mean: f64) -> Self {
        Self { mean, ..self }
    }
}

/// The greatest standard error of the blocks, their pairs and their fours.
fn greatest_error(blocks: &[f64]) -> f64 {
    let mut blocks = blocks.to_vec();
    let mut greatest: f64 = 0.0;
    for _ in 0..HALVINGS {
        greatest = greatest.max(standard_error(&blocks));
        blocks = blocks.chunks_exact(2).map(mean).collect();
    }
    greatest
}

fn standard_error(values: &[f64]) -> f64 {
    let (count, mean) = (values.len() as f64, mean(values));
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (squares / (count - 1.0) / count).sqrt()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1 without an order.
    fn noise() -> impl Iterator<Item = f64> {
        let mut state: u64 = 1;
        core::iter::from_fn(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            Some((state >> 11) as f64 / (1_u64 << 53) as f64)
        })
    }

    #[test]
    fn the_error_is_that_of_the_mean() {
        let mut noise = noise();
        let (mut within, mut drifting) = (0, 0);
        for _ in 0..1000 {
            // Means of a hundred numbers each, alike in fours.
            let blocks: Vec<f64> = (0..8)
                .flat_map(|_| {
                    let mean = noise.by_ref().take(100).sum::<f64>() / 100.0;
                    [mean; 4]
                })
                .collect();
            let statistic = Statistic::of(&blocks).unwrap();
            within += i32::from((statistic.mean - 0.5).abs() < 2.0 * statistic.error);
            drifting += i32::from(statistic.drifts);
        }
        // Student's distribution of seven degrees has 91.4 % within two.
        assert!((890..=940).contains(&within), "{within}");
        assert!(drifting < 60, "{drifting}");
        assert_eq!(Statistic::of(&[1.0; 31]), None);
        let still = Statistic { mean: 2.0, error: 0.0, drifts: false };
        assert_eq!(Statistic::of(&[2.0; 32]), Some(still));
    }
}
