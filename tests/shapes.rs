//! First contacts with every shape: against exact ones, and against dense sampling of the
//! gap for flights that are hard on a contact finder.

mod common;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use carom::lane::Lane;
use carom::real::Real;
use carom::surroundings::{
    Capsule, Cone, Cuboid, Cylinder, Disc, Feature, FixedSphere, Hull, Plane, Revolved, Shape,
    Torus, Triangle, Tube,
};
use carom::vec3::Vec3;
use common::numbers::Random;

const PLACE: [f64; 3] = [0.5, -0.25, 0.125];
const TILTED: [f64; 3] = [1.0, 2.0, 2.0];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// The parts of the exact shots, by name.
fn parts() -> Vec<(&'static str, Vec<Shape<f64>>)> {
    let along = |distance: f64| core::array::from_fn(|k| PLACE[k] + TILTED[k] / 3.0 * distance);
    let above = |height: f64| [PLACE[0], PLACE[1], PLACE[2] + height];
    let [a, b] = [[-1.0, 0.5, 0.0], [2.0, -0.5, 1.0]];
    let (lower, upper) = ([-1.0, -1.5, -0.5], [2.0, 0.5, 1.0]);
    let tube = |z: f64, height: f64, radii: [f64; 2]| Tube::new(above(z), UP, height, radii).into();
    vec![
        ("plane", vec![Plane::new([0.0, 0.0, -1.0], [2.0, 3.0, 6.0]).into()]),
        ("sphere", vec![FixedSphere::solid(PLACE, 2.0).into()]),
        ("sphere-inside", vec![FixedSphere::container(PLACE, 2.0).into()]),
        ("box", vec![Cuboid::solid(lower, upper).into()]),
        ("box-inside", vec![Cuboid::container(lower, upper).into()]),
        ("capsule", vec![Capsule::solid(a, b, 1.0).into()]),
        ("capsule-inside", vec![Capsule::container(a, b, 1.0).into()]),
        ("cylinder", vec![Cylinder::solid(PLACE, TILTED, 2.0, None).into()]),
        ("cylinder-inside", vec![Cylinder::container(PLACE, TILTED, 2.0, None).into()]),
        ("capped-cylinder", vec![Cylinder::solid(PLACE, TILTED, 2.0, Some(3.0)).into()]),
        ("capped-cylinder-inside", vec![Cylinder::container(PLACE, TILTED, 2.0, Some(3.0)).into()]),
        ("torus", vec![Torus::solid(PLACE, TILTED, 3.0, 1.0).into()]),
        ("torus-inside", vec![Torus::container(PLACE, TILTED, 3.0, 1.0).into()]),
        ("disc", vec![Disc::new(PLACE, TILTED, 2.0, 0.0).into()]),
        ("annulus", vec![Disc::new(PLACE, TILTED, 2.0, 1.0).into()]),
        ("tube", vec![Tube::new(along(-1.5), TILTED, 3.0, [2.0, 2.0]).into()]),
        ("funnel", vec![tube(-2.0, 4.0, [0.5, 3.5])]),
        (
            "hopper",
            vec![
                tube(-4.0, 2.0, [0.5, 0.5]),
                tube(-2.0, 4.0, [0.5, 3.5]),
                tube(2.0, 3.0, [3.5, 3.5]),
            ],
        ),
        ("frustum", vec![Cone::solid(along(-2.0), TILTED, 2.0, [3.0, 1.5]).into()]),
        // Its base is so far away that no shot comes there in time.
        ("cone-inside", vec![Cone::container(above(0.0), UP, 4000.0, [0.0, 3000.0]).into()]),
        (
            "triangle",
            vec![Triangle::new([-1.0, -1.0, 0.0], [2.0, -0.5, 0.5], [0.25, 1.75, -0.25]).into()],
        ),
    ]
}

