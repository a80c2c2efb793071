//! Heightfield: a surface over a grid, by its heights.

use super::Feature;
use super::entry::{FILE, Key, Meaning, ShapeEntry};
use super::mesh::{Mesh, MeshError};
use super::mistake::Mistake;
use super::placement::Placement;
use super::solid::Solid;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::Bounds;
use crate::vec3::Vec3;

/// A thin surface fixed in space over a grid in the x-y plane, by its height at each point
/// of the grid: a [`Mesh`] of two triangles a cell, cut from the corner with the least
/// coordinates to that with the greatest.
///
/// In a scene file: `shape = "heightfield"` with `origin`, two numbers, or three to add to
/// all heights; `spacing`, a number, or one each along x and y; `columns`, how many points
/// there are along x, `rows`, how many along y, and `heights`, row by row; or in place of
/// these three `file`, the path of a CSV file of heights, a line for each row, from the
/// folder of the scene file.
///
/// ```
/// use carom::surroundings::{Heightfield, Shape};
/// use carom::vec3::Vec3;
///
/// let slope = [0.0, 0.0, 3.0, 3.0];
/// let field = Heightfield::new([0.0; 3], [4.0, 4.0], 2, &slope)?;
/// assert!(field.mesh().vertices().contains(&Vec3::new(4.0, 4.0, 3.0)));
/// let below = Vec3::new(2.0, 2.0, -1.0);
/// let tiles = Shape::from(field).features();
/// assert_eq!(tiles[0].clearance(below, 1.0).gap, 1.0);
/// # Ok::<(), carom::surroundings::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Heightfield<T> {
    mesh: Mesh<T>,
}

impl<T: Real> Heightfield<T> {
    /// From the corner of the grid with the least coordinates, the distances of its points
    /// along x and y, how many there are along x, and the heights over that corner, row by
    /// row; lengths.
    ///
    /// ```
    /// use carom::surroundings::Heightfield;
    /// let heights = [0.0_f64; 12];
    /// assert!(Heightfield::new([0.0; 3], [1.0; 2], 4, &heights).is_ok());
    /// assert!(Heightfield::new([0.0; 3], [1.0; 2], 5, &heights).is_err());
    /// ```
    ///
    /// # Errors
    /// If there are fewer than two columns or rows, the heights do not fill the rows, or a
    /// number is not finite.
    pub fn new(
        origin: [T; 3],
        spacing: [T; 2],
        columns: usize,
        heights: &[T],
    ) -> Result<Self, MeshError> {
        let rows = heights.len().checked_div(columns).unwrap_or(0);
        if columns < 2 || rows < 2 || rows * columns != heights.len() {
            return Err(MeshError::NoGrid { columns, heights: heights.len() });
        }
        let whole = |number: usize| T::from_f64(number as f64);
        let vertices: Vec<[T; 3]> = heights
            .iter()
            .enumerate()
            .map(|(k, &height)| {
                let [x, y] = [whole(k % columns) * spacing[0], whole(k / columns) * spacing[1]];
                [origin[0] + x, origin[1] + y, origin[2] + height]
            })
            .collect();
        let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |k| row * columns + k));
        let triangles: Vec<[u32; 3]> = cells
            .flat_map(|low| {
                let [a, b, c, d] = [low, low + 1, low + columns + 1, low + columns];
                [[a, b, c], [a, c, d]].each(|corners| corners.each(|corner| corner as u32))
            })
            .collect();
        Mesh::new(&vertices, &triangles).map(|mesh| Self { mesh })
    }

    /// Its triangles.
    #[must_use]
    pub fn mesh(&self) -> &Mesh<T> {
        &self.mesh
    }
}

const ORIGIN: Key = Key::new("origin", Meaning::Numbers);
const SPACING: Key = Key::new("spacing", Meaning::Numbers);
const COLUMNS: Key = Key::new("columns", Meaning::Count);
const ROWS: Key = Key::new("rows", Meaning::Count);
const HEIGHTS: Key = Key::new("heights", Meaning::Numbers);

