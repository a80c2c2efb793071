//! Features: all that spheres can touch in a scene, by number.
//!
//! Those that stand alone have the first numbers, in the order of the scene; the triangles
//! of meshes follow, which are made when they are looked at.

use super::mesh::Tile;
use super::solid::Obstacle;
use super::{Clearance, Feature, Mesh, Shape};
use crate::contact::FreeFlight;
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::space::{Bounds, FixedParts};
use crate::vec3::Vec3;

/// The features of all shapes.
#[derive(Clone, Debug)]
pub(crate) struct Features<T> {
    alone: Vec<Feature<T>>,
    /// The shape that each of them is of.
    shapes: Vec<u32>,
    meshes: Vec<Numbered<T>>,
    len: u32,
}

/// A mesh, the number of its first triangle, and the shape that it is of.
#[derive(Clone, Debug)]
struct Numbered<T> {
    mesh: Mesh<T>,
    first: u32,
    shape: u32,
}

/// A feature, wherever it comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FeatureRef<'a, T> {
    Alone(&'a Feature<T>),
    Tile(Tile<'a, T>),
}

impl<T: Real> Features<T> {
    pub(crate) fn new(shapes: &[Shape<T>]) -> Self {
        let mut features =
            Self { alone: Vec::new(), shapes: Vec::new(), meshes: Vec::new(), len: 0 };
        for (number, shape) in (0..).zip(shapes) {
            if let Some(mesh) = shape.mesh() {
                features.meshes.push(Numbered { mesh: mesh.clone(), first: 0, shape: number });
            } else {
                features.alone.extend(shape.features());
                features.shapes.resize(features.alone.len(), number);
            }
        }
        features.len = features.alone.len() as u32;
        for numbered in &mut features.meshes {
            numbered.first = features.len;
            features.len += numbered.mesh.count();
        }
        features
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.len as usize
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Those that are no triangles of a mesh: the first ones.
    pub(crate) fn alone(&self) -> &[Feature<T>] {
        &self.alone
    }

    pub(crate) fn has_meshes(&self) -> bool {
        !self.meshes.is_empty()
    }

    /// The boxes around all meshes.
    pub(crate) fn mesh_bounds(&self) -> impl Iterator<Item = Bounds<T>> {
        self.meshes.iter().map(|numbered| numbered.mesh.bounds())
    }

    /// The feature of a number.
    #[inline(always)]
    pub(crate) fn at(&self, number: u32) -> FeatureRef<'_, T> {
        match self.alone.get(number as usize) {
            Some(feature) => FeatureRef::Alone(feature),
            None => self.tile(number),
        }
    }

    #[inline(never)]
    fn tile(&self, number: u32) -> FeatureRef<'_, T> {
        let Numbered { mesh, first, .. } = self.mesh_of(number);
        FeatureRef::Tile(mesh.tile(number - first))
    }

    /// The mesh that a triangle is of.
    fn mesh_of(&self, number: u32) -> &Numbered<T> {
        let after = self.meshes.partition_point(|numbered| numbered.first <= number);
        &self.meshes[after - 1]
    }

    /// The shape that a feature is of.
    #[inline]
    pub(crate) fn shape_of(&self, number: u32) -> u32 {
        match self.shapes.get(number as usize) {
            Some(&shape) => shape,
            None => self.mesh_of(number).shape,
        }
    }

    /// The feature that stands for all that go on into one in its plane.
    #[inline]
    pub(crate) fn surface_of(&self, number: u32) -> u32 {
        if (number as usize) < self.alone.len() {
            return number;
        }
        let Numbered { mesh, first, .. } = self.mesh_of(number);
        first + mesh.plane_of(number - first)
    }

    /// The bytes that they hold.
    pub(crate) fn bytes(&self) -> usize {
        let meshes = self.meshes.iter().map(|numbered| numbered.mesh.bytes());
        size_of_val(self.alone.as_slice())
            + size_of_val(self.shapes.as_slice())
            + meshes.sum::<usize>()
    }

    /// Whether any triangle of a mesh whose box touches a box is what `is_wanted` says.
    pub(crate) fn any_tile(&self, bounds: Bounds<T>, is_wanted: impl Fn(u32) -> bool) -> bool {
        let mut any = false;
        self.for_each_tile(bounds, |_, number| any = any || is_wanted(number));
        any
    }

    /// Visits the triangles of meshes whose boxes touch a box.
    #[inline]
    pub(crate) fn for_each_tile(&self, bounds: Bounds<T>, mut visit: impl FnMut(Bounds<T>, u32)) {
        for Numbered { mesh, first, .. } in &self.meshes {
            mesh.for_each_near(bounds, |bounds, number| visit(bounds, first + number));
        }
    }
}

