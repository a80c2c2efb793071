//! Both engines in round containers and about thin parts: exact trajectories, conservation,
//! and nothing that passes through.

use carom::Vec3;
use carom::contact::Surface;
use carom::engine::{Compiled, Execution, World};
use carom::observe::Energy;
use carom::scene::{EngineKind, Impact, Scene, SceneFile, Sphere};
use carom::surroundings::{Capsule, Cone, Cylinder, Disc, FixedSphere, Revolved, Shape, Torus};

const ENGINES: [EngineKind; 2] = [EngineKind::EventDriven, EngineKind::Stepped];

/// A world of one ball in one container.
fn with_ball<T: Compiled>(
    engine: EngineKind,
    dt: f64,
    surface: Surface,
    shape: impl Into<Shape<T>>,
    gravity: [f64; 3],
    ball: Sphere,
) -> World<T> {
    let scene = Scene::<T>::builder()
        .engine(engine)
        .impact(Impact::SubStep)
        .dt(dt)
        .surface(surface)
        .gravity(gravity.map(T::from_f64))
        .surroundings(shape)
        .sphere(ball)
        .build()
        .unwrap();
    World::new(scene, Execution::new().threads(1)).unwrap()
}

/// A rough ball that bounces inside a vertical tube under gravity comes up again: between
/// bounces it turns by `θ` about the axis, and `(v_z, √q rω_φ, √q rω_n)` by `ψ` with a
/// reflection, `sin(ψ/2) = √(q/(1 + q)) sin(θ/2)`. Heights of the map in 40 digits.
#[test]
fn a_rough_ball_in_a_tube_comes_up_again() {
    /// At bounces 1, 2, 60 and 100.
    const HEIGHTS: [(usize, f64); 4] = [
        (1, -0.287_311_058_832_443_7),
        (2, -0.820_888_739_521_179_1),
        (60, -11.815_274_318_421_064),
        (100, -4.918_965_481_116_472),
    ];
    let (radius, speed, theta) = (0.5, 3.0_f64, 0.5_f64);
    for engine in ENGINES {
        let inward = speed * (0.5 * theta).tan();
        let ball = Sphere::new([1.5, 0.0, 0.0])
            .radius(radius)
            .velocity([-inward, speed, 0.0])
            .spin([0.0, 0.0, -speed / radius]);
        let tube = Cylinder::container([0.0; 3], [0.0, 0.0, 1.0], 2.0, None);
        let mut world =
            with_ball::<f64>(engine, 0.01, Surface::Rough, tube, [0.0, 0.0, -10.0], ball);
        let mut heights = Vec::new();
        world.for_each_event(48.0, |event| heights.push(event.point.z)).unwrap();
        assert_eq!(heights.len(), 200, "{engine:?}");
        for (k, exact) in HEIGHTS {
            let found = heights[k - 1];
            let error = (found - exact).abs();
            assert!(error < 1e-10, "{engine:?}: bounce {k} at {found}, not {exact}");
        }
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((lowest + 12.020_233_179_322_03).abs() < 1e-9, "{engine:?}: lowest {lowest}");
    }
}

/// In a cone a smooth ball's distance from the apex of the cone of its centres is that of
/// free flight, through all bounces.
#[test]
fn a_ball_in_a_cone_keeps_the_law_of_the_apex() {
    let radius = 0.3;
    // The apex of the container is r/sin α below that of the centres, at ρ = ¾ z.
    let apex = [0.0, 0.0, -radius / 0.6];
    let cases = [
        ([1.0, 0.0, 2.0], [-0.25, 0.5, -1.5], 3),
        ([0.0, 0.5, 4.0], [0.125, 0.0625, -2.0], 2),
        ([0.5, 0.25, 1.0], [1.0, -0.5, 0.25], 1),
    ];
    for engine in ENGINES {
        for (position, velocity, bounces) in cases {
            let ball = Sphere::new(position).radius(radius).velocity(velocity);
            let cone = Cone::container(apex, [0.0, 0.0, 1.0], 4000.0, [0.0, 3000.0]);
            let mut world = with_ball::<f64>(engine, 0.1, Surface::Smooth, cone, [0.0; 3], ball);
            let duration = 8.0;
            world.advance(duration).unwrap();
            assert_eq!(world.collisions().surroundings, bounces, "{engine:?} {position:?}");
            let (p, v) = (Vec3::from(position), Vec3::from(velocity));
            let exact = p.dot(p) + 2.0 * duration * p.dot(v) + duration * duration * v.dot(v);
            let end = world.bodies().position_of(0);
            let error = (end.dot(end) / exact - 1.0).abs();
            assert!(error < 1e-14, "{engine:?} {position:?}: {error:e}");
            let about_axis = |p: Vec3<f64>, v: Vec3<f64>| p.cross(v).z;
            let kept = about_axis(end, world.bodies().velocity_of(0)) - about_axis(p, v);
            assert!(kept.abs() < 1e-14, "{engine:?} {position:?}: {kept:e}");
        }
    }
}

