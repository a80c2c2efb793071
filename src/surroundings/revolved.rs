//! Revolved: a profile turned about an axis, thin or closed.

use super::axis::{Axis, inscribed};
use super::entry::{AXIS, CENTER, INSIDE, Key, Meaning, ShapeEntry};
use super::gate::Gate;
use super::mistake::{Mistake, direction, point};
use super::placement::Placement;
use super::skin::{Corners, Detail, from_inside};
use super::slant::Slant;
use super::solid::Solid;
use super::{Band, Chain, Feature};
use crate::numbers::array::Each;
use crate::real::Real;
use crate::space::joined;
use crate::vec3::Vec3;

/// What a profile makes that is turned about an axis, fixed in space.
///
/// The profile is a line through places `[ρ, z]`: distances from the axis, and heights along
/// it from a centre. What it makes is thin, touched from both sides; or, if it is closed, from
/// its last place to its first one or along the axis, solid, or a container.
///
/// In a scene file: `shape = "revolved"` with `center`, `axis`, `profile`, `closed` and
/// `inside`; `closed = true` joins the ends of the profile, `inside = true` makes a container
/// of what is closed. `"funnel"` is another name of it.
///
/// ```
/// use carom::surroundings::{Revolved, Shape};
/// use carom::vec3::Vec3;
///
/// // A pipe, a funnel and a drum.
/// let profile = [[0.5, -4.0], [0.5, -2.0], [3.5, 2.0], [3.5, 5.0]];
/// let hopper = Shape::from(Revolved::thin([0.0; 3], [0.0, 0.0, 1.0], profile));
/// let gaps = hopper.features().into_iter().map(|part| {
///     part.clearance(Vec3::new(0.0, 0.0, 4.0), 0.25).gap
/// });
/// assert_eq!(gaps.fold(f64::INFINITY, f64::min), 3.25);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Revolved<T> {
    axis: Axis<T>,
    /// Distances from the axis and heights, length.
    profile: Vec<[T; 2]>,
    is_closed: bool,
    inside: bool,
}

impl<T: Real> Revolved<T> {
    /// A thin one: the centre, the axis, of any length but 0, and the profile; lengths.
    ///
    /// ```
    /// use carom::surroundings::{Revolved, Shape};
    /// let profile = [[1.0, 0.0], [2.0, 1.0], [2.0, 3.0]];
    /// let cup = Shape::from(Revolved::thin([0.0; 3], [0.0, 0.0, 1.0], profile));
    /// assert_eq!(cup.features().len(), 2);
    /// ```
    #[must_use]
    pub fn thin(center: [T; 3], axis: [T; 3], profile: impl IntoIterator<Item = [T; 2]>) -> Self {
        let profile = profile.into_iter().collect();
        Self { axis: Axis::new(center, axis), profile, is_closed: false, inside: false }
    }

    /// A solid one that bodies bounce off, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::{Revolved, Shape};
    /// use carom::vec3::Vec3;
    ///
    /// // Two cones, base to base.
    /// let profile = [[0.0, -4.0], [3.0, 0.0], [0.0, 4.0]];
    /// let top = Shape::from(Revolved::solid([0.0; 3], [0.0, 0.0, 1.0], profile));
    /// let [top] = &top.features()[..] else { return };
    /// assert_eq!(top.clearance(Vec3::new(0.0, 0.0, 6.0), 0.5).gap, 1.5);
    /// assert!(top.clearance(Vec3::new(0.0, 0.0, 0.0), 0.5).gap < -2.5);
    /// ```
    #[must_use]
    pub fn solid(center: [T; 3], axis: [T; 3], profile: impl IntoIterator<Item = [T; 2]>) -> Self {
        Self { is_closed: true, ..Self::thin(center, axis, profile) }
    }

    /// A container that bodies are inside of, of the same lengths.
    ///
    /// ```
    /// use carom::surroundings::{Revolved, Shape};
    /// let profile = [[0.0, 0.0], [2.0, 0.0], [3.0, 4.0], [0.0, 4.0]];
    /// let cup = Shape::from(Revolved::container([0.0; 3], [0.0, 0.0, 1.0], profile));
    /// let corners = cup.interior().map(|corners| corners.map(|c| c.to_array()));
    /// assert_eq!(corners, Some([[-3.0, -3.0, 0.0], [3.0, 3.0, 4.0]]));
    /// ```
    #[must_use]
    pub fn container(
        center: [T; 3],
        axis: [T; 3],
        profile: impl IntoIterator<Item = [T; 2]>,
    ) -> Self {
        Self { inside: true, ..Self::solid(center, axis, profile) }
    }

    /// The lines of the profile, but those of the axis.
    fn lines(&self) -> Vec<Slant<T>> {
        let ends = self.profile.iter().copied();
        let next = self.profile.iter().copied().cycle().skip(1);
        let count = if self.is_closed { self.profile.len() } else { self.profile.len().max(1) - 1 };
        let lines = ends.zip(next).take(count).filter(|(a, b)| a[0] > T::ZERO || b[0] > T::ZERO);
        lines.map(|(a, b)| Slant::new(a, b)).collect()
    }

