//! Exact results that the engines are compared with, and the little vector
//! algebra they need.

/// `a + s b`.
pub fn add_scaled(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// `a − b`.
pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    add_scaled(a, -1.0, b)
}

/// `a · b`.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `|a|`.
pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Time until two spheres touch whose centres are `r` apart and move at the
/// relative velocity `v`: the smaller root of |r + v t| = `distance`, or
/// `None` when they miss each other.
pub fn contact_time(r: [f64; 3], v: [f64; 3], distance: f64) -> Option<f64> {
    let b = dot(r, v);
    let c = dot(r, r) - distance * distance;
    let discriminant = b * b - dot(v, v) * c;
    (b < 0.0 && discriminant >= 0.0).then(|| c / (discriminant.sqrt() - b))
}

/// Velocities after the elastic collision of two equal smooth spheres whose
/// centres are `r` = r₁ − r₂ apart at contact: the velocities along `r` are swapped.
pub fn elastic_collision(v1: [f64; 3], v2: [f64; 3], r: [f64; 3]) -> [[f64; 3]; 2] {
    let exchanged = dot(difference(v1, v2), r) / dot(r, r);
    [add_scaled(v1, -exchanged, r), add_scaled(v2, exchanged, r)]
}

/// Quaternion `x, y, z, w` of the rotation by `angle` about the direction of `axis`.
pub fn rotation(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let s = (0.5 * angle).sin() / length(axis);
    [s * axis[0], s * axis[1], s * axis[2], (0.5 * angle).cos()]
}

/// Angle of the rotation that leads from `p` to `q`, radians, 0 to π. Neither
/// has to be of unit length.
pub fn angle_between(p: [f64; 4], q: [f64; 4]) -> f64 {
    // q p*, whose vector part has length sin(angle / 2) |p| |q|.
    let w = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    let vector = [
        p[3] * q[0] - q[3] * p[0] - (q[1] * p[2] - q[2] * p[1]),
        p[3] * q[1] - q[3] * p[1] - (q[2] * p[0] - q[0] * p[2]),
        p[3] * q[2] - q[3] * p[2] - (q[0] * p[1] - q[1] * p[0]),
    ];
    2.0 * length(vector).atan2(w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_touch_when_the_gap_is_closed() {
        let t = contact_time([3.0, 0.0, 0.0], [-2.0, 0.0, 0.0], 1.0);
        assert_eq!(t, Some(1.0));
        assert_eq!(contact_time([3.0, 2.0, 0.0], [-2.0, 0.0, 0.0], 1.0), None, "a miss");
    }

    #[test]
    fn a_central_collision_swaps_velocities() {
        let (v1, v2) = ([1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]);
        assert_eq!(elastic_collision(v1, v2, [-1.0, 0.0, 0.0]), [v2, v1]);
    }

    #[test]
    fn an_oblique_collision_keeps_energy_and_momentum() {
        let (v1, v2) = ([1.0, 0.25, -0.5], [-0.5, 2.0, 0.125]);
        let [w1, w2] = elastic_collision(v1, v2, [-0.6, 0.8, 0.1]);
        let energy = |a, b| dot(a, a) + dot(b, b);
        assert!((energy(v1, v2) - energy(w1, w2)).abs() < 1e-14);
        let momentum = difference(add_scaled(v1, 1.0, v2), add_scaled(w1, 1.0, w2));
        assert!(length(momentum) < 1e-15);
    }

    #[test]
    fn angles_are_measured_from_one_orientation_to_the_other() {
        let axis = [2.0, 3.0, 6.0];
        let p = rotation(axis, 1.0);
        for (angle, expected) in [(1.0, 0.0), (1.25, 0.25), (0.5, 0.5), (1.0 + 6.0, 0.2831853)] {
            let found = angle_between(p, rotation(axis, angle));
            assert!((found - expected).abs() < 1e-7, "{angle}: {found}");
        }
    }
}
