//! PNG: a canvas in pixels, each by the share of it that is covered.

use ab_glyph_rasterizer::{Point, Rasterizer, point};

use super::canvas::{Canvas, Item, Place, Segment};
use super::look::Color;

/// Pixels of the file for each one of the canvas, in either direction: for fine screens.
const FINE: f64 = 2.0;

/// Lines that stand for a curve.
const PARTS: u32 = 8;

/// The bytes of the file.
pub(super) fn bytes(canvas: &Canvas) -> Result<Vec<u8>, png::EncodingError> {
    let pixels = Pixels::of(canvas);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width as u32, pixels.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // The unit is the metre: 192 to the inch.
    let dims = png::PixelDimensions { xppu: 7559, yppu: 7559, unit: png::Unit::Meter };
    encoder.set_pixel_dims(Some(dims));
    let mut file = encoder.write_header()?;
    file.write_image_data(&pixels.bytes)?;
    file.finish()?;
    Ok(bytes)
}

/// Three bytes each, row by row.
struct Pixels {
    width: usize,
    height: usize,
    bytes: Vec<u8>,
}

impl Pixels {
    fn of(canvas: &Canvas) -> Self {
        let [width, height] =
            [canvas.size.0, canvas.size.1].map(|length| (length * FINE).ceil() as usize);
        let bytes = canvas.ground.repeat(width * height);
        let mut pixels = Self { width, height, bytes };
        for item in &canvas.items {
            let path = polygons(&item.outline());
            match item {
                Item::Line { width, color, .. }
                | Item::Circle { width: Some(width), color, .. } => {
                    pixels.fill(
                        &path.iter().flat_map(|line| widened(line, *width)).collect::<Vec<_>>(),
                        *color,
                    );
                }
                Item::Polygon { color, .. } | Item::Circle { color, .. } => {
                    pixels.fill(&path, *color);
                }
                Item::Text(text) => pixels.fill(&path, text.color),
            }
        }
        pixels
    }

    /// Covers closed polygons; what several of the same sense cover is covered once.
    fn fill(&mut self, polygons: &[Vec<Place>], color: Color) {
        let places = || polygons.iter().flatten().map(|(x, y)| [x * FINE, y * FINE]);
        let (mut least, mut most) = ([f64::MAX; 2], [f64::MIN; 2]);
        for place in places() {
            for k in 0..2 {
                least[k] = least[k].min(place[k]);
                most[k] = most[k].max(place[k]);
            }
        }
        let ends = [self.width, self.height];
        let [first, last] = [least.map(f64::floor), most.map(|end| end.ceil() + 1.0)];
        let first = [0, 1].map(|k| first[k].clamp(0.0, ends[k] as f64) as usize);
        let last = [0, 1].map(|k| last[k].clamp(0.0, ends[k] as f64) as usize);
        if (0..2).any(|k| first[k] >= last[k]) {
            return;
        }
        let mut cover = Rasterizer::new(last[0] - first[0], last[1] - first[1]);
        let at = |(x, y): Place| -> Point {
            point((x * FINE) as f32 - first[0] as f32, (y * FINE) as f32 - first[1] as f32)
        };
        for polygon in polygons {
            let next = polygon.iter().skip(1).chain(polygon.first());
            for (from, to) in polygon.iter().zip(next) {
                cover.draw_line(at(*from), at(*to));
            }
        }
        let (width, bytes) = (self.width, &mut self.bytes);
        cover.for_each_pixel_2d(|x, y, share| {
            let share = f64::from(share.min(1.0));
            let start = 3 * ((first[1] + y as usize) * width + first[0] + x as usize);
            if share > 0.0 {
                for (byte, ink) in bytes[start..start + 3].iter_mut().zip(color) {
                    let ground = f64::from(*byte);
                    *byte = (ground + share * (f64::from(ink) - ground)).round() as u8;
                }
            }
        });
    }
}

/// A path as polygons, its curves as lines.
fn polygons(path: &[Segment]) -> Vec<Vec<Place>> {
    let mut polygons: Vec<Vec<Place>> = Vec::new();
    for segment in path {
        match (*segment, polygons.last_mut()) {
            (Segment::Move(at), _) => polygons.push(vec![at]),
            (Segment::Line(to), Some(polygon)) => polygon.push(to),
            (Segment::Curve([a, b, end]), Some(polygon)) => {
                let start = polygon.last().copied().unwrap_or(a);
                polygon.extend((1..=PARTS).map(|part| {
                    let t = f64::from(part) / f64::from(PARTS);
                    let s = 1.0 - t;
                    let of = |p: [f64; 4]| {
                        s * s * s * p[0] + 3.0 * s * t * (s * p[1] + t * p[2]) + t * t * t * p[3]
                    };
                    (of([start.0, a.0, b.0, end.0]), of([start.1, a.1, b.1, end.1]))
                }));
            }
            (_, None) => {}
        }
    }
    polygons
}

/// A line of some width, as polygons of the same sense: one for each of its parts, with an
/// octagon at each place between two.
fn widened(line: &[Place], width: f64) -> Vec<Vec<Place>> {
    let half = width / 2.0;
    let mut polygons = Vec::new();
    for pair in line.windows(2) {
        let [(x1, y1), (x2, y2)] = [pair[0], pair[1]];
        let length = (x2 - x1).hypot(y2 - y1);
        if length > 0.0 {
            let (u, v) = ((x2 - x1) / length * half, (y2 - y1) / length * half);
            polygons.push(vec![
                (x1 - v, y1 + u),
                (x1 + v, y1 - u),
                (x2 + v, y2 - u),
                (x2 - v, y2 + u),
            ]);
        }
    }
    let corners = line.len().saturating_sub(1);
    for (x, y) in line.iter().take(corners).skip(1) {
        polygons.push(
            (0..8)
                .map(|k| f64::from(k) * core::f64::consts::FRAC_PI_4)
                .map(|angle| (x + half * angle.cos(), y + half * angle.sin()))
                .collect(),
        );
    }
    polygons
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_cover_their_pixels() {
        let mut canvas = Canvas::new((4.0, 4.0), [255; 3]);
        canvas.polygon(vec![(1.0, 1.0), (2.5, 1.0), (2.5, 2.0), (1.0, 2.0)], [0, 0, 100]);
        canvas.line(&[(0.0, 3.0), (2.0, 3.0), (4.0, 3.0)], 1.0, [10; 3]);
        let pixels = Pixels::of(&canvas);
        let at = |x: usize, y: usize| pixels.bytes[3 * (8 * y + x)..][..3].to_vec();
        assert_eq!((pixels.width, pixels.height), (8, 8));
        assert_eq!(
            [at(1, 2), at(2, 2), at(4, 3), at(5, 2)],
            [[255, 255, 255], [0, 0, 100], [0, 0, 100], [255, 255, 255]]
        );
        // From one end to the other, its middle once.
        for x in 0..8 {
            assert_eq!([at(x, 4), at(x, 5), at(x, 6), at(x, 7)].map(|p| p[0]), [255, 10, 10, 255]);
        }
    }
}