    /// The area within a closed profile, positive if that leads about it with the right hand
    /// from out to up.
    fn area(&self) -> T {
        let next = self.profile.iter().cycle().skip(1);
        let areas = self.profile.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]);
        areas.fold(T::ZERO, |sum, area| sum + area)
    }

    /// The corners of the box around it.
    fn around(&self) -> [Vec3<T>; 2] {
        let bounds = self.lines().into_iter().map(|line| line.bounds(&self.axis));
        bounds.reduce(joined).unwrap_or([self.axis.center; 2])
    }
}

/// Two lines of a closed profile that meet where they do not follow each other.
fn meeting<T: Real>(lines: &[Slant<T>]) -> Option<[Slant<T>; 2]> {
    let side = |line: &Slant<T>, [distance, height]: [T; 2]| line.rightward(distance, height);
    let is_apart = |a: &Slant<T>, b: &Slant<T>| {
        let (start, end) = (side(a, b.start), side(a, b.end));
        start * end > T::ZERO
    };
    // On one line.
    let is_behind = |a: &Slant<T>, b: &Slant<T>| {
        (0..2).any(|k| {
            let [low, high] = [a.start[k].lesser(a.end[k]), a.start[k].greater(a.end[k])];
            b.start[k].greater(b.end[k]) < low || b.start[k].lesser(b.end[k]) > high
        })
    };
    lines.iter().enumerate().find_map(|(k, a)| {
        lines[k + 1..].iter().find_map(|b| {
            let follows = a.end == b.start || b.end == a.start;
            let is_back = follows && a.along[0] == -b.along[0] && a.along[1] == -b.along[1];
            let meets = !follows && !is_behind(a, b) && !is_apart(a, b) && !is_apart(b, a);
            (meets || is_back).then_some([*a, *b])
        })
    })
}

const PROFILE: Key = Key::new("profile", Meaning::Profile);
const CLOSED: Key = Key::new("closed", Meaning::Flag);

impl<T: Real> Solid<T> for Revolved<T> {
    type In<B: Real> = Revolved<B>;

    const NAME: &'static str = "revolved";
    const OTHER_NAME: Option<&'static str> = Some("funnel");
    const KEYS: &'static [Key] = &[CENTER, AXIS, PROFILE, CLOSED, INSIDE];

    fn read(entry: &ShapeEntry) -> Result<Revolved<f64>, Mistake> {
        Ok(Revolved {
            axis: Axis::new(entry.vector(CENTER)?, entry.vector(AXIS)?),
            profile: entry.profile(PROFILE)?.to_vec(),
            is_closed: entry.flag(CLOSED),
            inside: entry.flag(INSIDE),
        })
    }

    fn check(&self) -> Result<(), Mistake> {
        point(CENTER.name, self.axis.center)?;
        direction(AXIS.name, self.axis.direction)?;
        if self.inside && !self.is_closed {
            let wanted = "closed = true belongs beside it: what is open is thin, touched from both \
                          sides";
            return Err(Mistake::value(INSIDE.name, true, wanted));
        }
        let wrong =
            |found: String, wanted: &str| Err(Mistake::described(PROFILE.name, found, wanted));
        let count = self.profile.len();
        let least = if self.is_closed { 3 } else { 2 };
        if count < least {
            let wanted =
                format!("{least} or more are needed, each [distance from the axis, height]");
            return wrong(format!("a list of {count} places"), &wanted);
        }
        let shown = |[distance, height]: [T; 2]| format!("[{distance:?}, {height:?}]");
        for place in &self.profile {
            let is_place = place.iter().all(|c| c.is_finite()) && place[0] >= T::ZERO;
            if !is_place {
                let wanted =
                    "a place is a distance from the axis, from 0, and a height, both finite";
                return wrong(format!("through {}", shown(*place)), wanted);
            }
        }
        let ends = self.profile.iter().zip(self.profile.iter().cycle().skip(1));
        for (a, b) in ends.take(if self.is_closed { count } else { count - 1 }) {
            if a == b {
                let wanted = "each place must be another one than that before it; closed = true joins \
                              the last to the first";
                return wrong(format!("twice at {}", shown(*a)), wanted);
            }
            if !self.is_closed && a[0] == T::ZERO && b[0] == T::ZERO {
                return wrong(
                    format!("along the axis from {} to {}", shown(*a), shown(*b)),
                    "a line must lead out of the axis, unless closed = true",
                );
            }
        }
        if !self.is_closed {
            return Ok(());
        }
        let lines = self.lines();
        if let Some([a, b]) = meeting(&lines) {
            return wrong(
                format!(
                    "one whose lines from {} to {} and from {} to {} meet",
                    shown(a.start),
                    shown(a.end),
                    shown(b.start),
                    shown(b.end),
                ),
                "a closed profile must not cross or touch itself",
            );
        }
        let length = lines.iter().fold(T::ZERO, |sum, line| sum + line.length);
        if self.area().abs() > T::whole(16) * T::EPSILON * length * length {
            return Ok(());
        }
        wrong("one without an area".to_owned(), "a closed profile must go around something")
    }

