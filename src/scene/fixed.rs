//! Fixed: the shapes of a scene file, each in its place.

use std::path::Path;

use super::error::{Problem, SceneError};
use super::origin::Origin;
use super::raw::{KEYS, Number, RawRotation, RawRow, RawSurroundings, Vector, Whole};
use crate::numbers::array::Each;
use crate::surroundings::{
    Copies, Mistake, NO_VECTOR, Placement, Sensor, Shape, ShapeKind, finite, positive, shape_kinds,
};
use crate::vec3::Vec3;

/// One entry of the surroundings, with the keys of its shape and no others.
pub(super) fn shape(
    origin: &Origin,
    index: usize,
    raw: &RawSurroundings,
    folder: &Path,
) -> Result<Shape<f64>, SceneError> {
    let entry = format!("surroundings[{index}]");
    let Some(ShapeKind { keys, read, .. }) = raw.shape else {
        let problem = Problem::missing(format!("it is {}", shapes()));
        return Err(origin.error_in(&entry, ("shape", problem)));
    };
    if let Some(key) = KEYS.iter().find(|key| raw.values.has(**key) && !keys.contains(key)) {
        let name = raw.values.shape;
        let keys: Vec<_> = keys.iter().map(|key| key.name).collect();
        let reason = format!("a {name} has {}", keys.join(", "));
        let problem = Problem::conflict(format!("shape = \"{name}\""), reason);
        return Err(origin.error_in(&entry, (key.name, problem)));
    }
    read(&raw.values.in_folder(folder))
        .and_then(|shape| copied(shape, raw))
        .and_then(|shape| placed(shape, raw))
        .map(|shape| if raw.sensor { Sensor::new(shape).into() } else { shape })
        .map_err(|mistake| origin.error_in(&entry, mistake))
}

/// The names of all shapes, with an "or" before the last.
fn shapes() -> String {
    let names = shape_kinds().flat_map(ShapeKind::names);
    let names: Vec<_> = names.map(|name| format!("\"{name}\"")).collect();
    let names = names.join(", ");
    names.rsplit_once(", ").map_or(names.clone(), |(first, last)| format!("{first} or {last}"))
}

/// The shape of an entry with its copies, if it has some.
fn copied(shape: Shape<f64>, raw: &RawSurroundings) -> Result<Shape<f64>, Mistake> {
    let Some(rows) = &raw.copies else { return Ok(shape) };
    let mut copies = Copies::new(shape);
    for RawRow { count, step } in rows {
        let Whole(count) = count
            .ok_or_else(|| Mistake::missing("copies", "each of them has a count of shapes"))?;
        let Vector(step) = step
            .ok_or_else(|| Mistake::missing("copies", "each of them has a step, three numbers"))?;
        copies = copies.along(step, count);
    }
    // In the words of the file, before it is moved.
    let copies = Shape::from(copies);
    copies.check().map(|()| copies)
}

/// The shape of an entry where its placement puts it, if it has one.
fn placed(shape: Shape<f64>, raw: &RawSurroundings) -> Result<Shape<f64>, Mistake> {
    if raw.scale.is_none() && raw.rotation.is_none() && raw.translation.is_none() {
        return Ok(shape);
    }
    // In the words of the file, before it is moved.
    shape.check()?;
    Ok(shape.placed(&placement(raw)?))
}

/// Scaled, then turned, then moved.
fn placement(raw: &RawSurroundings) -> Result<Placement<f64>, Mistake> {
    let mut placement = Placement::NONE;
    if let Some(Number(scale)) = raw.scale {
        positive::<f64>("scale", scale, "a scale")?;
        placement = placement.scaled(scale);
    }
    if let Some(RawRotation { axis, angle, center }) = raw.rotation {
        let Vector(axis) = axis.ok_or_else(|| Mistake::missing("rotation.axis", NO_VECTOR))?;
        let Number(angle) = angle
            .ok_or_else(|| Mistake::missing("rotation.angle", "an angle in rad belongs here"))?;
        let Vector(center) = center.unwrap_or(Vector([0.0; 3]));
        let [axis, center] = [axis, center].each(Vec3::from);
        let length = axis.length();
        if !(length.is_normal() && (1.0 / length).is_normal()) {
            let wanted = "an axis must be finite and have a length greater than 0";
            return Err(Mistake::value("rotation.axis", axis.to_array(), wanted));
        }
        if !angle.is_finite() {
            return Err(Mistake::value("rotation.angle", angle, "an angle must be finite, in rad"));
        }
        finite::<f64>("rotation.center", center, "every component")?;
        placement = placement.turned(axis, angle, center);
    }
    if let Some(Vector(shift)) = raw.translation {
        finite::<f64>("translation", shift.into(), "every component")?;
        placement = placement.moved(shift.into());
    }
    Ok(placement)
}
