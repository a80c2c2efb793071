//! Tight: columns that grow and leave little room unused.

/// Puts an element at the end of a column. One that is full grows by an eighth: twice as
/// much, as vectors do, would leave up to half of it unused.
#[inline(always)]
pub(super) fn push<V>(column: &mut Vec<V>, element: V) {
    if column.len() == column.capacity() {
        grow(column);
    }
    column.push(element);
}

#[cold]
fn grow<V>(column: &mut Vec<V>) {
    column.reserve_exact(column.len() / 8 + 16);
}
