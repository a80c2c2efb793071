//! At parts: the bodies that may touch something fixed.
//!
//! Parts do not move: a body that is not within half of the skin of one cannot touch
//! it before the next search.

use core::ops::Range;

use super::candidates::{Chunk, SHELLS, shell};
use crate::bodies::{Figure, PerBody};
use crate::lane::{Lane, Mask, ones};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::{Bounds, FixedParts, Tree, joined};
use crate::vec3::Vec3;

/// So few fixed parts are each tested against all bodies; of more, the tree says
/// which are near.
pub(super) const FEW_PARTS: usize = 8;

/// The tree is asked for a group of bodies at once that stand one after the other: so
/// many at most, in a box that is at most so much wider than that of the first one.
const GROUP: usize = 8;
/// Bodies that stand one after the other, in a sphere around which an endless part is
/// looked for at first.
const BLOCK: usize = 8;
const COMPACT: i32 = 12;

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

/// A part, a body whose image comes near its box, and the number of the image.
type Near = (u32, u32, u32);

/// A search for bodies at parts in progress. Radii and space are looked at once a
/// body, so that they have no kernels of their own.
pub(super) struct PartSearch<'a, T: Real, P: ?Sized> {
    pub position: [&'a [T]; 3],
    pub radius: &'a PerBody<T>,
    pub greatest_radius: T,
    /// For the rounding of coordinates, length.
    pub margin: T,
    /// From a point to itself and to its images in the periodic box: a body may be
    /// near a part where the box puts it when it leaves.
    pub images: &'a [Vec3<T>],
    pub skin: T,
    pub shell_ends: [T; SHELLS - 1],
    pub parts: &'a P,
    pub tree: &'a Tree<T>,
}

