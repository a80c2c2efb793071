//! Raster: a drawing in pixels, and what of it is hidden.

use std::collections::HashMap;

use carom::study::chart::Color;
use rayon::prelude::*;

use super::camera::Disc;
use super::drawing::{Drawing, Item, LIT, REACH, mixed, shades};

/// Rows of a band that one thread draws at a time.
const BAND: usize = 32;

/// Samples for each pixel, in either direction.
const SAMPLES: usize = 2;

/// The pixels of a drawing, `fine` for each one of its own in either direction, row by row.
pub fn pixels(drawing: &Drawing, fine: f64) -> (Vec<u8>, (u32, u32)) {
    let size = [drawing.width, drawing.height].map(|side| (side * fine).ceil() as usize);
    let mut pixels = vec![0; 3 * size[0] * size[1]];
    let items: Vec<(&Item, [f64; 4])> =
        drawing.items.iter().chain(&drawing.legend).map(|item| (item, item.bounds())).collect();
    let mut colors = Colors::new();
    for (item, _) in &items {
        if let Item::Sphere { color, haze, .. } = item {
            let shades = || Shades::new(shades(*color, *haze, drawing.ground));
            colors.entry((*color, *haze)).or_insert_with(shades);
        }
    }
    let bands = pixels.par_chunks_mut(3 * size[0] * BAND).enumerate();
    bands.for_each(|(number, band)| {
        let rows = band.len() / (3 * size[0]);
        let mut samples = Samples::new(
            drawing.ground,
            fine * SAMPLES as f64,
            [size[0] * SAMPLES, number * BAND * SAMPLES, rows * SAMPLES],
        );
        for (item, bounds) in &items {
            samples.draw(item, *bounds, &colors);
        }
        samples.averaged(band);
    });
    (pixels, (size[0] as u32, size[1] as u32))
}

/// The colours of spheres, by their own colour and haze.
type Colors = HashMap<(Color, u8), Shades>;

/// Some rows of samples.
struct Samples {
    colors: Vec<Color>,
    fine: f64,
    width: usize,
    first: usize,
    rows: usize,
}

/// What samples an item has: in which rows, and from where to where in one.
fn rows_of(bounds: [f64; 4], fine: f64, first: usize, rows: usize) -> core::ops::Range<usize> {
    let from = (bounds[1] * fine - 0.5).ceil().max(first as f64) as usize;
    let to = ((bounds[3] * fine - 0.5).floor() + 1.0).clamp(0.0, (first + rows) as f64) as usize;
    from..to.max(from)
}

impl Samples {
    fn new(ground: Color, fine: f64, [width, first, rows]: [usize; 3]) -> Self {
        Self { colors: vec![ground; width * rows], fine, width, first, rows }
    }

    fn draw(&mut self, item: &Item, bounds: [f64; 4], colors: &Colors) {
        let rows = rows_of(bounds, self.fine, self.first, self.rows);
        if rows.is_empty() {
            return;
        }
        match item {
            Item::Sphere { disc, color, haze } => {
                let Some(shades) = colors.get(&(*color, *haze)) else { return };
                for row in rows {
                    let y = (row as f64 + 0.5) / self.fine;
                    let Some(ends) = disc_ends(disc, y) else { continue };
                    self.span(row, ends, |x, _| shades.at(in_disc(disc, [x, y])));
                }
            }
            Item::Area { corners, color, opacity } => {
                let corners: Vec<[f64; 2]> = corners.iter().map(|at| [at.x, at.y]).collect();
                self.polygon(rows, &corners, *color, *opacity);
            }
            Item::Line { ends, width, color, opacity } => {
                let [a, b] = ends.map(|end| [end.x, end.y]);
                let [x, y] = [b[0] - a[0], b[1] - a[1]];
                let half = 0.5 * width / x.hypot(y).max(f64::MIN_POSITIVE);
                let [x, y] = [x * half, y * half];
                // A little longer than it is, so that lines meet.
                let corner = |end: [f64; 2], along: f64, across: f64| {
                    [end[0] + along * x - across * y, end[1] + along * y + across * x]
                };
                let corners = [
                    corner(a, -0.5, 1.0),
                    corner(b, 0.5, 1.0),
                    corner(b, 0.5, -1.0),
                    corner(a, -0.5, -1.0),
                ];
                self.polygon(rows, &corners, *color, *opacity);
            }
        }
    }

