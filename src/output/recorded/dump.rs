//! The text dump of LAMMPS.

use super::bodies::{Columns, checked_count, wanted};
use super::lines::{Lines, finite, number};
use super::{RecordedFrame, Wrong};
use crate::space::PeriodicBox;

/// Reads a frame; `None` behind the last one.
pub fn read(lines: &mut Lines, in_full: bool) -> Result<Option<RecordedFrame>, Wrong> {
    let mut time = None;
    let mut count = None;
    let mut space = None;
    let mut is_first = true;
    loop {
        let line = if is_first {
            match lines.next()? {
                None => return Ok(None),
                Some(line) => line,
            }
        } else {
            lines.within()?
        };
        is_first = false;
        let Some(item) = line.strip_prefix("ITEM: ").map(str::to_owned) else {
            let cut: String = line.chars().take(40).collect();
            return Err(lines.wrong(format!("{cut:?} stands where an ITEM: of a dump is to be")));
        };
        if item == "TIMESTEP" {
            let step = number::<u64>(lines.within()?, "a number of steps");
            step.map_err(|problem| lines.wrong(problem))?;
        } else if item == "UNITS" {
            lines.within()?;
        } else if item == "TIME" {
            let found = finite(lines.within()?);
            time = Some(found.map_err(|problem| lines.wrong(problem))?);
        } else if item == "NUMBER OF ATOMS" {
            let found = number(lines.within()?, "a number of bodies").and_then(checked_count);
            count = Some(found.map_err(|problem| lines.wrong(problem))?);
        } else if let Some(sides) = item.strip_prefix("BOX BOUNDS") {
            space = bounds(lines, sides)?;
        } else if let Some(names) = item.strip_prefix("ATOMS ") {
            let Some(count) = count else {
                return Err(lines.wrong("there is no ITEM: NUMBER OF ATOMS before it"));
            };
            let columns = rows(lines, names, count, in_full)?;
            let (bodies, images) = columns.bodies().map_err(|problem| lines.wrong(problem))?;
            return Ok(Some(RecordedFrame { time, bodies, space, images }));
        } else {
            return Err(lines.wrong(format!("ITEM: {item} is none that is known")));
        }
    }
}

fn bounds(lines: &mut Lines, sides: &str) -> Result<Option<PeriodicBox<f64>>, Wrong> {
    let sides: Vec<&str> = sides.split_whitespace().collect();
    let periodic = sides.iter().filter(|side| **side == "pp").count();
    if sides.len() > 3 || !(periodic == 0 || periodic == 3) {
        let problem = "the box is neither one with right angles and three periodic sides, nor open";
        return Err(lines.wrong(problem));
    }
    let (mut lower, mut upper) = ([0.0; 3], [0.0; 3]);
    for axis in 0..3 {
        let ends = lines.within()?.split_whitespace().map(finite).collect::<Result<Vec<_>, _>>();
        match ends {
            Ok(ends) if ends.len() == 2 && ends[0] < ends[1] => {
                (lower[axis], upper[axis]) = (ends[0], ends[1]);
            }
            Ok(_) => return Err(lines.wrong("the two ends of a side are to be here")),
            Err(problem) => return Err(lines.wrong(problem)),
        }
    }
    Ok((periodic == 3).then(|| PeriodicBox::new(lower, upper)))
}

fn rows(lines: &mut Lines, names: &str, count: usize, in_full: bool) -> Result<Columns, Wrong> {
    let names: Vec<&str> = names.split_whitespace().collect();
    // Unwrapped coordinates serve too, and need no images.
    let is_unwrapped = !names.contains(&"x") && names.contains(&"xu");
    let has_own = |name: &str| names.iter().any(|other| own_name(other) == name);
    let places: Vec<Option<usize>> = names
        .iter()
        .map(|name| match (own_name(name), is_unwrapped) {
            ("xu" | "yu" | "zu", true) => Columns::place(&name[..1]),
            ("ix" | "iy" | "iz", true) => None,
            (name, _) if wanted(name, in_full, |other| has_own(other)) => Columns::place(name),
            _ => None,
        })
        .collect();
    let has = |name: &str| places.contains(&Columns::place(name));
    Columns::check(has).map_err(|problem| lines.wrong(problem))?;
    let mut columns = Columns::default();
    for _ in 0..count {
        let line = lines.within()?;
        let mut fields = line.split_ascii_whitespace();
        let mut problem = None;
        for (place, name) in places.iter().zip(&names) {
            let Some(field) = fields.next() else {
                problem = Some(format!("there is no {name} of this body"));
                break;
            };
            let Some(place) = place else { continue };
            match finite(field) {
                Ok(value) => columns.values[*place].push(value),
                Err(mistake) => {
                    problem = Some(format!("{name}: {mistake}"));
                    break;
                }
            }
        }
        if problem.is_none() && fields.next().is_some() {
            problem = Some("there are more values than columns".to_owned());
        }
        if let Some(problem) = problem {
            return Err(lines.wrong(problem));
        }
    }
    Ok(columns)
}

/// What a column of a dump is called here.
fn own_name(name: &str) -> &str {
    match name {
        "omegax" => "wx",
        "omegay" => "wy",
        "omegaz" => "wz",
        "quatw" => "qw",
        "quati" => "qx",
        "quatj" => "qy",
        "quatk" => "qz",
        name => name,
    }
}
