//! The lane types: one real, and the packs of `wide`.

use wide::{f32x8, f32x16, f64x4, f64x8};

use super::{Lane, Mask};
use crate::numbers::array;

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
    ($($pack:ident: [$real:ident; $width:literal] $(, $transpose:path)?;)*) => {$(
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
                wide::$pack::new(array::from_fn(value))
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

            $(
                #[inline(always)]
                fn transpose(records: &[&[$real; 8]]) -> [Self; 8] {
                    $transpose(records)
                }
            )?
        }
    )*};
}

pack!(
    f32x4: [f32; 4];
    f32x8: [f32; 8], eight_of_f32;
    f32x16: [f32; 16], sixteen_of_f32;
    f64x4: [f64; 4], four_of_f64;
    f64x8: [f64; 8], eight_of_f64;
);

/// Real by real this is 64 loads; by rows it is 8, and shuffles.
#[inline(always)]
fn eight_of_f32(records: &[&[f32; 8]]) -> [f32x8; 8] {
    let records = &records[..8];
    f32x8::transpose(array::from_fn(|k| f32x8::new(*records[k])))
}

#[inline(always)]
fn sixteen_of_f32(records: &[&[f32; 8]]) -> [f32x16; 8] {
    let (first, last) = (eight_of_f32(&records[..8]), eight_of_f32(&records[8..16]));
    array::from_fn(|j| wide::bytemuck::cast([first[j], last[j]]))
}

#[inline(always)]
fn four_of_f64(records: &[&[f64; 8]]) -> [f64x4; 8] {
    let records = &records[..4];
    let rows: [[f64x4; 2]; 4] = array::from_fn(|k| wide::bytemuck::cast(*records[k]));
    let halves: [[f64x4; 4]; 2] =
        array::from_fn(|half| f64x4::transpose(array::from_fn(|k| rows[k][half])));
    array::from_fn(|j| halves[j / 4][j % 4])
}

#[inline(always)]
fn eight_of_f64(records: &[&[f64; 8]]) -> [f64x8; 8] {
    let (first, last) = (four_of_f64(&records[..4]), four_of_f64(&records[4..8]));
    array::from_fn(|j| wide::bytemuck::cast([first[j], last[j]]))
}
