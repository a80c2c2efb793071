//! Newton's cradle of a thousand balls.

use super::case::{Case, Extent, Findings, Studied, Trial, greatest, in_epsilon, trial};
use super::{Figure, StudyError};
use crate::engine::{Execution, World};
use crate::lane::Lane;
use crate::real::Real;
use crate::scene::{EngineKind, Impact};
use crate::scene::{Scene, SceneBuilder, Sphere};
use crate::study::Course;

pub(super) const CASE: Case = Case {
    name: "cradle",
    title: "Newton's cradle of 1,000 balls, pairwise in order",
    law: "Equal balls exchange velocities: as many fly off as came in, as fast, and the others \
          rest; N − k collisions for each of the k that came in, touching or not. Where each has \
          0.99 of the mass of the one before, velocities are products of 2m/(m + m′), right to ε \
          for each collision. Places are right to ε of the length of the row.",
    trials,
    combine: Findings::joined,
    picture: None,
};

/// Of the balls.
const DIAMETER: f64 = 1.0;

/// A row of balls, of which the first ones come in at speed 1.
#[derive(Clone, Copy)]
struct BallRow {
    name: &'static str,
    balls: usize,
    moving: usize,
    gap: f64,
    /// Mass of each, over that of the one before.
    ratio: f64,
    engine: EngineKind,
}

fn trials(extent: Extent) -> Vec<Trial> {
    let row = BallRow {
        name: "",
        balls: extent.of(1_000, 100),
        moving: 1,
        gap: 0.0,
        ratio: 1.0,
        engine: EngineKind::EventDriven,
    };
    let rows = [
        BallRow { name: "touching", ..row },
        BallRow { name: "gaps of 1/10", gap: 0.1, ..row },
        BallRow { name: "ten come in", moving: 10, ..row },
        BallRow { name: "lighter and lighter", ratio: 0.99, ..row },
        BallRow { name: "touching, in steps", engine: EngineKind::Stepped, ..row },
        BallRow { name: "gaps of 1/10, in steps", gap: 0.1, engine: EngineKind::Stepped, ..row },
    ];
    rows.into_iter().flat_map(|row| [cradle::<f32>(row), cradle::<f64>(row)]).collect()
}

fn cradle<T: Studied>(row: BallRow) -> Trial {
    trial::<T, _>(row.name, 0.5, move || {
        let time = row.balls as f64 * row.gap + 4.0;
        let scene = row.scene::<T>()?;
        let masses: Vec<T::Judge> =
            (0..row.balls).map(|k| scene.bodies.mass.of(k).cast()).collect();
        let mut world = World::new(scene, Execution { threads: 1, ..Execution::default() })?;
        let course = Course::new(&world, time);
        course.finish(&mut world, course.length(), None)?;
        let (bodies, is) = (world.bodies(), T::PRECISION);
        let name = |what: &str| format!("{what}, {}", row.name);
        let collisions = row.moving * (row.balls - row.moving);
        let pairs = world.collisions().pairs as f64;
        let mut figures = vec![Figure::equal(is, name("collisions"), pairs, collisions as f64, "")];

        let velocities = row.velocities::<T>(&masses);
        if row.ratio == 1.0 {
            let wrong =
                (0..row.balls).filter(|&k| bodies.velocity_of(k).x.to_f64() != velocities[k].left);
            figures.push(Figure::equal(
                is,
                name("velocities not exact"),
                wrong.count() as f64,
                0.0,
                "",
            ));
            let extent = row.balls as f64 * (DIAMETER + row.gap);
            let off = row
                .positions(world.time())
                .into_iter()
                .enumerate()
                .map(|(k, x)| (bodies.position_of(k).x.to_f64() - x).abs());
            let off = in_epsilon::<T>(greatest(off)) / extent;
            figures.push(Figure::at_most(is, name("places off"), off, 4.0, "ε L"));
        } else {
            // Over the velocity that it was hit with: what it kept of that is a
            // small difference.
            let off = velocities.iter().enumerate().map(|(k, exact)| {
                let error = (bodies.velocity_of(k).x.to_f64() - exact.left).abs();
                error / exact.hit_with
            });
            let off = in_epsilon::<T>(greatest(off)) / (row.balls as f64).sqrt();
            figures.push(Figure::at_most(is, name("velocities off"), off, 4.0, "√N ε"));
        }
        Ok(figures)
    })
}

impl BallRow {
    fn scene<T: Studied>(&self) -> Result<Scene<T>, StudyError> {
        let mut builder: SceneBuilder<T> =
            Scene::builder().engine(self.engine).dt(1.0 / 128.0).impact(Impact::SubStep);
        let mut mass = 1.0;
        for (k, x) in self.start().into_iter().enumerate() {
            let speed = if k < self.moving { 1.0 } else { 0.0 };
            let ball = Sphere::new([x, 0.0, 0.0]).radius(DIAMETER / 2.0).mass(mass);
            builder = builder.sphere(ball.velocity([speed, 0.0, 0.0]));
            mass *= self.ratio;
        }
        Ok(builder.build()?)
    }

    /// Where the balls are at the start.
    fn start(&self) -> Vec<f64> {
        let start = |k: usize| k as f64 * (DIAMETER + self.gap);
        let way = |k: usize| if k < self.moving { DIAMETER } else { 0.0 };
        (0..self.balls).map(|k| start(k) - way(k)).collect()
    }

    /// Where equal balls are at a time: points that pass through each other,
    /// sorted, a diameter apart.
    fn positions(&self, time: f64) -> Vec<f64> {
        let mut points: Vec<f64> = self
            .start()
            .into_iter()
            .enumerate()
            .map(|(k, x)| x - k as f64 * DIAMETER + if k < self.moving { time } else { 0.0 })
            .collect();
        points.sort_by(f64::total_cmp);
        points.iter().enumerate().map(|(k, x)| x + k as f64 * DIAMETER).collect()
    }

    /// How fast they are at the end. Equal balls take all of what they are hit
    /// with and hand it on.
    fn velocities<T: Studied>(&self, masses: &[T::Judge]) -> Vec<Speeds> {
        let mut hit_with = T::Judge::ONE;
        let mut speeds = Vec::new();
        for k in 0..self.balls {
            // None of the last ones is hit any more.
            let next = masses.get(k + self.moving).copied();
            let (kept, given) = match next {
                Some(next) => {
                    let sum = masses[k] + next;
                    ((masses[k] - next) / sum, (masses[k] + masses[k]) / sum)
                }
                None => (T::Judge::ONE, T::Judge::ONE),
            };
            speeds.push(Speeds { hit_with: hit_with.to_f64(), left: (hit_with * kept).to_f64() });
            hit_with = hit_with * given;
        }
        speeds
    }
}

/// Of a ball in its last collision but one, and after that.
struct Speeds {
    hit_with: f64,
    left: f64,
}
