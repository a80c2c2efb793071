//! Fall: the potential energy that a scene lets bodies exchange.

use crate::compensated::CompensatedSum;
use crate::real::Real;
use crate::scene::{Encounters, Scene};
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// The potential energy that bodies set free as they fall from where they are to
/// the lowest fixed part below them, `Σ m |g| h`, mass × length² per time²; 0
/// without gravity, or with nothing below. In a periodic box `h` is at least its
/// height.
///
/// ```
/// use carom::observe::fall_energy;
/// use carom::{Plane, Scene, Sphere};
///
/// let floor = Plane::new([0.0, 0.0, 1e6], [0.0, 0.0, 1.0]);
/// let ball = Sphere::new([0.0, 0.0, 1e6 + 2.5]).radius(0.5).mass(3.0);
/// let scene = Scene::<f64>::builder().gravity([0.0, 0.0, -10.0]);
/// let scene = scene.surroundings(floor).sphere(ball).build()?;
/// assert_eq!(fall_energy(&scene), 60.0);
/// # Ok::<(), carom::SceneError>(())
/// ```
#[must_use]
pub fn fall_energy<T: Real>(scene: &Scene<T>) -> f64 {
    let gravity = scene.gravity.cast::<f64>();
    let strength = gravity.length();
    if strength == 0.0 {
        return 0.0;
    }
    let up = gravity * (-1.0 / strength);
    let mut least = 0.0;
    if let Some(space) = &scene.periodic {
        let sides = space.sides().cast::<f64>();
        least = (sides.x * up.x).abs() + (sides.y * up.y).abs() + (sides.z * up.z).abs();
    }
    let mut lowest = f64::INFINITY;
    let mut planes = Vec::new();
    let shapes = match scene.encounters {
        Encounters::None => &[],
        _ => scene.surroundings.as_slice(),
    };
    for shape in shapes {
        if let Some([lower, upper]) = shape.interior().or_else(|| shape.bounds()) {
            let corner = |k: usize| {
                let pick = |bit: usize, a: T, b: T| if k >> bit & 1 == 0 { a } else { b };
                Vec3::new(
                    pick(0, lower.x, upper.x),
                    pick(1, lower.y, upper.y),
                    pick(2, lower.z, upper.z),
                )
            };
            let heights = (0..8).map(|k| corner(k).cast::<f64>().dot(up));
            lowest = heights.fold(lowest, f64::min);
        } else {
            planes.extend(shape.features().into_iter().filter_map(|feature| match feature {
                Feature::Plane(plane) => Some((plane.point.cast::<f64>(), plane.normal.cast())),
                _ => None,
            }));
        }
    }
    let bodies = &scene.bodies;
    let energy: CompensatedSum = (0..bodies.len())
        .map(|body| {
            let center = bodies.position_of(body).cast::<f64>();
            let radius = bodies.radius.of(body).to_f64();
            let mut height = least.max(center.dot(up) - radius - lowest);
            for (point, normal) in &planes {
                let normal: &Vec3<f64> = normal;
                let slope = normal.dot(up);
                if slope > 1e-3 {
                    height = height.max(((center - *point).dot(*normal) - radius) / slope);
                }
            }
            bodies.mass.of(body).to_f64() * strength * height.max(0.0)
        })
        .collect();
    energy.value()
}
