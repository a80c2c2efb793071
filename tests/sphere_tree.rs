//! What is where, as a look at all spheres and images finds it.

use carom::bodies::Bodies;
use carom::real::Real;
use carom::space::{PeriodicBox, SphereTree};
use carom::vec3::Vec3;

/// Numbers from 0 to 1 without an order.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// How far along a ray a sphere is, by the roots of `t² + 2bt + c = 0`.
fn meets(start: Vec3<f64>, unit: Vec3<f64>, center: Vec3<f64>, radius: f64) -> Option<f64> {
    let offset = start - center;
    let (b, c) = (offset.dot(unit), offset.length_squared() - radius * radius);
    let square = b * b - c;
    match () {
        () if c <= 0.0 => Some(0.0),
        () if square < 0.0 || b > 0.0 => None,
        () => Some(-b - square.sqrt()),
    }
}

/// Spheres of very different sizes in a box of side 10, from -5 on.
fn spheres<T: Real>(noise: &mut impl FnMut() -> f64, count: usize) -> Bodies<T> {
    let place =
        |noise: &mut dyn FnMut() -> f64| [(); 3].map(|()| T::from_f64(10.0 * noise() - 5.0));
    let centers: Vec<[T; 3]> = (0..count).map(|_| place(noise)).collect();
    let radii: Vec<T> = (0..count).map(|_| T::from_f64(2.0 * noise().powi(4) + 0.01)).collect();
    Bodies::from_positions(&centers).radii(&radii).build().unwrap()
}

/// The centres of all images around, with their numbers.
fn images<T: Real>(bodies: &Bodies<T>, periodic: bool, reach: i32) -> Vec<(usize, Vec3<f64>)> {
    let reach = if periodic { reach } else { 0 };
    let mut all = Vec::new();
    for body in 0..bodies.len() {
        for x in -reach..=reach {
            for y in -reach..=reach {
                for z in -reach..=reach {
                    let shift = Vec3::new(f64::from(x), f64::from(y), f64::from(z)) * 10.0;
                    all.push((body, bodies.position_of(body).cast::<f64>() + shift));
                }
            }
        }
    }
    all
}

