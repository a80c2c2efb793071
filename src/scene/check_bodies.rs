//! Checks of the bodies of a scene, after everything is rounded to its
//! precision: what they make together with each other and with what is fixed.

use core::ops::Range;

use super::check::{Found, figures};
use super::description::Description;
use super::error::{Problem, SceneError};
use super::obstacles::{Misplaced, Obstacles};
use super::settings::{Encounters, EngineKind, Impact};
use crate::bodies::{Bodies, Columns3, Origin, PerBody};
use crate::mat3::Mat3;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::space::neighbours::{Neighbours, largest, tolerance};
use crate::space::shadow::Shadow;
use crate::surroundings::{Feature, FeatureRef, Features, Shape};
use crate::vec3::Vec3;

/// By which part of their radii spheres of a state may overlap what they touch, and by
/// the way of how many steps: a step ends with bodies in each other.
const STATE_SLACK: f64 = 0.1;
const STATE_STEPS: f64 = 2.0;

/// The most of its radius that a sphere of a state may be inside of another.
const DEEPEST: f64 = 0.9;

/// What has put the bodies where they are.
#[derive(Clone, Copy)]
pub(super) struct Sources<'a> {
    /// The bodies of each entry, and what has put these there.
    pub(super) ranges: &'a [Range<usize>],
    pub(super) origins: &'a [Origin],
    /// Of bodies that a world has left: what was placed since.
    pub(super) placed: Option<Placed<'a>>,
}

/// What was placed in a world since it has left its bodies where they are.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// Whether each body was moved, grown or added.
    pub(crate) bodies: &'a [bool],
    /// Whether each part was added; empty if none was.
    pub(crate) parts: &'a [bool],
}

/// Where fewer than one in this many were placed, most of the others are near to none of them.
const FEW: usize = 8;

/// How far bodies may overlap what they touch, by where they come from.
struct Allowance<'a> {
    sources: Sources<'a>,
    /// What has put all of them there, if it is one thing.
    common: Option<Origin>,
    /// How far a body of a state comes in some steps, length.
    way: f64,
}

impl<'a> Allowance<'a> {
    fn new(sources: Sources<'a>, way: f64) -> Self {
        let kind = core::mem::discriminant;
        let (first, mut all) = (sources.origins.first(), sources.origins.iter());
        let common = first.filter(|first| all.all(|origin| kind(origin) == kind(first))).copied();
        let common = common.filter(|_| sources.placed.is_none());
        Self { sources, common, way }
    }

    fn origin(&self, body: usize) -> Origin {
        if let Some(origin) = self.common {
            return origin;
        }
        let Sources { ranges, origins, placed } = self.sources;
        if placed.is_some_and(|placed| placed.bodies[body]) {
            return Origin::Described;
        }
        origins[ranges.partition_point(|range| range.end <= body)]
    }

    /// Whether it is where a world has left it. What an engine may leave, it goes on from.
    fn is_left(&self, body: usize) -> bool {
        matches!(self.origin(body), Origin::World(_))
    }

    /// Whether a part has come to where a world has left bodies.
    fn is_added(&self, part: usize) -> bool {
        let parts = self.sources.placed.map_or(&[][..], |placed| placed.parts);
        parts.get(part).is_some_and(|is_added| *is_added)
    }

    /// Whether any has.
    fn has_added(&self) -> bool {
        self.sources.placed.is_some_and(|placed| placed.parts.contains(&true))
    }

    /// Whether a body and a part are to be held against each other.
    fn is_checked(&self, part: usize, body: usize) -> bool {
        !self.is_left(body) || self.is_added(part)
    }

    /// How far a body may be inside of others, length.
    fn of(&self, body: usize, radius: f64) -> f64 {
        match self.origin(body) {
            Origin::Described | Origin::World(_) => 0.0,
            Origin::State => (STATE_SLACK * radius + self.way).min(DEEPEST * radius),
        }
    }
}

/// How far the fastest body of a stepped scene comes in the steps that a state may be
/// behind by, length.
fn way<T: Real>(asked: &Description<T>, bodies: &Bodies<T>) -> f64 {
    let (EngineKind::Stepped, Some(dt)) = (asked.engine, asked.stepped.dt) else { return 0.0 };
    let squares =
        (0..bodies.len()).map(|body| bodies.velocity_of(body).cast::<f64>().length_squared());
    let speed = squares.fold(0.0, f64::max).sqrt();
    let fallen = asked.gravity.cast::<f64>().length() * dt;
    STATE_STEPS * dt * (speed + fallen)
}

