//! Checks of what a scene is told: values one by one, and those that
//! contradict each other. What the bodies then make together is checked in
//! [`super::check_bodies`].

use core::ops::Range;

use super::builder::{Entry, Periodicity, SceneBuilder};
use super::check_bodies;
use super::error::{Problem, SceneError};
use super::spheres::{Make, Spheres, Spread};
use super::{MOST_BODIES, MOST_STEPS};
use crate::bodies::{Bodies, PerBody};
use crate::real::Real;
use crate::scene::EngineKind;
use crate::surroundings::Shape;
use crate::vec3::Vec3;

/// Whether a number is finite and greater than 0, in the scene's precision too.
pub(super) fn is_positive<T: Real>(value: f64) -> bool {
    let rounded = T::from_f64(value);
    value.is_finite() && rounded > T::ZERO && rounded.is_finite()
}

/// A problem unless a number is finite and greater than 0.
fn positive<T: Real>(value: f64, what: &str) -> Result<(), Problem> {
    if is_positive::<T>(value) {
        return Ok(());
    }
    let precision = if value > 0.0 && value.is_finite() {
        format!(" in {} too", T::NAME)
    } else {
        String::new()
    };
    Err(Problem::value(value, format!("{what} must be finite and greater than 0{precision}")))
}

/// A problem unless every component is finite, in the scene's precision too.
fn finite<T: Real>(vector: [f64; 3], what: &str) -> Result<(), Problem> {
    if vector.iter().all(|c| T::from_f64(*c).is_finite()) {
        return Ok(());
    }
    let wanted = format!("every component of {what} must be finite in {}", T::NAME);
    Err(Problem::value(vector, wanted))
}

fn is_finite<T: Real>(vector: Vec3<T>) -> bool {
    vector.to_array().iter().all(|c| c.is_finite())
}

fn shown<T: Real>(vector: Vec3<T>) -> [f64; 3] {
    vector.to_array().map(T::to_f64)
}

/// Checks duration, step, gravity, periodic box and surroundings.
pub(super) fn settings<T: Real>(builder: &SceneBuilder<T>) -> Result<(), SceneError> {
    let origin = &builder.origin;
    let fail = |key: &str, problem| Err(origin.error(key, problem));
    if !is_finite(builder.gravity) {
        let wanted = format!("every component of gravity must be finite in {}", T::NAME);
        return fail("gravity", Problem::value(shown(builder.gravity), wanted));
    }
    // The clock runs in f64, but a step goes through the formulas.
    if let Some(duration) = builder.duration {
        positive::<f64>(duration, "a duration")
            .map_err(|problem| origin.error("duration", problem))?;
    }
    match builder.stepped.dt {
        // Code may choose the engine later: `Stepped::new` asks for it there.
        None if builder.engine == EngineKind::Stepped && origin.is_file() => {
            let wanted =
                "the stepped engine has no default for it: set `dt` under [stepped], or --dt";
            return fail("stepped.dt", Problem::missing(wanted));
        }
        None => {}
        Some(dt) => {
            positive::<T>(dt, "a time step")
                .map_err(|problem| origin.error("stepped.dt", problem))?;
            let steps = builder.duration.unwrap_or(0.0) / dt;
            if steps > MOST_STEPS && builder.engine == EngineKind::Stepped {
                let wanted = format!("that is {steps:e} steps, and 2^53 is the most there can be");
                return fail("stepped.dt", Problem::value(dt, wanted));
            }
        }
    }
    if let Periodicity::Box(given) = &builder.periodic {
        let [lower, upper] = [given.rounded.lower, given.rounded.upper];
        bounds(lower, upper)
            .map_err(|(key, problem)| origin.error(format!("periodic.{key}"), problem))?;
    }
    let is_periodic = !matches!(builder.periodic, Periodicity::Open);
    for (index, given) in builder.surroundings.iter().enumerate() {
        let entry = format!("surroundings[{index}]");
        shape(&given.rounded)
            .map_err(|(key, problem)| origin.error(format!("{entry}.{key}"), problem))?;
        let open = match given.rounded {
            Shape::Plane(_) => Some("a plane"),
            Shape::Cuboid(cuboid) if cuboid.inside => Some("a container"),
            Shape::FixedSphere(sphere) if sphere.inside => Some("a container"),
            _ => None,
        };
        if let (true, Some(what)) = (is_periodic, open) {
            let reason = format!(
                "{what} ends space, which a periodic box closes upon itself; leave out one of them"
            );
            return fail(&entry, Problem::conflict("a periodic box", reason));
        }
    }
    Ok(())
}

