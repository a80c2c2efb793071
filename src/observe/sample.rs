//! Sample: what is measured of a scene in motion at one time.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::{Energy, Images, Momentum, Temperature, collision_rate, compressibility, total_mass};
use crate::bodies::Bodies;
use crate::compensated::CompensatedSum;
use crate::engine::{Collisions, Exchange, PartTotals, World};
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// What is measured of a world at one time. Rates and the pressure are of the time
/// between two samples.
///
/// ```
/// use carom::engine::World;
/// use carom::observe::Sample;
/// use carom::{Execution, SceneFile};
///
/// let scene = SceneFile::builtin("hard-sphere-fluid").ok_or("no such scene")?.build::<f64>()?;
/// let volume: f64 = scene.periodic.ok_or("no box")?.sides().to_array().iter().product();
/// let mut world = World::new(scene, Execution::default())?;
/// let start = Sample::of(&world, &world.bodies(), None);
/// world.advance(0.05)?;
/// let end = Sample::of(&world, &world.bodies(), None);
/// assert!(end.pressure_since(&start, volume) > Some(0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Sample {
    /// Time since the start.
    pub time: f64,
    /// How many bodies there are.
    pub bodies: usize,
    /// The energy.
    pub energy: Energy,
    /// The momentum, mass × length per time.
    pub momentum: Momentum,
    /// The temperatures, energy; `None` for fewer than two bodies.
    pub temperature: Option<Temperature>,
    /// The centre of mass, length: of a periodic space that of the bodies as they have
    /// moved, through the faces of the box.
    pub center: [f64; 3],
    /// Collisions since the start.
    pub collisions: Collisions,
    /// `Σ σ|J_n|` over the pair collisions since the start, mass × length² per time.
    pub virial: f64,
    /// The impulse of the surroundings since the start, mass × length per time.
    pub impulse: [f64; 3],
    /// What the parts of the surroundings that are counted apart have done since the start,
    /// in the order of the scene.
    pub parts: Vec<PartTotals>,
    /// What has come and gone by the scene since the start.
    pub exchange: Exchange,
}

impl Sample {
    /// What there is to measure now. `bodies` are the world's own, `images` the boxes of
    /// a periodic space that they have moved through.
    #[must_use]
    pub fn of<T: Real>(world: &World<T>, bodies: &Bodies<T>, images: Option<&Images<T>>) -> Self {
        Self {
            time: world.time(),
            bodies: bodies.len(),
            energy: Energy::of(bodies, world.gravity()),
            momentum: Momentum::of(bodies),
            temperature: Temperature::of(bodies),
            center: center(bodies, images),
            collisions: world.collisions(),
            virial: world.virial(),
            impulse: world.impulse_from_surroundings(),
            parts: world.parts(),
            exchange: world.exchange(),
        }
    }

    /// Time since an earlier sample; `None` if there was none.
    pub(crate) fn elapsed(&self, earlier: &Self) -> Option<f64> {
        Some(self.time - earlier.time).filter(|elapsed| *elapsed > 0.0)
    }

    /// Collisions with others per body and time since an earlier sample
    /// ([`collision_rate`]).
    #[must_use]
    pub fn rate_since(&self, earlier: &Self) -> Option<f64> {
        let pairs = self.collisions.pairs - earlier.collisions.pairs;
        if self.bodies == 0 {
            return None;
        }
        Some(collision_rate(self.bodies, pairs, self.elapsed(earlier)?))
    }

    /// Collisions with the surroundings per time since an earlier sample.
    #[must_use]
    pub fn surroundings_rate_since(&self, earlier: &Self) -> Option<f64> {
        let count = self.collisions.surroundings - earlier.collisions.surroundings;
        Some(count as f64 / self.elapsed(earlier)?)
    }

    /// The force of the surroundings on the bodies since an earlier sample, in the mean.
    #[must_use]
    pub fn force_since(&self, earlier: &Self) -> Option<[f64; 3]> {
        let elapsed = self.elapsed(earlier)?;
        Some(array::from_fn(|k| (self.impulse[k] - earlier.impulse[k]) / elapsed))
    }

    /// What a part of the surroundings has done since the start, if it is counted apart.
    #[must_use]
    pub fn part(&self, part: u32) -> Option<&PartTotals> {
        let place = self.parts.binary_search_by_key(&part, |totals| totals.part);
        place.ok().map(|place| &self.parts[place])
    }

    /// The mean translational temperature since an earlier sample, by both ends.
    fn temperature_since(&self, earlier: &Self) -> Option<f64> {
        let [before, now] = [earlier.temperature?, self.temperature?];
        Some(0.5 * (before.translational + now.translational))
    }

    /// The compressibility factor since an earlier sample, in a periodic box
    /// ([`compressibility`]).
    #[must_use]
    pub fn compressibility_since(&self, earlier: &Self) -> Option<f64> {
        let virial = self.virial - earlier.virial;
        let temperature = self.temperature_since(earlier)?;
        Some(compressibility(self.bodies, virial, temperature, self.elapsed(earlier)?))
    }

    /// The pressure since an earlier sample, `p = Z N kT / V`, in a periodic box of this
    /// volume.
    #[must_use]
    pub fn pressure_since(&self, earlier: &Self, volume: f64) -> Option<f64> {
        let temperature = self.temperature_since(earlier)?;
        Some(self.compressibility_since(earlier)? * self.bodies as f64 * temperature / volume)
    }
}

/// `Σ m c / Σ m`.
fn center<T: Real>(bodies: &Bodies<T>, images: Option<&Images<T>>) -> [f64; 3] {
    let mut sums = [CompensatedSum::default(); 3];
    let sides = images.map_or([0.0; 3], Images::sides);
    for index in 0..bodies.len() {
        let mass = bodies.mass.of(index).to_f64();
        let crossed = images.map_or([0; 3], |images| images.of(index));
        let place = bodies.position_of(index).cast::<f64>().to_array();
        for (axis, sum) in sums.iter_mut().enumerate() {
            sum.add(mass * (place[axis] + sides[axis] * f64::from(crossed[axis])));
        }
    }
    let mass = total_mass(bodies);
    // Without bodies there is no centre to tell.
    if bodies.is_empty() { [0.0; 3] } else { sums.each(|sum| sum.value() / mass) }
}
