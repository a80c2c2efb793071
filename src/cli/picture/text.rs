//! Text: the words of a legend in pixels.

use std::sync::Once;

use plotters::prelude::{BitMapBackend, Color as _, IntoDrawingArea, RGBColor, Text, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

use super::drawing::{Anchor, LETTERS, Words};

/// The font that comes with the program.
const FAMILY: &str = "DejaVu Sans";

/// What `plotters` takes for the size of a font, and the height of a capital, in sizes.
const LINE: f64 = 1.24;
const CAPITAL: f64 = 0.729;

/// Writes words over pixels, `fine` for each one of theirs in either direction.
pub fn write(
    pixels: &mut [u8],
    size: (u32, u32),
    words: &[Words],
    fine: f64,
) -> Result<(), String> {
    static FONTS: Once = Once::new();
    FONTS.call_once(|| {
        // A font that cannot be read leaves the picture without text.
        let _ = register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular());
    });
    let area = BitMapBackend::with_buffer(pixels, size).into_drawing_area();
    for Words { text, at: [x, y], anchor, color: [red, green, blue] } in words {
        let font =
            FontDesc::new(FontFamily::Name(FAMILY), LETTERS * LINE * fine, FontStyle::Normal);
        let side = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::End => HPos::Right,
        };
        let color = RGBColor(*red, *green, *blue).to_rgba();
        let style = TextStyle::from(font).color(&color).pos(Pos::new(side, VPos::Center));
        let middle = [*x, y - 0.5 * CAPITAL * LETTERS].map(|place| (place * fine).round() as i32);
        let text = Text::new(text.as_str(), (middle[0], middle[1]), style);
        area.draw(&text).map_err(|error| error.to_string())?;
    }
    area.present().map_err(|error| error.to_string())
}
