//! The change of the energy to many more digits than the energy has.

use crate::bodies::Bodies;
use crate::compensated::two_product;
use crate::observe::{CompensatedSum, Energy};
use crate::real::Real;
use crate::vec3::Vec3;

/// `E/E₀ − 1` of bodies in no field, without a rounding of the size of ε: the
/// squares of now and of the start are summed as one, with what each product
/// rounds off.
pub(super) fn relative_change<T: Real>(now: &Bodies<T>, start: &Bodies<T>) -> f64 {
    let mut twice = CompensatedSum::default();
    for (bodies, sign) in [(now, 1.0), (start, -1.0)] {
        for index in 0..bodies.len() {
            add(&mut twice, sign * bodies.mass.of(index).to_f64(), bodies.velocity_of(index));
            add(&mut twice, sign * bodies.inertia.of(index).to_f64(), bodies.spin_of(index));
        }
    }
    twice.value() / (2.0 * Energy::of(start, Vec3::ZERO).kinetic())
}

/// Adds `factor |vector|²`.
fn add<T: Real>(sum: &mut CompensatedSum, factor: f64, vector: Vec3<T>) {
    for component in vector.to_array().map(T::to_f64) {
        let (square, rest) = two_product(component, component);
        let (term, rounded_off) = two_product(factor, square);
        sum.add(term);
        sum.add(rounded_off + factor * rest);
    }
}
