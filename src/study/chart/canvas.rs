//! Canvas: what a picture is made of, in whatever format it is written.

use super::look::Color;
use super::text;

/// A place, pixels from the left and from the top.
pub(super) type Place = (f64, f64);

/// What is drawn, from the back to the front.
#[derive(Debug)]
pub(super) struct Canvas {
    /// Width and height, pixels.
    pub size: (f64, f64),
    /// Behind everything.
    pub ground: Color,
    pub items: Vec<Item>,
}

/// A piece of it.
#[derive(Debug)]
pub(super) enum Item {
    /// Lines from place to place.
    Line { places: Vec<Place>, width: f64, color: Color },
    /// An area.
    Polygon { corners: Vec<Place>, color: Color },
    /// A circle, as a line of this width, or filled.
    Circle { center: Place, radius: f64, width: Option<f64>, color: Color },
    /// A line of text.
    Text(Text),
}

/// A line of text.
#[derive(Debug)]
pub(super) struct Text {
    pub text: String,
    /// On its base line, at its anchor.
    pub at: Place,
    /// The font's, pixels.
    pub size: f64,
    pub anchor: Anchor,
    /// It goes upwards.
    pub is_turned: bool,
    pub color: Color,
}

/// What of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    pub fn new(size: (f64, f64), ground: Color) -> Self {
        Self { size, ground, items: Vec::new() }
    }

    pub fn line(&mut self, places: &[Place], width: f64, color: Color) {
        if places.len() > 1 {
            self.items.push(Item::Line { places: places.to_vec(), width, color });
        }
    }

    /// Dashes and gaps of these lengths along lines from place to place.
    pub fn dashes(&mut self, places: &[Place], [on, off]: [f64; 2], width: f64, color: Color) {
        let (mut dash, mut is_on, mut left) = (Vec::new(), true, on);
        dash.extend(places.first());
        for pair in places.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            let mut done = 0.0;
            while length - done > left {
                done += left;
                let share = done / length;
                let at = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
                if is_on {
                    dash.push(at);
                    self.line(&dash, width, color);
                }
                is_on = !is_on;
                left = if is_on { on } else { off };
                dash = vec![at];
            }
            left -= length - done;
            dash.push(to);
        }
        if is_on {
            self.line(&dash, width, color);
        }
    }

    pub fn polygon(&mut self, corners: Vec<Place>, color: Color) {
        self.items.push(Item::Polygon { corners, color });
    }

    pub fn circle(&mut self, center: Place, radius: f64, width: Option<f64>, color: Color) {
        self.items.push(Item::Circle { center, radius, width, color });
    }

    pub fn text(&mut self, text: &str, at: Place, size: f64, anchor: Anchor, color: Color) {
        let text = text.to_owned();
        self.items.push(Item::Text(Text { text, at, size, anchor, is_turned: false, color }));
    }

    /// A text that goes upwards, with its middle at the place.
    pub fn turned_text(&mut self, text: &str, at: Place, size: f64, color: Color) {
        let (text, anchor) = (text.to_owned(), Anchor::Middle);
        self.items.push(Item::Text(Text { text, at, size, anchor, is_turned: true, color }));
    }
}

/// A piece of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) enum Segment {
    Move(Place),
    Line(Place),
    /// Two places that it is drawn to, and its end (Bézier).
    Curve([Place; 3]),
}

impl Item {
    /// The path that is filled or, of a line or a ring, drawn along.
    pub fn outline(&self) -> Vec<Segment> {
        match self {
            Self::Line { places, .. } | Self::Polygon { corners: places, .. } => {
                let mut places = places.iter().copied();
                let start = places.next().map(Segment::Move);
                start.into_iter().chain(places.map(Segment::Line)).collect()
            }
            Self::Circle { center, radius, .. } => circle(*center, *radius),
            Self::Text(text) => text.outlines(),
        }
    }
}

/// The outline of a circle, closed; off by less than 0.03 % of its radius.
fn circle((x, y): Place, radius: f64) -> Vec<Segment> {
    /// Of four arcs.
    const ARM: f64 = 0.552_284_75;
    let at = |u: f64, v: f64| (x + radius * u, y + radius * v);
    let mut path = vec![Segment::Move(at(1.0, 0.0))];
    let (mut u, mut v) = (1.0, 0.0);
    for _ in 0..4 {
        let (s, t) = (-v, u);
        path.push(Segment::Curve([
            at(u + ARM * s, v + ARM * t),
            at(s + ARM * u, t + ARM * v),
            at(s, t),
        ]));
        (u, v) = (s, t);
    }
    path
}

impl Text {
    /// The outlines of its letters.
    pub fn outlines(&self) -> Vec<Segment> {
        let start = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * text::width(&self.text, self.size),
            Anchor::End => -text::width(&self.text, self.size),
        };
        let place = |(x, y): Place| match self.is_turned {
            false => (self.at.0 + start + x, self.at.1 + y),
            true => (self.at.0 + y, self.at.1 - start - x),
        };
        let segments = text::outlines(&self.text, self.size).into_iter();
        let placed = segments.map(|segment| match segment {
            Segment::Move(at) => Segment::Move(place(at)),
            Segment::Line(to) => Segment::Line(place(to)),
            Segment::Curve(places) => Segment::Curve(places.map(place)),
        });
        placed.collect()
    }
}
