//! Checks of what a scene is asked to be: values one by one, and those that
//! contradict each other. What the bodies then make together is checked in
//! [`super::check_bodies`].

use core::ops::Range;
use std::collections::HashMap;

use super::description::{Description, Entry, Given, Periodicity};
use super::error::{Keyed, Problem, SceneError};
use super::inlet::{Inlet, Opening};
use super::settings::{EngineKind, MOST_BODIES, MOST_STEPS};
use super::spheres::{Make, Spheres, Spread};
use crate::bodies::{Bodies, PerBody};
use crate::contact::Surface;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::surroundings::{Mistake, corners, finite, is_positive, positive};
use crate::vec3::Vec3;

/// A mistake of one body: the key of its entry, and the problem.
pub(super) type Found = (usize, &'static str, Problem);

/// Checks duration, step, gravity, periodic box and surroundings.
pub(super) fn settings<T: Real>(asked: &Description<T>) -> Result<(), SceneError> {
    let origin = &asked.origin;
    let fail = |mistake: Mistake| origin.error_in("", mistake);
    finite::<T>("gravity", asked.gravity.cast(), "every component of gravity").map_err(fail)?;
    // The clock runs in f64, but a step goes through the formulas.
    if let Some(duration) = asked.duration {
        positive::<f64>("duration", duration, "a duration").map_err(fail)?;
    }
    step(asked).map_err(fail)?;
    if let Periodicity::Box(Given { rounded: PeriodicBox { lower, upper }, .. }) = asked.periodic {
        corners(lower, upper).map_err(|mistake| origin.error_in("periodic", mistake))?;
    }
    part_names(&asked.part_names)
        .map_err(|(part, mistake)| origin.error_in(&format!("surroundings[{part}]"), mistake))?;
    let is_periodic = !matches!(asked.periodic, Periodicity::Open);
    for (index, given) in asked.surroundings.iter().enumerate() {
        let entry = format!("surroundings[{index}]");
        let shape = &given.rounded;
        shape.check().map_err(|mistake| origin.error_in(&entry, mistake))?;
        let removes = asked.removes.get(index).is_some_and(|removes| *removes);
        if removes && shape.is_sensor() {
            let reason = "nothing touches a sensor; leave out one of them";
            let problem = Problem::conflict("sensor = true", reason);
            return Err(origin.error(format!("{entry}.removes"), problem));
        }
        if is_periodic && removes {
            let reason = "a periodic box keeps its spheres; leave out one of them";
            let problem = Problem::conflict("a periodic box", reason);
            return Err(origin.error(format!("{entry}.removes"), problem));
        }
        if is_periodic && shape.is_sensor() {
            let reason = "a sensor counts in open space only; leave out one of them";
            return Err(origin.error(entry, Problem::conflict("a periodic box", reason)));
        }
        if is_periodic && shape.bounds().is_none() {
            let what = if shape.is_container() { "container" } else { shape.name() };
            let reason = if shape.is_container() || shape.name() == "plane" {
                format!(
                    "a {what} ends space, and a periodic box has no end; leave out one of \
                     them"
                )
            } else {
                format!("a {what} without end leaves the box; give it a `height` that fits into it")
            };
            return Err(origin.error(entry, Problem::conflict("a periodic box", reason)));
        }
    }
    for (index, inlet) in asked.inlets.iter().enumerate() {
        let entry = format!("inlet[{index}]");
        if is_periodic {
            let reason = "a periodic box keeps its spheres; leave out one of them";
            return Err(origin.error(entry, Problem::conflict("a periodic box", reason)));
        }
        self::inlet::<T>(inlet).map_err(|keyed| origin.error_in(&entry, keyed))?;
        let every = inlet.every.unwrap_or(1.0);
        if asked.duration.unwrap_or(0.0) / every > MOST_STEPS {
            let wanted = "that is more than 2^53 spheres, and more than can be counted";
            return Err(origin.error_in(&entry, Mistake::value("every", every, wanted)));
        }
    }
    Ok(())
}

/// A source of spheres.
fn inlet<T: Real>(inlet: &Inlet) -> Result<(), Keyed> {
    make::<T>(&inlet.make)?;
    temperatures::<T>(inlet.temperature, inlet.spin_temperature)?;
    match inlet.opening {
        Opening::At(place) => finite::<T>("position", place.into(), "every component")?,
        Opening::Box([lower, upper]) => {
            for (key, corner) in [("lower", lower), ("upper", upper)] {
                finite::<T>(key, corner.into(), "every component")?;
            }
            if (0..3).any(|axis| lower[axis] > upper[axis]) {
                let wanted = "no component may be less than that of lower";
                return Err(Mistake::value("upper", upper, wanted).into());
            }
        }
        Opening::Disc(center, axis, reach) => {
            finite::<T>("center", center.into(), "every component")?;
            let length = Vec3::from(axis).length();
            if !(length.is_normal() && (1.0 / length).is_normal()) {
                let wanted = "an axis must be finite and have a length greater than 0";
                return Err(Mistake::value("axis", axis, wanted).into());
            }
            positive::<T>("reach", reach, "a distance")?;
        }
    }
    let Some(every) = inlet.every else {
        let wanted = "how much time is from one sphere to the next, or their rate per time";
        return Err(Mistake::missing("every", wanted).into());
    };
    positive::<f64>("every", every, "a time")?;
    if !(inlet.from >= 0.0 && inlet.from.is_finite()) {
        let wanted = "a time must be finite and not negative";
        return Err(Mistake::value("from", inlet.from, wanted).into());
    }
    if inlet.count == Some(0) {
        return Err(Mistake::value("count", 0, "a count must be at least 1").into());
    }
    Ok(())
}

/// Names, each of one part.
fn part_names(names: &[Option<String>]) -> Result<(), (usize, Mistake)> {
    const KEY: &str = "name";
    let mut parts = HashMap::new();
    for (part, name) in names.iter().enumerate().filter_map(|(k, name)| Some((k, name.as_ref()?))) {
        if name.is_empty() || name.chars().any(char::is_control) {
            let wanted = "a name has letters, and no line breaks or other control characters";
            return Err((part, Mistake::value(KEY, name, wanted)));
        }
        if let Some(other) = parts.insert(name, part) {
            let wanted = format!("surroundings[{other}] is called so already");
            return Err((part, Mistake::value(KEY, name, wanted)));
        }
    }
    Ok(())
}

/// The length of a step, and how many of them there are.
fn step<T: Real>(asked: &Description<T>) -> Result<(), Mistake> {
    const KEY: &str = "stepped.dt";
    let is_stepped = asked.engine == EngineKind::Stepped;
    let Some(dt) = asked.stepped.dt else {
        // Code may choose the engine later: `Stepped::new` asks for it there.
        if is_stepped && asked.origin.is_file() {
            let wanted =
                "the stepped engine has no default for it: set `dt` under [stepped], or --dt";
            return Err(Mistake::missing(KEY, wanted));
        }
        return Ok(());
    };
    positive::<T>(KEY, dt, "a time step")?;
    let steps = asked.duration.unwrap_or(0.0) / dt;
    if steps > MOST_STEPS && is_stepped {
        let wanted = format!("that is {steps:e} steps, and 2^53 is the most there can be");
        return Err(Mistake::value(KEY, dt, wanted));
    }
    Ok(())
}

/// Checks every entry of spheres by itself, and gives the bodies that it
/// becomes.
pub(super) fn entries<T: Real>(asked: &Description<T>) -> Result<Vec<Range<usize>>, SceneError> {
    let mut ranges = Vec::with_capacity(asked.entries.len());
    let mut total = 0_u64;
    for (index, entry) in asked.entries.iter().enumerate() {
        let name = format!("spheres[{index}]");
        let fail = |keyed: Keyed| asked.origin.error_in(&name, keyed);
        let count = match entry {
            Entry::One(sphere) => {
                make::<T>(&sphere.make).map_err(fail)?;
                finite::<T>("position", sphere.position.into(), "every component of a position")
                    .map_err(|mistake| fail(mistake.into()))?;
                1
            }
            Entry::Many(spheres) => {
                make::<T>(&spheres.make).map_err(fail)?;
                many::<T>(spheres).map_err(|mistake| fail(mistake.into()))?;
                spheres.count
            }
            Entry::Ready(bodies) => {
                columns(bodies).map_err(fail)?;
                figures(bodies, asked.surface).map_err(|(_, key, problem)| fail((key, problem)))?;
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
    // A world may have lost all of them.
    let is_left_empty = !asked.inlets.is_empty()
        || asked.removes.contains(&true) && matches!(asked.entries[..], [Entry::Ready(_)]);
    if total == 0 && !is_left_empty {
        return Err(asked.origin.error("", Problem::Empty));
    }
    Ok(ranges)
}

/// What spheres are whose places are in a file.
#[cfg(feature = "files")]
pub(super) fn described<T: Real>(spheres: &Spheres) -> Result<(), Keyed> {
    make::<T>(&spheres.make)?;
    Ok(many::<T>(spheres)?)
}

/// What a sphere is and how it starts.
fn make<T: Real>(make: &Make) -> Result<(), Keyed> {
    let Some(radius) = &make.radius else {
        let wanted = "it has no default; give a number greater than 0";
        return Err(("radius", Problem::missing(wanted)));
    };
    spread::<T>("radius", radius, "a radius")?;
    if let Some(mass) = &make.mass {
        spread::<T>("mass", mass, "a mass")?;
        if make.density.is_some() {
            let reason = "either makes the other; give one of them";
            return Err(("density", Problem::conflict("mass", reason)));
        }
    }
    if let Some(density) = &make.density {
        spread::<T>("density", density, "a density")?;
    }
    let factor = make.inertia_factor;
    if !(factor > 0.0 && factor <= 2.0 / 3.0 && is_positive::<T>(factor)) {
        let wanted = "the inertia factor I / (m r²) of a sphere is above 0, a point, and at most \
                      2/3, a thin shell; a solid sphere has 0.4";
        return Err(("inertia_factor", Problem::value(factor, wanted)));
    }
    finite::<T>("velocity", make.velocity.into(), "every component of a velocity")?;
    finite::<T>("spin", make.spin.into(), "every component of a spin")?;
    Ok(())
}

fn spread<T: Real>(key: &'static str, spread: &Spread, what: &str) -> Result<(), Mistake> {
    positive::<T>(key, spread.least(), what)?;
    positive::<T>(key, spread.greatest(), what)?;
    if spread.least() > spread.greatest() {
        let found = [spread.least(), spread.greatest()];
        return Err(Mistake::value(key, found, "the lesser bound comes first"));
    }
    Ok(())
}

/// Those of centres and of spins.
fn temperatures<T: Real>(centers: f64, spins: f64) -> Result<(), Mistake> {
    for (key, temperature) in [("temperature", centers), ("spin_temperature", spins)] {
        if !(temperature >= 0.0 && T::from_f64(temperature).is_finite()) {
            let wanted = "a temperature, kT in units of energy, must be finite and not negative";
            return Err(Mistake::value(key, temperature, wanted));
        }
    }
    Ok(())
}

/// What only many spheres have.
fn many<T: Real>(spheres: &Spheres) -> Result<(), Mistake> {
    if spheres.count == 0 {
        return Err(Mistake::value("count", 0, "a count must be at least 1"));
    }
    temperatures::<T>(spheres.temperature, spheres.spin_temperature)?;
    if let Some(density) = spheres.number_density {
        positive::<T>("number_density", density, "a number density")?;
    }
    match spheres.bounds {
        None => Ok(()),
        Some([lower, upper]) => corners::<f64>(lower.into(), upper.into()),
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

/// Radii, masses and moments of inertia. Smooth surfaces change no spin: there a
/// moment of inertia may be too small for the precision.
pub(super) fn figures<T: Real>(bodies: &Bodies<T>, surface: Surface) -> Result<(), Found> {
    let figures =
        [("radius", &bodies.radius), ("mass", &bodies.mass), ("inertia", &bodies.inertia)];
    for (key, figure) in figures {
        let values = match figure {
            PerBody::Same(value) => core::slice::from_ref(value),
            PerBody::Each(column) => column,
        };
        let may_vanish = key == "inertia" && !surface.changes_spins();
        let is_right = |value: &T| {
            value.is_finite() && (*value > T::ZERO || (may_vanish && *value == T::ZERO))
        };
        if let Some(body) = values.iter().position(|value| !is_right(value)) {
            let what = if key == "inertia" { "moment of inertia" } else { key };
            let found = format!(
                "such that the {what} of body {body} is {:?} in {}",
                values[body].to_f64(),
                T::NAME
            );
            let finer = if T::NAME == "f32" { ", or precision = \"f64\"" } else { "" };
            let wanted = format!(
                "it must be finite and greater than 0: take units in which radii and masses are \
                 nearer to 1{finer}"
            );
            return Err((body, "", Problem::Value { found, wanted }));
        }
    }
    Ok(())
}
