//! Golden hashes: the same bits on every machine and for every instruction set.
//!
//! Each entry hashes what a piece of the crate makes of a fixed pseudo-random
//! input. The constants come from a baseline x86-64 build; this test must pass
//! wherever the crate is built. For other instruction sets of one machine:
//!
//! ```sh
//! RUSTFLAGS="-C target-cpu=x86-64" cargo test --target-dir target/x86-64 --test golden --test lanes
//! RUSTFLAGS="-C target-cpu=x86-64-v3" cargo test --target-dir target/x86-64-v3 --test golden --test lanes
//! ```
//!
//! A new entry: a function that returns a hash, and a line in the table with 0.
//! The failing test prints the line as it should be.

mod common;

use carom::contact::{Law, Party, Rough, Smooth, collide, contact_time};
use carom::engine::{Compiled, EventDriven, Stepped};
use carom::motion::Integrator;
use carom::motion::rotation::reference_rotation;
use carom::motion::turning::turn;
use carom::observe::state_hash;
use carom::real::Real;
use carom::scene::Impact;
use carom::scene::SceneFile;
use carom::space::OpenSpace;
use carom::surroundings::{Cuboid, Feature, FixedSphere, Plane};
use carom::trigonometry::sin_cos;
use carom::vec3::Vec3;
use common::numbers::{Random, hash};

