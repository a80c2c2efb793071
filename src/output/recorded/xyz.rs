//! Extended XYZ.

use super::bodies::{Columns, checked_count};
use super::lines::{Lines, finite, number};
use super::{RecordedFrame, Wrong};
use crate::numbers::array;
use crate::space::PeriodicBox;

/// Reads a frame; `None` behind the last one.
pub fn read(lines: &mut Lines, in_full: bool) -> Result<Option<RecordedFrame>, Wrong> {
    let Some(line) = lines.next()? else { return Ok(None) };
    let count = number(line, "a number of bodies").and_then(checked_count);
    let count = count.map_err(|problem| lines.wrong(problem))?;
    let heading =
        Heading::parse(lines.within()?, in_full).map_err(|problem| lines.wrong(problem))?;
    let mut columns = Columns::default();
    for _ in 0..count {
        let line = lines.within()?;
        let mut fields = line.split_ascii_whitespace();
        let mut read = || -> Result<(), String> {
            for place in &heading.places {
                let field = fields.next().ok_or("this body has too few values")?;
                if let Some(place) = place {
                    columns.values[*place].push(finite(field)?);
                }
            }
            if fields.next().is_some() {
                Err("this body has too many values".into())
            } else {
                Ok(())
            }
        };
        let read = read();
        read.map_err(|problem| lines.wrong(problem))?;
    }
    let (bodies, images) = columns.bodies().map_err(|problem| lines.wrong(problem))?;
    let Heading { time, space, .. } = heading;
    Ok(Some(RecordedFrame { time, bodies, space, images }))
}

/// What the second line of a frame says.
struct Heading {
    time: Option<f64>,
    space: Option<PeriodicBox<f64>>,
    /// For each value of a row the column that it goes into.
    places: Vec<Option<usize>>,
}

impl Heading {
    fn parse(line: &str, in_full: bool) -> Result<Self, String> {
        let pairs = pairs(line);
        let value =
            |key: &str| pairs.iter().find(|(name, _)| *name == key).map(|(_, value)| *value);
        let numbers =
            |text: &str| text.split_whitespace().map(finite).collect::<Result<Vec<_>, _>>();
        let time = value("Time").map(finite).transpose()?;
        let properties = value("Properties")
            .ok_or("there are no Properties; extended XYZ is to have them here")?;
        let places = places(properties, in_full)?;
        let is_periodic = match value("pbc").map(|pbc| pbc.split_whitespace().collect::<Vec<_>>()) {
            None => value("Lattice").is_some(),
            Some(sides) if sides == ["T"; 3] => true,
            Some(sides) if sides == ["F"; 3] => false,
            Some(_) => return Err("space is periodic along some sides only".to_owned()),
        };
        let lattice = value("Lattice").map(numbers).transpose()?;
        let origin = value("Origin").map(numbers).transpose()?.unwrap_or_else(|| vec![0.0; 3]);
        let space = match lattice {
            Some(lattice) if is_periodic => {
                let is_right = |(k, side): (usize, &f64)| (k % 4 == 0) == (*side > 0.0);
                if lattice.len() != 9 || origin.len() != 3 {
                    return Err("a Lattice has nine numbers, an Origin three".to_owned());
                }
                if !lattice.iter().enumerate().all(is_right) {
                    return Err("the Lattice is no box with right angles".to_owned());
                }
                let upper = array::from_fn(|axis| origin[axis] + lattice[4 * axis]);
                Some(PeriodicBox::new([origin[0], origin[1], origin[2]], upper))
            }
            None if is_periodic => return Err("periodic space needs a Lattice".to_owned()),
            _ => None,
        };
        Ok(Self { time, space, places })
    }
}

/// The pairs `key=value` of a line; a value may stand in quotes.
fn pairs(line: &str) -> Vec<(&str, &str)> {
    let mut pairs = Vec::new();
    let mut rest = line.trim_start();
    while let Some((key, after)) = rest.split_once('=') {
        let key = key.split_whitespace().last().unwrap_or_default();
        let (value, left) = match after.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None => after.split_once(char::is_whitespace).unwrap_or((after, "")),
        };
        pairs.push((key, value));
        rest = left.trim_start();
    }
    pairs
}

/// Where the values of a row go, by `name:type:count` of each property.
fn places(properties: &str, in_full: bool) -> Result<Vec<Option<usize>>, String> {
    let fields: Vec<&str> = properties.split(':').collect();
    if !fields.len().is_multiple_of(3) {
        return Err("Properties are name:type:count of each".to_owned());
    }
    let mut places = Vec::new();
    for property in fields.chunks(3) {
        let count: usize = number(property[2], "a number of values")?;
        if count > 100 {
            return Err(format!("{} has {count} values", property[0]));
        }
        let names: &[&str] = match property[0] {
            "pos" => &["x", "y", "z"],
            "velo" => &["vx", "vy", "vz"],
            "image" => &["ix", "iy", "iz"],
            "radius" => &["radius"],
            "mass" => &["mass"],
            "id" => &["id"],
            "omega" if in_full && count == 3 => &["wx", "wy", "wz"],
            "orientation" if in_full && count == 4 => &["qx", "qy", "qz", "qw"],
            _ => &[],
        };
        if !names.is_empty() && names.len() != count {
            return Err(format!("{} has {count} values, not {}", property[0], names.len()));
        }
        places.extend((0..count).map(|k| names.get(k).and_then(|name| Columns::place(name))));
    }
    Columns::check(|name| places.contains(&Columns::place(name)))?;
    Ok(places)
}
