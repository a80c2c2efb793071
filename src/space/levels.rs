//! Levels: cells in levels by size, where bodies of one size have too many small
//! ones around them.
//!
//! Each level is a grid for the bodies of one factor of two in the radius, or of
//! several. The grids are nested: a cell is named by its coordinates in the finest
//! one, and those of a coarser one have fewer binary digits. All bodies cross the
//! cells of the finest level.
//!
//! A pair of one level is found from cells that are neighbours. Of a pair of two
//! levels the smaller body finds the greater one in the cells around it of the
//! greater one's level, each time it searches or crosses a cell of its own level.
//! The greater one finds the smaller one in the *shell* of cells of the smaller
//! one's level near its surface, each time it searches or crosses a cell of that
//! level (levels: Ogarko and Luding, *Computer Physics Communications* 183, 2012).

use super::cells::{Cells, Grid, Members, Span};
use super::sizes;
use crate::bodies::PerBody;
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// Bodies in the cells around a body from which one grid is no longer enough.
const CROWDED: u64 = 256;

/// The most binary digits by which grids differ.
const MOST_SHIFT: u32 = 20;

/// Cells in a row along `x`, relative to the cell of a body's centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    y: i32,
    z: i32,
    first: i32,
    last: i32,
}

impl Row {
    /// The cells of the row around a centre.
    pub fn cells(self, [x, y, z]: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
        (self.first..=self.last).map(move |along| [x + along, y + self.y, z + self.z])
    }
}

/// The grids. A scene of one grid finds it without a detour.
#[derive(Debug)]
pub(crate) struct Levels<T> {
    finest: Level<T>,
    /// The others, coarsest first.
    coarser: Vec<Level<T>>,
}

/// The grids, with the cells that a worker holds.
#[derive(Debug)]
pub(crate) struct Held<'a, T> {
    pub finest: Members<'a, T>,
    coarser: Vec<Members<'a, T>>,
    /// What is special to each level, coarsest first; empty if there is one only.
    sizes: Vec<&'a Sizes<T>>,
}

#[derive(Debug)]
struct Level<T> {
    cells: Cells<T>,
    sizes: Sizes<T>,
}

/// What is special to a level.
#[derive(Debug)]
pub(crate) struct Sizes<T> {
    /// Greatest radius of its bodies, length.
    greatest: T,
    /// Least radius of its bodies, length.
    least: T,
    /// By how many binary digits its coordinates are shorter than the finest ones.
    shift: u32,
    /// For each finer level where its bodies can touch one of this level.
    shells: Vec<Vec<Row>>,
}

impl<T: Real> Levels<T> {
    /// Empty grids that suit bodies of these radii among `parts` bounded fixed parts.
    pub fn fitting(span: Span<T>, radius: &PerBody<T>, len: usize, parts: usize) -> Self {
        let greatest = radius.greatest();
        let one = Cells::fitting(span, greatest + greatest, len, parts);
        let around = 27 * len as u64
            / one.grid().counts().iter().map(|&count| count as u64).product::<u64>();
        let several = match radius {
            PerBody::Each(radii) if around > CROWDED => Self::several(span, radii, &one, parts),
            _ => None,
        };
        several.unwrap_or_else(|| Self::one(one, greatest))
    }

    /// One cell for all bodies of up to a radius.
    pub fn whole(span: Span<T>, radius: T) -> Self {
        Self::one(Cells::whole(span), radius)
    }

    fn one(cells: Cells<T>, greatest: T) -> Self {
        let sizes = Sizes { greatest, least: T::ZERO, shift: 0, shells: Vec::new() };
        Self { finest: Level { cells, sizes }, coarser: Vec::new() }
    }

