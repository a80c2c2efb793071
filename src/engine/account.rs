//! Account: what is added up over all collisions.

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::parts::Counter;
use super::{Collisions, PartTotals};
use crate::compensated::ExactSum;
use crate::numbers::array::Each;
use crate::real::Real;
use crate::vec3::Vec3;

/// What it took to find collisions.
///
/// ```
/// use carom::{EventDriven, Scene, Sphere};
///
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.advance(1.0)?;
/// assert!(world.effort().remaining <= world.effort().tried);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Effort {
    /// Pairs whose contact was looked for.
    pub tried: u64,
    /// Those of them that the coarse precision left to the full one.
    pub remaining: u64,
    /// How often bodies crossed from one cell to the next.
    pub crossings: u64,
    /// How often a body's contacts were looked for again, since all that it
    /// knew of had been overtaken.
    pub searches: u64,
    /// Collisions that were taken back, since an earlier one was found: of the order of
    /// windows only.
    pub undone: u64,
}

/// `J_n·x` of a collision, mass × length² per time.
#[inline(always)]
fn virial<T: Real>(normal: Vec3<T>, offset: Vec3<T>) -> f64 {
    let (normal, offset) = (normal.cast::<f64>(), offset.cast::<f64>());
    normal.dot(offset)
}

/// What collisions have added up to.
#[derive(Clone, Copy, Debug)]
pub struct Totals {
    pub collisions: Collisions,
    /// `Σ J_n·x` over pairs, mass × length² per time.
    pub virial: f64,
    /// `Σ J` over the surroundings, mass × length per time.
    pub impulse: [f64; 3],
}

/// Counts and sums over the collisions so far. They do not depend on the order, which
/// workers decide: what is taken back is subtracted, and what workers have added up is
/// merged. A restart file keeps all of it.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Account {
    pub collisions: Collisions,
    pub effort: Effort,
    virial: ExactSum,
    /// Of the parts of the surroundings that are not counted apart.
    impulse: [ExactSum; 3],
    /// Of those that are; as many as have been met.
    parts: Vec<PartSum>,
    path: ExactSum,
}

/// What collisions with one part of the surroundings add up to.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct PartSum {
    collisions: u64,
    impulse: [ExactSum; 3],
    /// `Σ|J_n|`, of parts with a name.
    normal: ExactSum,
}

impl PartSum {
    /// What is added up so far, of a part.
    pub fn totals(&self, part: u32) -> PartTotals {
        let impulse = self.impulse.refs().each(ExactSum::value);
        let normal_impulse = self.normal.value();
        PartTotals {
            part,
            collisions: self.collisions,
            impulse,
            normal_impulse,
            area: None,
            removed: 0,
            passages: None,
        }
    }

    fn merge(&mut self, other: &Self) {
        self.collisions = self.collisions.wrapping_add(other.collisions);
        merge(&mut self.impulse, &other.impulse);
        self.normal.merge(&other.normal);
    }
}

fn merge(sums: &mut [ExactSum; 3], others: &[ExactSum; 3]) {
    for (sum, other) in sums.iter_mut().zip(others) {
        sum.merge(other);
    }
}

impl Account {
    /// Counts a collision of two bodies: its normal impulse on the first, and
    /// the offset from the second centre to the first.
    #[inline(always)]
    pub fn pair<T: Real>(&mut self, normal: Vec3<T>, offset: Vec3<T>) {
        // A worker may have taken more back than it has counted.
        self.collisions.pairs = self.collisions.pairs.wrapping_add(1);
        self.virial.add(virial(normal, offset));
    }

    /// Counts a collision with something fixed, by the normal and the tangential impulse on
    /// the body and the part's counter.
    #[inline(always)]
    pub fn surroundings<T: Real>(
        &mut self,
        [normal, tangential]: [Vec3<T>; 2],
        counter: Option<Counter>,
    ) {
        self.collisions.surroundings = self.collisions.surroundings.wrapping_add(1);
        self.add_impulse([normal, tangential], counter, T::ONE, 1);
    }

    /// Adds to the sums of a counter, by a sign, and to its count, which may wrap.
    #[inline(always)]
    fn add_impulse<T: Real>(
        &mut self,
        [normal, tangential]: [Vec3<T>; 2],
        counter: Option<Counter>,
        sign: T,
        count: u64,
    ) {
        let sums = match counter {
            None => &mut self.impulse,
            Some(Counter { index, is_named, .. }) => {
                let part = self.part(index);
                part.collisions = part.collisions.wrapping_add(count);
                if is_named {
                    part.normal.add((normal.length() * sign).to_f64());
                }
                &mut part.impulse
            }
        };
        for (sum, j) in sums.iter_mut().zip((normal + tangential).to_array()) {
            sum.add((j * sign).to_f64());
        }
    }

    #[inline(always)]
    fn part(&mut self, counter: usize) -> &mut PartSum {
        if counter >= self.parts.len() {
            self.parts.resize_with(counter + 1, PartSum::default);
        }
        &mut self.parts[counter]
    }

    /// Adds the length of a flight that has ended.
    #[inline(always)]
    pub fn flight<T: Real>(&mut self, length: T) {
        self.path.add(length.to_f64());
    }

    /// Takes a collision of two bodies back, which another worker may have counted.
    pub fn undo_pair<T: Real>(&mut self, normal: Vec3<T>, offset: Vec3<T>) {
        self.collisions.pairs = self.collisions.pairs.wrapping_sub(1);
        self.virial.add(-virial(normal, offset));
    }

    /// Takes a collision with something fixed back.
    pub fn undo_surroundings<T: Real>(&mut self, impulses: [Vec3<T>; 2], counter: Option<Counter>) {
        self.collisions.surroundings = self.collisions.surroundings.wrapping_sub(1);
        self.add_impulse(impulses, counter, -T::ONE, u64::MAX);
    }

    /// Takes the end of a flight back.
    pub fn undo_flight<T: Real>(&mut self, length: T) {
        self.path.add(-length.to_f64());
    }

    /// Adds what another worker has added up.
    pub fn merge(&mut self, other: &Self) {
        let add = |one: &mut u64, other: u64| *one = one.wrapping_add(other);
        add(&mut self.collisions.pairs, other.collisions.pairs);
        add(&mut self.collisions.surroundings, other.collisions.surroundings);
        self.effort.tried += other.effort.tried;
        self.effort.remaining += other.effort.remaining;
        self.effort.crossings += other.effort.crossings;
        self.effort.searches += other.effort.searches;
        self.effort.undone += other.effort.undone;
        self.virial.merge(&other.virial);
        self.path.merge(&other.path);
        merge(&mut self.impulse, &other.impulse);
        for (counter, other) in other.parts.iter().enumerate() {
            self.part(counter).merge(other);
        }
    }

    /// The sum of the lengths of all flights that have ended.
    pub fn path(&self) -> f64 {
        self.path.value()
    }

    /// Of the parts of the surroundings that are counted apart, by their counters.
    pub fn parts(&self) -> &[PartSum] {
        &self.parts
    }

    /// What is added up so far.
    pub fn totals(&self) -> Totals {
        let mut impulse = self.impulse.clone();
        self.parts.iter().for_each(|part| merge(&mut impulse, &part.impulse));
        Totals {
            collisions: self.collisions,
            virial: self.virial.value(),
            impulse: impulse.refs().each(ExactSum::value),
        }
    }
}