/// As a look at all images finds them, but for what rounding decides.
fn agrees<T: Real>() {
    let near = 1e3 * T::EPSILON.to_f64();
    let mut noise = noise();
    let (mut found, mut hits) = (0, 0);
    for trial in 0..60 {
        let is_periodic = trial % 2 == 0;
        let bodies = spheres::<T>(&mut noise, [1, 7, 200][trial % 3]);
        let space = PeriodicBox::new([T::from_f64(-5.0); 3], [T::from_f64(5.0); 3]);
        let tree = SphereTree::new(&bodies, is_periodic.then_some(space));
        let images = images(&bodies, is_periodic, 3);
        let radius = |body: usize| bodies.radius.of(body).to_f64();
        let place = [(); 3].map(|()| 12.0 * noise() - 6.0);
        let (point, reach) = (Vec3::from(place), 4.0 * noise());
        let (asked, asked_reach) = (point.cast::<T>(), T::from_f64(reach));

        // Numbers that must be there, and those that may.
        let check = |got: &[u32], beyond: &dyn Fn(usize, Vec3<f64>) -> f64| {
            assert!(got.is_sorted_by(|a, b| a < b));
            for body in 0..bodies.len() {
                let own = images.iter().filter(|(number, _)| *number == body);
                let beyond = own.map(|(_, at)| beyond(body, *at)).fold(f64::INFINITY, f64::min);
                let is_there = got.contains(&(body as u32));
                assert!(is_there || beyond > -near, "{trial}: {body} by {beyond}");
                assert!(!is_there || beyond < near, "{trial}: {body} by {beyond}");
            }
            got.len()
        };
        found += check(&tree.in_sphere(asked, asked_reach), &|body, at| {
            (at - point).length() - radius(body) - reach
        });
        let half = Vec3::new(reach, 0.5 * reach, 0.1);
        let corners = [point - half, point + half].map(|corner| corner.cast::<T>());
        found += check(&tree.in_box(corners[0], corners[1]), &|body, at| {
            let (way, half) = ((at - point).to_array(), half.to_array());
            let beyond = |axis: usize| (way[axis].abs() - half[axis]).max(0.0);
            Vec3::new(beyond(0), beyond(1), beyond(2)).length() - radius(body)
        });

        let count = 1 + trial % 9;
        let far = |body: usize| {
            let own = images.iter().filter(|(number, _)| *number == body);
            own.map(|(_, at)| (*at - point).length() - radius(body)).fold(f64::INFINITY, f64::min)
        };
        let mut all: Vec<f64> = (0..bodies.len()).map(far).collect();
        all.sort_by(f64::total_cmp);
        let got = tree.nearest(asked, count);
        assert_eq!(got.len(), count.min(bodies.len()));
        for (number, expected) in got.iter().zip(all) {
            assert!((far(*number as usize) - expected).abs() < near, "{trial}");
        }

        let direction = Vec3::from([(); 3].map(|()| noise() - 0.5));
        let unit = direction * (1.0 / direction.length());
        let longest = 14.0;
        let first = images
            .iter()
            .filter_map(|(body, at)| meets(point, unit, *at, radius(*body)))
            .fold(f64::INFINITY, f64::min);
        let hit = tree.ray(asked, (direction * 1e3).cast::<T>(), T::from_f64(longest));
        match hit {
            None => assert!(first > longest - near, "{trial}: {first}"),
            Some(hit) => {
                hits += 1;
                // Where it grazes, a rounding is a long way.
                let distance = hit.distance.to_f64();
                assert!((distance - first).abs() < near.sqrt(), "{trial}: {distance} {first}");
                let at = (hit.point.cast::<f64>() - point - unit * distance).length();
                assert!(at < near.sqrt());
                let is_outwards = hit.normal.cast::<f64>().dot(unit) < near.sqrt();
                assert!(is_outwards || distance == 0.0);
            }
        }
    }
    assert!(found > 300 && hits > 10, "{found} {hits}");
}

#[test]
fn finds_what_a_look_at_all_finds() {
    agrees::<f64>();
    agrees::<f32>();
}

#[test]
fn what_is_no_question_has_no_answer() {
    let ball = Bodies::from_positions(&[[0.0_f64; 3]]).radius(1.0).build().unwrap();
    let tree = SphereTree::new(&ball, None);
    assert_eq!(tree.ray([5.0, 0.0, 0.0], [0.0; 3], 9.0), None);
    assert_eq!(tree.ray([5.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], 9.0), None);
    assert_eq!(tree.ray([5.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 3.0), None);
    let far = tree.ray([1e9, 0.0, 0.0], [-1e-300, 0.0, 0.0], f64::INFINITY).unwrap();
    assert_eq!((far.distance, far.point.x), (1e9 - 1.0, 1.0));
    let inside = tree.ray([0.5, 0.0, 0.0], [0.0, 1.0, 0.0], 3.0).unwrap();
    assert_eq!((inside.distance, inside.normal.x), (0.0, 1.0));
    assert_eq!(tree.nearest([1e12, 0.0, 0.0], 3), [0]);
    assert_eq!(tree.nearest([0.0; 3], 0), [0_u32; 0]);
    let space = PeriodicBox::new([-5.0; 3], [5.0; 3]);
    let periodic = SphereTree::new(&ball, Some(space));
    let aside = [0.0, 3.0, 0.0];
    assert_eq!(periodic.ray(aside, [1.0, 0.0, 0.0], f64::INFINITY), None);
    assert_eq!(periodic.ray(aside, [1.0, 0.0, 0.0], 1e5), None);
    let image = periodic.ray([2.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1e5).unwrap();
    assert_eq!((image.distance, image.point.x), (7.0, 9.0));
    let none = SphereTree::new(&ball.only(&[]), None);
    assert_eq!(none.nearest([0.0; 3], 2), [0_u32; 0]);
    assert_eq!(none.in_sphere([0.0; 3], 2.0), [0_u32; 0]);
}