/// The same parts, made in another way.
fn other_parts() -> Vec<(&'static str, Vec<Shape<f64>>)> {
    let (lower, upper) = ([-1.0, -1.5, -0.5], [2.0, 0.5, 1.0]);
    let corner = |k: usize| core::array::from_fn(|axis| [lower, upper][k >> axis & 1][axis]);
    let inner = (0..40).map(|k| {
        let share = |axis: usize| f64::from((k * (axis as u32 + 3)) % 7) / 6.0;
        core::array::from_fn(|axis| lower[axis] + share(axis) * (upper[axis] - lower[axis]))
    });
    let thin = |axis, profile: &[[f64; 2]]| Revolved::thin(PLACE, axis, profile.to_vec()).into();
    let can = [[0.0, -1.5], [2.0, -1.5], [2.0, 1.5], [0.0, 1.5]];
    let frustum = [[0.0, -2.0], [3.0, -2.0], [1.5, 0.0], [0.0, 0.0]];
    let cylinder = Shape::from(Cylinder::solid([0.0; 3], UP, 1.0, None)).scaled(2.0);
    let tilt = (2.0_f64 / 3.0).acos();
    let hopper = [[0.5, -4.0], [0.5, -2.0], [3.5, 2.0], [3.5, 5.0]];
    vec![
        ("box", vec![Hull::new((0..8).map(corner).chain(inner)).into()]),
        ("capped-cylinder", vec![Revolved::solid(PLACE, TILTED, can).into()]),
        ("capped-cylinder-inside", vec![Revolved::container(PLACE, TILTED, can).into()]),
        ("frustum", vec![Revolved::solid(PLACE, TILTED, frustum).into()]),
        ("disc", vec![thin(TILTED, &[[2.0, 0.0], [0.0, 0.0]])]),
        ("annulus", vec![thin(TILTED, &[[1.0, 0.0], [2.0, 0.0]])]),
        ("tube", vec![thin(TILTED, &[[2.0, 1.5], [2.0, -1.5]])]),
        ("funnel", vec![thin(UP, &[[0.5, -2.0], [3.5, 2.0]])]),
        ("hopper", vec![thin(UP, &hopper)]),
        ("cone-inside", vec![Cone::endless_container(PLACE, UP, 0.75).into()]),
        ("cylinder", vec![cylinder.turned([-2.0, 1.0, 0.0], tilt).moved(PLACE)]),
        (
            "torus",
            vec![
                Shape::from(Torus::solid([0.0; 3], UP, 1.5, 0.5))
                    .scaled(2.0)
                    .moved(PLACE)
                    .turned_about(PLACE, [-2.0, 1.0, 0.0], -1.5)
                    .turned_about(PLACE, [-2.0, 1.0, 0.0], tilt + 1.5),
            ],
        ),
    ]
}

/// Parts of which there are no exact shots.
fn further_parts() -> Vec<(&'static str, Vec<Shape<f64>>)> {
    let spool = [[0.0, -2.0], [2.0, -2.0], [0.75, -0.5], [0.75, 0.5], [2.0, 2.0], [0.0, 1.5]];
    let bottle = [[0.0, -3.0], [2.5, -3.0], [2.5, 0.5], [1.0, 2.0], [1.0, 3.0], [0.0, 3.5]];
    let ring = [[1.5, -0.5], [2.5, -0.75], [2.0, 0.75]];
    let mut random = Random(5);
    let stone = Hull::new((0..30).map(|_| {
        let place = random.vector::<f64>();
        (place * (1.5 / place.length())).to_array()
    }));
    let pyramid = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [3.0, 3.0, 0.0], [1.0, 1.0, 2.0]];
    let turned = |shape: Shape<f64>| shape.turned([3.0, -2.0, 4.0], 0.7);
    vec![
        ("spool", vec![Revolved::solid(PLACE, TILTED, spool).into()]),
        ("bottle-inside", vec![Revolved::container(PLACE, TILTED, bottle).into()]),
        ("ring", vec![Revolved::solid(PLACE, TILTED, ring).into()]),
        ("stone", vec![stone.into()]),
        ("pyramid", vec![turned(Hull::new(pyramid).into())]),
        ("endless-cone", vec![Cone::endless_solid(PLACE, TILTED, 0.5).into()]),
        ("turned-box", vec![turned(Cuboid::solid([-1.0; 3], [1.0, 2.0, 0.5]).into())]),
    ]
}

