//! Near: which fixed features a body in a cell can touch.

use super::cells::{Cells, Ends, Region};
use crate::real::Real;
use crate::surroundings::Feature;
use crate::vec3::Vec3;

/// An image of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Image {
    pub feature: u32,
    /// Its number among the images of the box.
    pub image: u32,
}

/// The features near each cell.
#[derive(Debug, Default)]
pub(super) struct Near {
    /// Those near everywhere.
    everywhere: Vec<Image>,
    /// Where each cell's features start in `images`.
    starts: Vec<u32>,
    images: Vec<Image>,
}

impl Near {
    /// Finds the features near each cell, for bodies of up to `radius`.
    pub fn new<T: Real>(
        features: &[Feature<T>],
        images: &[Vec3<T>],
        cells: &Cells<T>,
        ends: Ends,
        radius: T,
    ) -> Self {
        let mut near = Self::default();
        let mut found: Vec<(u32, Image)> = Vec::new();
        let is_open = ends == Ends::Joined && images.len() == 1;
        for (number, feature) in features.iter().enumerate() {
            for (image, shift) in images.iter().enumerate() {
                let this = Image { feature: number as u32, image: image as u32 };
                if is_open {
                    match feature.bounds() {
                        None => near.everywhere.push(this),
                        Some(bounds) => {
                            cells.each_in(bounds, radius, |cell| found.push((cell, this)))
                        }
                    }
                } else {
                    let is_near = |center: Vec3<T>, reach: T| {
                        feature.clearance(center - *shift, radius).gap.le(reach)
                    };
                    cells.each_near(is_near, |cell| found.push((cell, this)));
                }
            }
        }
        found.sort_by_key(|&(cell, _)| cell);
        if !found.is_empty() {
            near.starts = vec![0; cells.numbers() + 1];
            for &(cell, _) in &found {
                near.starts[cell as usize + 1] += 1;
            }
            for k in 1..near.starts.len() {
                near.starts[k] += near.starts[k - 1];
            }
            near.images = found.into_iter().map(|(_, image)| image).collect();
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
        match self.starts.get(cell as usize..cell as usize + 2) {
            Some(&[start, end]) => &self.images[start as usize..end as usize],
            _ => &[],
        }
    }

    /// The bytes that the lists hold.
    pub fn bytes(&self) -> usize {
        self.starts.capacity() * size_of::<u32>() + self.images.capacity() * size_of::<Image>()
    }
}

/// The region in which bodies are: the inside of the containers, or what the
/// bodies and the solids without end span at the start. Bodies on a line or in a
/// plane span nothing across: `least` is what each side has at least.
pub(super) fn region<T: Real>(
    least: T,
    interiors: impl Iterator<Item = [Vec3<T>; 2]>,
    features: &[Feature<T>],
    centers: impl Iterator<Item = Vec3<T>>,
) -> Region<T> {
    let lesser =
        |a: Vec3<T>, b: Vec3<T>| Vec3::new(a.x.lesser(b.x), a.y.lesser(b.y), a.z.lesser(b.z));
    let greater =
        |a: Vec3<T>, b: Vec3<T>| Vec3::new(a.x.greater(b.x), a.y.greater(b.y), a.z.greater(b.z));
    let inside = interiors.reduce(|[a, b], [c, d]| [greater(a, c), lesser(b, d)]);
    if let Some([lower, upper]) = inside {
        return Region { lower, upper, ends: Ends::Closed };
    }
    let solids = features.iter().filter_map(Feature::bounds);
    let points = solids.chain(centers.map(|center| [center, center]));
    let all = points.reduce(|[a, b], [c, d]| [lesser(a, c), greater(b, d)]);
    let [lower, upper] = all.unwrap_or([Vec3::ZERO, Vec3::ZERO]);
    let missing = |low: T, high: T| (least - (high - low)).greater(T::ZERO) * T::ratio(1, 2);
    let missing =
        Vec3::new(missing(lower.x, upper.x), missing(lower.y, upper.y), missing(lower.z, upper.z));
    Region { lower: lower - missing, upper: upper + missing, ends: Ends::Joined }
}