/// Checks all bodies. Centres on the upper face of the periodic box move to
/// the lower one, which is the same place.
pub(super) fn bodies<T: Real>(
    asked: &Description<T>,
    periodic: Option<PeriodicBox<T>>,
    mut bodies: Bodies<T>,
    sources: Sources<'_>,
) -> Result<Bodies<T>, SceneError> {
    let of_entry = |(body, key, problem): Found| {
        let entry = sources.ranges.partition_point(|range| range.end <= body);
        asked.origin.error_in(&format!("spheres[{entry}]"), (key, problem))
    };
    let allowance = Allowance::new(sources, way(asked, &bodies));
    figures(&bodies, asked.surface).map_err(of_entry)?;
    motion(&bodies).map_err(of_entry)?;
    orientation(&bodies, &allowance).map_err(of_entry)?;
    if let Some(space) = &periodic {
        if asked.encounters == Encounters::All {
            sides(space, &bodies).map_err(|problem| asked.origin.error("periodic", problem))?;
        }
        wrap(space, &mut bodies).map_err(of_entry)?;
    }
    if asked.encounters != Encounters::None {
        let shapes: Vec<_> = asked.surroundings.iter().map(|given| given.rounded.clone()).collect();
        let misplaced = surroundings(&shapes, &bodies, &allowance);
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
        thin(asked, &shapes, &bodies, &allowance).map_err(|(index, problem)| {
            asked.origin.error(format!("surroundings[{index}]"), problem)
        })?;
        room(&shapes, asked.gravity, &bodies, &allowance).map_err(|(index, problem)| {
            asked.origin.error(format!("surroundings[{index}]"), problem)
        })?;
    }
    if asked.encounters == Encounters::All {
        overlaps(periodic, &bodies, &allowance).map_err(of_entry)?;
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
fn orientation<T: Real>(bodies: &Bodies<T>, allowance: &Allowance<'_>) -> Result<(), Found> {
    if bodies.orientation.is_none() {
        return Ok(());
    }
    for body in (0..bodies.len()).filter(|body| !allowance.is_left(*body)) {
        let m = bodies.orientation_of(body);
        if !is_rotation(m) {
            let found = format!("no rotation for body {body}");
            let wanted = "its columns must be orthonormal and right-handed".to_owned();
            return Err((body, "orientation", Problem::Value { found, wanted }));
        }
    }
    Ok(())
}

/// Whether a matrix is a rotation, to some rounding.
pub(super) fn is_rotation<T: Real>(m: Mat3<T>) -> bool {
    let [a, b, c] = m.columns;
    let error = (m.transpose() * m - Mat3::IDENTITY).rows();
    let is_orthonormal = error.iter().all(|element| element.to_f64().abs() < 1e-3);
    is_orthonormal && a.cross(b).dot(c) > T::ZERO
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
fn surroundings<T: Real>(
    shapes: &[Shape<T>],
    bodies: &Bodies<T>,
    allowance: &Allowance<'_>,
) -> Option<(usize, Found)> {
    let epsilon = T::EPSILON.to_f64();
    let sphere = |body| (bodies.position_of(body), bodies.radius.of(body));
    let tolerated = |feature: FeatureRef<'_, T>, body: usize, center: Vec3<T>, radius: T| {
        let coordinate = largest(center.cast().to_array()) + feature.farthest();
        let radius = radius.to_f64();
        tolerance(epsilon, coordinate, radius) + allowance.of(body, radius)
    };
    let has_added = allowance.has_added();
    let placed = (0..bodies.len()).filter(|body| has_added || !allowance.is_left(*body));
    let is_checked = |part: usize, body: usize| allowance.is_checked(part, body);
    let Misplaced { shape, body, depth } =
        Obstacles::new(shapes).first_overlap(placed, is_checked, sphere, tolerated)?;
    let (beyond, wanted) = match shapes[shape].is_container() {
        true => (
            format!("outside of its container, surroundings[{shape}]"),
            "every sphere must be wholly inside of it",
        ),
        false => (
            format!("inside of surroundings[{shape}], which is solid"),
            "a sphere may touch it from outside",
        ),
    };
    Some((shape, (body, "", Problem::Misplaced { body, beyond, depth, wanted })))
}

/// With impacts at the end of a step, a body must not fly through something thin in one.
fn thin<T: Real>(
    asked: &Description<T>,
    shapes: &[Shape<T>],
    bodies: &Bodies<T>,
    allowance: &Allowance<'_>,
) -> Result<(), (usize, Problem)> {
    let (EngineKind::Stepped, Impact::EndOfStep, Some(dt)) =
        (asked.engine, asked.stepped.impact, asked.stepped.dt)
    else {
        return Ok(());
    };
    let thin = || (0..shapes.len()).filter(|part| shapes[*part].is_thin());
    let (Some(first), added) = (thin().next(), thin().find(|part| allowance.is_added(*part)))
    else {
        return Ok(());
    };
    let fallen = 0.5 * asked.gravity.cast::<f64>().length() * dt;
    for body in 0..bodies.len() {
        let part = if allowance.is_left(body) { added } else { Some(first) };
        let Some(part) = part else { continue };
        let way = (bodies.velocity_of(body).cast::<f64>().length() + fallen) * dt;
        let radius = bodies.radius.of(body).to_f64();
        if way > radius {
            let reason = format!(
                "it is thin, and body {body} flies {way:.3} in a step, farther than its radius, \
                 {radius:?}, and could jump through it; set impact = \"sub-step\", or dt to {:.1e} \
                 or less",
                dt * radius / way
            );
            return Err((part, Problem::conflict("impact = \"end-of-step\"", reason)));
        }
    }
    Ok(())
}

/// Two faces that look at each other, nearer than the greatest diameter or just as near.
struct Slab<T> {
    /// The parts of the faces.
    parts: [usize; 2],
    /// The normal of the first.
    normal: Vec3<T>,
    /// How far they are apart, length.
    width: f64,
    /// What rounding can make of that.
    slack: f64,
}

/// All of them, between the faces of some shapes.
fn narrow_slabs<T: Real>(shapes: &[Shape<T>], bodies: &Bodies<T>) -> Vec<Slab<T>> {
    /// More planes make no slab that a person has in mind.
    const MOST: usize = 1000;
    let epsilon = T::EPSILON.to_f64();
    let features = Features::new(shapes);
    let faces: Vec<_> = (0..)
        .zip(features.alone())
        .filter_map(|(number, feature)| match feature {
            Feature::Plane(plane) => Some((*plane, features.shape_of(number) as usize)),
            _ => None,
        })
        .take(MOST)
        .collect();
    let greatest = bodies.radius.greatest().to_f64();
    let mut slabs = Vec::new();
    for (first, &(floor, part)) in faces.iter().enumerate() {
        let normal = floor.normal;
        for &(ceiling, other) in &faces[first + 1..] {
            let facing = (normal + ceiling.normal).cast::<f64>().length() <= 8.0 * epsilon;
            let width = (ceiling.point - floor.point).cast::<f64>().dot(normal.cast());
            let farthest =
                [floor.point, ceiling.point].each(|point| largest(point.cast().to_array()));
            let slack = tolerance(epsilon, farthest[0].max(farthest[1]), greatest);
            if facing && width - 2.0 * greatest <= slack {
                slabs.push(Slab { parts: [part, other], normal, width, slack });
            }
        }
    }
    slabs
}

/// Whether a body may have no room to move between two faces.
pub(super) fn has_narrow_slab<T: Real>(shapes: &[Shape<T>], bodies: &Bodies<T>) -> bool {
    !narrow_slabs(shapes, bodies).is_empty()
}

/// Between two faces that look at each other, a body has room to move if it does
/// or is pulled to one of them. Where there is none it would meet both without
/// end.
fn room<T: Real>(
    shapes: &[Shape<T>],
    gravity: Vec3<T>,
    bodies: &Bodies<T>,
    allowance: &Allowance<'_>,
) -> Result<(), (usize, Problem)> {
    let epsilon = T::EPSILON.to_f64();
    for Slab { parts: [part, other], normal, width, slack } in narrow_slabs(shapes, bodies) {
        let is_checked =
            |body: &usize| [part, other].iter().any(|part| allowance.is_checked(*part, *body));
        for body in (0..bodies.len()).filter(is_checked) {
            let radius = bodies.radius.of(body).to_f64();
            let moves = |vector: Vec3<T>| {
                let vector = vector.cast::<f64>();
                vector.dot(normal.cast()).abs() > 8.0 * epsilon * vector.length()
            };
            let is_moved = moves(bodies.velocity_of(body)) || moves(gravity);
            if is_moved && width - 2.0 * radius <= slack {
                let what = match (part == other, shapes[part].interior()) {
                    (true, Some(_)) => "the container leaves".to_owned(),
                    (true, None) => "its faces leave".to_owned(),
                    (false, _) => format!("with surroundings[{other}] it leaves"),
                };
                let direction = direction(normal);
                return Err((part, Problem::Wedged { what, body, direction, width: 2.0 * radius }));
            }
        }
    }
    Ok(())
}

/// The name of a direction.
fn direction<T: Real>(vector: Vec3<T>) -> String {
    let components = vector.to_array().each(|component| component.to_f64() + 0.0);
    match components.each(f64::abs) {
        [1.0, _, _] => "x".to_owned(),
        [_, 1.0, _] => "y".to_owned(),
        [_, _, 1.0] => "z".to_owned(),
        _ => format!("the direction {components:?}"),
    }
}

/// No two bodies overlap, but those that a world has left so, which are held against the
/// others only. The largest go first, and each then meets only bodies of its own size or
/// larger: the time is linear in their number.
fn overlaps<T: Real>(
    periodic: Option<PeriodicBox<T>>,
    bodies: &Bodies<T>,
    allowance: &Allowance<'_>,
) -> Result<(), Found> {
    let all = 0..bodies.len() as u32;
    let is_left = |body: &u32| allowance.is_left(*body as usize);
    let placed: Vec<u32> = all.clone().filter(|body| !is_left(body)).collect();
    let center = |body: u32| bodies.position_of(body as usize).to_array().each(T::to_f64);
    let whole = |body: u32| bodies.radius.of(body as usize).to_f64();
    // Spheres that may overlap are as smaller ones that may not.
    let radius = |body: u32| whole(body) - allowance.of(body as usize, whole(body));
    let greatest = placed.iter().map(|body| radius(*body)).fold(0.0, f64::max);
    if placed.is_empty() {
        return Ok(());
    }
    let space = periodic.map(|space| {
        let corner = |point: Vec3<T>| point.to_array().each(T::to_f64);
        PeriodicBox::new(corner(space.lower), corner(space.upper))
    });
    let mut table = Neighbours::new(placed.len(), greatest, T::EPSILON.to_f64(), space);
    let overlap = |table: &Neighbours, body: u32| {
        let Some(other) = table.overlapping(center(body), radius(body)) else { return Ok(()) };
        let (a, b) = (body.min(other.id), body.max(other.id));
        let soft = [a, b].each(|body| whole(body) - radius(body));
        let (depth, found) = (other.depth + soft[0] + soft[1], b as usize);
        Err((found, "", Problem::Overlap { a: a as usize, b: found, depth }))
    };
    let finest = match &bodies.radius {
        PerBody::Same(_) if allowance.common.is_some() => 0,
        _ => placed.iter().map(|body| table.level(radius(*body))).max().unwrap_or(0),
    };
    for level in 0..=finest {
        let on_level = |body: &u32| finest == 0 || table.level(radius(*body)) == level;
        let mut order: Vec<u32> = placed.iter().copied().filter(on_level).collect();
        order.sort_by_cached_key(|body| table.order(level, center(*body)));
        for body in order {
            overlap(&table, body)?;
            table.insert(body, center(body), radius(body));
        }
    }
    if placed.len() > bodies.len() / FEW {
        return all.filter(is_left).try_for_each(|body| overlap(&table, body));
    }
    // Most of those that were left are near to nothing that was placed.
    let reach = greatest + bodies.radius.greatest().to_f64();
    let shadow = Shadow::of(placed.iter().map(|body| center(*body)), reach, space);
    let may_touch = |body: &u32| is_left(body) && shadow.covers(center(*body));
    all.filter(may_touch).try_for_each(|body| overlap(&table, body))
}
