//! Start: scenes go to lanes, or to worlds of their own.

use std::cmp::Reverse;

use super::pack::Pack;
use super::setting::Setting;
use super::{Alone, Batch, BatchError, Fault, Place};
use crate::engine::{Compiled, EngineError, Execution, World};
use crate::real::Real;
use crate::scene::{QuickCheck, Scene, SceneError};
use crate::workers::Workers;

/// What gives the scene of each number.
pub type Make<'a, T> = dyn Fn(usize) -> Result<Scene<T>, SceneError> + Sync + 'a;

/// As many scenes as a pack has lanes.
struct Portion<T: Real> {
    pack: Option<Pack<T>>,
    /// Those that are not in it.
    others: Vec<(usize, Result<World<T>, Fault>)>,
    durations: Vec<f64>,
}

/// A batch of the scenes that `make` gives, each for its number. `first` has their shape.
pub fn start<T: Compiled>(
    first: &Scene<T>,
    count: usize,
    execution: Execution,
    make: &Make<'_, T>,
) -> Result<Batch<T>, BatchError> {
    if count == 0 {
        return Err(BatchError::Empty);
    }
    let workers = Workers::new(execution.threads).map_err(EngineError::from)?;
    let setting = Setting::new(first, execution, workers.threads());
    let width = setting.width;
    let meetings = (0..workers.threads()).map(|_| setting.meetings(first));
    let meetings = meetings.collect::<Result<_, _>>()?;
    let mut portions: Vec<_> =
        (0..count).step_by(width).map(|start| (start..count.min(start + width), None)).collect();
    workers.each(&mut portions, |(scenes, portion)| {
        let mut pack = setting.has_lanes().then(|| Pack::new(&setting));
        let (mut others, mut durations) = (Vec::new(), Vec::with_capacity(width));
        for (lane, k) in scenes.clone().enumerate() {
            let scene = make(k);
            let duration = scene.as_ref().ok().and_then(|scene| scene.duration);
            durations.push(duration.unwrap_or(f64::NAN));
            match (scene, &mut pack) {
                (Ok(scene), Some(pack)) if setting.takes(&scene) => {
                    pack.seat(&setting, lane, k, &scene);
                }
                (Ok(scene), _) => {
                    let world = World::new(scene, execution.threads(1));
                    others.push((k, world.map_err(Fault::Engine)));
                }
                (Err(error), _) => others.push((k, Err(Fault::Scene(error)))),
            }
        }
        let pack = pack.filter(Pack::has_scenes);
        *portion = Some(Portion { pack, others, durations });
    });
    let mut batch = Batch {
        check: QuickCheck::new(first),
        setting,
        workers,
        meetings,
        packs: Vec::new(),
        alone: Vec::new(),
        places: vec![Place::Nowhere; count],
        durations: Vec::with_capacity(count),
        execution,
        faults: Default::default(),
        recorded: Vec::new(),
    };
    for Portion { pack, others, durations } in portions.into_iter().filter_map(|(_, made)| made) {
        batch.durations.extend(durations);
        batch.packs.extend(pack);
        for (scene, world) in others {
            match world {
                Ok(world) => {
                    batch.places[scene] = Place::Alone(batch.alone.len() as u32);
                    batch.alone.push(Alone { scene, world, fault: None, events: Vec::new() });
                }
                Err(fault) => drop(batch.faults.insert(scene, fault)),
            }
        }
    }
    find_places(&batch.packs, &mut batch.places);
    Ok(batch)
}

/// Notes where the scenes in lanes are.
fn find_places<T: Real>(packs: &[Pack<T>], places: &mut [Place]) {
    for (number, pack) in packs.iter().enumerate() {
        for (lane, seat) in pack.moving.seats.iter().enumerate() {
            if let Some(scene) = seat.scene {
                places[scene] = Place::Lane { pack: number as u32, lane: lane as u32 };
            }
        }
    }
}

/// Puts scenes that have about as many steps ahead of them into one pack, those with the
/// most first, unless all have the same number.
pub(super) fn regroup<T: Real>(
    setting: &Setting<T>,
    packs: &mut Vec<Pack<T>>,
    places: &mut [Place],
) {
    let mut order = Vec::new();
    for (number, pack) in packs.iter().enumerate() {
        for (lane, seat) in pack.moving.seats.iter().enumerate() {
            if seat.scene.is_some() {
                order.push((seat.goal - seat.steps, number, lane));
            }
        }
    }
    let is_even = order.windows(2).all(|two| two[0].0 == two[1].0);
    if is_even {
        return;
    }
    order.sort_by_key(|(ahead, ..)| Reverse(*ahead));
    let sorted = order.chunks(setting.width).map(|scenes| {
        let mut pack = Pack::new(setting);
        for (lane, &(_, number, from)) in scenes.iter().enumerate() {
            pack.take_over(setting, lane, &mut packs[number], from);
        }
        pack
    });
    *packs = sorted.collect();
    find_places(packs, places);
}