    fn polygon(
        &mut self,
        rows: core::ops::Range<usize>,
        corners: &[[f64; 2]],
        color: Color,
        opacity: f64,
    ) {
        for row in rows {
            let Some(ends) = polygon_ends(corners, (row as f64 + 0.5) / self.fine) else {
                continue;
            };
            self.span(
                row,
                ends,
                |_, before| {
                    if opacity < 1.0 { mixed(before, color, opacity) } else { color }
                },
            );
        }
    }

    /// Colours the samples of a row between two places.
    fn span(&mut self, row: usize, ends: [f64; 2], color: impl Fn(f64, Color) -> Color) {
        for column in columns(ends, self.fine, self.width) {
            let sample = &mut self.colors[(row - self.first) * self.width + column];
            *sample = color((column as f64 + 0.5) / self.fine, *sample);
        }
    }

    /// The means of the samples of each pixel.
    fn averaged(&self, pixels: &mut [u8]) {
        let width = self.width / SAMPLES;
        for (index, pixel) in pixels.chunks_exact_mut(3).enumerate() {
            let (row, column) = (index / width * SAMPLES, index % width * SAMPLES);
            let mut sum = [0_u32; 3];
            for k in 0..SAMPLES * SAMPLES {
                let sample = (row + k / SAMPLES) * self.width + column + k % SAMPLES;
                for (sum, value) in sum.iter_mut().zip(self.colors[sample]) {
                    *sum += u32::from(value);
                }
            }
            let count = (SAMPLES * SAMPLES) as u32;
            for (value, sum) in pixel.iter_mut().zip(sum) {
                *value = ((sum + count / 2) / count) as u8;
            }
        }
    }
}

/// The samples between two places of a row.
fn columns(ends: [f64; 2], fine: f64, width: usize) -> core::ops::Range<usize> {
    let from = (ends[0] * fine - 0.5).ceil().max(0.0) as usize;
    let to = ((ends[1] * fine - 0.5).floor() + 1.0).clamp(0.0, width as f64) as usize;
    from..to.max(from)
}

/// A place of a disc, in halves of its diameters: turned to the picture again.
fn in_disc(disc: &Disc, [x, y]: [f64; 2]) -> [f64; 2] {
    let [x, y] = [x - disc.center.x, y - disc.center.y];
    let [u, v] = disc.along;
    let [s, t] = [(x * u + y * v) / disc.half[0], (y * u - x * v) / disc.half[1]];
    [s * u - t * v, s * v + t * u]
}

/// Where a row leaves a disc.
fn disc_ends(disc: &Disc, y: f64) -> Option<[f64; 2]> {
    let [u, v] = disc.along;
    let [a, b] = disc.half.map(|half| 1.0 / (half * half));
    let y = y - disc.center.y;
    // Of (x u + y v)² a + (y u − x v)² b = 1.
    let square = u * u * a + v * v * b;
    let linear = u * v * y * (a - b);
    let constant = y * y * (v * v * a + u * u * b) - 1.0;
    let root = linear * linear - square * constant;
    (root >= 0.0).then(|| {
        let root = root.sqrt();
        [-root, root].map(|root| disc.center.x + (root - linear) / square)
    })
}

/// Where a row leaves a polygon without dents.
fn polygon_ends(corners: &[[f64; 2]], y: f64) -> Option<[f64; 2]> {
    let mut ends = [f64::MAX, f64::MIN];
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        if (a[1] <= y) != (b[1] <= y) {
            let x = a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]);
            ends = [ends[0].min(x), ends[1].max(x)];
        }
    }
    (ends[0] <= ends[1]).then_some(ends)
}

/// The colours of a sphere, by the share of the way from its lit place to its edge: what a
/// radial gradient of SVG has there.
struct Shades([Color; 256]);

impl Shades {
    fn new(stops: [(f64, Color); 4]) -> Self {
        let mut colors = [stops[3].1; 256];
        for (k, color) in colors.iter_mut().enumerate() {
            let share = k as f64 / 255.0;
            if let Some(ends) = stops.windows(2).find(|ends| share < ends[1].0) {
                let part = (share - ends[0].0) / (ends[1].0 - ends[0].0);
                *color = mixed(ends[0].1, ends[1].1, part);
            }
        }
        Self(colors)
    }

