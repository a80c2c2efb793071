//! Mesh: a surface of triangles.

mod error;
mod net;
mod obj;
mod polygon;
mod report;
mod seams;
mod stl;
mod tile;
mod words;

use core::any::Any;
use std::path::Path;
use std::sync::Arc;

use super::Feature;
use super::entry::{FILE, Key, Meaning, ShapeEntry, VERTICES};
use super::mistake::Mistake;
use super::placement::Placement;
use super::skin::{Corners, Detail};
use super::solid::Solid;
use crate::contact::greatest_component;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::hierarchy::Hierarchy;
use crate::space::{Bounds, joined};
use crate::vec3::Vec3;

pub use error::{FilePlace, MeshError};
use net::Net;
use obj::Obj;
pub use report::MeshReport;
use seams::Seams;
use stl::Stl;
pub(crate) use tile::Tile;

/// A surface of triangles fixed in space, thin and touched from both sides: what is the
/// inside of a closed one, and which way its triangles look, is of no matter.
///
/// In a scene file: `shape = "mesh"` with `file`, the path of an STL or OBJ file from the
/// folder of the scene file; or with `vertices`, a list of points, and `triangles`, a list of
/// three numbers of vertices each, from 0.
///
/// Equal vertices count as one. Triangles of one plane that are joined by their sides are
/// one face: a sphere that rolls over them moves as on a plane, bit for bit. A triangle
/// whose corners are on a line or in a point is touched as that line or point.
///
/// It takes about 56 bytes a triangle in `f64`, 50 in `f32`; copies share them.
///
/// ```
/// use carom::surroundings::{Mesh, Shape};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let square = Mesh::new(&corners, &[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!((square.vertices().len(), square.triangles().len()), (4, 2));
/// assert_eq!(square.report().open_edges, 4);
/// assert_eq!(Shape::from(square).features().len(), 2);
/// # Ok::<(), carom::surroundings::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<T> {
    net: Arc<Net>,
    vertices: Arc<[Vec3<T>]>,
    seams: Arc<Seams>,
    hierarchy: Arc<Hierarchy>,
    bounds: Bounds<T>,
    source: Source,
}

/// What a mesh was made of, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Numbers,
    BinaryStl,
    Text,
}

