//! Images: through how many whole boxes a body has moved.
//!
//! An engine keeps bodies inside the periodic box. Between two looks that are close
//! enough, no body moves through half a side, so that the shorter way is the one it
//! took.

use crate::bodies::{Bodies, Columns3};
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::vec3::Vec3;

/// What part of the shortest side the fastest body may move through from one look to
/// the next. Half a side would do for bodies that keep their speed; a collision can
/// double one, and two can double it again.
const REACH: f64 = 0.125;

/// The whole boxes that each body of a periodic space has moved through, by looks at
/// the bodies on the way.
///
/// ```
/// use carom::observe::Images;
/// use carom::space::PeriodicBox;
/// use carom::Bodies;
///
/// let at = |x| {
///     let (place, velocity) = ([[x, 1.0, 1.0]], [[2.0, 0.0, 0.0]]);
///     Bodies::from_positions(&place).velocities(&velocity).radius(0.5).build()
/// };
/// let start = at(3.5)?;
/// let mut images = Images::new(PeriodicBox::new([0.0; 3], [4.0; 3]), &start);
/// assert_eq!(images.next_look(&start, [0.0; 3].into()), 0.25);
/// images.look(&at(0.25)?);
/// assert_eq!(images.of(0), [1, 0, 0]);
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Images<T: Real> {
    space: PeriodicBox<T>,
    seen: Columns3<T>,
    crossed: Vec<[i32; 3]>,
}

impl<T: Real> Images<T> {
    /// All bodies are in the box that they start in.
    #[must_use]
    pub fn new(space: PeriodicBox<T>, bodies: &Bodies<T>) -> Self {
        Self { space, seen: bodies.position.clone(), crossed: vec![[0; 3]; bodies.len()] }
    }

    /// Looks at the bodies again.
    pub fn look(&mut self, bodies: &Bodies<T>) {
        let sides = self.space.sides().to_array();
        for (axis, side) in sides.into_iter().enumerate() {
            let half = side * T::from_f64(0.5);
            let ways = self.seen[axis].iter_mut().zip(bodies.position[axis].iter());
            for ((seen, &now), crossed) in ways.zip(&mut self.crossed) {
                let way = now - *seen;
                if way < -half {
                    crossed[axis] += 1;
                } else if way > half {
                    crossed[axis] -= 1;
                }
                *seen = now;
            }
        }
    }

    /// The time after which the bodies are to be looked at again.
    #[must_use]
    pub fn next_look(&self, bodies: &Bodies<T>, gravity: Vec3<T>) -> f64 {
        let sides = self.space.sides().cast::<f64>().to_array();
        let reach = REACH * sides.into_iter().fold(f64::INFINITY, f64::min);
        let speed = greatest_speed(bodies);
        let pull = gravity.cast::<f64>().length();
        if pull == 0.0 {
            return reach / speed;
        }
        // vt + gt²/2 = reach, in the form that does not cancel.
        2.0 * reach / (speed + (speed * speed + 2.0 * pull * reach).sqrt())
    }

    /// The same with what was counted before `bodies` were where they are.
    ///
    /// # Panics
    /// If there are not as many counts as bodies.
    #[must_use]
    pub fn after(self, crossed: Vec<[i32; 3]>) -> Self {
        assert_eq!(crossed.len(), self.crossed.len(), "counts for other bodies");
        Self { crossed, ..self }
    }

    /// What was counted for each body.
    #[must_use]
    pub fn counts(&self) -> &[[i32; 3]] {
        &self.crossed
    }

    /// The sides of the box, length.
    #[must_use]
    pub fn sides(&self) -> [f64; 3] {
        self.space.sides().cast().to_array()
    }

    /// The whole boxes that a body has moved through along each axis.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn of(&self, index: usize) -> [i32; 3] {
        self.crossed[index]
    }
}

/// The speed of the fastest body.
fn greatest_speed<T: Real>(bodies: &Bodies<T>) -> f64 {
    let speeds = (0..bodies.len()).map(|index| bodies.velocity_of(index).cast::<f64>());
    speeds.map(|velocity| velocity.length_squared()).fold(0.0, f64::max).sqrt()
}
