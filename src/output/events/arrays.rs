//! Arrays: collisions as columns of NumPy.

use std::io::{self, Write};
use std::path::Path;

use super::{EVENT_COLUMNS, check_finite};
use crate::engine::{Event, Partner};
use crate::output::is_single;
use crate::output::npz::{Archive, NpzColumn};
use crate::real::Real;

/// Bytes of a column that go to its file at once.
const PIECE: usize = 1 << 15;

/// The columns that hold whole numbers, after the time.
const WHOLE: usize = 3;

/// Writes collisions as a `.npz` archive of one array for each of [`EVENT_COLUMNS`], as
/// `numpy.load` reads it: `time` in double precision, `a`, `b` and `surroundings` as whole
/// numbers of 32 bits, -1 where there is none, all else in the precision of the run, with
/// `nan` for the motion of a partner that is fixed. A third to half of the bytes of text.
///
/// ```
/// use std::path::Path;
/// use carom::output::EventArrays;
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut world = EventDriven::new(scene)?;
/// let folder = tempfile::tempdir()?;
/// let mut arrays = EventArrays::new(&folder.path().join("events.npz"), Vec::new())?;
/// world.for_each_event(1.0, |event| arrays.record(event))?;
/// arrays.check()?;
/// let bytes = arrays.finish()?;
/// assert!(bytes.starts_with(b"PK\x03\x04"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EventArrays<W> {
    output: W,
    columns: Vec<NpzColumn>,
    /// What is not in their files yet.
    pending: Vec<Vec<u8>>,
    events: u64,
    /// What NumPy calls the precision.
    precision: &'static str,
    failure: Option<io::Error>,
}

impl<W: Write> EventArrays<W> {
    /// Collisions that go to `output`, which is or becomes the file at `path`: until the end
    /// they are in files without names in the folder of that.
    ///
    /// # Errors
    /// If these cannot be made.
    pub fn new(path: &Path, output: W) -> io::Result<Self> {
        let columns = EVENT_COLUMNS.iter().map(|name| NpzColumn::beside(path, name));
        let columns = columns.collect::<Result<Vec<_>, _>>()?;
        let pending = columns.iter().map(|_| Vec::with_capacity(PIECE + 8)).collect();
        Ok(Self { output, columns, pending, events: 0, precision: "<f8", failure: None })
    }

    /// Adds one collision. An engine cannot be stopped in the middle of a step: a failure is
    /// kept for [`check`](Self::check), and nothing is written after it.
    pub fn record<T: Real>(&mut self, event: &Event<T>) {
        if self.failure.is_none() {
            self.failure = self.add(event).err();
        }
    }

    fn add<T: Real>(&mut self, event: &Event<T>) -> io::Result<()> {
        check_finite(event)?;
        self.precision = if is_single::<T>()? { "<f4" } else { "<f8" };
        let nothing = [T::from_f64(f64::NAN); 3];
        let (partner, velocity, spin) = match event.partner {
            Partner::Body { index, velocity, spin } => {
                ([index as i32, -1], velocity.to_array(), spin.to_array())
            }
            Partner::Surroundings(part) => ([-1, part as i32], nothing, nothing),
        };
        let mut pending = self.pending.iter_mut();
        let mut next = pending.by_ref();
        if let Some(column) = next.next() {
            column.extend_from_slice(&event.time.to_le_bytes());
        }
        let whole = [event.a as i32, partner[0], partner[1]];
        for (value, column) in whole.into_iter().zip(&mut next) {
            column.extend_from_slice(&value.to_le_bytes());
        }
        let numbers = [
            &event.point.to_array()[..],
            &event.normal.to_array(),
            &[event.normal_impulse],
            &event.tangential_impulse.to_array(),
            &event.velocity.to_array(),
            &event.spin.to_array(),
            &velocity,
            &spin,
        ];
        for (value, column) in numbers.iter().copied().flatten().zip(&mut next) {
            value.write_bits(column);
        }
        self.events += 1;
        if self.pending[0].len() >= PIECE { self.hand_on() } else { Ok(()) }
    }

    fn hand_on(&mut self) -> io::Result<()> {
        for (column, bytes) in self.columns.iter_mut().zip(&mut self.pending) {
            column.add(bytes)?;
            bytes.clear();
        }
        Ok(())
    }

    /// Reports a failure to keep any of the collisions so far.
    ///
    /// # Errors
    /// As [`EventWriter::check`](super::EventWriter::check).
    pub fn check(&mut self) -> io::Result<()> {
        self.failure.take().map_or(Ok(()), Err)
    }

    /// Writes the archive, and gives the output back.
    ///
    /// # Errors
    /// If the output takes no more.
    pub fn finish(mut self) -> io::Result<W> {
        self.check()?;
        self.hand_on()?;
        let shape = format!("({},)", self.events);
        let mut archive = Archive::new(self.output);
        for (number, column) in self.columns.into_iter().enumerate() {
            let kind = match number {
                0 => "<f8",
                number if number <= WHOLE => "<i4",
                _ => self.precision,
            };
            column.store(kind, &shape, &mut archive)?;
        }
        archive.finish()
    }
}
