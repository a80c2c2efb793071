//! Copies: a shape again and again, at equal steps.

use super::entry::{Key, ShapeEntry};
use super::mistake::{Mistake, finite};
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::Solid;
use super::{Feature, Shape};
use crate::real::Real;
use crate::space::{Bounds, joined};
use crate::vec3::Vec3;

/// The most there can be, and rows of rows.
const MOST: u64 = 1 << 20;
const MOST_ROWS: usize = 3;

/// A shape and copies of it in rows, at equal steps: the pins of a board, a bundle of tubes,
/// the spheres of a lattice. All together are one part.
///
/// In a scene file: `copies`, a list of up to three `{ count, step }`, beside the keys of the
/// shape.
///
/// ```
/// use carom::surroundings::{Copies, FixedSphere, Shape};
/// use carom::vec3::Vec3;
///
/// let pin = FixedSphere::solid([0.0; 3], 0.25);
/// let board = Copies::new(pin).along([1.0, 0.0, 0.0], 4).along([0.5, 0.0, -1.0], 3);
/// let pins = Shape::from(board).features();
/// assert_eq!(pins.len(), 12);
/// assert_eq!(pins[11].clearance(Vec3::new(4.0, 0.0, -1.0), 0.5).gap, 0.25);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Copies<T> {
    shape: Box<Shape<T>>,
    rows: Vec<Row<T>>,
}

/// As many shapes, each a step from the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row<T> {
    /// Length.
    step: Vec3<T>,
    count: u64,
}

impl<T: Real> Copies<T> {
    /// A shape with no copies yet.
    ///
    /// ```
    /// use carom::surroundings::{Copies, Cuboid, Shape};
    /// let brick = Shape::from(Copies::new(Cuboid::solid([0.0; 3], [2.0, 1.0, 1.0])));
    /// assert_eq!(brick.features().len(), 1);
    /// ```
    #[must_use]
    pub fn new(shape: impl Into<Shape<T>>) -> Self {
        Self { shape: Box::new(shape.into()), rows: Vec::new() }
    }

    /// `count` in place of each one there is, a step, length, from one to the next.
    ///
    /// ```
    /// use carom::surroundings::{Copies, FixedSphere, Shape};
    /// let ball = FixedSphere::solid([0.0; 3], 1.0);
    /// let pair = Shape::from(Copies::new(ball).along([0.0, 0.0, 3.0], 2));
    /// assert_eq!(pair.features().len(), 2);
    /// ```
    #[must_use]
    pub fn along(mut self, step: [T; 3], count: u64) -> Self {
        self.rows.push(Row { step: step.into(), count });
        self
    }

    /// How many shapes there are.
    fn number(&self) -> u64 {
        self.rows.iter().map(|row| row.count).fold(1, u64::saturating_mul)
    }

    /// The one that is a number of steps along each row.
    fn after(&self, steps: impl Iterator<Item = u64>) -> Shape<T> {
        let shift =
            self.rows.iter().zip(steps).fold(Vec3::ZERO, |shift, (row, steps)| {
                shift + row.step * T::from_f64(steps as f64)
            });
        self.shape.moved(shift.to_array())
    }

    /// One of them.
    fn copy(&self, number: u64) -> Shape<T> {
        let mut rest = number;
        self.after(self.rows.iter().map(|row| {
            let steps = rest % row.count;
            rest /= row.count;
            steps
        }))
    }

    /// Those at the ends of all rows.
    fn outermost(&self) -> impl Iterator<Item = Shape<T>> {
        let corners = 0..1_u32 << self.rows.len().min(MOST_ROWS);
        corners.map(|corner| {
            self.after(
                self.rows.iter().enumerate().map(|(k, row)| {
                    if corner >> k & 1 == 0 { 0 } else { row.count.saturating_sub(1) }
                }),
            )
        })
    }
}

impl<T: Real> Solid<T> for Copies<T> {
    type In<B: Real> = Copies<B>;

    const NAME: &'static str = "row of copies";
    /// No shape of a scene file: any shape may have copies there.
    const KEYS: &'static [Key] = &[];

    fn read(entry: &ShapeEntry) -> Result<Copies<f64>, Mistake> {
        Err(Mistake::described("shape", entry.shape, "copies are a shape with the key copies"))
    }

    fn check(&self) -> Result<(), Mistake> {
        self.shape.check()?;
        let described = |wanted: &str| {
            Err(Mistake::described("copies", format!("of a {}", self.shape.name()), wanted))
        };
        if self.shape.is_container() {
            return described("a container has no copies: spheres are in one of them only");
        }
        if self.shape.mesh().is_some() {
            return described("a surface of triangles has no copies; give each an entry");
        }
        if self.shape.is_sensor() || matches!(*self.shape, Shape::Copies(_)) {
            return described("a shape that spheres touch belongs here");
        }
        if self.rows.len() > MOST_ROWS {
            let found = format!("{} rows", self.rows.len());
            return Err(Mistake::described("copies", found, "there can be three at most"));
        }
        for row in &self.rows {
            finite::<T>("copies", row.step.cast(), "every component of a step")?;
            if row.count == 0 {
                return Err(Mistake::value("copies", row.count, "a row has a count from 1"));
            }
            if row.count > 1 && row.step == Vec3::ZERO {
                let wanted = "a row of more than one has a step greater than 0";
                return Err(Mistake::value("copies", row.step.to_array(), wanted));
            }
        }
        if self.number() > MOST {
            let wanted = format!("there can be {MOST} at most");
            return Err(Mistake::value("copies", self.number(), wanted));
        }
        self.outermost().try_for_each(|shape| shape.check())
    }

    fn cast<B: Real>(&self) -> Copies<B> {
        let rows = self.rows.iter().map(|row| Row { step: row.step.cast(), count: row.count });
        Copies { shape: Box::new(self.shape.cast()), rows: rows.collect() }
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        // Many of them are small in a picture.
        let around = [(16, detail.around), (256, 24), (4096, 12)];
        let around = around.iter().find(|(count, _)| self.number() <= *count);
        let around = around.map_or(12, |(_, around)| *around).min(detail.around);
        let detail = Detail { around, ..*detail };
        (0..self.number()).flat_map(|number| self.copy(number).skin(&detail)).collect()
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.outermost().flat_map(|shape| shape.points()).collect()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        let rows = self.rows.iter().map(|row| Row { step: at.way(row.step), ..*row });
        Self { shape: Box::new(self.shape.placed(at)), rows: rows.collect() }
    }

    fn features(&self) -> Vec<Feature<T>> {
        (0..self.number()).flat_map(|number| self.copy(number).features()).collect()
    }

    fn count(&self) -> usize {
        self.shape.count() * self.number() as usize
    }

    fn extent(&self) -> Option<Bounds<T>> {
        let bounds: Option<Vec<_>> = self.outermost().map(|shape| shape.bounds()).collect();
        bounds?.into_iter().reduce(joined)
    }

    fn area(&self) -> Option<T> {
        self.shape.area().map(|area| area * T::from_f64(self.number() as f64))
    }

    fn is_thin(&self) -> bool {
        self.shape.is_thin()
    }
}
