//! Carom beside a textbook program, in what is hard for both: the figures of
//! `docs/textbook.md`.
//!
//! ```sh
//! cargo run --release --example textbook
//! ```

mod pairs;
mod program;

use std::error::Error;

use carom::engine::{Compiled, World};
use carom::motion::rotation::reference_rotation;
use carom::real::Real;
use carom::scene::{EngineKind, OrientationUpdate};
use carom::{
    Cuboid, DoubleDouble, EventDriven, Execution, Integrator, Plane, Scene, Sphere, Spheres,
    Surface, Vec3,
};
use num_traits::Float;
use program::Ball;

/// What `f32` and `f64` are to both programs.
trait Number: Compiled + Float {}
impl Number for f32 {}
impl Number for f64 {}

/// A point of a plane, and its normal.
type Face = [[f64; 3]; 2];

/// What can be off.
type Found = Result<Vec<Figure>, Box<dyn Error>>;

/// A figure of both programs.
struct Figure {
    what: String,
    unit: &'static str,
    carom: f64,
    textbook: f64,
}

impl Figure {
    fn new(what: impl Into<String>, unit: &'static str, carom: f64, textbook: f64) -> Self {
        Self { what: what.into(), unit, carom, textbook }
    }

    /// Both in ε of the precision.
    fn in_epsilon<T: Number>(what: impl Into<String>, carom: f64, textbook: f64) -> Self {
        let [carom, textbook] = [carom, textbook].map(|error| error / epsilon::<T>());
        Self::new(what, "ε", carom, textbook)
    }
}

fn epsilon<T: Number>() -> f64 {
    plain(<T as Real>::EPSILON)
}

fn real<T: Number>(value: f64) -> T {
    <T as Real>::from_f64(value)
}

fn plain<T: Number>(value: T) -> f64 {
    <T as Real>::to_f64(value)
}

/// A vector in the precision.
fn vector<T: Number>(value: [f64; 3]) -> [T; 3] {
    value.map(real)
}

/// The scene for the textbook program; `planes` are its points and normals.
fn textbook<T: Number>(scene: &Scene<T>, planes: &[Face]) -> program::World<T> {
    let bodies = &scene.bodies;
    let ball = |k| Ball {
        c: bodies.position_of(k),
        v: bodies.velocity_of(k),
        w: bodies.spin_of(k),
        m: bodies.orientation_of(k).columns,
        radius: bodies.radius.of(k),
        mass: bodies.mass.of(k),
        inertia: bodies.inertia.of(k),
    };
    program::World {
        balls: (0..bodies.len()).map(ball).collect(),
        planes: planes.iter().map(|plane| plane.map(|it| Vec3::from(vector(it)))).collect(),
        gravity: scene.gravity,
        rough: scene.surface == Surface::Rough,
        collisions: 0,
    }
}

fn distance<T: Number>(a: Vec3<T>, b: [f64; 3]) -> f64 {
    let [x, y, z] = a.to_array().map(plain);
    ((x - b[0]).powi(2) + (y - b[1]).powi(2) + (z - b[2]).powi(2)).sqrt()
}

/// A throw of one second, in steps.
fn throw<T: Number>(what: &str, steps: u32, duration: f64, start: [f64; 3]) -> Found {
    let (velocity, gravity) = ([1.0, 2.0, 3.0], -9.75);
    let dt = duration / f64::from(steps);
    let ball = Sphere::new(start).radius(0.5).velocity(velocity);
    let builder = Scene::<T>::builder().gravity(vector([0.0, 0.0, gravity]));
    let builder = builder.engine(EngineKind::Stepped).dt(dt);
    let scene = builder.integrator(Integrator::VelocityVerlet).sphere(ball).build()?;
    let mut book = textbook(&scene, &[]);
    let mut world = World::new(scene, Execution::default())?;
    world.advance(duration)?;
    for _ in 0..steps {
        book.step(real(dt));
    }
    let fallen = [0.0, 0.0, 0.5 * gravity * duration * duration];
    let end: [f64; 3] = core::array::from_fn(|k| start[k] + velocity[k] * duration + fallen[k]);
    let carom = distance(world.bodies().position_of(0), end);
    let figure = |carom, textbook| Figure::new(what, "of the way", carom, textbook);
    let way = distance(Vec3::from(start), end);
    Ok(vec![figure(carom / way, distance(book.balls[0].c, end) / way)])
}

