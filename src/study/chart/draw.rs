//! Draw: charts on a canvas.

use plotters::prelude::DrawingBackend;

use super::axis::{Divided, Tick};
use super::canvas::{Anchor, Canvas, Place};
use super::look::{Color, Look};
use super::text::{CAPITAL, fitting, width};
use super::{Chart, Mark, Picture, Series, Shape};
use crate::numbers::array::Each;

/// Sizes of the font, pixels: of titles, what an axis shows, its numbers, the legend, and
/// the names of guides.
const TITLE: f64 = 15.0;
const LABEL: f64 = 14.0;
const NUMBER: f64 = 13.0;
const NAME: f64 = 13.0;
const REMARK: f64 = 11.0;

/// Around a chart, pixels.
const MARGIN: f64 = 10.0;

/// From one thing to the next, pixels.
const GAP: f64 = 6.0;

/// Of the small line beside a number, pixels.
const TICK: f64 = 4.0;

/// Of an entry of the legend before its name, and behind it, pixels.
const BEFORE: f64 = 32.0;
const BEHIND: f64 = 14.0;

/// Of a line of the legend, pixels.
const ROW: f64 = 19.0;

/// Radius of a marker, and of a ring around it, pixels.
const MARKER: f64 = 3.6;
const RING: f64 = 7.0;

/// A line of more points than this need not have a marker at each.
const MANY: usize = 40;

/// Room for a number, across and upwards, pixels.
const ROOM: [f64; 2] = [50.0, 30.0];

impl Picture {
    /// Width and height, pixels.
    pub(super) fn size(&self, look: &Look) -> (f64, f64) {
        let columns = self.rows().map(<[Chart]>::len).max().unwrap_or(1).max(1);
        let height: f64 = self.rows().map(|row| row_height(row, look)).sum();
        (f64::from(look.width) * columns as f64, height.max(1.0))
    }

    /// Draws all of it.
    pub(super) fn draw<B: DrawingBackend>(&self, canvas: &mut Canvas<B>, look: &Look) {
        let mut top = 0.0;
        for row in self.rows() {
            for (column, chart) in row.iter().enumerate() {
                let corner = (column as f64 * f64::from(look.width), top);
                chart.draw(canvas, corner, look);
            }
            top += row_height(row, look);
        }
    }

    /// The charts that stand side by side.
    fn rows(&self) -> impl Iterator<Item = &[Chart]> {
        self.charts.chunks(if self.charts.len() > 3 { 2 } else { 3 })
    }
}

fn row_height(row: &[Chart], look: &Look) -> f64 {
    let legends = row.iter().map(|chart| Legend::of(chart, look).height());
    look.height() + legends.fold(0.0, f64::max)
}

/// Where the points of a chart are, and how many pixels are between the ends of its axes.
struct Field {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: Divided,
    y: Divided,
}

impl Field {
    fn across(&self, share: f64) -> f64 {
        self.left + share * (self.right - self.left)
    }

    fn up(&self, share: f64) -> f64 {
        self.bottom + share * (self.top - self.bottom)
    }

    /// Where a point is, if it can be shown.
    fn place(&self, &(a, b): &(f64, f64)) -> Option<Place> {
        Some((self.across(self.x.share(a)?), self.up(self.y.share(b)?)))
    }
}

impl Chart {
    /// Draws it below and to the right of a corner.
    fn draw<B: DrawingBackend>(&self, canvas: &mut Canvas<B>, corner: Place, look: &Look) {
        let field = self.field(corner, look);
        self.draw_axes(canvas, &field, corner, look);
        for series in &self.series {
            series.draw(canvas, &field, look);
        }
        let below = (corner.0, corner.1 + look.height());
        Legend::of(self, look).draw(canvas, below, look);
    }

