//! Generation: from the entries of a scene to its bodies.

use core::ops::Range;

use super::arrangement::{self, Layout, Region, free_place};
use super::description::{Description, Entry, GivenBox, Periodicity};
use super::error::{Problem, SceneError};
use super::figures::Figures;
use super::filling::Filling;
use super::obstacles::Obstacles;
use super::random::{Purpose, Seed};
use super::settings::Encounters;
use super::spheres::{Arrangement, Spheres, Spread};
use crate::bodies::Bodies;
use crate::numbers::array;
use crate::real::Real;
use crate::space::PeriodicBox;
use crate::space::neighbours::Neighbours;
use crate::surroundings::is_positive;

/// The periodic box, as given or sized by a number density.
pub(super) fn periodic_box<T: Real>(
    asked: &Description<T>,
) -> Result<Option<GivenBox<T>>, SceneError> {
    let mut sized = asked.entries.iter().enumerate().filter_map(|(index, entry)| match entry {
        Entry::Many(spheres) => spheres.number_density.map(|density| (index, spheres, density)),
        _ => None,
    });
    let first = sized.next();
    let key = |index| format!("spheres[{index}].number_density");
    match (asked.periodic, first) {
        (Periodicity::Open, None) => Ok(None),
        (Periodicity::Box(given), None) => Ok(Some(given)),
        (Periodicity::Cube, None) => {
            let problem = Problem::value(
                "cube",
                "one group of spheres has to size the cube with a number_density",
            );
            Err(asked.origin.error("periodic", problem))
        }
        (Periodicity::Open, Some((index, ..))) => {
            let reason = "write periodic = \"cube\" at the top, which it sizes";
            let problem = Problem::conflict("open space", reason);
            Err(asked.origin.error(key(index), problem))
        }
        (Periodicity::Box(_), Some((index, ..))) => {
            let reason = "the box has its size already; write periodic = \"cube\" instead of it";
            let problem = Problem::conflict("the bounds of a periodic box", reason);
            Err(asked.origin.error(key(index), problem))
        }
        (Periodicity::Cube, Some((index, spheres, density))) => {
            if let Some((second, ..)) = sized.next() {
                let reason = "one group sizes the cube, the others fill it";
                let problem = Problem::conflict(key(index), reason);
                return Err(asked.origin.error(key(second), problem));
            }
            if spheres.bounds.is_some() {
                let reason = "the cube that it sizes is what the spheres fill";
                let problem = Problem::conflict(format!("spheres[{index}].lower"), reason);
                return Err(asked.origin.error(key(index), problem));
            }
            let side = cube_root(spheres.count as f64 / density);
            if !is_positive::<T>(side) {
                let wanted = "it has to make a cube of a size that is finite and not 0";
                return Err(asked.origin.error(key(index), Problem::value(density, wanted)));
            }
            Ok(Some(GivenBox::exact(PeriodicBox::new([0.0; 3], [side; 3]))))
        }
    }
}

/// Cube root by Newton's method from above: the platform's own has other bits
/// on every platform.
pub(super) fn cube_root(value: f64) -> f64 {
    let mut root = value.max(1.0);
    loop {
        let next = root - (root - value / (root * root)) / 3.0;
        if next >= root || !next.is_finite() {
            return root;
        }
        root = next;
    }
}

/// The bodies of all entries, in their order. Entries with a place of their own
/// and lattices settle first, then random groups scatter among them.
pub(super) fn bodies<T: Real>(
    asked: &mut Description<T>,
    periodic: Option<PeriodicBox<f64>>,
    ranges: &[Range<usize>],
) -> Result<Bodies<T>, SceneError> {
    if let [Entry::Ready(_)] = asked.entries.as_slice()
        && let Some(Entry::Ready(bodies)) = asked.entries.pop()
    {
        return Ok(*bodies);
    }
    let asked = &*asked;
    let layouts = layouts(asked, periodic)?;
    let len = ranges.last().map_or(0, |range| range.end);
    let has_random = layouts.iter().any(|layout| matches!(layout, Some(Layout::Random(_))));
    let must_find_room = has_random && asked.encounters == Encounters::All;
    let mut generation = Generation {
        filling: Filling::new(len),
        neighbours: must_find_room
            .then(|| Neighbours::new(len, greatest_radius(asked), 0.0, periodic)),
    };
    let entries = || asked.entries.iter().zip(ranges).zip(&layouts).enumerate();
    for (index, ((entry, range), layout)) in entries() {
        generation.settle(entry, range, layout.as_ref(), seed(asked, entry, index));
    }
    let fixed: Vec<_> = match asked.encounters {
        Encounters::None => Vec::new(),
        _ => asked.surroundings.iter().map(|given| given.exact.clone()).collect(),
    };
    let fixed = Obstacles::new(&fixed);
    for (index, ((entry, range), layout)) in entries() {
        if let (Entry::Many(spheres), Some(Layout::Random(region))) = (entry, layout) {
            generation.scatter(spheres, range, region, &fixed, seed(asked, entry, index)).map_err(
                |problem| asked.origin.error(format!("spheres[{index}].count"), problem),
            )?;
        }
    }
    Ok(generation.filling.into_bodies())
}

/// Bodies that are being put in their places.
struct Generation<T: Real> {
    filling: Filling<T>,
    /// Those that have a place, if random groups have to find room among them.
    neighbours: Option<Neighbours>,
}

impl<T: Real> Generation<T> {
    fn place(&mut self, index: usize, center: [f64; 3], radius: f64) {
        self.filling.place(index, center);
        if let Some(table) = &mut self.neighbours {
            table.insert(index as u32, center, radius);
        }
    }

