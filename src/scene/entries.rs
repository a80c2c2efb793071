//! Entries: the spheres and the inlets of a scene file.

use super::description::Entry;
use super::error::{Problem, SceneError};
use super::inlet::{Inlet, Opening};
use super::origin::Origin;
use super::raw::{Number, RawInlet, RawSpheres, Vector, Whole, number};
use super::spheres::{Make, Sphere, Spheres, Spread};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::surroundings::{Mistake, NO_VECTOR, positive};

/// The value of a key that has to be there.
pub(super) fn required(
    origin: &Origin,
    entry: &str,
    key: &'static str,
    value: Option<Vector>,
) -> Result<[f64; 3], SceneError> {
    value
        .map(|Vector(vector)| vector)
        .ok_or_else(|| origin.error_in(entry, Mistake::missing(key, NO_VECTOR)))
}

/// One entry of spheres, with the keys of one or of many.
pub(super) fn spheres<T: Real>(
    origin: &Origin,
    index: usize,
    raw: &RawSpheres,
) -> Result<Entry<T>, SceneError> {
    let entry = format!("spheres[{index}]");
    let make = make(raw);
    if let Some(Vector(position)) = raw.position {
        let mut given = of_many(raw).into_iter().chain([
            ("temperature", raw.temperature.is_some()),
            ("spin_temperature", raw.spin_temperature.is_some()),
        ]);
        if let Some((key, _)) = given.find(|(_, given)| *given) {
            let reason = "an entry is one sphere with a position, or a count of them";
            let problem = Problem::conflict("position", reason);
            return Err(origin.error(format!("{entry}.{key}"), problem));
        }
        return Ok(Entry::One(Sphere { position, make }));
    }
    let Some(Whole(count)) = raw.count else {
        let wanted = "an entry is one sphere with a position, a count of them, or a file";
        return Err(origin.error(format!("{entry}.position"), Problem::missing(wanted)));
    };
    let Some(arrangement) = raw.arrangement else {
        let wanted = "it is \"fcc\", \"cubic\" or \"random\"";
        return Err(origin.error(format!("{entry}.arrangement"), Problem::missing(wanted)));
    };
    let bounds = match (raw.lower, raw.upper) {
        (None, None) => None,
        (lower, upper) => Some([
            required(origin, &entry, "lower", lower)?,
            required(origin, &entry, "upper", upper)?,
        ]),
    };
    Ok(Entry::Many(Spheres {
        count,
        arrangement,
        bounds,
        number_density: number(raw.number_density),
        temperature: number(raw.temperature).unwrap_or(0.0),
        spin_temperature: number(raw.spin_temperature).unwrap_or(0.0),
        seed: None,
        make,
    }))
}

/// What spheres are and how they start, apart from their places.
pub(super) fn make(raw: &RawSpheres) -> Make {
    let RawSpheres { radius, mass, density, inertia_factor, velocity, spin, .. } = *raw;
    made(radius, [mass, density], inertia_factor, [velocity, spin])
}

/// The same of spheres or of what comes in by an inlet.
fn made(
    radius: Option<Spread>,
    [mass, density]: [Option<Spread>; 2],
    inertia_factor: Option<Number>,
    motion: [Option<Vector>; 2],
) -> Make {
    let inertia_factor = number(inertia_factor).unwrap_or(0.4);
    let [velocity, spin] =
        motion.each(|given| given.map_or([0.0; 3], |Vector(components)| components));
    Make { radius, mass, density, inertia_factor, velocity, spin }
}

/// The keys of how many spheres there are and where, and whether they are given.
pub(super) fn of_many(raw: &RawSpheres) -> [(&'static str, bool); 5] {
    [
        ("count", raw.count.is_some()),
        ("arrangement", raw.arrangement.is_some()),
        ("lower", raw.lower.is_some()),
        ("upper", raw.upper.is_some()),
        ("number_density", raw.number_density.is_some()),
    ]
}

/// One entry of the inlets.
pub(super) fn inlet(origin: &Origin, index: usize, raw: &RawInlet) -> Result<Inlet, SceneError> {
    let entry = format!("inlet[{index}]");
    let fail = |mistake: Mistake| origin.error_in(&entry, mistake);
    let every = match (raw.every, raw.rate) {
        (Some(_), Some(_)) => {
            let reason = "either makes the other; give one of them";
            return Err(origin.error(format!("{entry}.rate"), Problem::conflict("every", reason)));
        }
        (every, None) => number(every),
        (None, Some(Number(rate))) => {
            positive::<f64>("rate", rate, "a rate").map_err(fail)?;
            Some(1.0 / rate)
        }
    };
    Ok(Inlet {
        opening: opening(origin, &entry, raw)?,
        make: made(
            raw.radius,
            [raw.mass, raw.density],
            raw.inertia_factor,
            [raw.velocity, raw.spin],
        ),
        temperature: number(raw.temperature).unwrap_or(0.0),
        spin_temperature: number(raw.spin_temperature).unwrap_or(0.0),
        every,
        count: raw.count.map(|Whole(count)| count),
        from: number(raw.from).unwrap_or(0.0),
        seed: raw.seed.map(|Whole(seed)| seed),
    })
}

/// Where its spheres come in: the keys of a point, a box or a disc, and no others.
fn opening(origin: &Origin, entry: &str, raw: &RawInlet) -> Result<Opening, SceneError> {
    let given = [
        ("position", raw.position.is_some(), 0),
        ("lower", raw.lower.is_some(), 1),
        ("upper", raw.upper.is_some(), 1),
        ("center", raw.center.is_some(), 2),
        ("axis", raw.axis.is_some(), 2),
        ("reach", raw.reach.is_some(), 2),
    ];
    let mut given = given.into_iter().filter(|(_, is_given, _)| *is_given);
    let Some((first, _, kind)) = given.next() else {
        let wanted = "an inlet is a position, a box from lower to upper, or a disc with center, axis \
                      and reach";
        return Err(origin.error(format!("{entry}.position"), Problem::missing(wanted)));
    };
    if let Some((other, ..)) = given.find(|(_, _, other)| *other != kind) {
        let reason = "an inlet is a position, or a box from lower to upper, or a disc with center, \
                      axis and reach";
        return Err(origin.error(format!("{entry}.{other}"), Problem::conflict(first, reason)));
    }
    let vector = |key, value| required(origin, entry, key, value);
    Ok(match kind {
        0 => Opening::At(vector("position", raw.position)?),
        1 => Opening::Box([vector("lower", raw.lower)?, vector("upper", raw.upper)?]),
        _ => {
            let Some(Number(reach)) = raw.reach else {
                let wanted = "how far from the center of the disc spheres come in";
                return Err(origin.error(format!("{entry}.reach"), Problem::missing(wanted)));
            };
            Opening::Disc(vector("center", raw.center)?, vector("axis", raw.axis)?, reach)
        }
    })
}
