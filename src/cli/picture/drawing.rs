//! Drawing: what a picture is made of, from the back to the front.

use carom::study::chart::Color;

use super::camera::{Disc, Place};

/// Something that is drawn in one colour.
#[derive(Clone, Debug)]
pub enum Item {
    /// A sphere, shaded: its colour, and how much of it is lost in the haze.
    Sphere { disc: Disc, color: Color, haze: u8 },
    /// A polygon without dents.
    Area { corners: Vec<Place>, color: Color, opacity: f64 },
    /// A line.
    Line { ends: [Place; 2], width: f64, color: Color, opacity: f64 },
}

/// Levels of haze, from none on.
pub const HAZES: u8 = 10;

/// Parts of a picture, each drawn over those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Walls with all spheres in front of them, and their edges.
    Back,
    /// Spheres, and what may stand between them.
    Between,
    /// What all spheres are behind: seen through.
    Front,
}

/// A picture.
pub struct Drawing {
    pub width: f64,
    pub height: f64,
    pub ground: Color,
    /// What is drawn, from the back to the front.
    pub items: Vec<Item>,
    /// Below the picture, drawn over it.
    pub legend: Vec<Item>,
    pub words: Vec<Words>,
}

/// A text of a legend, from its start, middle or end on its base line.
pub struct Words {
    pub text: String,
    pub at: [f64; 2],
    pub anchor: Anchor,
    pub color: Color,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    End,
}

/// The size of letters, pixels.
pub const LETTERS: f64 = 13.0;

/// What a sphere of a colour looks like from its lit place to its edge: shares of a way, and
/// the colours there.
pub fn shades(color: Color, haze: u8, ground: Color) -> [(f64, Color); 4] {
    const LIGHTS: [(f64, f64); 4] = [(0.0, 1.5), (0.38, 1.04), (0.8, 0.7), (1.0, 0.45)];
    let hazy = 0.5 * f64::from(haze) / f64::from(HAZES - 1);
    LIGHTS.map(|(share, light)| (share, mixed(lit(color, light), ground, hazy)))
}

/// A colour that is darker, or lighter from 1 up.
pub fn lit(color: Color, light: f64) -> Color {
    if light > 1.0 { mixed(color, [255; 3], light - 1.0) } else { mixed([0; 3], color, light) }
}

/// From one colour so far to another.
pub fn mixed(from: Color, to: Color, share: f64) -> Color {
    let mix = |k: usize| {
        let [a, b] = [from[k], to[k]].map(f64::from);
        (a + (b - a) * share).round().clamp(0.0, 255.0) as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// Where the light on a sphere is, from its middle, in radii.
pub const LIT: [f64; 2] = [-0.3, -0.42];

/// How far around the lit place its colours go, in radii.
pub const REACH: f64 = 1.08;

impl Item {
    /// The corners of the box around it.
    pub fn bounds(&self) -> [f64; 4] {
        let around = |places: &[Place], more: f64| {
            places.iter().fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |[l, t, r, b], place| {
                let (x, y) = (place.x, place.y);
                [l.min(x - more), t.min(y - more), r.max(x + more), b.max(y + more)]
            })
        };
        match self {
            Self::Sphere { disc, .. } => around(&[disc.center], disc.half[0]),
            Self::Area { corners, .. } => around(corners, 0.0),
            Self::Line { ends, width, .. } => around(ends, width / 2.0),
        }
    }

    /// Whether it is too short to be seen.
    pub fn is_tiny(&self) -> bool {
        /// Pixels.
        const TINY: f64 = 0.3;
        let [left, top, right, bottom] = self.bounds();
        match self {
            Self::Sphere { .. } | Self::Area { .. } => false,
            Self::Line { width, .. } => (right - left).max(bottom - top) - width < TINY,
        }
    }

    /// Whether it hides what is behind it.
    pub fn hides(&self) -> bool {
        match self {
            Self::Sphere { .. } => true,
            Self::Area { opacity, .. } => *opacity >= 1.0,
            Self::Line { .. } => false,
        }
    }
}
