//! Checks of the bodies of a scene, after everything is rounded to its
//! precision: what they make together with each other and with what is fixed.

use core::ops::Range;

use super::check::{Found, figures};
use super::description::Description;
use super::error::{Problem, SceneError};
use super::obstacles::{Misplaced, Obstacles};
use super::settings::Encounters;
use crate::bodies::{Bodies, Columns3, PerBody};
use crate::mat3::Mat3;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::space::neighbours::{Neighbours, largest, tolerance};
use crate::surroundings::{Feature, Shape};
use crate::vec3::Vec3;

/// Checks all bodies. Centres on the upper face of the periodic box move to
/// the lower one, which is the same place.
pub(super) fn bodies<T: Real>(
    asked: &Description<T>,
    periodic: Option<PeriodicBox<T>>,
    mut bodies: Bodies<T>,
    ranges: &[Range<usize>],
) -> Result<Bodies<T>, SceneError> {
    let of_entry = |(body, key, problem): Found| {
        let entry = ranges.partition_point(|range| range.end <= body);
        asked.origin.error_in(&format!("spheres[{entry}]"), (key, problem))
    };
    figures(&bodies).map_err(of_entry)?;
    motion(&bodies).map_err(of_entry)?;
    orientation(&bodies).map_err(of_entry)?;
    if let Some(space) = &periodic {
        if asked.encounters == Encounters::All {
            sides(space, &bodies).map_err(|problem| asked.origin.error("periodic", problem))?;
        }
        wrap(space, &mut bodies).map_err(of_entry)?;
    }
    if asked.encounters != Encounters::None {
        let shapes: Vec<_> = asked.surroundings.iter().map(|given| given.rounded).collect();
        let misplaced = surroundings(&shapes, &bodies);
        let first = misplaced.as_ref().map_or(shapes.len(), |misplaced| misplaced.0 + 1);
        if let Some(space) = &periodic {
            let radius = bodies.radius.greatest();
            for (index, shape) in shapes[..first].iter().enumerate() {
                within(shape, space, radius).map_err(|problem| {
                    asked.origin.error(format!("surroundings[{index}]"), problem)
                })?;
            }
        }
        if let Some((_, found)) = misplaced {
            return Err(of_entry(found));
        }
    }
    if asked.encounters == Encounters::All {
        overlaps(periodic, &bodies).map_err(of_entry)?;
    }
    Ok(bodies)
}

/// Places, velocities and spins.
fn motion<T: Real>(bodies: &Bodies<T>) -> Result<(), Found> {
    let vectors: [(&str, &Columns3<T>); 3] =
        [("position", &bodies.position), ("velocity", &bodies.velocity), ("spin", &bodies.spin)];
    for (what, columns) in vectors {
        for column in columns {
            if let Some(body) = column.iter().position(|value| !value.is_finite()) {
                let found = format!("such that the {what} of body {body} is not finite");
                let wanted = format!("it must be a number that {} can hold", T::NAME);
                return Err((body, "", Problem::Value { found, wanted }));
            }
        }
    }
    Ok(())
}

/// Orientations of bodies that came ready.
fn orientation<T: Real>(bodies: &Bodies<T>) -> Result<(), Found> {
    if bodies.orientation.is_none() {
        return Ok(());
    }
    for body in 0..bodies.len() {
        let m = bodies.orientation_of(body);
        let [a, b, c] = m.columns;
        let error = (m.transpose() * m - Mat3::IDENTITY).rows();
        let is_orthonormal = error.iter().all(|element| element.to_f64().abs() < 1e-3);
        if !(is_orthonormal && a.cross(b).dot(c) > T::ZERO) {
            let found = format!("no rotation for body {body}");
            let wanted = "its columns must be orthonormal and right-handed".to_owned();
            return Err((body, "orientation", Problem::Value { found, wanted }));
        }
    }
    Ok(())
}

/// Of all images of two spheres, only the nearest may be able to touch. Two
/// images of a sphere are a side apart, so the farther one of two is at least
/// half a side away: that has to be a contact distance or more.
fn sides<T: Real>(space: &PeriodicBox<T>, bodies: &Bodies<T>) -> Result<(), Problem> {
    let needed = 4.0 * bodies.radius.greatest().to_f64();
    let sides = space.sides().cast::<f64>().to_array();
    let limit = needed * (1.0 - 8.0 * T::EPSILON.to_f64());
    match sides.iter().find(|side| **side < limit) {
        None => Ok(()),
        Some(side) => Err(Problem::Value {
            found: format!("{side:?} wide"),
            wanted: format!(
                "a side must be at least twice the greatest diameter, {needed:?} here, so that \
                 of all images of a sphere only the nearest can touch another"
            ),
        }),
    }
}