/// All of them.
fn all_parts() -> impl Iterator<Item = (&'static str, Vec<Shape<f64>>)> {
    parts().into_iter().chain(other_parts()).chain(further_parts())
}

/// A part's features in a precision.
fn features<T: Real>(shapes: &[Shape<f64>]) -> Vec<Feature<T>> {
    shapes.iter().flat_map(|shape| shape.cast::<T>().features()).collect()
}

/// A sphere in free flight, in numbers that every precision has.
#[derive(Clone, Copy, Debug)]
struct Flight {
    center: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
    radius: f64,
}

fn vector<T: Real>(components: [f64; 3]) -> Vec3<T> {
    components.map(T::from_f64).into()
}

fn length(components: [f64; 3]) -> f64 {
    vector::<f64>(components).length()
}

impl Flight {
    fn center_at<T: Real>(&self, time: T) -> Vec3<T> {
        let [c, v, a] = [self.center, self.velocity, self.acceleration].map(vector::<T>);
        c + (v + a * (T::ratio(1, 2) * time)) * time
    }

    fn velocity_at(&self, time: f64) -> Vec3<f64> {
        vector::<f64>(self.velocity) + vector::<f64>(self.acceleration) * time
    }

    fn field<T: Real>(&self) -> Option<Vec3<T>> {
        (self.acceleration != [0.0; 3]).then(|| vector(self.acceleration))
    }

    /// The feature that is met first, and when; `left` says which was bounced off.
    fn first<T: Real>(
        &self,
        features: &[Feature<T>],
        left: impl Fn(usize) -> bool,
    ) -> Option<(T, usize)> {
        let (center, velocity) = (vector(self.center), vector(self.velocity));
        let radius = T::from_f64(self.radius);
        let times = features.iter().enumerate().filter_map(|(k, feature)| {
            let time = feature.contact_time(center, velocity, self.field(), radius, left(k))?;
            Some((time, k))
        });
        let first = times.reduce(|a, b| if b.0 < a.0 { b } else { a });
        first.filter(|(time, _)| *time < T::whole(1000))
    }

    fn gap<T: Real>(&self, features: &[Feature<T>], time: T) -> f64 {
        let (center, radius) = (self.center_at(time), T::from_f64(self.radius));
        let gaps = features.iter().map(|feature| feature.clearance(center, radius).gap.to_f64());
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// What lengths are rounded by up to a time, for something of this size.
    fn scale(&self, time: f64, size: f64) -> f64 {
        let [c, v, a] = [self.center, self.velocity, self.acceleration].map(length);
        c + (v + 0.5 * a * time) * time + self.radius + size
    }
}

/// A shot with its exact contact.
struct Shot {
    part: String,
    kind: String,
    is_short: bool,
    flight: Flight,
    /// Time, normal, speed of approach.
    contact: Option<(f64, Vec3<f64>, f64)>,
}

fn shots() -> Vec<Shot> {
    let text = include_str!("data/shots.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    rows.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let vector = |k: usize| [number(k), number(k + 1), number(k + 2)];
        let flight = Flight {
            center: vector(3),
            velocity: vector(6),
            acceleration: vector(9),
            radius: number(12),
        };
        let is_hit = fields[13] != "none";
        let contact = is_hit.then(|| (number(13), vector(14).into(), number(17)));
        let [part, kind] = [fields[0], fields[1]].map(str::to_owned);
        Shot { part, kind, is_short: fields[2] == "f32", flight, contact }
    })
    .collect()
}

/// How far shapes reach that the shots meet.
const SIZE: f64 = 4.0;

