//! Parts: what is fixed, and the periodic box, as areas and lines of a picture.
//!
//! What all spheres are in front of is a wall behind them. What all of them are behind is
//! left open, but for its edges. What stands among them is cut into pieces, which are drawn
//! with the spheres in order of their distance.

use carom::Vec3;
use carom::space::PeriodicBox;
use carom::study::chart::Look;
use carom::surroundings::{Cuboid, Shape};

use super::camera::{Camera, Place};
use super::drawing::{Item, Layer, lit, mixed};
use crate::cli::outline::{self, AROUND, MOST_WITH_EDGES, Triangle, edges, is_wall};
use crate::cli::shown::Bounds;

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

/// Something drawn, in its layer and by how near it is.
pub type Placed = (Layer, f64, Item);

impl Parts<'_> {
    /// Draws a part.
    pub fn draw(&self, shape: &Shape<f64>, triangles: &[Triangle], items: &mut Vec<Placed>) {
        let sides: Vec<Side> = triangles.iter().map(|it| self.side(it, shape)).collect();
        // What stands among the spheres stands out.
        let is_wall = shape.is_thin() || is_wall(shape);
        let is_wall =
            is_wall || sides.iter().any(|side| side.layer == Some(Layer::Back) || side.is_open);
        let tones = match () {
            () if shape.is_sensor() => Tones::Sensor,
            () if is_wall => Tones::Wall,
            () => Tones::Solid,
        };
        let area: f64 = triangles.iter().map(outline::area).sum();
        let piece = self.piece.max((area / MOST_PIECES).sqrt());
        for (triangle, side) in triangles.iter().zip(&sides) {
            match side.layer {
                Some(Layer::Between) => {
                    self.pieces(*triangle, piece, &mut |piece| {
                        self.area(&piece, side, (Layer::Between, tones), items);
                    });
                }
                Some(layer) => self.area(triangle, side, (layer, tones), items),
                None => {}
            }
        }
        if triangles.len() <= MOST_WITH_EDGES {
            self.draw_edges(shape, (triangles, &sides), piece, items);
        }
    }

    /// Draws the edges of a periodic box.
    pub fn draw_box(&self, space: &PeriodicBox<f64>, items: &mut Vec<Placed>) {
        let (lower, upper) = (space.lower.to_array(), space.upper.to_array());
        let shape = Shape::from(Cuboid::container(lower, upper));
        let triangles = shape.triangles(self.within, AROUND);
        let sides: Vec<Side> = triangles.iter().map(|it| self.side(it, &shape)).collect();
        self.draw_edges(&shape, (&triangles, &sides), f64::INFINITY, items);
    }

    /// How a triangle is seen.
    fn side(&self, triangle: &Triangle, shape: &Shape<f64>) -> Side {
        let normal = outline::normal(triangle);
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

    fn area(
        &self,
        triangle: &Triangle,
        side: &Side,
        (layer, tones): (Layer, Tones),
        items: &mut Vec<Placed>,
    ) {
        let corners = triangle.map(|corner| self.camera.place(corner));
        let light = side.normal.dot(self.light()).max(0.0);
        let ink = |dark: f64, bright: f64| self.look.ink(dark + (bright - dark) * light);
        let color = match tones {
            Tones::Sensor => self.look.color(Some(0)),
            Tones::Wall => ink(0.22, 0.07),
            Tones::Solid => ink(0.56, 0.22),
        };
        // Through what is seen through, its colour has to be seen.
        let color = if side.opacity < 1.0 { lit(color, 0.6) } else { color };
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
    fn draw_edges(
        &self,
        shape: &Shape<f64>,
        (triangles, sides): (&[Triangle], &[Side]),
        piece: f64,
        items: &mut Vec<Placed>,
    ) {
        let normals: Vec<Vec3<f64>> = triangles.iter().map(outline::normal).collect();
        let is_two_sided = shape.is_thin() || shape.is_sensor();
        // Nothing is inside of it that could be looked at.
        let is_closed = !is_wall(shape) && shape.bounds().is_some();
        for edge in edges(triangles) {
            let own: Vec<&Side> = edge.of.iter().map(|index| &sides[*index]).collect();
            let turns_away = own.iter().any(|side| side.is_front != own[0].is_front);
            let (is_seen, ends) = (turns_away || edge.is_sharp(&normals), edge.ends);
            if !is_seen {
                continue;
            }
            let is_open = !is_closed && own.iter().all(|side| side.is_open);
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

/// The colours of a part.
#[derive(Clone, Copy, Debug)]
enum Tones {
    Sensor,
    Wall,
    Solid,
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

/// How near the middle of some places is.
fn middle(places: &[Place]) -> f64 {
    places.iter().map(|place| place.near).sum::<f64>() / places.len() as f64
}