/// A million turns of 0.01 rad: how far a matrix is from orthonormal, and from its place.
fn rotation<T: Number>() -> Found {
    const STEPS: u32 = 1_000_000;
    let ball = Sphere::new([0.0; 3]).radius(0.5).spin([0.48, 0.6, 0.64]);
    let builder = Scene::<T>::builder().engine(EngineKind::Stepped).dt(0.01);
    let scene = builder.orientation(OrientationUpdate::EachStep).sphere(ball).build()?;
    let (mut book, spin) = (textbook(&scene, &[]), scene.bodies.spin_of(0));
    let mut world = World::new(scene, Execution::default())?;
    world.advance(0.01 * f64::from(STEPS))?;
    let dt = real::<T>(0.01);
    (0..STEPS).for_each(|_| book.step(dt));
    let time = dt.cast::<DoubleDouble>() * DoubleDouble::from_f64(f64::from(STEPS));
    let should = reference_rotation(spin.cast::<DoubleDouble>(), time);
    let errors = |columns: [Vec3<T>; 3]| {
        let m = columns.map(|column| column.cast::<DoubleDouble>());
        let skew = (0..9).map(|k| {
            let one = if k / 3 == k % 3 { 1.0 } else { 0.0 };
            (m[k / 3].dot(m[k % 3]).to_f64() - one).abs()
        });
        let off = (0..3).map(|k| (m[k] - should.columns[k]).length().to_f64());
        (skew.fold(0.0, f64::max), off.fold(0.0, f64::max))
    };
    let carom = errors(world.bodies().orientation_of(0).columns);
    let textbook = errors(book.balls[0].m);
    Ok(vec![
        Figure::in_epsilon::<T>("10⁶ turns of 0.01 rad: ‖MᵗM − 1‖", carom.0, textbook.0),
        Figure::in_epsilon::<T>("10⁶ turns of 0.01 rad: axes off", carom.1, textbook.1),
    ])
}

const SIDE: f64 = 6.0;

/// 64 rough spheres in a box.
fn gas<T: Number>() -> Result<(Scene<T>, Vec<Face>), Box<dyn Error>> {
    let spheres = Spheres::random(64).radius(0.5).temperature(1.0).spin_temperature(1.0);
    let shape = Cuboid::container(vector([0.0; 3]), vector([SIDE; 3]));
    let scene = Scene::<T>::builder().surface(Surface::Rough).surroundings(shape);
    let planes = (0..6).map(|k| {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        (point[k % 3], normal[k % 3]) = if k < 3 { (0.0, 1.0) } else { (SIDE, -1.0) };
        [point, normal]
    });
    Ok((scene.spheres(spheres).build()?, planes.collect()))
}

/// What a gas keeps over 10⁵ collisions.
fn energy<T: Number>() -> Found {
    const COLLISIONS: u64 = 100_000;
    let (scene, planes) = gas::<T>()?;
    let start = energy_of(&textbook(&scene, &planes).balls);
    let mut book = textbook(&scene, &planes);
    let mut world = EventDriven::new(scene)?;
    world.advance_until(COLLISIONS, 1e9)?;
    while book.collisions < COLLISIONS {
        book.step(real(0.1));
    }
    let bodies = world.bodies();
    let change = |energy: f64| (energy / start - 1.0).abs();
    let (mut ended, _) = gas::<T>()?;
    ended.bodies = bodies.clone();
    let ended = textbook(&ended, &[]).balls;
    let centers = |place: &dyn Fn(usize) -> Vec3<T>| {
        let places: Vec<_> = (0..64).map(|k| place(k).to_array().map(plain)).collect();
        let mut deepest: f64 = 0.0;
        for (k, a) in places.iter().enumerate() {
            for b in &places[..k] {
                deepest = deepest.max(1.0 - distance(Vec3::from(*a), *b));
            }
            let walls = a.iter().map(|x| 0.5 - x.min(SIDE - x));
            deepest = walls.fold(deepest, f64::max);
        }
        deepest
    };
    let overlap = [centers(&|k| bodies.position_of(k)), centers(&|k| book.balls[k].c)];
    Ok(vec![
        Figure::in_epsilon::<T>(
            "10⁵ collisions of a rough gas: energy",
            change(energy_of(&ended)),
            change(energy_of(&book.balls)),
        ),
        Figure::new("deepest overlap then", "diameters", overlap[0], overlap[1]),
    ])
}

