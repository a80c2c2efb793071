//! Film: the frames of a page, as many of them as it has room for.

use std::collections::HashMap;

use carom::Vec3;
use carom::output::quaternion_of;

use crate::cli::shown::{Bounds, Moment, Scenery, around, joined};

/// The most species that have a colour each.
const MOST_KINDS: usize = 64;

/// The greatest whole number of two bytes, which stands for 1.
const ONE: f64 = 32_767.0;

/// Bytes of a page for each three of data, as base64.
const WRITTEN: [u64; 2] = [4, 3];

/// The spheres of a frame, in columns.
pub struct Frame {
    pub time: Option<f64>,
    /// From the origin of the film, three numbers each.
    pub positions: Vec<f32>,
    /// Quaternions x, y, z, w; `None` where none is turned.
    pub turns: Option<Vec<i16>>,
    pub speeds: Vec<f32>,
    pub radii: Vec<f32>,
    pub kinds: Vec<u8>,
}

impl Frame {
    pub fn count(&self) -> usize {
        self.speeds.len()
    }
}

/// A film under way. Where it has no room any more, every second frame is left out.
pub struct Film {
    pub frames: Vec<Frame>,
    /// What places are counted from, length.
    pub origin: Vec3<f64>,
    /// The box around all spheres of all frames.
    pub spheres: Option<Bounds>,
    /// Of how many frames one is kept.
    every: u64,
    /// How many there were.
    passed: u64,
    most_bytes: u64,
    most_frames: u64,
    /// How many spheres the frames have together.
    bodies: u64,
    has_turns: bool,
    varies: bool,
    kinds: HashMap<[u64; 2], u8>,
}

/// A frame has no room by itself.
pub struct TooLarge {
    /// What it takes.
    pub bytes: u64,
}

impl Film {
    /// One whose data take up to this many bytes of a page.
    pub fn new(most_bytes: u64) -> Self {
        Self {
            frames: Vec::new(),
            origin: Vec3::ZERO,
            spheres: None,
            every: 1,
            passed: 0,
            most_bytes,
            most_frames: u64::MAX,
            bodies: 0,
            has_turns: false,
            varies: false,
            kinds: HashMap::new(),
        }
    }

    /// Keeps no more frames than this, if there is a bound.
    pub fn keep_at_most(&mut self, frames: Option<u64>) {
        self.most_frames = frames.map_or(u64::MAX, |frames| frames.saturating_add(1));
    }

    /// Says whether spheres may come and go, and others take their places.
    pub fn comes_and_goes(&mut self, comes_and_goes: bool) {
        self.varies = comes_and_goes;
    }

    /// Adds the next frame, if it is one of those that are kept.
    pub fn add(&mut self, scenery: &Scenery, moment: Moment) {
        let number = self.passed;
        self.passed += 1;
        if let Some(bounds) = around(&moment.bodies) {
            self.spheres = Some(self.spheres.map_or(bounds, |before| joined(before, bounds)));
        }
        if number == 0 {
            self.origin = origin(scenery.whole(self.spheres));
        }
        if !number.is_multiple_of(self.every) {
            return;
        }
        let frame = self.frame(&moment);
        self.bodies += frame.count() as u64;
        self.has_turns |= frame.turns.is_some();
        self.varies |= self.frames.first().is_some_and(|first| first.radii != frame.radii);
        self.frames.push(frame);
        while self.frames.len() > 1
            && (self.bytes() > self.most_bytes || self.frames.len() as u64 > self.most_frames)
        {
            self.every *= 2;
            let mut number = 0;
            self.frames.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.bodies = self.frames.iter().map(|frame| frame.count() as u64).sum();
        }
    }

