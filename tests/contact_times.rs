//! Contact times with fixed features: against dense sampling of the gap, against
//! more digits, and in the cases where rounding decides.

mod common;

use carom::DoubleDouble;
use carom::real::Real;
use carom::surroundings::{Cuboid, Feature, FixedSphere, Plane};
use carom::vec3::Vec3;
use common::numbers::Random;

/// A sphere in free flight, in numbers that every precision has.
#[derive(Clone, Copy, Debug)]
struct Flight {
    center: [f64; 3],
    velocity: [f64; 3],
    acceleration: Option<[f64; 3]>,
    radius: f64,
}

impl Flight {
    fn contact_time<T: Real>(&self, feature: &Scenery, is_leaving: bool) -> Option<T> {
        feature.feature::<T>().contact_time(
            vector(self.center),
            vector(self.velocity),
            self.acceleration.map(vector),
            T::from_f64(self.radius),
            is_leaving,
        )
    }

    fn center_at<T: Real>(&self, time: T) -> Vec3<T> {
        let acceleration = vector(self.acceleration.unwrap_or([0.0; 3]));
        vector::<T>(self.center)
            + (vector::<T>(self.velocity) + acceleration * (T::ratio(1, 2) * time)) * time
    }

    fn velocity_at<T: Real>(&self, time: T) -> Vec3<T> {
        vector::<T>(self.velocity) + vector::<T>(self.acceleration.unwrap_or([0.0; 3])) * time
    }

    fn gap<T: Real>(&self, feature: &Scenery, time: T) -> T {
        feature.feature::<T>().clearance(self.center_at(time), T::from_f64(self.radius)).gap
    }

    /// How fast the gap closes.
    fn closing(&self, feature: &Scenery, time: f64) -> f64 {
        let feature = feature.feature::<f64>();
        // With a radius, the arm of a point has no direction.
        let arm = feature.clearance(self.center_at(time), self.radius.max(1e-3)).arm;
        -self.velocity_at(time).dot(arm) / arm.length()
    }
}

fn vector<T: Real>(components: [f64; 3]) -> Vec3<T> {
    components.map(T::from_f64).into()
}

/// A feature, in numbers that every precision has.
#[derive(Clone, Copy, Debug)]
enum Scenery {
    Plane([f64; 3], [f64; 3]),
    Cuboid([f64; 3], [f64; 3]),
    Ball([f64; 3], f64),
    Hollow([f64; 3], f64),
}

impl Scenery {
    fn feature<T: Real>(&self) -> Feature<T> {
        let vector = |components: [f64; 3]| components.map(T::from_f64);
        match *self {
            Self::Plane(point, normal) => Feature::Plane(Plane::new(vector(point), vector(normal))),
            Self::Cuboid(lower, upper) => {
                Feature::Cuboid(Cuboid::solid(vector(lower), vector(upper)))
            }
            Self::Ball(center, radius) => {
                Feature::FixedSphere(FixedSphere::solid(vector(center), T::from_f64(radius)))
            }
            Self::Hollow(center, radius) => {
                Feature::FixedSphere(FixedSphere::container(vector(center), T::from_f64(radius)))
            }
        }
    }
}

/// To the digits of `f32`, so that it is the same number in every precision.
fn short(value: f64) -> f64 {
    f64::from(value as f32)
}

fn random_vector(random: &mut Random, size: f64) -> [f64; 3] {
    random.vector::<f64>().to_array().map(|component| short(component * size))
}

