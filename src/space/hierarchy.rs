//! Hierarchy: which of many parts are near a place, in few bytes a part.
//!
//! The parts stand in an order in which neighbours in space are neighbours in number
//! ([`along_curve`](super::curve::along_curve)). They are halved by number, down to a few
//! each; so the nodes depend on how many parts there are and on nothing else, and their boxes
//! are found from the leaves up: `O(n)`. Nodes lie in one array in the order in which a search comes to them, each
//! with the number to go on from where it is too far away, so a search needs no stack.
//!
//! Boxes are in f32, rounded outward, in every precision.

use rayon::prelude::*;

use super::Bounds;
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// The most parts of a node that is not cut further. Of 4 in place of 8 the nodes take
/// twice the memory.
const LEAF: u32 = 8;

/// The binary digits that count the parts of a leaf.
const COUNT_DIGITS: u32 = 4;

/// The most parts of a hierarchy.
pub(crate) const MOST_PARTS: u32 = 1 << (32 - COUNT_DIGITS);

/// A node: the box around all below it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    lower: [f32; 3],
    upper: [f32; 3],
    /// The node that comes after all below this one.
    next: u32,
    /// The first of a leaf's parts, and how many; 0 for other nodes.
    parts: u32,
}

/// A bounding-volume hierarchy over parts in an order along a curve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hierarchy {
    nodes: Vec<Node>,
}

impl Hierarchy {
    /// Over a number of parts, each in its box.
    pub(crate) fn new<T: Real>(count: u32, bounds: impl Fn(u32) -> Bounds<T> + Sync) -> Self {
        let mut hierarchy = Self { nodes: Vec::new() };
        if count > 0 {
            hierarchy.divide(0, count);
            hierarchy.nodes.shrink_to_fit();
            hierarchy.fit(bounds);
        }
        hierarchy
    }

    /// Lays out the nodes over a run of parts.
    fn divide(&mut self, start: u32, end: u32) {
        let (own, count) = (self.nodes.len(), end - start);
        let is_leaf = count <= LEAF;
        let parts = if is_leaf { start << COUNT_DIGITS | count } else { 0 };
        self.nodes.push(Node { lower: [0.0; 3], upper: [0.0; 3], next: 0, parts });
        if !is_leaf {
            let middle = start + count / 2;
            self.divide(start, middle);
            self.divide(middle, end);
        }
        self.nodes[own].next = self.nodes.len() as u32;
    }

    /// Finds the boxes of all nodes, each after those below it.
    fn fit<T: Real>(&mut self, bounds: impl Fn(u32) -> Bounds<T> + Sync) {
        self.nodes.par_iter_mut().for_each(|node| {
            let boxes = node.leaf().map(|part| outward(bounds(part)));
            [node.lower, node.upper] = boxes.reduce(joined).unwrap_or_default();
        });
        for own in (0..self.nodes.len()).rev() {
            if self.nodes[own].parts == 0 {
                let first = self.nodes[own + 1];
                let second = self.nodes[first.next as usize];
                let both = joined([first.lower, first.upper], [second.lower, second.upper]);
                [self.nodes[own].lower, self.nodes[own].upper] = both;
            }
        }
    }

    /// Visits the parts of all leaves that touch a box, in rising order.
    #[inline]
    pub(crate) fn for_each<T: Real>(&self, bounds: Bounds<T>, mut visit: impl FnMut(u32)) {
        let [lower, upper] = outward(bounds);
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            let touches = |k: usize| node.lower[k] <= upper[k] && lower[k] <= node.upper[k];
            if touches(0) & touches(1) & touches(2) {
                node.leaf().for_each(&mut visit);
                at += 1;
            } else {
                at = node.next as usize;
            }
        }
    }

    /// The bytes that the nodes hold.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }
}

impl Node {
    /// The parts of a leaf, none of another node.
    #[inline(always)]
    fn leaf(&self) -> core::ops::Range<u32> {
        let first = self.parts >> COUNT_DIGITS;
        first..first + (self.parts & ((1 << COUNT_DIGITS) - 1))
    }
}

