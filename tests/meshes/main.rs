//! Meshes: seams that nothing feels, first contacts, conservation, the same bits on every
//! path, files.

#[path = "../common/mod.rs"]
mod common;
mod files;
mod motion;
mod seams;
mod shots;

use carom::real::Real;
use carom::surroundings::Mesh;

/// Vertices and triangles.
pub(crate) struct Net {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Net {
    pub(crate) fn mesh<T: Real>(&self) -> Mesh<T> {
        let vertices: Vec<[T; 3]> = self.vertices.iter().map(|v| v.map(T::from_f64)).collect();
        Mesh::new(&vertices, &self.triangles).unwrap()
    }
}

/// A grid of cells about the origin, each of two triangles, with a vertex where `place` puts
/// it, whose corners go round to different sides.
pub(crate) fn grid(cells: usize, place: impl Fn(usize, usize) -> [f64; 3]) -> Net {
    let row = cells + 1;
    let vertices = (0..row * row).map(|k| place(k % row, k / row)).collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..cells * cells).map(|k| (k % cells, k / cells)) {
        let [a, b, c, d] =
            [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| (j * row + i) as u32);
        let both = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[b, a, d], [b, c, d]] };
        triangles.extend(both);
    }
    Net { vertices, triangles }
}

/// A sphere of triangles about the origin: an icosahedron whose sides are halved so often.
pub(crate) fn icosphere(radius: f64, level: usize) -> Net {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let onto = |[x, y, z]: [f64; 3]| {
        let scale = radius / (x * x + y * y + z * z).sqrt();
        [x * scale, y * scale, z * scale]
    };
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for k in 0..12 {
        let (a, b) =
            (if k & 1 == 0 { 1.0 } else { -1.0 }, if k & 2 == 0 { golden } else { -golden });
        let mut place = [0.0, a, b];
        place.rotate_right(k / 4);
        vertices.push(onto(place));
    }
    let near = |a: [f64; 3], b: [f64; 3]| {
        let d: f64 = (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum();
        d < 1.3 * radius * radius
    };
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|k| vertices[k]);
                if near(p, q) && near(q, r) && near(r, p) {
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    for _ in 0..level {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for &[a, b, c] in &triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                    let [p, q] = [from, to].map(|k| vertices[k as usize]);
                    vertices.push(onto([p[0] + q[0], p[1] + q[1], p[2] + q[2]]));
                    vertices.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    Net { vertices, triangles }
}