/// A random feature and a flight that begins clear of it.
fn random_case(random: &mut Random) -> (Scenery, Flight) {
    loop {
        let size = short(random.unit::<f64>().abs() + 0.2);
        let place = random_vector(random, 1.0);
        let scenery = match random.bits() % 5 {
            0 => {
                // Along an axis, so that its normal is the same in every precision.
                let mut normal = [0.0; 3];
                normal[(random.bits() % 3) as usize] = random.unit::<f64>().signum();
                Scenery::Plane(place, normal)
            }
            1 | 2 => {
                let sides = random_vector(random, 1.0).map(|side| side.abs() + 0.05);
                Scenery::Cuboid(place, core::array::from_fn(|k| short(place[k] + sides[k])))
            }
            3 => Scenery::Ball(place, size),
            _ => Scenery::Hollow(place, size),
        };
        let far = [1.5, 3.0, 20.0][(random.bits() % 3) as usize];
        let around = random_vector(random, far);
        let center = match scenery {
            // Inside.
            Scenery::Hollow(..) => {
                core::array::from_fn(|k| short(place[k] + 0.2 * around[k] / far))
            }
            _ => around,
        };
        let speed = [0.0, 0.1, 1.0, 5.0][(random.bits() % 4) as usize];
        // Aimed near the feature, or not.
        let target = random_vector(random, 0.6);
        let velocity = if random.bits().is_multiple_of(2) {
            random_vector(random, speed)
        } else {
            core::array::from_fn(|k| short(speed * (place[k] + target[k] - center[k]) / far))
        };
        let acceleration = match random.bits() % 4 {
            0 => None,
            1 => Some([0.0, 0.0, -1.0]),
            2 => Some(random_vector(random, 1.0)),
            // Along the path.
            _ => Some(velocity.map(|component| -0.5 * component)),
        };
        let radius = [0.0, short(0.3 * random.unit::<f64>().abs())][(random.bits() % 2) as usize];
        let flight = Flight { center, velocity, acceleration, radius };
        if flight.gap(&scenery, 0.0) > 1e-3 {
            return (scenery, flight);
        }
    }
}

#[test]
fn contacts_are_where_the_gap_first_closes() {
    let mut random = Random(1);
    let (mut contacts, mut worst) = (0, 0.0_f64);
    for _ in 0..50_000 {
        let (scenery, flight) = random_case(&mut random);
        let found = flight.contact_time::<f64>(&scenery, false);
        if let Some(time) = found {
            contacts += 1;
            assert!(time >= 0.0);
            let size = flight.center_at::<f64>(time).length() + 3.0;
            let gap = flight.gap(&scenery, time).abs() / size;
            worst = worst.max(gap);
            assert!(gap < 1e-14, "gap {gap:e} at {time}: {scenery:?} {flight:?}");
            assert!(
                flight.closing(&scenery, time) > -1e-6,
                "opens at {time}: {scenery:?} {flight:?}"
            );
        }
        // As far as the sphere can come back from.
        let until = found.unwrap_or(60.0);
        let samples = 500;
        for k in 0..samples {
            let time = until * f64::from(k) / f64::from(samples);
            let gap = flight.gap(&scenery, time);
            assert!(gap > -1e-11, "gap {gap:e} at {time} before {found:?}: {scenery:?} {flight:?}");
        }
    }
    println!("{contacts} contacts, gap within {worst:e} of the distances");
    assert!(contacts > 6000);
}

/// The greatest error against more digits, in epsilon of what the inputs'
/// rounding is worth: the distances by the closing velocity, and the time.
fn worst_error<T: Real>(seed: u64) -> f64 {
    let mut random = Random(seed);
    let epsilon = T::EPSILON.to_f64();
    let mut worst = 0.0_f64;
    for _ in 0..30_000 {
        let (scenery, flight) = random_case(&mut random);
        let expected = flight.contact_time::<DoubleDouble>(&scenery, false);
        let found = flight.contact_time::<T>(&scenery, false);
        let (Some(expected), Some(found)) = (expected, found) else {
            let time = expected.map(T::from_double).or(found);
            if let Some(time) = time {
                // Only what hardly touches may be missed or found.
                let depth = deepest(&scenery, &flight, time.to_f64());
                assert!(
                    depth < 30.0 * epsilon * vector::<f64>(flight.center).length().max(1.0),
                    "{expected:?} {found:?} depth {depth:e}: {scenery:?} {flight:?}"
                );
            }
            continue;
        };
        let closing = flight.closing(&scenery, expected.to_f64());
        let [c, v, a] = [
            vector::<f64>(flight.center).length() + 2.0,
            vector::<f64>(flight.velocity).length(),
            vector::<f64>(flight.acceleration.unwrap_or([0.0; 3])).length(),
        ];
        let time = expected.to_f64();
        let distances = c + v * time + 0.5 * a * time * time;
        if closing < epsilon.sqrt() * 30.0 * (v + a * time) {
            continue; // A graze: neither here nor there.
        }
        let error = (found.to_f64() - time).abs() / (epsilon * (distances / closing + time));
        assert!(error < 30.0, "{error} ε: {expected:?} {found}: {scenery:?} {flight:?}");
        worst = worst.max(error);
    }
    worst
}

