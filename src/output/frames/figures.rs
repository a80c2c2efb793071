//! Figures: what a frame says of each body, in the terms of the formats.

use super::Frame;
use crate::bodies::Bodies;
use crate::mat3::Mat3;
use crate::numbers::array::Each;
use crate::real::Real;

/// The names of columns of numbers, in formats that have them.
pub const NUMBERS: [&str; 15] =
    ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "qw", "qx", "qy", "qz", "radius", "mass"];

/// The names of columns of whole numbers.
pub const WHOLE: [&str; 4] = ["ix", "iy", "iz", "type"];

/// The corners of the periodic box, or of the box around all bodies.
pub fn bounds<T: Real>(frame: &Frame<'_, T>) -> [[T; 3]; 2] {
    if let Some(space) = frame.space {
        return [space.lower.to_array(), space.upper.to_array()];
    }
    let bodies = frame.bodies;
    let mut corners = [[T::ZERO; 3]; 2];
    for (axis, column) in bodies.position.iter().enumerate() {
        for (index, &x) in column.iter().enumerate() {
            let radius = bodies.radius.of(index);
            let (least, greatest) = (x - radius, x + radius);
            let [lower, upper] = &mut corners;
            let is_first = index == 0;
            lower[axis] = if is_first { least } else { lower[axis].lesser(least) };
            upper[axis] = if is_first { greatest } else { upper[axis].greater(greatest) };
        }
    }
    corners
}

/// The orientation of a body as a unit quaternion, w, x, y, z, with w not negative.
///
/// ```
/// use carom::Bodies;
/// use carom::output::quaternion_of;
/// let bodies = Bodies::from_positions(&[[0.0_f64; 3]]).radius(1.0).build()?;
/// assert_eq!(quaternion_of(&bodies, 0), [1.0, 0.0, 0.0, 0.0]);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn quaternion_of<T: Real>(bodies: &Bodies<T>, index: usize) -> [T; 4] {
    match bodies.orientation {
        None => [T::ONE, T::ZERO, T::ZERO, T::ZERO],
        Some(_) => quaternion(bodies.orientation_of(index)),
    }
}

/// The unit quaternion w, x, y, z of a rotation, w not negative.
///
/// Of the four ways to find it, each of which divides by one component, the one by the
/// greatest (Shepperd 1978).
fn quaternion<T: Real>(rotation: Mat3<T>) -> [T; 4] {
    let m: [f64; 9] = rotation.rows().each(Real::to_f64);
    let trace = m[0] + m[4] + m[8];
    // Each is 4 q_k q_j, with the greatest q_k.
    let products = if trace >= m[0].max(m[4]).max(m[8]) {
        [1.0 + trace, m[7] - m[5], m[2] - m[6], m[3] - m[1]]
    } else if m[0] >= m[4].max(m[8]) {
        [m[7] - m[5], 1.0 + m[0] - m[4] - m[8], m[1] + m[3], m[2] + m[6]]
    } else if m[4] >= m[8] {
        [m[2] - m[6], m[1] + m[3], 1.0 - m[0] + m[4] - m[8], m[5] + m[7]]
    } else {
        [m[3] - m[1], m[2] + m[6], m[5] + m[7], 1.0 - m[0] - m[4] + m[8]]
    };
    let length = products.iter().map(|q| q * q).sum::<f64>().sqrt();
    let length = if products[0] < 0.0 { -length } else { length };
    // Adding 0 takes the sign off a zero.
    products.each(|q| T::from_f64(q / length + 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quaternion_turns_as_its_matrix() {
        // One rotation for each component that can be the greatest.
        let tests: [[f64; 4]; 5] = [
            [1.0, 0.0, 0.0, 0.0],
            [0.5, -0.5, 0.5, 0.5],
            [0.1, 0.7, -0.5, 0.5],
            [0.0, 0.1, 0.9, -0.3],
            [0.2, 0.1, 0.3, -0.9],
        ];
        for given in tests {
            let length = given.iter().map(|q| q * q).sum::<f64>().sqrt();
            let [w, x, y, z] = given.map(|q| q / length);
            let rows = [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ];
            let found = quaternion(Mat3::<f64>::from_rows(rows));
            for (found, given) in found.iter().zip([w, x, y, z]) {
                approx::assert_abs_diff_eq!(*found, given, epsilon = 1e-15);
            }
        }
    }
}
