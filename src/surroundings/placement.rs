//! Placement: how a shape is scaled, turned and moved.

use super::Shape;
use crate::mat3::Mat3;
use crate::motion::rotation::reference_rotation;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// What takes a point `p` of a shape to `R(s p − c) + c + t`: scaled by `s` about the
/// origin, then turned by `R` about the centre `c`, then moved by `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement<T> {
    scale: T,
    /// The rotation and its centre, length.
    turn: Option<(Mat3<T>, Vec3<T>)>,
    /// Length.
    shift: Vec3<T>,
}

impl<T: Real> Placement<T> {
    /// One that leaves all where it is.
    pub(crate) const NONE: Self = Self { scale: T::ONE, turn: None, shift: Vec3::ZERO };

    /// The same, and larger by a factor.
    pub(crate) fn scaled(self, scale: T) -> Self {
        Self { scale, ..self }
    }

    /// The same, and turned by an angle, rad, about an axis of any length but 0 through a
    /// centre, length.
    pub(crate) fn turned(self, axis: Vec3<T>, angle: T, center: Vec3<T>) -> Self {
        let axis = axis * (T::ONE / axis.length());
        Self { turn: Some((reference_rotation(axis * angle, T::ONE), center)), ..self }
    }

    /// The same, and moved, length.
    pub(crate) fn moved(self, shift: Vec3<T>) -> Self {
        Self { shift, ..self }
    }

    /// Where a point is then, length.
    pub(super) fn point(&self, point: Vec3<T>) -> Vec3<T> {
        let scaled = point * self.scale;
        let turned = self.turn.map(|(turn, center)| turn * (scaled - center) + center);
        turned.unwrap_or(scaled) + self.shift
    }

    /// The way from one point to another then, length.
    pub(super) fn way(&self, way: Vec3<T>) -> Vec3<T> {
        let scaled = way * self.scale;
        self.turn.map_or(scaled, |(turn, _)| turn * scaled)
    }

    /// A unit vector as it is turned then.
    pub(super) fn unit(&self, vector: Vec3<T>) -> Vec3<T> {
        self.turn.map_or(vector, |(turn, _)| {
            let turned = turn * vector;
            let length = turned.length();
            turned.to_array().each(|component| component / length).into()
        })
    }

    /// How great a length is then.
    pub(super) fn length(&self, length: T) -> T {
        length * self.scale
    }

    /// How it is turned.
    pub(super) fn rotation(&self) -> Option<Mat3<T>> {
        self.turn.map(|(turn, _)| turn)
    }

    fn cast<B: Real>(&self) -> Placement<B> {
        let turn = self.turn.map(|(turn, center)| (turn.cast(), center.cast()));
        Placement { scale: self.scale.cast(), turn, shift: self.shift.cast() }
    }
}

impl<T: Real> Shape<T> {
    /// The same shape, larger by a factor, about the origin.
    ///
    /// ```
    /// use carom::surroundings::{FixedSphere, Shape};
    /// let ball = Shape::from(FixedSphere::solid([1.0, 0.0, 0.0], 0.5)).scaled(2.0);
    /// assert_eq!(ball, FixedSphere::solid([2.0, 0.0, 0.0], 1.0).into());
    /// ```
    #[must_use]
    pub fn scaled(&self, factor: T) -> Self {
        self.placed_finely(Placement::NONE.scaled(factor))
    }

    /// The same shape, turned by an angle, rad, about an axis through the origin, of any
    /// length but 0, with the right hand.
    ///
    /// ```
    /// use carom::surroundings::{Cuboid, Shape};
    /// use carom::vec3::Vec3;
    ///
    /// let eighth = core::f64::consts::FRAC_PI_4;
    /// let cube = Shape::from(Cuboid::solid([-1.0; 3], [1.0; 3]));
    /// let [cube] = &cube.turned([0.0, 0.0, 1.0], eighth).features()[..] else { return };
    /// let gap = cube.clearance(Vec3::new(2.0, 0.0, 0.0), 0.5).gap;
    /// assert!((gap - (1.5 - 2.0_f64.sqrt())).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn turned(&self, axis: [T; 3], angle: T) -> Self {
        self.turned_about([T::ZERO; 3], axis, angle)
    }

    /// The same shape, turned by an angle, rad, about an axis through a centre, length.
    ///
    /// ```
    /// use carom::surroundings::{FixedSphere, Shape};
    /// use carom::vec3::Vec3;
    ///
    /// let quarter = core::f64::consts::FRAC_PI_2;
    /// let ball = Shape::from(FixedSphere::solid([3.0, 0.0, 0.0], 0.5));
    /// let ball = ball.turned_about([2.0, 0.0, 0.0], [0.0, 0.0, 1.0], quarter);
    /// let [ball] = &ball.features()[..] else { return };
    /// assert!((ball.clearance(Vec3::new(2.0, 3.0, 0.0), 0.5).gap - 1.0_f64).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn turned_about(&self, center: [T; 3], axis: [T; 3], angle: T) -> Self {
        self.placed_finely(Placement::NONE.turned(axis.into(), angle, center.into()))
    }

    /// The same shape, moved, length.
    ///
    /// ```
    /// use carom::surroundings::{FixedSphere, Shape};
    /// let ball = Shape::from(FixedSphere::solid([1.0, 0.0, 0.0], 0.5)).moved([0.0, 2.0, 0.0]);
    /// assert_eq!(ball, FixedSphere::solid([1.0, 2.0, 0.0], 0.5).into());
    /// ```
    #[must_use]
    pub fn moved(&self, shift: [T; 3]) -> Self {
        self.placed_finely(Placement::NONE.moved(shift.into()))
    }

    /// Placed in `f64` or better, and then rounded.
    fn placed_finely(&self, placement: Placement<T>) -> Self {
        if T::EPSILON.to_f64() > f64::EPSILON {
            self.cast::<f64>().placed(&placement.cast()).cast()
        } else {
            self.placed(&placement)
        }
    }
}
