//! The text dump of LAMMPS, as OVITO and MDAnalysis read it.
//!
//! There is no `ITEM: TIME`, which MDAnalysis takes for the number of atoms.

use std::io;

use super::Frame;
use super::figures::{bounds, quaternion_of};
use super::rows::{self, Figures, numbers, whole};
use crate::numbers::array::Each;
use crate::observe::species;
use crate::real::Real;

/// The columns. `ix iy iz` are the images, the `quat` the orientation.
const COLUMNS: &str = "id type radius mass x y z ix iy iz vx vy vz omegax omegay omegaz \
                       quatw quati quatj quatk";

/// Writes one frame.
pub fn write<T: Real, W: io::Write>(output: &mut W, frame: &Frame<'_, T>) -> io::Result<()> {
    let bodies = frame.bodies;
    let sides = if frame.space.is_some() { "pp pp pp" } else { "ff ff ff" };
    let mut head = Vec::new();
    head.extend_from_slice(format!("ITEM: TIMESTEP\n{}\n", frame.step).as_bytes());
    head.extend_from_slice(format!("ITEM: NUMBER OF ATOMS\n{}\n", bodies.len()).as_bytes());
    head.extend_from_slice(format!("ITEM: BOX BOUNDS {sides}\n").as_bytes());
    let [lower, upper] = bounds(frame);
    for (lower, upper) in lower.into_iter().zip(upper) {
        numbers(&mut head, [lower, upper]);
        head.pop();
        head.push(b'\n');
    }
    head.extend_from_slice(format!("ITEM: ATOMS {COLUMNS}\n").as_bytes());
    output.write_all(&head)?;
    let species = species(bodies);
    let figures = Figures::of(bodies);
    rows::write(output, bodies.len(), |row, index| {
        whole(row, [frame.number(index) + 1, i64::from(species[index])]);
        figures.add(row, bodies, index);
        numbers(row, bodies.position_of(index).to_array());
        whole(row, frame.images.map_or([0; 3], |images| images.of(index)).each(i64::from));
        numbers(row, bodies.velocity_of(index).to_array());
        numbers(row, bodies.spin_of(index).to_array());
        numbers(row, quaternion_of(bodies, index));
    })
}
