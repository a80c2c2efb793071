//! Random numbers whose bits are the same on every machine.
//!
//! The generator is ChaCha8, seeded by this file and turned into reals by it,
//! so that no release of another crate changes a scene. Normal deviates need no
//! logarithm, which every platform rounds in its own way: von Neumann's
//! comparison of uniform deviates (Various techniques used in connection with
//! random digits, 1951) gives exponential ones, and a uniform direction in the
//! plane does the rest.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::numbers::array;

/// What a stream of random numbers is for. Each has its own, so that a change
/// of temperature moves no body.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    Radius,
    Mass,
    Position,
    Velocity,
    Spin,
    /// What a program draws for its own use.
    Own,
}

/// Where the random numbers of a group of spheres come from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seed {
    /// The seed of the scene, or the group's own.
    pub(super) seed: u64,
    /// The index of the group, for groups that share a seed.
    pub(super) group: u64,
}

impl Seed {
    /// The random numbers for a purpose.
    pub(super) fn random(self, purpose: Purpose) -> Random {
        Random::new(self.seed, self.group, purpose)
    }
}

/// A stream of random numbers, the same bits on every machine.
///
/// ```
/// use carom::scene::Random;
///
/// let draw = |seed| Random::of_seed(seed, 0).between(1.0, 2.0);
/// assert_eq!(draw(7), draw(7));
/// assert!(draw(7) != draw(8) && (1.0..2.0).contains(&draw(7)));
/// ```
#[derive(Debug)]
pub struct Random {
    generator: ChaCha8Rng,
    spare: Option<f64>,
}

impl Random {
    /// The stream of a group of spheres for a purpose.
    pub(super) fn new(seed: u64, group: u64, purpose: Purpose) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(bytes);
        generator.set_stream(group.wrapping_mul(8).wrapping_add(purpose as u64));
        Self { generator, spare: None }
    }

    /// A stream for a program's own use, as the variation of a scene with this seed. Each
    /// `number` is another one, and none is one that places or moves spheres.
    #[must_use]
    pub fn of_seed(seed: u64, number: u64) -> Self {
        Self::new(seed, number, Purpose::Own)
    }

    /// Uniform in `[0, 1)`, a multiple of `2⁻⁵³`.
    pub fn uniform(&mut self) -> f64 {
        const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;
        (self.generator.next_u64() >> 11) as f64 * UNIT
    }

    /// Uniform between two bounds.
    pub fn between(&mut self, least: f64, greatest: f64) -> f64 {
        least + self.uniform() * (greatest - least)
    }

    /// Exponential with mean 1: the first deviate of a falling run of odd
    /// length is exponential on `[0, 1)`, each run of even length adds 1.
    fn exponential(&mut self) -> f64 {
        let mut whole = 0.0;
        loop {
            let first = self.uniform();
            let mut last = first;
            let mut is_odd = true;
            loop {
                let next = self.uniform();
                if next >= last {
                    break;
                }
                last = next;
                is_odd = !is_odd;
            }
            if is_odd {
                return whole + first;
            }
            whole += 1.0;
        }
    }

    /// Normal with mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let x = self.between(-1.0, 1.0);
            let y = self.between(-1.0, 1.0);
            let square = x * x + y * y;
            if square < 1.0 && square > 0.0 {
                // Half the squared distance of a normal point is exponential.
                let stretch = (2.0 * self.exponential() / square).sqrt();
                self.spare = Some(y * stretch);
                return x * stretch;
            }
        }
    }

    /// Three independent normal deviates.
    pub(super) fn normal3(&mut self) -> [f64; 3] {
        array::from_fn(|_| self.normal())
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::{Purpose, Random};

    #[test]
    fn normal_deviates_have_the_moments_of_the_normal_distribution() {
        let mut random = Random::new(1, 0, Purpose::Velocity);
        let count = 1_000_000;
        let mut moments = [0.0; 5];
        let mut tail = 0;
        for _ in 0..count {
            let z = random.normal();
            let mut power = 1.0;
            for moment in &mut moments {
                *moment += power / f64::from(count);
                power *= z;
            }
            tail += usize::from(z.abs() > 1.959_963_985);
        }
        // Five standard errors each.
        for (moment, (expected, error)) in
            moments.iter().zip([(1.0, 1e-9), (0.0, 5e-3), (1.0, 7.1e-3), (0.0, 0.02), (3.0, 0.05)])
        {
            assert_abs_diff_eq!(*moment, expected, epsilon = error);
        }
        assert_abs_diff_eq!(tail as f64 / f64::from(count), 0.05, epsilon = 1.1e-3);
    }

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, group, purpose| Random::new(seed, group, purpose).uniform().to_bits();
        let first = draw(1, 0, Purpose::Radius);
        assert_eq!(first, draw(1, 0, Purpose::Radius));
        assert_ne!(first, draw(2, 0, Purpose::Radius));
        assert_ne!(first, draw(1, 1, Purpose::Radius));
        assert_ne!(first, draw(1, 0, Purpose::Spin));
    }

    /// These bits are part of what a seed means: they never change.
    #[test]
    fn the_first_numbers_of_a_seed_are_fixed() {
        let mut random = Random::new(1, 0, Purpose::Position);
        let bits = [random.uniform().to_bits(), random.normal().to_bits()];
        assert_eq!(bits, [4_600_447_875_732_012_120, 13_827_885_807_981_088_209]);
    }
}
