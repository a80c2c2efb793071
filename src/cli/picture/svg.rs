//! SVG: a drawing as text.

use core::fmt::Write as _;
use std::collections::BTreeMap;

use carom::study::chart::Color;

use super::drawing::{Anchor, Drawing, Item, LETTERS, LIT, REACH, shades};

/// The text of a drawing.
pub fn text(drawing: &Drawing) -> String {
    let Drawing { width, height, ground, items, legend, words } = drawing;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Verdana, sans-serif\" \
         font-size=\"{LETTERS}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(*ground)
    );
    let mut gradients: BTreeMap<(Color, u8), usize> = BTreeMap::new();
    for item in items.iter().chain(legend) {
        if let Item::Sphere { color, haze, .. } = item {
            let next = gradients.len();
            gradients.entry((*color, *haze)).or_insert(next);
        }
    }
    let by_half = |length: f64| 0.5 + 0.5 * length;
    svg += "<defs>\n";
    for ((color, haze), number) in &gradients {
        let _ = write!(
            svg,
            "<radialGradient id=\"s{number}\" r=\"{}\" fx=\"{}\" fy=\"{}\">",
            short(REACH / 2.0),
            short(by_half(LIT[0])),
            short(by_half(LIT[1]))
        );
        for (share, color) in shades(*color, *haze, *ground) {
            let _ = write!(svg, "<stop offset=\"{share}\" stop-color=\"{}\"/>", hex(color));
        }
        svg += "</radialGradient>\n";
    }
    svg += "</defs>\n";
    for item in items.iter().chain(legend) {
        write_item(&mut svg, item, &gradients);
    }
    for words in words {
        let anchor = match words.anchor {
            Anchor::Start => "",
            Anchor::End => " text-anchor=\"end\"",
        };
        let text = words.text.replace('&', "&amp;").replace('<', "&lt;");
        let [x, y] = words.at.map(short);
        let color = hex(words.color);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" fill=\"{color}\"{anchor}>{text}</text>");
    }
    svg + "</svg>\n"
}

fn write_item(svg: &mut String, item: &Item, gradients: &BTreeMap<(Color, u8), usize>) {
    match item {
        Item::Sphere { disc, color, haze } => {
            let number = gradients.get(&(*color, *haze)).copied().unwrap_or_default();
            let [x, y] = [disc.center.x, disc.center.y].map(short);
            let [a, b] = disc.half;
            if a - b < 0.02 {
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" fill=\"url(#s{number})\"/>",
                    short(a)
                );
            } else {
                // The light stays where it is: turned back within the ellipse.
                let turn = disc.along[1].atan2(disc.along[0]).to_degrees();
                let [turn, back] = [turn, -turn].map(short);
                let [across, down] = [a, b].map(short);
                let _ = writeln!(
                    svg,
                    "<circle r=\"1\" transform=\"translate({x} {y})rotate({turn})scale({across} \
                     {down})rotate({back})\" fill=\"url(#s{number})\"/>"
                );
            }
        }
        Item::Area { corners, color, opacity } => {
            let path = corners.iter().map(|at| format!("{} {}", short(at.x), short(at.y)));
            let path = path.collect::<Vec<_>>().join("L");
            let fill = hex(*color);
            let _ = if *opacity < 1.0 {
                // Without smooth edges, which would show where two areas meet.
                writeln!(
                    svg,
                    "<path d=\"M{path}z\" fill=\"{fill}\" fill-opacity=\"{opacity}\" \
                     shape-rendering=\"crispEdges\"/>"
                )
            } else {
                writeln!(
                    svg,
                    "<path d=\"M{path}z\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\".5\" \
                     stroke-linejoin=\"round\"/>"
                )
            };
        }
        Item::Line { ends: [a, b], width, color, opacity } => {
            let [ax, ay, bx, by] = [a.x, a.y, b.x, b.y].map(short);
            let stroke = hex(*color);
            let opacity = match *opacity {
                1.0 => String::new(),
                opacity => format!(" stroke-opacity=\"{opacity}\""),
            };
            let _ = writeln!(
                svg,
                "<path d=\"M{ax} {ay}L{bx} {by}\" stroke=\"{stroke}\" stroke-width=\"{width}\" \
                 stroke-linecap=\"round\"{opacity}/>"
            );
        }
    }
}

fn hex([red, green, blue]: Color) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A number with two decimals at most.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