/// The worst error of all shots as a gap, in ε of the lengths.
fn worst_of_shots<T: Real>(is_fit: impl Fn(&Shot) -> bool) -> (usize, f64) {
    let parts: Vec<_> = all_parts().collect();
    let shots = shots();
    let epsilon = T::EPSILON.to_f64();
    let (mut count, mut worst) = (0, 0.0_f64);
    let mut wrong = Vec::new();
    let pairs = shots.iter().filter(|shot| is_fit(shot)).flat_map(|shot| {
        let own = parts.iter().filter(|(name, _)| *name == shot.part);
        own.map(move |(_, shapes)| (shot, shapes))
    });
    for (shot, shapes) in pairs {
        count += 1;
        let features = features::<T>(shapes);
        let (center, radius) = (vector(shot.flight.center), T::from_f64(shot.flight.radius));
        let is_left = |k: usize| {
            let gap = features[k].clearance(center, radius).gap.to_f64();
            shot.kind.starts_with("leave") && gap.abs() < 1e-6
        };
        let found = shot.flight.first(&features, is_left);
        let at = || format!("{} {} {:?} {found:?}", shot.part, shot.kind, shot.flight);
        let (Some((found, feature)), Some((time, normal, approach))) = (found, shot.contact) else {
            if found.is_some() != shot.contact.is_some() {
                wrong.push(format!("{} for {:?}", at(), shot.contact));
            }
            continue;
        };
        if shot.kind == "touch" {
            if found.to_f64() > 1e-9_f64.max(8.0 * epsilon) {
                wrong.push(at());
            }
            continue;
        }
        let scale = epsilon * shot.flight.scale(time, SIZE);
        let error = (found.to_f64() - time).abs() * approach / scale;
        worst = worst.max(error);
        if error > 4.0 {
            wrong.push(format!("{error} ε of {time}: {}", at()));
        }
        // The normal turns by what the place is off, over the radius of the sphere.
        let clearance = features[feature].clearance(shot.flight.center_at(found), radius);
        let arm = clearance.arm.cast::<f64>();
        let speed = shot.flight.velocity_at(time).length();
        let late = error * scale / approach * speed;
        let turned = (arm * (1.0 / arm.length()) - normal).length();
        let allowed = 16.0 * (late + scale) / shot.flight.radius + 16.0 * epsilon;
        if turned > allowed {
            wrong.push(format!("normal off by {turned:e}, not {allowed:e}: {}", at()));
        }
        // A pack has the same bits.
        let centers = shot.flight.center_at(found).to_array().map(T::Pack8::splat);
        let pack = features[feature].clearance(Vec3::from(centers), T::Pack8::splat(radius));
        let arm = pack.arm.to_array().map(|lanes| lanes.to_array().as_ref()[5]);
        let same = arm == clearance.arm.to_array()
            && pack.gap.to_array().as_ref().iter().all(|gap| *gap == clearance.gap);
        assert!(same, "another clearance in a pack: {}", at());
    }
    assert!(wrong.is_empty(), "{} of {count} in {}:\n{}", wrong.len(), T::NAME, wrong.join("\n"));
    (count, worst)
}

#[test]
fn contacts_are_the_exact_ones() {
    let double = worst_of_shots::<f64>(|_| true);
    let single = worst_of_shots::<f32>(|shot| shot.is_short);
    println!("(shots, worst error in ε): f64 {double:?}, f32 {single:?}");
    assert!(double.0 > 750 && single.0 > 450);
}

#[cfg(feature = "study")]
#[test]
fn contacts_are_the_exact_ones_in_double_double() {
    // The times of the file have the digits of a double here.
    let parts = parts();
    for shot in shots() {
        let (_, shapes) = parts.iter().find(|(name, _)| *name == shot.part).unwrap();
        let features = features::<carom::DoubleDouble>(shapes);
        if let Some((time, _, approach)) = shot.contact.filter(|_| shot.kind != "touch") {
            let is_left = |_| shot.kind.starts_with("leave");
            let found = shot.flight.first(&features, is_left).map(|(time, _)| time.to_f64());
            let found = found.unwrap_or_else(|| panic!("missed: {} {}", shot.part, shot.kind));
            let scale = f64::EPSILON * shot.flight.scale(time, SIZE);
            let error = (found - time).abs() * approach;
            assert!(error < 4.0 * scale, "{} {} {found} for {time}", shot.part, shot.kind);
        }
    }
}

