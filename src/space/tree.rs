//! Tree: which of many boxes are near a point.
//!
//! The boxes are halved by number, along the axis in which their centres spread
//! most, down to a few each: `O(n log n)` to build, whatever their sizes and
//! distances, and as deep as the logarithm of their number. Nodes lie in one
//! array in the order in which a search comes to them, each with the number to go
//! on from where it is too far away, so a search needs no stack.
//!
//! Boxes and searches are larger by what rounding can do to their coordinates:
//! what touches in any formula of a few operations is found.

use core::ops::ControlFlow;

use crate::numbers::array::{self, Each};
use crate::real::Real;
use crate::vec3::Vec3;

/// The corners of a box, least coordinates first.
pub type Bounds<T> = [Vec3<T>; 2];

/// Boxes of a node that is not cut further.
const LEAF: usize = 4;

/// Units in the last digit of the largest coordinate by which a box grows.
const ROUNDING: i32 = 64;

/// A node: the box around all below it.
#[derive(Clone, Copy, Debug)]
struct Node<T> {
    lower: [T; 3],
    upper: [T; 3],
    /// The node that comes after all below this one.
    next: u32,
    /// The first of a leaf's boxes, and how many; none for other nodes.
    first: u32,
    count: u32,
}

/// A bounding-volume tree over numbered boxes, some of which may be without
/// end.
///
/// ```
/// use carom::space::Tree;
/// use carom::vec3::Vec3;
///
/// let cube = |x| Some([Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 1.0, 1.0)]);
/// let tree = Tree::new([cube(0.0), None, cube(5.0)]);
/// let mut near = Vec::new();
/// tree.near([Vec3::new(4.0, 0.0, 0.0), Vec3::new(5.5, 0.5, 0.5)], &mut near);
/// assert_eq!(near, [2]);
/// assert_eq!(tree.endless(), [1]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Tree<T> {
    nodes: Vec<Node<T>>,
    /// Boxes and their numbers, leaf by leaf.
    boxes: Vec<(Bounds<T>, u32)>,
    endless: Vec<u32>,
}

/// A ray from a point, up to a distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray<T> {
    origin: [T; 3],
    /// `1/u` of each component of its unit direction; infinite where that is 0.
    inverse: [T; 3],
    longest: T,
    margin: T,
}

impl<T: Real> Ray<T> {
    /// From a point in a unit direction, up to a distance, length.
    pub(crate) fn new(origin: Vec3<T>, unit: Vec3<T>, longest: T) -> Self {
        let largest = origin.x.abs().greater(origin.y.abs()).greater(origin.z.abs());
        Self {
            origin: origin.to_array(),
            inverse: unit.to_array().each(|component| T::ONE / component),
            longest,
            margin: largest * T::EPSILON * T::whole(ROUNDING),
        }
    }

    fn touches(&self, bounds: [[T; 3]; 2]) -> bool {
        self.span(bounds).is_some()
    }

    /// From where to where a box is in its way, length: it is between two faces of each axis at
    /// one time.
    pub(crate) fn span(&self, [lower, upper]: [[T; 3]; 2]) -> Option<[T; 2]> {
        let (mut enters, mut leaves) = (T::ZERO, self.longest);
        for axis in 0..3 {
            let low = lower[axis] - self.margin - self.origin[axis];
            let high = upper[axis] + self.margin - self.origin[axis];
            if !self.inverse[axis].is_finite() {
                if low > T::ZERO || high < T::ZERO {
                    return None;
                }
                continue;
            }
            let [first, last] = [low * self.inverse[axis], high * self.inverse[axis]];
            enters = enters.greater(first.lesser(last));
            leaves = leaves.lesser(first.greater(last));
        }
        (enters <= leaves).then_some([enters, leaves])
    }
}

impl<T: Real> Tree<T> {
    /// A tree over boxes numbered from 0 on; `None` is a box without end.
    #[must_use]
    pub fn new(all: impl IntoIterator<Item = Option<Bounds<T>>>) -> Self {
        let mut tree = Self { nodes: Vec::new(), boxes: Vec::new(), endless: Vec::new() };
        for (number, bounds) in (0..).zip(all) {
            match bounds {
                Some(bounds) => tree.boxes.push((grown(bounds), number)),
                None => tree.endless.push(number),
            }
        }
        tree.build(0, tree.boxes.len());
        tree
    }

    /// The numbers of the boxes without end, which are near everywhere.
    #[must_use]
    pub fn endless(&self) -> &[u32] {
        &self.endless
    }

    /// How many boxes have an end.
    #[must_use]
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Whether no box has an end.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// Appends the numbers of the boxes that touch `bounds`, in rising order;
    /// those without end are left out.
    pub fn near(&self, bounds: Bounds<T>, found: &mut Vec<u32>) {
        let start = found.len();
        self.for_each(bounds, |number| found.push(number));
        found[start..].sort_unstable();
    }