    /// Levels upon a grid for the greatest bodies; `None` if there is room for one
    /// only.
    fn several(span: Span<T>, radii: &[T], coarsest: &Cells<T>, parts: usize) -> Option<Self> {
        // Bodies of one factor of two in the radius: the greatest and the least of
        // them, and how many binary digits finer their grid can be.
        let sizes = sizes::classes(radii);
        let mut classes: Vec<(T, T, u32)> = sizes.iter().map(|&size| (size, size, 0)).collect();
        for &radius in radii {
            let least = &mut classes[sizes::class(&sizes, radius)].1;
            *least = least.lesser(radius);
        }
        let alone: Vec<[i32; 3]> = classes
            .iter()
            .map(|class| {
                Cells::fitting(span, class.0 + class.0, radii.len(), parts).grid().counts()
            })
            .collect();
        let (base, finest) = nested(coarsest.grid().counts(), *alone.last()?);
        for ((_, _, digits), counts) in classes.iter_mut().zip(&alone) {
            let fits = |shift: u32| (0..3).all(|k| base[k] << shift <= counts[k]);
            *digits = (1..=finest).take_while(|&shift| fits(shift)).count() as u32;
        }
        classes.dedup_by(|next, class| {
            let is_same = next.2 == class.2;
            if is_same {
                class.1 = next.1;
            }
            is_same
        });
        if classes.len() == 1 {
            return None;
        }
        let mut levels: Vec<_> = classes
            .iter()
            .map(|&(greatest, least, digits)| Level {
                cells: coarsest.divided(span, base.each(|count| count << digits)),
                sizes: Sizes { greatest, least, shift: finest - digits, shells: Vec::new() },
            })
            .collect();
        let margin = levels.last()?.cells.grid().sides().each(|[_, margin]| margin);
        for coarse in 0..levels.len() {
            for fine in coarse + 1..levels.len() {
                let shell = shell(&levels[coarse], &levels[fine], margin)?;
                levels[coarse].sizes.shells.push(shell);
            }
        }
        Some(Self { finest: levels.pop()?, coarser: levels })
    }

    /// The finest grid, in whose coordinates cells are named.
    pub fn finest(&self) -> &Grid<T> {
        self.finest.cells.grid()
    }

    /// The grid of the greatest bodies.
    pub fn coarsest(&self) -> &Grid<T> {
        self.coarser.first().unwrap_or(&self.finest).cells.grid()
    }

    fn all(&self) -> impl Iterator<Item = &Level<T>> {
        self.coarser.iter().chain([&self.finest])
    }

    fn all_mut(&mut self) -> impl Iterator<Item = &mut Level<T>> {
        self.coarser.iter_mut().chain([&mut self.finest])
    }

    /// How many levels there are.
    pub fn len(&self) -> usize {
        self.coarser.len() + 1
    }

    /// All cells, to be read and written.
    pub fn held(&mut self) -> Held<'_, T> {
        let Self { finest, coarser } = self;
        let is_one = coarser.is_empty();
        let (mut members, mut sizes) = (Vec::new(), Vec::new());
        for level in coarser {
            members.push(level.cells.members());
            sizes.push(&level.sizes);
        }
        if !is_one {
            sizes.push(&finest.sizes);
        }
        Held { finest: finest.cells.members(), coarser: members, sizes }
    }

    /// The cells of the only level.
    pub fn only(&mut self) -> &mut Cells<T> {
        &mut self.finest.cells
    }

    /// Takes all bodies out.
    pub fn clear(&mut self) {
        self.all_mut().for_each(|level| level.cells.clear());
    }

    /// Makes room where cells have more bodies than they have room for. If it did, all
    /// of a level's bodies are out.
    pub fn grow(&mut self) -> bool {
        let grow = |level: &mut Level<T>| level.cells.has_spilled() && level.cells.grow();
        self.all_mut().map(grow).fold(false, |one, other| one | other)
    }

    /// The bytes that the grids hold.
    pub fn bytes(&self) -> usize {
        let bytes = |level: &Level<T>| {
            let rows: usize = level.sizes.shells.iter().map(Vec::capacity).sum();
            level.cells.bytes() + rows * size_of::<Row>()
        };
        self.all().map(bytes).sum()
    }
}

