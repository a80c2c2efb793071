//! Text: how wide it is, and the outlines of its letters.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, OutlineCurve, Point};

use super::canvas::Segment;

/// It comes with the program: pictures look the same everywhere. Verdana is as wide, for
/// those who look at an SVG without it.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// The height of a capital, of the size of the font.
pub(super) const CAPITAL: f64 = 0.729;

/// A font that cannot be read leaves a picture without text.
static FONT: LazyLock<Option<FontRef<'static>>> =
    LazyLock::new(|| FontRef::try_from_slice(dejavu::sans::regular()).ok());

/// Letters in a row, in units of the font.
struct Row {
    font: &'static FontRef<'static>,
    /// Each with its place from the start.
    letters: Vec<(char, f64)>,
    end: f64,
    /// Of the font, pixels.
    unit: f64,
}

impl Row {
    fn of(text: &str, size: f64) -> Option<Self> {
        let font = FONT.as_ref()?;
        let unit = size / f64::from(font.units_per_em()?);
        let (mut letters, mut end, mut before) = (Vec::new(), 0.0, None);
        for letter in text.chars() {
            let glyph = font.glyph_id(letter);
            if let Some(before) = before.replace(glyph) {
                end += f64::from(font.kern_unscaled(before, glyph));
            }
            letters.push((letter, end));
            end += f64::from(font.h_advance_unscaled(glyph));
        }
        Some(Self { font, letters, end, unit })
    }
}

/// The width of a text in a size of the font, pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    Row::of(text, size).map_or(0.0, |row| row.end * row.unit)
}

/// The greatest size of the font, up to this one, in which a text takes no more room.
pub(super) fn fitting(text: &str, size: f64, room: f64) -> f64 {
    size * (room / width(text, size)).min(1.0)
}

/// The outlines of a text that starts at the origin, closed, downwards positive, pixels.
pub(super) fn outlines(text: &str, size: f64) -> Vec<Segment> {
    let Some(Row { font, letters, unit, .. }) = Row::of(text, size) else { return Vec::new() };
    let mut segments = Vec::new();
    for (letter, start) in letters {
        let Some(outline) = font.outline(font.glyph_id(letter)) else { continue };
        let place =
            |point: Point| ((start + f64::from(point.x)) * unit, -f64::from(point.y) * unit);
        let mut end = None;
        for curve in outline.curves {
            let (from, to) = match curve {
                OutlineCurve::Line(from, to)
                | OutlineCurve::Quad(from, _, to)
                | OutlineCurve::Cubic(from, _, _, to) => (from, to),
            };
            if end != Some(from) {
                segments.push(Segment::Move(place(from)));
            }
            end = Some(to);
            segments.push(match curve {
                OutlineCurve::Line(..) => Segment::Line(place(to)),
                OutlineCurve::Quad(_, middle, _) => {
                    let third = |end: Point| {
                        let (a, b) = (place(end), place(middle));
                        (a.0 + (b.0 - a.0) * 2.0 / 3.0, a.1 + (b.1 - a.1) * 2.0 / 3.0)
                    };
                    Segment::Curve([third(from), third(to), place(to)])
                }
                OutlineCurve::Cubic(_, a, b, _) => Segment::Curve([place(a), place(b), place(to)]),
            });
        }
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_has_a_width_and_outlines() {
        assert!(width("mm", 10.0) > 2.0 * width("i", 10.0));
        assert_eq!(width("mm", 20.0), 2.0 * width("mm", 10.0));
        let size = fitting("a long title", 15.0, 20.0);
        assert!((width("a long title", size) - 20.0).abs() < 1e-9);
        assert_eq!(fitting("a", 15.0, 200.0), 15.0);
        // Of an i two contours, of a superscript one; none leaves the line.
        let contours = |text: &str| {
            let moves = |segment: &&Segment| matches!(segment, Segment::Move(_));
            outlines(text, 10.0).iter().filter(moves).count()
        };
        assert_eq!([contours("i"), contours("⁷"), contours(" ")], [2, 1, 0]);
    }
}
