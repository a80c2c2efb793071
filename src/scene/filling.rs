//! Filling: bodies while they are put together.

use core::ops::Range;

use super::figures::{Figures, Values};
use super::random::{Purpose, Random, Seed};
use super::spheres::{Make, Spheres};
use crate::bodies::{Bodies, Columns3, Origin, PerBody};
use crate::column::Column;
use crate::mat3::Mat3;
use crate::numbers::array::{self, Each};
use crate::real::Real;

/// A figure of all bodies that gets a column once two of them differ.
struct Sparse<T: Real> {
    len: usize,
    values: Option<PerBody<T>>,
}

impl<T: Real> Sparse<T> {
    fn set(&mut self, index: usize, value: T) {
        match &mut self.values {
            None => self.values = Some(PerBody::Same(value)),
            Some(PerBody::Same(same)) if *same == value => {}
            Some(PerBody::Same(same)) => {
                let mut column = Column::new(self.len, T::ONE);
                column.fill(*same);
                column[index] = value;
                self.values = Some(PerBody::Each(column));
            }
            Some(PerBody::Each(column)) => column[index] = value,
        }
    }

    fn set_all(&mut self, start: usize, count: usize, values: &Values) {
        for k in 0..count {
            self.set(start + k, T::from_f64(values.of(k)));
        }
    }

    fn into_values(self) -> PerBody<T> {
        self.values.unwrap_or(PerBody::Same(T::ONE))
    }
}

/// Bodies that are being filled in.
pub(super) struct Filling<T: Real> {
    position: Columns3<T>,
    velocity: Columns3<T>,
    spin: Columns3<T>,
    orientation: Option<Box<[Column<T>; 9]>>,
    radius: Sparse<T>,
    mass: Sparse<T>,
    inertia: Sparse<T>,
}

impl<T: Real> Filling<T> {
    pub(super) fn new(len: usize) -> Self {
        let columns = || array::from_fn(|_| Column::new(len, T::ZERO));
        let sparse = || Sparse { len, values: None };
        Self {
            position: columns(),
            velocity: columns(),
            spin: columns(),
            orientation: None,
            radius: sparse(),
            mass: sparse(),
            inertia: sparse(),
        }
    }

    pub(super) fn figures(&mut self, start: usize, count: usize, figures: &Figures) {
        self.radius.set_all(start, count, &figures.radius);
        self.mass.set_all(start, count, &figures.mass);
        self.inertia.set_all(start, count, &figures.inertia);
    }

    pub(super) fn place(&mut self, index: usize, center: [f64; 3]) {
        set(&mut self.position, index, center);
    }

    /// How one sphere starts.
    pub(super) fn start(&mut self, index: usize, make: &Make) {
        set(&mut self.velocity, index, make.velocity);
        set(&mut self.spin, index, make.spin);
    }

    /// How a group starts: what is common to all, and what its temperatures
    /// add.
    pub(super) fn motion(
        &mut self,
        range: &Range<usize>,
        spheres: &Spheres,
        figures: &Figures,
        seed: Seed,
    ) {
        velocities(range.len(), spheres, figures, seed, |k, velocity| {
            set(&mut self.velocity, range.start + k, velocity);
        });
        spins(range.len(), spheres, figures, seed, |k, spin| {
            set(&mut self.spin, range.start + k, spin);
        });
    }

    /// The velocities with which a group of its own starts.
    #[cfg(feature = "files")]
    pub(super) fn velocities(
        count: usize,
        spheres: &Spheres,
        figures: &Figures,
        seed: Seed,
    ) -> Columns3<T> {
        drawn(count, |take| velocities(count, spheres, figures, seed, take))
    }

    /// The spins with which a group of its own starts.
    #[cfg(feature = "files")]
    pub(super) fn spins(
        count: usize,
        spheres: &Spheres,
        figures: &Figures,
        seed: Seed,
    ) -> Columns3<T> {
        drawn(count, |take| spins(count, spheres, figures, seed, take))
    }