/// Name, what is computed now, and the hash that it must have.
type Entry = (&'static str, fn() -> u64, u64);

const GOLDEN: &[Entry] = &[
    ("arithmetic f32", arithmetic::<f32>, 0xd930_9894_71e0_7f38),
    ("arithmetic f64", arithmetic::<f64>, 0x81ee_554d_ba77_378d),
    ("sine and cosine f32", sines::<f32>, 0x91ad_dbe5_c5ac_4ac1),
    ("sine and cosine f64", sines::<f64>, 0xa2ec_dbad_0586_d241),
    ("reference rotation f32", reference_rotations::<f32>, 0x04b6_ccea_dcb1_1941),
    ("reference rotation f64", reference_rotations::<f64>, 0x7473_9414_0165_f47f),
    ("turning f32", turning::<f32>, 0x249f_4f56_2d1c_45c7),
    ("turning f64", turning::<f64>, 0xd79d_ad72_405d_f75a),
    ("flight f32", flights::<f32>, 0x58b9_50ff_4b45_5fcb),
    ("flight f64", flights::<f64>, 0xefa4_71d9_b3c9_6153),
    ("smooth impulse f32", || impulses::<f32, _>(Smooth), 0x96b6_c183_0274_a53e),
    ("smooth impulse f64", || impulses::<f64, _>(Smooth), 0x2890_999d_1a32_8784),
    ("rough impulse f32", || impulses::<f32, _>(Rough), 0x661a_40cf_da21_d0dd),
    ("rough impulse f64", || impulses::<f64, _>(Rough), 0x2bed_9b8d_179f_2d94),
    ("contact times f32", contact_times::<f32>, 0x9181_358d_4a5e_590f),
    ("contact times f64", contact_times::<f64>, 0xae09_9c5e_86e4_c6fd),
    (
        "rough gas, end of step f32",
        || engine::<f32>("rough-gas", Impact::EndOfStep),
        0x343d_ce17_80e5_faaf,
    ),
    (
        "rough gas, end of step f64",
        || engine::<f64>("rough-gas", Impact::EndOfStep),
        0x48ec_c486_2f7e_02fb,
    ),
    ("mixture, sub-step f32", || engine::<f32>("mixture", Impact::SubStep), 0x77f3_6f67_3e49_94f6),
    ("mixture, sub-step f64", || engine::<f64>("mixture", Impact::SubStep), 0x67c0_0596_26f0_22cf),
    (
        "fluid, sub-step f32",
        || engine::<f32>("hard-sphere-fluid", Impact::SubStep),
        0x28c4_d7b2_9dfa_a886,
    ),
    (
        "fluid, sub-step f64",
        || engine::<f64>("hard-sphere-fluid", Impact::SubStep),
        0x9640_2d96_6548_2931,
    ),
    ("hard-sphere-fluid, events f32", || events::<f32>("hard-sphere-fluid"), 0x6369_0c74_c585_d639),
    ("hard-sphere-fluid, events f64", || events::<f64>("hard-sphere-fluid"), 0x0444_57df_e512_4035),
    ("rough-gas, events f32", || events::<f32>("rough-gas"), 0x69a2_4fd0_ad7e_8027),
    ("rough-gas, events f64", || events::<f64>("rough-gas"), 0x8554_f6a0_10af_ae6f),
    ("mixture, events f32", || events::<f32>("mixture"), 0xd550_4959_437f_7ed2),
    ("mixture, events f64", || events::<f64>("mixture"), 0x60ab_fb06_a378_9828),
    ("wedge, events f32", || events::<f32>("wedge"), 0x4f92_cbf3_ff8d_9041),
    ("wedge, events f64", || events::<f64>("wedge"), 0xac09_e4a9_d303_8057),
];

#[test]
fn hashes_are_golden() {
    let mut changed = String::new();
    for &(name, compute, golden) in GOLDEN {
        let found = compute();
        if found != golden {
            changed += &format!("    (\"{name}\", …, {found:#x}), // not {golden:#x}\n");
        }
    }
    assert!(changed.is_empty(), "other bits than golden:\n{changed}");
}

/// How many values of each kind go into a hash; no multiple of a lane's width.
const COUNT: usize = 10_007;

/// A column of pseudo-random numbers in [-1, 1).
fn column<T: Real>(random: &mut Random) -> Vec<T> {
    (0..COUNT).map(|_| random.unit()).collect()
}

fn arithmetic<T: Real>() -> u64 {
    let mut random = Random(1);
    hash((0..COUNT).flat_map(|_| {
        let (a, b): (T, T) = (random.magnitude(-8, 9), random.magnitude(-8, 9));
        [a + b, a - b, a * b, a / b, a.abs().sqrt(), a.nearest_whole(), a.lesser(b)]
    }))
}

fn sines<T: Real>() -> u64 {
    let mut random = Random(2);
    hash((0..COUNT).flat_map(|_| {
        let (sine, cosine) = sin_cos::<T>(random.magnitude(-8, 12));
        [sine, cosine]
    }))
}

fn reference_rotations<T: Real>() -> u64 {
    let mut random = Random(3);
    hash((0..COUNT).flat_map(|_| {
        let time: T = random.magnitude(-4, 4);
        reference_rotation(random.vector(), time).rows()
    }))
}

fn turning<T: Real>() -> u64 {
    let mut random = Random(4);
    let spin: [Vec<T>; 3] = core::array::from_fn(|_| column(&mut random));
    let zero = vec![T::ZERO; COUNT];
    let mut rows: [Vec<T>; 9] =
        core::array::from_fn(|k| if k % 4 == 0 { vec![T::ONE; COUNT] } else { zero.clone() });
    for time in [T::ratio(1, 100), T::ONE, T::whole(1000)] {
        turn::<T::Pack8>(
            rows.each_mut().map(Vec::as_mut_slice),
            spin.each_ref().map(Vec::as_slice),
            time,
        );
    }
    hash(rows.into_iter().flatten())
}

/// Of two spheres, and of one with each kind of feature, with and without a
/// field.
fn contact_times<T: Real>() -> u64 {
    let mut random = Random(6);
    let radius = T::ratio(1, 4);
    let features = [
        Feature::Plane(Plane::new([T::ZERO; 3], [T::ONE, T::whole(2), T::whole(-2)])),
        Feature::Cuboid(Cuboid::solid([T::ratio(-1, 2); 3], [radius, T::ratio(1, 3), radius])),
        Feature::FixedSphere(FixedSphere::solid([T::ZERO; 3], T::ratio(1, 3))),
        Feature::FixedSphere(FixedSphere::container([T::ZERO; 3], T::whole(3))),
    ];
    hash((0..COUNT).flat_map(|_| {
        let (center, velocity): (Vec3<T>, Vec3<T>) = (random.vector(), random.vector());
        let (center, field) = (center * T::whole(2), random.vector());
        let pair = contact_time(center, velocity, radius);
        let mut times = vec![if pair.meets { pair.time } else { -T::ONE }];
        for feature in &features {
            for field in [None, Some(field)] {
                let time = feature.contact_time(center, velocity, field, radius, false);
                times.push(time.unwrap_or(-T::ONE));
            }
        }
        times
    }))
}

fn flights<T: Real>() -> u64 {
    let mut random = Random(5);
    let mut position: [Vec<T>; 3] = core::array::from_fn(|_| column(&mut random));
    let mut velocity: [Vec<T>; 3] = core::array::from_fn(|_| column(&mut random));
    for integrator in
        [Integrator::SemiImplicitEuler, Integrator::ExplicitEuler, Integrator::VelocityVerlet]
    {
        for field in [None, Some(Vec3::new(T::ratio(1, 3), T::ZERO, T::whole(-10)))] {
            integrator.flight::<T::Pack16, _>(
                position.each_mut().map(Vec::as_mut_slice),
                velocity.each_mut().map(Vec::as_mut_slice),
                field,
                T::ratio(1, 100),
                OpenSpace,
            );
        }
    }
    hash(position.into_iter().chain(velocity).flatten())
}

/// Impulses between random bodies.
fn impulses<T: Real, W: Law<T>>(law: W) -> u64 {
    let mut random = Random(7);
    let mut results = Vec::new();
    for _ in 0..COUNT {
        let offset = random.vector::<T>();
        let mut party = || Party {
            velocity: random.vector(),
            spin: random.vector(),
            inverse_mass: random.unit::<T>() + T::whole(2),
            inverse_inertia: random.unit::<T>() + T::whole(5),
            share: T::ratio(1, 3),
        };
        let (mut a, mut b) = (party(), party());
        collide(law, offset, &mut a, &mut b);
        for v in [a.velocity, a.spin, b.velocity, b.spin] {
            results.extend(v.to_array());
        }
    }
    hash(results)
}

/// The state of a built-in scene after some steps of the stepped engine.
fn engine<T: Compiled>(name: &str, impact: Impact) -> u64 {
    let mut scene = SceneFile::builtin(name).unwrap().build::<T>().unwrap();
    scene.stepped.impact = impact;
    let mut world = Stepped::new(scene).unwrap();
    world.advance_steps(100);
    state_hash(&world.bodies()).0
}

/// The state of a built-in scene after some collisions of the event-driven
/// engine.
fn events<T: Compiled>(name: &str) -> u64 {
    let scene = SceneFile::builtin(name).unwrap().build::<T>().unwrap();
    let mut world = EventDriven::new(scene).unwrap();
    world.advance_until(20_000, 1e3).unwrap();
    state_hash(&world.bodies()).0
}
