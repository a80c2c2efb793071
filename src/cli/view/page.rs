//! Page: the text of a film, with its script and its data.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use carom::Vec3;
use serde_json::json;

use super::film::{Film, Frame};
use crate::cli::outline::{self, MOST_WITH_EDGES, Triangle, edges, is_wall, surfaces};
use crate::cli::shown::Scenery;

const HTML: &str = include_str!("view.html");
const SCRIPT: &str = include_str!("view.js");

/// The page of a film. Its data are columns of little-endian numbers, as base64, which the
/// header describes.
pub fn page(scenery: &Scenery, film: &Film) -> String {
    let bounds = scenery.whole(film.spheres);
    let fixed = Fixed::of(scenery, bounds);
    let varies = film.varies();
    // Of what stays the same one frame is enough.
    let own: &[Frame] =
        if varies { &film.frames } else { film.frames.get(..1).unwrap_or_default() };
    let from_origin = |point: Vec3<f64>| (point - film.origin).to_array();
    let times: Option<Vec<f64>> = film.frames.iter().map(|frame| frame.time).collect();
    let counts: Vec<usize> = film.frames.iter().map(Frame::count).collect();
    let fastest = film.frames.iter().flat_map(|frame| &frame.speeds).copied().fold(0.0, f32::max);
    let header = json!({
        "name": scenery.name,
        "counts": counts,
        "times": times,
        "origin": film.origin.to_array(),
        "bounds": bounds.map(from_origin),
        "box": scenery.space.map(|space| [space.lower, space.upper].map(from_origin)),
        "up": scenery.up.to_array(),
        "turns": film.has_turns(),
        "varies": varies,
        "fastest": fastest,
        "faces": fixed.faces.each_ref().map(Vec::len),
        "edges": fixed.edges.len(),
    });
    let floats = |values: &mut dyn Iterator<Item = f32>| -> Vec<u8> {
        values.flat_map(f32::to_le_bytes).collect()
    };
    let points = |points: &mut dyn Iterator<Item = Vec3<f64>>| {
        floats(&mut points.flat_map(|point| from_origin(point).map(|component| component as f32)))
    };
    let mut data = String::new();
    let mut add = |id: &str, bytes: Vec<u8>| {
        data += &format!("<script type=\"text/plain\" id=\"{id}\">");
        STANDARD.encode_string(bytes, &mut data);
        data += "</script>\n";
    };
    let all = || film.frames.iter();
    add("positions", floats(&mut all().flat_map(|frame| &frame.positions).copied()));
    if film.has_turns() {
        add("turns", all().flat_map(turns).flat_map(i16::to_le_bytes).collect());
    }
    add(
        "speeds",
        all().flat_map(|frame| &frame.speeds).map(|speed| share(*speed, fastest)).collect(),
    );
    add("radii", floats(&mut own.iter().flat_map(|frame| &frame.radii).copied()));
    add("kinds", own.iter().flat_map(|frame| &frame.kinds).copied().collect());
    add("faces", points(&mut fixed.faces.iter().flatten().flatten().copied()));
    add("edges", points(&mut fixed.edges.iter().flatten().copied()));
    filled(&scenery.name, &header.to_string(), &data)
}

/// Quaternions of a frame; of one in which nothing is turned yet, those of no turn.
fn turns(frame: &Frame) -> Vec<i16> {
    let none = || [0, 0, 0, i16::MAX].repeat(frame.count());
    frame.turns.clone().unwrap_or_else(none)
}

/// A share of the greatest speed in a byte, by its root: most are slow.
fn share(speed: f32, fastest: f32) -> u8 {
    if fastest > 0.0 { (255.0 * (speed / fastest).sqrt()).round() as u8 } else { 0 }
}

/// The page with its parts in their places.
fn filled(name: &str, header: &str, data: &str) -> String {
    let title = name.replace('&', "&amp;").replace('<', "&lt;");
    // A text in a script must not end it.
    let header = header.replace('<', "\\u003c");
    let parts = [
        ("{{title}}", title.as_str()),
        ("{{header}}", &header),
        ("{{data}}", data),
        ("{{script}}", SCRIPT),
    ];
    let length = parts.iter().map(|(_, part)| part.len()).sum::<usize>();
    let mut page = String::with_capacity(HTML.len() + length);
    let mut rest = HTML;
    for (place, part) in parts {
        if let Some((before, after)) = rest.split_once(place) {
            page += before;
            page += part;
            rest = after;
        }
    }
    page + rest
}

/// What does not move.
struct Fixed {
    /// Walls about spheres, what stands among them, what is thin, and what only counts.
    faces: [Vec<Triangle>; 4],
    edges: Vec<[Vec3<f64>; 2]>,
}

impl Fixed {
    fn of(scenery: &Scenery, bounds: [Vec3<f64>; 2]) -> Self {
        let mut fixed = Self { faces: [const { Vec::new() }; 4], edges: Vec::new() };
        for (shape, triangles) in surfaces(&scenery.shapes, bounds) {
            if triangles.len() <= MOST_WITH_EDGES {
                let normals: Vec<Vec3<f64>> = triangles.iter().map(outline::normal).collect();
                let sharp = edges(&triangles).into_iter().filter(|edge| edge.is_sharp(&normals));
                fixed.edges.extend(sharp.map(|edge| edge.ends));
            }
            let kind = match () {
                () if shape.is_sensor() => 3,
                () if shape.is_thin() => 2,
                () if is_wall(shape) => 0,
                () => 1,
            };
            fixed.faces[kind].extend(triangles);
        }
        if let Some(space) = &scenery.space {
            let corner = |k: usize| {
                let pick = |bit: usize| if k >> bit & 1 == 0 { space.lower } else { space.upper };
                Vec3::new(pick(0).x, pick(1).y, pick(2).z)
            };
            let ends = (0..8_usize).flat_map(|k| [1, 2, 4].map(|bit| (k, k | bit)));
            fixed.edges.extend(ends.filter(|(a, b)| a != b).map(|(a, b)| [corner(a), corner(b)]));
        }
        fixed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_cannot_leave_its_place() {
        let page = filled("a</title><b>", "{\"name\":\"</script>\"}", "");
        assert!(page.contains("<title>a&lt;/title>&lt;b></title>"));
        assert!(page.contains("\\u003c/script>") && !page.contains("{{"));
    }
}
