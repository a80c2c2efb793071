//! Repeated timings of several engines, taken in turn, so that what else the
//! machine does falls on all of them alike.

use crate::peer::{Peer, PeerError, Timing};

/// Times of one engine.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// Median wall time per body and step over the rounds, nanoseconds.
    pub nanoseconds: f64,
    /// Median over the rounds of the time over that of the first engine of
    /// the same precision, in the same round.
    pub ratio: f64,
}

/// Runs `time` on every engine in turn, `rounds` times over.
pub fn interleaved(
    peers: &[Box<dyn Peer>],
    rounds: usize,
    time: impl Fn(&dyn Peer) -> Result<Timing, PeerError>,
) -> Result<Vec<Times>, PeerError> {
    let mut table = vec![Vec::with_capacity(rounds); peers.len()];
    for _ in 0..rounds {
        for (peer, times) in peers.iter().zip(&mut table) {
            times.push(time(peer.as_ref())?.nanoseconds);
        }
    }
    let first = |precision| peers.iter().position(|peer| peer.precision() == precision);
    Ok(peers
        .iter()
        .zip(&table)
        .map(|(peer, times)| {
            let base = first(peer.precision()).map_or(times, |i| &table[i]);
            Times {
                nanoseconds: median(times.clone()),
                ratio: median(times.iter().zip(base).map(|(a, b)| a / b).collect()),
            }
        })
        .collect())
}

/// The middle value, or the mean of the middle two; NaN of no values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(Vec::new()).is_nan());
    }
}
