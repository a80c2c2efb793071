//! Capsule: a cylinder with round ends, solid or hollow.

use super::axis::{Axis, inscribed, pi};
use super::entry::{INSIDE, Key, Meaning, RADIUS, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, point, positive};
use super::piece::Piece;
use super::pieced::Pieced;
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::solid::{Obstacle, Solid};
use super::{Clearance, Feature};
use crate::contact::{FreeFlight, greatest_component};
use crate::lane::Lane;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// A capsule fixed in space: all that is within a radius of a line.
///
/// In a scene file: `shape = "capsule"` with the ends of the line, `a` and `b`, `radius`
/// and `inside`; `inside = true` makes a container.
///
/// ```
/// use carom::surroundings::{Capsule, Feature};
/// use carom::vec3::Vec3;
///
/// let bar = Feature::from(Capsule::solid([0.0; 3], [4.0, 0.0, 0.0], 1.0));
/// assert_eq!(bar.clearance(Vec3::new(2.0, 3.0, 0.0), 0.5).gap, 1.5);
/// assert_eq!(bar.clearance(Vec3::new(7.0, 4.0, 0.0), 0.5).gap, 3.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<T> {
    /// The ends of its line, length.
    pub ends: [Vec3<T>; 2],
    /// Length.
    pub radius: T,
    /// Whether bodies are inside of it: a container.
    pub inside: bool,
}

impl<T: Real> Capsule<T> {
    /// A solid capsule that bodies bounce off; the ends of its line and its radius, length.
    ///
    /// ```
    /// use carom::surroundings::Capsule;
    /// assert!(!Capsule::solid([0.0; 3], [4.0, 0.0, 0.0], 1.0).inside);
    /// ```
    #[must_use]
    pub fn solid(a: [T; 3], b: [T; 3], radius: T) -> Self {
        Self { ends: [a.into(), b.into()], radius, inside: false }
    }

    /// A container that bodies are inside of, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::Capsule;
    /// assert!(Capsule::container([0.0; 3], [4.0, 0.0, 0.0], 1.0).inside);
    /// ```
    #[must_use]
    pub fn container(a: [T; 3], b: [T; 3], radius: T) -> Self {
        Self { ends: [a.into(), b.into()], radius, inside: true }
    }

    /// From the line's nearest point.
    #[inline(always)]
    fn off_line<L: Lane<Scalar = T>>(&self, place: Vec3<L>) -> Vec3<L> {
        let [start, end] = self.ends.each(Vec3::<L>::splat);
        let line = end - start;
        let offset = place - start;
        let share = offset.dot(line) / line.length_squared();
        offset - line * share.greater(L::ZERO).lesser(L::ONE)
    }

    fn axis(&self) -> Axis<T> {
        let [start, end] = self.ends;
        Axis::new(start.to_array(), (end - start).to_array())
    }

    fn around(&self) -> [Vec3<T>; 2] {
        let reach = Vec3::new(self.radius, self.radius, self.radius);
        let [a, b] = self.ends.each(|end| [end - reach, end + reach]);
        joined(a, b)
    }
}

impl<T: Real> Obstacle<T> for Capsule<T> {
    /// On the line, where no normal is defined, the arm is zero and no impulse follows.
    #[inline(never)]
    fn clearance<L: Lane<Scalar = T>>(&self, center: Vec3<L>, radius: L) -> Clearance<L> {
        let offset = self.off_line(center);
        let distance = offset.length();
        Clearance::round(offset, distance, L::splat(self.radius), radius, self.inside)
    }

    fn contact_time(&self, flight: &FreeFlight<T>) -> Option<T> {
        self.collision_time(flight)
    }

    fn bounds(&self) -> Option<[Vec3<T>; 2]> {
        (!self.inside).then(|| self.around())
    }

    fn farthest(&self) -> f64 {
        let [lower, upper] = self.around().each(|corner| greatest_component(corner.cast::<f64>()));
        lower.max(upper)
    }

    fn is_hollow(&self) -> bool {
        self.inside
    }

    fn hop(&self, flight: &FreeFlight<T>, wait: T) -> T {
        self.long_hop(flight, wait)
    }
}

impl<T: Real> Pieced<T> for Capsule<T> {
    fn is_convex(&self) -> bool {
        !self.inside
    }

    fn offset(&self, place: Vec3<T>) -> Vec3<T> {
        self.off_line(place)
    }

    fn skin(&self) -> T {
        self.radius
    }

    fn each_piece(&self, visit: &mut dyn FnMut(Piece<T>)) {
        let Self { radius, inside: is_hollow, .. } = *self;
        visit(Piece::Edge { axis: self.axis(), radius, is_hollow });
        for center in self.ends {
            visit(Piece::Corner { center, radius, is_hollow });
        }
    }
}

const ENDS: [Key; 2] = [Key::new("a", Meaning::Point), Key::new("b", Meaning::Point)];

impl<T: Real> Solid<T> for Capsule<T> {
    type In<B: Real> = Capsule<B>;

    const NAME: &'static str = "capsule";
    const KEYS: &'static [Key] = &[ENDS[0], ENDS[1], RADIUS, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Capsule<f64>, Mistake> {
        let [a, b] = [entry.vector(ENDS[0])?, entry.vector(ENDS[1])?];
        let radius = entry.number(RADIUS, "a capsule has a radius greater than 0")?;
        Ok(Capsule { inside: entry.flag(INSIDE), ..Capsule::solid(a, b, radius) })
    }

    fn check(&self) -> Result<(), Mistake> {
        let [start, end] = self.ends;
        point(ENDS[0].name, start)?;
        point(ENDS[1].name, end)?;
        positive::<T>(RADIUS.name, self.radius.to_f64(), "a radius")?;
        let length = (end - start).length();
        if length > T::ZERO && length.is_finite() {
            return Ok(());
        }
        let [start, end] = self.ends.each(|end| end.cast::<f64>().to_array());
        let wanted = format!("it must be another point than a, {start:?}; a ball is a sphere");
        Err(Mistake::value(ENDS[1].name, end, wanted))
    }

    fn cast<B: Real>(&self) -> Capsule<B> {
        let ends = self.ends.each(|end| end.cast());
        Capsule { ends, radius: self.radius.cast(), inside: self.inside }
    }

    fn features(&self) -> Vec<Feature<T>> {
        vec![(*self).into()]
    }

    fn area(&self) -> Option<T> {
        let [a, b] = self.ends;
        Some(pi::<T>() * T::whole(2) * self.radius * ((b - a).length() + self.radius * T::whole(2)))
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let [a, b] = self.ends;
        let length = (b - a).length();
        let way = if length > T::ZERO { b - a } else { Vec3::new(T::ZERO, T::ZERO, T::ONE) };
        let axis = Axis::new(a.to_array(), way.to_array());
        let mut profile = detail.arc([T::ZERO; 2], self.radius, [-1, 0]);
        profile.extend(detail.arc([T::ZERO, length], self.radius, [0, 1]));
        from_inside(detail.turned(&axis, &profile), self.inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        let ends = self.ends.each(|end| at.point(end));
        Self { ends, radius: at.length(self.radius), inside: self.inside }
    }

    fn gate(&self) -> Option<Gate<T>> {
        Some(Gate::closed(|inside| Self { inside, ..*self }.features()))
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.around())
    }

    /// A box in its cylinder.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let [start, end] = self.ends;
        let half = (end - start).length() * T::ratio(1, 2);
        self.inside.then(|| inscribed(&self.axis().moved(half), self.radius, half))
    }
}
