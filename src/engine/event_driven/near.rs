//! Near: which fixed features a body in a cell can touch.

use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::cells::{Ends, Grid, Span};
use crate::space::{Bounds, Tree, joined};
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// An image of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Image {
    pub feature: u32,
    /// Its number among the images of the box.
    pub image: u32,
}

/// The most entries of all lists, for each feature's image and besides. Where
/// there were more, several cells share a list.
const ENTRIES_EACH: usize = 64;
const ENTRIES_BESIDES: usize = 1 << 16;

/// How many cells are looked at for each such entry, before there are no lists.
const LOOKS: usize = 8;

/// The binary digits by which fewer tell lists apart when more cells share one:
/// twice as many cells along each side.
const SHARED_STEP: u32 = 3;

/// All cells would share one list.
const ALL: u32 = 30;

/// The features near each cell.
#[derive(Debug)]
pub(super) struct Near<T> {
    /// Those near everywhere.
    everywhere: Vec<Image>,
    /// Those that have an end, where lists would tell little: many cells fold into each, or
    /// all would share one.
    tree: Tree<T>,
    /// The number of a cell's list is its own without this number of last digits.
    shared: u32,
    /// Where each list starts in `images`.
    starts: Vec<u32>,
    images: Vec<Image>,
}

/// Lists in the making: which image is on which list, image by image.
struct Lists {
    entries: Vec<(Image, u32)>,
    shared: u32,
    most: usize,
    looks: usize,
}

impl Lists {
    fn new(images: usize) -> Self {
        let most = ENTRIES_BESIDES + ENTRIES_EACH * images;
        Self { entries: Vec::new(), shared: 0, most, looks: LOOKS * most }
    }

    /// Puts an image on the list of a cell.
    fn put(&mut self, image: Image, cell: u32) {
        self.looks = self.looks.saturating_sub(1);
        if self.looks == 0 && self.shared < ALL {
            self.share(ALL - self.shared);
        }
        let entry = (image, cell >> self.shared);
        if self.entries.last() != Some(&entry) {
            self.entries.push(entry);
        }
        while self.entries.len() > self.most && self.shared < ALL {
            self.share(SHARED_STEP);
        }
    }

    fn share(&mut self, digits: u32) {
        self.shared += digits;
        self.entries.iter_mut().for_each(|entry| entry.1 >>= digits);
        self.entries.sort_unstable();
        self.entries.dedup();
    }
}

impl<T: Real> Near<T> {
    /// Finds the features near each cell, for bodies of up to `radius`.
    pub fn new(features: &[Feature<T>], images: &[Vec3<T>], cells: &Grid<T>, radius: T) -> Self {
        let tree = Tree::new([]);
        let (everywhere, starts) = (Vec::new(), Vec::new());
        let mut near = Self { everywhere, tree, shared: 0, starts, images: Vec::new() };
        if cells.is_folded() {
            return near.in_tree(features, images);
        }
        let mut lists = Lists::new(features.len() * images.len());
        for (number, feature) in (0..).zip(features) {
            let bounds = feature.bounds();
            for (image, shift) in (0..).zip(images) {
                let this = Image { feature: number, image };
                let bounds = bounds.map(|bounds| bounds.each(|corner| corner + *shift));
                let is_near = |center: Vec3<T>, reach: T| {
                    feature.clearance(center - *shift, radius).gap.le(reach)
                };
                cells.each_near(bounds, radius, is_near, |cell| lists.put(this, cell));
                if lists.shared == ALL {
                    return near.in_tree(features, images);
                }
            }
        }
        let Lists { mut entries, shared, .. } = lists;
        // Where cells share a list.
        entries.sort_unstable();
        entries.dedup();
        entries.sort_by_key(|&(_, list)| list);
        if let Some(&(_, last)) = entries.last() {
            near.shared = shared;
            near.starts = vec![0; last as usize + 2];
            for &(_, list) in &entries {
                near.starts[list as usize + 1] += 1;
            }
            for k in 1..near.starts.len() {
                near.starts[k] += near.starts[k - 1];
            }
            near.images = entries.into_iter().map(|(image, _)| image).collect();
        }
        near
    }

    fn in_tree(mut self, features: &[Feature<T>], images: &[Vec3<T>]) -> Self {
        self.tree = Tree::new(features.iter().map(Feature::bounds));
        let images = 0..images.len() as u32;
        let of = |&feature| images.clone().map(move |image| Image { feature, image });
        self.everywhere = self.tree.endless().iter().flat_map(of).collect();
        self
    }

    /// Whether it depends on the cell which features are near.
    pub fn has_cells(&self) -> bool {
        !self.images.is_empty() || self.has_tree()
    }

    /// Whether those that have an end are found by their boxes, not by cells.
    pub fn has_tree(&self) -> bool {
        !self.tree.is_empty()
    }

    /// Visits those that have an end whose boxes touch a box, where there are no lists.
    #[inline]
    pub fn for_each_in(&self, bounds: Bounds<T>, visit: impl FnMut(u32)) {
        self.tree.for_each(bounds, visit);
    }

    /// The features that are near everywhere.
    pub fn everywhere(&self) -> &[Image] {
        &self.everywhere
    }

    /// The features near the cell of a number.
    #[inline]
    pub fn of(&self, cell: u32) -> &[Image] {
        let list = (cell >> self.shared) as usize;
        match self.starts.get(list..list + 2) {
            Some(&[start, end]) => &self.images[start as usize..end as usize],
            _ => &[],
        }
    }

    /// The bytes that the lists hold.
    pub fn bytes(&self) -> usize {
        self.starts.capacity() * size_of::<u32>()
            + self.images.capacity() * size_of::<Image>()
            + self.tree.bytes()
    }
}

/// The span in which bodies are: the inside of the containers, or what the
/// bodies and the solids without end span at the start. Bodies on a line or in a
/// plane span nothing across: `least` is what each side has at least.
pub(super) fn span<T: Real>(
    least: T,
    interiors: impl Iterator<Item = [Vec3<T>; 2]>,
    solids: impl Iterator<Item = [Vec3<T>; 2]>,
    centers: impl Iterator<Item = Vec3<T>>,
) -> Span<T> {
    let inside = interiors.reduce(|[a, b], [c, d]| [a.greater(c), b.lesser(d)]);
    if let Some([lower, upper]) = inside {
        return Span::new(lower, upper, Ends::Closed);
    }
    let points = solids.chain(centers.map(|center| [center, center]));
    let all = points.reduce(joined);
    let [lower, upper] = all.unwrap_or([Vec3::ZERO, Vec3::ZERO]);
    let missing = |low: T, high: T| (least - (high - low)).greater(T::ZERO) * T::ratio(1, 2);
    let missing =
        Vec3::new(missing(lower.x, upper.x), missing(lower.y, upper.y), missing(lower.z, upper.z));
    Span::new(lower - missing, upper + missing, Ends::Open)
}
