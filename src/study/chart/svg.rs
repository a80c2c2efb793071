//! SVG: a canvas as text.

use core::fmt::Write as _;

use super::canvas::{Anchor, Canvas, Item, Place, Text};
use super::look::Color;
use super::text::FAMILY;

/// The text of the file.
pub(super) fn text(canvas: &Canvas) -> String {
    let [width, height] = [canvas.size.0, canvas.size.1].map(number);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{FAMILY}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(canvas.ground)
    );
    for item in &canvas.items {
        // Writing into a string does not fail.
        let _ = match item {
            Item::Line { places, width, color } => writeln!(
                svg,
                "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" \
                 stroke-linejoin=\"round\" points=\"{}\"/>",
                hex(*color),
                number(*width),
                joined(places)
            ),
            Item::Polygon { corners, color } => {
                let (color, corners) = (hex(*color), joined(corners));
                writeln!(svg, "<polygon fill=\"{color}\" points=\"{corners}\"/>")
            }
            Item::Circle { center, radius, width, color } => {
                let [x, y, r] = [center.0, center.1, *radius].map(number);
                let color = hex(*color);
                let paint = match width {
                    None => format!("fill=\"{color}\""),
                    Some(width) => {
                        let width = number(*width);
                        format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"")
                    }
                };
                writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {paint}/>")
            }
            Item::Text(text) => writeln!(svg, "{}", of_text(text)),
        };
    }
    svg + "</svg>\n"
}

fn of_text(text: &Text) -> String {
    let [x, y, size] = [text.at.0, text.at.1, text.size].map(number);
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let turn = match text.is_turned {
        true => format!(" transform=\"rotate(-90 {x} {y})\""),
        false => String::new(),
    };
    format!(
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
         fill=\"{}\"{turn}>{}</text>",
        hex(text.color),
        escaped(&text.text)
    )
}

fn joined(places: &[Place]) -> String {
    let places = places.iter().map(|(x, y)| format!("{},{}", number(*x), number(*y)));
    places.collect::<Vec<_>>().join(" ")
}

/// To a hundredth of a pixel.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn hex([red, green, blue]: Color) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_the_language_are_escaped() {
        let mut canvas = Canvas::new((10.0, 10.0), [255; 3]);
        canvas.text("a < b & c", (1.0, 2.126), 13.0, Anchor::End, [0, 10, 255]);
        let svg = text(&canvas);
        assert!(svg.contains("a &lt; b &amp; c") && svg.contains("#000aff"), "{svg}");
        assert!(svg.contains("x=\"1\" y=\"2.13\" font-size=\"13\""), "{svg}");
    }
}
