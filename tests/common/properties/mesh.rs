//! Mesh: whatever a file of a surface has, it is a surface or one clear error.

use carom::engine::Compiled;
use carom::scene::{Scene, Sphere};
use carom::surroundings::{Heightfield, Mesh};
use carom::vec3::Vec3;

use super::builder::moves_a_little;
use super::{Outcome, check_message};

/// Bytes as an STL file, an OBJ file and a picture of heights, in a precision by how many
/// they are; a ball flies against what they make.
pub fn mesh(bytes: &[u8]) -> Outcome {
    if bytes.len().is_multiple_of(4) { read::<f32>(bytes) } else { read::<f64>(bytes) }
}

fn read<T: Compiled>(bytes: &[u8]) -> Outcome {
    let (origin, sides, range) = ([T::ZERO; 3], [T::ONE; 2], [T::ZERO, T::ONE]);
    let heights = Heightfield::from_png(bytes, origin, sides, range);
    let read =
        [Mesh::from_stl(bytes), Mesh::from_obj(bytes), heights.map(|field| field.mesh().clone())];
    let mut outcome = Outcome::Refused;
    for mesh in read {
        match mesh {
            Ok(mesh) => outcome = is_met(mesh),
            Err(error) => check_message(&error.to_string()),
        }
    }
    outcome
}

fn is_met<T: Compiled>(mesh: Mesh<T>) -> Outcome {
    let (vertices, triangles) = (mesh.vertices(), mesh.triangles());
    let report = mesh.report();
    assert_eq!((report.vertices, report.triangles), (vertices.len(), triangles.len()));
    assert!(vertices.iter().flat_map(|vertex| vertex.to_array()).all(T::is_finite));
    let corners = |triangle: &[u32; 3]| triangle.map(|k| vertices[k as usize].cast::<f64>());
    let normal = |[a, b, c]: [Vec3<f64>; 3]| (b - a).cross(c - a);
    let Some([a, b, c]) = triangles.iter().map(corners).find(|&all| normal(all).length() > 0.0)
    else {
        return Outcome::Refused;
    };
    let normal = normal([a, b, c]) * (1.0 / normal([a, b, c]).length());
    let radius = 0.1 * (b - a).length();
    let above = (a + b + c) * (1.0 / 3.0) + normal * (1.5 * radius);
    let ball = Sphere::new(above.to_array()).radius(radius);
    let ball = ball.velocity((normal * -radius).to_array());
    match Scene::<T>::builder().surroundings(mesh).dt(0.25).sphere(ball).build() {
        Ok(scene) => moves_a_little(scene),
        Err(error) => {
            check_message(&error.to_string());
            Outcome::Refused
        }
    }
}
