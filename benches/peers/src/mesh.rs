//! Meshes of triangles, the same for every engine: hills in a closed room, and
//! a flat floor.

use oorandom::Rand64;

use crate::scene::single;

/// Vertices, and triangles by the numbers of their corners. Seen from where
/// the spheres are, corners go round counter-clockwise.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Vertices.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Cells of two triangles each, cut one way and the other in turn, with a
    /// vertex where `place` puts it.
    fn grid(columns: usize, rows: usize, place: impl FnMut([usize; 2]) -> [f64; 3]) -> Self {
        let row = columns + 1;
        let vertices = (0..row * (rows + 1)).map(|k| [k % row, k / row]).map(place).collect();
        let mut triangles = Vec::with_capacity(2 * columns * rows);
        for (i, j) in (0..columns * rows).map(|k| (k % columns, k / columns)) {
            let [a, b, c, d] =
                [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| (j * row + i) as u32);
            triangles.extend(if is_cut_upwards(i, j) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
        Self { vertices, triangles }
    }

    /// 10,000 triangles of all forms in the plane z = 0, from −12 to 12 along
    /// x and −24 to 24 along y.
    pub fn flat() -> Self {
        let mut random = Rand64::new(4);
        Self::grid(50, 100, |place| {
            let [x, y] = place.map(|k| 0.5 * (k as f64 + 0.6 * (random.rand_float() - 0.5)));
            [single(x - 12.5), single(y - 25.0), 0.0]
        })
    }
}

/// Whether the cut through a cell goes from its lowest corner to its highest.
fn is_cut_upwards(i: usize, j: usize) -> bool {
    (i + j).is_multiple_of(2)
}

/// Irregular hills with walls around and a ceiling above, of triangles too:
/// what is in leaves only through a surface.
#[derive(Clone, Debug)]
pub struct Terrain {
    /// Cells of one diameter along each side.
    side: usize,
    /// All triangles.
    pub mesh: Mesh,
}

impl Terrain {
    /// Height of the ceiling.
    const CEILING: f64 = 24.0;

    /// No hill is higher.
    pub const HIGHEST: f64 = 7.0;

    /// Hills of `side` by `side` cells: waves, and 0.6 diameters at random.
    pub fn new(side: usize) -> Self {
        let mut random = Rand64::new(5);
        let mut mesh = Mesh::grid(side, side, |place| {
            let [x, y] = place.map(|k| k as f64);
            let waves = 1.5 * (0.37 * x + 0.11 * y).sin() * (0.29 * y).cos()
                + 0.9 * (1.1 * x - 0.3).sin() * (0.2 * x + 0.8 * y).cos();
            [x, y, single(3.0 + waves + 0.6 * random.rand_float())]
        });
        let corner = |i: usize, j: usize| (j * (side + 1) + i) as u32;
        let rim: Vec<u32> = (0..side)
            .map(|k| corner(k, 0))
            .chain((0..side).map(|k| corner(side, k)))
            .chain((0..side).map(|k| corner(side - k, side)))
            .chain((0..side).map(|k| corner(0, side - k)))
            .collect();
        let top = mesh.vertices.len() as u32;
        for &foot in &rim {
            let [x, y, _] = mesh.vertices[foot as usize];
            mesh.vertices.push([x, y, Self::CEILING]);
        }
        let middle = mesh.vertices.len() as u32;
        let half = 0.5 * side as f64;
        mesh.vertices.push([half, half, Self::CEILING]);
        for (k, &foot) in rim.iter().enumerate() {
            let next = (k + 1) % rim.len();
            let [above, next_above] = [top + k as u32, top + next as u32];
            mesh.triangles.extend([
                [rim[next], foot, above],
                [rim[next], above, next_above],
                [next_above, above, middle],
            ]);
        }
        Self { side, mesh }
    }

    /// Height of the surface over a point of the ground.
    fn height(&self, x: f64, y: f64) -> f64 {
        let cell = |x: f64| (x as usize).min(self.side - 1);
        let (i, j) = (cell(x), cell(y));
        let (u, v) = (x - i as f64, y - j as f64);
        let z = |i: usize, j: usize| self.mesh.vertices[j * (self.side + 1) + i][2];
        let (a, b, c, d) = (z(i, j), z(i + 1, j), z(i + 1, j + 1), z(i, j + 1));
        match (is_cut_upwards(i, j), u > v, u + v < 1.0) {
            (true, true, _) => a + u * (b - a) + v * (c - b),
            (true, false, _) => a + v * (d - a) + u * (c - d),
            (false, _, true) => a + u * (b - a) + v * (d - a),
            (false, _, false) => c + (1.0 - u) * (d - c) + (1.0 - v) * (b - c),
        }
    }

    /// Whether a point is over the hills and inside the walls.
    pub fn holds(&self, [x, y, z]: [f64; 3]) -> bool {
        let inside = 0.0..=self.side as f64;
        inside.contains(&x) && inside.contains(&y) && z <= Self::CEILING && z >= self.height(x, y)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    #[test]
    fn the_room_is_closed_and_turned_inwards() {
        let Mesh { vertices, triangles } = Terrain::new(8).mesh;
        let mut edges = HashMap::new();
        let mut volume = 0.0;
        for [a, b, c] in triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let way = if from < to { 1 } else { -1 };
                *edges.entry([from.min(to), from.max(to)]).or_insert(0) += way;
            }
            let [p, q, r] = [a, b, c].map(|k| vertices[k as usize]);
            volume += p[0] * (q[1] * r[2] - q[2] * r[1])
                + p[1] * (q[2] * r[0] - q[0] * r[2])
                + p[2] * (q[0] * r[1] - q[1] * r[0]);
        }
        assert!(edges.values().all(|&sum| sum == 0));
        assert!(volume / 6.0 < -8.0 * 8.0 * 16.0, "{volume}");
    }

    #[test]
    fn points_are_held_over_the_surface() {
        let terrain = Terrain::new(8);
        let Mesh { vertices, triangles } = &terrain.mesh;
        for corners in &triangles[..128] {
            let corners = corners.map(|k| vertices[k as usize]);
            let [x, y, z] = [0, 1, 2].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / 3.0);
            assert!((terrain.height(x, y) - z).abs() < 1e-12);
            assert!(terrain.holds([x, y, z + 0.01]) && !terrain.holds([x, y, z - 0.01]));
        }
        assert!(!terrain.holds([-0.1, 4.0, 10.0]) && !terrain.holds([4.0, 4.0, 25.0]));
        assert!(vertices[..81].iter().all(|v| (0.0..Terrain::HIGHEST).contains(&v[2])));
    }

    #[test]
    fn the_flat_mesh_has_ten_thousand_triangles() {
        let mesh = Mesh::flat();
        assert_eq!(mesh.triangles.len(), 10_000);
        for corners in mesh.triangles {
            let [a, b, c] = corners.map(|k| mesh.vertices[k as usize]);
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(turn > 0.0);
        }
    }
}
