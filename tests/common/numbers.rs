//! Pseudo-random and extreme numbers, the same on every machine.

use carom::mat3::Mat3;
use carom::motion::rotation::reference_rotation;
use carom::real::Real;
use carom::vec3::Vec3;
use xxhash_rust::xxh3::xxh3_64;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [-1, 1), with the digits of an `f64`.
    pub fn unit<T: Real>(&mut self) -> T {
        T::from_f64((self.bits() as i64 >> 10) as f64 / (1_u64 << 53) as f64)
    }

    /// Of either sign, with a magnitude between `10^least` and `10^most`.
    pub fn magnitude<T: Real>(&mut self, least: i32, most: i32) -> T {
        let decade = least + (self.bits() % (most - least) as u64) as i32;
        let value: f64 = self.unit();
        // By multiplication: `powi` may have other bits elsewhere.
        let ten = if decade < 0 { 0.1 } else { 10.0 };
        let power = (0..decade.abs()).fold(1.0, |power, _| power * ten);
        T::from_f64((value * 9.0 + value.signum()) * power)
    }

    /// A vector with components in [-1, 1).
    pub fn vector<T: Real>(&mut self) -> Vec3<T> {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    /// An orthonormal matrix, to rounding.
    pub fn orientation<T: Real>(&mut self) -> Mat3<T> {
        reference_rotation(self.vector(), T::whole(3))
    }
}

/// A precision whose bits the tests know.
pub trait Bits: Real {
    /// The number with these bits, of which there may be too many.
    fn from_any(bits: u64) -> Self;

    /// The bits, those of all NaNs the same.
    fn to_bits64(self) -> u64;

    /// Where formulas break: both zeros, subnormals, the ends of the range,
    /// infinities, NaN, ties of rounding, ends of argument reduction.
    fn extremes() -> Vec<Self>;
}

macro_rules! bits {
    ($($real:ident: $unsigned:ident),*) => {$(
        impl Bits for $real {
            fn from_any(bits: u64) -> Self {
                $real::from_bits((bits >> (64 - $unsigned::BITS)) as $unsigned)
            }

            fn to_bits64(self) -> u64 {
                if self.is_nan() { u64::MAX } else { u64::from(self.to_bits()) }
            }

            fn extremes() -> Vec<Self> {
                let pi = core::$real::consts::PI;
                let counted = Self::MOST_QUARTER_TURNS * pi / 2.0;
                let positive = [
                    0.0, 1.0, 0.5, 1.5, 2.5, 3.5, 1.0 + $real::EPSILON, 1.0 - $real::EPSILON / 2.0,
                    $real::from_bits(1), $real::MIN_POSITIVE, $real::MIN_POSITIVE / 3.0,
                    $real::MIN_POSITIVE.sqrt(), $real::MAX, $real::MAX / 2.0, $real::MAX.sqrt(),
                    $real::INFINITY, $real::NAN, 1.0 / $real::EPSILON, 0.5 / $real::EPSILON,
                    0.5 / $real::EPSILON - 0.5, pi, pi / 2.0, pi / 4.0, (pi / 4.0).next_up(),
                    counted, counted.next_up(), counted * 100.0, 1e10, 1e20, 1e-10, 1e-20,
                ];
                positive.into_iter().chain(positive.map(|value| -value)).collect()
            }
        }
    )*};
}

bits!(f32: u32, f64: u64);

/// Numbers from 0 to 1 without an order.
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The xxh3 hash of the bits of some numbers.
pub fn hash<T: Real>(values: impl IntoIterator<Item = T>) -> u64 {
    let mut bytes = Vec::new();
    for value in values {
        value.write_bits(&mut bytes);
    }
    xxh3_64(&bytes)
}