impl<T: Real> FeatureRef<'_, T> {
    /// As [`Feature::clearance`].
    #[inline(always)]
    pub(crate) fn clearance<L: Lane<Scalar = T>>(
        &self,
        center: Vec3<L>,
        radius: L,
    ) -> Clearance<L> {
        match self {
            Self::Alone(feature) => feature.clearance(center, radius),
            Self::Tile(tile) => tile_clearance(tile, center, radius),
        }
    }

    /// The clearance from the surface that a sphere has bounced off, of which this is a part.
    #[inline]
    pub(crate) fn clearance_of_surface(&self, center: Vec3<T>, radius: T) -> Clearance<T> {
        match self {
            Self::Alone(feature) => feature.clearance(center, radius),
            Self::Tile(tile) => tile.clearance_of_plane(center, radius),
        }
    }

    /// Of spheres that overlap it, those that no neighbour stops instead.
    #[inline(always)]
    pub(crate) fn stops<L: Lane<Scalar = T>>(&self, overlaps: L::Mask, center: Vec3<L>) -> L::Mask {
        match self {
            Self::Tile(tile) if overlaps.any() => stops_own(tile, overlaps, center),
            _ => overlaps,
        }
    }

    /// As [`Feature::contact_time`].
    pub(crate) fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        match self {
            Self::Alone(feature) => Obstacle::contact_time(*feature, flight),
            Self::Tile(tile) => tile.contact_time(flight),
        }
    }

    /// The same of a sphere that has just bounced off the feature, and follows it in flights
    /// long enough to get on by.
    pub(crate) fn hop_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.contact_time(flight).map(|wait| match self {
            Self::Alone(feature) => feature.hop(flight, wait),
            Self::Tile(tile) => tile.hop(flight, wait),
        })
    }

    /// As [`Feature::is_hollow`].
    pub(crate) fn is_hollow(&self) -> bool {
        matches!(self, Self::Alone(feature) if feature.is_hollow())
    }

    /// As [`Feature::farthest`].
    pub(crate) fn farthest(&self) -> f64 {
        match self {
            Self::Alone(feature) => feature.farthest(),
            Self::Tile(tile) => tile.farthest(),
        }
    }
}

/// Not inlined: loops over features that stand alone stay as small as they are.
#[inline(never)]
fn tile_clearance<L: Lane<Scalar = T>, T: Real>(
    tile: &Tile<'_, T>,
    center: Vec3<L>,
    radius: L,
) -> Clearance<L> {
    tile.clearance(center, radius)
}

#[inline(never)]
fn stops_own<L: Lane<Scalar = T>, T: Real>(
    tile: &Tile<'_, T>,
    overlaps: L::Mask,
    center: Vec3<L>,
) -> L::Mask {
    let [x, y, z] = center.to_arrays();
    let bits = overlaps.bits();
    let is_own = L::from_fn(|k| {
        let place = Vec3::new(x.as_ref()[k], y.as_ref()[k], z.as_ref()[k]);
        if bits >> k & 1 != 0 && tile.is_own(place) { T::ONE } else { T::ZERO }
    });
    is_own.gt(L::ZERO)
}

impl<T: Real> FixedParts<T> for Features<T> {
    fn count(&self) -> usize {
        self.len()
    }

    fn bounds(&self, part: usize) -> Option<Bounds<T>> {
        match self.at(part as u32) {
            FeatureRef::Alone(feature) => feature.bounds(),
            FeatureRef::Tile(tile) => tile.bounds(),
        }
    }

    #[inline(always)]
    fn gap<L: Lane<Scalar = T>>(&self, part: usize, center: Vec3<L>, radius: L) -> L {
        self.at(part as u32).clearance(center, radius).gap
    }

    fn alone(&self) -> usize {
        self.alone.len()
    }

    #[inline]
    fn for_each_near(&self, bounds: Bounds<T>, visit: impl FnMut(Bounds<T>, u32)) {
        self.for_each_tile(bounds, visit);
    }
}