    /// Everything about an entry but the places of a random group.
    fn settle(
        &mut self,
        entry: &Entry<T>,
        range: &Range<usize>,
        layout: Option<&Layout>,
        seed: Seed,
    ) {
        match entry {
            Entry::One(sphere) => {
                let figures = Figures::new(&sphere.make, 1, seed);
                self.filling.figures(range.start, 1, &figures);
                self.filling.start(range.start, &sphere.make);
                self.place(range.start, sphere.position, figures.radius.of(0));
            }
            Entry::Many(spheres) => {
                let figures = Figures::new(&spheres.make, range.len(), seed);
                self.filling.figures(range.start, range.len(), &figures);
                self.filling.motion(range, spheres, &figures, seed);
                if let Some(Layout::Lattice(lattice)) = layout {
                    for k in 0..range.len() {
                        self.place(range.start + k, lattice.site(k as u64), figures.radius.of(k));
                    }
                }
            }
            Entry::Ready(bodies) => {
                self.filling.copy(range.start, bodies);
                if let Some(table) = &mut self.neighbours {
                    for k in 0..bodies.len() {
                        let center = bodies.position_of(k).cast().to_array();
                        let radius = bodies.radius.of(k).to_f64();
                        table.insert((range.start + k) as u32, center, radius);
                    }
                }
            }
        }
    }

    /// The places of a random group.
    fn scatter(
        &mut self,
        spheres: &Spheres,
        range: &Range<usize>,
        region: &Region,
        fixed: &Obstacles<f64>,
        seed: Seed,
    ) -> Result<(), Problem> {
        let figures = Figures::new(&spheres.make, range.len(), seed);
        let mut random = seed.random(Purpose::Position);
        let mut attempts = arrangement::attempts(spheres.count);
        for k in 0..range.len() {
            let radius = figures.radius.of(k);
            let table = self.neighbours.as_ref();
            let place = free_place(region, radius, fixed, table, &mut random, &mut attempts);
            let Some(center) = place else {
                let reason = format!(
                    "after {} attempts there was no free place for sphere {k} of the group, of \
                     radius {radius:?}; take fewer or smaller ones, a larger box, or a lattice",
                    arrangement::attempts(spheres.count)
                );
                return Err(Problem::NoRoom { count: spheres.count, reason });
            };
            self.place(range.start + k, center, radius);
        }
        Ok(())
    }
}

/// The layouts of all groups, before anything is allocated for them.
fn layouts<T: Real>(
    asked: &Description<T>,
    periodic: Option<PeriodicBox<f64>>,
) -> Result<Vec<Option<Layout>>, SceneError> {
    let layout = |(index, entry): (usize, &Entry<T>)| {
        let Entry::Many(spheres) = entry else {
            return Ok(None);
        };
        let key = format!("spheres[{index}]");
        let Some(region) = region(asked, spheres, periodic) else {
            let wanted = "nothing bounds these spheres: give lower and upper, a periodic box or a \
                          container";
            return Err(asked.origin.error(format!("{key}.lower"), Problem::missing(wanted)));
        };
        let can_meet = asked.encounters == Encounters::All;
        let radius = spheres.make.radius.unwrap_or(Spread::Same(0.0));
        Layout::new(spheres.arrangement, spheres.count, &radius, region, can_meet)
            .map(Some)
            .map_err(|problem| asked.origin.error(format!("{key}.count"), problem))
    };
    asked.entries.iter().enumerate().map(layout).collect()
}

/// The box that a group fills.
fn region<T: Real>(
    asked: &Description<T>,
    spheres: &Spheres,
    periodic: Option<PeriodicBox<f64>>,
) -> Option<Region> {
    if let Some([lower, upper]) = spheres.bounds {
        return Some(Region { lower, upper, is_periodic: false });
    }
    if let Some(space) = periodic {
        let [lower, upper] = [space.lower.to_array(), space.upper.to_array()];
        return Some(Region { lower, upper, is_periodic: true });
    }
    // What all containers have in common; a lattice takes a box inside of it.
    let is_lattice = spheres.arrangement != Arrangement::Random;
    let interiors = asked.surroundings.iter().filter_map(|given| {
        let shape = &given.exact;
        let [lower, upper] = if is_lattice { shape.inscribed() } else { shape.interior() }?;
        Some(Region { lower: lower.to_array(), upper: upper.to_array(), is_periodic: false })
    });
    interiors.reduce(|a, b| Region {
        lower: array::from_fn(|axis| a.lower[axis].max(b.lower[axis])),
        upper: array::from_fn(|axis| a.upper[axis].min(b.upper[axis])),
        is_periodic: false,
    })
}

/// The greatest radius of all entries.
fn greatest_radius<T: Real>(asked: &Description<T>) -> f64 {
    let radius = |entry: &Entry<T>| match entry {
        Entry::One(sphere) => sphere.make.radius.map_or(0.0, |radius| radius.greatest()),
        Entry::Many(spheres) => spheres.make.radius.map_or(0.0, |radius| radius.greatest()),
        Entry::Ready(bodies) => bodies.radius.greatest().to_f64(),
    };
    asked.entries.iter().map(radius).fold(0.0, f64::max)
}

/// Where the random numbers of an entry come from.
fn seed<T: Real>(asked: &Description<T>, entry: &Entry<T>, index: usize) -> Seed {
    match entry {
        Entry::Many(Spheres { seed: Some(seed), .. }) => Seed { seed: *seed, group: 0 },
        _ => Seed { seed: asked.seed, group: index as u64 },
    }
}