impl<T: Real> Mesh<T> {
    /// The triangles between vertices, length, by the numbers of these from 0.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// assert!(Mesh::new(&corners, &[[0, 1, 2]]).is_ok());
    /// let error = Mesh::new(&corners, &[[0, 1, 3]]).unwrap_err();
    /// assert!(error.to_string().contains("vertex 3"));
    /// ```
    ///
    /// # Errors
    /// If there are no triangles, or 2²⁸ or more, a number is of no vertex, or a coordinate
    /// is not finite.
    pub fn new(vertices: &[[T; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let vertices: Vec<Vec3<T>> = vertices.iter().copied().map(Vec3::from).collect();
        Self::of(&vertices, triangles, Source::Numbers)
    }

    /// What a file in the STL format has, binary or text. The normals in it, its colours and
    /// its name are of no matter; several solids are one mesh.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    ///
    /// let text = "solid corner
    ///     facet normal 0 0 1
    ///       outer loop
    ///         vertex 0 0 0
    ///         vertex 1 0 0
    ///         vertex 0 1 0
    ///       endloop
    ///     endfacet
    ///     endsolid corner";
    /// assert_eq!(Mesh::<f32>::from_stl(text.as_bytes())?.triangles().len(), 1);
    /// let error = Mesh::<f32>::from_stl(&text.as_bytes()[..70]).unwrap_err();
    /// assert!(error.to_string().starts_with("line 4:"));
    /// # Ok::<(), carom::surroundings::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// If it is anything else, ends too early or has more than it says, or a coordinate is
    /// not finite: the message names the byte or the line.
    pub fn from_stl(bytes: &[u8]) -> Result<Self, MeshError> {
        let Stl { corners, is_binary, ends_early } = stl::read(bytes)?;
        let count = corners.len() as u32;
        let triangles: Vec<[u32; 3]> = (0..count).step_by(3).map(|k| [k, k + 1, k + 2]).collect();
        let source = if is_binary { Source::BinaryStl } else { Source::Text };
        let mesh = Self::of(&cast(&corners), &triangles, source)?;
        match ends_early {
            Some(line) if !mesh.report().is_closed() => {
                let problem = "the file ends here without \"endsolid\", and what it has is not \
                               closed: it may be cut off";
                Err(MeshError::at_line(line, problem))
            }
            _ => Ok(mesh),
        }
    }

    /// What a file in the OBJ format has: its vertices and faces. Faces of more than three
    /// corners are cut into triangles. Its textures, normals, groups and materials are of no
    /// matter; lines, points and curved surfaces are refused.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    /// let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    /// assert_eq!(Mesh::<f64>::from_obj(square.as_bytes())?.triangles().len(), 2);
    /// let error = Mesh::<f64>::from_obj(b"v 0 0 0\nf 1 2 3\n").unwrap_err();
    /// assert!(error.to_string().starts_with("line 2:"));
    /// # Ok::<(), carom::surroundings::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// If it is anything else, a number is of no vertex, or a coordinate is not finite: the
    /// message names the line.
    pub fn from_obj(bytes: &[u8]) -> Result<Self, MeshError> {
        let Obj { vertices, triangles } = obj::read(bytes)?;
        Self::of(&cast(&vertices), &triangles, Source::Text)
    }

    /// What a file has, in the format of its ending: `.stl` or `.obj`.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    ///
    /// let folder = tempfile::tempdir()?;
    /// let path = folder.path().join("square.obj");
    /// std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
    /// assert_eq!(Mesh::<f64>::load(&path)?.vertices().len(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it cannot be read, has another ending, or is refused as
    /// [`from_stl`](Self::from_stl) and [`from_obj`](Self::from_obj) have it.
    pub fn load(path: &Path) -> Result<Self, MeshError> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        if ending == "stl" {
            Self::from_stl(&std::fs::read(path)?)
        } else if ending == "obj" {
            Self::from_obj(&std::fs::read(path)?)
        } else {
            Err(MeshError::UnknownFormat(path.into()))
        }
    }

    fn of(points: &[Vec3<T>], triangles: &[[u32; 3]], source: Source) -> Result<Self, MeshError> {
        let (net, vertices) = Net::new(points, triangles)?;
        Ok(Self::placed_at(Arc::new(net), vertices, source))
    }

    /// With its vertices where they are.
    fn placed_at(net: Arc<Net>, vertices: Vec<Vec3<T>>, source: Source) -> Self {
        let seams = Seams::new(&net, &vertices);
        let corners = |triangle: u32| net.corners[triangle as usize].each(|k| vertices[k as usize]);
        let hierarchy = Hierarchy::new(net.len(), |triangle| around(corners(triangle)));
        let ends = vertices.iter().map(|&vertex| [vertex, vertex]);
        let bounds = ends.reduce(joined);
        Self {
            seams: Arc::new(seams),
            hierarchy: Arc::new(hierarchy),
            bounds: bounds.unwrap_or([Vec3::ZERO; 2]),
            vertices: vertices.into(),
            net,
            source,
        }
    }

    /// The same triangles with other vertices.
    fn with_vertices<B: Real>(&self, place: impl Fn(Vec3<T>) -> Vec3<B>) -> Mesh<B> {
        let vertices = self.vertices.iter().map(|&vertex| place(vertex)).collect();
        Mesh::placed_at(Arc::clone(&self.net), vertices, self.source)
    }

    /// Its vertices, length, each once.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3<T>] {
        &self.vertices
    }

    /// Its triangles, by the numbers of their corners among its [vertices](Self::vertices).
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.net.corners
    }

    /// The corners of the box around it, length.
    #[must_use]
    pub fn bounds(&self) -> Bounds<T> {
        self.bounds
    }

    /// What is to know about it before spheres meet it: whether it is closed, and what may
    /// be wrong with it.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
    /// let report = Mesh::new(&corners, &[[0, 1, 2], [0, 1, 3]])?.report();
    /// assert_eq!((report.triangles, report.degenerate, report.components), (2, 1, 1));
    /// # Ok::<(), carom::surroundings::MeshError>(())
    /// ```
    #[must_use]
    pub fn report(&self) -> MeshReport {
        MeshReport::of(self)
    }

    /// The bytes that it and its copies hold.
    ///
    /// ```
    /// use carom::surroundings::Mesh;
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// assert!(Mesh::new(&corners, &[[0, 1, 2]])?.bytes() < 200);
    /// # Ok::<(), carom::surroundings::MeshError>(())
    /// ```
    #[must_use]
    pub fn bytes(&self) -> usize {
        let Net { corners, neighbours, given } = &*self.net;
        size_of_val(corners.as_slice())
            + size_of_val(neighbours.as_slice())
            + size_of_val(given.as_slice())
            + size_of_val(&*self.vertices)
            + self.seams.bytes()
            + self.hierarchy.bytes()
    }

    /// How many triangles it has.
    pub(crate) fn count(&self) -> u32 {
        self.net.len()
    }

    /// A triangle.
    pub(crate) fn tile(&self, number: u32) -> Tile<'_, T> {
        Tile { mesh: self, number }
    }

    /// The triangle that gives one its plane: the same one for all that go on into each
    /// other.
    pub(crate) fn plane_of(&self, number: u32) -> u32 {
        self.seams.planes[number as usize]
    }

    /// Visits the triangles whose boxes touch a box, in rising order.
    #[inline]
    pub(crate) fn for_each_near(&self, bounds: Bounds<T>, mut visit: impl FnMut(Bounds<T>, u32)) {
        let [lower, upper] = bounds.each(Vec3::to_array);
        self.hierarchy.for_each(bounds, |number| {
            let own = self.bounds_of(number);
            let [low, high] = own.each(Vec3::to_array);
            let touches = |k: usize| low[k] <= upper[k] && lower[k] <= high[k];
            if touches(0) & touches(1) & touches(2) {
                visit(own, number);
            }
        });
    }

    #[inline]
    fn corners(&self, triangle: u32) -> [Vec3<T>; 3] {
        self.net.corners[triangle as usize].each(|corner| self.vertices[corner as usize])
    }

    #[inline]
    fn bounds_of(&self, triangle: u32) -> Bounds<T> {
        around(self.corners(triangle))
    }

    /// A mistake if a precision cannot square its sides, or hold its vertices.
    pub(super) fn check_range(&self, key: &'static str) -> Result<(), Mistake> {
        let is_in_range = |triangle: u32| {
            let [a, b, c] = self.corners(triangle);
            let sides = [b - a, c - b, a - c];
            sides.iter().all(|side| side.length_squared().is_finite())
                && [a, b, c].iter().all(|corner| greatest_component(*corner).is_finite())
        };
        let beyond = (0..self.count()).filter(|&triangle| !is_in_range(triangle));
        let Some(first) = beyond.map(|triangle| self.net.given[triangle as usize]).min() else {
            return Ok(());
        };
        let place = match self.source {
            Source::BinaryStl => {
                format!("byte {}: triangle {first}", stl::byte_of(first as usize))
            }
            _ => format!("triangle {first}"),
        };
        let found = format!("a mesh with a side too long, {place}");
        let wanted = format!("no side may be longer than {} can square", T::NAME);
        Err(Mistake::described(key, found, wanted))
    }
}

