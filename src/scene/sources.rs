//! Sources: the inlets of a scene file.

use super::error::{Problem, SceneError};
use super::inlet::{Inlet, Opening};
use super::origin::Origin;
use super::raw::{Number, RawInlet, Vector, Whole};
use super::spheres::Make;
use crate::surroundings::{Mistake, NO_VECTOR, positive};

/// One entry of the inlets.
pub(super) fn inlet(origin: &Origin, index: usize, raw: &RawInlet) -> Result<Inlet, SceneError> {
    let entry = format!("inlet[{index}]");
    let fail = |mistake: Mistake| origin.error_in(&entry, mistake);
    let number = |value: Option<Number>| value.map(|Number(value)| value);
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
        make: Make {
            radius: raw.radius,
            mass: raw.mass,
            density: raw.density,
            inertia_factor: number(raw.inertia_factor).unwrap_or(0.4),
            velocity: raw.velocity.map_or([0.0; 3], |Vector(velocity)| velocity),
            spin: raw.spin.map_or([0.0; 3], |Vector(spin)| spin),
        },
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
    let vector = |key: &'static str, value: Option<Vector>| {
        let missing = || origin.error_in(entry, Mistake::missing(key, NO_VECTOR));
        value.map(|Vector(vector)| vector).ok_or_else(missing)
    };
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
