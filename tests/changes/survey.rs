//! What is beside what, and what is in the way of a ray.

use carom::engine::{Compiled, Execution, Partner, Stepped, Touched, World};
use carom::scene::{EngineKind, Impact};
use carom::space::{PeriodicBox, Space};
use carom::surroundings::{
    Capsule, Cone, Cuboid, Cylinder, Disc, Feature, Heightfield, Hull, Sensor, Shape, Torus,
    Triangle, Tube,
};
use carom::{FixedSphere, Plane, Scene, Sphere, Vec3};

use super::common::numbers::noise;
use super::{BOX, FLUID, scene, tell};

/// All pairs one by one.
fn beside<T: Compiled>(world: &World<T>, gap: T) -> Vec<(u32, Touched, T)> {
    let (bodies, scene) = (world.bodies(), world.scene());
    let mut pairs = Vec::new();
    for a in 0..bodies.len() {
        let (center, radius) = (bodies.position_of(a), bodies.radius.of(a));
        for (part, shape) in (0..).zip(&scene.surroundings) {
            let gaps = shape.features().into_iter().map(|it| it.clearance(center, radius).gap);
            if let Some(least) = gaps.reduce(T::lesser).filter(|least| *least <= gap) {
                pairs.push((a as u32, Touched::Part(part), least));
            }
        }
        for b in a + 1..bodies.len() {
            let offset = center - bodies.position_of(b);
            let offset = scene.periodic.map_or(offset, |space| space.nearest(offset));
            let apart = offset.length() - (radius + bodies.radius.of(b));
            if apart <= gap {
                pairs.push((a as u32, Touched::Body(b as u32), apart));
            }
        }
    }
    pairs
}

fn check_contacts<T: Compiled>(text: &str) {
    for engine in [EngineKind::EventDriven, EngineKind::Stepped] {
        let mut world = World::new(scene::<T>(text, engine), Execution::default()).unwrap();
        let mut found = 0;
        for _ in 0..5 {
            tell(&mut world, 0.25);
            for gap in [-0.01, 0.0, 0.0625, 0.5].map(T::from_f64) {
                let contacts = world.contacts(gap);
                let pairs = contacts.iter().map(|it| (it.a, it.partner, it.gap));
                assert_eq!(pairs.collect::<Vec<_>>(), beside(&world, gap), "{engine:?}");
                found += contacts.len();
                for contact in contacts {
                    assert!((contact.normal.length().to_f64() - 1.0).abs() < 1e-5);
                    let center = world.bodies().position_of(contact.a as usize);
                    let way = (center - contact.point).dot(contact.normal).to_f64();
                    let radius = world.bodies().radius.of(contact.a as usize).to_f64();
                    assert!((way - radius - 0.5 * contact.gap.to_f64()).abs() < 1e-5);
                }
            }
            assert!(world.contacts(T::from_f64(f64::NAN)).is_empty());
        }
        assert!(found > 100, "{engine:?}: {found}");
    }
}

#[test]
fn all_that_is_beside_each_other() {
    check_contacts::<f64>(BOX);
    check_contacts::<f32>(BOX);
    check_contacts::<f64>(FLUID);
}

#[test]
fn what_collides_is_in_contact() {
    // Just after each event.
    let mut world =
        World::new(scene::<f64>(BOX, EngineKind::EventDriven), Execution::default()).unwrap();
    let mut met = 0;
    for _ in 0..200 {
        let World::EventDriven(engine) = &mut world else { unreachable!() };
        let mut pair = None;
        let mut note = |event: &carom::Event<f64>| pair = Some((event.a, of(&event.partner)));
        engine.advance_to(10.0, 1, Some(&mut note)).unwrap();
        let now: Vec<_> = world.contacts(1e-12).iter().map(|it| (it.a, it.partner)).collect();
        assert!(now.contains(&pair.unwrap()), "{pair:?}: {now:?}");
        assert!(now.len() < 4);
        met += 1;
    }
    assert_eq!(met, 200);
    // At the end of each step.
    let file = format!("stepped.impact = \"end-of-step\"\n{BOX}");
    let scene = scene::<f64>(&file, EngineKind::Stepped);
    let mut world = Stepped::new(scene.clone()).unwrap();
    let mut other = Stepped::new(scene).unwrap();
    assert_eq!(world.scene().stepped.impact, Impact::EndOfStep);
    let mut met = 0;
    for _ in 0..300 {
        let pairs = world.step_with_contacts();
        let mut expected = Vec::new();
        other.take_steps(1, Some(&mut |event| expected.push((event.a, of(&event.partner)))));
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(pairs, expected);
        let now: Vec<_> =
            world.survey().contacts(1e-12).iter().map(|it| (it.a, it.partner)).collect();
        assert!(pairs.iter().all(|pair| now.contains(pair)), "{pairs:?}: {now:?}");
        met += pairs.len();
    }
    assert_eq!(world.bodies(), other.bodies());
    assert!(met > 50, "{met}");
}

fn of(partner: &Partner<f64>) -> Touched {
    match partner {
        Partner::Surroundings(part) => Touched::Part(*part),
        Partner::Body { index, .. } => Touched::Body(*index),
        _ => unreachable!(),
    }
}

