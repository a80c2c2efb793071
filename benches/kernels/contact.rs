//! Contacts of two bodies, on contiguous pairs: the impulse, and the time.

use carom::contact::{self, Party, collide, past_contact};
use carom::lane::Lane;
use carom::real::Real;
use carom::vec3::Vec3;
use criterion::Criterion;

use crate::columns::uniform;
use crate::formula::{Formula, measure};

/// Pairs: fifteen columns of them stay in the cache.
const PAIRS: usize = 960;

/// All benches of this file.
pub fn benches<T: Real>(criterion: &mut Criterion) {
    let smooth = uniform::<T, 9>(PAIRS, -1.0, 1.0, 5);
    measure(criterion, "collide/smooth", &smooth, &Smooth);
    let rough = uniform::<T, 15>(PAIRS, -1.0, 1.0, 6);
    measure(criterion, "collide/rough", &rough, &Rough);
    let relative = uniform::<T, 6>(PAIRS, -1.0, 1.0, 7);
    measure(criterion, "past_contact", &relative, &PastContact);
}

/// Two equal solid spheres; half of the random ones approach.
fn equal<L: Lane>(velocity: [L; 3], spin: [L; 3]) -> Party<L> {
    Party {
        velocity: velocity.into(),
        spin: spin.into(),
        inverse_mass: L::ONE,
        inverse_inertia: L::ratio(10, 1),
        share: L::ratio(1, 2),
    }
}

struct Smooth;

impl<T: Real> Formula<T, 9, 6> for Smooth {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, [x, y, z, ux, uy, uz, vx, vy, vz]: [L; 9]) -> [L; 6] {
        let mut a = equal([ux, uy, uz], [L::ZERO; 3]);
        let mut b = equal([vx, vy, vz], [L::ZERO; 3]);
        collide(contact::Smooth, Vec3::new(x, y, z), &mut a, &mut b);
        joined([a.velocity, b.velocity])
    }
}

struct Rough;

impl<T: Real> Formula<T, 15, 12> for Rough {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, inputs: [L; 15]) -> [L; 12] {
        let [x, y, z, ux, uy, uz, vx, vy, vz, px, py, pz, qx, qy, qz] = inputs;
        let mut a = equal([ux, uy, uz], [px, py, pz]);
        let mut b = equal([vx, vy, vz], [qx, qy, qz]);
        collide(contact::Rough, Vec3::new(x, y, z), &mut a, &mut b);
        joined([a.velocity, b.velocity, a.spin, b.spin])
    }
}

/// The components of some vectors, one after another.
#[inline(always)]
fn joined<L: Lane, const N: usize, const COMPONENTS: usize>(
    vectors: [Vec3<L>; N],
) -> [L; COMPONENTS] {
    let vectors = vectors.map(Vec3::to_array);
    core::array::from_fn(|k| vectors[k / 3][k % 3])
}

struct PastContact;

impl<T: Real> Formula<T, 6, 1> for PastContact {
    #[inline(always)]
    fn of<L: Lane<Scalar = T>>(&self, [x, y, z, u, v, w]: [L; 6]) -> [L; 1] {
        let contact = past_contact(Vec3::new(x, y, z), Vec3::new(u, v, w), L::ONE);
        [L::select(contact.met, contact.ago, L::ZERO)]
    }
}
