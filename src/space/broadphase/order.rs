//! Order: bodies sorted by the cell that they are in.

/// Bodies by cell: a counting sort, stable, linear in bodies and cells.
#[derive(Debug, Default)]
pub(super) struct CellOrder {
    /// The first slot of each cell, and one more.
    pub starts: Vec<u32>,
    /// Which body comes to each slot.
    pub bodies: Vec<u32>,
}

impl CellOrder {
    /// Sorts bodies by the ranks of their cells, `cells` in number.
    pub fn sort(&mut self, ranks: &[u32], cells: usize) {
        // Shifted by one, so that the counts turn into the first slots and
        // then, as bodies get theirs, into the last ones.
        self.starts.clear();
        self.starts.resize(cells + 2, 0);
        for &rank in ranks {
            self.starts[rank as usize + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts[2..] {
            sum += *start;
            *start = sum;
        }
        self.bodies.resize(ranks.len(), 0);
        for (body, &rank) in ranks.iter().enumerate() {
            let slot = &mut self.starts[rank as usize + 1];
            self.bodies[*slot as usize] = body as u32;
            *slot += 1;
        }
        self.starts.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorts_stably() {
        let mut order = CellOrder::default();
        order.sort(&[2, 0, 2, 1, 0], 4);
        assert_eq!(order.bodies, [1, 4, 3, 0, 2]);
        assert_eq!(order.starts, [0, 2, 3, 5, 5]);
    }
}
