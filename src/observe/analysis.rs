//! Analysis: what many looks at the bodies of a run amount to.
//!
//! An analysis looks at the bodies again and again, in a run or in recorded frames, and
//! adds up in `f64` what it sees, in the order of the bodies: threads and lanes change no
//! bit. Its memory is that of what is asked, whatever the number of looks.
//!
//! ```
//! use carom::engine::World;
//! use carom::observe::{Analysis, Moment};
//! use carom::scene::{AnalysisKind, AnalysisSettings, SceneFile};
//! use carom::Execution;
//!
//! let scene = SceneFile::builtin("hard-sphere-fluid").ok_or("no such scene")?.build::<f64>()?;
//! let space = scene.periodic;
//! let mut world = World::new(scene, Execution::default())?;
//! let settings = AnalysisSettings::of(AnalysisKind::RadialDistribution);
//! let bodies = world.bodies();
//! let start = Moment { time: 0.0, bodies: &bodies, space, images: None };
//! let mut analysis = Analysis::new(&settings, &start)?;
//! analysis.look(&start);
//! world.advance(0.1)?;
//! let bodies = world.bodies();
//! analysis.look(&Moment { time: 0.1, bodies: &bodies, space, images: None });
//! let findings = analysis.findings();
//! assert_eq!(findings.columns[0].0, "r");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod autocorrelation;
mod bonds;
mod displacement;
mod flights;
mod lags;
mod radial;
mod speeds;
mod structure;
mod tally;

use core::fmt;

#[cfg(feature = "files")]
use serde::{Deserialize, Serialize};

use super::species;
use crate::bodies::Bodies;
use crate::engine::Event;
use crate::numbers::array;
use crate::real::Real;
use crate::scene::{AnalysisKind, AnalysisSettings};
use crate::space::PeriodicBox;

use autocorrelation::VelocityAutocorrelation;
use bonds::BondOrder;
use displacement::MeanSquaredDisplacement;
use flights::CollisionStatistics;
use radial::RadialDistribution;
use speeds::SpeedDistribution;
use structure::StructureFactor;
pub use tally::Figure;
use tally::{Sums, Tally, columns};

/// The bodies at one time.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Time since the start.
    pub time: f64,
    /// All bodies.
    pub bodies: &'a Bodies<f64>,
    /// The periodic box; `None` in open space.
    pub space: Option<PeriodicBox<f64>>,
    /// Through how many whole boxes each body has moved; `None` in open space, or where
    /// positions are not wrapped.
    pub images: Option<&'a [[i32; 3]]>,
}

impl Moment<'_> {
    /// Where a body is in the space that a periodic box stands for.
    fn unwrapped(&self, index: usize) -> [f64; 3] {
        let place = self.bodies.position_of(index).to_array();
        let (Some(space), Some(images)) = (self.space, self.images) else { return place };
        let sides = space.sides().to_array();
        array::from_fn(|axis| place[axis] + sides[axis] * f64::from(images[index][axis]))
    }

    /// The volume of the periodic box, and its shortest side.
    fn cell(&self) -> Result<(f64, f64), Unfit> {
        let sides = self.space.map(|space| space.sides().to_array());
        let sides = sides.ok_or_else(|| {
            Unfit::new("kind", "in open space", "it is of bodies in a periodic box")
        })?;
        Ok((sides.iter().product(), sides.into_iter().fold(f64::INFINITY, f64::min)))
    }
}

/// Why an analysis cannot be made of bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unfit {
    /// The key of the settings that is to blame.
    pub key: &'static str,
    /// What it is.
    pub found: String,
    /// What would be right.
    pub wanted: String,
}

impl Unfit {
    fn new(key: &'static str, found: impl fmt::Display, wanted: impl Into<String>) -> Self {
        Self { key, found: found.to_string(), wanted: wanted.into() }
    }
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; {}", self.key, self.found, self.wanted)
    }
}

impl core::error::Error for Unfit {}

/// What an analysis has found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Findings {
    /// Columns of one length, each with its name; what means nothing is `None`.
    pub columns: Vec<(&'static str, Vec<Option<f64>>)>,
    /// Single figures.
    pub figures: Vec<Figure>,
    /// How many looks there were.
    pub looks: u64,
}

