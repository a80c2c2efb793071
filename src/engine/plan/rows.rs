//! Rows: the plan as a person reads it.

use core::fmt;

use super::{Plan, Turning};
use crate::engine::Order;
use crate::scene::{EngineKind, Impact, Summation};

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = |what: &str, how: &str| writeln!(f, "{what:<22}{how}");
        let is_stepped = self.engine == EngineKind::Stepped;
        row("engine", if is_stepped { "stepped" } else { "event-driven" })?;
        row("bodies", &format!("{} in {}", self.bodies, self.precision))?;
        row("lanes", &self.lanes())?;
        row("threads", &self.threads.to_string())?;
        if !is_stepped {
            row("time", "in periods with an origin of their own, a power of two long")?;
        }
        if !is_stepped {
            row(
                "order",
                match self.order {
                    Order::Windows => {
                        "windows of time, neighbours after neighbours; what came too early is taken \
                         back: the bits of strict order"
                    }
                    _ => "strict: one collision after the other in time",
                },
            )?;
        }
        row("flight", &self.flight())?;
        if is_stepped {
            row(
                "sums",
                match self.summation {
                    Summation::Compensated => {
                        "compensated: what rounding leaves out is added in the next step"
                    }
                    _ => "plain: steps are long beside the digits of the coordinates",
                },
            )?;
        }
        row(
            "space",
            match (self.is_periodic, is_stepped) {
                (false, _) => "open: no wrapping",
                (true, true) => {
                    "periodic: positions are wrapped, differences taken to the nearest image"
                }
                (true, false) => {
                    "periodic: wrapped at collisions, differences taken to the nearest image"
                }
            },
        )?;
        row("pairs", self.pairs())?;
        row("surroundings", &self.surroundings())?;
        if self.inlets + self.drains > 0 {
            let cost = match self.engine {
                EngineKind::EventDriven if self.inlets == 0 => "taken out in its course",
                EngineKind::EventDriven => "the world is built again for those that come",
                EngineKind::Stepped => "the world is built again at each exchange",
            };
            let how = format!(
                "{}, {}: {cost}",
                counted(self.inlets, "inlet", "inlets"),
                counted(self.drains, "part that removes", "parts that remove"),
            );
            row("spheres", &how)?;
        }
        if self.sensors > 0 {
            let when = if is_stepped { "after each step" } else { "when collisions end them" };
            let count = counted(self.sensors, "sensor", "sensors");
            row("passages", &format!("{count}: ways are looked at {when}"))?;
        }
        let contacts = self.has_pairs || self.features > 0;
        row(
            "impact",
            match (contacts, self.engine, self.impact) {
                (false, ..) => "skipped: there are no contacts",
                (true, EngineKind::EventDriven, _) => "at its exact time, one after the other",
                (true, EngineKind::Stepped, Impact::EndOfStep) => "at the end of the step",
                (true, EngineKind::Stepped, Impact::SubStep) => {
                    "at the time of impact inside the step"
                }
            },
        )?;
        row(
            "surfaces",
            &match (contacts, self.changes_spins) {
                (false, _) => "skipped: there are no contacts".to_owned(),
                (true, false) => format!("{}: spins are never read", self.surface),
                (true, true) => format!("{}: spins are read and changed at contacts", self.surface),
            },
        )?;
        row(
            "masses",
            match (contacts, self.has_masses) {
                (false, _) => "skipped: there are no contacts",
                (true, false) => "one for all, none is loaded",
                (true, true) => "loaded at contacts",
            },
        )?;
        row(
            "orientations",
            match self.turning {
                Turning::Never => "skipped: nothing spins",
                Turning::FromStart => "one closed form from the start, when asked",
                Turning::FromLastContact => "a closed form from the last contact, when asked",
                Turning::EachStep => "turned in each step, as the scene wants it",
            },
        )?;
        row(
            "in a batch",
            &match self.alone_in_batch() {
                None => "a scene in each lane; every pair is tested".to_owned(),
                Some(why) => format!("scene by scene on all threads: {why}"),
            },
        )
    }
}

/// How many there are of something.
fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

impl Plan {
    fn lanes(&self) -> String {
        let (sweep, gather) = (self.sweep_lanes, self.gather_lanes);
        match (self.engine, self.has_screening) {
            (EngineKind::Stepped, _) => format!("{sweep} in sweeps, {gather} in gathers"),
            (EngineKind::EventDriven, true) => {
                format!("{gather} in contact times, {sweep} where neighbours are screened")
            }
            (EngineKind::EventDriven, false) => format!("{gather} in contact times"),
        }
    }

    fn flight(&self) -> String {
        match (self.engine, self.has_field) {
            (EngineKind::Stepped, true) => {
                format!("{}: positions and velocities are updated", self.integrator)
            }
            (EngineKind::Stepped, false) => {
                "no field: positions are updated, velocities only read".to_owned()
            }
            (EngineKind::EventDriven, true) => {
                "a parabola, evaluated where a body is met or asked for".to_owned()
            }
            (EngineKind::EventDriven, false) => {
                "a straight line, evaluated where a body is met or asked for".to_owned()
            }
        }
    }

    fn pairs(&self) -> &'static str {
        match (self.engine, self.has_pairs, self.has_radii) {
            (_, false, _) => "skipped: bodies do not meet each other",
            (EngineKind::Stepped, true, false) => {
                "grid and candidate list; one radius for all, none is loaded"
            }
            (EngineKind::Stepped, true, true) => {
                "grids by size and candidate list; radii are loaded"
            }
            (EngineKind::EventDriven, true, _) if self.has_screening => {
                "cells; neighbours are screened in a coarser precision"
            }
            (EngineKind::EventDriven, true, _) => "cells; every neighbour is tried",
        }
    }

    fn surroundings(&self) -> String {
        let count = match self.features {
            0 => return "skipped: there is nothing to meet".to_owned(),
            1 => "1 feature".to_owned(),
            count => format!("{count} features"),
        };
        let how = match (self.engine, self.has_field) {
            (EngineKind::Stepped, _) => "tested where a body is near",
            (EngineKind::EventDriven, false) => "met by quadratics where a body's cell is near",
            (EngineKind::EventDriven, true) => {
                "met by quadratics, what is curved by quartics, where a body's cell is near"
            }
        };
        format!("{count}, {how}")
    }
}
