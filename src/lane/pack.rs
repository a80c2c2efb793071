//! The lane types: one real, and the packs of `wide`.

use super::{Lane, Mask};

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn all(self) -> bool {
        self
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

/// What a lane type does with the array it is made of.
macro_rules! arrays {
    ($real:ty, $width:literal) => {
        type Scalar = $real;
        type Array = [$real; $width];

        const WIDTH: usize = $width;

        #[inline(always)]
        fn arrays(column: &[$real]) -> (&[[$real; $width]], &[$real]) {
            column.as_chunks()
        }

        #[inline(always)]
        fn arrays_mut(column: &mut [$real]) -> (&mut [[$real; $width]], &mut [$real]) {
            column.as_chunks_mut()
        }
    };
}
pub(super) use arrays;

macro_rules! one_real {
    ($($real:ident),*) => {$(
        impl Lane for $real {
            type Mask = bool;

            arrays!($real, 1);

            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;

            #[inline(always)]
            fn splat(value: $real) -> Self {
                value
            }

            #[inline(always)]
            fn from_array(values: [$real; 1]) -> Self {
                values[0]
            }

            #[inline(always)]
            fn to_array(self) -> [$real; 1] {
                [self]
            }

            #[inline(always)]
            fn from_fn(mut value: impl FnMut(usize) -> $real) -> Self {
                value(0)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                $real::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $real::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }

            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }

            #[inline(always)]
            fn same(self, other: Self) -> bool {
                self == other
            }

            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
        }
    )*};
}

one_real!(f32, f64);

macro_rules! pack {
    ($($pack:ident: [$real:ident; $width:literal]),*) => {$(
        impl Mask for wide::$pack {
            #[inline(always)]
            fn any(self) -> bool {
                wide::$pack::any(self)
            }

            #[inline(always)]
            fn all(self) -> bool {
                wide::$pack::all(self)
            }

            #[inline(always)]
            fn bits(self) -> u32 {
                self.to_bitmask()
            }
        }

        impl Lane for wide::$pack {
            type Mask = wide::$pack;

            arrays!($real, $width);

            const ZERO: Self = wide::$pack::ZERO;
            const ONE: Self = wide::$pack::ONE;

            #[inline(always)]
            fn splat(value: $real) -> Self {
                wide::$pack::splat(value)
            }

            #[inline(always)]
            fn from_array(values: [$real; $width]) -> Self {
                wide::$pack::new(values)
            }

            #[inline(always)]
            fn to_array(self) -> [$real; $width] {
                wide::$pack::to_array(self)
            }

            #[inline(always)]
            fn from_fn(value: impl FnMut(usize) -> $real) -> Self {
                wide::$pack::new(core::array::from_fn(value))
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                wide::$pack::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                wide::$pack::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> Self {
                self.simd_lt(other)
            }

            #[inline(always)]
            fn le(self, other: Self) -> Self {
                self.simd_le(other)
            }

            #[inline(always)]
            fn same(self, other: Self) -> Self {
                self.simd_eq(other)
            }

            #[inline(always)]
            fn select(mask: Self, yes: Self, no: Self) -> Self {
                mask.select(yes, no)
            }
        }
    )*};
}

pack!(
    f32x4: [f32; 4],
    f32x8: [f32; 8],
    f32x16: [f32; 16],
    f64x2: [f64; 2],
    f64x4: [f64; 4],
    f64x8: [f64; 8]
);
