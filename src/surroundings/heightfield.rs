//! Heightfield: a surface over a grid, by its heights.

#[cfg(feature = "files")]
mod picture;
mod table;

use std::io;
use std::path::Path;

use super::Feature;
use super::entry::{FILE, Key, Meaning, ShapeEntry};
use super::mesh::{Mesh, MeshError};
use super::mistake::Mistake;
use super::placement::Placement;
use super::skin::{Corners, Detail};
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
/// these three `file`, from the folder of the scene file: a CSV file of heights, a line for
/// each row, or a `.png` picture of them from above, whose lower left pixel is the first, with
/// `range`, the heights of black and white, 0 and 1 by default.
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

    /// From a PNG picture of the heights as one sees them from above: from the place of its
    /// lower left pixel, the distances of pixels along x and y, and the heights of black and
    /// of white over that place; lengths. Of 1 to 16 bits, grey or of equal colours, opaque.
    ///
    /// ```
    /// use carom::surroundings::Heightfield;
    ///
    /// let mut file = Vec::new();
    /// let mut picture = png::Encoder::new(&mut file, 2, 2);
    /// picture.set_color(png::ColorType::Grayscale);
    /// picture.write_header()?.write_image_data(&[255, 255, 0, 51])?;
    /// let field = Heightfield::<f64>::from_png(&file, [0.0; 3], [1.0; 2], [0.0, 10.0])?;
    /// // Low at the lower edge, high at the upper one.
    /// let heights = field.mesh().vertices().iter().map(|v| (v.x, v.y, v.z));
    /// let mut heights: Vec<_> = heights.collect();
    /// heights.sort_by(|a, b| a.partial_cmp(b).unwrap());
    /// let right = [(0.0, 0.0, 0.0), (0.0, 1.0, 10.0), (1.0, 0.0, 2.0), (1.0, 1.0, 10.0)];
    /// assert_eq!(heights, right);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is no such picture, or has fewer than two columns or rows.
    #[cfg(feature = "files")]
    pub fn from_png(
        bytes: &[u8],
        origin: [T; 3],
        spacing: [T; 2],
        [black, white]: [T; 2],
    ) -> Result<Self, MeshError> {
        let (columns, levels) = picture::read(bytes)?;
        let height = |level| black + T::from_f64(level) * (white - black);
        let heights: Vec<T> = levels.into_iter().map(height).collect();
        Self::new(origin, spacing, columns, &heights)
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
const RANGE: Key = Key::new("range", Meaning::Numbers);

/// The heights that a file has.
fn in_file(
    path: &Path,
    origin: [f64; 3],
    spacing: [f64; 2],
    range: [f64; 2],
) -> Result<Heightfield<f64>, MeshError> {
    let bytes = std::fs::read(path)?;
    if is_picture(path) {
        #[cfg(feature = "files")]
        return Heightfield::from_png(&bytes, origin, spacing, range);
        #[cfg(not(feature = "files"))]
        return Err(MeshError::Picture(format!("{range:?} needs the feature `files`")));
    }
    let text = String::from_utf8(bytes);
    let text = text.map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
    let (columns, heights) = table::read(&text)?;
    Heightfield::new(origin, spacing, columns, &heights)
}

fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

impl<T: Real> Solid<T> for Heightfield<T> {
    type In<B: Real> = Heightfield<B>;

    const NAME: &'static str = "heightfield";
    const KEYS: &'static [Key] = &[ORIGIN, SPACING, COLUMNS, ROWS, HEIGHTS, FILE, RANGE];

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
            let range = match entry.numbers(RANGE) {
                None => [0.0, 1.0],
                Some(_) if !is_picture(&path.whole) => {
                    let wanted = "only a .png file has grey levels, whose heights it is";
                    return Err(Mistake::described(RANGE.name, "there", wanted));
                }
                Some(&[black, white]) if black.is_finite() && white.is_finite() => [black, white],
                Some(other) => {
                    let wanted = "the heights of black and white belong here";
                    return Err(Mistake::value(RANGE.name, other, wanted));
                }
            };
            return in_file(&path.whole, origin, spacing, range)
                .map_err(|error| path.mistake(FILE, &error));
        }
        if entry.has(RANGE) {
            let wanted = "only a .png file has grey levels, whose heights it is";
            return Err(Mistake::described(RANGE.name, "there without a file", wanted));
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

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        Solid::triangles(&self.mesh, detail)
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