trait FromDouble {
    fn from_double(value: DoubleDouble) -> Self;
}

impl<T: Real> FromDouble for T {
    fn from_double(value: DoubleDouble) -> Self {
        T::from_f64(value.to_f64())
    }
}

/// The greatest overlap soon after a time.
fn deepest(scenery: &Scenery, flight: &Flight, time: f64) -> f64 {
    (0..2000)
        .map(|k| -flight.gap(scenery, time + 1e-3 * f64::from(k)))
        .take_while(|&depth| depth > -1e-3)
        .fold(0.0, f64::max)
}

#[test]
fn times_are_right_to_a_few_epsilon() {
    let single = worst_error::<f32>(2);
    let double = worst_error::<f64>(2);
    println!("worst error: f32 {single:.2} ε, f64 {double:.2} ε");
    assert!(single < 8.0 && double < 8.0, "f32 {single}, f64 {double}");
}

/// Bounces a sphere off a feature, as an engine does, and returns the least gap
/// on the way, in epsilon.
fn bounce<T: Real>(scenery: &Scenery, flight: &Flight, bounces: usize) -> f64 {
    let feature = scenery.feature::<T>();
    let half = T::ratio(1, 2);
    let mut center = vector::<T>(flight.center);
    let mut velocity = vector::<T>(flight.velocity);
    let acceleration = flight.acceleration.map(vector::<T>);
    let pull = acceleration.unwrap_or(Vec3::ZERO);
    let radius = T::from_f64(flight.radius);
    let mut least = 0.0_f64;
    let mut is_leaving = false;
    for bounce in 0..bounces {
        let Some(time) = feature.contact_time(center, velocity, acceleration, radius, is_leaving)
        else {
            break;
        };
        assert!(
            bounce == 0 || time > T::ZERO,
            "no time after bounce {bounce}: {scenery:?} {flight:?} {center:?} {velocity:?}"
        );
        let at = |time: T| center + (velocity + pull * (half * time)) * time;
        for k in 0..=64 {
            let center = at(time * T::ratio(k, 64));
            let size = 1.0 + center.length().to_f64();
            let gap = feature.clearance(center, radius).gap.to_f64();
            least = least.min(gap / size / T::EPSILON.to_f64());
        }
        (center, velocity) = (at(time), velocity + pull * time);
        let arm = feature.clearance(center, radius).arm;
        let along = velocity.dot(arm);
        if along < T::ZERO {
            velocity -= arm * ((along + along) / arm.length_squared());
        }
        is_leaving = true;
    }
    least
}

fn bounces_stay_outside<T: Real>() -> f64 {
    let mut random = Random(3);
    let mut least = 0.0_f64;
    for _ in 0..3000 {
        let (scenery, mut flight) = random_case(&mut random);
        // The arm of a point has no direction.
        flight.radius = flight.radius.max(1.0 / 64.0);
        if flight.gap(&scenery, 0.0) > 0.0 {
            least = least.min(bounce::<T>(&scenery, &flight, 30));
        }
    }
    least
}

#[test]
fn bouncing_spheres_never_sink_in_nor_stand_still() {
    let single = bounces_stay_outside::<f32>();
    let double = bounces_stay_outside::<f64>();
    println!("least gap: f32 {single:.1} ε, f64 {double:.1} ε");
    assert!(single > -64.0 && double > -64.0);
}