/// What a ball is in, where it starts, and the parts.
type Case = (&'static str, [f64; 3], Vec<Shape<f64>>);

/// A smooth ball keeps its angular momentum about the axis of whatever is round about it, and
/// its energy.
#[test]
fn about_the_axis_of_a_round_part_nothing_turns_a_smooth_ball() {
    let up = [0.0, 0.0, 1.0];
    let vase = [[0.0, -3.0], [2.5, -3.0], [2.5, 0.5], [1.0, 2.0], [1.5, 3.0], [0.0, 3.5]];
    let spool = [[0.0, -1.0], [1.0, -1.0], [0.25, 0.0], [1.0, 1.0], [0.0, 0.75]];
    let around = |shape: Shape<f64>| vec![FixedSphere::container([0.0; 3], 4.0).into(), shape];
    let thin = [[0.5, -2.0], [0.5, -1.0], [2.0, 1.0], [2.0, 2.0]];
    let cases: Vec<Case> = vec![
        ("sphere", [1.0, 0.0, 0.5], vec![FixedSphere::container([0.0; 3], 3.0).into()]),
        (
            "cylinder",
            [1.0, 0.0, 0.5],
            vec![Cylinder::container([0.0; 3], up, 2.0, Some(5.0)).into()],
        ),
        (
            "cone",
            [0.5, 0.0, 0.5],
            vec![Cone::container([0.0, 0.0, -1.0], up, 4.0, [3.0, 1.0]).into()],
        ),
        ("capsule", [1.0, 0.0, 0.5], vec![Capsule::container([0.0, 0.0, -1.0], up, 2.0).into()]),
        ("torus", [3.0, 0.0, 0.25], vec![Torus::container([0.0; 3], up, 3.0, 1.0).into()]),
        ("vase", [1.0, 0.0, 0.5], vec![Revolved::container([0.0; 3], up, vase).into()]),
        ("solid torus", [3.0, 0.0, 1.5], around(Torus::solid([0.0; 3], up, 2.0, 0.5).into())),
        ("solid cone", [1.5, 0.0, 1.0], around(Cone::solid([0.0; 3], up, 1.0, [1.0, 0.0]).into())),
        ("spool", [1.75, 0.0, 0.5], around(Revolved::solid([0.0; 3], up, spool).into())),
        ("hopper", [1.0, 0.0, 1.5], around(Revolved::thin([0.0; 3], up, thin).into())),
        ("annulus", [1.5, 0.0, 1.0], around(Disc::new([0.0; 3], up, 1.5, 0.5).into())),
    ];
    for engine in ENGINES {
        for (name, position, shapes) in &cases {
            let mut scene = Scene::<f64>::builder().engine(engine).dt(0.01);
            for shape in shapes {
                scene = scene.surroundings(shape.clone());
            }
            let ball = Sphere::new(*position).radius(0.25).velocity([-0.5, 1.0, -0.75]);
            let mut world =
                World::new(scene.sphere(ball).build().unwrap(), Execution::default()).unwrap();
            let about_axis = |world: &World<f64>| {
                let bodies = world.bodies();
                bodies.position_of(0).cross(bodies.velocity_of(0)).z
            };
            let (before, energy) = (about_axis(&world), world.energy().total());
            world.advance(100.0).unwrap();
            let hits = world.collisions().surroundings;
            assert!(hits > 10, "{name} {engine:?}: {hits}");
            let change = (about_axis(&world) - before).abs();
            assert!(change < 1e-12, "{name} {engine:?}: {change:e} after {hits}");
            let drift = (world.energy().total() / energy - 1.0).abs();
            assert!(drift < 1e-13, "{name} {engine:?}: {drift:e} after {hits}");
        }
    }
}

/// A rough ball inside a sphere keeps `I w − (r/R) m c × v`, where its centre can be as far
/// as `R` from that of the sphere: an impulse `J` at the point of contact, `(r/R) c` from
/// its centre, turns it by `(r/R) c × J`.
#[test]
fn a_rough_ball_inside_a_sphere_keeps_a_vector() {
    let (radius, reach, factor) = (0.25, 2.75, 0.4);
    for engine in ENGINES {
        let ball = Sphere::new([1.0, 0.5, -0.25])
            .radius(radius)
            .velocity([0.5, 1.0, -0.75])
            .spin([3.0, -2.0, 1.0])
            .inertia_factor(factor);
        let vessel = FixedSphere::container([0.0; 3], radius + reach);
        let mut world = with_ball::<f64>(engine, 0.01, Surface::Rough, vessel, [0.0; 3], ball);
        let kept = |world: &World<f64>| {
            let bodies = world.bodies();
            let spin = bodies.spin_of(0) * (factor * radius * radius);
            spin - bodies.position_of(0).cross(bodies.velocity_of(0)) * (radius / reach)
        };
        let before = kept(&world);
        world.advance(200.0).unwrap();
        let hits = world.collisions().surroundings;
        let change = (kept(&world) - before).length();
        assert!(hits > 50 && change < 1e-13, "{engine:?}: {change:e} after {hits}");
    }
}

/// All shapes in one container, in a scene file.
const ALL: &str = r#"
duration = 20.0
gravity = [0.0, 0.0, -1.0]
stepped = { dt = 0.02 }
surroundings = [
  { shape = "cylinder", center = [0, 0, 0], axis = [0, 0, 1], radius = 6, height = 12, inside = true },
  { shape = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0.5], rotation = { axis = [3, -2, 4], angle = 0.54 }, translation = [-3, 0, -3.5] },
  { shape = "triangle", vertices = [[2, 2, 0], [4, 1, 1], [2, 4, -1]] },
  { shape = "capsule", a = [0, -4, 2], b = [1, -2, 3], radius = 0.4 },
  { shape = "cylinder", center = [3, -2, -4], axis = [1, 0, 2], radius = 0.8, height = 1.5 },
  { shape = "cone", base = [0, 3, -4], axis = [0, 1, 3], height = 2, radius = 1, top_radius = 0.2 },
  { shape = "disc", center = [-3, 0, 3], axis = [1, 2, 2], radius = 1.5 },
  { shape = "annulus", center = [-3, -2, 0], axis = [1, 0, 2], outer = 1.5, inner = 0.6 },
  { shape = "tube", base = [0, 0, -1], axis = [0, 0, 1], height = 2, radius = 0.6, top_radius = 2 },
  { shape = "torus", center = [1, 2, 4], axis = [2, 1, 2], major = 1, minor = 0.3 },
  { shape = "hull", vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], translation = [2, -4, 1] },
  { shape = "revolved", center = [-2, 3, 3], axis = [2, 1, 2], closed = true, scale = 0.5, translation = [-1, 1, 1],
    profile = [[0, -2], [2, -2], [0.75, -0.5], [0.75, 0.5], [2, 2], [0, 1.5]] },
  { shape = "revolved", center = [0, 0, -4.5], axis = [0, 0, 1], profile = [[3, 0], [3, 1], [4, 2]] },
]
[[spheres]]
count = 60
arrangement = "random"
radius = [0.15, 0.3]
temperature = 4.0
"#;