    fn field(&self, (x, y): Place, look: &Look) -> Field {
        let values = |pick: fn(&(f64, f64)) -> f64| {
            let series = self.series.iter().filter(|series| series.mark != Mark::Guide);
            series.flat_map(|series| &series.points).map(pick)
        };
        let across = Divided::new(&self.x, values(|point| point.0));
        let up = Divided::new(&self.y, values(|point| point.1));
        let top = y + MARGIN + TITLE + 2.0 * GAP;
        let bottom = y + look.height() - MARGIN - LABEL - NUMBER - TICK - 2.0 * GAP;
        let numbers = up.ticks(most(bottom - top, ROOM[1]));
        let widest = numbers.iter().map(|tick| width(&tick.label, NUMBER)).fold(0.0, f64::max);
        Field {
            left: x + MARGIN + LABEL + widest + TICK + 2.0 * GAP,
            right: x + f64::from(look.width) - MARGIN - 2.0 * GAP,
            top,
            bottom,
            x: across,
            y: up,
        }
    }

    fn draw_axes<B: DrawingBackend>(
        &self,
        canvas: &mut Canvas<B>,
        field: &Field,
        corner: Place,
        look: &Look,
    ) {
        let Field { left, right, top, bottom, .. } = *field;
        let (ink, faint, line) = (look.ink(1.0), look.ink(0.1), look.ink(0.6));
        let down = NUMBER * CAPITAL;
        let mut reached = f64::MIN;
        for Tick { share, label } in field.x.ticks(most(right - left, ROOM[0])) {
            let x = field.across(share);
            canvas.line(&[(x, top), (x, bottom)], 1.0, faint);
            canvas.line(&[(x, bottom), (x, bottom + TICK)], 1.0, line);
            let half = 0.5 * width(&label, NUMBER);
            // Numbers that would touch the one before are left out.
            if x - half > reached {
                let at = (x, bottom + TICK + GAP + down);
                canvas.text(&label, at, NUMBER, Anchor::Middle, ink);
                reached = x + half + GAP;
            }
        }
        for Tick { share, label } in field.y.ticks(most(bottom - top, ROOM[1])) {
            let y = field.up(share);
            canvas.line(&[(left, y), (right, y)], 1.0, faint);
            canvas.line(&[(left - TICK, y), (left, y)], 1.0, line);
            canvas.text(&label, (left - TICK - GAP, y + down / 2.0), NUMBER, Anchor::End, ink);
        }
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        canvas.line(&corners, 1.0, line);
        // Beyond these lines is nothing but 0.
        if let Some(x) = field.x.edge_of_zero().map(|share| field.across(share)) {
            canvas.line(&[(x, top), (x, bottom)], 1.0, line);
        }
        if let Some(y) = field.y.edge_of_zero().map(|share| field.up(share)) {
            canvas.line(&[(left, y), (right, y)], 1.0, line);
        }
        let whole = f64::from(look.width) - 2.0 * MARGIN;
        let size = fitting(&self.title, TITLE, whole);
        let at = (corner.0 + MARGIN + 0.5 * whole, corner.1 + MARGIN + TITLE * CAPITAL);
        canvas.text(&self.title, at, size, Anchor::Middle, ink);
        let middle = 0.5 * (left + right);
        let room = 2.0 * (right + 2.0 * GAP - middle);
        let size = fitting(&self.x.label, LABEL, room);
        let at = (middle, corner.1 + look.height() - MARGIN);
        canvas.text(&self.x.label, at, size, Anchor::Middle, ink);
        // A long one has the whole height below the title.
        let (upper, lower) = (top - GAP, corner.1 + look.height() - MARGIN);
        let size = fitting(&self.y.label, LABEL, lower - upper);
        let half = 0.5 * width(&self.y.label, size);
        let y = (0.5 * (top + bottom)).clamp(upper + half, (lower - half).max(upper + half));
        canvas.turned_text(&self.y.label, (corner.0 + MARGIN + LABEL * CAPITAL, y), size, ink);
    }
}

/// How many numbers an axis of this length has room for.
fn most(length: f64, room: f64) -> usize {
    ((length / room) as usize).max(2)
}

