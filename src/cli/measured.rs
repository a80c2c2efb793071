//! Measured: the part of a run that its figures are taken over, and what is taken.

use std::collections::BTreeMap;

use carom::contact::Surface;
use carom::engine::{Collisions, PartTotals, World};
use carom::observe::{Statistic, Temperature, collision_rate, compressibility};
use carom::real::Real;
use carom::study::{Course, Schedule};
use serde::{Deserialize, Serialize};

/// Into how many blocks the measured part of a gas is divided: a power of two, so that
/// their ends are exact.
const BLOCKS: u32 = 32;

/// By how much of their mean the lengths of blocks may differ, so that they count alike.
const UNEQUAL: f64 = 0.1;

/// What has added up at a moment of a run.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Reading {
    pub time: f64,
    pub collisions: Collisions,
    pub virial: f64,
    /// The lengths of all flights, where the engine knows them.
    path: f64,
}

impl Reading {
    fn of<T: Real>(world: &World<T>) -> Self {
        let collisions = world.collisions();
        // Where spheres come and go, the engine knows the flights since the last exchange only.
        let mean = world.mean_free_path().filter(|_| !world.has_flow());
        let path = mean.map_or(0.0, |mean| mean * collisions.ends() as f64);
        Self { time: world.time(), collisions, virial: world.virial(), path }
    }

    /// What has added up since an earlier reading.
    fn since(&self, earlier: &Self) -> Self {
        let (now, then) = (self.collisions, earlier.collisions);
        Self {
            time: self.time - earlier.time,
            collisions: now.since(then),
            virial: self.virial - earlier.virial,
            path: self.path - earlier.path,
        }
    }

    /// Mean length of the flights that ended.
    pub fn mean_free_path(&self) -> Option<f64> {
        let ends = self.collisions.ends();
        (self.path > 0.0 && ends > 0).then(|| self.path / ends as f64)
    }
}

/// The measured part of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measured {
    /// Where it begins, in steps or in time.
    begin: f64,
    /// What had added up there.
    before: Option<Reading>,
    /// The same of each part that is counted apart.
    parts_before: Vec<PartTotals>,
    gas: Option<Gas>,
}

/// A gas in a periodic box: its temperature, and what adds up block by block.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Gas {
    /// Whether collisions change its temperature.
    exchanges: bool,
    volume: f64,
    bodies: usize,
    /// At the end of each block, and where the first one begins.
    readings: Vec<(Reading, Temperature)>,
    last_position: f64,
    /// Temperature × position, by the trapezoidal rule.
    integral: f64,
}

impl Measured {
    /// What is measured after a time of equilibration; of a gas in a periodic box of a
    /// volume, block by block.
    pub fn new<T: Real>(
        world: &World<T>,
        course: &Course,
        equilibration: f64,
        gas: Option<(f64, Surface)>,
    ) -> Self {
        let begin = Schedule::new(world, course, 1.0).starting(equilibration).mark();
        let gas = gas.map(|(volume, surface)| Gas {
            exchanges: surface.changes_spins(),
            volume,
            bodies: world.plan().bodies,
            readings: Vec::new(),
            last_position: 0.0,
            integral: 0.0,
        });
        Self { begin: begin.unwrap_or(0.0), before: None, parts_before: Vec::new(), gas }
    }

    /// The same on a course of another length: the blocks begin again.
    pub fn stretched(mut self) -> Self {
        if let Some(gas) = &mut self.gas {
            let last = gas.readings.pop();
            gas.readings.clear();
            gas.readings.extend(last);
        }
        self
    }

    /// Where something is due next, on a course of this length.
    pub fn mark(&self, length: f64) -> Option<f64> {
        let Some(gas) = self.gas.as_ref().filter(|_| self.before.is_some()) else {
            return self.before.is_none().then_some(self.begin);
        };
        let passed = gas.readings.len() as u32;
        if passed >= BLOCKS {
            return (passed == BLOCKS).then_some(length);
        }
        Some(self.begin + (length - self.begin) * (f64::from(passed) / f64::from(BLOCKS)))
    }