/// What makes a flight hard on a contact finder.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Random,
    /// Past the part or into it by as little as is asked for.
    Graze,
    /// From as little off the surface.
    Near,
    /// From contact, as little as rounding off.
    Leaving,
    /// A graze on which gravity bends the path as an edge bends the gap.
    Osculating,
    /// From a thousand sizes away.
    Far,
    /// A sphere a thousandth of its size.
    Tiny,
    /// A sphere greater than the part.
    Huge,
}

const KINDS: [Kind; 8] = [
    Kind::Random,
    Kind::Graze,
    Kind::Near,
    Kind::Leaving,
    Kind::Osculating,
    Kind::Far,
    Kind::Tiny,
    Kind::Huge,
];

/// A flight of a kind with a part, in numbers of a precision; None where chance gave none.
fn flight<T: Real>(random: &mut Random, kind: Kind, features: &[Feature<f64>]) -> Option<Flight> {
    let short = |value: f64| T::from_f64(value).to_f64();
    let shortened = |vector: Vec3<f64>| vector.to_array().map(short);
    let radius = match kind {
        Kind::Tiny => short(1e-3 * (1.1 + random.unit::<f64>())),
        Kind::Huge => short(3.0 + 2.0 * random.unit::<f64>()),
        _ => short(0.25 + 0.2 * random.unit::<f64>()),
    };
    let gravity = Vec3::new(0.0, 0.0, [0.0, -10.0][(random.bits() % 2) as usize]);
    let is_field = gravity.z != 0.0;
    let place = random.vector::<f64>() * 5.0;
    let speed = random.magnitude::<f64>(-2, 1).abs();
    let rounding = 16.0 * T::EPSILON.to_f64();
    let toss = random.vector::<f64>() * speed;
    let (center, velocity) = match kind {
        Kind::Random | Kind::Tiny | Kind::Huge => (place, toss),
        Kind::Far => {
            let way = random.vector::<f64>() * 1000.0;
            let time = 100.0;
            // Aimed, and lifted for its fall.
            (way, (place * 0.5 - way) * (1.0 / time) - gravity * (0.5 * time))
        }
        _ => {
            // To the surface of one of the features.
            let feature = &features[random.bits() as usize % features.len()];
            let mut center = place;
            for _ in 0..4 {
                let way = feature.clearance(center, radius).way_to_touch();
                if !way.length().is_finite() {
                    return None;
                }
                center += way;
            }
            let arm = feature.clearance(center, radius).arm;
            let normal = arm * (1.0 / arm.length());
            let off = random.magnitude::<f64>(-14, -1);
            let along = normal.cross(random.vector::<f64>());
            let along = along * (1.0 / along.length());
            match kind {
                Kind::Near => (center + normal * off.abs(), toss),
                Kind::Leaving => {
                    let out = normal * random.magnitude::<f64>(-12, 1).abs();
                    (center, out + along * (random.unit::<f64>() * speed))
                }
                _ => {
                    let pull = -gravity.dot(normal);
                    let bend = (pull.max(0.0) * radius).sqrt();
                    let osculating = kind == Kind::Osculating && bend > 0.0;
                    let speed = if osculating { bend } else { speed };
                    let time = 0.3 + 0.2 * random.unit::<f64>();
                    let back = along * speed - gravity * time;
                    (center + normal * off - (along * speed - gravity * (0.5 * time)) * time, back)
                }
            }
        }
    };
    let (center, velocity) = (shortened(center), shortened(velocity));
    let is_clear = features.iter().all(|feature| {
        let clearance = feature.clearance(center.into(), radius);
        let is_left = kind == Kind::Leaving
            && clearance.gap.abs() < rounding
            && clearance.arm.dot(velocity.into()) >= 0.0;
        is_left || clearance.gap > 0.0
    });
    let acceleration = if is_field { gravity.to_array() } else { [0.0; 3] };
    is_clear.then_some(Flight { center, velocity, acceleration, radius })
}

