//! Known solutions that both engines are held to.

/// Masses, velocities, what becomes of them, in how many collisions.
pub type Cradle = (&'static [f64], &'static [f64], &'static [f64], u64);

/// Equal and unequal balls in a row, pairwise in order.
pub const CRADLES: [Cradle; 4] = [
    (&[1.0; 3], &[1.0, 0.0, 0.0], &[0.0, 0.0, 1.0], 2),
    (&[1.0; 5], &[1.0, 1.0, 0.0, 0.0, 0.0], &[0.0, 0.0, 0.0, 1.0, 1.0], 6),
    (&[1.0, 2.0, 3.0], &[1.0, 0.0, 0.0], &[-1.0 / 3.0, -2.0 / 15.0, 8.0 / 15.0], 2),
    (
        &[1.0, 0.5, 0.25, 0.125],
        &[1.0, 0.0, 0.0, 0.0],
        &[1.0 / 3.0, 4.0 / 9.0, 16.0 / 27.0, 64.0 / 27.0],
        3,
    ),
];

/// `v_x` and `r w` of a solid superball between floor and ceiling after each of
/// its first bounces, from `v_x = 1` and no spin.
pub const SUPERBALL: [(f64, f64); 6] = [
    (3.0 / 7.0, -10.0 / 7.0),
    (-31.0 / 49.0, 60.0 / 49.0),
    (-333.0 / 343.0, 130.0 / 343.0),
    (-479.0 / 2401.0, -3720.0 / 2401.0),
    (13443.0 / 16807.0, 15950.0 / 16807.0),
    (104129.0 / 117649.0, 86580.0 / 117649.0),
];