fn energy_of<T: Number>(balls: &[Ball<T>]) -> f64 {
    let square = |vector: Vec3<T>| distance(vector, [0.0; 3]).powi(2);
    let energy =
        |ball: &Ball<T>| plain(ball.mass) * square(ball.v) + plain(ball.inertia) * square(ball.w);
    0.5 * balls.iter().map(energy).sum::<f64>()
}

/// Ten collisions of each sphere, and all of them back.
fn reversal<T: Number>() -> Found {
    let (scene, planes) = gas::<T>()?;
    let start = scene.bodies.clone();
    let mut book = textbook(&scene, &planes);
    let mut world = EventDriven::new(scene)?;
    world.advance_until(320, 1e9)?;
    let time = world.time() * (1.0 + 1e-6);
    world.advance(time - world.time())?;
    let (mut back, _) = gas::<T>()?;
    back.bodies = world.bodies();
    back.bodies.scale_motion(-T::one());
    let mut world = EventDriven::new(back)?;
    world.advance(time)?;
    book.step(real(time));
    for ball in &mut book.balls {
        ball.v = -ball.v;
        ball.w = -ball.w;
    }
    book.step(real(time));
    let off = |place: &dyn Fn(usize) -> Vec3<T>| {
        let squares = (0..start.len())
            .map(|k| distance(place(k), start.position_of(k).to_array().map(plain)).powi(2));
        (squares.sum::<f64>() / start.len() as f64).sqrt()
    };
    let ended = world.bodies();
    let carom = off(&|k| ended.position_of(k));
    let textbook = off(&|k| book.balls[k].c);
    Ok(vec![Figure::new("10 collisions of a sphere, and back", "diameters", carom, textbook)])
}

/// The digits of π, counted in collisions of a ball with one 10⁸ times as heavy and a wall.
fn galperin<T: Number>() -> Found {
    let ball = |x: f64| Sphere::new([x, 0.0, 0.0]).radius(0.0625);
    let wall = [[0.0; 3], [1.0, 0.0, 0.0]];
    let scene = Scene::<T>::builder()
        .surroundings(Plane::new(vector(wall[0]), vector(wall[1])))
        .sphere(ball(1.0))
        .sphere(ball(5.0).mass(1e8).velocity([-1.0, 0.0, 0.0]))
        .build()?;
    let mut book = textbook(&scene, &[wall]);
    let mut world = EventDriven::new(scene)?;
    world.advance(400.0)?;
    book.step(real(400.0));
    let what = "π·10⁴, counted in collisions";
    Ok(vec![Figure::new(what, "", world.collisions().total() as f64, book.collisions as f64)])
}

/// A ball that flies into a wedge of π/1000½ along one side: 1000 bounces.
fn wedge<T: Number>() -> Found {
    let angle = core::f64::consts::PI / 1000.5;
    let radius = 1.0 / 16.0;
    let normals = [[0.0, 1.0, 0.0], [angle.sin(), -angle.cos(), 0.0]];
    let planes = normals.map(|normal| [normal.map(|x| -radius * x), normal]);
    let mut builder = Scene::<T>::builder();
    for [point, normal] in planes {
        builder = builder.surroundings(Plane::new(vector(point), vector(normal)));
    }
    let ball = Sphere::new([1.0, 0.5 * angle, 0.0]).radius(radius).velocity([-1.0, 0.0, 0.0]);
    let scene = builder.sphere(ball).build()?;
    let mut book = textbook(&scene, &planes);
    let mut world = EventDriven::new(scene)?;
    world.advance(64.0)?;
    book.step(real(64.0));
    let found = [world.collisions().total() as f64, book.collisions as f64];
    Ok(vec![Figure::new("bounces in a wedge of π/1000½", "", found[0], found[1])])
}