/// The least gap up to a time, by samples and a descent from the least of them.
fn least_gap(flight: &Flight, features: &[Feature<f64>], until: f64) -> (f64, f64) {
    const SAMPLES: u32 = 160;
    let gap = |time: f64| flight.gap::<f64>(features, time);
    let at = |k: f64| until * k / f64::from(SAMPLES);
    let least = (0..SAMPLES).map(|k| (gap(at(f64::from(k))), f64::from(k)));
    let (_, k) = least.reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap();
    let (mut low, mut high) = (at((k - 1.0).max(0.0)), at(k + 1.0).min(until));
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        let (a, b) = (low + third, high - third);
        if gap(a) < gap(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let time = 0.5 * (low + high);
    (gap(time), time)
}

/// The worst of an audit, in ε of the lengths.
#[derive(Debug, Default)]
struct Audit {
    flights: usize,
    contacts: usize,
    /// Of the part, before the contact that was found.
    penetration: f64,
    /// Between the surfaces at contact.
    gap: f64,
}

impl Audit {
    fn add(&mut self, other: &Self) {
        self.flights += other.flights;
        self.contacts += other.contacts;
        self.penetration = self.penetration.max(other.penetration);
        self.gap = self.gap.max(other.gap);
    }
}

/// Many flights of each kind with every part, the parts on all cores.
fn audit<T: Real>(flights: usize) -> Audit {
    let parts: Vec<_> = all_parts().collect();
    let (next, total) = (AtomicUsize::new(0), Mutex::new((Audit::default(), Vec::new())));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((part, shapes)) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let (audit, wrong) = audit_part::<T>(part, shapes, flights);
                    let mut total = total.lock().unwrap();
                    total.0.add(&audit);
                    total.1.extend(wrong);
                }
            });
        }
    });
    let (audit, wrong) = total.into_inner().unwrap();
    let some = &wrong[..wrong.len().min(40)];
    assert!(wrong.is_empty(), "{} of {audit:?} in {}:\n{}", wrong.len(), T::NAME, some.join("\n"));
    audit
}

/// Many flights of each kind with a part, and what is wrong with them.
fn audit_part<T: Real>(part: &str, shapes: &[Shape<f64>], flights: usize) -> (Audit, Vec<String>) {
    let mut audit = Audit::default();
    let epsilon = T::EPSILON.to_f64();
    let mut random = Random(17);
    let mut wrong = Vec::new();
    let (exact, rounded) = (features::<f64>(shapes), features::<T>(shapes));
    for kind in KINDS {
        for _ in 0..flights {
            let Some(flight) = flight::<T>(&mut random, kind, &exact) else { continue };
            // What is inside of a container is smaller than it.
            if kind == Kind::Huge && part.ends_with("inside") {
                continue;
            }
            audit.flights += 1;
            let radius = T::from_f64(flight.radius);
            // It does not come towards what it has left.
            let is_left = |k: usize| {
                let gap = rounded[k].clearance(vector(flight.center), radius).gap.to_f64();
                let arm = exact[k].clearance(flight.center.into(), flight.radius).arm;
                let is_closing = arm.dot(flight.velocity.into()) < 0.0;
                kind == Kind::Leaving && gap.abs() < 64.0 * epsilon && !is_closing
            };
            let found = flight.first(&rounded, is_left).map(|(time, _)| time.to_f64());
            // As long as gravity can bring it back.
            let until = found.unwrap_or(20.0);
            let (least, time) = least_gap(&flight, &exact, until);
            let off = if kind == Kind::Leaving {
                (-flight.gap::<f64>(&exact, 0.0)).max(0.0)
            } else {
                0.0
            };
            let scale = epsilon * flight.scale(time, SIZE);
            let depth = (-least - off) / scale;
            audit.penetration = audit.penetration.max(depth);
            let at = || format!("{part} {kind:?} {flight:?} {found:?}");
            if depth.is_nan() || depth > 4.0 {
                wrong.push(format!("{depth:.1} ε deep at {time}: {}", at()));
            }
            if let Some(time) = found {
                audit.contacts += 1;
                let scale = epsilon * flight.scale(time, SIZE);
                let gap = (flight.gap::<f64>(&exact, time).abs() - off) / scale;
                audit.gap = audit.gap.max(gap);
                if gap.is_nan() || gap > 20.0 {
                    wrong.push(format!("gap of {gap:.1} ε: {}", at()));
                }
            }
        }
    }
    (audit, wrong)
}

