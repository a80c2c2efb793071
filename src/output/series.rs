//! Time series: figures of a run at times, as comma-separated values.

use std::borrow::Cow;
use std::io;

use super::{CsvLine, as_io, csv_writer};
use crate::engine::PartTotals;
use crate::observe::Sample;

/// What a row is made of.
#[derive(Clone, Copy, Debug)]
struct Row<'a> {
    now: &'a Sample,
    before: Option<&'a Sample>,
    volume: Option<f64>,
}

impl Row<'_> {
    /// A coordinate of the centre of mass, if there is any.
    fn center(&self, axis: usize) -> Option<f64> {
        (self.now.bodies > 0).then(|| self.now.center[axis])
    }

    /// What a part did up to now, and up to the row before and since what time.
    fn part(&self, part: u32) -> Option<(&PartTotals, Option<(&PartTotals, f64)>)> {
        let before = self.before.and_then(|before| before.part(part).zip(self.now.elapsed(before)));
        Some((self.now.part(part)?, before))
    }
}

/// A column of a time series.
#[derive(Clone, Debug)]
pub struct SeriesColumn {
    name: Cow<'static, str>,
    figure: Figure,
    /// Whether it is a whole number.
    is_count: bool,
}

/// What is in a column.
#[derive(Clone, Copy, Debug)]
enum Figure {
    Of(WholeFigure),
    /// Of a part: what it did up to now, and since the row before.
    OfPart(u32, PartFigure),
}

