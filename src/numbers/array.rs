//! Short arrays, written out: what `map`, `from_fn`, `each_ref` and `each_mut` do.
//!
//! The standard library's are built of a guard, a drain and four closures for each call,
//! which are left as calls wherever the compiler does not see all of a crate at once: that
//! made the engines 1.3 to 1.5 times slower without link-time optimisation, and was a tenth
//! of what there was to compile. `disallowed-methods` of Clippy finds them (`array::map`,
//! `core::array::from_fn`); tests and the program, which cannot see this module, use them.

/// An array of `N`, element by element.
pub trait Each<A, const N: usize> {
    /// `f` of each element, in their order.
    fn each<B>(self, f: impl FnMut(A) -> B) -> [B; N];

    /// `value` of each index, in their order.
    fn of(value: impl FnMut(usize) -> A) -> Self;

    /// Each element borrowed.
    fn refs(&self) -> [&A; N];

    /// Each element borrowed, to be changed.
    fn muts(&mut self) -> [&mut A; N];
}

/// `value` of each index, in their order.
#[inline(always)]
pub fn from_fn<A, const N: usize>(value: impl FnMut(usize) -> A) -> [A; N]
where
    [A; N]: Each<A, N>,
{
    Each::of(value)
}

macro_rules! each {
    ($($count:literal: $($element:ident $index:literal),+;)*) => {$(
        impl<A> Each<A, $count> for [A; $count] {
            #[inline(always)]
            fn each<B>(self, mut f: impl FnMut(A) -> B) -> [B; $count] {
                let [$($element),+] = self;
                [$(f($element)),+]
            }

            #[inline(always)]
            fn of(mut value: impl FnMut(usize) -> A) -> Self {
                [$(value($index)),+]
            }

            #[inline(always)]
            fn refs(&self) -> [&A; $count] {
                let [$($element),+] = self;
                [$($element),+]
            }

            #[inline(always)]
            fn muts(&mut self) -> [&mut A; $count] {
                let [$($element),+] = self;
                [$($element),+]
            }
        }
    )*};
}

each! {
    1: a 0;
    2: a 0, b 1;
    3: a 0, b 1, c 2;
    4: a 0, b 1, c 2, d 3;
    5: a 0, b 1, c 2, d 3, e 4;
    6: a 0, b 1, c 2, d 3, e 4, f_ 5;
    7: a 0, b 1, c 2, d 3, e 4, f_ 5, g 6;
    8: a 0, b 1, c 2, d 3, e 4, f_ 5, g 6, h 7;
    9: a 0, b 1, c 2, d 3, e 4, f_ 5, g 6, h 7, i 8;
    16: a 0, b 1, c 2, d 3, e 4, f_ 5, g 6, h 7, i 8, j 9, k 10, l 11, m 12, n 13, o 14, p 15;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn as_by_the_standard_library<const N: usize>()
    where
        [usize; N]: Each<usize, N>,
        for<'a> [&'a usize; N]: Each<&'a usize, N>,
    {
        let mut count = 0;
        let expected: [usize; N] = core::array::from_fn(|k| 7 * k + 1);
        let mut found: [usize; N] = from_fn(|k| {
            count += 1;
            assert_eq!(count, k + 1);
            7 * k + 1
        });
        assert_eq!(found, expected);
        assert_eq!(found.refs().each(|value| *value), expected);
        found.muts().into_iter().for_each(|value| *value += 1);
        assert_eq!(found.each(|value| value - 1), expected);
    }

    #[test]
    fn every_length_is_as_by_the_standard_library() {
        as_by_the_standard_library::<1>();
        as_by_the_standard_library::<2>();
        as_by_the_standard_library::<3>();
        as_by_the_standard_library::<4>();
        as_by_the_standard_library::<5>();
        as_by_the_standard_library::<6>();
        as_by_the_standard_library::<7>();
        as_by_the_standard_library::<8>();
        as_by_the_standard_library::<9>();
        as_by_the_standard_library::<16>();
    }
}