/// The box around a triangle.
fn around<T: Real>([a, b, c]: [Vec3<T>; 3]) -> Bounds<T> {
    [a.lesser(b).lesser(c), a.greater(b).greater(c)]
}

fn cast<T: Real>(points: &[[f64; 3]]) -> Vec<Vec3<T>> {
    points.iter().map(|point| point.each(T::from_f64).into()).collect()
}

const TRIANGLES: Key = Key::new("triangles", Meaning::Triples);

impl<T: Real> Solid<T> for Mesh<T> {
    type In<B: Real> = Mesh<B>;

    const NAME: &'static str = "mesh";
    const KEYS: &'static [Key] = &[FILE, VERTICES, TRIANGLES];

    fn read(entry: &ShapeEntry) -> Result<Mesh<f64>, Mistake> {
        if let Some(path) = entry.path(FILE) {
            if let Some(key) = [VERTICES, TRIANGLES].into_iter().find(|key| entry.has(*key)) {
                let wanted = "the file has it; leave out one of them";
                return Err(Mistake::described(key.name, "there beside a file", wanted));
            }
            return Mesh::load(&path.whole).map_err(|error| path.mistake(FILE, &error));
        }
        let vertices = entry.points(VERTICES)?;
        let triangles = entry.triples(TRIANGLES)?;
        Mesh::new(vertices, triangles).map_err(|error| {
            let wanted = "every triangle is three numbers of vertices, from 0";
            Mistake::described(TRIANGLES.name, format!("such that {error}"), wanted)
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        self.check_range(if self.source == Source::Numbers { VERTICES.name } else { FILE.name })
    }

    fn is_thin(&self) -> bool {
        true
    }

    fn area(&self) -> Option<T> {
        let both_sides = |triangle| {
            let [a, b, c] = self.corners(triangle);
            (b - a).cross(c - a).length()
        };
        Some((0..self.count()).map(both_sides).fold(T::ZERO, |sum, area| sum + area))
    }

    fn cast<B: Real>(&self) -> Mesh<B> {
        // In its own precision it is a copy, which shares all that was worked out.
        let same = (self as &dyn Any).downcast_ref::<Mesh<B>>();
        same.cloned().unwrap_or_else(|| self.with_vertices(Vec3::cast))
    }

    fn triangles(&self, _: &Detail<T>) -> Vec<Corners<T>> {
        let triangles = self.triangles().iter();
        triangles.map(|corners| corners.each(|k| self.vertices[k as usize])).collect()
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.vertices.to_vec()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        self.with_vertices(|vertex| at.point(vertex))
    }

    /// One of each triangle, for itself.
    fn features(&self) -> Vec<Feature<T>> {
        (0..Mesh::count(self)).map(|triangle| self.tile(triangle).alone().into()).collect()
    }

    fn count(&self) -> usize {
        self.net.corners.len()
    }

    fn extent(&self) -> Option<Bounds<T>> {
        Some(self.bounds)
    }

    fn mesh(&self) -> Option<&Mesh<T>> {
        Some(self)
    }
}
