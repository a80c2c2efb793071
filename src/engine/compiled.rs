//! Compiled: the precisions that engines are there for.

use super::frame::{Frame, Framed};
use super::idle::Idle;
use super::interface::{EventEngine, StepEngine};
use super::{
    Batch, BatchError, Change, ChangeError, Contact, EngineError, Event, Execution, Hit, Survey,
    batch, event_driven, sensed, stepped,
};
use crate::bodies::Bodies;
#[cfg(feature = "study")]
use crate::real::DoubleDouble;
use crate::real::Real;
use crate::scene::{Buildable, EngineKind, Scene};
use crate::vec3::Vec3;

/// A precision that this crate has engines for.
///
/// They are compiled here once, so that a crate that runs them does not compile
/// them again.
///
/// ```
/// use carom::engine::Compiled;
/// use carom::{EventDriven, Scene, Sphere};
///
/// fn collisions<T: Compiled>() -> Result<u64, Box<dyn std::error::Error>> {
///     let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
///     let scene = Scene::<T>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
///     let mut world = EventDriven::new(scene)?;
///     world.advance(1.0)?;
///     Ok(world.collisions().total())
/// }
/// assert_eq!(collisions::<f32>()?, collisions::<f64>()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Compiled: Buildable + sealed::Engines {}

pub(super) mod sealed {
    use super::{
        Batch, BatchError, Bodies, Change, ChangeError, Contact, EngineError, Event, EventEngine,
        Execution, Hit, Real, Scene, StepEngine, Survey, Vec3,
    };
    use crate::engine::batch::{Events, Going, Make, Meetings, Pack, Setting};

    /// What makes the engines of a precision; not generic, so that it is compiled
    /// in this crate.
    pub trait Engines: Real {
        fn event_driven(
            scene: Scene<Self>,
            execution: Execution,
        ) -> Result<Box<dyn EventEngine<Self>>, EngineError>;

        fn stepped(
            scene: Scene<Self>,
            execution: Execution,
        ) -> Result<Box<dyn StepEngine<Self>>, EngineError>;

        fn advance_pack(
            setting: &Setting<Self>,
            pack: &mut Pack<Self>,
            meetings: Option<&mut Meetings<Self>>,
            steps: u64,
            events: Option<&mut Events<Self>>,
        );

        fn apply(change: Change<'_, Self>) -> Result<(), ChangeError>;

        fn survey(bodies: &Bodies<Self>, scene: &Scene<Self>) -> Survey<Self>;

        fn contacts(survey: &Survey<Self>, gap: Self) -> Vec<Contact<Self>>;

        fn ray(
            survey: &Survey<Self>,
            origin_and_direction: [Vec3<Self>; 2],
            longest: Self,
        ) -> Option<Hit<Self>>;

        fn start_batch(
            first: &Scene<Self>,
            count: usize,
            execution: Execution,
            make: &Make<'_, Self>,
        ) -> Result<Batch<Self>, BatchError>;

        fn go(batch: &mut Batch<Self>, alone: &Going<'_, Self>);

        fn tell_events(
            batch: &mut Batch<Self>,
            duration: f64,
            on_event: &mut dyn FnMut(usize, &Event<Self>),
        );

        fn reset(
            batch: &mut Batch<Self>,
            scene: usize,
            start: &Scene<Self>,
        ) -> Result<(), ChangeError>;
    }
}

macro_rules! compile {
    ($($real:ty),*) => {$(
        impl Compiled for $real {}

        impl sealed::Engines for $real {
            fn event_driven(
                scene: Scene<Self>,
                execution: Execution,
            ) -> Result<Box<dyn EventEngine<Self>>, EngineError> {
                let driver = |scene: Scene<Self>| -> Result<Box<dyn EventEngine<Self>>, EngineError> {
                    if scene.bodies.is_empty() {
                        return Ok(Box::new(Idle::new(&scene, EngineKind::EventDriven, execution)?));
                    }
                    Ok(Box::new(event_driven::Driver::new(scene, execution)?))
                };
                let start = |scene| sensed::event_driven(scene, driver);
                Ok(match Frame::of(&scene) {
                    None => start(scene)?,
                    Some(frame) => Box::new(Framed { engine: start(frame.enter(scene))?, frame }),
                })
            }

            fn stepped(
                scene: Scene<Self>,
                execution: Execution,
            ) -> Result<Box<dyn StepEngine<Self>>, EngineError> {
                let driver = |scene: Scene<Self>| -> Result<Box<dyn StepEngine<Self>>, EngineError> {
                    if scene.bodies.is_empty() {
                        return Ok(Box::new(Idle::new(&scene, EngineKind::Stepped, execution)?));
                    }
                    Ok(Box::new(stepped::Driver::new(scene, execution)?))
                };
                let start = |scene| sensed::stepped(scene, driver);
                Ok(match Frame::of(&scene) {
                    None => start(scene)?,
                    Some(frame) => Box::new(Framed { engine: start(frame.enter(scene))?, frame }),
                })
            }

            fn advance_pack(
                setting: &batch::Setting<Self>,
                pack: &mut batch::Pack<Self>,
                meetings: Option<&mut batch::Meetings<Self>>,
                steps: u64,
                events: Option<&mut batch::Events<Self>>,
            ) {
                batch::advance(setting, pack, meetings, steps, events);
            }

            fn apply(change: Change<'_, Self>) -> Result<(), ChangeError> {
                change.take_effect()
            }

            fn survey(bodies: &Bodies<Self>, scene: &Scene<Self>) -> Survey<Self> {
                Survey::of(bodies, scene)
            }

            fn contacts(survey: &Survey<Self>, gap: Self) -> Vec<Contact<Self>> {
                survey.find_contacts(gap)
            }

            fn ray(
                survey: &Survey<Self>,
                [origin, direction]: [Vec3<Self>; 2],
                longest: Self,
            ) -> Option<Hit<Self>> {
                survey.first_hit(origin, direction, longest)
            }

            fn start_batch(
                first: &Scene<Self>,
                count: usize,
                execution: Execution,
                make: &batch::Make<'_, Self>,
            ) -> Result<Batch<Self>, BatchError> {
                batch::start(first, count, execution, make)
            }

            fn go(batch: &mut Batch<Self>, alone: &batch::Going<'_, Self>) {
                batch.go_on(alone);
            }

            fn tell_events(
                batch: &mut Batch<Self>,
                duration: f64,
                on_event: &mut dyn FnMut(usize, &Event<Self>),
            ) {
                batch.go_and_tell(duration, on_event);
            }

            fn reset(
                batch: &mut Batch<Self>,
                scene: usize,
                start: &Scene<Self>,
            ) -> Result<(), ChangeError> {
                batch.put_back(scene, start)
            }
        }
    )*};
}

compile!(f32, f64);
#[cfg(feature = "study")]
compile!(DoubleDouble);
