//! Parts: what is fixed, and the periodic box, as areas and lines of a picture.
//!
//! What all spheres are in front of is a wall behind them. What all of them are behind is
//! left open, but for its edges. What stands among them is cut into pieces, which are drawn
//! with the spheres in order of their distance.

use std::collections::HashMap;

use carom::Vec3;
use carom::space::PeriodicBox;
use carom::study::chart::Look;
use carom::surroundings::{Cuboid, Shape};

use super::camera::{Camera, Place};
use super::drawing::{Item, Layer, lit, mixed};
use crate::cli::shown::{Bounds, Scenery};

type Triangle = [Vec3<f64>; 3];

/// Corners of a circle.
const AROUND: usize = 72;

/// The most triangles of a part that are drawn with their edges.
const MOST_WITH_EDGES: usize = 40_000;

/// The cosine of the angle by which two faces differ at an edge that is seen.
const CREASE: f64 = 0.84;

/// The most pieces that a part is cut into.
const MOST_PIECES: f64 = 6_000.0;

/// The most centres that a triangle is compared with.
const MOST_CENTERS: usize = 1_000;

/// Colours of a picture, seen by a camera.
pub struct Parts<'a> {
    pub camera: &'a Camera,
    pub look: &'a Look,
    /// The box that what has no end fills.
    pub within: Bounds,
    /// Some of the spheres' centres.
    pub centers: Vec<Vec3<f64>>,
    /// The length of a piece.
    pub piece: f64,
}

/// Some of many centres.
pub fn some_of(centers: impl ExactSizeIterator<Item = Vec3<f64>>) -> Vec<Vec3<f64>> {
    let every = centers.len().div_ceil(MOST_CENTERS).max(1);
    centers.step_by(every).collect()
}

/// The triangles of all parts.
pub fn triangles(scenery: &Scenery, within: Bounds) -> Vec<(&Shape<f64>, Vec<Triangle>)> {
    scenery.shapes.iter().map(|shape| (shape, shape.triangles(within, AROUND))).collect()
}

/// An edge between triangles, by its ends, bit by bit.
type Edge = [[u64; 3]; 2];

/// Something drawn, in its layer and by how near it is.
pub type Placed = (Layer, f64, Item);