    fn frame(&mut self, moment: &Moment) -> Frame {
        let bodies = &moment.bodies;
        let all = 0..bodies.len();
        let positions = all.clone().flat_map(|k| {
            let place = bodies.position_of(k) - self.origin;
            place.to_array().map(|component| component as f32)
        });
        let positions = positions.collect();
        let turns = bodies.orientation.is_some().then(|| {
            let turns = all.clone().flat_map(|k| {
                let [w, x, y, z] = quaternion_of(bodies, k);
                [x, y, z, w].map(|component| (component * ONE).round() as i16)
            });
            turns.collect()
        });
        let kinds = all.clone().map(|k| {
            let figures = [bodies.radius.of(k), bodies.mass.of(k)].map(f64::to_bits);
            let next = self.kinds.len().min(MOST_KINDS) as u8;
            if usize::from(next) == MOST_KINDS {
                return self.kinds.get(&figures).copied().unwrap_or(next);
            }
            *self.kinds.entry(figures).or_insert(next)
        });
        let kinds = kinds.collect();
        Frame {
            time: moment.time,
            positions,
            turns,
            speeds: all.clone().map(|k| bodies.velocity_of(k).length() as f32).collect(),
            radii: all.map(|k| bodies.radius.of(k) as f32).collect(),
            kinds,
        }
    }

    /// The bytes of a page that the frames take.
    fn bytes(&self) -> u64 {
        let turns = if self.has_turns { 8 } else { 0 };
        let own = if self.varies { 5 } else { 0 };
        let [written, data] = WRITTEN;
        self.bodies * (13 + turns + own) * written / data
    }

    /// Whether any sphere is turned.
    pub fn has_turns(&self) -> bool {
        self.has_turns
    }

    /// Whether frames are not of the same spheres throughout.
    pub fn varies(&self) -> bool {
        self.varies
    }

    /// The film with all of its frames.
    pub fn finished(mut self) -> Result<Self, TooLarge> {
        let bytes = self.bytes();
        if bytes > self.most_bytes {
            return Err(TooLarge { bytes });
        }
        if self.kinds.len() >= MOST_KINDS {
            // There are no colours for as many.
            self.frames.iter_mut().for_each(|frame| frame.kinds.fill(0));
        }
        Ok(self)
    }

    /// How many frames there are, and of how many.
    pub fn described(&self) -> String {
        let count = self.frames.len();
        let most = self.frames.iter().map(Frame::count).max().unwrap_or(0);
        let spheres = if most == 1 { "sphere" } else { "spheres" };
        let frames = if count == 1 { "frame" } else { "frames" };
        let thinned = match self.every {
            1 => String::new(),
            every => format!(", one of each {every}"),
        };
        format!("{count} {frames}{thinned}, {most} {spheres}")
    }
}

/// What places are counted from: 0, unless f32 would round them by what is seen.
fn origin([lower, upper]: Bounds) -> Vec3<f64> {
    let middle = (lower + upper) * 0.5;
    if middle.length() > 1e3 * (upper - lower).length() { middle } else { Vec3::ZERO }
}

#[cfg(test)]
mod tests {
    use carom::Bodies;

    use super::*;

    fn film(frames: usize, most_bytes: u64) -> Film {
        let scenery =
            Scenery { name: String::new(), shapes: Vec::new(), space: None, up: Vec3::ZERO };
        let mut film = Film::new(most_bytes);
        for k in 0..frames {
            let bodies = Bodies::from_positions(&[[k as f64, 0.1, 0.0]; 3]).radius(0.5).build();
            film.add(&scenery, Moment { time: Some(k as f64), bodies: bodies.unwrap() });
        }
        film
    }

    #[test]
    fn frames_are_thinned_until_they_have_room() {
        // A frame of three spheres takes 52 bytes.
        let whole = film(9, 9 * 52).finished().ok().unwrap();
        assert_eq!(whole.described(), "9 frames, 3 spheres");
        let thinned = film(9, 8 * 52).finished().ok().unwrap();
        assert_eq!(thinned.described(), "5 frames, one of each 2, 3 spheres");
        let times: Vec<_> = thinned.frames.iter().filter_map(|frame| frame.time).collect();
        assert_eq!(times, [0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(thinned.spheres.unwrap()[1].x, 8.5);
        assert_eq!(thinned.frames[1].positions[..3], [2.0, 0.1, 0.0]);
        assert_eq!(film(1, 51).finished().err().unwrap().bytes, 52);
    }

    #[test]
    fn far_away_places_are_counted_from_there() {
        let at = |x: f64| [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 1.0, 1.0)];
        assert_eq!(origin(at(100.0)), Vec3::ZERO);
        assert_eq!(origin(at(1e5)).x, 1e5 + 0.5);
    }
}
