//! Bodies of a frame, from the columns that a file has of them.

use crate::bodies::Bodies;
use crate::scene::MOST_BODIES;

/// What the columns of frames are called here.
pub const NAMES: [&str; 19] = [
    "x", "y", "z", "vx", "vy", "vz", "radius", "mass", "ix", "iy", "iz", "wx", "wy", "wz", "qw",
    "qx", "qy", "qz", "id",
];

/// Columns that no analysis looks at: spins and orientations.
const ROTATION: [&[&str]; 2] = [&["wx", "wy", "wz"], &["qw", "qx", "qy", "qz"]];

/// The columns that are read of those that there are: of rotation none or all that belong
/// together.
pub fn wanted(name: &str, in_full: bool, has: impl Fn(&str) -> bool) -> bool {
    let together = ROTATION.iter().find(|together| together.contains(&name));
    together.is_none_or(|together| in_full && together.iter().all(|name| has(name)))
}

/// The columns of a frame under way, in the order of [`NAMES`]; empty where there is none.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    pub values: [Vec<f64>; NAMES.len()],
}

/// How many bodies a frame may have.
pub fn checked_count(count: u64) -> Result<usize, String> {
    if (1..=MOST_BODIES).contains(&count) {
        return Ok(count as usize);
    }
    Err(format!("a frame of {count} bodies; it must have from 1 to {MOST_BODIES}"))
}

/// Bodies, and the whole boxes that they have moved through.
pub type Found = (Bodies<f64>, Option<Vec<[i32; 3]>>);

impl Columns {
    /// The place of a name.
    pub fn place(name: &str) -> Option<usize> {
        NAMES.iter().position(|other| *other == name)
    }

    /// A mistake in what columns there are.
    pub fn check(has: impl Fn(&str) -> bool) -> Result<(), String> {
        for name in ["x", "y", "z", "radius"] {
            if !has(name) {
                return Err(format!("there is no {name}; frames need x, y, z and radius"));
            }
        }
        for together in [["vx", "vy", "vz"], ["ix", "iy", "iz"]] {
            let count = together.iter().filter(|name| has(name)).count();
            if count != 0 && count != 3 {
                return Err(format!("{} belong together", together.join(", ")));
            }
        }
        Ok(())
    }

    /// The bodies, in the order of their `id` if there is one.
    pub fn bodies(mut self) -> Result<Found, String> {
        self.sort()?;
        let [x, y, z, vx, vy, vz, radius, mass, ix, iy, iz, wx, wy, wz, qw, qx, qy, qz, _] =
            &self.values;
        let vectors = |x: &[f64], y: &[f64], z: &[f64]| -> Vec<[f64; 3]> {
            x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]).collect()
        };
        for (name, column) in [("radius", radius), ("mass", mass)] {
            if let Some(index) = column.iter().position(|it| *it <= 0.0) {
                let value = column[index];
                return Err(format!("body {index} has a {name} of {value:?}; it must be above 0"));
            }
        }
        let positions = vectors(x, y, z);
        let velocities = vectors(vx, vy, vz);
        let spins = vectors(wx, wy, wz);
        let quaternions = qw.iter().zip(qx).zip(qy).zip(qz);
        let orientations: Vec<[f64; 9]> =
            quaternions.map(|(((w, x), y), z)| rotation([*w, *x, *y, *z])).collect();
        let mut builder = Bodies::from_positions(&positions).radii(radius);
        if !velocities.is_empty() {
            builder = builder.velocities(&velocities);
        }
        if !spins.is_empty() {
            builder = builder.spins(&spins);
        }
        if !orientations.is_empty() {
            builder = builder.orientations(&orientations);
        }
        if !mass.is_empty() {
            builder = builder.masses(mass);
        }
        let bodies = builder.build().map_err(|error| error.to_string())?;
        let images = ix.iter().zip(iy).zip(iz).map(|((x, y), z)| [*x as i32, *y as i32, *z as i32]);
        Ok((bodies, (!ix.is_empty()).then(|| images.collect())))
    }

    fn sort(&mut self) -> Result<(), String> {
        let id = core::mem::take(&mut self.values[NAMES.len() - 1]);
        if id.windows(2).all(|pair| pair[0] < pair[1]) {
            return Ok(());
        }
        let mut order: Vec<usize> = (0..id.len()).collect();
        order.sort_by(|a, b| id[*a].total_cmp(&id[*b]));
        if let Some(pair) = order.windows(2).find(|pair| id[pair[0]] == id[pair[1]]) {
            return Err(format!("two bodies of a frame have the id {:?}", id[pair[0]]));
        }
        for column in self.values.iter_mut().filter(|column| !column.is_empty()) {
            *column = order.iter().map(|index| column[*index]).collect();
        }
        Ok(())
    }
}

/// The rows of the rotation of a quaternion of any length; of none where that is 0.
fn rotation([w, x, y, z]: [f64; 4]) -> [f64; 9] {
    let square = w * w + x * x + y * y + z * z;
    let twice = if square > 0.0 { 2.0 / square } else { 0.0 };
    [
        1.0 - twice * (y * y + z * z),
        twice * (x * y - w * z),
        twice * (x * z + w * y),
        twice * (x * y + w * z),
        1.0 - twice * (x * x + z * z),
        twice * (y * z - w * x),
        twice * (x * z - w * y),
        twice * (y * z + w * x),
        1.0 - twice * (x * x + y * y),
    ]
}