/// Down onto the top of every shape, and up from a hollow's bottom.
fn scenes_below() -> [(Scenery, [f64; 3]); 7] {
    let cuboid = Scenery::Cuboid([-2.0, -2.0, -3.0], [2.0, 2.0, 0.0]);
    let down = core::f64::consts::FRAC_1_SQRT_2;
    [
        (Scenery::Plane([0.0; 3], [0.0, 0.0, 1.0]), [0.3, 0.7, 0.5]),
        (cuboid, [0.3, 0.7, 0.5]),
        // At the very end of the face.
        (cuboid, [2.0, 2.0, 0.5]),
        // Over an edge, where the sphere slides off.
        (cuboid, [2.0 + 0.5 * down, 0.0, 0.5 * down]),
        (Scenery::Ball([0.0, 0.0, -3.0], 3.0), [0.0, 0.0, 0.5]),
        (Scenery::Ball([0.0, 0.0, -3.0], 3.0), [3.5 * down, 0.0, 3.5 * down - 3.0]),
        (Scenery::Hollow([0.0, 0.0, 3.0], 3.0), [0.0, 0.0, 0.5]),
    ]
}

/// From contact, with overlaps as rounding leaves them, whatever the velocity
/// out of the surface: it comes back later, and never falls in.
fn slow_starts<T: Real>() {
    let mut random = Random(4);
    let epsilon = T::EPSILON.to_f64();
    for (scenery, center) in scenes_below() {
        let feature = scenery.feature::<T>();
        let radius = T::ratio(1, 2);
        // On the surface to the digits of this precision.
        let near = feature.clearance(vector::<T>(center), radius);
        let surface = vector::<T>(center) - near.arm * (near.gap / near.arm.length());
        for _ in 0..300 {
            let rounding: f64 = 4.0 * epsilon * random.unit::<f64>();
            let arm = feature.clearance(surface, radius).arm;
            let normal = arm * (T::ONE / arm.length());
            let start = surface + normal * T::from_f64(rounding);
            let speed: T = random.magnitude(-12, 1);
            let speed = speed.abs();
            let gravity = Vec3::new(T::ZERO, T::ZERO, T::whole(-10));
            for is_leaving in [false, true] {
                let up =
                    feature.contact_time(start, normal * speed, Some(gravity), radius, is_leaving);
                let back = (speed + speed) / -gravity.dot(normal);
                if let Some(time) = up {
                    assert!(time > T::ZERO, "{scenery:?} {start:?} {speed:e}");
                }
                // Straight up on the level: exactly there and back, if it
                // begins at the surface.
                let overlaps = feature.clearance(start, radius).gap <= T::ZERO;
                let is_level = normal.z == T::ONE;
                if is_level && (is_leaving || overlaps) {
                    let error = (up.unwrap() / back - T::ONE).abs().to_f64();
                    assert!(error <= 4.0 * epsilon, "{scenery:?} {speed:e}: {up:?} {back:e}");
                }
                // Straight up and away, never to return.
                let straight =
                    feature.contact_time(start, normal * speed, None, radius, is_leaving);
                assert_eq!(
                    straight.is_some(),
                    matches!(scenery, Scenery::Hollow(..)),
                    "{scenery:?} {start:?} {speed:e} {is_leaving} {straight:?}"
                );
            }
            // Just bounced, and rounding has turned the velocity round.
            let rounded = normal * (-speed * T::EPSILON);
            let again = feature.contact_time(start, rounded, Some(gravity), radius, true);
            assert!(again.is_none_or(|time| time > T::ZERO), "{scenery:?} {start:?}");
            let again = feature.contact_time(start, rounded, None, radius, true);
            assert_eq!(
                again.is_some(),
                matches!(scenery, Scenery::Hollow(..)),
                "{scenery:?} {start:?} {rounded:?} {again:?}"
            );
            // Approaching in contact: now.
            let overlap = surface - normal * (T::whole(4) * T::EPSILON);
            for acceleration in [None, Some(gravity)] {
                let now =
                    feature.contact_time(overlap, -(normal * speed), acceleration, radius, false);
                assert_eq!(now, Some(T::ZERO), "{scenery:?} {speed:e}");
            }
        }
        // At rest under gravity.
        let start = surface;
        let rest = feature.contact_time(start, Vec3::ZERO, Some(gravity_of(10)), radius, true);
        let gap = feature.clearance(start, radius).gap;
        assert!(gap != T::ZERO || rest == Some(T::ZERO), "{scenery:?} {rest:?}");
        assert_eq!(feature.contact_time(start, Vec3::ZERO, None, radius, true), None);
    }
}