/// A rough ball between two planes: the invariant of 10⁵ bounces.
fn superball<T: Number>() -> Found {
    const BOUNCES: u64 = 100_000;
    let planes = [[[0.0; 3], [0.0, 0.0, 1.0]], [[0.0, 0.0, 2.0], [0.0, 0.0, -1.0]]];
    let mut builder = Scene::<T>::builder().surface(Surface::Rough);
    for [point, normal] in planes {
        builder = builder.surroundings(Plane::new(vector(point), vector(normal)));
    }
    let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([1.0, 0.0, -1.0]);
    let scene = builder.sphere(ball).build()?;
    let mut book = textbook(&scene, &planes);
    let mut world = EventDriven::new(scene)?;
    world.advance_until(BOUNCES, 1e9)?;
    while book.collisions < BOUNCES {
        book.step(real(1.0));
    }
    let off = |v: Vec3<T>, w: Vec3<T>| {
        let [v, w] = [v.x, w.y].map(plain);
        ((v * v + 0.4 * 0.25 * w * w).sqrt() - 1.0).abs()
    };
    let bodies = world.bodies();
    let carom = off(bodies.velocity_of(0), bodies.spin_of(0));
    let textbook = off(book.balls[0].v, book.balls[0].w);
    Ok(vec![Figure::in_epsilon::<T>("10⁵ bounces of a superball: its invariant", carom, textbook)])
}

/// Twenty equal balls that touch, and one that comes in: how many end wrongly.
fn cradle<T: Number>() -> Found {
    let mut builder = Scene::<T>::builder();
    for k in 0..20 {
        let speed = if k == 0 { 1.0 } else { 0.0 };
        let ball = Sphere::new([f64::from(k) * 0.7, 0.0, 0.0]).radius(0.35);
        builder = builder.sphere(ball.velocity([speed, 0.0, 0.0]));
    }
    let scene = builder.build()?;
    let mut book = textbook(&scene, &[]);
    let mut world = EventDriven::new(scene)?;
    world.advance(4.0)?;
    book.step(real(4.0));
    let wrong = |velocity: &dyn Fn(usize) -> T| {
        let should = |k| if k == 19 { T::one() } else { T::zero() };
        (0..20).filter(|&k| velocity(k) != should(k)).count() as f64
    };
    let bodies = world.bodies();
    let carom = wrong(&|k| bodies.velocity_of(k).x);
    let textbook = wrong(&|k| book.balls[k].v.x);
    Ok(vec![Figure::new("balls of a cradle of 20 that end wrongly", "", carom, textbook)])
}

fn all<T: Number>() -> Found {
    let mut figures = throw::<T>("a throw of 1 s in steps of 0.01 s", 100, 1.0, [0.0; 3])?;
    figures.extend(throw::<T>("10⁶ steps of 10⁻⁷ s, 10 away", 1_000_000, 0.1, [10.0; 3])?);
    figures.extend(rotation::<T>()?);
    figures.extend(energy::<T>()?);
    figures.extend(reversal::<T>()?);
    figures.extend(pairs::all::<T>()?);
    figures.extend(galperin::<T>()?);
    figures.extend(wedge::<T>()?);
    figures.extend(superball::<T>()?);
    figures.extend(cradle::<T>()?);
    Ok(figures)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("| | unit | carom f32 | f64 | textbook f32 | f64 |\n|---|---|---|---|---|---|");
    for (single, double) in all::<f32>()?.iter().zip(all::<f64>()?) {
        let figures = [single.carom, double.carom, single.textbook, double.textbook].map(number);
        println!("| {} | {} | {} |", double.what, double.unit, figures.join(" | "));
    }
    Ok(())
}

fn number(value: f64) -> String {
    match value {
        v if v.fract() == 0.0 && v.abs() < 1e6 => format!("{v}"),
        v if (0.1..1000.0).contains(&v) => format!("{v:.2}"),
        v => format!("{v:.1e}"),
    }
}