/// An analysis under way.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
pub struct Analysis {
    kind: Kind,
    /// Of how many bodies it is.
    bodies: usize,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
enum Kind {
    RadialDistribution(RadialDistribution),
    MeanSquaredDisplacement(MeanSquaredDisplacement),
    VelocityAutocorrelation(VelocityAutocorrelation),
    SpeedDistribution(SpeedDistribution),
    CollisionStatistics(CollisionStatistics),
    BondOrder(BondOrder),
    StructureFactor(StructureFactor),
}

impl Analysis {
    /// An analysis of bodies as they are at a moment. Nothing is looked at yet.
    ///
    /// # Errors
    /// If the settings do not fit the bodies or their space.
    pub fn new(settings: &AnalysisSettings, moment: &Moment<'_>) -> Result<Self, Unfit> {
        let chosen = Chosen::of(settings, moment)?;
        let kind = match settings.kind {
            AnalysisKind::RadialDistribution => {
                Kind::RadialDistribution(RadialDistribution::new(&chosen, moment)?)
            }
            AnalysisKind::MeanSquaredDisplacement => {
                Kind::MeanSquaredDisplacement(MeanSquaredDisplacement::new(&chosen)?)
            }
            AnalysisKind::VelocityAutocorrelation => {
                Kind::VelocityAutocorrelation(VelocityAutocorrelation::new(&chosen)?)
            }
            AnalysisKind::SpeedDistribution => {
                Kind::SpeedDistribution(SpeedDistribution::new(&chosen)?)
            }
            AnalysisKind::CollisionStatistics => {
                Kind::CollisionStatistics(CollisionStatistics::new(&chosen)?)
            }
            AnalysisKind::BondOrder => Kind::BondOrder(BondOrder::new(&chosen, moment)?),
            AnalysisKind::StructureFactor => {
                Kind::StructureFactor(StructureFactor::new(&chosen, moment)?)
            }
        };
        Ok(Self { kind, bodies: moment.bodies.len() })
    }

    /// Whether it is of collisions ([`hear`](Self::hear)), which no frame has.
    #[must_use]
    pub fn hears(&self) -> bool {
        matches!(self.kind, Kind::CollisionStatistics(_))
    }

    /// Looks at the bodies, at a later time than before.
    ///
    /// # Panics
    /// If there are not as many bodies as at the start.
    pub fn look(&mut self, moment: &Moment<'_>) {
        assert_eq!(moment.bodies.len(), self.bodies, "an analysis of other bodies");
        match &mut self.kind {
            Kind::RadialDistribution(it) => it.look(moment),
            Kind::MeanSquaredDisplacement(it) => it.look(moment),
            Kind::VelocityAutocorrelation(it) => it.look(moment),
            Kind::SpeedDistribution(it) => it.look(moment),
            Kind::CollisionStatistics(it) => it.look(),
            Kind::BondOrder(it) => it.look(moment),
            Kind::StructureFactor(it) => it.look(moment),
        }
    }

    /// Hears of a collision. Only those after the first look count.
    pub fn hear<T: Real>(&mut self, event: &Event<T>) {
        if let Kind::CollisionStatistics(it) = &mut self.kind {
            it.hear(event);
        }
    }

    /// What it has found so far.
    #[must_use]
    pub fn findings(&self) -> Findings {
        match &self.kind {
            Kind::RadialDistribution(it) => it.findings(),
            Kind::MeanSquaredDisplacement(it) => it.findings(),
            Kind::VelocityAutocorrelation(it) => it.findings(),
            Kind::SpeedDistribution(it) => it.findings(),
            Kind::CollisionStatistics(it) => it.findings(),
            Kind::BondOrder(it) => it.findings(),
            Kind::StructureFactor(it) => it.findings(),
        }
    }
}

/// Settings that were looked at once.
struct Chosen<'a> {
    settings: &'a AnalysisSettings,
    /// The bodies of each species that is chosen, in their order.
    members: Vec<Members>,
    /// How many bodies there are in all.
    bodies: usize,
}

/// Some of the bodies, in their order; `None` stands for all.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
struct Members {
    some: Option<Vec<u32>>,
    count: usize,
}

impl Members {
    /// Their indices.
    fn indices(&self) -> impl Iterator<Item = usize> + '_ {
        let all = if self.some.is_none() { 0..self.count } else { 0..0 };
        all.chain(self.some.iter().flatten().map(|index| *index as usize))
    }
}

/// The most bins that a range can be divided into.
const MOST_BINS: u64 = 100_000;