impl<T: Real, P: FixedParts<T> + ?Sized> PartSearch<'_, T, P> {
    /// Finds the bodies of a chunk that are near fixed parts.
    pub fn search<L: Lane<Scalar = T>>(&self, bodies: Range<usize>, chunk: &mut Chunk) {
        let are_few = self.tree.len() <= FEW_PARTS;
        let few: Vec<_> = if are_few { (0..self.parts.alone() as u32).collect() } else { vec![] };
        let swept = if are_few { &few } else { self.tree.endless() };
        if !swept.is_empty() {
            let blocks = self.blocks::<L>(&bodies);
            for &part in swept {
                self.sweep_blocks::<L>(part, &bodies, &blocks, chunk);
            }
        }
        if are_few && self.parts.alone() == self.parts.count() {
            return;
        }
        let mut found = Vec::new();
        let mut rest = bodies;
        while !rest.is_empty() {
            let (group, bounds) = self.group(&rest);
            rest.start = group.end;
            for (number, &image) in (0..).zip(self.images) {
                let bounds = bounds.each(|corner| corner + image);
                let mut keep = |bounds, part| {
                    self.near_box::<L>(&group, image, bounds, |body| {
                        found.push((part, body, number));
                    });
                };
                if !are_few {
                    self.tree.for_each_box(bounds, &mut keep);
                }
                self.parts.for_each_near(bounds, &mut keep);
            }
        }
        // Part by part, as they stand in memory; by one number, which is compared at once.
        found.sort_unstable_by_key(|&(part, body, image)| {
            u128::from(part) << 64 | u128::from(body) << 32 | u128::from(image)
        });
        for images in found.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (part, body, _) = images[0];
            let slot = body as usize;
            let (center, radius) = (self.center(slot), self.radius.of(slot));
            let gap = |&(_, _, image): &Near| {
                self.parts.gap::<T>(part as usize, center + self.images[image as usize], radius)
            };
            let gap =
                images[1..].iter().fold(gap(&images[0]), |least, image| gap(image).lesser(least));
            let twice = gap + gap;
            if twice < self.skin {
                chunk.at_parts[shell(&self.shell_ends, twice)].push(part, body);
            }
        }
    }

    /// Spheres around the bodies of one block after the other: their centres and radii, whole
    /// packs of them.
    #[inline(never)]
    fn blocks<L: Lane<Scalar = T>>(&self, bodies: &Range<usize>) -> [Vec<T>; 4] {
        let count = bodies.len().div_ceil(BLOCK).next_multiple_of(L::WIDTH);
        let mut blocks = [(); 4].each(|()| Vec::with_capacity(count));
        for first in bodies.clone().step_by(BLOCK) {
            let last = (first + BLOCK).min(bodies.end) - 1;
            let center = self.center(usize::midpoint(first, last));
            // What stands behind the last one may count too.
            let packs = (first..=last)
                .step_by(L::WIDTH)
                .map(|start| (self.centers::<L>(start) - Vec3::splat(center)).length_squared());
            let farthest = packs.fold(L::ZERO, |most, squared| squared.greater(most)).to_array();
            let farthest =
                farthest.as_ref().iter().fold(T::ZERO, |most, squared| squared.greater(most));
            let reach = Lane::sqrt(farthest) * T::ratio(1025, 1024);
            let reach = reach + self.greatest_radius + self.margin;
            for (column, value) in blocks.iter_mut().zip([center.x, center.y, center.z, reach]) {
                column.push(value);
            }
        }
        blocks.iter_mut().for_each(|column| column.resize(count, T::ZERO));
        blocks
    }

    /// Tests the bodies against one part, but for the blocks that are not near it.
    fn sweep_blocks<L: Lane<Scalar = T>>(
        &self,
        part: u32,
        bodies: &Range<usize>,
        blocks: &[Vec<T>; 4],
        chunk: &mut Chunk,
    ) {
        let reach = L::splat(self.reach());
        let count = bodies.len().div_ceil(BLOCK);
        for block in (0..count).step_by(L::WIDTH) {
            let [x, y, z, radius] = blocks.refs().each(|column| L::load(&column[block..]));
            let gap = self.least_gap(part, Vec3::new(x, y, z), radius);
            // Where it is NaN there is no telling.
            for block in ones((!gap.ge(reach)).bits()).map(|k| block + k) {
                if block < count {
                    let start = bodies.start + block * BLOCK;
                    self.sweep::<L>(part, &(start..bodies.end.min(start + BLOCK)), chunk);
                }
            }
        }
    }

    /// Tests some bodies against one part.
    fn sweep<L: Lane<Scalar = T>>(&self, part: u32, bodies: &Range<usize>, chunk: &mut Chunk) {
        for start in bodies.clone().step_by(L::WIDTH) {
            let (center, radius) = (self.centers::<L>(start), self.radius.load_tail::<L>(start));
            let gap = self.least_gap(part, center, radius);
            let twice = gap + gap;
            for k in ones(twice.lt(L::splat(self.skin)).bits()) {
                if start + k < bodies.end {
                    let shell = shell(&self.shell_ends, twice.to_array().as_ref()[k]);
                    chunk.at_parts[shell].push(part, (start + k) as u32);
                }
            }
        }
    }

    /// The gap between a part and the nearest images of spheres, length.
    #[inline(never)]
    fn least_gap<L: Lane<Scalar = T>>(&self, part: u32, center: Vec3<L>, radius: L) -> L {
        let gaps = self
            .images
            .iter()
            .map(|image| self.parts.gap(part as usize, center + Vec3::splat(*image), radius));
        gaps.reduce(|least, gap| gap.lesser(least)).unwrap_or(L::ONE / L::ZERO)
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

    /// Calls `visit` with those of some bodies an image of which comes near a box.
    #[inline(always)]
    fn near_box<L: Lane<Scalar = T>>(
        &self,
        bodies: &Range<usize>,
        image: Vec3<T>,
        [lower, upper]: Bounds<T>,
        mut visit: impl FnMut(u32),
    ) {
        let [lower, upper] = [lower - image, upper - image].each(Vec3::<L>::splat);
        for start in bodies.clone().step_by(L::WIDTH) {
            let center = self.centers::<L>(start);
            let beyond = |least: L, c: L, most: L| (least - c).greater(c - most).greater(L::ZERO);
            let offset = Vec3::new(
                beyond(lower.x, center.x, upper.x),
                beyond(lower.y, center.y, upper.y),
                beyond(lower.z, center.z, upper.z),
            );
            let reach = self.radius.load_tail::<L>(start) + L::splat(self.reach());
            let reach = reach * L::ratio(1025, 1024);
            let is_near = offset.length_squared().le(reach * reach);
            for body in ones(is_near.bits()).map(|k| start + k) {
                if body < bodies.end {
                    visit(body as u32);
                }
            }
        }
    }

    /// The centres of the bodies from a slot on, zeros past the end.
    #[inline(always)]
    fn centers<L: Lane<Scalar = T>>(&self, start: usize) -> Vec3<L> {
        let [x, y, z] = self.position;
        Vec3::new(x.load_tail(start), y.load_tail(start), z.load_tail(start))
    }

    #[inline(always)]
    fn center(&self, body: usize) -> Vec3<T> {
        let [x, y, z] = self.position;
        Vec3::new(x[body], y[body], z[body])
    }

    /// How far from its surface a body looks for parts.
    #[inline(always)]
    fn reach(&self) -> T {
        self.skin * T::ratio(1, 2)
    }

    /// The box that a body and half of its skin fill.
    #[inline(always)]
    fn bounds(&self, body: usize) -> Bounds<T> {
        let reach = self.radius.of(body) + self.reach();
        let (center, reach) = (self.center(body), Vec3::new(reach, reach, reach));
        [center - reach, center + reach]
    }
}

/// Whether a box is at most `times` as wide as another one along each axis.
fn is_within<T: Real>(all: Bounds<T>, one: Bounds<T>, times: T) -> bool {
    let [all, one] = [all, one].each(|[lower, upper]| (upper - lower).to_array());
    (0..3).all(|k| all[k] <= one[k] * times)
}
