//! Report: what is to know about a mesh before spheres meet it.

use std::collections::HashSet;

use super::Mesh;
use super::net::{OPEN, SEVERAL};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// What a mesh is like. Nothing of it keeps spheres from meeting the mesh rightly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshReport {
    /// How many triangles there are.
    pub triangles: usize,
    /// How many vertices, equal ones once.
    pub vertices: usize,
    /// The corners of the box around it, length.
    pub bounds: [[f64; 3]; 2],
    /// Edges of one triangle only; 0 of a closed surface.
    pub open_edges: usize,
    /// Edges of three triangles or more.
    pub non_manifold_edges: usize,
    /// Edges whose two triangles look to different sides.
    pub flipped_edges: usize,
    /// Triangles whose corners are on a line or in a point.
    pub degenerate: usize,
    /// How many pieces there are that have no vertex in common.
    pub components: usize,
    /// How many different planes triangles have that go on into each other.
    pub faces: usize,
    /// What it encloses, length³: negative if its triangles look inwards. It means something
    /// only if there are no open and no flipped edges.
    pub volume: f64,
}

impl MeshReport {
    pub(super) fn of<T: Real>(mesh: &Mesh<T>) -> Self {
        let net = &*mesh.net;
        let (mut open_edges, mut flipped) = (0, 0);
        let mut several = HashSet::new();
        let (mut degenerate, mut faces) = (0, 0);
        let mut volume = 0.0;
        let middle = (mesh.bounds[0] + mesh.bounds[1]).cast::<f64>() * 0.5;
        for triangle in 0..net.len() {
            let corners = net.corners[triangle as usize];
            let ends = |side: usize| [corners[side], corners[(side + 1) % 3]];
            for side in 0..3 {
                match net.neighbours[triangle as usize][side] {
                    OPEN => open_edges += 1,
                    SEVERAL => {
                        let [from, to] = ends(side);
                        several.insert([from.min(to), from.max(to)]);
                    }
                    other if other > triangle => {
                        let Some((other, back)) = net.behind(triangle, side) else { continue };
                        flipped += usize::from(net.corners[other as usize][back] == ends(side)[0]);
                    }
                    _ => {}
                }
            }
            let is_degenerate = mesh.seams.is_degenerate(triangle);
            degenerate += usize::from(is_degenerate);
            faces += usize::from(!is_degenerate && mesh.plane_of(triangle) == triangle);
            let [a, b, c] = mesh.corners(triangle).each(|corner| corner.cast::<f64>() - middle);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        let corner = |corner: Vec3<T>| corner.cast::<f64>().to_array();
        Self {
            triangles: net.corners.len(),
            vertices: mesh.vertices.len(),
            bounds: mesh.bounds.each(corner),
            open_edges,
            non_manifold_edges: several.len(),
            flipped_edges: flipped,
            degenerate,
            components: components(mesh.vertices.len(), &net.corners),
            faces,
            volume,
        }
    }

    /// Whether every edge has two triangles.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0 && self.non_manifold_edges == 0
    }
}

/// How many sets of triangles there are without a vertex in common.
fn components(vertices: usize, triangles: &[[u32; 3]]) -> usize {
    // Each vertex leads to another one of its set, in the end to the one that stands for it.
    let mut leads: Vec<u32> = (0..vertices as u32).collect();
    fn stands(leads: &mut [u32], mut vertex: u32) -> u32 {
        while leads[vertex as usize] != vertex {
            let next = leads[leads[vertex as usize] as usize];
            leads[vertex as usize] = next;
            vertex = next;
        }
        vertex
    }
    let mut sets = vertices;
    for &[a, b, c] in triangles {
        for other in [b, c] {
            let [one, other] = [a, other].each(|vertex| stands(&mut leads, vertex));
            if one != other {
                leads[one.max(other) as usize] = one.min(other);
                sets -= 1;
            }
        }
    }
    sets
}
