//! Deviation: how far a state is from what it should be.

use serde::{Deserialize, Serialize};

use super::invariants::Invariants;
use super::norm::Norm;
use crate::bodies::Bodies;
use crate::engine::World;
use crate::lane::Lane;
use crate::mat3::Mat3;
use crate::real::{DoubleDouble, Real};
use crate::space::{PeriodicBox, Space};
use crate::vec3::Vec3;

/// A trajectory is lost where bodies are off by this part of the greatest radius:
/// it is chance then which bodies meet next.
pub const LOST: f64 = 0.1;

/// What a state should be: that of a world of a finer precision.
#[derive(Clone, Debug)]
pub struct Truth<T: Real = DoubleDouble> {
    /// When, in the scene's unit of time.
    pub time: f64,
    /// All bodies.
    pub bodies: Bodies<T>,
    /// What they amount to.
    pub invariants: Invariants,
    gravity: Vec3<DoubleDouble>,
    periodic: Option<PeriodicBox<DoubleDouble>>,
    /// The potential energy that bodies can fall through.
    fall: f64,
}

/// How far each body is from what it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Of the centres, length.
    pub position: Vec<f64>,
    /// Of the velocities, length per time.
    pub velocity: Vec<f64>,
    /// Of the orientations, rad.
    pub orientation: Vec<f64>,
}

/// How far a state is from what it should be. Of bodies, the root of the mean
/// square over all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Of the centres, length.
    pub position: f64,
    /// Of the centre that is farthest off, length.
    pub position_worst: f64,
    /// Of the velocities, length per time.
    pub velocity: f64,
    /// Of the orientations, rad.
    pub orientation: f64,
    /// Of the energy, see [`Invariants::change_since`]; its sign is kept.
    pub energy: f64,
    /// Of the momentum, as above, of the sum of all momenta.
    pub momentum: f64,
    /// Of the angular momentum, as above, of the sum of all angular momenta.
    pub angular_momentum: f64,
}

impl<T: Real> Truth<T> {
    /// The present state of a world, in this field and this box, where bodies fall
    /// through this potential energy ([`fall_energy`](crate::observe::fall_energy)).
    #[must_use]
    pub fn of(
        world: &World<T>,
        gravity: Vec3<T>,
        periodic: Option<PeriodicBox<T>>,
        fall: f64,
    ) -> Self {
        let gravity = gravity.cast::<DoubleDouble>();
        let bounds = |corner: Vec3<T>| corner.cast::<DoubleDouble>().to_array();
        let periodic =
            periodic.map(|space| PeriodicBox::new(bounds(space.lower), bounds(space.upper)));
        let bodies = world.bodies();
        let invariants = Invariants::of(&bodies, gravity);
        Self { time: world.time(), bodies, invariants, gravity, periodic, fall }
    }

    /// How far each body of a world that should be here is from it.
    #[must_use]
    pub fn errors<U: Real>(&self, bodies: &Bodies<U>) -> Errors {
        let of_each = |distance: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..bodies.len().min(self.bodies.len())).map(distance).collect()
        };
        let position = of_each(&|index| {
            let should = self.bodies.position_of(index).cast::<DoubleDouble>();
            let difference = bodies.position_of(index).cast::<DoubleDouble>() - should;
            let nearest = self.periodic.map_or(difference, |space| space.nearest(difference));
            nearest.length().high()
        });
        let velocity = of_each(&|index| {
            let should = self.bodies.velocity_of(index).cast::<DoubleDouble>();
            (bodies.velocity_of(index).cast::<DoubleDouble>() - should).length().high()
        });
        let orientation = of_each(&|index| {
            angle_between(bodies.orientation_of(index), self.bodies.orientation_of(index))
        });
        Errors { position, velocity, orientation }
    }

    /// How far the bodies of a world that should be here are from it.
    #[must_use]
    pub fn deviation<U: Real>(&self, bodies: &Bodies<U>) -> Deviation {
        self.deviation_of(bodies, &self.errors(bodies))
    }

    /// The same where the errors of each of these bodies are known.
    #[must_use]
    pub fn deviation_of<U: Real>(&self, bodies: &Bodies<U>, errors: &Errors) -> Deviation {
        let invariants = Invariants::of(bodies, self.gravity);
        let [energy, momentum, angular_momentum] =
            invariants.change_since(&self.invariants, self.fall);
        Deviation {
            position: Norm::RootMeanSquare.of(&errors.position),
            position_worst: Norm::Maximum.of(&errors.position),
            velocity: Norm::RootMeanSquare.of(&errors.velocity),
            orientation: Norm::RootMeanSquare.of(&errors.orientation),
            energy,
            momentum,
            angular_momentum,
        }
    }
}

impl Deviation {
    /// Whether all of it is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let Self { position, position_worst, velocity, orientation, .. } = *self;
        let Self { energy, momentum, angular_momentum, .. } = *self;
        [position, position_worst, velocity, orientation, energy, momentum, angular_momentum]
            .into_iter()
            .all(f64::is_finite)
    }
}

/// The angle of the rotation between two orientations, rad: of the distance of
/// their matrices, `‖A − B‖ = 2√2 sin(angle/2)`, which is good for small angles
/// too. What a matrix lacks of a rotation counts as an angle.
fn angle_between<T: Real, U: Real>(is: Mat3<U>, should: Mat3<T>) -> f64 {
    let elements = is.rows().into_iter().zip(should.rows());
    let squares = elements.map(|(is, should)| {
        let difference = is.cast::<DoubleDouble>() - should.cast::<DoubleDouble>();
        difference * difference
    });
    let distance = squares.fold(DoubleDouble::ZERO, |sum, square| sum + square).high().sqrt();
    2.0 * (distance / 8.0_f64.sqrt()).min(1.0).asin()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::motion::rotation::turned;

    #[test]
    fn angles_of_any_size() {
        let axis = Vec3::new(0.0, 0.6, -0.8);
        for angle in [1e-30, 1e-17, 1e-9, 0.5, 3.0] {
            let spin = axis.cast::<DoubleDouble>();
            let should = turned(Mat3::IDENTITY, spin, DoubleDouble::from_f64(angle));
            assert_relative_eq!(
                angle_between(Mat3::<f64>::IDENTITY, should),
                angle,
                max_relative = 1e-12
            );
        }
    }
}
