//! Three by three matrices of lanes.

use core::ops::{Mul, Sub};

use crate::lane::Lane;
use crate::numbers::array;
use crate::real::Real;
use crate::vec3::Vec3;

/// A matrix by its columns. An orientation takes body axes to world axes: its
/// columns are the body's axes in the world frame.
///
/// ```
/// use carom::mat3::Mat3;
/// use carom::vec3::Vec3;
///
/// // A quarter turn about z.
/// let turn = Mat3::from_rows([0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
/// assert_eq!((turn * Vec3::new(1.0, 0.0, 0.0)).to_array(), [0.0, 1.0, 0.0]);
/// assert_eq!(turn * turn.transpose(), Mat3::IDENTITY);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<L> {
    /// The three columns.
    pub columns: [Vec3<L>; 3],
}

impl<L: Lane> Mat3<L> {
    /// The matrix with these columns.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// use carom::vec3::Vec3;
    ///
    /// let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
    /// assert_eq!(Mat3::from_columns(x, y, z), Mat3::IDENTITY);
    /// ```
    #[inline(always)]
    pub const fn from_columns(x: Vec3<L>, y: Vec3<L>, z: Vec3<L>) -> Self {
        Self { columns: [x, y, z] }
    }

    /// The identity.
    pub const IDENTITY: Self = Self::from_columns(
        Vec3::new(L::ONE, L::ZERO, L::ZERO),
        Vec3::new(L::ZERO, L::ONE, L::ZERO),
        Vec3::new(L::ZERO, L::ZERO, L::ONE),
    );

    /// The same matrix in every lane.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// let four = Mat3::<wide::f64x4>::splat(Mat3::IDENTITY);
    /// assert_eq!(four.columns[2].z.to_array(), [1.0; 4]);
    /// ```
    #[inline(always)]
    pub fn splat(value: Mat3<L::Scalar>) -> Self {
        let [a, b, c] = value.columns;
        Self::from_columns(Vec3::splat(a), Vec3::splat(b), Vec3::splat(c))
    }

    /// The transposed matrix.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// let m = Mat3::from_rows([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    /// assert_eq!(m.transpose().rows(), [1.0, 4.0, 7.0, 2.0, 5.0, 8.0, 3.0, 6.0, 9.0]);
    /// ```
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [a, b, c] = self.columns;
        Self::from_columns(
            Vec3::new(a.x, b.x, c.x),
            Vec3::new(a.y, b.y, c.y),
            Vec3::new(a.z, b.z, c.z),
        )
    }

    /// The nine elements, row by row.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// assert_eq!(Mat3::<f64>::IDENTITY.rows(), [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    /// ```
    #[inline(always)]
    pub fn rows(self) -> [L; 9] {
        let [a, b, c] = self.columns;
        [a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z]
    }

    /// The matrix with these elements, row by row.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// let m = Mat3::from_rows([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    /// assert_eq!(m.columns[0].to_array(), [1.0, 4.0, 7.0]);
    /// ```
    #[inline(always)]
    pub fn from_rows(m: [L; 9]) -> Self {
        Self::from_columns(
            Vec3::new(m[0], m[3], m[6]),
            Vec3::new(m[1], m[4], m[7]),
            Vec3::new(m[2], m[5], m[8]),
        )
    }

    /// Lane by lane, `yes` where the mask is true and `no` elsewhere.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// let (m, zero) = (Mat3::<f64>::IDENTITY, Mat3::from_rows([0.0; 9]));
    /// assert_eq!(Mat3::select(true, m, zero), m);
    /// ```
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self { columns: array::from_fn(|k| Vec3::select(mask, yes.columns[k], no.columns[k])) }
    }
}

impl<T: Real> Mat3<T> {
    /// The matrix in another precision: every element becomes the nearest.
    ///
    /// ```
    /// use carom::mat3::Mat3;
    /// assert_eq!(Mat3::<f64>::IDENTITY.cast::<f32>(), Mat3::IDENTITY);
    /// ```
    #[must_use]
    pub fn cast<B: Real>(self) -> Mat3<B> {
        let [a, b, c] = self.columns;
        Mat3::from_columns(a.cast(), b.cast(), c.cast())
    }
}

impl<L: Lane> Mul<Vec3<L>> for Mat3<L> {
    type Output = Vec3<L>;

    #[inline(always)]
    fn mul(self, v: Vec3<L>) -> Vec3<L> {
        let [a, b, c] = self.columns;
        a * v.x + b * v.y + c * v.z
    }
}

impl<L: Lane> Mul for Mat3<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let [a, b, c] = other.columns;
        Self::from_columns(self * a, self * b, self * c)
    }
}

impl<L: Lane> Sub for Mat3<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { columns: array::from_fn(|k| self.columns[k] - other.columns[k]) }
    }
}
