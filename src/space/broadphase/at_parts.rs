//! At parts: the bodies that may touch something fixed.
//!
//! Parts do not move: a body that is not within half of the skin of one cannot touch
//! it before the next search.

use core::ops::Range;

use super::candidates::{Chunk, SHELLS, shell};
use crate::bodies::{Figure, PerBody};
use crate::lane::{Lane, Mask};
use crate::real::Real;
use crate::space::{Bounds, FixedParts, Tree, grown, joined};
use crate::vec3::Vec3;

/// So few fixed parts are each tested against all bodies; of more, the tree says
/// which are near.
pub(super) const FEW_PARTS: usize = 8;

/// The tree is asked for a group of bodies that stand one after the other, if its box
/// is at most so much wider than that of its first body. A group of its own for each
/// body took twice the time among 32,768 parts.
const COMPACT: i32 = 8;

/// Bodies of a group.
const GROUP: usize = 16;

/// Bodies near fixed parts, part by part.
#[derive(Debug, Default)]
pub(super) struct AtParts {
    bodies: Vec<u32>,
    /// Each part, and where its bodies end.
    parts: Vec<(u32, usize)>,
}

impl AtParts {
    pub fn clear(&mut self) {
        self.bodies.clear();
        self.parts.clear();
    }

    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Adds a body to the last part, or begins another one.
    pub fn push(&mut self, part: u32, body: u32) {
        self.bodies.push(body);
        let end = self.bodies.len();
        match self.parts.last_mut() {
            Some(last) if last.0 == part => last.1 = end,
            _ => self.parts.push((part, end)),
        }
    }

    /// The parts and their bodies.
    pub fn each(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mut start = 0;
        self.parts.iter().map(move |&(part, end)| {
            let bodies = &self.bodies[start..end];
            start = end;
            (part, bodies)
        })
    }

    pub fn bytes(&self) -> usize {
        self.bodies.capacity() * size_of::<u32>()
            + self.parts.capacity() * size_of::<(u32, usize)>()
    }
}

/// A search for bodies at parts in progress. Radii and space are looked at once a
/// body, so that they have no kernels of their own.
pub(super) struct PartSearch<'a, T: Real, P: ?Sized> {
    pub position: [&'a [T]; 3],
    pub radius: &'a PerBody<T>,
    /// From a point to itself and to its images in the periodic box: a body may be
    /// near a part where the box puts it when it leaves.
    pub images: &'a [Vec3<T>],
    pub skin: T,
    pub shell_ends: [T; SHELLS - 1],
    pub parts: &'a P,
    pub tree: &'a Tree<T>,
}

/// The boxes of the parts near a group of bodies, in columns.
#[derive(Debug)]
struct Boxes<T> {
    lower: [Vec<T>; 3],
    upper: [Vec<T>; 3],
    parts: Vec<u32>,
}

impl<T: Real> Boxes<T> {
    fn new() -> Self {
        let none = || [const { Vec::new() }; 3];
        Self { lower: none(), upper: none(), parts: Vec::new() }
    }

    fn clear(&mut self) {
        self.lower.iter_mut().chain(&mut self.upper).for_each(Vec::clear);
        self.parts.clear();
    }

    fn push(&mut self, [lower, upper]: Bounds<T>, part: u32) {
        let add = |columns: &mut [Vec<T>; 3], corner: Vec3<T>| {
            let [x, y, z] = columns;
            x.push(corner.x);
            y.push(corner.y);
            z.push(corner.z);
        };
        add(&mut self.lower, lower);
        add(&mut self.upper, upper);
        self.parts.push(part);
    }

    /// Fills the columns up to whole packs.
    fn fill_up(&mut self, width: usize) {
        let whole = self.parts.len().next_multiple_of(width);
        for column in self.lower.iter_mut().chain(&mut self.upper) {
            column.resize(whole, T::ZERO);
        }
    }

    /// Calls `visit` with the parts whose boxes touch another one.
    #[inline(always)]
    fn each_near<L: Lane<Scalar = T>>(
        &self,
        [lower, upper]: Bounds<T>,
        mut visit: impl FnMut(u32),
    ) {
        let [lower, upper] = [lower, upper].map(Vec3::<L>::splat);
        let at = |[x, y, z]: &[Vec<T>; 3], k: usize| -> Vec3<L> {
            Vec3::new(L::load(&x[k..]), L::load(&y[k..]), L::load(&z[k..]))
        };
        for (k, parts) in self.parts.chunks(L::WIDTH).enumerate() {
            let (least, most) = (at(&self.lower, k * L::WIDTH), at(&self.upper, k * L::WIDTH));
            let along_x = least.x.le(upper.x) & lower.x.le(most.x);
            let along_y = least.y.le(upper.y) & lower.y.le(most.y);
            let along_z = least.z.le(upper.z) & lower.z.le(most.z);
            let mut bits = (along_x & along_y & along_z).bits();
            while bits != 0 {
                // Lanes past the end are zeros.
                if let Some(&part) = parts.get(bits.trailing_zeros() as usize) {
                    visit(part);
                }
                bits &= bits - 1;
            }
        }
    }
}