    fn cast<B: Real>(&self) -> Revolved<B> {
        Revolved {
            axis: self.axis.cast(),
            profile: self.profile.iter().map(|place| place.each(Real::cast)).collect(),
            is_closed: self.is_closed,
            inside: self.inside,
        }
    }

    /// One for each line of what is thin; of what is closed, one for all lines between
    /// corners in which a sphere touches two of them.
    fn features(&self) -> Vec<Feature<T>> {
        let mut lines = self.lines();
        if !self.is_closed {
            let bands = lines.into_iter().enumerate().map(|(k, line)| {
                let [out, up] = line.along;
                let is_up = up > T::ZERO || up == T::ZERO && out > T::ZERO;
                // The rim between two lines is that of the first one.
                let rims = [k == 0, true];
                let (slant, rims) =
                    if is_up { (line, rims) } else { (line.reversed(), [rims[1], rims[0]]) };
                Band { rims, ..Band::thin(self.axis, slant) }.into()
            });
            return bands.collect();
        }
        if (self.area() < T::ZERO) != self.inside {
            lines.reverse();
            lines.iter_mut().for_each(|line| *line = line.reversed());
        }
        Chain::all(self.axis, &lines, self.inside).into_iter().map(Feature::from).collect()
    }

    fn is_thin(&self) -> bool {
        !self.is_closed
    }

    fn area(&self) -> Option<T> {
        let area = self.lines().iter().fold(T::ZERO, |sum, line| sum + line.area());
        Some(if self.is_closed { area } else { area * T::whole(2) })
    }

    fn triangles(&self, detail: &Detail<T>) -> Vec<Corners<T>> {
        let mut profile = self.profile.clone();
        if self.is_closed {
            profile.extend(self.profile.first());
        }
        let is_seen_from_inside = (self.area() < T::ZERO) != self.inside;
        from_inside(detail.turned(&self.axis, &profile), self.is_closed && is_seen_from_inside)
    }

    fn points(&self) -> Vec<Vec3<T>> {
        self.around().into()
    }

    fn placed(&self, at: &Placement<T>) -> Self {
        let profile = self.profile.iter().map(|place| place.each(|length| at.length(length)));
        Self { axis: self.axis.placed(at), profile: profile.collect(), ..*self }
    }

    fn gate(&self) -> Option<Gate<T>> {
        self.is_closed.then(|| Gate::closed(|inside| Self { inside, ..self.clone() }.features()))
    }

    fn interior(&self) -> Option<[Vec3<T>; 2]> {
        self.inside.then(|| self.around())
    }

    /// A box in the greatest cylinder about the axis, of those between some heights.
    fn inscribed(&self) -> Option<[Vec3<T>; 2]> {
        let lines = self.lines();
        let quarters = (0..4).map(|k| T::ratio(k, 4));
        let mut heights: Vec<T> = lines
            .iter()
            .flat_map(|line| {
                let rise = line.end[1] - line.start[1];
                quarters.clone().map(move |share| line.start[1] + rise * share)
            })
            .collect();
        heights.extend(lines.last().map(|line| line.end[1]));
        heights.sort_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
        let slabs: Vec<[T; 3]> = heights
            .windows(2)
            .map(|ends| [ends[0], ends[1], free_radius(&lines, [ends[0], ends[1]])])
            .collect();
        let (mut greatest, mut best) = (T::ZERO, None);
        for (first, slab) in slabs.iter().enumerate() {
            let mut radius = slab[2];
            for &[_, top, free] in &slabs[first..] {
                radius = radius.lesser(free);
                let volume = radius * radius * (top - slab[0]);
                if volume > greatest {
                    (greatest, best) = (volume, Some((slab[0], top, radius)));
                }
            }
        }
        let (base, top, radius) = best.filter(|_| self.inside)?;
        let half = T::ratio(1, 2);
        Some(inscribed(&self.axis.moved((base + top) * half), radius, (top - base) * half))
    }
}

/// How far lines around a hollow are from its axis, between two heights without an end of a
/// line between them; 0 where the axis is not in the hollow.
fn free_radius<T: Real>(lines: &[Slant<T>], [base, top]: [T; 2]) -> T {
    let middle = (base + top) * T::ratio(1, 2);
    let (mut least, mut crossings): (Option<T>, _) = (None, 0);
    let mut add =
        |distance: T| least = Some(least.map_or(distance, |least| least.lesser(distance)));
    for line in lines {
        let rise = line.end[1] - line.start[1];
        let at = |height: T| {
            let share = (height - line.start[1]) / rise;
            line.start[0] + (line.end[0] - line.start[0]) * share
        };
        let reaches = |height: T| (line.start[1] > height) != (line.end[1] > height);
        if reaches(middle) {
            crossings += 1;
            add(at(base).lesser(at(top)).greater(T::ZERO));
        }
    }
    least.filter(|_| crossings % 2 == 1).unwrap_or(T::ZERO)
}
