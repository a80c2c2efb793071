//! Two that meet: how far off they part, beside double-double.

use core::error::Error;

use carom::contact::{Party, Rough, Smooth, collide, contact_time};
use carom::lane::Lane;
use carom::real::Real;
use carom::{DoubleDouble, EventDriven, Scene, Sphere, Surface, Vec3};

use super::{Figure, Found, Number, epsilon, textbook};

/// How many pairs of a kind.
const PAIRS: u32 = 2_000;

type Exact = Vec3<DoubleDouble>;

/// Whether two meet, and how far off each velocity is then.
type Parting = (bool, [f64; 2]);

/// Numbers at random, the same on every machine: SplitMix64.
struct Random(u64);

impl Random {
    /// Within −1 and 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) as i64 >> 10) as f64 / (1_u64 << 53) as f64
    }

    fn direction(&mut self) -> Vec3<f64> {
        loop {
            let vector = Vec3::new(self.unit(), self.unit(), self.unit());
            let length = vector.length();
            if (0.1..=1.0).contains(&length) {
                return vector * (1.0 / length);
            }
        }
    }
}

/// Two of these radii and masses, one of which comes at the other at a speed of 1, past its
/// centre by `aim` of the sum of the radii. Both spin.
fn scene<T: Number>(
    random: &mut Random,
    radii: [f64; 2],
    masses: [f64; 2],
    aim: f64,
    far: f64,
) -> Result<Scene<T>, Box<dyn Error>> {
    let way = random.direction();
    let aside = way.cross(random.direction());
    let aside = aside * (1.0 / aside.length());
    let reach = radii[0] + radii[1];
    let far = Vec3::new(far, far, -far);
    let places = [far + way * (-3.0 * reach) + aside * (aim * reach), far];
    let mut builder = Scene::<T>::builder().surface(Surface::Rough);
    for k in 0..2 {
        let velocity = if k == 0 { way } else { Vec3::new(0.0, 0.0, 0.0) };
        let spin = random.direction() * (0.5 / radii[k]);
        let ball = Sphere::new(places[k].to_array()).radius(radii[k]).mass(masses[k]);
        builder = builder.sphere(ball.velocity(velocity.to_array()).spin(spin.to_array()));
    }
    Ok(builder.build()?)
}

/// The velocities with which the two of a scene part, whose numbers are exact; `None` if
/// they miss. Last by how much of the sum of the radii they come nearer than that.
fn exact<T: Number>(scene: &Scene<T>) -> (Option<[Exact; 2]>, f64) {
    let bodies = &scene.bodies;
    let one = DoubleDouble::ONE;
    let radii = [0, 1].map(|k| bodies.radius.of(k).cast::<DoubleDouble>());
    let reach = radii[0] + radii[1];
    let [mut a, mut b] = [0, 1].map(|k| Party {
        velocity: bodies.velocity_of(k).cast::<DoubleDouble>(),
        spin: bodies.spin_of(k).cast(),
        inverse_mass: one / bodies.mass.of(k).cast(),
        inverse_inertia: one / bodies.inertia.of(k).cast(),
        share: radii[k] / reach,
    });
    let offset = bodies.position_of(0).cast() - bodies.position_of(1).cast();
    let relative = a.velocity - b.velocity;
    let depth = one - offset.cross(relative).length() / relative.length() / reach;
    let contact = contact_time(offset, relative, reach);
    if !contact.meets {
        return (None, depth.to_f64());
    }
    let offset = offset + relative * contact.time;
    match scene.surface {
        Surface::Rough => collide(Rough, offset, &mut a, &mut b),
        _ => collide(Smooth, offset, &mut a, &mut b),
    };
    (Some([a.velocity, b.velocity]), depth.to_f64())
}

