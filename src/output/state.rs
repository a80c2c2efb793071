//! State file: all bodies at one time.

use std::io;

use crate::bodies::Bodies;
use crate::observe::not_finite;
use crate::output::{CsvLine, as_io, csv_writer};
use crate::real::Real;

/// The columns of a state file: number of the body, centre, velocity, angular
/// velocity, orientation (body axes to world axes, row by row), radius, mass.
///
/// ```
/// use carom::output::STATE_COLUMNS;
/// assert_eq!((STATE_COLUMNS[0], STATE_COLUMNS[20]), ("id", "mass"));
/// ```
pub const STATE_COLUMNS: [&str; 21] = [
    "id", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "m00", "m01", "m02", "m10", "m11",
    "m12", "m20", "m21", "m22", "radius", "mass",
];

/// Writes bodies as comma-separated values under [`STATE_COLUMNS`], in the
/// order of the scene. Each number has the digits that read back as the same
/// bits in the scene's precision.
///
/// ```
/// # use carom::Bodies;
/// # let ball = Bodies::from_positions(&[[0.1, 0.0, 2.0]]).velocities(&[[1e-9, 0.0, 0.0]]);
/// # let ball = ball.radius(0.5).mass(2.0).build()?;
/// let mut text = Vec::new();
/// carom::output::write_state(&mut text, &ball)?;
/// let rows = String::from_utf8_lossy(&text);
/// assert!(rows.ends_with(
///     "\n0,0.1,0.0,2.0,1e-9,0.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.5,2.0\n"
/// ));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the output takes no more, or if a figure of a body is [no finite
/// number](not_finite), before anything is written.
pub fn write_state<T: Real, W: io::Write>(output: W, bodies: &Bodies<T>) -> io::Result<()> {
    if let Some(found) = not_finite(bodies) {
        return Err(io::Error::new(io::ErrorKind::InvalidData, found.to_string()));
    }
    let mut writer = csv_writer(output);
    writer.write_record(STATE_COLUMNS).map_err(as_io)?;
    let mut line = CsvLine::default();
    for index in 0..bodies.len() {
        line.shown(index);
        line.numbers(bodies.position_of(index).to_array());
        line.numbers(bodies.velocity_of(index).to_array());
        line.numbers(bodies.spin_of(index).to_array());
        line.numbers(bodies.orientation_of(index).rows());
        line.numbers([bodies.radius.of(index), bodies.mass.of(index)]);
        line.finish(&mut writer)?;
    }
    writer.flush()
}
