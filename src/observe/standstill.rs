//! Standstill: why a body of the event-driven engine collides without end.

use core::fmt;

use crate::bodies::Bodies;
use crate::real::Real;
use crate::surroundings::{Features, Shape};
use crate::vec3::Vec3;

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// A fixed part, by its index.
    Part(usize),
    /// Another body.
    Body(usize),
}

impl fmt::Display for Touched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part(index) => write!(f, "surroundings[{index}]"),
            Self::Body(index) => write!(f, "body {index}"),
        }
    }
}

/// How a body stands to what it collides with while time stands still
/// ([`EngineError::Stalled`](crate::EngineError::Stalled)). Its text says what
/// helps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Standstill {
    /// A force presses it on something.
    Rests(Touched),
    /// It moves along something hollow, in ever smaller hops.
    Slides(Touched),
    /// It is between two things without room.
    Wedged([Touched; 2]),
    /// It meets something again and again.
    Meets(Touched),
    /// None of these.
    Unknown,
}

impl Standstill {
    /// How a body stands to what is around it.
    #[must_use]
    pub fn of<T: Real>(
        bodies: &Bodies<T>,
        shapes: &[Shape<T>],
        gravity: Vec3<T>,
        body: usize,
    ) -> Self {
        let touched = touched(bodies, shapes, body);
        let velocity = bodies.velocity_of(body).cast::<f64>();
        let facing = touched.iter().enumerate().find_map(|(k, (one, normal))| {
            let other = touched[..k].iter().find(|(_, other)| normal.dot(*other) < -0.5)?;
            Some([other.0, *one])
        });
        if let Some(between) = facing {
            return Self::Wedged(between);
        }
        let pressed = touched.iter().find(|(_, normal)| gravity.cast().dot(*normal) < 0.0);
        if let Some((what, normal)) = pressed
            && velocity.dot(*normal).abs() <= 1e-3 * gravity.cast::<f64>().length().max(1.0)
        {
            return Self::Rests(*what);
        }
        let Some((what, normal)) = touched.first() else { return Self::Unknown };
        if velocity.dot(*normal).abs() <= 1e-3 * velocity.length() {
            Self::Slides(*what)
        } else {
            Self::Meets(*what)
        }
    }
}

/// What a body touches, and the normals from there to it. Another body that flies away
/// holds nothing.
fn touched<T: Real>(
    bodies: &Bodies<T>,
    shapes: &[Shape<T>],
    body: usize,
) -> Vec<(Touched, Vec3<f64>)> {
    /// What counts as touching, of a radius.
    const NEAR: f64 = 1e-3;
    let (center, radius) = (bodies.position_of(body), bodies.radius.of(body));
    let near = NEAR * radius.to_f64();
    let unit = |vector: Vec3<f64>| vector * (1.0 / vector.length());
    let features = Features::new(shapes);
    let mut touched = Vec::new();
    let mut test = |feature: u32| {
        let clearance = features.at(feature).clearance(center, radius);
        if clearance.gap.to_f64().abs() <= near {
            let part = Touched::Part(features.shape_of(feature) as usize);
            touched.push((part, unit(clearance.arm.cast())));
        }
    };
    (0..features.alone().len() as u32).for_each(&mut test);
    let reach = radius + T::from_f64(near);
    let reach = Vec3::new(reach, reach, reach);
    features.for_each_tile([center - reach, center + reach], |_, feature| test(feature));
    for other in (0..bodies.len()).filter(|other| *other != body) {
        let distance = (center - bodies.position_of(other)).cast::<f64>();
        let reach = radius.to_f64() + bodies.radius.of(other).to_f64();
        let parting = (bodies.velocity_of(body) - bodies.velocity_of(other)).cast::<f64>();
        let flies_away = parting.dot(unit(distance)) > 1e-3 * parting.length();
        if (distance.length() - reach).abs() <= near && !flies_away {
            touched.push((Touched::Body(other), unit(distance)));
        }
    }
    touched
}

impl fmt::Display for Standstill {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rests(what) => write!(
                f,
                "it rests on {what}; let it start above it, or take the stepped engine \
                 (--engine stepped --dt TIME)"
            ),
            Self::Slides(what) => write!(
                f,
                "it slides along {what} in ever smaller hops; let it start away from it, or take \
                 the stepped engine with impact = \"sub-step\" (--engine stepped --dt TIME)"
            ),
            Self::Wedged([one, other]) => write!(
                f,
                "it is wedged between {one} and {other}; give it room between them, which the \
                 stepped engine needs too"
            ),
            Self::Meets(what) => write!(
                f,
                "it meets {what} again and again; --precision f64 tells shorter times apart, and \
                 the stepped engine with impact = \"sub-step\" passes over them (--engine stepped \
                 --dt TIME)"
            ),
            Self::Unknown => write!(
                f,
                "--precision f64 tells shorter times apart, and the stepped engine with impact = \
                 \"sub-step\" passes over them (--engine stepped --dt TIME)"
            ),
        }
    }
}
