//! `carom picture`: a still picture of spheres and what is fixed around them.

mod camera;
mod drawing;
mod paint;
mod parts;
mod raster;
mod svg;
mod text;

use std::path::PathBuf;

use carom::Vec3;
use carom::output::write_whole;
use carom::study::chart::{Format, Look, pdf_of, png_of};

use super::arguments::PictureArguments;
use super::failure::Failure;
use super::outline::surfaces;
use super::output_file::{Destination, OutputError};
use super::shown::{Bounds, Looks, Moment, Scenery, Subject, around, frames, run_scene, state};
use camera::Camera;
use drawing::{Drawing, HAZES, Item, Layer};
use paint::{LEGEND, Paint};
use parts::Parts;

pub use paint::ColorBy;

/// From the front, from one side and from above, where up is along z.
const FROM: [f64; 3] = [0.42, -0.84, 0.34];

/// Room around what is drawn, pixels.
const MARGIN: f64 = 16.0;

/// The most things that are drawn as text of their own.
const MOST_IN_TEXT: usize = 200_000;

/// Draws a scene, a state or a frame.
pub fn picture(arguments: &PictureArguments) -> Result<(), Failure> {
    let subject = Subject::of(&arguments.scene)?;
    let output = match &arguments.output {
        Some(output) => output.clone(),
        None => PathBuf::from(subject.name() + ".svg"),
    };
    let shown = output.display();
    let format = Format::of(&output).ok_or_else(|| {
        Failure::Argument(format!("-o is {shown}; its ending must be .svg, .png or .pdf"))
    })?;
    let target = Destination::replaceable("-o", &output)?;
    let unfit = |reason: String| {
        let source = OutputError::Path { path: output.clone(), reason };
        Failure::Open { option: "-o", source }
    };
    if !format.is_built() {
        return Err(unfit(pdf_of("").err().unwrap_or_default()));
    }
    let (scenery, moment) = moment(&subject, arguments)?;
    let look = arguments.pictures.look();
    let drawing = drawn(&scenery, &moment, arguments, &look);
    let bytes = match format {
        Format::Png => {
            /// For fine screens.
            const FINE: f64 = 2.0;
            let drawing = without_hidden(drawing);
            let (mut pixels, size) = raster::pixels(&drawing, FINE);
            text::write(&mut pixels, size, &drawing.words, FINE)
                .and_then(|()| png_of(&pixels, size))
        }
        Format::Svg | Format::Pdf => {
            let drawing = without_hidden(drawing);
            let count = drawing.items.len();
            if count > MOST_IN_TEXT {
                return Err(Failure::Argument(format!(
                    "-o is {shown}: {count} spheres and areas are seen, and this format has a line \
                     for each; give it the ending .png"
                )));
            }
            let text = svg::text(&drawing);
            if format == Format::Pdf { pdf_of(&text) } else { Ok(text.into_bytes()) }
        }
    };
    let written = write_whole(&target, &bytes.map_err(unfit)?);
    written.map_err(|source| OutputError::Write { path: output.clone(), source }.into())
}

/// What is drawn: of a scene its start or a time after it, of frames the last one or the first
/// one from a time on.
fn moment(subject: &Subject, arguments: &PictureArguments) -> Result<(Scenery, Moment), Failure> {
    let at = arguments.scene.duration;
    let mut found = None;
    let scenery = match subject {
        Subject::State(path) => {
            if at.is_some() {
                let path = path.display();
                return Err(Failure::Argument(format!("--at: {path} is the state at one time")));
            }
            return state(path);
        }
        Subject::Scene(file) => {
            let looks = Looks::At(at.unwrap_or(0.0));
            let execution = arguments.scene.execution();
            Some(run_scene(file, execution, looks, &mut |_, moment| found = Some(moment))?)
        }
        Subject::Frames(path) => {
            let mut is_there = false;
            let scenery = frames(path, &mut |_, moment| {
                is_there = at.is_some_and(|at| moment.time.is_some_and(|time| time >= at));
                found = Some(moment);
                !is_there
            })?;
            if let Some(at) = at.filter(|_| !is_there && found.is_some()) {
                let path = path.display();
                return Err(Failure::Argument(format!(
                    "--at is {at:?}: no frame of {path} has that time or a later one"
                )));
            }
            scenery
        }
    };
    scenery.zip(found).ok_or_else(|| {
        Failure::Argument(format!("{} has no frame, which could be drawn", subject.name()))
    })
}