/// How both programs part the two: whether they meet at all, and how far off each velocity
/// is.
fn errors<T: Number>(
    scene: Scene<T>,
    expected: Option<[Exact; 2]>,
    time: f64,
) -> Result<[Parting; 2], Box<dyn Error>> {
    let bodies = &scene.bodies;
    let start = [0, 1].map(|k| bodies.velocity_of(k).cast::<DoubleDouble>());
    let should = expected.unwrap_or(start);
    let off = |velocity: &dyn Fn(usize) -> Vec3<T>| {
        [0, 1].map(|k| (velocity(k).cast::<DoubleDouble>() - should[k]).length().to_f64())
    };
    let mut book = textbook(&scene, &[]);
    book.step(super::real(time));
    let mut world = EventDriven::new(scene)?;
    world.advance(time)?;
    let ended = world.bodies();
    Ok([
        (world.collisions().total() > 0, off(&|k| ended.velocity_of(k))),
        (book.collisions > 0, off(&|k| book.balls[k].v)),
    ])
}

/// The worst velocity of many pairs, relative to the speed at which they meet; that of the
/// second one is multiplied by `second`.
fn worst<T: Number>(
    radii: [f64; 2],
    masses: [f64; 2],
    far: f64,
    second: f64,
) -> Result<[f64; 2], Box<dyn Error>> {
    let (mut random, mut worst) = (Random(1), [0.0_f64; 2]);
    for _ in 0..PAIRS {
        let aim = 0.7 * random.unit();
        let scene = scene::<T>(&mut random, radii, masses, aim, far)?;
        let (expected, _) = exact(&scene);
        if expected.is_none() {
            continue;
        }
        for (worst, (_, off)) in worst.iter_mut().zip(errors(scene, expected, 10.0)?) {
            *worst = worst.max(off[0]).max(off[1] * second);
        }
    }
    Ok(worst)
}

/// Pairs whose paths come within 1 − δ of contact, |δ| from 0.1 to 10⁻¹⁶.
fn grazing<T: Number>() -> Found {
    let (mut random, mut wrong, mut worst) = (Random(2), [0; 2], [0.0_f64; 2]);
    for k in 0..16 * PAIRS {
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let delta = side * 10.0_f64.powi(-(k as i32 / 2 % 16) - 1);
        let scene = scene::<T>(&mut random, [0.5, 0.3], [1.0, 1.5], 1.0 - delta, 0.0)?;
        let (expected, depth) = exact(&scene);
        // What the precision can decide.
        if depth.abs() < 64.0 * epsilon::<T>() {
            continue;
        }
        let found = errors(scene, expected, 10.0)?;
        for (k, (meets, off)) in found.into_iter().enumerate() {
            if meets != expected.is_some() {
                wrong[k] += 1;
            } else {
                worst[k] = worst[k].max(off[0].max(off[1]) * depth.abs().sqrt());
            }
        }
    }
    let wrong = wrong.map(f64::from);
    let worst = worst.map(|error| error / epsilon::<T>());
    Ok(vec![
        Figure::new("grazing pairs decided wrongly, of 32,000", "", wrong[0], wrong[1]),
        Figure::new("the others off by, δ deep", "ε/√δ", worst[0], worst[1]),
    ])
}

/// All kinds of pairs.
pub fn all<T: Number>() -> Found {
    let mut figures = Vec::new();
    let mut add = |what: &str, [carom, textbook]: [f64; 2], per: f64| {
        figures.push(Figure::in_epsilon::<T>(what, carom / per, textbook / per));
    };
    add("two that meet part wrongly by", worst::<T>([0.5; 2], [1.0; 2], 0.0, 1.0)?, 1.0);
    let heavy = worst::<T>([0.5; 2], [1.0, 1e12], 0.0, 1e12)?;
    add("a light one on one 10¹² as heavy", heavy, 1.0);
    let small = worst::<T>([1e-6, 1.0], [1.0; 2], 0.0, 1.0)?;
    add("radii of 10⁻⁶ and 1", small, 1.0);
    add("10⁴ from the origin, of X", worst::<T>([0.5; 2], [1.0; 2], 1e4, 1.0)?, 1e4);
    figures.extend(grazing::<T>()?);
    Ok(figures)
}