/// All centres are inside the periodic box.
fn wrap<T: Real>(space: &PeriodicBox<T>, bodies: &mut Bodies<T>) -> Result<(), Found> {
    let [lower, upper] = [space.lower.to_array(), space.upper.to_array()];
    for (axis, column) in bodies.position.iter_mut().enumerate() {
        for (body, center) in column.iter_mut().enumerate() {
            let beyond = lower[axis] - *center;
            let beyond = if beyond > T::ZERO { beyond } else { *center - upper[axis] };
            if beyond > T::ZERO {
                let problem = Problem::Misplaced {
                    body,
                    beyond: "outside of the periodic box".to_owned(),
                    depth: beyond.to_f64(),
                    wanted: "every centre must be between lower and upper",
                };
                return Err((body, "", problem));
            }
            if *center == upper[axis] {
                *center = lower[axis];
            }
        }
    }
    Ok(())
}

/// What is solid in a periodic box must be met from one side of it only: the
/// images of what is fixed are not looked for.
fn within<T: Real>(shape: &Shape<T>, space: &PeriodicBox<T>, radius: T) -> Result<(), Problem> {
    let Some([lower, upper]) = shape.bounds() else {
        return Ok(());
    };
    let [low, high] = [(lower - space.lower).to_array(), (space.upper - upper).to_array()];
    if low.iter().chain(&high).all(|margin| *margin >= radius) {
        return Ok(());
    }
    Err(Problem::Value {
        found: "too near to the faces of the periodic box".to_owned(),
        wanted: format!(
            "there must be room for the greatest radius, {:?}, on every side of it",
            radius.to_f64()
        ),
    })
}

/// The first body that is inside of something solid or outside of its container,
/// at the first such shape.
fn surroundings<T: Real>(shapes: &[Shape<T>], bodies: &Bodies<T>) -> Option<(usize, Found)> {
    let epsilon = T::EPSILON.to_f64();
    let sphere = |body| (bodies.position_of(body), bodies.radius.of(body));
    let tolerated = |feature: &Feature<T>, center: Vec3<T>, radius: T| {
        let coordinate = largest(center.cast().to_array()) + feature.farthest();
        tolerance(epsilon, coordinate, radius.to_f64())
    };
    let Misplaced { shape, body, depth } =
        Obstacles::new(shapes).first_overlap(bodies.len(), sphere, tolerated)?;
    let (beyond, wanted) = match shapes[shape].interior() {
        Some(_) => (
            format!("outside of its container, surroundings[{shape}]"),
            "every sphere must be wholly inside of it",
        ),
        None => (
            format!("inside of surroundings[{shape}], which is solid"),
            "a sphere may touch it from outside",
        ),
    };
    Some((shape, (body, "", Problem::Misplaced { body, beyond, depth, wanted })))
}

/// No two bodies overlap. The largest go first, and each then meets only
/// bodies of its own size or larger: the time is linear in their number.
fn overlaps<T: Real>(periodic: Option<PeriodicBox<T>>, bodies: &Bodies<T>) -> Result<(), Found> {
    let space = periodic.map(|space| {
        let corner = |point: Vec3<T>| point.to_array().map(T::to_f64);
        PeriodicBox::new(corner(space.lower), corner(space.upper))
    });
    let greatest = bodies.radius.greatest().to_f64();
    let mut table = Neighbours::new(bodies.len(), greatest, T::EPSILON.to_f64(), space);
    let finest = match &bodies.radius {
        PerBody::Same(_) => 0,
        PerBody::Each(column) => {
            column.iter().map(|radius| table.level(radius.to_f64())).max().unwrap_or(0)
        }
    };
    for level in 0..=finest {
        let center = |body: u32| bodies.position_of(body as usize).to_array().map(T::to_f64);
        let radius = |body: u32| bodies.radius.of(body as usize).to_f64();
        let mut order: Vec<u32> = (0..bodies.len() as u32)
            .filter(|body| finest == 0 || table.level(radius(*body)) == level)
            .collect();
        order.sort_by_cached_key(|body| table.order(level, center(*body)));
        for body in order {
            if let Some(other) = table.overlapping(center(body), radius(body)) {
                let (a, b) = (body.min(other.id) as usize, body.max(other.id) as usize);
                return Err((b, "", Problem::Overlap { a, b, depth: other.depth }));
            }
            table.insert(body, center(body), radius(body));
        }
    }
    Ok(())
}
