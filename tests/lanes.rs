//! Every lane width gives the bits of the scalar path: by equality, over random
//! and extreme numbers.

mod common;

use carom::contact::{contact_time, past_contact};
use carom::lane::{Lane, Mask, Twin};
use carom::mat3::Mat3;
use carom::motion::Integrator;
use carom::motion::integrator::{
    Coasting, ExplicitEuler, FlightStep, SemiImplicitEuler, VelocityVerlet,
};
use carom::motion::rotation::{reference_rotation, turned};
use carom::motion::turning::turn;
use carom::real::Real;
use carom::space::OpenSpace;
use carom::space::PeriodicBox;
use carom::trigonometry::{sin_cos, sin_cos_of_sum};
use carom::vec3::Vec3;
use common::numbers::{Bits, Random};

/// A formula of `I` numbers that gives `O`.
trait Formula<const I: usize, const O: usize> {
    const NAME: &'static str;

    fn at<L: Lane>(inputs: [L; I]) -> [L; O];
}

macro_rules! formulas {
    ($($name:ident($($input:ident),*) -> $outputs:literal $body:block)*) => {$(
        struct $name;

        impl Formula<{ [$(stringify!($input)),*].len() }, $outputs> for $name {
            const NAME: &'static str = stringify!($name);

            #[inline(never)]
            fn at<L: Lane>(
                [$($input),*]: [L; [$(stringify!($input)),*].len()],
            ) -> [L; $outputs] $body
        }
    )*};
}

/// A mask as numbers.
fn truth<L: Lane>(mask: L::Mask) -> L {
    L::select(mask, L::ONE, L::ZERO)
}

/// Position and velocity as six numbers.
fn six<L: Lane>((position, velocity): (Vec3<L>, Vec3<L>)) -> [L; 6] {
    let ([x, y, z], [u, v, w]) = (position.to_array(), velocity.to_array());
    [x, y, z, u, v, w]
}

formulas! {
    Arithmetic(a, b) -> 5 { [a + b, a - b, a * b, a / b, -a] }
    Root(a) -> 2 { [a.sqrt(), a.abs()] }
    Comparisons(a, b) -> 8 {
        let (less, same) = (a.lt(b), a.same(b));
        [
            truth(less), truth(a.le(b)), truth(a.gt(b)), truth(a.ge(b)), truth(same),
            truth(less | same), truth(!less & !same), L::select(less, a, b),
        ]
    }
    Bounds(a, b) -> 2 { [a.lesser(b), a.greater(b)] }
    Whole(a) -> 1 { [a.nearest_whole()] }
    SineAndCosine(a) -> 2 {
        let (sine, cosine) = sin_cos(a);
        [sine, cosine]
    }
    SineAndCosineOfSum(a, b) -> 2 {
        let (sine, cosine) = sin_cos_of_sum(a, b);
        [sine, cosine]
    }
    Coast(x, y, z, u, v, w, ax, ay, az, dt) -> 6 {
        six(Coasting::step([x, y, z].into(), [u, v, w].into(), [ax, ay, az].into(), dt))
    }
    VelocityFirst(x, y, z, u, v, w, ax, ay, az, dt) -> 6 {
        six(SemiImplicitEuler::step([x, y, z].into(), [u, v, w].into(), [ax, ay, az].into(), dt))
    }
    PositionFirst(x, y, z, u, v, w, ax, ay, az, dt) -> 6 {
        six(ExplicitEuler::step([x, y, z].into(), [u, v, w].into(), [ax, ay, az].into(), dt))
    }
    Parabola(x, y, z, u, v, w, ax, ay, az, dt) -> 6 {
        six(VelocityVerlet::step([x, y, z].into(), [u, v, w].into(), [ax, ay, az].into(), dt))
    }
    Reference(x, y, z, t) -> 9 { reference_rotation([x, y, z].into(), t).rows() }
    Turn(a, b, c, d, e, f, g, h, i, x, y, z, t) -> 9 {
        turned(Mat3::from_rows([a, b, c, d, e, f, g, h, i]), [x, y, z].into(), t).rows()
    }
}

formulas! {
    ContactAhead(x, y, z, u, v, w, reach) -> 2 {
        let contact = contact_time([x, y, z].into(), [u, v, w].into(), reach);
        [truth(contact.meets), contact.time]
    }
    ContactBehind(x, y, z, u, v, w, reach) -> 2 {
        let contact = past_contact([x, y, z].into(), [u, v, w].into(), reach);
        [truth(contact.met), contact.ago]
    }
}

