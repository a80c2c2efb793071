//! Text: the font, and how wide a text is in it.

use std::sync::Once;

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

/// It comes with the program: pictures look the same everywhere. Verdana is as wide, for
/// those who look at an SVG without it.
const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// The height of a capital, of the size of the font.
pub(super) const CAPITAL: f64 = 0.729;

/// What `plotters` takes for the size of a font: of its lines, not of its letters.
const LINE: f64 = 1.24;

/// Text is measured this large, since widths are whole numbers.
const MEASURED: f64 = 1_000.0;

/// The font in a size, pixels.
pub(super) fn font(size: f64) -> FontDesc<'static> {
    static FONTS: Once = Once::new();
    FONTS.call_once(|| {
        // A font that cannot be read leaves the picture without text.
        let _ = register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular());
    });
    FontDesc::new(FontFamily::Name(FAMILY), size * LINE, FontStyle::Normal)
}

/// The width of a text in a size of the font, pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let measured = font(MEASURED).box_size(text).map_or(0, |(width, _)| width);
    f64::from(measured) * size / MEASURED
}

/// The greatest size of the font, up to this one, in which a text takes no more room.
pub(super) fn fitting(text: &str, size: f64, room: f64) -> f64 {
    size * (room / width(text, size)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_has_a_width() {
        assert!(width("mm", 10.0) > 2.0 * width("i", 10.0));
        assert_eq!(width("mm", 20.0), 2.0 * width("mm", 10.0));
        assert!(width("⁷", 10.0) > 0.0);
        let size = fitting("a long title", 15.0, 20.0);
        assert!((width("a long title", size) - 20.0).abs() < 1e-9);
        assert_eq!(fitting("a", 15.0, 200.0), 15.0);
    }
}