/// The distance between a point and the surface of a shape.
fn gap<T: Compiled>(features: &[Feature<T>], place: Vec3<T>) -> f64 {
    let gaps = features.iter().map(|it| it.clearance(place, T::ZERO).gap.to_f64());
    gaps.fold(f64::INFINITY, f64::min)
}

/// Along a ray from point to point, each as far as there is nothing for certain; `None` if
/// it comes to no end.
fn marched<T: Compiled>(
    features: &[Feature<T>],
    origin: Vec3<T>,
    direction: Vec3<T>,
    near: f64,
) -> Option<Option<f64>> {
    let mut way = 0.0;
    for _ in 0..2000 {
        let gap = gap(features, origin + direction * T::from_f64(way));
        if gap < near {
            return Some(Some(way));
        }
        way += gap;
        if way > 100.0 {
            return Some(None);
        }
    }
    None
}

/// A world of one part, and of one small ball out of the way.
fn alone<T: Compiled>(shape: &Shape<T>, home: [f64; 3]) -> World<T> {
    let scene = Scene::<T>::builder()
        .engine(EngineKind::EventDriven)
        .surroundings(shape.clone())
        .sphere(Sphere::new(home).radius(1e-3))
        .build()
        .unwrap();
    World::new(scene, Execution::default()).unwrap()
}

/// Shapes about the origin: what is solid or thin, and what is hollow.
fn shapes<T: Compiled>() -> [Vec<Shape<T>>; 2] {
    let t = T::from_f64;
    let v = |point: [f64; 3]| point.map(t);
    let (o, axis) = (v([0.0; 3]), v([0.3, -0.4, 0.8]));
    let heights: Vec<T> = (0..64).map(|k| t(f64::from(k * k % 7) * 0.25 - 0.5)).collect();
    let corners = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let outer = vec![
        Plane::new(v([0.0, 0.0, -1.5]), v([0.1, 0.2, 1.0])).into(),
        Cuboid::solid(v([-1.0, -0.5, -1.5]), v([1.0, 0.75, 0.5])).into(),
        FixedSphere::solid(o, t(1.25)).into(),
        Triangle::new(v([-1.5, -1.0, 0.0]), v([1.5, -1.0, 0.5]), v([0.0, 1.5, 1.0])).into(),
        Hull::new(corners.map(v)).into(),
        Heightfield::new(v([-2.0, -2.0, 0.0]), [t(0.5), t(0.5)], 8, &heights).unwrap().into(),
        Capsule::solid(v([-1.0, 0.0, 0.0]), v([1.0, 0.5, 0.5]), t(0.5)).into(),
        Cylinder::solid(o, axis, t(0.75), Some(t(2.0))).into(),
        Cylinder::solid(o, axis, t(0.75), None).into(),
        Cone::solid(o, axis, t(1.5), [t(1.0), t(0.25)]).into(),
        Disc::new(o, axis, t(1.5), T::ZERO).into(),
        Disc::new(o, axis, t(1.5), t(0.5)).into(),
        Torus::solid(o, axis, t(1.25), t(0.5)).into(),
        Tube::new(o, axis, t(1.0), [t(0.75), t(0.5)]).into(),
    ];
    let inner = vec![
        Cuboid::container(v([-2.0; 3]), v([2.0, 2.5, 3.0])).into(),
        FixedSphere::container(o, t(2.5)).into(),
        Capsule::container(v([-1.0, 0.0, 0.0]), v([1.0, 0.5, 0.5]), t(2.0)).into(),
        Cylinder::container(o, axis, t(2.0), Some(t(4.0))).into(),
        Cylinder::container(o, axis, t(2.0), None).into(),
    ];
    [outer, inner]
}

/// The first hit of rays from all around, against the march; nothing else is as far off as
/// rounding.
fn check_rays<T: Compiled>(tolerance: f64) {
    let mut noise = noise(21);
    for (group, size) in shapes::<T>().into_iter().zip([8.0, 2.0]) {
        let home = if size > 4.0 { [30.0, 30.0, 30.0] } else { [0.25; 3] };
        for shape in group {
            let world = alone(&shape, home);
            let survey = world.survey();
            let features = shape.features();
            assert!(!features.is_empty());
            let (mut hits, mut misses, mut turned) = (0, 0, 0);
            for _ in 0..400 {
                let mut place = || Vec3::from([(); 3].map(|()| T::from_f64(noise() - 0.5)));
                let origin = place() * T::from_f64(size);
                // To somewhere about the shape.
                let direction = place() * T::from_f64(3.0) - origin;
                let direction = direction * (T::ONE / direction.length());
                if gap(&features, origin) <= 0.01 {
                    continue;
                }
                let near = 0.01 * tolerance;
                let Some(expected) = marched(&features, origin, direction, near) else { continue };
                let hit = survey.ray(origin, direction, T::from_f64(100.0));
                let hit = hit.filter(|hit| hit.what == Touched::Part(0));
                let name = format!("{shape:?} {origin:?} {direction:?} {hit:?} {expected:?}");
                let (Some(hit), Some(expected)) = (hit, expected) else {
                    assert!(hit.is_none() == expected.is_none(), "{name}");
                    misses += 1;
                    continue;
                };
                hits += 1;
                let slope = -hit.normal.dot(direction).to_f64();
                assert!(slope > -1e-3, "{name}");
                // The march ends where it is near, before the surface by that over the slope.
                let off = (hit.distance.to_f64() - expected).abs();
                assert!(off <= tolerance / slope.max(0.02), "{off} {slope} {name}");
                assert!(gap(&features, hit.point).abs() < tolerance, "{name}");
                assert!((hit.normal.length().to_f64() - 1.0).abs() < 1e-5, "{name}");
                // Straight above the point is what is nearest to it.
                let above = 1e-2;
                let height = gap(&features, hit.point + hit.normal * T::from_f64(above));
                turned += usize::from((height - above).abs() > 10.0 * tolerance);
                // Up to the distance and no farther.
                let short = hit.distance * T::from_f64(0.999);
                assert!(survey.ray(origin, direction, short).is_none(), "{name}");
            }
            assert!(hits > 50, "{shape:?}: {hits} {misses}");
            // But for a few in corners.
            assert!(turned * 20 <= hits, "{shape:?}: {turned} of {hits}");
        }
    }
}

