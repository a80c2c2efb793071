//! Order: bodies sorted by the cell that they are in.

/// Bodies by cell: a counting sort, stable, linear in bodies and cells.
#[derive(Debug, Default)]
pub(super) struct CellOrder {
    /// The first place of each cell, and one more.
    pub starts: Vec<u32>,
    /// Which body comes to each place.
    pub bodies: Vec<u32>,
}

impl CellOrder {
    /// Sorts bodies by the ranks of their cells, `cells` in number.
    pub fn sort(&mut self, ranks: &[u32], cells: usize) {
        // Shifted by one, so that the counts turn into the first places and
        // then, as bodies are placed, into the last ones.
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
            let place = &mut self.starts[rank as usize + 1];
            self.bodies[*place as usize] = body as u32;
            *place += 1;
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