impl<T: Real, P: FixedParts<T> + ?Sized> PartSearch<'_, T, P> {
    /// Finds the bodies of a chunk that are near fixed parts.
    pub fn search<L: Lane<Scalar = T>>(&self, bodies: Range<usize>, chunk: &mut Chunk) {
        if self.tree.len() <= FEW_PARTS {
            for part in 0..self.parts.count() as u32 {
                self.sweep::<L>(part, &bodies, chunk);
            }
            return;
        }
        for &part in self.tree.endless() {
            self.sweep::<L>(part, &bodies, chunk);
        }
        let mut found = Vec::new();
        let mut boxes = Boxes::new();
        let mut rest = bodies;
        while !rest.is_empty() {
            let (group, bounds) = self.group(&rest);
            rest.start = group.end;
            for &image in self.images {
                boxes.clear();
                let bounds = bounds.map(|corner| corner + image);
                self.tree.for_each_box(bounds, |bounds, part| boxes.push(bounds, part));
                boxes.fill_up(L::WIDTH);
                for body in group.clone() {
                    self.test::<L>(body, image, &boxes, &mut found);
                }
            }
        }
        // Two images of a body may be near a part: the nearer one counts.
        found.sort_unstable();
        found.dedup_by_key(|&mut (part, body, _)| (part, body));
        for (part, body, shell) in found {
            chunk.at_parts[shell as usize].push(part, body);
        }
    }

    /// Tests some bodies against one part.
    #[inline(never)]
    fn sweep<L: Lane<Scalar = T>>(&self, part: u32, bodies: &Range<usize>, chunk: &mut Chunk) {
        for start in bodies.clone().step_by(L::WIDTH) {
            let center = Vec3::new(
                self.position[0].load_tail::<L>(start),
                self.position[1].load_tail(start),
                self.position[2].load_tail(start),
            );
            let radius = self.radius.load_tail::<L>(start);
            let gap = |image: &Vec3<T>| {
                self.parts.gap(part as usize, center + Vec3::splat(*image), radius)
            };
            let gap = self.images.iter().map(gap).reduce(Lane::lesser).unwrap_or(L::ZERO);
            let twice = gap + gap;
            let mut bits = twice.lt(L::splat(self.skin)).bits();
            while bits != 0 {
                let k = bits.trailing_zeros() as usize;
                if start + k < bodies.end {
                    let shell = shell(&self.shell_ends, twice.to_array().as_ref()[k]);
                    chunk.at_parts[shell].push(part, (start + k) as u32);
                }
                bits &= bits - 1;
            }
        }
    }

    /// The next bodies for which the tree is asked at once, and the box around what
    /// they can reach.
    fn group(&self, bodies: &Range<usize>) -> (Range<usize>, Bounds<T>) {
        let one = self.bounds(bodies.start);
        let (mut end, mut all) = (bodies.start + 1, one);
        while end < bodies.end && end - bodies.start < GROUP {
            let more = joined(all, self.bounds(end));
            if !is_within(more, one, T::whole(COMPACT)) {
                break;
            }
            all = more;
            end += 1;
        }
        (bodies.start..end, all)
    }

    /// Tests an image of a body against some parts.
    #[inline(always)]
    fn test<L: Lane<Scalar = T>>(
        &self,
        body: usize,
        image: Vec3<T>,
        boxes: &Boxes<T>,
        found: &mut Vec<(u32, u32, u8)>,
    ) {
        let bounds = self.bounds(body).map(|corner| corner + image);
        boxes.each_near::<L>(bounds, |part| {
            let center = self.center(body) + image;
            let gap = self.parts.gap::<T>(part as usize, center, self.radius.of(body));
            let twice = gap + gap;
            if twice < self.skin {
                let shell = shell(&self.shell_ends, twice);
                found.push((part, body as u32, shell as u8));
            }
        });
    }

    #[inline(always)]
    fn center(&self, body: usize) -> Vec3<T> {
        let [x, y, z] = self.position;
        Vec3::new(x[body], y[body], z[body])
    }

    /// The box that a body and half of its skin fill, with room for rounding.
    #[inline(always)]
    fn bounds(&self, body: usize) -> Bounds<T> {
        let center = self.center(body);
        let reach = self.radius.of(body) + self.skin * T::ratio(1, 2);
        let reach = Vec3::new(reach, reach, reach);
        grown([center - reach, center + reach])
    }
}

/// Whether a box is at most `times` as wide as another one along each axis.
fn is_within<T: Real>(all: Bounds<T>, one: Bounds<T>, times: T) -> bool {
    let [all, one] = [all, one].map(|[lower, upper]| (upper - lower).to_array());
    (0..3).all(|k| all[k] <= one[k] * times)
}
