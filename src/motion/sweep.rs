//! How a sweep goes over columns: whole lanes, then the tail one by one.

use crate::lane::Lane;
use crate::numbers::array::{self, Each};

/// `N` columns, `L::WIDTH` reals at a time.
pub(super) type Arrays<'a, L, const N: usize> = [&'a mut [<L as Lane>::Array]; N];

/// The first `len` reals of each column: those that fill whole lanes of type
/// `L`, and those of the tail as lanes of one.
///
/// `len` is no more than the shortest column has. The columns that come back
/// are equally long.
#[inline(always)]
pub(super) fn lanes_and_tail<'a, L: Lane, const N: usize>(
    columns: [&'a mut [L::Scalar]; N],
    len: usize,
) -> (Arrays<'a, L, N>, Arrays<'a, L::Scalar, N>)
where
    Arrays<'a, L, N>: Each<&'a mut [L::Array], N>,
    Arrays<'a, L::Scalar, N>: Each<&'a mut [[L::Scalar; 1]], N>,
{
    let mut lanes: Arrays<L, N> = array::from_fn(|_| Default::default());
    let mut tails: Arrays<L::Scalar, N> = array::from_fn(|_| Default::default());
    for ((column, lanes), tail) in columns.into_iter().zip(&mut lanes).zip(&mut tails) {
        let rest;
        (*lanes, rest) = L::arrays_mut(&mut column[..len]);
        *tail = L::Scalar::arrays_mut(rest).0;
    }
    (lanes, tails)
}