fn gravity_of<T: Real>(strength: i32) -> Vec3<T> {
    Vec3::new(T::ZERO, T::ZERO, T::whole(-strength))
}

#[test]
fn a_contact_is_not_found_twice() {
    slow_starts::<f32>();
    slow_starts::<f64>();
    slow_starts::<DoubleDouble>();
}

/// A box from −1 to 1 and spheres that come round its edges.
fn around_a_box<T: Real>() {
    let r = T::ratio;
    let cuboid = Feature::Cuboid(Cuboid::solid([T::whole(-1); 3], [T::ONE; 3]));
    let v = |x: (i32, i32), y: (i32, i32), z: (i32, i32)| {
        Vec3::new(r(x.0, x.1), r(y.0, y.1), r(z.0, z.1))
    };
    let whole = |x, y, z| v((x, 1), (y, 1), (z, 1));
    let straight =
        |center, velocity, radius| cuboid.contact_time(center, velocity, None, radius, false);
    // Faces, to their very ends, and past them.
    assert_eq!(straight(whole(0, 0, 4), whole(0, 0, -2), T::ONE), Some(T::ONE));
    assert_eq!(straight(whole(1, 1, 4), whole(0, 0, -2), T::ONE), Some(T::ONE));
    assert_eq!(straight(whole(1, 1, 4), whole(0, 0, -2), T::ZERO), Some(r(3, 2)));
    assert_eq!(straight(v((3, 2), (0, 1), (4, 1)), whole(0, 0, -2), T::ZERO), None);
    // An edge and a corner, at 3-4-5 and 2-3-6-7.
    let edge = straight(v((8, 5), (1, 3), (4, 1)), whole(0, 0, -1), T::ONE);
    let error = (edge.unwrap() - r(11, 5)).abs();
    assert!(error <= T::whole(2) * T::EPSILON, "{edge:?}");
    let corner = straight(v((9, 7), (10, 7), (4, 1)), whole(0, 0, -1), T::ONE);
    let error = (corner.unwrap() - r(15, 7)).abs();
    assert!(error <= T::whole(4) * T::EPSILON, "{corner:?}");
    // Grazing an edge.
    assert_eq!(straight(v((2, 1), (0, 1), (4, 1)), whole(0, 0, -1), T::ONE), None);
    // Up beside the box, over its top and down on it: the top's height falls
    // through zero once, on the way down. Up to 9, over at t = 2.
    let thrown =
        cuboid.contact_time(whole(-4, 0, -3), whole(2, 0, 10), Some(gravity_of(4)), T::ZERO, false);
    // −3 + 10 t − 2 t² = 1 at t = (5 − √17)/2 = 0.44 outside, and at 4.56
    // outside on the far side.
    assert_eq!(thrown, None);
    let thrown = cuboid.contact_time(
        v((-5, 2), (0, 1), (-3, 1)),
        v((1, 2), (0, 1), (10, 1)),
        Some(gravity_of(4)),
        T::ZERO,
        false,
    );
    let expected = (T::whole(5) + T::whole(17).sqrt()) * r(1, 2);
    let error = (thrown.unwrap() - expected).abs();
    assert!(error <= T::whole(8) * T::EPSILON * expected, "{thrown:?} {expected}");
    // Straight towards an edge of the box, as a point.
    for side in [-1, 1] {
        let found = straight(whole(3, side, 3), whole(-1, 0, -1), T::ZERO);
        let error = (found.unwrap() - T::whole(2)).abs();
        assert!(error <= T::whole(2) * T::EPSILON, "{found:?}");
    }
}