/// Some thousand inputs: all pairs of extremes for the first two numbers, then
/// mixtures of tame numbers, extremes and arbitrary bits.
fn inputs<T: Bits, const I: usize>() -> Vec<[T; I]> {
    let extremes = T::extremes();
    let mut random = Random(42);
    let mut any = move |extremes: &[T], kind: u64| match kind {
        0..4 => random.unit(),
        4..6 => random.magnitude(-3, 6),
        6 => extremes[random.bits() as usize % extremes.len()],
        _ => T::from_any(random.bits()),
    };
    let mut kinds = Random(43);
    let mut inputs: Vec<[T; I]> = (0..20_000)
        .map(|case| {
            // Every other input is of tame numbers only.
            let most = if case % 2 == 0 { 6 } else { 8 };
            core::array::from_fn(|_| any(&extremes, kinds.bits() % most))
        })
        .collect();
    for (case, input) in inputs.iter_mut().enumerate().take(extremes.len() * extremes.len()) {
        for (k, number) in input.iter_mut().enumerate().take(2) {
            *number = extremes[case / extremes.len().pow(k as u32) % extremes.len()];
        }
    }
    inputs
}

/// Asserts that a formula in lanes of type `L` gives the bits of the scalar
/// path.
fn holds_for<F: Formula<I, O>, L: Lane, const I: usize, const O: usize>(inputs: &[[L::Scalar; I]])
where
    L::Scalar: Bits,
{
    for group in inputs.chunks(L::WIDTH) {
        let packed = F::at(core::array::from_fn(|k| L::from_fn(|i| group[i % group.len()][k])));
        for (i, &input) in group.iter().enumerate() {
            let alone = F::at(input).map(|value: L::Scalar| value.to_bits64());
            let together = packed.map(|value| value.to_array().as_ref()[i].to_bits64());
            assert_eq!(
                together,
                alone,
                "{} of {input:?}, lane {i} of {}",
                F::NAME,
                core::any::type_name::<L>()
            );
        }
    }
}

fn holds_for_all<F: Formula<I, O>, const I: usize, const O: usize>() {
    let inputs_f32 = inputs();
    holds_for::<F, wide::f32x4, I, O>(&inputs_f32);
    holds_for::<F, wide::f32x8, I, O>(&inputs_f32);
    holds_for::<F, wide::f32x16, I, O>(&inputs_f32);
    let inputs_f64 = inputs();
    holds_for::<F, wide::f64x4, I, O>(&inputs_f64);
    holds_for::<F, wide::f64x8, I, O>(&inputs_f64);
    holds_for::<F, Twin<wide::f64x8>, I, O>(&inputs_f64);
}

#[test]
fn operations_have_the_same_bits() {
    holds_for_all::<Arithmetic, 2, 5>();
    holds_for_all::<Root, 1, 2>();
    holds_for_all::<Comparisons, 2, 8>();
    holds_for_all::<Bounds, 2, 2>();
    holds_for_all::<Whole, 1, 1>();
}

#[test]
fn sine_and_cosine_have_the_same_bits() {
    holds_for_all::<SineAndCosine, 1, 2>();
    holds_for_all::<SineAndCosineOfSum, 2, 2>();
}

#[test]
fn flight_has_the_same_bits() {
    holds_for_all::<Coast, 10, 6>();
    holds_for_all::<VelocityFirst, 10, 6>();
    holds_for_all::<PositionFirst, 10, 6>();
    holds_for_all::<Parabola, 10, 6>();
}

#[test]
fn contact_times_have_the_same_bits() {
    holds_for_all::<ContactAhead, 7, 2>();
    holds_for_all::<ContactBehind, 7, 2>();
}

#[test]
fn rotation_has_the_same_bits() {
    holds_for_all::<Reference, 4, 9>();
    holds_for_all::<Turn, 13, 9>();
}

/// Runs a check for every lane type.
macro_rules! for_all_lanes {
    ($check:ident) => {
        $check::<f32>();
        $check::<wide::f32x4>();
        $check::<wide::f32x8>();
        $check::<wide::f32x16>();
        $check::<f64>();
        $check::<wide::f64x4>();
        $check::<wide::f64x8>();
        $check::<Twin<wide::f64x8>>();
    };
}

fn moves_through_columns<L: Lane>()
where
    L::Scalar: Bits,
{
    let mut random = Random(7);
    let column: Vec<L::Scalar> = (0..100).map(|_| L::Scalar::from_any(random.bits())).collect();
    let bits = |values: &[L::Scalar]| values.iter().map(|v| v.to_bits64()).collect::<Vec<_>>();
    let width = L::WIDTH;
    let zero = L::Scalar::ZERO;
    let mut target = [zero; 100];

    L::load(&column[3..]).store(&mut target[5..]);
    assert_eq!(bits(&target[5..5 + width]), bits(&column[3..3 + width]));
    assert_eq!(bits(&target[5 + width..]), bits(&vec![zero; 95 - width]));

    for len in 0..=width {
        let mut target = vec![zero; 32];
        let tail = L::load_tail(&column[..len], L::Scalar::ONE);
        tail.store(&mut target);
        assert_eq!(bits(&target[..len]), bits(&column[..len]));
        assert!(target[len..width].iter().all(|&padding| padding == L::Scalar::ONE));
    }

    let indices: Vec<u32> = (0..width as u32).map(|k| 99 - 3 * k).collect();
    let gathered = L::gather(&column, &indices);
    for (k, &index) in indices.iter().enumerate() {
        assert_eq!(gathered.to_array().as_ref()[k].to_bits64(), column[index as usize].to_bits64());
    }

    let (lanes, tail) = L::arrays(&column);
    assert_eq!((lanes.len(), tail.len()), (100 / width, 100 % width));
    assert_eq!(bits(lanes[1].as_ref()), bits(&column[width..2 * width]));
}

