//! Vectors of three lanes.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::lane::Lane;
use crate::real::Real;

/// A vector of space: as many vectors as the lane is wide.
///
/// ```
/// use carom::Vec3;
///
/// let (x, y) = (Vec3::new(1.0, 0.0, 0.0), Vec3::from([0.0, 1.0, 0.0]));
/// assert_eq!(x.cross(y), Vec3::new(0.0, 0.0, 1.0));
/// assert_eq!((x * 3.0 + y * 4.0).length(), 5.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<L> {
    /// First component.
    pub x: L,
    /// Second component.
    pub y: L,
    /// Third component.
    pub z: L,
}

impl<L> Vec3<L> {
    /// The vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// The components as an array.
    #[inline(always)]
    pub fn to_array(self) -> [L; 3] {
        [self.x, self.y, self.z]
    }
}

impl<L> From<[L; 3]> for Vec3<L> {
    #[inline(always)]
    fn from([x, y, z]: [L; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T: Real> Vec3<T> {
    /// The nearest vector of another precision. It goes by way of `f64`.
    ///
    /// ```
    /// use carom::Vec3;
    /// assert_eq!(Vec3::new(0.1, 0.2, 0.5).cast::<f32>(), Vec3::new(0.1_f32, 0.2, 0.5));
    /// ```
    #[inline]
    #[must_use]
    pub fn cast<U: Real>(self) -> Vec3<U> {
        let component = |value: T| U::from_f64(value.to_f64());
        Vec3::new(component(self.x), component(self.y), component(self.z))
    }
}

impl<L: Lane> Vec3<L> {
    /// The zero vector.
    pub const ZERO: Self = Self::new(L::ZERO, L::ZERO, L::ZERO);

    /// The same vector in every lane.
    ///
    /// ```
    /// use carom::Vec3;
    /// use wide::f64x4;
    ///
    /// let gravity = Vec3::<f64x4>::splat(Vec3::new(0.0, 0.0, -9.81));
    /// assert_eq!(gravity.z.to_array(), [-9.81; 4]);
    /// ```
    #[inline(always)]
    pub fn splat(value: Vec3<L::Scalar>) -> Self {
        Self::new(L::splat(value.x), L::splat(value.y), L::splat(value.z))
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// `self · self`.
    #[inline(always)]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> L {
        self.length_squared().sqrt()
    }

    /// Lane by lane, `yes` where the mask is true and `no` elsewhere.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            L::select(mask, yes.x, no.x),
            L::select(mask, yes.y, no.y),
            L::select(mask, yes.z, no.z),
        )
    }

    /// The lanes of the three components. Written out, since the array's own
    /// `map` is not always inlined.
    #[inline(always)]
    pub fn from_arrays([x, y, z]: [L::Array; 3]) -> Self {
        Self::new(L::from_array(x), L::from_array(y), L::from_array(z))
    }

    /// The lanes of the three components.
    #[inline(always)]
    pub fn to_arrays(self) -> [L::Array; 3] {
        [self.x.to_array(), self.y.to_array(), self.z.to_array()]
    }

    /// Lane `k` is element `indices[k]` of the three columns.
    ///
    /// ```
    /// use carom::Vec3;
    /// use wide::f64x4;
    ///
    /// let (x, y, z) = ([1.0, 2.0], [3.0, 4.0], [5.0, 6.0]);
    /// let bodies = Vec3::<f64x4>::gather([&x, &y, &z], &[1, 0, 0, 1]);
    /// assert_eq!(bodies.y.to_array(), [4.0, 3.0, 3.0, 4.0]);
    /// ```
    ///
    /// # Panics
    /// As [`Lane::gather`].
    #[inline(always)]
    pub fn gather(columns: [&[L::Scalar]; 3], indices: &[u32]) -> Self {
        let [x, y, z] = columns;
        Self::new(L::gather(x, indices), L::gather(y, indices), L::gather(z, indices))
    }
}

impl<L: Lane> Add for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lane> Sub for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lane> Neg for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<L: Lane> Mul<L> for Vec3<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<L: Lane> AddAssign for Vec3<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<L: Lane> SubAssign for Vec3<L> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
