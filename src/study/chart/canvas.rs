//! Canvas: lines, areas and text on a drawing area, at places in fractions of a pixel.

use plotters::coord::Shift;
use plotters::element::{DashedPathElement, Drawable, PointCollection};
use plotters::prelude::*;
use plotters::style::Color as _;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::look::Color;
use super::text::{CAPITAL, font};
use crate::numbers::array::Each;

/// A place, pixels from the left and from the top.
pub(super) type Place = (f64, f64);

/// What of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// An area that is drawn on, from the back to the front.
pub(super) struct Canvas<B: DrawingBackend> {
    area: DrawingArea<B, Shift>,
    /// Pixels of the area for each one of a place, in either direction.
    fine: f64,
    /// The first thing that could not be drawn; what is drawn later is not seen.
    failed: Option<String>,
}

impl<B: DrawingBackend> Canvas<B> {
    pub fn new(area: DrawingArea<B, Shift>, fine: f64, ground: Color) -> Self {
        let failed = area.fill(&rgb(ground)).err().map(|error| error.to_string());
        Self { area, fine, failed }
    }

    /// Ends the drawing.
    ///
    /// # Errors
    /// If something could not be drawn, as a sentence.
    pub fn finish(self) -> Result<(), String> {
        match self.failed {
            Some(error) => Err(error),
            None => self.area.present().map_err(|error| error.to_string()),
        }
    }

    /// Lines from place to place.
    pub fn line(&mut self, places: &[Place], width: f64, color: Color) {
        if places.len() > 1 {
            let places: Vec<_> = places.iter().map(|&place| self.pixel(place)).collect();
            self.draw(&PathElement::new(places, self.stroke(width, color)));
        }
    }

    /// Dashes and gaps of these lengths along lines from place to place.
    pub fn dashes(&mut self, places: &[Place], [on, off]: [f64; 2], width: f64, color: Color) {
        let places: Vec<_> = places.iter().map(|&place| self.pixel(place)).collect();
        let [on, off] = [on, off].each(|length| self.whole(length));
        let stroke = self.stroke(width, color);
        self.draw(&DashedPathElement::new(places, on, off, stroke));
    }

    pub fn polygon(&mut self, corners: &[Place], color: Color) {
        let corners: Vec<_> = corners.iter().map(|&place| self.pixel(place)).collect();
        self.draw(&Polygon::new(corners, rgb(color).filled()));
    }

    pub fn disc(&mut self, center: Place, radius: f64, color: Color) {
        self.draw(&Circle::new(self.pixel(center), self.whole(radius), rgb(color).filled()));
    }

    pub fn ring(&mut self, center: Place, radius: f64, width: f64, color: Color) {
        let stroke = self.stroke(width, color);
        self.draw(&Circle::new(self.pixel(center), self.whole(radius), stroke));
    }

    /// A text on its base line, in a size of the font in pixels.
    pub fn text(&mut self, text: &str, at: Place, size: f64, anchor: Anchor, color: Color) {
        let side = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let color = rgb(color);
        let style = TextStyle::from(font(size * self.fine)).color(&color);
        let style = style.pos(Pos::new(side, VPos::Center));
        let middle = self.pixel((at.0, at.1 - 0.5 * CAPITAL * size));
        self.draw(&Text::new(text, middle, style));
    }

    /// A text that goes upwards, with the middle of its base line at the place.
    pub fn turned_text(&mut self, text: &str, at: Place, size: f64, color: Color) {
        let font = font(size * self.fine).transform(FontTransform::Rotate270);
        let color = rgb(color);
        let style = TextStyle::from(font).color(&color);
        let style = style.pos(Pos::new(HPos::Center, VPos::Center));
        let middle = self.pixel((at.0 - 0.5 * CAPITAL * size, at.1));
        self.draw(&Text::new(text, middle, style));
    }

    fn draw<'a, E>(&mut self, element: &'a E)
    where
        E: Drawable<B>,
        &'a E: PointCollection<'a, (i32, i32)>,
    {
        if self.failed.is_none() {
            self.failed = self.area.draw(element).err().map(|error| error.to_string());
        }
    }

    fn pixel(&self, (x, y): Place) -> (i32, i32) {
        ((x * self.fine).round() as i32, (y * self.fine).round() as i32)
    }

    fn whole(&self, length: f64) -> i32 {
        (length * self.fine).round() as i32
    }

    fn stroke(&self, width: f64, color: Color) -> ShapeStyle {
        rgb(color).stroke_width(self.whole(width).max(1) as u32)
    }
}

fn rgb([red, green, blue]: Color) -> RGBColor {
    RGBColor(red, green, blue)
}