    fn at(&self, [x, y]: [f64; 2]) -> Color {
        let off = [x - LIT[0], y - LIT[1]];
        let way = [-LIT[0], -LIT[1]];
        let square = REACH * REACH - way[0] * way[0] - way[1] * way[1];
        let linear = off[0] * way[0] + off[1] * way[1];
        let length = off[0] * off[0] + off[1] * off[1];
        let share = ((linear * linear + square * length).sqrt() - linear) / square;
        self.0[(255.0 * share.min(1.0)) as usize]
    }
}

/// Which items are seen at all, as far as samples tell; all that hide nothing are.
pub fn seen(drawing: &Drawing) -> Vec<bool> {
    /// For each pixel, in either direction, in a picture of usual size.
    const FINE: f64 = 2.0;
    /// The most samples along a side.
    const MOST: f64 = 6000.0;
    let fine = FINE.min(MOST / drawing.width.max(drawing.height));
    let [width, height] = [drawing.width, drawing.height].map(|side| (side * fine).ceil() as usize);
    let mut is_covered = vec![false; width * height];
    let mut seen = vec![true; drawing.items.len()];
    let mut own = Vec::new();
    for (index, item) in drawing.items.iter().enumerate().rev() {
        if !item.hides() {
            continue;
        }
        let bounds = item.bounds();
        // What is smaller than some samples hides little, may lie between them, and closes what
        // is open between others.
        if (bounds[2] - bounds[0]).max(bounds[3] - bounds[1]) * fine < 3.0 {
            let [x, y] = [bounds[0] + bounds[2], bounds[1] + bounds[3]]
                .map(|sum| (0.5 * sum * fine).floor() as i64);
            seen[index] = (0..9).any(|k| {
                let (x, y) = (x - 1 + k % 3, y - 1 + k / 3);
                let is_within = (0..width as i64).contains(&x) && (0..height as i64).contains(&y);
                is_within && !is_covered[y as usize * width + x as usize]
            });
            continue;
        }
        let (mut is_seen, mut has_samples) = (false, false);
        for row in rows_of(bounds, fine, 0, height) {
            let y = (row as f64 + 0.5) / fine;
            let ends = match item {
                Item::Sphere { disc, .. } => disc_ends(disc, y),
                Item::Area { corners, .. } => {
                    let corners: Vec<[f64; 2]> = corners.iter().map(|at| [at.x, at.y]).collect();
                    polygon_ends(&corners, y)
                }
                Item::Line { .. } => None,
            };
            let Some(ends) = ends else { continue };
            let columns = columns(ends, fine, width);
            has_samples |= !columns.is_empty();
            // What is thinner than samples closes what is open beside them.
            let beside = columns.start.saturating_sub(1)..(columns.end + 1).min(width);
            for row in row.saturating_sub(1)..(row + 2).min(height) {
                is_seen |= is_covered[row * width..][beside.clone()].contains(&false);
            }
            own.push((row, columns));
        }
        for (row, columns) in own.drain(..) {
            is_covered[row * width..][columns].fill(true);
        }
        seen[index] = is_seen || !has_samples;
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::super::camera::Place;
    use super::*;

    fn drawing(items: Vec<Item>) -> Drawing {
        let legend = Vec::new();
        Drawing { width: 40.0, height: 40.0, ground: [255; 3], items, legend, words: Vec::new() }
    }

    fn sphere(x: f64, near: f64, half: f64) -> Item {
        let center = Place { x, y: 20.0, near };
        let disc = Disc { center, half: [half; 2], along: [1.0, 0.0] };
        Item::Sphere { disc, color: [200, 40, 40], haze: 0 }
    }

    #[test]
    fn what_is_hidden_is_not_seen() {
        let items = vec![sphere(20.0, 0.0, 5.0), sphere(22.0, 1.0, 10.0), sphere(4.0, 2.0, 2.0)];
        assert_eq!(seen(&drawing(items)), [false, true, true]);
    }

    #[test]
    fn a_disc_has_its_area() {
        let (pixels, size) = pixels(&drawing(vec![sphere(20.0, 0.0, 15.0)]), 1.0);
        assert_eq!(size, (40, 40));
        let colored = pixels.chunks(3).filter(|pixel| *pixel != [255; 3]).count() as f64;
        assert!((colored / (core::f64::consts::PI * 225.0) - 1.0).abs() < 0.06, "{colored}");
        // Lit from the upper left.
        let at = |x: usize, y: usize| u32::from(pixels[3 * (40 * y + x) + 1]);
        assert!(at(15, 13) > at(26, 28), "{} {}", at(15, 13), at(26, 28));
        assert_eq!(pixels[..3], [255; 3]);
    }
}
