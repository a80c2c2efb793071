//! Rows: numbers in order of the rows that they belong to.

use crate::workers::Workers;

/// Rows that are filled as one piece of work, at least, and the most pieces.
const LEAST_ROWS: usize = 1 << 12;
const MOST_PIECES: usize = 64;

/// What each row has, one after the other: a counting sort, stable, linear in rows and
/// numbers. Numbers are dealt out by pieces of the rows first, which are filled side by side.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    /// Where each row begins, and one more.
    pub starts: Vec<u32>,
    pub all: Vec<u32>,
}

/// What one source has dealt out.
pub(crate) struct Hands {
    /// Rows and numbers, for each piece of the rows.
    pieces: Vec<Vec<[u32; 2]>>,
    shift: u32,
}

impl Hands {
    /// Gives a number to a row.
    #[inline(always)]
    pub fn deal(&mut self, row: u32, number: u32) {
        self.pieces[(row >> self.shift) as usize].push([row, number]);
    }
}

impl Rows {
    /// Fills this many rows with what sources deal out, each row in the order of these.
    pub fn fill<S: Sync>(
        &mut self,
        rows: usize,
        sources: &[S],
        deal: impl Fn(&S, &mut Hands) + Send + Sync,
        workers: &Workers,
    ) {
        let piece = LEAST_ROWS.max(rows.div_ceil(MOST_PIECES)).next_power_of_two();
        let pieces = rows.div_ceil(piece);
        let hands = |source| {
            let pieces = (0..pieces).map(|_| Vec::new()).collect();
            (source, Hands { pieces, shift: piece.trailing_zeros() })
        };
        let mut hands: Vec<_> = sources.iter().map(hands).collect();
        workers.each(&mut hands, |(source, hands)| deal(source, hands));

        let dealt = |number: usize| hands.iter().map(move |(_, hands)| &hands.pieces[number]);
        let counts = (0..pieces).map(|number| dealt(number).map(Vec::len).sum());
        let counts: Vec<usize> = counts.collect();
        let total = counts.iter().sum();
        self.all.resize(total, 0);
        self.starts.resize(rows + 1, 0);
        self.starts[rows] = total as u32;
        let (mut all, mut first) = (&mut self.all[..], 0);
        let starts = self.starts[..rows].chunks_mut(piece);
        let mut filled: Vec<_> = starts
            .zip(counts)
            .enumerate()
            .map(|(number, (starts, count))| {
                let here;
                (here, all) = core::mem::take(&mut all).split_at_mut(count);
                first += count as u32;
                (number, first - count as u32, starts, here)
            })
            .collect();
        workers.each(&mut filled, |(number, first, starts, here)| {
            let place = |row: u32| row as usize & (piece - 1);
            starts.fill(0);
            for hand in dealt(*number) {
                hand.iter().for_each(|&[row, _]| starts[place(row)] += 1);
            }
            let mut sum = 0;
            for start in starts.iter_mut() {
                (*start, sum) = (sum, sum + *start);
            }
            for hand in dealt(*number) {
                for &[row, number] in hand {
                    let start = &mut starts[place(row)];
                    here[*start as usize] = number;
                    *start += 1;
                }
            }
            // They are where rows end now: where the next ones begin.
            let mut begin = *first;
            for start in starts.iter_mut() {
                (*start, begin) = (begin, *first + *start);
            }
        });
    }

    /// What a row has.
    #[inline]
    pub fn of(&self, row: u32) -> &[u32] {
        let row = row as usize;
        &self.all[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    /// The bytes that they hold.
    pub fn bytes(&self) -> usize {
        size_of::<u32>() * (self.starts.capacity() + self.all.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(rows: usize, entries: &[[u32; 2]], threads: usize) -> Rows {
        let mut filled = Rows::default();
        let sources: Vec<_> = entries.chunks(1000).collect();
        let deal = |source: &&[[u32; 2]], hands: &mut Hands| {
            source.iter().for_each(|&[row, number]| hands.deal(row, number));
        };
        filled.fill(rows, &sources, deal, &Workers::new(threads).unwrap());
        filled
    }

    #[test]
    fn rows_hold_what_each_is_given() {
        let rows = filled(4, &[[2, 7], [0, 5], [2, 1], [3, 9]], 1);
        let all: Vec<_> = (0..4).map(|row| rows.of(row).to_vec()).collect();
        assert_eq!(all, [vec![5], vec![], vec![7, 1], vec![9]]);
        assert_eq!(rows.starts, [0, 1, 1, 3, 4]);
    }

    #[test]
    fn pieces_and_threads_change_nothing() {
        for (len, rows) in [(0, 0), (0, 1), (1, 1), (30_000, 20_001), (50_000, 3), (9_000, 70_000)]
        {
            let entries: Vec<_> = (0..len).map(|k| [k * 7919 % rows, k]).collect();
            let mut expected = entries.clone();
            expected.sort_by_key(|&[row, _]| row);
            for threads in [1, 2, 3] {
                let filled = filled(rows as usize, &entries, threads);
                assert!(filled.all.iter().eq(expected.iter().map(|[_, number]| number)));
                let begin = |row| expected.partition_point(|&[other, _]| other < row) as u32;
                assert!((0..=rows).all(|row| filled.starts[row as usize] == begin(row)));
            }
        }
    }
}
