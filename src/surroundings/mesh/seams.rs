//! Seams: the sides of triangles behind which their plane goes on.
//!
//! Triangles of one plane that are joined by their sides have the plane of one of them: so
//! both sides of a seam give the same bits, and the seam itself is never touched.

use rayon::prelude::*;

use super::net::Net;
use crate::contact::greatest_component;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// How many roundings of its coordinates a corner may be off a plane to be in it.
const FLAT: i32 = 4;

/// Set in the marks of a triangle whose corners are on a line, or in a point.
const DEGENERATE: u8 = 1 << 3;

/// Which plane triangles have, and what is a seam.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Seams {
    /// The triangle that gives each one its plane.
    pub(super) planes: Vec<u32>,
    /// A binary digit for each side that is a seam, and one of degenerate triangles.
    marks: Vec<u8>,
}

impl Seams {
    /// Of a net in its place.
    pub(super) fn new<T: Real>(net: &Net, vertices: &[Vec3<T>]) -> Self {
        let corners = |triangle: u32| net.corners[triangle as usize].each(|k| vertices[k as usize]);
        let mark = |triangle| if is_degenerate(corners(triangle)) { DEGENERATE } else { 0 };
        let mut marks: Vec<u8> = (0..net.len()).into_par_iter().map(mark).collect();
        let own = |(triangle, &mark)| if mark == DEGENERATE { triangle } else { u32::MAX };
        let mut planes: Vec<u32> = (0..).zip(&marks).map(own).collect();
        let mut edge = Vec::new();
        for first in 0..net.len() {
            if planes[first as usize] != u32::MAX {
                continue;
            }
            planes[first as usize] = first;
            let point = corners(first)[0];
            let normal = unit_normal(corners(first));
            edge.push(first);
            while let Some(one) = edge.pop() {
                for side in 0..3 {
                    let Some((other, back)) = net.behind(one, side) else { continue };
                    let (is_free, is_ours) = {
                        let plane = planes[other as usize];
                        (plane == u32::MAX, plane == first)
                    };
                    let is_off = || {
                        let corner = corners(other)[(back + 2) % 3];
                        let size = greatest_component(corner).greater(greatest_component(point));
                        let height = (corner - point).dot(normal).abs();
                        height > T::whole(FLAT) * T::EPSILON * size
                    };
                    if !(is_free && !is_off() || is_ours)
                        || is_folded([corners(one), corners(other)], [side, back])
                    {
                        continue;
                    }
                    if is_free {
                        planes[other as usize] = first;
                        edge.push(other);
                    }
                    marks[one as usize] |= 1 << side;
                    marks[other as usize] |= 1 << back;
                }
            }
        }
        Self { planes, marks }
    }

    /// Whether a side is a seam.
    pub(super) fn is_seam(&self, triangle: u32, side: usize) -> bool {
        self.marks[triangle as usize] >> side & 1 != 0
    }

    /// Whether all sides are seams.
    pub(super) fn is_inner(&self, triangle: u32) -> bool {
        self.marks[triangle as usize] == 0b111
    }

    /// Whether the corners are on a line, or in a point.
    pub(super) fn is_degenerate(&self, triangle: u32) -> bool {
        self.marks[triangle as usize] & DEGENERATE != 0
    }

    /// The bytes that it holds.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.planes.as_slice()) + size_of_val(self.marks.as_slice())
    }
}

/// Whether, in the rounding of the precision, corners are on a line: `|u × v| ≤ 4 ε l²`,
/// with the longest side `l`. A test without a scale.
fn is_degenerate<T: Real>([a, b, c]: [Vec3<T>; 3]) -> bool {
    // In a unit that no square leaves the range of numbers in.
    let unit = [b - a, c - b, a - c].each(greatest_component).into_iter().fold(T::ZERO, T::greater);
    if unit == T::ZERO {
        return true;
    }
    let scale = T::ONE / unit;
    let [u, v, w] = [b - a, c - b, a - c].each(|side| side * scale);
    let longest = [u, v, w].each(Vec3::length_squared).into_iter().fold(T::ZERO, T::greater);
    u.cross(v).length() <= T::whole(4) * T::EPSILON * longest
}

/// The unit normal of a triangle. Divided, so that a plane along two axes has a normal
/// without rounding.
pub(super) fn unit_normal<T: Real>([a, b, c]: [Vec3<T>; 3]) -> Vec3<T> {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let length = normal.length();
    let is_in_range = length > T::ZERO && length.is_finite();
    let (normal, length) = if is_in_range {
        (normal, length)
    } else {
        let unit = greatest_component(u).greater(greatest_component(v));
        let normal = (u * (T::ONE / unit)).cross(v * (T::ONE / unit));
        (normal, normal.length())
    };
    // A zero has no sign.
    let part = |component: T| component / length + T::ZERO;
    Vec3::new(part(normal.x), part(normal.y), part(normal.z))
}

/// Whether of two triangles with a common side one lies on the other.
fn is_folded<T: Real>([one, other]: [[Vec3<T>; 3]; 2], [side, back]: [usize; 2]) -> bool {
    let from = one[side];
    let way = one[(side + 1) % 3] - from;
    let across = |corner: Vec3<T>| {
        let offset = corner - from;
        offset - way * (offset.dot(way) / way.length_squared())
    };
    across(one[(side + 2) % 3]).dot(across(other[(back + 2) % 3])) >= T::ZERO
}