impl<'a, T: Real> Held<'a, T> {
    /// The cells of one level only.
    pub fn one(finest: Members<'a, T>) -> Self {
        Self { finest, coarser: Vec::new(), sizes: Vec::new() }
    }

    /// How many levels there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.coarser.len() + 1
    }

    /// The level of a body.
    #[inline(always)]
    pub fn level_of(&self, radius: T) -> usize {
        (1..self.sizes.len()).take_while(|&level| radius <= self.sizes[level].greatest).count()
    }

    /// A cell in the coordinates of a level.
    #[inline(always)]
    pub fn cell_at(&self, level: usize, cell: [i32; 3]) -> [i32; 3] {
        match self.sizes.get(level) {
            Some(sizes) => cell.each(|c| c >> sizes.shift),
            None => cell,
        }
    }

    /// The cells of a level.
    #[inline(always)]
    pub fn at(&self, level: usize) -> &Members<'a, T> {
        self.coarser.get(level).unwrap_or(&self.finest)
    }

    /// Where bodies of the level `fine` can touch one of the level `coarse`.
    pub fn shell(&self, coarse: usize, fine: usize) -> &'a [Row] {
        &self.sizes[coarse].shells[fine - coarse - 1]
    }

    /// Puts a body of a level into a cell of the finest grid.
    #[inline(always)]
    pub fn insert(&mut self, level: usize, cell: [i32; 3], slot: u32) {
        let cell = self.cell_at(level, cell);
        let members = self.coarser.get_mut(level).unwrap_or(&mut self.finest);
        members.insert(members.grid.number_of(cell), slot);
    }

    /// Takes a body of a level out of a cell of the finest grid.
    #[inline(always)]
    pub fn remove(&mut self, level: usize, cell: [i32; 3], slot: u32) {
        let cell = self.cell_at(level, cell);
        let members = self.coarser.get_mut(level).unwrap_or(&mut self.finest);
        members.remove(members.grid.number_of(cell), slot);
    }

    /// How many slots a buffer for the bodies found must have.
    pub fn most(&self) -> usize {
        self.coarser.iter().map(Members::most).fold(self.finest.most(), usize::max)
    }
}

/// How many cells the coarsest grid has along each axis, at most `coarse`, and by how
/// many binary digits the finest one has more, at most `fine` in all, so that it has
/// as many as possible.
fn nested(coarse: [i32; 3], fine: [i32; 3]) -> ([i32; 3], u32) {
    let base = |shift: u32| -> [i32; 3] { array::from_fn(|k| coarse[k].min(fine[k] >> shift)) };
    let is_valid = |shift: &u32| (0..3).all(|k| base(*shift)[k] >= coarse[k].min(2));
    let count = |&shift: &u32| base(shift).each(|count| i64::from(count << shift)).iter().product();
    let shifts = (0..=MOST_SHIFT).take_while(is_valid).map(|shift| (count(&shift), shift));
    let best: (i64, u32) =
        shifts.fold((0, 0), |best, next| if next.0 > best.0 { next } else { best });
    (base(best.1), best.1)
}

