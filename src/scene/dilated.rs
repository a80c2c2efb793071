//! Dilated: the scene of a file with more or fewer bodies, as dense as before.

use super::error::{Problem, SceneError};
use super::file::SceneFile;
use super::generate::cube_root;
use super::raw::{RawPeriodic, RawScene, RawSpheres, Vector, Whole};
use super::settings::MOST_BODIES;
use super::spheres::Arrangement;
use crate::numbers::array::Each;

impl SceneFile {
    /// The same scene with about this many bodies, as dense as before.
    ///
    /// The counts of the groups are multiplied, and all places are dilated about
    /// the origin by the cube root of the same factor: the bounds of the periodic
    /// box and of the groups, positions, and all points of what is fixed.
    /// Radii of bodies, and radii and heights of what is solid or thin, stay; those of
    /// containers do not. A group that fills a cubic lattice, `k³`
    /// bodies or the `4k³` of a face-centred one, goes on to fill one, so the
    /// number may be missed by a few percent. Places that no longer fit are
    /// mistakes when the scene is [built](Self::build).
    ///
    /// The [text](Self::text) stays as it is.
    ///
    /// ```
    /// use carom::scene::SceneFile;
    ///
    /// let file = SceneFile::builtin("hard-sphere-fluid").ok_or("no such scene")?;
    /// let scene = file.with_bodies(500)?.build::<f64>()?;
    /// assert_eq!(scene.bodies.len(), 500);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the scene has no group with a count, or has as many single bodies, or if
    /// there would be more than [`MOST_BODIES`].
    pub fn with_bodies(&self, bodies: u64) -> Result<Self, SceneError> {
        let refused =
            |reason: String| self.origin().error("spheres", Problem::Unscalable { bodies, reason });
        if bodies > MOST_BODIES {
            return Err(refused(format!("a scene has {MOST_BODIES} at most")));
        }
        if self.raw.spheres.iter().any(|raw| raw.file.is_some()) {
            return Err(refused("a file says how many spheres there are".to_owned()));
        }
        let groups = || self.raw.spheres.iter().filter_map(count_of);
        let singles = self.raw.spheres.iter().filter(|raw| raw.position.is_some()).count() as u64;
        let grouped = groups().map(|count| count as f64).sum::<f64>();
        if grouped == 0.0 {
            let reason = "there is no group with a `count` that could be larger or smaller";
            return Err(refused(reason.to_owned()));
        }
        if bodies <= singles {
            return Err(refused(format!("more are needed than the {singles} with a `position`")));
        }
        let wanted = (bodies - singles) as f64 / grouped;
        let mut file = self.clone();
        let mut sizing = None;
        for raw in &mut file.raw.spheres {
            let Some(count) = count_of(raw) else { continue };
            let scaled = scaled(count, raw.arrangement, wanted);
            raw.count = Some(Whole(scaled));
            if raw.number_density.is_some() {
                sizing = Some(scaled as f64 / count as f64);
            }
        }
        let scaled = file.raw.spheres.iter().filter_map(count_of).map(|count| count as f64);
        // The group that sizes a periodic cube says how far that grows.
        let factor = sizing.unwrap_or(scaled.sum::<f64>() / grouped);
        file.raw.dilate(cube_root(factor));
        Ok(file)
    }
}

/// How many bodies a group has; `None` for a single body, and for a group of
/// none, which is a mistake.
fn count_of(raw: &RawSpheres) -> Option<u64> {
    raw.count.map(|Whole(count)| count).filter(|&count| count > 0 && raw.position.is_none())
}

/// A count, multiplied; a full lattice stays full.
fn scaled(count: u64, arrangement: Option<Arrangement>, factor: f64) -> u64 {
    let in_cell = match arrangement {
        Some(Arrangement::Fcc) => 4,
        Some(Arrangement::Cubic) => 1,
        Some(Arrangement::Random) | None => return multiplied(count, factor),
    };
    let cells = |bodies: f64| cube_root(bodies / in_cell as f64).round().max(1.0) as u64;
    let lattice = |side: u64| side.saturating_pow(3).saturating_mul(in_cell);
    if lattice(cells(count as f64)) == count {
        lattice(cells(count as f64 * factor))
    } else {
        multiplied(count, factor)
    }
}

fn multiplied(count: u64, factor: f64) -> u64 {
    (count as f64 * factor).round().max(1.0) as u64
}

impl RawScene {
    /// Moves every point away from the origin by this factor.
    fn dilate(&mut self, factor: f64) {
        let dilate = |point: &mut Option<Vector>| {
            if let Some(Vector(point)) = point {
                *point = point.each(|component| component * factor);
            }
        };
        if let Some(RawPeriodic::Box(bounds)) = &mut self.periodic {
            dilate(&mut bounds.lower);
            dilate(&mut bounds.upper);
        }
        for raw in &mut self.surroundings {
            raw.dilate(factor);
        }
        for spheres in &mut self.spheres {
            dilate(&mut spheres.position);
            dilate(&mut spheres.lower);
            dilate(&mut spheres.upper);
        }
    }
}
