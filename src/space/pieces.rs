//! Pieces: what one worker holds of a column.

use core::ops::{Index, IndexMut, Range, RangeInclusive};

/// One or two runs of a column, under the numbers that they have in the whole of it. A
/// worker writes what it holds and reads nothing else.
#[derive(Debug)]
pub(crate) struct Pieces<'a, V> {
    runs: [&'a mut [V]; 2],
    starts: [usize; 2],
}

impl<'a, V> Pieces<'a, V> {
    /// All of a column.
    pub fn whole(column: &'a mut [V]) -> Self {
        Self { runs: [column, &mut []], starts: [0; 2] }
    }

    /// Two runs of a column and the numbers at which they start.
    pub fn of(runs: [&'a mut [V]; 2], starts: [usize; 2]) -> Self {
        Self { runs, starts }
    }

    /// Whether a number is among those held.
    #[inline(always)]
    pub fn holds(&self, at: usize) -> bool {
        at.wrapping_sub(self.starts[0]) < self.runs[0].len()
            || at.wrapping_sub(self.starts[1]) < self.runs[1].len()
    }

    /// What is held under a number, if it is.
    #[inline(always)]
    pub fn get(&self, at: usize) -> Option<&V> {
        let [one, other] = &self.runs;
        let first = one.get(at.wrapping_sub(self.starts[0]));
        first.or_else(|| other.get(at.wrapping_sub(self.starts[1])))
    }

    /// What is held under a number, to be written, if it is.
    #[inline(always)]
    pub fn get_mut(&mut self, at: usize) -> Option<&mut V> {
        let [one, other] = &mut self.runs;
        let first = at.wrapping_sub(self.starts[0]);
        if first < one.len() {
            Some(&mut one[first])
        } else {
            other.get_mut(at.wrapping_sub(self.starts[1]))
        }
    }

    /// What is held under a range of numbers, if one run has all of it.
    #[inline(always)]
    pub fn run(&self, numbers: RangeInclusive<usize>) -> Option<&[V]> {
        let [one, other] = &self.runs;
        let within =
            |start: usize| numbers.start().wrapping_sub(start)..=numbers.end().wrapping_sub(start);
        let first = one.get(within(self.starts[0]));
        first.or_else(|| other.get(within(self.starts[1])))
    }

    /// The run and the number at which it starts, if there is one only.
    #[inline(always)]
    pub fn only_run(&self) -> Option<(&[V], usize)> {
        self.runs[1].is_empty().then_some((&*self.runs[0], self.starts[0]))
    }

    /// How many are held.
    pub fn len(&self) -> usize {
        self.runs[0].len() + self.runs[1].len()
    }
}

impl<V> Index<usize> for Pieces<'_, V> {
    type Output = V;

    #[inline(always)]
    fn index(&self, at: usize) -> &V {
        let first = at.wrapping_sub(self.starts[0]);
        if first < self.runs[0].len() {
            &self.runs[0][first]
        } else {
            &self.runs[1][at.wrapping_sub(self.starts[1])]
        }
    }
}

impl<V> IndexMut<usize> for Pieces<'_, V> {
    #[inline(always)]
    fn index_mut(&mut self, at: usize) -> &mut V {
        let first = at.wrapping_sub(self.starts[0]);
        if first < self.runs[0].len() {
            &mut self.runs[0][first]
        } else {
            &mut self.runs[1][at.wrapping_sub(self.starts[1])]
        }
    }
}

/// A run of neighbours, all of them in one piece.
impl<V> Index<Range<usize>> for Pieces<'_, V> {
    type Output = [V];

    #[inline(always)]
    fn index(&self, at: Range<usize>) -> &[V] {
        let first = at.start.wrapping_sub(self.starts[0]);
        let k = usize::from(first >= self.runs[0].len());
        let start = at.start.wrapping_sub(self.starts[k]);
        &self.runs[k][start..start + (at.end - at.start)]
    }
}

impl<V> IndexMut<Range<usize>> for Pieces<'_, V> {
    #[inline(always)]
    fn index_mut(&mut self, at: Range<usize>) -> &mut [V] {
        let first = at.start.wrapping_sub(self.starts[0]);
        let k = usize::from(first >= self.runs[0].len());
        let start = at.start.wrapping_sub(self.starts[k]);
        &mut self.runs[k][start..start + (at.end - at.start)]
    }
}

/// Cuts a column at rising numbers, the last of them its length.
pub(crate) fn cut<V>(mut column: &mut [V], ends: impl Iterator<Item = usize>) -> Vec<&mut [V]> {
    let mut start = 0;
    ends.map(|end| {
        let (run, rest) = core::mem::take(&mut column).split_at_mut(end - start);
        (start, column) = (end, rest);
        run
    })
    .collect()
}
