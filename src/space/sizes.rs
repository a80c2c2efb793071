//! Sizes: classes of radii that differ by a factor of two at most.

use crate::real::Real;

/// The last class takes all smaller radii too.
const MOST_CLASSES: usize = 24;

/// The greatest radius of each occupied factor of two, the greatest first.
pub(super) fn classes<T: Real>(radii: &[T]) -> Vec<T> {
    let mut sorted = radii.to_vec();
    sorted.sort_unstable_by(|a, b| b.partial_cmp(a).unwrap_or(core::cmp::Ordering::Equal));
    let mut classes: Vec<T> = Vec::new();
    for radius in sorted {
        let is_smaller = classes.last().is_none_or(|&last| radius + radius < last);
        if is_smaller && classes.len() < MOST_CLASSES {
            classes.push(radius);
        }
    }
    classes
}

/// The class of a radius.
#[inline(always)]
pub(super) fn class<T: Real>(classes: &[T], radius: T) -> usize {
    let mut class = 0;
    while class + 1 < classes.len() && radius <= classes[class + 1] {
        class += 1;
    }
    class
}