fn joined([a, b]: [[f32; 3]; 2], [c, d]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    [array::from_fn(|k| a[k].min(c[k])), array::from_fn(|k| b[k].max(d[k]))]
}

/// The least box in f32 around a box.
#[inline(always)]
fn outward<T: Real>([lower, upper]: Bounds<T>) -> [[f32; 3]; 2] {
    [lower.to_array().each(below), upper.to_array().each(|value| -below(-value))]
}

/// The greatest f32 that is not above a number.
#[inline(always)]
fn below<T: Real>(value: T) -> f32 {
    let nearest = value.to_f64() as f32;
    if T::from_f64(f64::from(nearest)) <= value { nearest } else { nearest.next_down() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::curve::along_curve;
    use crate::space::noise::noise;
    use crate::space::test_boxes::{cube, touch};
    use crate::vec3::Vec3;

    fn finds_all<T: Real>(count: u32, far: f64, half: f64) {
        let mut noise = noise();
        let places: Vec<[f64; 3]> =
            (0..count).map(|_| [(); 3].map(|()| far + 10.0 * noise())).collect();
        let order = along_curve(&places);
        let boxes: Vec<Bounds<T>> =
            order.iter().map(|&k| cube(places[k as usize], half * (1.0 + noise()))).collect();
        let hierarchy = Hierarchy::new(count, |part| boxes[part as usize]);
        let (mut visited, mut touched) = (0, 0);
        for _ in 0..200 {
            let search = cube::<T>([(); 3].map(|()| far + 10.0 * noise()), 0.3);
            let mut found = Vec::new();
            hierarchy.for_each(search, |part| found.push(part));
            assert!(found.is_sorted_by(|a, b| a < b));
            visited += found.len();
            for part in 0..count {
                if touch(&boxes[part as usize], &search) {
                    assert!(found.contains(&part), "{part} of {count} is not found");
                    touched += 1;
                }
            }
        }
        // Far away, a box in f32 is nearly all of the space.
        assert!(far > 1e6 || visited <= 24 * (touched + 200), "{visited} visited for {touched}");
    }

    #[test]
    fn finds_what_a_look_at_all_parts_finds() {
        for count in [0, 1, 7, 8, 9, 100, 5000] {
            finds_all::<f32>(count, 0.0, 0.1);
            finds_all::<f64>(count, 0.0, 0.1);
            finds_all::<f64>(count, 1e9, 0.1);
        }
    }

    #[test]
    fn takes_few_bytes_and_few_steps() {
        let mut noise = noise();
        let places: Vec<[f64; 3]> =
            (0..100_000).map(|_| [100.0 * noise(), 100.0 * noise(), 0.0]).collect();
        let order = along_curve(&places);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..100_000));
        let hierarchy =
            Hierarchy::new(100_000, |part| cube::<f64>(places[order[part as usize] as usize], 0.2));
        assert!(hierarchy.bytes() < 100_000 * 12, "{} bytes", hierarchy.bytes());
        let mut most = 0;
        for _ in 0..100 {
            let mut visited = 0;
            let search = cube::<f64>([100.0 * noise(), 100.0 * noise(), 0.0], 0.2);
            hierarchy.for_each(search, |_| visited += 1);
            most = most.max(visited);
        }
        assert!(most < 200, "{most} of 100,000 parts visited");
    }

    #[test]
    fn boxes_are_rounded_outward() {
        let third = 1.0 / 3.0;
        let [lower, upper] =
            outward([Vec3::new(third, -third, 0.5), Vec3::new(third, -third, 0.5)]);
        assert!(f64::from(lower[0]) < third && f64::from(upper[0]) > third);
        assert!(f64::from(lower[1]) < -third && f64::from(upper[1]) > -third);
        assert_eq!((lower[2], upper[2]), (0.5, 0.5));
        let [lower, upper] = outward([Vec3::new(-1e300, 0.0, 0.0), Vec3::new(1e300, 0.0, 0.0)]);
        assert_eq!((lower[0], upper[0]), (f32::NEG_INFINITY, f32::INFINITY));
    }
}