impl Series {
    fn draw<B: DrawingBackend>(&self, canvas: &mut Canvas<B>, field: &Field, look: &Look) {
        let color = look.color(self.color);
        let places: Vec<Place> =
            self.points.iter().filter_map(|point| field.place(point)).collect();
        match self.mark {
            Mark::Markers => {}
            Mark::Line | Mark::LineAndMarkers => canvas.line(&places, 1.6, color),
            Mark::Dashes => canvas.dashes(&places, [6.0, 4.0], 1.6, color),
            Mark::Rings => {
                for &place in &places {
                    canvas.ring(place, RING, 1.4, color);
                }
            }
            Mark::Guide => {
                canvas.dashes(&places, [2.5, 3.5], 1.0, look.ink(0.5));
                if let Some(&(x, y)) = places.last() {
                    let at = (x - 2.0, y - 4.0);
                    canvas.text(&self.name, at, REMARK, Anchor::End, look.ink(0.65));
                }
            }
        }
        for [from, to] in &self.bars {
            if let Some((from, to)) = field.place(from).zip(field.place(to)) {
                canvas.line(&[from, to], 1.0, color);
            }
        }
        if self.has_markers() {
            // On a line of many points, those that would hide the one before have no marker.
            let is_dense = self.mark == Mark::LineAndMarkers && places.len() > MANY;
            let mut shown: Option<Place> = None;
            for place in places {
                let is_hidden =
                    shown.is_some_and(|(x, y)| (place.0 - x).hypot(place.1 - y) < 2.5 * MARKER);
                if !(is_dense && is_hidden) {
                    self.shape.draw(canvas, place, color);
                    shown = Some(place);
                }
            }
        }
    }

    fn has_markers(&self) -> bool {
        matches!(self.mark, Mark::LineAndMarkers | Mark::Markers)
    }
}

impl Shape {
    /// A marker of this shape; all have about the same area.
    fn draw<B: DrawingBackend>(self, canvas: &mut Canvas<B>, (x, y): Place, color: Color) {
        match self {
            Self::Disc => canvas.disc((x, y), MARKER, color),
            Self::Square => {
                let half = 0.9 * MARKER;
                let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
                canvas.polygon(&corners.each(|(u, v)| (x + u, y + v)), color);
            }
            Self::Triangle => {
                let (side, up) = (1.2 * MARKER, 1.3 * MARKER);
                let corners = [(0.0, -up), (side, 0.7 * up), (-side, 0.7 * up)];
                canvas.polygon(&corners.each(|(u, v)| (x + u, y + v)), color);
            }
        }
    }
}

/// What each series is called: below the chart, where it hides nothing. As many entries as
/// have room stand side by side.
struct Legend<'a> {
    series: Vec<&'a Series>,
    columns: usize,
    entry: f64,
}

impl<'a> Legend<'a> {
    fn of(chart: &'a Chart, look: &Look) -> Self {
        let is_named = |series: &&Series| !series.name.is_empty() && series.mark != Mark::Guide;
        let series: Vec<&Series> = chart.series.iter().filter(is_named).collect();
        let longest = series.iter().map(|series| width(&series.name, NAME)).fold(0.0, f64::max);
        let whole = f64::from(look.width) - 2.0 * MARGIN;
        let columns = (whole / (BEFORE + longest + BEHIND)) as usize;
        let columns = columns.clamp(1, series.len().max(1));
        Self { series, columns, entry: whole / columns as f64 }
    }

    fn height(&self) -> f64 {
        let rows = self.series.len().div_ceil(self.columns) as f64;
        if rows > 0.0 { rows * ROW + MARGIN } else { 0.0 }
    }

    fn draw<B: DrawingBackend>(&self, canvas: &mut Canvas<B>, corner: Place, look: &Look) {
        for (k, series) in self.series.iter().enumerate() {
            let (column, row) = ((k % self.columns) as f64, (k / self.columns) as f64);
            let (x, y) = (corner.0 + MARGIN + column * self.entry, corner.1 + (row + 0.5) * ROW);
            let color = look.color(series.color);
            let line = [(x, y), (x + 24.0, y)];
            match series.mark {
                Mark::Line | Mark::LineAndMarkers => canvas.line(&line, 1.6, color),
                Mark::Dashes => canvas.dashes(&line, [6.0, 3.0], 1.6, color),
                Mark::Rings => canvas.ring((x + 12.0, y), RING, 1.4, color),
                Mark::Markers | Mark::Guide => {}
            }
            if series.has_markers() {
                series.shape.draw(canvas, (x + 12.0, y), color);
            }
            let room = self.entry - BEFORE;
            let size = fitting(&series.name, NAME, room);
            let at = (x + BEFORE, y + NAME * CAPITAL / 2.0);
            canvas.text(&series.name, at, size, Anchor::Start, look.ink(1.0));
        }
    }
}