#[test]
fn columns_come_and_go() {
    for_all_lanes!(moves_through_columns);
}

fn masks_know_their_lanes<L: Lane>() {
    let all = u32::MAX >> (32 - L::WIDTH);
    let mut random = Random(8);
    for case in 0..200 {
        let pattern = match case {
            0 => 0,
            1 => all,
            2..18 => 1 << (case - 2),
            _ => random.bits() as u32,
        } & all;
        let is_set = |k: usize| pattern >> k & 1 == 1;
        let zero = L::Scalar::ZERO;
        let mask = L::ZERO.lt(L::from_fn(|k| if is_set(k) { L::Scalar::ONE } else { zero }));
        assert_eq!(mask.bits(), pattern);
        assert_eq!((!mask).bits(), !pattern & all);
        assert_eq!(mask.any(), pattern != 0);
        assert_eq!(mask.all(), pattern == all);
    }
}

#[test]
fn masks_have_the_same_bits() {
    for_all_lanes!(masks_know_their_lanes);
}

/// Bodies of some number: position, velocity, spin, orientation.
fn columns<T: Bits>(len: usize) -> [Vec<T>; 18] {
    let mut random = Random(len as u64);
    core::array::from_fn(|_| (0..len).map(|_| random.unit()).collect())
}

fn sweeps_as_one_by_one<L: Lane>()
where
    L::Scalar: Bits,
{
    let bits = |columns: &[Vec<L::Scalar>]| -> Vec<u64> {
        columns.iter().flatten().map(|value| value.to_bits64()).collect()
    };
    let dt = L::Scalar::ratio(1, 10);
    let field = Vec3::new(L::Scalar::ZERO, dt, L::Scalar::whole(-10));
    let periodic = PeriodicBox::new([-L::Scalar::ONE; 3], [L::Scalar::ONE; 3]);
    for len in (0..40).chain([1000]) {
        for integrator in
            [Integrator::SemiImplicitEuler, Integrator::ExplicitEuler, Integrator::VelocityVerlet]
        {
            for field in [None, Some(field)] {
                let (mut swept, mut expected) = (columns(len), columns(len));
                let mut fastest = [L::Scalar::ZERO; 2];
                {
                    let [x, y, z, u, v, w, ..] = swept.each_mut().map(Vec::as_mut_slice);
                    let (position, velocity) = ([x, y, z], [u, v, w]);
                    fastest[0] = integrator
                        .flight_and_fastest::<L, _>(position, velocity, field, dt, periodic);
                }
                for k in 0..len {
                    let [x, y, z, u, v, w, ..] =
                        expected.each_mut().map(|column| &mut column[k..=k]);
                    let (position, velocity) = ([x, y, z], [u, v, w]);
                    fastest[1] = integrator
                        .flight_and_fastest::<L::Scalar, _>(position, velocity, field, dt, periodic)
                        .greater(fastest[1]);
                }
                assert_eq!(bits(&swept), bits(&expected));
                assert_eq!(fastest[0].to_bits64(), fastest[1].to_bits64());

                let [x, y, z, u, v, w, ..] = swept.each_mut().map(Vec::as_mut_slice);
                integrator.flight::<L, _>([x, y, z], [u, v, w], field, dt, OpenSpace);
                let [x, y, z, u, v, w, ..] = expected.each_mut().map(Vec::as_mut_slice);
                integrator.flight::<L::Scalar, _>([x, y, z], [u, v, w], field, dt, OpenSpace);
                assert_eq!(bits(&swept), bits(&expected));
            }
        }
        // From a small part of a turn to some whole turns.
        for time in [1, 3, 30].map(L::Scalar::whole) {
            let (mut swept, mut expected) = (columns(len), columns(len));
            let [_, _, _, _, _, _, x, y, z, m @ ..] = swept.each_mut();
            turn::<L>(m.map(Vec::as_mut_slice), [x, y, z], time);
            let [_, _, _, _, _, _, x, y, z, m @ ..] = expected.each_mut();
            turn::<L::Scalar>(m.map(Vec::as_mut_slice), [x, y, z], time);
            assert_eq!(bits(&swept), bits(&expected));
        }
    }
}

#[test]
fn sweeps_have_the_same_bits() {
    for_all_lanes!(sweeps_as_one_by_one);
}