/// A figure of the whole.
type WholeFigure = fn(&Row<'_>) -> Option<f64>;

/// A figure of what a part did up to now, and up to the row before and since what time.
type PartFigure = fn(&PartTotals, Option<(&PartTotals, f64)>) -> Option<f64>;

/// Names a column and says what is in it.
macro_rules! columns {
    ($($name:literal: $figure:expr,)*) => {
        &[$(($name, $figure)),*]
    };
}

/// The columns of counts.
const COUNTS: [&str; 9] = [
    "pairs",
    "surroundings",
    "collisions",
    "inward",
    "outward",
    "spheres",
    "came",
    "waits",
    "removed",
];

/// What a column of a part is called, behind the name of the part.
const PART_COLUMNS: &[(&str, PartFigure)] = columns! {
    "collisions": |now, _| Some(now.collisions as f64),
    "impulse_x": |now, _| Some(now.impulse[0]),
    "impulse_y": |now, _| Some(now.impulse[1]),
    "impulse_z": |now, _| Some(now.impulse[2]),
    "force_x": |now, since| force(now, since, 0),
    "force_y": |now, since| force(now, since, 1),
    "force_z": |now, since| force(now, since, 2),
    "pressure": |now, since| {
        let (before, elapsed) = since?;
        Some(now.since(before).normal_impulse / (elapsed * now.area?))
    },
};

/// The same of a sensor.
const SENSOR_COLUMNS: &[(&str, PartFigure)] = columns! {
    "inward": |now, _| Some(now.passages?.inward as f64),
    "outward": |now, _| Some(now.passages?.outward as f64),
    "flow": |now, since| {
        let (before, elapsed) = since?;
        let passages = now.since(before).passages?;
        Some((passages.inward as f64 - passages.outward as f64) / elapsed)
    },
};

/// The force of a part on the bodies since the row before, in the mean.
fn force(now: &PartTotals, since: Option<(&PartTotals, f64)>, axis: usize) -> Option<f64> {
    let (before, elapsed) = since?;
    Some(now.since(before).impulse[axis] / elapsed)
}

/// What the columns of the whole are called.
const COLUMNS: &[(&str, WholeFigure)] = columns! {
    "time": |row| Some(row.now.time),
    "energy": |row| Some(row.now.energy.total()),
    "kinetic": |row| Some(row.now.energy.kinetic()),
    "translational": |row| Some(row.now.energy.translational),
    "rotational": |row| Some(row.now.energy.rotational),
    "potential": |row| Some(row.now.energy.potential),
    "px": |row| Some(row.now.momentum.0.x),
    "py": |row| Some(row.now.momentum.0.y),
    "pz": |row| Some(row.now.momentum.0.z),
    "temperature": |row| Some(row.now.temperature?.translational),
    "spin_temperature": |row| Some(row.now.temperature?.rotational),
    "pairs": |row| Some(row.now.collisions.pairs as f64),
    "surroundings": |row| Some(row.now.collisions.surroundings as f64),
    "collision_rate": |row| row.now.rate_since(row.before?),
    "surroundings_rate": |row| row.now.surroundings_rate_since(row.before?),
    "compressibility": |row| {
        row.volume?;
        row.now.compressibility_since(row.before?)
    },
    "pressure": |row| row.now.pressure_since(row.before?, row.volume?),
    "force_x": |row| Some(row.now.force_since(row.before?)?[0]),
    "force_y": |row| Some(row.now.force_since(row.before?)?[1]),
    "force_z": |row| Some(row.now.force_since(row.before?)?[2]),
    "center_x": |row| row.center(0),
    "center_y": |row| row.center(1),
    "center_z": |row| row.center(2),
};

/// Those of a scene where spheres come and go.
const FLOW_COLUMNS: &[(&str, WholeFigure)] = columns! {
    "spheres": |row| Some(row.now.bodies as f64),
    "came": |row| Some(row.now.exchange.came.spheres as f64),
    "waits": |row| Some(row.now.exchange.waits as f64),
    "removed": |row| Some(row.now.exchange.removed.spheres as f64),
};

impl SeriesColumn {
    /// The names of all columns, in their order: time, energies, momentum, temperatures
    /// (from two bodies on), collisions since the start, rates, compressibility factor and
    /// pressure (in a periodic box) and the force of the surroundings on the bodies since
    /// the row before, and the centre of mass.
    ///
    /// ```
    /// use carom::output::SeriesColumn;
    /// assert_eq!(SeriesColumn::names().next(), Some("time"));
    /// ```
    pub fn names() -> impl Iterator<Item = &'static str> {
        COLUMNS.iter().map(|(name, _)| *name)
    }

    /// All columns, and those of parts with these names, if they have any, in the order of
    /// the scene: `NAME.collisions` and `NAME.impulse_x` since the start, `NAME.force_x` since
    /// the row before, on the bodies; and so `y` and `z`; `NAME.pressure`, normal impulse over
    /// time and area, of what has an end. A part that is said to be a sensor has
    /// `NAME.inward` and `NAME.outward`, the passages since the start, and `NAME.flow`, those
    /// inward less those outward per time since the row before.
    ///
    /// ```
    /// use carom::output::SeriesColumn;
    /// let columns = SeriesColumn::all([(Some("floor"), false), (None, false)]);
    /// assert_eq!(columns.last().map(SeriesColumn::name), Some("floor.pressure"));
    /// ```
    #[must_use]
    pub fn all<'a>(parts: impl IntoIterator<Item = (Option<&'a str>, bool)>) -> Vec<Self> {
        let of_part = |(part, (name, is_sensor)): (u32, (Option<&str>, bool))| {
            let columns = if is_sensor { SENSOR_COLUMNS } else { PART_COLUMNS };
            let columns = columns.iter().filter_map(move |(column, figure)| {
                let name = format!("{}.{column}", name?);
                Some(Self::new(name.into(), Figure::OfPart(part, *figure), column))
            });
            columns.collect::<Vec<_>>()
        };
        let whole = COLUMNS
            .iter()
            .map(|(name, figure)| Self::new((*name).into(), Figure::Of(*figure), name));
        whole.chain((0..).zip(parts).flat_map(of_part)).collect()
    }

    fn new(name: Cow<'static, str>, figure: Figure, kind: &str) -> Self {
        Self { name, figure, is_count: COUNTS.contains(&kind) }
    }

    /// The columns of a scene where spheres come and go: how many there are, and since the
    /// start how many came, how often one had to wait, and how many were removed.
    ///
    /// ```
    /// use carom::output::SeriesColumn;
    /// assert_eq!(SeriesColumn::of_flow().next().map(|column| column.name().to_owned()).as_deref(), Some("spheres"));
    /// ```
    pub fn of_flow() -> impl Iterator<Item = Self> {
        let columns = FLOW_COLUMNS.iter();
        columns.map(|(name, figure)| Self::new((*name).into(), Figure::Of(*figure), name))
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The column of that name, if there is one, of the whole.
    ///
    /// ```
    /// use carom::output::SeriesColumn;
    /// assert!(SeriesColumn::named("pressure").is_some());
    /// assert!(SeriesColumn::named("presure").is_none());
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::all([]).into_iter().find(|column| column.name == name)
    }

    fn value(&self, row: &Row<'_>) -> Option<f64> {
        match self.figure {
            Figure::Of(figure) => figure(row),
            Figure::OfPart(part, figure) => {
                let (now, since) = row.part(part)?;
                figure(now, since)
            }
        }
    }
}

