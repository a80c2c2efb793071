//! Vectors of three lanes.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::lane::Lane;
use crate::real::Real;

/// A vector of space: as many vectors as the lane is wide.
///
/// ```
/// use carom::vec3::Vec3;
///
/// let mut point = Vec3::new(1.0, 0.0, 0.0) + Vec3::from([0.0, 2.0, 2.0]) * 0.5;
/// assert_eq!(point.to_array(), [1.0, 1.0, 1.0]);
/// point -= -Vec3::new(0.0, 0.0, 1.0);
/// assert_eq!(point.z, 2.0);
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
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// assert_eq!(Vec3::new(1.0, 2.0, 3.0).y, 2.0);
    /// ```
    #[inline(always)]
    pub const fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    /// The components as an array.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// assert_eq!(Vec3::new(1.0, 2.0, 3.0).to_array(), [1.0, 2.0, 3.0]);
    /// ```
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

impl<L: Lane> Vec3<L> {
    /// The zero vector.
    pub const ZERO: Self = Self::new(L::ZERO, L::ZERO, L::ZERO);

    /// The same vector in every lane.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let four = Vec3::<wide::f64x4>::splat(Vec3::new(1.0, 2.0, 3.0));
    /// assert_eq!(four.z.to_array(), [3.0; 4]);
    /// ```
    #[inline(always)]
    pub fn splat(value: Vec3<L::Scalar>) -> Self {
        Self::new(L::splat(value.x), L::splat(value.y), L::splat(value.z))
    }

    /// Scalar product.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// assert_eq!(Vec3::new(1.0, 2.0, 3.0).dot(Vec3::new(4.0, 5.0, 6.0)), 32.0);
    /// ```
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let z = Vec3::new(1.0, 0.0, 0.0).cross(Vec3::new(0.0, 1.0, 0.0));
    /// assert_eq!(z.to_array(), [0.0, 0.0, 1.0]);
    /// ```
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// `self · self`.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// assert_eq!(Vec3::new(2.0, 3.0, 6.0).length_squared(), 49.0);
    /// ```
    #[inline(always)]
    pub fn length_squared(self) -> L {
        self.dot(self)
    }

    /// Euclidean length.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// assert_eq!(Vec3::new(2.0, 3.0, 6.0).length(), 7.0);
    /// ```
    #[inline(always)]
    pub fn length(self) -> L {
        self.length_squared().sqrt()
    }

    /// The lesser of two, component by component.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let corner = Vec3::new(1.0, 5.0, 3.0).lesser(Vec3::new(4.0, 2.0, 3.0));
    /// assert_eq!(corner.to_array(), [1.0, 2.0, 3.0]);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn lesser(self, other: Self) -> Self {
        Self::new(self.x.lesser(other.x), self.y.lesser(other.y), self.z.lesser(other.z))
    }

    /// The greater of two, component by component.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let corner = Vec3::new(1.0, 5.0, 3.0).greater(Vec3::new(4.0, 2.0, 3.0));
    /// assert_eq!(corner.to_array(), [4.0, 5.0, 3.0]);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn greater(self, other: Self) -> Self {
        Self::new(self.x.greater(other.x), self.y.greater(other.y), self.z.greater(other.z))
    }

    /// Lane by lane, `yes` where the mask is true and `no` elsewhere.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let (near, far) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(9.0, 0.0, 0.0));
    /// assert_eq!(Vec3::select(1.0 < 2.0, near, far), near);
    /// ```
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
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let v = Vec3::<wide::f64x4>::from_arrays([[1.0; 4], [2.0; 4], [0.0, 1.0, 2.0, 3.0]]);
    /// assert_eq!(v.length_squared().to_array(), [5.0, 6.0, 9.0, 14.0]);
    /// ```
    #[inline(always)]
    pub fn from_arrays([x, y, z]: [L::Array; 3]) -> Self {
        Self::new(L::from_array(x), L::from_array(y), L::from_array(z))
    }

    /// The lanes of the three components.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let v = Vec3::<wide::f64x4>::splat(Vec3::new(1.0, 2.0, 3.0));
    /// assert_eq!(v.to_arrays(), [[1.0; 4], [2.0; 4], [3.0; 4]]);
    /// ```
    #[inline(always)]
    pub fn to_arrays(self) -> [L::Array; 3] {
        [self.x.to_array(), self.y.to_array(), self.z.to_array()]
    }

    /// Lane `k` is element `indices[k]` of the three columns.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let (x, y, z) = ([1.0, 2.0], [3.0, 4.0], [5.0, 6.0]);
    /// let second = Vec3::<f64>::gather([&x, &y, &z], &[1]);
    /// assert_eq!(second.to_array(), [2.0, 4.0, 6.0]);
    /// ```
    ///
    /// # Panics
    /// As [`Lane::gather`].
    #[inline(always)]
    pub fn gather(columns: [&[L::Scalar]; 3], indices: &[u32]) -> Self {
        let [x, y, z] = columns;
        // An index that is within one of them is seen to be within all.
        let (y, z) = (&y[..x.len()], &z[..x.len()]);
        Self::new(L::gather(x, indices), L::gather(y, indices), L::gather(z, indices))
    }
}

impl<T: Real> Vec3<T> {
    /// The vector in another precision: every component becomes the nearest
    /// number.
    ///
    /// ```
    /// use carom::vec3::Vec3;
    /// let third = Vec3::new(1.0_f64 / 3.0, 0.0, 1.0).cast::<f32>();
    /// assert_eq!(third.to_array(), [1.0_f32 / 3.0, 0.0, 1.0]);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn cast<B: Real>(self) -> Vec3<B> {
        Vec3::new(self.x.cast(), self.y.cast(), self.z.cast())
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
