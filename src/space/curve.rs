//! Curve: points in an order in which neighbours in space are neighbours in number.

use rayon::prelude::*;

use crate::numbers::array::Each;

/// Cells along each axis, as many as three times fit into a number.
const CELLS: f64 = 2_097_152.0;

/// The numbers of points in the order of a curve that fills the box around them (Morton
/// 1966): points near each other come near each other.
pub(crate) fn along_curve(points: &[[f64; 3]]) -> Vec<u32> {
    let mut keys = keys(points);
    keys.par_sort_unstable();
    keys.into_iter().map(|(_, number)| number).collect()
}

/// For each point the number of the first one at the same place, bit by bit.
pub(crate) fn first_of_equal(points: &[[f64; 3]]) -> Vec<u32> {
    let place = |number: u32| points[number as usize].each(f64::to_bits);
    let mut keys = keys(points);
    keys.par_sort_unstable_by(|&(key, one), &(other_key, other)| {
        let places = || place(one).cmp(&place(other));
        key.cmp(&other_key).then_with(places).then(one.cmp(&other))
    });
    let mut firsts = vec![0; points.len()];
    for equal in keys.chunk_by(|a, b| a.0 == b.0 && place(a.1) == place(b.1)) {
        for &(_, number) in equal {
            firsts[number as usize] = equal[0].1;
        }
    }
    firsts
}

/// Where each point is on the curve, and its number.
fn keys(points: &[[f64; 3]]) -> Vec<(u64, u32)> {
    let mut lower = [f64::INFINITY; 3];
    let mut upper = [f64::NEG_INFINITY; 3];
    for point in points {
        for k in 0..3 {
            lower[k] = lower[k].min(point[k]);
            upper[k] = upper[k].max(point[k]);
        }
    }
    // One side for all axes: cells are cubes.
    let side = (0..3).map(|k| upper[k] - lower[k]).fold(f64::MIN_POSITIVE, f64::max);
    let key = |(number, point): (usize, &[f64; 3])| {
        let cell = |k: usize| ((point[k] - lower[k]) / side * CELLS).min(CELLS - 1.0) as u64;
        (spread(cell(0)) | spread(cell(1)) << 1 | spread(cell(2)) << 2, number as u32)
    };
    points.par_iter().enumerate().map(key).collect()
}

/// The last 21 binary digits of a number, with two zeros between neighbours.
fn spread(number: u64) -> u64 {
    let steps = [
        (32, 0x001F_0000_0000_FFFF),
        (16, 0x001F_0000_FF00_00FF),
        (8, 0x100F_00F0_0F00_F00F),
        (4, 0x10C3_0C30_C30C_30C3),
        (2, 0x1249_2492_4924_9249),
    ];
    steps.into_iter().fold(number, |digits, (shift, mask)| (digits | digits << shift) & mask)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::noise::noise;

    #[test]
    fn equal_points_have_the_number_of_the_first() {
        let mut noise = noise();
        let mut grid = || (4.0 * noise()).floor();
        let mut points: Vec<[f64; 3]> = (0..500).map(|_| [(); 3].map(|()| grid())).collect();
        // One that is far away puts all others into one cell.
        for far in [0.0, 1e300] {
            points[250] = [far; 3];
            let firsts = first_of_equal(&points);
            for (point, &first) in points.iter().zip(&firsts) {
                let right = points.iter().position(|other| other == point);
                assert_eq!(Some(first as usize), right);
            }
        }
    }
}