#[test]
fn spheres_come_round_the_edges_of_a_box() {
    around_a_box::<f32>();
    around_a_box::<f64>();
    around_a_box::<DoubleDouble>();
}

/// Points and small spheres aimed at edges and corners, where parts meet.
#[test]
fn no_path_slips_in_between_two_parts() {
    let mut random = Random(5);
    let scenery = Scenery::Cuboid([-0.7, -0.9, -1.1], [0.3, 0.6, 1.3]);
    for _ in 0..20_000 {
        let sides = [[-0.7, 0.3], [-0.9, 0.6], [-1.1, 1.3]];
        // A point of an edge or a corner.
        let mut target = sides.map(|ends| ends[(random.bits() % 2) as usize]);
        if random.bits().is_multiple_of(2) {
            target[(random.bits() % 3) as usize] *= random.unit::<f64>().abs();
        }
        let radius = [0.0, 1e-9, 0.1][(random.bits() % 3) as usize];
        let velocity = random_vector(&mut random, 1.0);
        let center = core::array::from_fn(|k| target[k] - 3.0 * velocity[k]);
        let acceleration = None;
        let flight = Flight { center, velocity, acceleration, radius };
        if flight.gap::<f64>(&scenery, 0.0) <= 0.0 {
            continue;
        }
        let found = flight.contact_time::<f64>(&scenery, false);
        let until = found.unwrap_or(6.0);
        for k in 0..300 {
            let gap = flight.gap(&scenery, until * f64::from(k) / 300.0);
            assert!(gap > -1e-12, "gap {gap:e} before {found:?}: {flight:?}");
        }
    }
}

/// Skipping over a box's top close to its edges and corners, in a field.
fn skips_round_the_edges<T: Real>() -> f64 {
    let mut random = Random(9);
    let scenery = Scenery::Cuboid([-2.0, -2.0, -3.0], [2.0, 2.0, 0.0]);
    let mut least = 0.0_f64;
    for _ in 0..3000 {
        let epsilon = T::EPSILON.to_f64();
        let near: [f64; 2] = core::array::from_fn(|_| random.magnitude::<f64>(-17, 0));
        let rounding = 4.0 * epsilon * random.unit::<f64>();
        let flight = Flight {
            center: [2.0 + near[0], 2.0 * random.unit::<f64>() + near[1], 0.5 + rounding],
            velocity: [
                random.magnitude(-12, 1),
                random.unit(),
                -random.magnitude::<f64>(-12, 1).abs(),
            ],
            acceleration: Some([0.0, 0.0, -10.0]),
            radius: 0.5,
        };
        least = least.min(bounce::<T>(&scenery, &flight, 30));
    }
    least
}

#[test]
fn spheres_skip_round_the_edges_of_a_box() {
    let single = skips_round_the_edges::<f32>();
    let double = skips_round_the_edges::<f64>();
    println!("least gap round edges: f32 {single:.1} ε, f64 {double:.1} ε");
    assert!(single > -64.0 && double > -64.0);
}