    pub(super) fn copy(&mut self, start: usize, bodies: &Bodies<T>) {
        let range = start..start + bodies.len();
        for axis in 0..3 {
            self.position[axis][range.clone()].copy_from_slice(&bodies.position[axis]);
            self.velocity[axis][range.clone()].copy_from_slice(&bodies.velocity[axis]);
            self.spin[axis][range.clone()].copy_from_slice(&bodies.spin[axis]);
        }
        if let Some(orientation) = &bodies.orientation {
            let len = self.position[0].len();
            let world = Mat3::<T>::IDENTITY.rows();
            let all = self.orientation.get_or_insert_with(|| {
                Box::new(array::from_fn(|element| Column::new(len, world[element])))
            });
            for (all, these) in all.iter_mut().zip(orientation.iter()) {
                all[range.clone()].copy_from_slice(these);
            }
        }
        for k in 0..bodies.len() {
            self.radius.set(start + k, bodies.radius.of(k));
            self.mass.set(start + k, bodies.mass.of(k));
            self.inertia.set(start + k, bodies.inertia.of(k));
        }
    }

    pub(super) fn into_bodies(self) -> Bodies<T> {
        Bodies {
            origin: Origin::Described,
            position: self.position,
            velocity: self.velocity,
            spin: self.spin,
            orientation: self.orientation,
            radius: self.radius.into_values(),
            mass: self.mass.into_values(),
            inertia: self.inertia.into_values(),
        }
    }
}

/// Columns of `count` vectors that a function gives one by one.
#[cfg(feature = "files")]
fn drawn<T: Real>(count: usize, draw: impl FnOnce(&mut dyn FnMut(usize, [f64; 3]))) -> Columns3<T> {
    let mut columns = array::from_fn(|_| Column::new(count, T::ZERO));
    draw(&mut |k, vector| set(&mut columns, k, vector));
    columns
}

/// Draws the velocities of a group.
fn velocities(
    count: usize,
    spheres: &Spheres,
    figures: &Figures,
    seed: Seed,
    mut take: impl FnMut(usize, [f64; 3]),
) {
    let random = || seed.random(Purpose::Velocity);
    let temperature = spheres.temperature;
    let mut drift = spheres.make.velocity;
    if temperature > 0.0 {
        // A first draw of the same numbers finds the mean to take away.
        let mut momentum = [0.0; 3];
        let mut total = 0.0;
        thermal(count, temperature, &figures.mass, random(), |k, velocity| {
            let mass = figures.mass.of(k);
            total += mass;
            for axis in 0..3 {
                momentum[axis] += mass * velocity[axis];
            }
        });
        drift = array::from_fn(|axis| drift[axis] - momentum[axis] / total);
    }
    thermal(count, temperature, &figures.mass, random(), |k, velocity| {
        take(k, array::from_fn(|i| velocity[i] + drift[i]));
    });
}

/// Draws the spins of a group.
fn spins(
    count: usize,
    spheres: &Spheres,
    figures: &Figures,
    seed: Seed,
    mut take: impl FnMut(usize, [f64; 3]),
) {
    let (random, common) = (seed.random(Purpose::Spin), spheres.make.spin);
    thermal(count, spheres.spin_temperature, &figures.inertia, random, |k, spin| {
        take(k, array::from_fn(|i| spin[i] + common[i]));
    });
}

/// Draws `count` vectors of a Maxwell distribution: each component with
/// variance `kT` over the inertia.
pub(super) fn thermal(
    count: usize,
    temperature: f64,
    inertia: &Values,
    mut random: Random,
    mut take: impl FnMut(usize, [f64; 3]),
) {
    for k in 0..count {
        if temperature > 0.0 {
            let width = (temperature / inertia.of(k)).sqrt();
            take(k, random.normal3().each(|z| z * width));
        } else {
            take(k, [0.0; 3]);
        }
    }
}

fn set<T: Real>(columns: &mut Columns3<T>, index: usize, vector: [f64; 3]) {
    for (column, component) in columns.iter_mut().zip(vector) {
        column[index] = T::from_f64(component);
    }
}