/// Writes samples as comma-separated values under the names of columns. A figure that
/// means nothing leaves its field empty: rates and what is made of them in the first row,
/// the pressure in open space.
///
/// ```
/// use carom::observe::Sample;
/// use carom::output::{SeriesColumn, SeriesWriter};
/// use carom::{Execution, Scene, Sphere};
/// use carom::engine::World;
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut world = World::new(scene, Execution::default())?;
/// let columns = ["time", "energy", "pairs", "collision_rate"];
/// let columns = columns.into_iter().filter_map(SeriesColumn::named).collect();
/// let mut series = SeriesWriter::new(Vec::new(), columns, None)?;
/// series.row(Sample::of(&world, &world.bodies(), None))?;
/// world.advance(1.0)?;
/// series.row(Sample::of(&world, &world.bodies(), None))?;
/// let text = String::from_utf8(series.finish()?)?;
/// assert_eq!(text, "time,energy,pairs,collision_rate\n0.0,1.0,0,\n1.0,1.0,1,1.0\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SeriesWriter<W: io::Write> {
    writer: csv::Writer<W>,
    line: CsvLine,
    columns: Vec<SeriesColumn>,
    volume: Option<f64>,
    before: Option<Sample>,
}

impl<W: io::Write> SeriesWriter<W> {
    /// Starts with the names of the columns. `volume` is that of a periodic box, length³.
    ///
    /// # Errors
    /// If the output takes nothing.
    pub fn new(output: W, columns: Vec<SeriesColumn>, volume: Option<f64>) -> io::Result<Self> {
        let mut writer = csv_writer(output);
        writer.write_record(columns.iter().map(SeriesColumn::name)).map_err(as_io)?;
        Ok(Self { writer, line: CsvLine::default(), columns, volume, before: None })
    }

    /// Goes on after other rows, without the names of the columns.
    #[must_use]
    pub fn further(output: W, columns: Vec<SeriesColumn>, volume: Option<f64>) -> Self {
        let writer = csv_writer(output);
        Self { writer, line: CsvLine::default(), columns, volume, before: None }
    }

    /// Rates of the next row are of the time since this sample.
    #[must_use]
    pub fn after(self, before: Option<Sample>) -> Self {
        Self { before, ..self }
    }

    /// Hands all rows so far on to the output.
    ///
    /// # Errors
    /// If the output takes no more.
    pub fn flush(&mut self) -> io::Result<&W> {
        self.writer.flush()?;
        Ok(self.writer.get_ref())
    }

    /// The sample of the last row.
    #[must_use]
    pub fn last(&self) -> Option<Sample> {
        self.before.clone()
    }

    /// Writes a sample, which is later than the one before.
    ///
    /// # Errors
    /// If the output takes no more, or if a figure is no finite number
    /// ([`InvalidData`](io::ErrorKind::InvalidData)).
    pub fn row(&mut self, sample: Sample) -> io::Result<()> {
        let row = Row { now: &sample, before: self.before.as_ref(), volume: self.volume };
        for column in &self.columns {
            match column.value(&row) {
                None => self.line.empty(1),
                Some(value) if !value.is_finite() => {
                    let message = format!("{} is no longer finite", column.name);
                    return Err(io::Error::new(io::ErrorKind::InvalidData, message));
                }
                Some(value) if column.is_count => self.line.shown(value),
                Some(value) => self.line.numbers([value]),
            }
        }
        self.before = Some(sample);
        self.line.finish(&mut self.writer)
    }

    /// Writes what is left, and gives the output back.
    ///
    /// # Errors
    /// If the output takes no more.
    pub fn finish(self) -> io::Result<W> {
        self.writer.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}