impl Parts<'_> {
    /// Draws a part.
    pub fn draw(&self, shape: &Shape<f64>, triangles: &[Triangle], items: &mut Vec<Placed>) {
        let sides: Vec<Side> = triangles.iter().map(|it| self.side(it, shape)).collect();
        let area: f64 = triangles.iter().map(|triangle| cross(triangle).length() * 0.5).sum();
        let piece = self.piece.max((area / MOST_PIECES).sqrt());
        for (triangle, side) in triangles.iter().zip(&sides) {
            match side.layer {
                Some(Layer::Between) => {
                    self.pieces(*triangle, piece, &mut |piece| {
                        self.area(&piece, side, Layer::Between, items);
                    });
                }
                Some(layer) => self.area(triangle, side, layer, items),
                None => {}
            }
        }
        if triangles.len() <= MOST_WITH_EDGES {
            self.edges(shape, triangles, &sides, piece, items);
        }
    }

    /// Draws the edges of a periodic box.
    pub fn draw_box(&self, space: &PeriodicBox<f64>, items: &mut Vec<Placed>) {
        let (lower, upper) = (space.lower.to_array(), space.upper.to_array());
        let shape = Shape::from(Cuboid::container(lower, upper));
        let triangles = shape.triangles(self.within, AROUND);
        let sides: Vec<Side> = triangles.iter().map(|it| self.side(it, &shape)).collect();
        self.edges(&shape, &triangles, &sides, f64::INFINITY, items);
    }

    /// How a triangle is seen.
    fn side(&self, triangle: &Triangle, shape: &Shape<f64>) -> Side {
        let normal = cross(triangle);
        let length = normal.length();
        let normal = if length > 0.0 { normal * (1.0 / length) } else { normal };
        let is_front = normal.dot(self.camera.sight(triangle[0])) > 0.0;
        let above = self.centers.iter().filter(|center| (**center - triangle[0]).dot(normal) > 0.0);
        let above = above.count();
        let in_front = if is_front { above } else { self.centers.len() - above };
        let (all, most) = (in_front == self.centers.len(), 2 * in_front >= self.centers.len());
        let is_two_sided = shape.is_thin() || shape.is_sensor();
        let opacity = match () {
            () if shape.is_sensor() => 0.16,
            () if is_two_sided && !most => 0.14,
            () => 1.0,
        };
        let layer = match () {
            () if !is_two_sided && !is_front => None,
            () if all => Some(Layer::Back),
            () if is_two_sided && in_front == 0 => Some(Layer::Front),
            () => Some(Layer::Between),
        };
        // Behind the wall is nothing: it is open from there.
        let is_open = !is_front && above == self.centers.len();
        Side { normal: if is_front { normal } else { -normal }, is_front, layer, opacity, is_open }
    }

    fn area(&self, triangle: &Triangle, side: &Side, layer: Layer, items: &mut Vec<Placed>) {
        let corners = triangle.map(|corner| self.camera.place(corner));
        let light = side.normal.dot(self.light()).max(0.0);
        // Walls are light, what stands among the spheres stands out.
        let [from, to] = if layer == Layer::Back { [0.2, 0.07] } else { [0.56, 0.24] };
        let color = match side.opacity {
            1.0 => self.look.ink(from + (to - from) * light),
            _ => lit(self.look.color(Some(0)), 0.8 + 0.5 * light),
        };
        let near = middle(&corners);
        let item = Item::Area { corners: corners.to_vec(), color, opacity: side.opacity };
        items.push((layer, near, item));
    }

    /// Where the light comes from.
    fn light(&self) -> Vec3<f64> {
        let [right, up, towards] = self.camera.axes();
        let light = towards * 0.66 + up * 0.62 - right * 0.42;
        light * (1.0 / light.length())
    }

    /// Cuts a triangle until its sides are no longer than a piece.
    fn pieces(&self, triangle: Triangle, piece: f64, each: &mut dyn FnMut(Triangle)) {
        let [a, b, c] = triangle;
        let sides = [(a, b, c), (b, c, a), (c, a, b)];
        let length = |side: &(Vec3<f64>, Vec3<f64>, Vec3<f64>)| (side.1 - side.0).length();
        let longest = sides.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let Some((from, to, other)) = longest.filter(|side| length(side) > 1.5 * piece) else {
            return each(triangle);
        };
        let half = (from + to) * 0.5;
        self.pieces([from, half, other], piece, each);
        self.pieces([half, to, other], piece, each);
    }

    /// Draws the edges that are seen: where a surface ends, has an edge, or turns away.
    fn edges(
        &self,
        shape: &Shape<f64>,
        triangles: &[Triangle],
        sides: &[Side],
        piece: f64,
        items: &mut Vec<Placed>,
    ) {
        let mut around: HashMap<Edge, ([Vec3<f64>; 2], Vec<usize>)> = HashMap::new();
        for (index, [a, b, c]) in triangles.iter().enumerate() {
            for ends in [[*a, *b], [*b, *c], [*c, *a]] {
                let mut key = ends.map(|end| (end + Vec3::ZERO).to_array().map(f64::to_bits));
                key.sort_unstable();
                if key[0] != key[1] {
                    around.entry(key).or_insert((ends, Vec::new())).1.push(index);
                }
            }
        }
        let mut edges: Vec<_> = around.into_iter().collect();
        edges.sort_unstable_by_key(|(key, _)| *key);
        let is_two_sided = shape.is_thin() || shape.is_sensor();
        for (_, (ends, own)) in edges {
            let own: Vec<&Side> = own.into_iter().map(|index| &sides[index]).collect();
            let is_seen = match own[..] {
                [a, b] => {
                    let signed = |side: &Side| side.normal * if side.is_front { 1.0 } else { -1.0 };
                    a.is_front != b.is_front || signed(a).dot(signed(b)) < CREASE
                }
                _ => true,
            };
            if !is_seen {
                continue;
            }
            let is_open = own.iter().all(|side| side.is_open);
            let is_hidden = !is_two_sided && own.iter().all(|side| !side.is_front);
            let layer = own.iter().filter_map(|side| side.layer).max();
            let (layer, opacity) = match layer {
                _ if is_hidden && is_open => (Layer::Front, 0.4),
                _ if is_hidden => continue,
                Some(layer) => (layer, 1.0),
                None => continue,
            };
            let color = match shape.is_sensor() {
                true => self.look.color(Some(0)),
                false => mixed(self.look.ground(), self.look.ink(1.0), 0.62),
            };
            let count = if layer == Layer::Between {
                ((ends[1] - ends[0]).length() / piece).ceil().clamp(1.0, 200.0) as usize
            } else {
                1
            };
            for k in 0..count {
                let at = |k: usize| ends[0] + (ends[1] - ends[0]) * (k as f64 / count as f64);
                let ends = [at(k), at(k + 1)].map(|end| self.camera.place(end));
                // In front of the areas that it is the edge of.
                let near = middle(&ends) + if count > 1 || piece.is_finite() { piece } else { 0.0 };
                let item = Item::Line { ends, width: 1.0, color, opacity };
                items.push((layer, near, item));
            }
        }
    }
}

/// How a triangle is seen.
struct Side {
    /// Unit vector towards the viewer.
    normal: Vec3<f64>,
    /// Whether it is seen from where its corners go counter-clockwise.
    is_front: bool,
    /// Where it is drawn, if it is.
    layer: Option<Layer>,
    opacity: f64,
    /// Whether it is a wall that is seen from behind.
    is_open: bool,
}

fn cross([a, b, c]: &Triangle) -> Vec3<f64> {
    (*b - *a).cross(*c - *a)
}

/// How near the middle of some places is.
fn middle(places: &[Place]) -> f64 {
    places.iter().map(|place| place.near).sum::<f64>() / places.len() as f64
}