    /// Takes what is due at a place. The temperature is only asked for where it can have
    /// changed.
    pub fn take<T: Real>(
        &mut self,
        world: &World<T>,
        position: f64,
        temperature: impl FnOnce() -> Option<Temperature>,
    ) {
        let reading = Reading::of(world);
        if self.before.is_none() {
            (self.before, self.parts_before) = (Some(reading), world.parts());
        }
        let Some(gas) = &mut self.gas else { return };
        let count = gas.readings.len();
        let last = gas.readings.last().map(|(_, last)| *last);
        // Where nothing changes the temperature, its ends show what rounding does.
        let is_needed = gas.exchanges || count == 0 || count == BLOCKS as usize;
        let now = if is_needed { temperature() } else { last };
        let now = now.or(last).unwrap_or_default();
        if let Some(last) = last.filter(|_| is_needed) {
            let mean = 0.5 * (last.translational + now.translational);
            gas.integral += mean * (position - gas.last_position);
        }
        if is_needed {
            gas.last_position = position;
        }
        gas.readings.push((reading, now));
    }

    /// What has added up in the measured part.
    pub fn total<T: Real>(&self, world: &World<T>) -> Reading {
        Reading::of(world).since(&self.before.unwrap_or_default())
    }

    /// What has added up in it of each part that is counted apart.
    pub fn parts<T: Real>(&self, world: &World<T>) -> Vec<PartTotals> {
        let mut parts = world.parts();
        for (part, before) in parts.iter_mut().zip(&self.parts_before) {
            *part = part.since(before);
        }
        parts
    }

    /// The mean translational temperature, of a gas, on a course of this length.
    pub fn mean_temperature(&self, length: f64) -> Option<f64> {
        let gas = self.gas.as_ref()?;
        Some(gas.integral / (length - self.begin))
    }

    /// Means with their errors, by name; none where there are too few blocks.
    pub fn statistics(&self, length: f64) -> BTreeMap<&'static str, Statistic> {
        let whole = self.mean_temperature(length).zip(self.gas.as_ref());
        whole.map_or_else(BTreeMap::new, |(temperature, gas)| gas.statistics(temperature))
    }
}

impl Gas {
    fn statistics(&self, temperature: f64) -> BTreeMap<&'static str, Statistic> {
        let mut statistics = BTreeMap::new();
        let (Some((first, _)), Some((last, _))) = (self.readings.first(), self.readings.last())
        else {
            return statistics;
        };
        let whole = last.since(first);
        let length = whole.time / f64::from(BLOCKS);
        let blocks: Vec<(Reading, f64, f64)> = self
            .readings
            .windows(2)
            .map(|ends| {
                let [(before, cold), (after, warm)] = [ends[0], ends[1]];
                let mean = 0.5 * (cold.translational + warm.translational);
                let spin = 0.5 * (cold.rotational + warm.rotational);
                let mean = if self.exchanges { mean } else { temperature };
                (after.since(&before), mean, spin)
            })
            .collect();
        let is_equal = |time: f64| (time - length).abs() <= UNEQUAL * length;
        if blocks.len() != BLOCKS as usize || !blocks.iter().all(|(block, ..)| is_equal(block.time))
        {
            return statistics;
        }
        let bodies = self.bodies;
        let factor = |block: &Reading, temperature: f64| {
            compressibility(bodies, block.virial, temperature, block.time)
        };
        let pressure = |block: &Reading, temperature: f64| {
            factor(block, temperature) * bodies as f64 * temperature / self.volume
        };
        let rate = |block: &Reading| collision_rate(bodies, block.collisions.pairs, block.time);
        let mut add = |name, figure: &dyn Fn(&(Reading, f64, f64)) -> f64, mean: f64| {
            let values: Vec<f64> = blocks.iter().map(figure).collect();
            if let Some(statistic) = Statistic::of(&values) {
                statistics.insert(name, statistic.about(mean));
            }
        };
        add("compressibility", &|(block, kt, _)| factor(block, *kt), factor(&whole, temperature));
        add("pressure", &|(block, kt, _)| pressure(block, *kt), pressure(&whole, temperature));
        add("collision_rate", &|(block, ..)| rate(block), rate(&whole));
        if self.exchanges {
            add("temperature", &|(_, kt, _)| *kt, temperature);
            let spin = blocks.iter().map(|(_, _, spin)| spin).sum::<f64>() / f64::from(BLOCKS);
            add("spin_temperature", &|(_, _, spin)| *spin, spin);
        }
        if let Some(mean) = whole.mean_free_path() {
            add("mean_free_path", &|(block, ..)| block.mean_free_path().unwrap_or(mean), mean);
        }
        statistics
    }
}
