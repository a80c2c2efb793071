//! Near: which fixed features a body in a cell can touch.

use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::cells::{Ends, Grid, Span};
use crate::space::joined;
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

/// How many cells are looked at for each such entry, before all share one list.
const LOOKS: usize = 8;

/// The binary digits by which fewer tell lists apart when more cells share one:
/// twice as many cells along each side.
const SHARED_STEP: u32 = 3;

/// All cells share one list.
const ALL: u32 = 30;

/// The features near each cell.
#[derive(Debug, Default)]
pub(super) struct Near {
    /// Those near everywhere.
    everywhere: Vec<Image>,
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

impl Near {
    /// Finds the features near each cell, for bodies of up to `radius`.
    pub fn new<T: Real>(
        features: &[Feature<T>],
        images: &[Vec3<T>],
        cells: &Grid<T>,
        radius: T,
    ) -> Self {
        let mut near = Self::default();
        let mut lists = Lists::new(features.len() * images.len());
        let is_folded = cells.is_folded();
        for (number, feature) in features.iter().enumerate() {
            let bounds = feature.bounds();
            for (image, shift) in images.iter().enumerate() {
                let this = Image { feature: number as u32, image: image as u32 };
                let bounds = bounds.map(|bounds| bounds.each(|corner| corner + *shift));
                if is_folded && bounds.is_none() {
                    near.everywhere.push(this);
                } else if lists.shared == ALL {
                    lists.put(this, 0);
                } else if let Some(bounds) = bounds.filter(|_| is_folded) {
                    cells.each_in(bounds, radius, |cell| lists.put(this, cell));
                } else {
                    let is_near = |center: Vec3<T>, reach: T| {
                        feature.clearance(center - *shift, radius).gap.le(reach)
                    };
                    cells.each_near(bounds, radius, is_near, |cell| lists.put(this, cell));
                }
            }
        }
        let Lists { mut entries, shared, .. } = lists;
        // Where two images of a cell fold into one, or cells share a list.
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

    /// Whether it depends on the cell which features are near.
    pub fn has_cells(&self) -> bool {
        !self.images.is_empty()
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
        self.starts.capacity() * size_of::<u32>() + self.images.capacity() * size_of::<Image>()
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
