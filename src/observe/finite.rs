//! Finite: whether a state consists of numbers, and whether they say what they
//! should.

use core::fmt;

use crate::bodies::Bodies;
use crate::real::Real;

/// A figure of a body that is infinite or no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite {
    /// The body.
    pub body: usize,
    /// What of it.
    pub what: &'static str,
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} of body {} is no longer finite", self.what, self.body)
    }
}

/// The first figure of a state that is infinite or no number: what leaves an
/// engine is a result only if there is none.
///
/// ```
/// use carom::Bodies;
/// use carom::observe::not_finite;
///
/// let balls = Bodies::from_positions(&[[0.0; 3], [2.0, 0.0, 0.0]]);
/// let mut balls = balls.velocities(&[[1e200; 3]; 2]).radius(0.5).build()?;
/// assert_eq!(not_finite(&balls), None);
/// balls.scale_motion(1e200);
/// let found = not_finite(&balls).map(|found| found.to_string());
/// assert_eq!(found.as_deref(), Some("the velocity of body 0 is no longer finite"));
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn not_finite<T: Real>(bodies: &Bodies<T>) -> Option<NotFinite> {
    let vectors = [
        ("position", bodies.position.as_slice()),
        ("velocity", bodies.velocity.as_slice()),
        ("spin", bodies.spin.as_slice()),
        ("orientation", bodies.orientation.as_deref().map_or(&[], |columns| columns.as_slice())),
    ];
    let columns = vectors.iter().flat_map(|(what, columns)| columns.iter().map(|c| (*what, c)));
    let found = columns.filter_map(|(what, column)| {
        let body = column.iter().position(|value| !value.is_finite())?;
        Some(NotFinite { body, what })
    });
    found.min_by_key(|found| found.body)
}

/// A figure of a body that the precision is too coarse for: it is a number, but
/// has no digit that means something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unresolved {
    /// Places differ by more than the body's radius.
    Place {
        /// The body.
        body: usize,
        /// Its largest coordinate, length.
        coordinate: f64,
        /// The distance of places there, length.
        spacing: f64,
        /// The precision.
        precision: &'static str,
    },
    /// Angles differ by more than a radian.
    Angle {
        /// The body.
        body: usize,
        /// By how much it turns, rad.
        angle: f64,
        /// Up to where angles can be distinguished, rad.
        greatest: f64,
        /// The precision.
        precision: &'static str,
    },
}

impl fmt::Display for Unresolved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Place { body, coordinate, spacing, precision } => write!(
                f,
                "body {body} is at {coordinate:.1e}, where places in {precision} are {spacing:.1e} \
                 apart, more than its radius: what it meets there is chance"
            ),
            Self::Angle { body, angle, greatest, precision } => write!(
                f,
                "body {body} turns by {angle:.1e} rad, and {precision} tells angles apart up to \
                 {greatest:.1e} rad: its orientation means nothing"
            ),
        }
    }
}

/// The first figure of a state that the precision is too coarse for, if the
/// bodies turn as they do for this time.
///
/// ```
/// use carom::Bodies;
/// use carom::observe::{Unresolved, unresolved};
///
/// let ball = Bodies::from_positions(&[[1e6_f32, 0.0, 0.0]]).spins(&[[0.0, 3.0, 0.0]]);
/// let ball = ball.radius(0.5).build()?;
/// assert_eq!(unresolved(&ball, 1.0), None);
/// assert!(matches!(unresolved(&ball, 1e7), Some(Unresolved::Angle { body: 0, .. })));
/// let far = Bodies::from_positions(&[[1e8_f32, 0.0, 0.0]]).radius(0.5).build()?;
/// assert!(matches!(unresolved(&far, 1.0), Some(Unresolved::Place { body: 0, .. })));
/// # Ok::<(), carom::bodies::BodiesError>(())
/// ```
#[must_use]
pub fn unresolved<T: Real>(bodies: &Bodies<T>, time: f64) -> Option<Unresolved> {
    let epsilon = T::EPSILON.to_f64();
    let precision = T::NAME;
    (0..bodies.len()).find_map(|body| {
        let position = bodies.position_of(body).cast::<f64>().to_array();
        let coordinate = position.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let spacing = coordinate * epsilon;
        let angle = bodies.spin_of(body).cast::<f64>().length() * time;
        if spacing > bodies.radius.of(body).to_f64() {
            Some(Unresolved::Place { body, coordinate, spacing, precision })
        } else if angle * epsilon > 1.0 {
            Some(Unresolved::Angle { body, angle, greatest: 1.0 / epsilon, precision })
        } else {
            None
        }
    })
}