type Keyed = (&'static str, Problem);

fn bounds<T: Real>(lower: Vec3<T>, upper: Vec3<T>) -> Result<(), Keyed> {
    for (key, corner) in [("lower", lower), ("upper", upper)] {
        if !is_finite(corner) {
            let wanted = format!("every component must be finite in {}", T::NAME);
            return Err((key, Problem::value(shown(corner), wanted)));
        }
    }
    let sides = (upper - lower).to_array();
    if sides.iter().all(|side| *side > T::ZERO && side.is_finite()) {
        return Ok(());
    }
    let wanted = format!("every component must be below that of upper, {:?}", shown(upper));
    Err(("lower", Problem::value(shown(lower), wanted)))
}

fn shape<T: Real>(shape: &Shape<T>) -> Result<(), Keyed> {
    let place = |key, point: Vec3<T>| {
        let wanted = format!("every component must be finite in {}", T::NAME);
        if is_finite(point) { Ok(()) } else { Err((key, Problem::value(shown(point), wanted))) }
    };
    match shape {
        Shape::Plane(plane) => {
            place("point", plane.point)?;
            let length = plane.normal.length().to_f64();
            if (length - 1.0).abs() < 1e-3 {
                return Ok(());
            }
            let wanted = "a normal must be finite and have a length greater than 0";
            Err(("normal", Problem::Value { found: "no direction".into(), wanted: wanted.into() }))
        }
        Shape::Cuboid(cuboid) => bounds(cuboid.lower, cuboid.upper),
        Shape::FixedSphere(sphere) => {
            place("center", sphere.center)?;
            positive::<T>(sphere.radius.to_f64(), "a radius").map_err(|problem| ("radius", problem))
        }
    }
}

/// Checks every entry of spheres by itself, and gives the bodies that it
/// becomes.
pub(super) fn entries<T: Real>(builder: &SceneBuilder<T>) -> Result<Vec<Range<usize>>, SceneError> {
    let mut ranges = Vec::with_capacity(builder.entries.len());
    let mut total = 0_u64;
    for (index, entry) in builder.entries.iter().enumerate() {
        let fail = |(key, problem): Keyed| {
            builder.origin.error(format!("spheres[{index}].{key}"), problem)
        };
        let count = match entry {
            Entry::One(sphere) => {
                make::<T>(&sphere.make).map_err(fail)?;
                finite::<T>(sphere.position, "a position").map_err(|p| fail(("position", p)))?;
                1
            }
            Entry::Many(spheres) => {
                make::<T>(&spheres.make).map_err(fail)?;
                many::<T>(spheres).map_err(fail)?;
                spheres.count
            }
            Entry::Ready(bodies) => {
                columns(bodies).map_err(fail)?;
                check_bodies::figures(bodies).map_err(|(.., problem)| {
                    builder.origin.error(format!("spheres[{index}]"), problem)
                })?;
                bodies.len() as u64
            }
        };
        let start = total;
        total = total.saturating_add(count);
        if total > MOST_BODIES {
            let wanted = format!("a scene can have {MOST_BODIES} spheres at most");
            return Err(fail(("count", Problem::value(count, wanted))));
        }
        ranges.push(start as usize..total as usize);
    }
    if total == 0 { Err(builder.origin.error("", Problem::Empty)) } else { Ok(ranges) }
}

/// What a sphere is and how it starts.
fn make<T: Real>(make: &Make) -> Result<(), Keyed> {
    let Some(radius) = &make.radius else {
        let wanted = "it has no default; give a number greater than 0";
        return Err(("radius", Problem::missing(wanted)));
    };
    spread::<T>(radius, "a radius").map_err(|problem| ("radius", problem))?;
    if let Some(mass) = &make.mass {
        spread::<T>(mass, "a mass").map_err(|problem| ("mass", problem))?;
        if make.density.is_some() {
            let reason = "either makes the other; give one of them";
            return Err(("density", Problem::conflict("mass", reason)));
        }
    }
    if let Some(density) = &make.density {
        spread::<T>(density, "a density").map_err(|problem| ("density", problem))?;
    }
    let factor = make.inertia_factor;
    if !(factor > 0.0 && factor <= 2.0 / 3.0 && is_positive::<T>(factor)) {
        let wanted = "the inertia factor I / (m r²) of a sphere is above 0, a point, and at most \
                      2/3, a thin shell; a solid sphere has 0.4";
        return Err(("inertia_factor", Problem::value(factor, wanted)));
    }
    finite::<T>(make.velocity, "a velocity").map_err(|problem| ("velocity", problem))?;
    finite::<T>(make.spin, "a spin").map_err(|problem| ("spin", problem))
}

fn spread<T: Real>(spread: &Spread, what: &str) -> Result<(), Problem> {
    positive::<T>(spread.least(), what)?;
    positive::<T>(spread.greatest(), what)?;
    if spread.least() > spread.greatest() {
        let found = [spread.least(), spread.greatest()];
        return Err(Problem::value(found, "the lesser bound comes first"));
    }
    Ok(())
}

/// What only many spheres have.
fn many<T: Real>(spheres: &Spheres) -> Result<(), Keyed> {
    if spheres.count == 0 {
        return Err(("count", Problem::value(0, "a count must be at least 1")));
    }
    for (key, temperature) in
        [("temperature", spheres.temperature), ("spin_temperature", spheres.spin_temperature)]
    {
        if !(temperature >= 0.0 && T::from_f64(temperature).is_finite()) {
            let wanted = "a temperature, kT in units of energy, must be finite and not negative";
            return Err((key, Problem::value(temperature, wanted)));
        }
    }
    if let Some(density) = spheres.number_density {
        positive::<T>(density, "a number density")
            .map_err(|problem| ("number_density", problem))?;
    }
    match spheres.bounds {
        None => Ok(()),
        Some([lower, upper]) => bounds::<f64>(lower.into(), upper.into()),
    }
}

/// Whether the columns of ready bodies have one length.
fn columns<T: Real>(bodies: &Bodies<T>) -> Result<(), Keyed> {
    let figure = |figure: &PerBody<T>| match figure {
        PerBody::Same(_) => bodies.len(),
        PerBody::Each(column) => column.len(),
    };
    let vectors = [("position", &bodies.position), ("velocity", &bodies.velocity)];
    let vectors = vectors.into_iter().chain([("spin", &bodies.spin)]);
    let vectors = vectors.flat_map(|(key, columns)| columns.iter().map(move |c| (key, c.len())));
    let figures = [
        ("radius", figure(&bodies.radius)),
        ("mass", figure(&bodies.mass)),
        ("inertia", figure(&bodies.inertia)),
    ];
    let axes = bodies.orientation.iter().flat_map(|columns| columns.iter());
    let axes = axes.map(|column| ("orientation", column.len()));
    for (key, len) in vectors.chain(figures).chain(axes) {
        if len != bodies.len() {
            let found = format!("{len} long");
            let wanted = format!("all columns must be as long as the first, {}", bodies.len());
            return Err((key, Problem::Value { found, wanted }));
        }
    }
    Ok(())
}