#[test]
fn rays_meet_every_shape() {
    check_rays::<f64>(1e-8);
    check_rays::<f32>(1e-3);
}

#[test]
fn the_nearest_of_bodies_and_parts() {
    let scene = Scene::<f64>::builder()
        .surroundings(Sensor::new(Plane::new([0.0, 0.0, 5.0], [0.0, 0.0, 1.0])))
        .surroundings(Plane::new([0.0; 3], [0.0, 0.0, 1.0]))
        .surroundings(FixedSphere::solid([4.0, 0.0, 2.0], 1.0))
        .sphere(Sphere::new([0.0, 0.0, 2.0]).radius(0.5))
        .build()
        .unwrap();
    let world = World::new(scene, Execution::default()).unwrap();
    let survey = world.survey();
    let ray = |origin: [f64; 3], direction: [f64; 3]| {
        survey.ray(origin, direction, f64::INFINITY).map(|hit| (hit.what, hit.distance))
    };
    // Through the sensor, which is nothing.
    let down = [0.0, 0.0, -2.0];
    assert_eq!(ray([0.0, 0.0, 9.0], down), Some((Touched::Body(0), 6.5)));
    assert_eq!(ray([2.0, 0.0, 9.0], down), Some((Touched::Part(1), 9.0)));
    assert_eq!(ray([4.0, 0.0, 9.0], down), Some((Touched::Part(2), 6.0)));
    assert_eq!(ray([-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]), Some((Touched::Body(0), 2.5)));
    assert_eq!(ray([2.0, 0.0, 2.0], [1.0, 0.0, 0.0]), Some((Touched::Part(2), 1.0)));
    assert_eq!(ray([2.0, 0.0, 9.0], [0.0, 0.0, 1.0]), None);
    assert_eq!(ray([2.0, 0.0, 9.0], [0.0; 3]), None);
    // Inside.
    assert_eq!(ray([4.5, 0.0, 2.0], [1.0, 0.0, 0.0]), Some((Touched::Part(2), 0.0)));
    assert_eq!(ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]), Some((Touched::Part(1), 0.0)));
}

#[test]
fn rays_go_through_the_faces_of_a_periodic_box() {
    let scene = Scene::<f64>::builder()
        .periodic(PeriodicBox::new([0.0; 3], [10.0; 3]))
        .surroundings(FixedSphere::solid([5.0; 3], 1.0))
        .sphere(Sphere::new([5.0, 2.0, 5.0]).radius(0.5))
        .build()
        .unwrap();
    let world = World::new(scene, Execution::default()).unwrap();
    let survey = world.survey();
    let hit = survey.ray([8.0, 5.0, 5.0], [1.0, 0.0, 0.0], 100.0).unwrap();
    assert_eq!((hit.what, hit.distance, hit.point.x), (Touched::Part(0), 6.0, 14.0));
    assert_eq!(hit.normal.to_array(), [-1.0, 0.0, 0.0]);
    let hit = survey.ray([5.0, 8.0, 5.0], [0.0, 1.0, 0.0], 100.0).unwrap();
    assert_eq!((hit.what, hit.distance), (Touched::Body(0), 3.5));
    // Slantwise to an image two boxes on.
    let way = Vec3::new(20.0, 10.0, 0.0);
    let hit = survey.ray([5.0, 5.0, 8.0], [0.0, 0.0, 1.0], 100.0).unwrap();
    assert_eq!(hit.distance, 6.0);
    let origin = Vec3::new(5.0, 5.0, 5.0) + way * (1.0625 / way.length());
    let hit = survey.ray(origin, way, 100.0).unwrap();
    assert_eq!(hit.what, Touched::Part(0));
    assert!((hit.distance - (way.length() - 2.0625)).abs() < 1e-12, "{hit:?}");
    assert!(survey.ray(origin, way, f64::INFINITY).is_none());
}
