//! Sweeps of rotation over columns.

use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::motion::rotation::turned;
use crate::motion::sweep::{Arrays, lanes_and_tail};
use crate::numbers::array::Each;
use crate::vec3::Vec3;

/// Turns every body's orientation for a time `time` by its angular velocity,
/// as [`turned`]: whole lanes through `L`, the rest one by one, with the same
/// bits.
///
/// `orientation` as nine columns in row-major order, body axes to world axes;
/// `spin` in rad per time. As many bodies turn as the shortest column has.
///
/// ```
/// use carom::motion::turning::turn;
/// let still = [0.0_f32; 5];
/// let spin = [core::f32::consts::PI; 5];
/// let mut m = [[1.0_f32; 5], still, still, still, [1.0; 5], still, still, still, [1.0; 5]];
/// turn::<wide::f32x4>(m.each_mut().map(|column| column.as_mut_slice()), [&still, &still, &spin], 1.0);
/// // Half a turn about z.
/// assert!(m[0].iter().all(|xx| (xx + 1.0).abs() < 1e-6));
/// assert_eq!(m[8], [1.0; 5]);
/// ```
pub fn turn<L: Lane>(orientation: [&mut [L::Scalar]; 9], spin: [&[L::Scalar]; 3], time: L::Scalar) {
    let lengths = orientation.iter().map(|column| column.len());
    let len = lengths.chain(spin.each(<[L::Scalar]>::len)).min().unwrap_or(0);
    let (lanes, tail) = lanes_and_tail::<L, 9>(orientation, len);
    let spin = spin.each(|column| L::arrays(&column[..len]));
    turn_arrays::<L>(lanes, spin.each(|(lanes, _)| lanes), time);
    turn_arrays::<L::Scalar>(tail, spin.each(|(_, tail)| L::Scalar::arrays(tail).0), time);
}

// Column by column: `map` over nine of them is not inlined, and an index over
// arrays of columns is checked against each, which costs a third of the speed.
//
// Not inlined, since every width has the same tail.
#[inline(never)]
fn turn_arrays<L: Lane>(
    [xx, xy, xz, yx, yy, yz, zx, zy, zz]: Arrays<L, 9>,
    [x, y, z]: [&[L::Array]; 3],
    time: L::Scalar,
) {
    let time = L::splat(time);
    let row_x = xx.iter_mut().zip(xy).zip(xz);
    let row_y = yx.iter_mut().zip(yy).zip(yz);
    let row_z = zx.iter_mut().zip(zy).zip(zz);
    let spins = x.iter().zip(y).zip(z);
    for (((((xx, xy), xz), ((yx, yy), yz)), ((zx, zy), zz)), ((x, y), z)) in
        row_x.zip(row_y).zip(row_z).zip(spins)
    {
        let orientation = Mat3::from_columns(
            Vec3::from_arrays([*xx, *yx, *zx]),
            Vec3::from_arrays([*xy, *yy, *zy]),
            Vec3::from_arrays([*xz, *yz, *zz]),
        );
        let [a, b, c] = turned(orientation, Vec3::<L>::from_arrays([*x, *y, *z]), time).columns;
        [*xx, *yx, *zx] = a.to_arrays();
        [*xy, *yy, *zy] = b.to_arrays();
        [*xz, *yz, *zz] = c.to_arrays();
    }
}