/// The picture.
fn drawn(scenery: &Scenery, moment: &Moment, arguments: &PictureArguments, look: &Look) -> Drawing {
    let bodies = &moment.bodies;
    let within = scenery.whole(around(bodies));
    let up = arguments.up.map_or(scenery.up, Vec3::from);
    let from = arguments.from.map_or_else(|| usual(up), Vec3::from);
    let camera = Camera::new(within, from, up, arguments.perspective);
    let triangles = surfaces(&scenery.shapes, within);
    let paint = Paint::new(bodies, arguments.color, look);
    let has_legend = paint.has_legend() && !arguments.no_legend;

    let mut corners = [[f64::MAX; 2], [f64::MIN; 2]];
    let mut reach = |x: f64, y: f64, more: [f64; 2]| {
        corners[0] = [corners[0][0].min(x - more[0]), corners[0][1].min(y - more[1])];
        corners[1] = [corners[1][0].max(x + more[0]), corners[1][1].max(y + more[1])];
    };
    for k in 0..bodies.len() {
        let disc = camera.disc(bodies.position_of(k), bodies.radius.of(k));
        reach(disc.center.x, disc.center.y, [disc.half[0]; 2]);
    }
    let frame = scenery.space.map(|space| [space.lower, space.upper]);
    let frame = frame.into_iter().flat_map(corners_of);
    for point in
        triangles.iter().flat_map(|(_, triangles)| triangles).flatten().copied().chain(frame)
    {
        let place = camera.place(point);
        reach(place.x, place.y, [0.0; 2]);
    }
    if corners[0][0] > corners[1][0] {
        // There is nothing to be seen.
        corners = [[-1.0; 2], [1.0; 2]];
    }
    let width = f64::from(look.width);
    let (camera, height) = camera.fitted(corners, width, MARGIN);

    let mut items = Vec::new();
    let centers = parts::some_of((0..bodies.len()).map(|k| bodies.position_of(k)));
    // As small as spheres, for the order of both to be right.
    let size = (within[1] - within[0]).length();
    let piece = typical_radius(bodies).min(0.02 * size).max(4.0 / camera.scale());
    let parts = Parts { camera: &camera, look, within, centers, piece };
    for (shape, triangles) in &triangles {
        parts.draw(shape, triangles, &mut items);
    }
    if let Some(space) = &scenery.space {
        parts.draw_box(space, &mut items);
    }
    let discs: Vec<_> = (0..bodies.len())
        .map(|k| camera.disc(bodies.position_of(k), bodies.radius.of(k)))
        .collect();
    let nears = discs.iter().map(|disc| disc.center.near);
    let [far, near] = nears.fold([f64::MAX, f64::MIN], |[a, b], it| [a.min(it), b.max(it)]);
    // Few spheres behind each other need no haze.
    let deep = ((near - far) / (12.0 * typical_radius(bodies))).min(1.0);
    for (k, disc) in discs.into_iter().enumerate() {
        let share = if near > far { (near - disc.center.near) / (near - far) } else { 0.0 };
        let haze = (share * deep * f64::from(HAZES - 1)).round() as u8;
        let near = disc.center.near;
        items.push((Layer::Between, near, Item::Sphere { disc, color: paint.color(k), haze }));
    }
    items.retain(|(_, _, item)| !item.is_tiny());
    items.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let items = items.into_iter().map(|(_, _, item)| item).collect();
    let (legend, words) =
        if has_legend { paint.legend([width, height], look) } else { (Vec::new(), Vec::new()) };
    let height = if has_legend { height + LEGEND } else { height };
    Drawing { width, height, ground: look.ground(), items, legend, words }
}

/// The direction that scenes are seen from, about what is up.
fn usual(up: Vec3<f64>) -> Vec3<f64> {
    let up = up * (1.0 / up.length());
    let [right, front, height] = FROM;
    // What is in front where z is up, turned as little as may be.
    let front_of =
        if up.y.abs() < 0.7 { Vec3::new(0.0, 1.0, 0.0) } else { Vec3::new(0.0, 0.0, -1.0) };
    let side = front_of.cross(up);
    let side = side * (1.0 / side.length());
    side * right + up.cross(side) * front + up * height
}

/// The corners of a box.
fn corners_of(bounds: Bounds) -> [Vec3<f64>; 8] {
    core::array::from_fn(|k| {
        let pick = |bit: usize| bounds[k >> bit & 1];
        Vec3::new(pick(0).x, pick(1).y, pick(2).z)
    })
}

/// The middle one of the radii.
fn typical_radius(bodies: &carom::Bodies<f64>) -> f64 {
    let mut radii: Vec<f64> = (0..bodies.len()).map(|k| bodies.radius.of(k)).collect();
    radii.sort_by(f64::total_cmp);
    radii.get(radii.len() / 2).copied().unwrap_or(1.0)
}

/// The drawing without what is hidden in it.
fn without_hidden(mut drawing: Drawing) -> Drawing {
    let seen = raster::seen(&drawing);
    let mut seen = seen.into_iter();
    drawing.items.retain(|_| seen.next().unwrap_or(true));
    drawing
}