/// A scene file in which balls are in this container.
fn container(shape: &str) -> String {
    format!(
        "duration = 20.0\ngravity = [0.0, 0.3, -1.0]\nstepped = {{ dt = 0.02 }}\n\
         surroundings = [{{ {shape}, inside = true }}]\n\
         [[spheres]]\ncount = 12\narrangement = \"random\"\nradius = 0.2\ntemperature = 3.0\n"
    )
}

/// Energy, collisions with the surroundings, and the least gap, of a scene file.
fn run<T: Compiled>(text: &str, engine: EngineKind) -> (f64, u64, f64) {
    let file = SceneFile::parse("vessel.toml", text).unwrap();
    let mut scene = file.build::<T>().unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.engine = engine;
    let shapes = scene.surroundings.clone();
    let features: Vec<_> = shapes.iter().flat_map(|shape| shape.features()).collect();
    let mut world = World::new(scene, Execution::new().threads(1)).unwrap();
    let energy = |world: &World<T>| Energy::of(&world.bodies(), world.gravity()).total();
    let before = energy(&world);
    let mut least = f64::INFINITY;
    for _ in 0..200 {
        world.advance(0.1).unwrap();
        let bodies = world.bodies();
        for body in 0..bodies.len() {
            let (center, radius) = (bodies.position_of(body), bodies.radius.of(body));
            let gaps = features.iter().map(|part| part.clearance(center, radius).gap.to_f64());
            least = gaps.fold(least, f64::min);
        }
    }
    let drift = (energy(&world) / before - 1.0).abs();
    (drift, world.collisions().surroundings, least)
}

