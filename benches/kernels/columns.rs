//! Columns of random numbers.

use carom::column::Column;
use carom::real::Real;

/// `N` columns, numbers uniform between `least` and `greatest`.
pub fn uniform<T: Real, const N: usize>(
    len: usize,
    least: f64,
    greatest: f64,
    seed: u64,
) -> [Column<T>; N] {
    let mut random = SplitMix(seed);
    [(); N].map(|()| {
        let values = (0..len).map(|_| least + (greatest - least) * random.fraction());
        Column::from_values(values.map(T::from_f64), T::ZERO)
    })
}

/// SplitMix64 (Steele, Lea and Flood 2014).
struct SplitMix(u64);

impl SplitMix {
    /// Uniform in 0 to 1.
    fn fraction(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The columns' values, to be read.
pub fn read<T: Real, const N: usize>(columns: &[Column<T>; N]) -> [&[T]; N] {
    columns.each_ref().map(|column| &column[..])
}

/// The columns' values, to be changed.
pub fn write<T: Real, const N: usize>(columns: &mut [Column<T>; N]) -> [&mut [T]; N] {
    columns.each_mut().map(|column| &mut column[..])
}
