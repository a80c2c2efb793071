//! Extended XYZ, as OVITO, MDAnalysis and ASE read it.

use std::io;

use super::Frame;
use super::figures::{bounds, quaternion_of};
use super::rows::{self, Figures, numbers, whole};
use crate::numbers::array::{self, Each};
use crate::observe::species;
use crate::real::Real;

/// The columns, with the names that OVITO knows; its quaternions end with w.
const PROPERTIES: &str = "species:S:1:pos:R:3:id:I:1:radius:R:1:mass:R:1:image:I:3:velo:R:3:\
                          omega:R:3:orientation:R:4";

/// Writes one frame.
pub fn write<T: Real, W: io::Write>(output: &mut W, frame: &Frame<'_, T>) -> io::Result<()> {
    let bodies = frame.bodies;
    let [lower, upper] = bounds(frame);
    let [x, y, z]: [T; 3] = array::from_fn(|axis| upper[axis] - lower[axis]);
    let zero = T::ZERO;
    let mut head = format!("{}\nLattice=\"", bodies.len()).into_bytes();
    numbers(&mut head, [x, zero, zero, zero, y, zero, zero, zero, z]);
    head.pop();
    head.extend_from_slice(b"\" Origin=\"");
    numbers(&mut head, lower);
    head.pop();
    head.extend_from_slice(format!("\" Properties={PROPERTIES} Time=").as_bytes());
    numbers(&mut head, [frame.time]);
    let periodic = if frame.space.is_some() { "T T T" } else { "F F F" };
    head.extend_from_slice(format!("pbc=\"{periodic}\"\n").as_bytes());
    output.write_all(&head)?;
    let species = species(bodies);
    let are_alike = species.iter().all(|kind| *kind == 1);
    let figures = Figures::of(bodies);
    rows::write(output, bodies.len(), |row, index| {
        row.push(b'X');
        if !are_alike {
            row.extend_from_slice(species[index].to_string().as_bytes());
        }
        row.push(b' ');
        numbers(row, bodies.position_of(index).to_array());
        whole(row, [frame.number(index)]);
        figures.add(row, bodies, index);
        whole(row, frame.images.map_or([0; 3], |images| images.of(index)).each(i64::from));
        numbers(row, bodies.velocity_of(index).to_array());
        numbers(row, bodies.spin_of(index).to_array());
        let [w, x, y, z] = quaternion_of(bodies, index);
        numbers(row, [x, y, z, w]);
    })
}
