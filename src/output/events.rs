//! Events file: one row for each collision.

#[cfg(feature = "study")]
mod arrays;
mod filter;

use std::io;

use crate::engine::{Event, Partner};
use crate::output::{CsvLine, as_io, csv_writer};
use crate::real::Real;
use crate::vec3::Vec3;

#[cfg(feature = "study")]
pub use arrays::EventArrays;
pub use filter::EventFilter;

/// The columns of an events file.
///
/// `x,y,z` is the point of contact, `n` the unit normal from `b` (or the fixed
/// part) to `a`, `jn` and `jt` the normal and the tangential impulse on `a`,
/// the rest the velocities and angular velocities just after. Of two bodies `a`
/// is the one with the lesser number, and `surroundings` is empty; for
/// something fixed it is its number, and `b` with its velocities is empty.
///
/// ```
/// use carom::output::EVENT_COLUMNS;
/// assert_eq!(EVENT_COLUMNS[..4], ["time", "a", "b", "surroundings"]);
/// ```
pub const EVENT_COLUMNS: [&str; 26] = [
    "time",
    "a",
    "b",
    "surroundings",
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "jn",
    "jtx",
    "jty",
    "jtz",
    "vax",
    "vay",
    "vaz",
    "wax",
    "way",
    "waz",
    "vbx",
    "vby",
    "vbz",
    "wbx",
    "wby",
    "wbz",
];

/// Writes collisions as comma-separated values under [`EVENT_COLUMNS`], in the
/// order in which they come.
///
/// ```
/// use carom::output::EventWriter;
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut world = EventDriven::new(scene)?;
/// let mut writer = EventWriter::new(Vec::new())?;
/// world.for_each_event(1.0, |event| writer.record(event))?;
/// writer.check()?;
/// let text = String::from_utf8(writer.finish()?)?;
/// assert!(text.starts_with("time,a,b,surroundings,"));
/// assert!(text.contains("\n0.5,0,1,,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EventWriter<W: io::Write> {
    writer: csv::Writer<W>,
    line: CsvLine,
    failure: Option<io::Error>,
}

impl<W: io::Write> EventWriter<W> {
    /// Starts with the names of the columns.
    ///
    /// # Errors
    /// If the output takes nothing.
    pub fn new(output: W) -> io::Result<Self> {
        let mut writer = csv_writer(output);
        writer.write_record(EVENT_COLUMNS).map_err(as_io)?;
        Ok(Self { writer, line: CsvLine::default(), failure: None })
    }

    /// Goes on after other collisions, without the names of the columns.
    #[must_use]
    pub fn further(output: W) -> Self {
        Self { writer: csv_writer(output), line: CsvLine::default(), failure: None }
    }

    /// Hands all collisions so far on to the output.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn flush(&mut self) -> io::Result<&W> {
        self.check()?;
        self.writer.flush()?;
        Ok(self.writer.get_ref())
    }

    /// Writes one collision. An engine cannot be stopped in the middle of a
    /// step: a failure is kept for [`check`](Self::check), and nothing is
    /// written after it.
    pub fn record<T: Real>(&mut self, event: &Event<T>) {
        if self.failure.is_none() {
            self.failure = self.write(event).err();
        }
    }

    fn write<T: Real>(&mut self, event: &Event<T>) -> io::Result<()> {
        check_finite(event)?;
        let line = &mut self.line;
        line.numbers([event.time]);
        line.shown(event.a);
        match event.partner {
            Partner::Body { index, .. } => {
                line.shown(index);
                line.empty(1);
            }
            Partner::Surroundings(index) => {
                line.empty(1);
                line.shown(index);
            }
        }
        line.numbers(event.point.to_array());
        line.numbers(event.normal.to_array());
        line.numbers([event.normal_impulse]);
        line.numbers(event.tangential_impulse.to_array());
        line.numbers(event.velocity.to_array());
        line.numbers(event.spin.to_array());
        match event.partner {
            Partner::Body { velocity, spin, .. } => {
                line.numbers(velocity.to_array());
                line.numbers(spin.to_array());
            }
            Partner::Surroundings(_) => line.empty(6),
        }
        line.finish(&mut self.writer)
    }

    /// Reports a failure to write any of the collisions so far.
    ///
    /// # Errors
    /// If the output took no more, or if a collision had a figure that is no finite
    /// number ([`InvalidData`](io::ErrorKind::InvalidData)).
    pub fn check(&mut self) -> io::Result<()> {
        self.failure.take().map_or(Ok(()), Err)
    }

    /// Writes what is left, and gives the output back.
    ///
    /// # Errors
    /// If the output takes no more.
    pub fn finish(mut self) -> io::Result<W> {
        self.check()?;
        self.writer.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}

/// Refuses a collision that has a figure that is no finite number.
fn check_finite<T: Real>(event: &Event<T>) -> io::Result<()> {
    if is_finite(event) {
        return Ok(());
    }
    let at = format!("a collision of body {} is no longer finite", event.a);
    Err(io::Error::new(io::ErrorKind::InvalidData, at))
}

/// Whether a collision consists of numbers.
fn is_finite<T: Real>(event: &Event<T>) -> bool {
    let own = [event.point, event.normal, event.tangential_impulse, event.velocity, event.spin];
    let others = match event.partner {
        Partner::Body { velocity, spin, .. } => [velocity, spin],
        Partner::Surroundings(_) => [Vec3::ZERO; 2],
    };
    let is_finite = |vector: &Vec3<T>| vector.to_array().iter().all(|value| value.is_finite());
    event.time.is_finite()
        && event.normal_impulse.is_finite()
        && own.iter().chain(&others).all(is_finite)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(partner: Partner<f32>) -> Event<f32> {
        let vector = |first: f32| Vec3::new(first, first + 0.5, -first);
        Event {
            time: 0.1,
            a: 3,
            partner,
            point: vector(1.0),
            normal: vector(2.0),
            normal_impulse: 0.1,
            tangential_impulse: vector(3.0),
            velocity: vector(4.0),
            spin: vector(5.0),
        }
    }

    #[test]
    fn a_row_has_every_column_and_all_digits() {
        let mut writer = EventWriter::new(Vec::new()).unwrap();
        let velocity = Vec3::new(6.0, 1e-30, 0.0);
        let spin = Vec3::new(7.0, 0.0, -0.0);
        writer.record(&event(Partner::Body { index: 8, velocity, spin }));
        writer.record(&event(Partner::Surroundings(2)));
        let text = String::from_utf8(writer.finish().unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], EVENT_COLUMNS.join(","));
        let common = "1.0,1.5,-1.0,2.0,2.5,-2.0,0.1,3.0,3.5,-3.0,4.0,4.5,-4.0,5.0,5.5,-5.0";
        assert_eq!(lines[1], format!("0.1,3,8,,{common},6.0,1e-30,0.0,7.0,0.0,-0.0"));
        assert_eq!(lines[2], format!("0.1,3,,2,{common},,,,,,"));
        assert!(lines.iter().all(|line| line.split(',').count() == 26));
    }

    #[test]
    fn a_failure_is_kept_until_it_is_checked() {
        struct Full;
        impl io::Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut writer = EventWriter::new(Full).unwrap();
        for _ in 0..10_000 {
            writer.record(&event(Partner::Surroundings(0)));
        }
        assert_eq!(writer.check().unwrap_err().kind(), io::ErrorKind::StorageFull);
    }
}