    /// Visits the numbers of the boxes that touch `bounds`, in an order that
    /// means nothing; those without end are left out.
    #[inline]
    pub fn for_each(&self, bounds: Bounds<T>, mut visit: impl FnMut(u32)) {
        self.for_each_box(bounds, |_, number| visit(number));
    }

    /// As [`for_each`](Self::for_each), and the boxes themselves, a little grown.
    #[inline]
    pub(crate) fn for_each_box(&self, bounds: Bounds<T>, mut visit: impl FnMut(Bounds<T>, u32)) {
        let _ = self.visit(bounds, |bounds, number| -> ControlFlow<()> {
            visit(bounds, number);
            ControlFlow::Continue(())
        });
    }

    /// Whether any box that touches `bounds` is what `is_wanted` says; those
    /// without end are left out.
    pub fn any(&self, bounds: Bounds<T>, mut is_wanted: impl FnMut(u32) -> bool) -> bool {
        let visit = |_, number| {
            if is_wanted(number) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.visit(bounds, visit).is_break()
    }

    /// The bytes that the tree holds.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.boxes.as_slice())
            + size_of_val(self.endless.as_slice())
    }

    /// The box around all boxes that have an end.
    pub(crate) fn bounds(&self) -> Option<Bounds<T>> {
        self.nodes.first().map(|root| [root.lower.into(), root.upper.into()])
    }

    /// Visits the numbers of the boxes in the way of a ray, in an order that means nothing;
    /// those without end are left out.
    pub(crate) fn for_each_along(&self, ray: Ray<T>, mut visit: impl FnMut(u32)) {
        let _ = self.visit_where(
            |bounds| ray.touches(bounds),
            |_, number| -> ControlFlow<()> {
                visit(number);
                ControlFlow::Continue(())
            },
        );
    }

    #[inline]
    fn visit<B>(
        &self,
        bounds: Bounds<T>,
        visit: impl FnMut(Bounds<T>, u32) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let searched = grown(bounds).each(Vec3::to_array);
        self.visit_where(|bounds| touch(bounds, searched), visit)
    }

    #[inline]
    fn visit_where<B>(
        &self,
        is_near: impl Fn([[T; 3]; 2]) -> bool,
        mut visit: impl FnMut(Bounds<T>, u32) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if !is_near([node.lower, node.upper]) {
                at = node.next as usize;
                continue;
            }
            let first = node.first as usize;
            for &(bounds, number) in &self.boxes[first..first + node.count as usize] {
                if is_near(bounds.each(Vec3::to_array)) {
                    visit(bounds, number)?;
                }
            }
            at += 1;
        }
        ControlFlow::Continue(())
    }

    /// Builds the nodes over a run of boxes.
    fn build(&mut self, start: usize, end: usize) {
        let boxes = &mut self.boxes[start..end];
        let Some(&(first, _)) = boxes.first() else { return };
        let [lower, upper] = boxes.iter().fold(first, |all, &(one, _)| joined(all, one));
        let own = self.nodes.len();
        let is_leaf = boxes.len() <= LEAF;
        self.nodes.push(Node {
            lower: lower.to_array(),
            upper: upper.to_array(),
            next: 0,
            first: start as u32,
            count: if is_leaf { boxes.len() as u32 } else { 0 },
        });
        if !is_leaf {
            let axis = widest(boxes);
            let half = boxes.len() / 2;
            // Equal centres by number: the tree is the same on every machine.
            boxes.select_nth_unstable_by(half, |a, b| {
                let order = center(&a.0, axis).partial_cmp(&center(&b.0, axis));
                order.unwrap_or(core::cmp::Ordering::Equal).then(a.1.cmp(&b.1))
            });
            self.build(start, start + half);
            self.build(start + half, end);
        }
        self.nodes[own].next = self.nodes.len() as u32;
    }
}

#[inline(always)]
fn touch<T: Real>(a: [[T; 3]; 2], b: [[T; 3]; 2]) -> bool {
    let along = |k: usize| a[0][k] <= b[1][k] && b[0][k] <= a[1][k];
    along(0) & along(1) & along(2)
}

/// A box with the room that rounding takes.
fn grown<T: Real>([lower, upper]: Bounds<T>) -> Bounds<T> {
    let largest = |point: Vec3<T>| point.x.abs().greater(point.y.abs()).greater(point.z.abs());
    let margin = largest(lower).greater(largest(upper)) * T::EPSILON * T::whole(ROUNDING);
    let margin = Vec3::new(margin, margin, margin);
    [lower - margin, upper + margin]
}

/// The box around two boxes.
pub(crate) fn joined<T: Real>([a, b]: Bounds<T>, [c, d]: Bounds<T>) -> Bounds<T> {
    [a.lesser(c), b.greater(d)]
}