/// Inputs over the whole range end in time, and in a time.
fn wild_inputs<T: Real>() {
    let mut random = Random(6);
    for _ in 0..20_000 {
        let mut vector =
            || Vec3::new(random.magnitude(-9, 9), random.magnitude(-9, 9), random.magnitude(-9, 9));
        let (center, velocity, acceleration, place): (Vec3<T>, _, _, Vec3<T>) =
            (vector(), vector(), vector(), vector());
        let radius: T = random.magnitude::<T>(-9, 9).abs();
        let reach: T = random.magnitude::<T>(-9, 9).abs();
        let upper = place + Vec3::new(reach, reach * T::ratio(1, 3), radius);
        let ball = FixedSphere { center: place, radius: reach, inside: false };
        for feature in [
            Feature::Plane(Plane { point: place, normal: Vec3::new(T::ZERO, T::ONE, T::ZERO) }),
            Feature::Cuboid(Cuboid { lower: place, upper, rotation: None, inside: false }),
            Feature::FixedSphere(ball),
            Feature::FixedSphere(FixedSphere { inside: true, radius: reach + radius, ..ball }),
        ] {
            for acceleration in [None, Some(acceleration), Some(Vec3::ZERO)] {
                for is_leaving in [false, true] {
                    let time =
                        feature.contact_time(center, velocity, acceleration, radius, is_leaving);
                    assert!(time.is_none_or(|time| time >= T::ZERO && time.is_finite()));
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

/// Paths whose least gap is known: found if it is negative, else not.
#[test]
fn grazes_are_told_from_misses() {
    let mut random = Random(7);
    let ball = Scenery::Ball([0.0; 3], 0.25);
    let edge = Scenery::Cuboid([-9.0, -9.0, -9.0], [0.0, 0.0, 9.0]);
    for case in 0..20_000 {
        let scenery = [ball, edge][case % 2];
        // The radius that makes 1/2 the distance of the centres.
        let radius = [0.25, 0.5][case % 2];
        let normal = if case % 2 == 0 {
            random.vector::<f64>()
        } else {
            Vec3::new(0.1 + random.unit::<f64>().abs(), 0.1 + random.unit::<f64>().abs(), 0.0)
        };
        let normal = normal * (1.0 / normal.length());
        let along = normal.cross(random.vector());
        let velocity = along * (1.0 / along.length());
        let acceleration = random.vector::<f64>() * [0.0, 0.5][case / 2 % 2];
        let (least, time) = (random.magnitude::<f64>(-14, -4), 0.3);
        let center = normal * (0.5 + least) - (velocity - acceleration * (0.5 * time)) * time;
        let flight = Flight {
            center: center.to_array(),
            velocity: (velocity - acceleration * time).to_array(),
            acceleration: (case / 2 % 2 != 0).then(|| acceleration.to_array()),
            radius,
        };
        // Across an edge the speed may be next to nothing.
        let across = if case % 2 == 0 { 1.0 } else { 1.0 - velocity.z * velocity.z };
        if across < 0.7 {
            continue;
        }
        let found = flight.contact_time::<f64>(&scenery, false);
        let near = found.filter(|found| *found < 0.6);
        assert_eq!(near.is_some(), least < 0.0, "{least:e}: {found:?} {scenery:?} {flight:?}");
        if let Some(near) = near {
            let early = time - near;
            assert!(early > 0.0 && early < (4.0 * -least).sqrt(), "{least:e} {early:e}");
        }
    }
}

/// Small spheres from 10⁴ of their reach away, in a field: multiplied out, the
/// quartic has no digit left in `f32`.
#[test]
fn distance_costs_no_digits() {
    let mut random = Random(8);
    let mut worst = 0.0_f64;
    let scenery = Scenery::Ball([0.0; 3], 0.5);
    for _ in 0..5000 {
        let center = random_vector(&mut random, 10_000.0);
        let time = short(100.0 + 50.0 * random.unit::<f64>());
        let acceleration = random_vector(&mut random, 1.0);
        let aside = random_vector(&mut random, 0.4);
        let velocity = core::array::from_fn(|k| {
            short((aside[k] - center[k]) / time - 0.5 * acceleration[k] * time)
        });
        let acceleration = Some(acceleration);
        let flight = Flight { center, velocity, acceleration, radius: 0.5 };
        let expected = flight.contact_time::<DoubleDouble>(&scenery, false);
        let found = flight.contact_time::<f32>(&scenery, false);
        let Some(expected) = expected.map(|time| time.to_f64()) else {
            continue;
        };
        let closing = flight.closing(&scenery, expected);
        if closing < 30.0 {
            continue;
        }
        let Some(found) = found else {
            panic!("missed at {expected}: {flight:?}");
        };
        let distances = 20_000.0 + vector::<f64>(velocity).length() * expected;
        let error = (f64::from(found) - expected).abs();
        worst = worst.max(error / f64::from(f32::EPSILON) / (distances / closing + expected));
    }
    println!("from afar: {worst:.2} ε (f32)");
    assert!(worst < 4.0);
}
