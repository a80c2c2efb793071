//! PDF: a canvas on a page of its size.

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Pdf, Rect, Ref};

use super::canvas::{Canvas, Item, Place, Segment};
use super::look::Color;

/// Of a pixel, points of 1/72 inch.
const POINTS: f64 = 0.75;

/// The bytes of the file.
pub(super) fn bytes(canvas: &Canvas) -> Vec<u8> {
    let [catalog, pages, page, content] = [1, 2, 3, 4].map(Ref::new);
    let size = [canvas.size.0, canvas.size.1].map(|length| (length * POINTS) as f32);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let mut of_page = pdf.page(page);
    of_page.media_box(Rect::new(0.0, 0.0, size[0], size[1])).parent(pages).contents(content);
    of_page.resources();
    of_page.finish();
    pdf.stream(content, &drawn(canvas));
    pdf.finish()
}

fn drawn(canvas: &Canvas) -> Vec<u8> {
    let (width, height) = canvas.size;
    let mut page = Content::new();
    // Pixels from the top, in place of points from the bottom.
    let points = POINTS as f32;
    page.transform([points, 0.0, 0.0, -points, 0.0, (height * POINTS) as f32]);
    page.set_line_cap(LineCapStyle::ButtCap).set_line_join(LineJoinStyle::RoundJoin);
    fill(&mut page, canvas.ground).rect(0.0, 0.0, width as f32, height as f32).fill_nonzero();
    for item in &canvas.items {
        // Colours come before the path.
        let is_line = match item {
            Item::Line { width, color, .. } | Item::Circle { width: Some(width), color, .. } => {
                let [red, green, blue] = parts(*color);
                page.set_stroke_rgb(red, green, blue).set_line_width(*width as f32);
                true
            }
            Item::Polygon { color, .. } | Item::Circle { color, .. } => {
                fill(&mut page, *color);
                false
            }
            Item::Text(text) => {
                fill(&mut page, text.color);
                false
            }
        };
        along(&mut page, &item.outline());
        if is_line {
            page.stroke();
        } else {
            page.fill_nonzero();
        }
    }
    page.finish().to_vec()
}

fn parts(color: Color) -> [f32; 3] {
    color.map(|part| f32::from(part) / 255.0)
}

fn fill(page: &mut Content, color: Color) -> &mut Content {
    let [red, green, blue] = parts(color);
    page.set_fill_rgb(red, green, blue)
}

/// Lays a path.
fn along(page: &mut Content, path: &[Segment]) {
    let single = |(x, y): Place| (x as f32, y as f32);
    for segment in path {
        match *segment {
            Segment::Move(at) => {
                let (x, y) = single(at);
                page.move_to(x, y);
            }
            Segment::Line(to) => {
                let (x, y) = single(to);
                page.line_to(x, y);
            }
            Segment::Curve(places) => {
                let [(x1, y1), (x2, y2), (x3, y3)] = places.map(single);
                page.cubic_to(x1, y1, x2, y2, x3, y3);
            }
        }
    }
}