/// Twice the centre of a box, along an axis, from halves that do not overflow.
fn center<T: Real>([lower, upper]: &Bounds<T>, axis: usize) -> T {
    let half = T::ratio(1, 2);
    lower.to_array()[axis] * half + upper.to_array()[axis] * half
}

/// The axis along which centres spread most.
fn widest<T: Real>(boxes: &[(Bounds<T>, u32)]) -> usize {
    let spread: [T; 3] = array::from_fn(|axis| {
        let first = center(&boxes[0].0, axis);
        let (least, most) = boxes.iter().fold((first, first), |(least, most), (bounds, _)| {
            let c = center(bounds, axis);
            (least.lesser(c), most.greater(c))
        });
        most - least
    });
    let wider = |a: usize, b: usize| if spread[b] > spread[a] { b } else { a };
    wider(wider(0, 1), 2)
}

#[cfg(test)]
mod tests {
    use super::{Bounds, Tree};
    use crate::real::Real;
    use crate::space::noise::noise;
    use crate::space::test_boxes::{cube, touch};
    use crate::vec3::Vec3;

    /// Every box that a look at all of them finds is found, once and in order;
    /// no box that is farther than rounding.
    fn agrees<T: Real>(boxes: &[Option<Bounds<T>>], searches: &[Bounds<T>]) {
        let tree = Tree::new(boxes.iter().copied());
        assert_eq!(tree.len() + tree.endless().len(), boxes.len());
        for search in searches {
            let mut found = Vec::new();
            tree.near(*search, &mut found);
            assert!(found.is_sorted_by(|a, b| a < b));
            let wide = super::grown(super::grown(super::grown(*search)));
            for (number, bounds) in (0..).zip(boxes) {
                let Some(bounds) = bounds else { continue };
                let is_found = found.contains(&number);
                assert!(is_found || !touch(bounds, search), "{bounds:?} {search:?}");
                assert!(!is_found || touch(&super::grown(super::grown(*bounds)), &wide));
                assert_eq!(tree.any(*search, |other| other == number), is_found);
            }
        }
    }

    fn agrees_everywhere<T: Real>() {
        let mut noise = noise();
        let cases: [(usize, f64, f64, f64); 7] = [
            (0, 0.0, 1.0, 1.0),
            (1, 0.0, 1.0, 1.0),
            (5, 0.0, 0.1, 0.1),
            (300, 0.0, 0.05, 0.05),
            (300, 0.0, 1e-4, 10.0),
            (300, 1e6, 0.05, 0.5),
            (300, -1e15, 1e-3, 1e13),
        ];
        for (count, far, least, most) in cases {
            let mut boxes: Vec<Option<Bounds<T>>> = Vec::new();
            let mut searches = Vec::new();
            for k in 0..count {
                let center = [(); 3].map(|()| far + (10.0 + f64::abs(far) * 1e-3) * noise());
                let half = least * f64::powf(most / least, noise());
                boxes.push((k % 7 != 3).then(|| cube(center, half)));
                let center = [(); 3].map(|()| far + (10.0 + f64::abs(far) * 1e-3) * noise());
                searches.push(cube(center, half));
            }
            agrees(&boxes, &searches);
        }
    }

    #[test]
    fn finds_what_a_look_at_all_boxes_finds() {
        agrees_everywhere::<f32>();
        agrees_everywhere::<f64>();
    }

    #[test]
    fn equal_boxes_and_boxes_without_extent() {
        let same = vec![Some(cube::<f64>([1.0; 3], 0.5)); 100];
        agrees(&same, &[cube([1.2; 3], 0.1), cube([2.0; 3], 0.1)]);
        let points = vec![Some(cube::<f32>([1.0; 3], 0.0)); 9];
        agrees(&points, &[cube([1.0; 3], 0.0), cube([1.1; 3], 0.0)]);
        agrees(&[None::<Bounds<f64>>; 3], &[cube([0.0; 3], 1.0)]);
    }

    /// A search looks at few boxes beside those it finds, also where most boxes
    /// are in a corner of the space that all take.
    #[test]
    fn is_as_deep_as_the_logarithm() {
        let mut noise = noise();
        let boxes = (0..10_000).map(|k| {
            let far = if k % 100 == 0 { 1e9 } else { 1.0 };
            Some(cube::<f64>([(); 3].map(|()| far * noise()), 1e-3))
        });
        let tree = Tree::new(boxes);
        let mut most = 0;
        for _ in 0..100 {
            let search = super::grown(cube([(); 3].map(|()| noise()), 1e-3));
            let (mut at, mut nodes) = (0, 0);
            while let Some(node) = tree.nodes.get(at) {
                let is_near = super::touch([node.lower, node.upper], search.map(Vec3::to_array));
                at = if is_near { at + 1 } else { node.next as usize };
                nodes += 1;
            }
            most = most.max(nodes);
        }
        assert!(most < 400, "{most} of {} nodes", tree.nodes.len());
        assert!(tree.bytes() < 10_000 * 150);
    }
}