#[test]
fn no_flight_passes_through_a_surface() {
    let double = audit::<f64>(2000);
    let single = audit::<f32>(2000);
    println!("f64 {double:?}\nf32 {single:?}");
    assert!(double.contacts > 20_000 && single.contacts > 20_000);
}

/// The same with 100,000 flights of each kind, or as many as the variable `FLIGHTS` says:
/// `FLIGHTS=100000 cargo test --release --test shapes in_full -- --ignored --nocapture`.
#[test]
#[ignore = "takes hours"]
fn no_flight_passes_through_a_surface_in_full() {
    let flights = std::env::var("FLIGHTS").map_or(100_000, |flights| flights.parse().unwrap());
    println!("f64 {:?}", audit::<f64>(flights));
    println!("f32 {:?}", audit::<f32>(flights));
}

/// Shapes and flights of any size end in a time, or in none.
fn wild_inputs<T: Real>() {
    let mut random = Random(6);
    for _ in 0..4000 {
        let vector = |random: &mut Random| [(); 3].map(|()| random.magnitude::<T>(-6, 6));
        let (a, b, c) = (vector(&mut random), vector(&mut random), vector(&mut random));
        let [r, s, h] = [(); 3].map(|()| random.magnitude::<T>(-6, 6).abs());
        let shapes: [Shape<T>; 19] = [
            Triangle::new(a, b, c).into(),
            Shape::from(Cuboid::solid(a, core::array::from_fn(|k| a[k] + r))).turned(b, c[0]),
            Capsule::solid(a, b, r).into(),
            Capsule::container(a, b, r).into(),
            Cylinder::solid(a, b, r, None).into(),
            Cylinder::container(a, b, r, None).into(),
            Cylinder::solid(a, b, r, Some(h)).into(),
            Cone::solid(a, b, h, [r, T::ZERO]).into(),
            Cone::container(a, b, h, [r, s]).into(),
            Disc::new(a, b, r + s, T::ZERO).into(),
            Disc::new(a, b, r + s, s).into(),
            Tube::new(a, b, h, [r, s]).into(),
            Torus::solid(a, b, r + s, s).into(),
            Torus::container(a, b, r + s, s).into(),
            Hull::new([a, b, c, [r, s, h], [h, r, s]]).into(),
            Revolved::thin(a, b, [[r, s], [s, h], [h, r]]).into(),
            Revolved::solid(a, b, [[r, s], [s, h], [h, r]]).into(),
            Revolved::container(a, b, [[T::ZERO, s], [s, h], [h, r]]).into(),
            Cone::endless_solid(a, b, r).into(),
        ];
        let (center, velocity) = (vector(&mut random).into(), vector(&mut random).into());
        let (field, radius) = (vector(&mut random).into(), random.magnitude::<T>(-6, 6).abs());
        for feature in shapes.iter().flat_map(|shape| shape.features()) {
            for field in [None, Some(field), Some(Vec3::ZERO)] {
                for is_leaving in [false, true] {
                    let time = feature.contact_time(center, velocity, field, radius, is_leaving);
                    let is_time = time.is_none_or(|time| time >= T::ZERO && time.is_finite());
                    assert!(is_time, "{time:?}: {feature:?} {center:?} {velocity:?} {field:?}");
                }
            }
        }
    }
}

#[test]
fn inputs_of_any_size_end_in_a_time_or_none() {
    wild_inputs::<f32>();
    wild_inputs::<f64>();
}