impl<'a> Chosen<'a> {
    fn of(settings: &'a AnalysisSettings, moment: &Moment<'_>) -> Result<Self, Unfit> {
        if let Some(bins) = settings.bins.filter(|bins| !(1..=MOST_BINS).contains(bins)) {
            return Err(Unfit::new("bins", bins, format!("it is a number from 1 to {MOST_BINS}")));
        }
        let [from, to] = settings.range.unwrap_or_default();
        let is_wrong = |value: Option<f64>| value.is_some_and(|it| !(it.is_finite() && it >= 0.0));
        let least = from.unwrap_or(0.0);
        if is_wrong(from) || is_wrong(to) || to.is_some_and(|to| to <= least) {
            let found = match (from, to) {
                (Some(from), Some(to)) => format!("[{from:?}, {to:?}]"),
                (from, to) => format!("{:?}", from.or(to).unwrap_or_default()),
            };
            let wanted = "it goes to a number above 0, or as [from, to] from one to a greater one";
            return Err(Unfit::new("range", found, wanted));
        }
        let of_all = || Members { some: None, count: moment.bodies.len() };
        let Some(numbers) = &settings.species else {
            return Ok(Self { settings, members: vec![of_all()], bodies: moment.bodies.len() });
        };
        let most = if settings.kind == AnalysisKind::RadialDistribution { 2 } else { 1 };
        let known = species(moment.bodies);
        let last = known.iter().copied().max().unwrap_or(1);
        let wanted = match most {
            2 => format!("it is one or two of the species 1 to {last}, as [1, 2]"),
            _ => format!("it is one of the species 1 to {last}, as [1]"),
        };
        let is_known = |number: &u64| (1..=u64::from(last)).contains(number);
        if !(1..=most).contains(&numbers.len()) || !numbers.iter().all(is_known) {
            return Err(Unfit::new("species", format!("{numbers:?}"), wanted));
        }
        let of = |number: &u64| {
            if last == 1 {
                return of_all();
            }
            let is_of = |(_, known): &(usize, &u32)| u64::from(**known) == *number;
            let some: Vec<u32> =
                known.iter().enumerate().filter(is_of).map(|(index, _)| index as u32).collect();
            Members { count: some.len(), some: Some(some) }
        };
        let members = numbers.iter().map(of).collect();
        Ok(Self { settings, members, bodies: moment.bodies.len() })
    }

    /// The bodies of the only species that is chosen.
    fn only(&self) -> Members {
        self.members[0].clone()
    }

    /// How many bins, with a number for those that chose none.
    fn bins(&self, usual: usize) -> usize {
        self.settings.bins.map_or(usual, |bins| bins as usize)
    }

    /// From where and to where, if it is chosen.
    fn range(&self) -> [Option<f64>; 2] {
        self.settings.range.unwrap_or_default()
    }

    /// An error if bins are chosen, for what has none.
    fn without_bins(&self) -> Result<(), Unfit> {
        match self.settings.bins {
            None => Ok(()),
            Some(bins) => {
                let wanted = format!("{} has no bins; leave it out", self.settings.kind.name());
                Err(Unfit::new("bins", bins, wanted))
            }
        }
    }

    /// An error if a lower end is chosen, for what begins at 0.
    fn begins_at_zero(&self) -> Result<(), Unfit> {
        match self.range()[0] {
            None | Some(0.0) => Ok(()),
            Some(from) => {
                let wanted = format!("{} begins at 0", self.settings.kind.name());
                Err(Unfit::new("range", format!("from {from:?}"), wanted))
            }
        }
    }
}

/// Bins of one width.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(Serialize, Deserialize))]
struct Bins {
    from: f64,
    width: f64,
    count: usize,
}

impl Bins {
    fn new(from: f64, to: f64, count: usize) -> Self {
        Self { from, width: (to - from) / count as f64, count }
    }

    /// The bin of a value, if it is in one.
    fn of(&self, value: f64) -> Option<usize> {
        let place = (value - self.from) / self.width;
        (place >= 0.0 && place < self.count as f64).then_some(place as usize)
    }

    /// The lower end of a bin, or with the count the upper end of the last one.
    fn edge(&self, bin: usize) -> f64 {
        self.from + self.width * bin as f64
    }

    /// The middle of a bin.
    fn middle(&self, bin: usize) -> f64 {
        self.from + self.width * (bin as f64 + 0.5)
    }

    /// What a tally of them has in each, over its width, and the errors: two columns.
    fn density(&self, tally: &Tally) -> (Vec<Option<f64>>, Vec<Option<f64>>) {
        let of = |sums: &Sums, bin| Some(sums.mean(bin)? / self.width);
        columns(&tally.figures(self.count, "density", of))
    }

    /// The middles of all, as a column.
    fn middles(&self) -> Vec<Option<f64>> {
        (0..self.count).map(|bin| Some(self.middle(bin))).collect()
    }
}