/// The heights of a CSV file, row by row, and how many a row has.
fn table(text: &str) -> Result<(usize, Vec<f64>), MeshError> {
    let (mut columns, mut heights) = (0, Vec::new());
    for (line, row) in (1..).zip(text.lines()) {
        if row.trim().is_empty() {
            continue;
        }
        let before = heights.len();
        for (column, word) in (1..).zip(row.split(',').map(str::trim)) {
            match word.parse::<f64>() {
                Ok(height) if height.is_finite() => heights.push(height),
                _ => {
                    let problem =
                        format!("column {column} is {word:?}, where a finite height belongs");
                    return Err(MeshError::at_line(line, problem));
                }
            }
        }
        let found = heights.len() - before;
        if columns == 0 {
            columns = found;
        } else if found != columns {
            let problem = format!("it has {found} heights, and the rows before have {columns}");
            return Err(MeshError::at_line(line, problem));
        }
    }
    Ok((columns, heights))
}

impl<T: Real> Solid<T> for Heightfield<T> {
    type In<B: Real> = Heightfield<B>;

    const NAME: &'static str = "heightfield";
    const KEYS: &'static [Key] = &[ORIGIN, SPACING, COLUMNS, ROWS, HEIGHTS, FILE];

    fn read(entry: &ShapeEntry) -> Result<Heightfield<f64>, Mistake> {
        let origin = match entry.numbers(ORIGIN).unwrap_or(&[0.0; 2]) {
            &[x, y] => [x, y, 0.0],
            &[x, y, z] => [x, y, z],
            other => {
                return Err(Mistake::value(ORIGIN.name, other, "it is two numbers or three"));
            }
        };
        let wanted = "a heightfield has a spacing greater than 0, or one each along x and y";
        let spacing = match entry.numbers(SPACING) {
            Some(&[both]) => [both; 2],
            Some(&[x, y]) => [x, y],
            Some(other) => return Err(Mistake::value(SPACING.name, other, wanted)),
            None => return Err(Mistake::missing(SPACING.name, wanted)),
        };
        if !spacing.iter().all(|&step| step > 0.0 && step.is_finite()) {
            return Err(Mistake::value(SPACING.name, spacing, wanted));
        }
        if let Some(path) = entry.path(FILE) {
            if let Some(key) = [COLUMNS, ROWS, HEIGHTS].into_iter().find(|key| entry.has(*key)) {
                let wanted = "the file has it; leave out one of them";
                return Err(Mistake::described(key.name, "there beside a file", wanted));
            }
            let read = || {
                let (columns, heights) = table(&std::fs::read_to_string(&path.whole)?)?;
                Heightfield::new(origin, spacing, columns, &heights)
            };
            return read().map_err(|error| path.mistake(FILE, &error));
        }
        let columns = entry.count(COLUMNS, "how many heights a row has belongs here")?;
        let rows = entry.count(ROWS, "how many rows of heights there are belongs here")?;
        let heights = entry
            .numbers(HEIGHTS)
            .ok_or_else(|| Mistake::missing(HEIGHTS.name, "a list of numbers, row by row"))?;
        if columns.saturating_mul(rows) != heights.len() {
            let found = format!("a list of {}", heights.len());
            let wanted = format!(
                "{columns} columns and {rows} rows are {} heights",
                columns.saturating_mul(rows)
            );
            return Err(Mistake::described(HEIGHTS.name, found, wanted));
        }
        Heightfield::new(origin, spacing, columns, heights).map_err(|error| {
            let wanted = "a heightfield has two columns and two rows at least, of finite heights";
            Mistake::described(HEIGHTS.name, format!("such that {error}"), wanted)
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        self.mesh.check_range(SPACING.name)
    }

    fn is_thin(&self) -> bool {
        true
    }

    fn area(&self) -> Option<T> {
        self.mesh.area()
    }

    fn cast<B: Real>(&self) -> Heightfield<B> {
        Heightfield { mesh: self.mesh.cast() }
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.mesh.points()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        Self { mesh: self.mesh.placed(at) }
    }

    fn features(&self) -> Vec<Feature<T>> {
        self.mesh.features()
    }

    fn count(&self) -> usize {
        Solid::count(&self.mesh)
    }

    fn extent(&self) -> Option<Bounds<T>> {
        self.mesh.extent()
    }

    fn mesh(&self) -> Option<&Mesh<T>> {
        Some(&self.mesh)
    }
}