/// In every container, and about every solid, both engines keep the energy and let nothing
/// through.
#[test]
fn nothing_passes_through_any_shape() {
    let containers = [
        "shape = \"box\", lower = [-2, -2, -2], upper = [2, 2, 2], rotation = { axis = [5, 2, 1], angle = 0.55 }",
        "shape = \"capsule\", a = [-1, 0, 0], b = [1, 0.5, 0], radius = 2",
        "shape = \"cylinder\", center = [0, 0, 0], axis = [1, 2, 2], radius = 2, height = 4",
        "shape = \"cone\", base = [0, 0, 3], axis = [0, 0.2, -1], height = 6, radius = 4",
        "shape = \"torus\", center = [0, 0, 0], axis = [1, 2, 2], major = 3, minor = 1",
        "shape = \"revolved\", center = [0, 0, 0], axis = [1, 2, 2], closed = true, \
         profile = [[0, -3], [2.5, -3], [2.5, 0.5], [1, 2], [1, 3], [0, 3.5]]",
    ];
    let texts = core::iter::once(ALL.to_owned()).chain(containers.map(container));
    for text in texts {
        for engine in ENGINES {
            let (drift, hits, least) = run::<f64>(&text, engine);
            println!("{engine:?} f64: {drift:.1e} {hits} {least:.1e}");
            assert!(drift < 1e-11 && hits > 100 && least > -1e-11, "{engine:?} {text}");
            let (drift, hits, least) = run::<f32>(&text, engine);
            println!("{engine:?} f32: {drift:.1e} {hits} {least:.1e}");
            assert!(drift < 1e-3 && hits > 100 && least > -1e-3, "{engine:?} f32 {text}");
        }
    }
}

/// Lattices start inside of every container.
#[test]
fn lattices_fit_into_every_container() {
    for shape in [
        "shape = \"box\", lower = [-2, -2, -2], upper = [2, 2, 2], rotation = { axis = [5, 2, 1], angle = 0.55 }",
        "shape = \"capsule\", a = [-1, 0, 0], b = [1, 0.5, 0], radius = 2",
        "shape = \"cylinder\", center = [0, 0, 0], axis = [1, 2, 2], radius = 2, height = 4",
        "shape = \"cylinder\", center = [0, 0, 0], axis = [0, 0, 1], radius = 2, height = 4",
        "shape = \"cone\", base = [0, 0, 3], axis = [0, 0, -1], height = 6, radius = 4",
        "shape = \"torus\", center = [0, 0, 0], axis = [1, 2, 2], major = 3, minor = 1",
        "shape = \"revolved\", center = [0, 0, 0], axis = [1, 2, 2], closed = true, \
         profile = [[0, -3], [2.5, -3], [2.5, 0.5], [1, 2], [1, 3], [0, 3.5]]",
    ] {
        let text = container(shape).replace("\"random\"", "\"cubic\"").replace("= 0.2", "= 0.02");
        let scene = SceneFile::parse("vessel.toml", &text).unwrap().build::<f64>();
        assert_eq!(scene.unwrap().bodies.len(), 12, "{shape}");
    }
}