/// The cells of a finer level that a body of it can be in when it touches one of a
/// coarser level whose centre is in the middle one. `None` if the grid closes upon
/// itself within them.
fn shell<T: Real>(coarse: &Level<T>, fine: &Level<T>, margin: [f64; 3]) -> Option<Vec<Row>> {
    let sides = fine.cells.grid().sides().each(|[side, _]| side);
    // Both bodies may be beyond their cells; a little more, for the rounding.
    let beyond = margin.each(|margin| 2.5 * margin);
    let outer = coarse.sizes.greatest.to_f64() + fine.sizes.greatest.to_f64();
    let inner = coarse.sizes.least.to_f64();
    let most: [i32; 3] = array::from_fn(|k| ((outer + beyond[k]) / sides[k]).floor() as i32 + 1);
    let closes = |k: usize| {
        let count = i64::from(fine.cells.grid().counts()[k]);
        fine.cells.grid().closes(k) && 2 * i64::from(most[k]) + 1 > count
    };
    if (0..3).any(closes) {
        return None;
    }
    // Least and greatest distance along an axis of points in cells so far apart.
    let nearest = |k: usize, cells: i32| {
        (f64::from((cells.abs() - 1).max(0)) * sides[k] - beyond[k]).max(0.0)
    };
    let farthest = |k: usize, cells: i32| f64::from(cells.abs() + 1) * sides[k] + beyond[k];
    let mut rows = Vec::new();
    for z in -most[2]..=most[2] {
        for y in -most[1]..=most[1] {
            let left = outer * outer - nearest(1, y).powi(2) - nearest(2, z).powi(2);
            if left < 0.0 {
                continue;
            }
            let reach = (left.sqrt() + beyond[0]) / sides[0];
            let last = (reach.floor() as i32 + 1).min(most[0]);
            // The cells that lie in the body of the coarser level are empty.
            let within = inner * inner - farthest(1, y).powi(2) - farthest(2, z).powi(2);
            let within = (within.max(0.0).sqrt() - beyond[0]) / sides[0] - 1.0;
            let first_outside = if within > 0.0 { within.ceil() as i32 } else { 0 };
            if first_outside == 0 {
                rows.push(Row { y, z, first: -last, last });
            } else if first_outside <= last {
                rows.push(Row { y, z, first: -last, last: -first_outside });
                rows.push(Row { y, z, first: first_outside, last });
            }
        }
    }
    Some(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Column;
    use crate::space::cells::Ends;
    use crate::vec3::Vec3;

    fn each(radii: &[f64]) -> PerBody<f64> {
        let mut column = Column::new(radii.len(), 1.0);
        column.copy_from_slice(radii);
        PerBody::Each(column)
    }

    /// Every pair of a great and a small body that touch is found from both sides.
    #[test]
    fn shells_hold_all_that_touch() {
        let (lower, upper) = (Vec3::ZERO, Vec3::new(50.0, 60.0, 55.0));
        let span = Span::new(lower, upper, Ends::Joined);
        let mut radii = vec![0.05_f64; 40_000];
        radii.extend([0.2, 1.5, 4.0, 5.0]);
        let radius = each(&radii);
        let mut levels = Levels::fitting(span, &radius, radii.len(), 0);
        assert!(levels.len() > 2, "{}", levels.len());
        let levels = levels.held();
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for trial in 0..20_000 {
            let great = [5.0, 4.0, 1.5, 0.2][trial % 4];
            let center = Vec3::new(random() * 50.0, random() * 60.0, random() * 55.0);
            let toward = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
            let other = center + toward * ((great + 0.05) / toward.length());
            let [a, b] = [center, other].map(|point| levels.finest.grid.cell_of(point));
            let (coarse, fine) = (levels.level_of(great), levels.level_of(0.05));
            if coarse == fine {
                continue;
            }
            let middle = levels.cell_at(fine, a);
            let is_in_shell =
                levels.shell(coarse, fine).iter().any(|row| row.cells(middle).any(|c| c == b));
            assert!(is_in_shell, "{center:?} {other:?}");
            let [a, b] = [a, b].map(|cell| levels.cell_at(coarse, cell));
            assert!((0..3).all(|k| (a[k] - b[k]).abs() <= 1));
        }
    }

    #[test]
    fn bodies_of_one_size_have_one_level() {
        let span = Span::new(Vec3::ZERO, Vec3::new(9.0, 9.0, 9.0), Ends::Closed);
        for radius in [PerBody::Same(0.4), each(&[0.4, 0.2])] {
            assert_eq!(Levels::fitting(span, &radius, 100, 0).len(), 1);
        }
    }
}
