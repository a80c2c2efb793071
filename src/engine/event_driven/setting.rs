//! Setting: what all workers read and none writes.

use super::flight::Flight;
use super::near::{self, Near};
use super::search::{Search, further, searcher};
use crate::bodies::{Bodies, PerBody, at};
use crate::column::Column;
use crate::engine::parts::{Counted, Counter};
use crate::engine::plan::{Plan, Turning};
use crate::engine::{Execution, Order};
use crate::motion::integrator::{Coasting, VelocityVerlet};
use crate::numbers::array;
use crate::real::Real;
use crate::scene::Scene;
use crate::space::cells::{Ends, Span};
use crate::space::levels::Levels;
use crate::space::{OpenSpace, PeriodicBox, Space};
use crate::surroundings::{Feature, Features};
use crate::vec3::Vec3;

/// So few bodies and fixed parts are tried all with each other: no cells are crossed,
/// however far they are apart and however fast.
const FEW: usize = 16;

/// The scene and its plan. All of it follows from the scene: a restart file
/// keeps the scene instead.
#[derive(Debug)]
pub(super) struct Setting<T: Real> {
    pub plan: Plan,
    pub gravity: Vec3<T>,
    pub periodic: Option<PeriodicBox<T>>,
    pub features: Features<T>,
    /// Which of them are counted apart.
    pub counted: Counted,
    /// The periodic images of a feature.
    pub images: Vec<Vec3<T>>,
    /// The images of a pair besides the nearest one, and that one itself, in
    /// whole boxes.
    pub further: Vec<Vec3<T>>,
    /// `further` in the coarse precision.
    pub coarse_further: Vec<Vec3<T::Coarse>>,
    pub near: Near<T>,
    pub has_cells: bool,
    /// Looks for a body's contacts with others, in the plan's lanes.
    pub search_bodies: Search<T>,
    /// Mean distance of bodies or the greatest diameter, length.
    pub spacing: T,

    /// Masses, inertia and radii by index, and the start's spins and
    /// orientations where contacts do not change them. Centres and velocities
    /// are in the region.
    pub bodies: Bodies<T>,
    pub inverse_mass: PerBody<T>,
    pub inverse_inertia: PerBody<T>,
}

/// Triangles of a mesh that a body looks at in a cell where it meets nothing else.
const TILES_IN_CELL: usize = 8;

impl<T: Real> Setting<T> {
    /// What a scene and its plan say, and the grid of its cells, still empty.
    pub fn new(scene: Scene<T>, mut plan: Plan, execution: Execution) -> (Self, Levels<T>) {
        let counted = Counted::of(&scene);
        let bodies = scene.bodies;
        let met: &[_] = if plan.features > 0 { &scene.surroundings } else { &[] };
        let features = Features::new(met);
        let images = scene.periodic.map_or_else(|| OpenSpace.images(), Space::images);
        let len = bodies.len();
        let radius = bodies.radius.greatest();
        let interiors = scene.surroundings.iter().filter_map(|shape| shape.interior());
        // Wide enough for cells that do not all neighbour each other.
        let least = radius * T::whole(9);
        let interiors = interiors.filter(|_| plan.features > 0);
        let span = |meshes: bool| match scene.periodic {
            Some(PeriodicBox { lower, upper }) => Span::new(lower, upper, Ends::Joined),
            None => near::span(
                least,
                interiors.clone(),
                features
                    .alone()
                    .iter()
                    .filter_map(Feature::bounds)
                    .chain(features.mesh_bounds().filter(|_| meshes)),
                (0..len).map(|index| bodies.position_of(index)),
            ),
        };
        let grid = span(true);
        // A mesh has the time of the plane that it may be.
        let spacing = span(false).spacing(radius + radius, len);
        let bounded = features.alone().iter().filter(|feature| feature.bounds().is_some()).count();
        let is_periodic = scene.periodic.is_some();
        // Without pairs cells tell parts apart, not bodies.
        let tiles = features.len() - features.alone().len();
        let (crowd, parts) =
            if plan.has_pairs { (len, bounded) } else { (0, bounded + tiles / TILES_IN_CELL) };
        let fitting = |span| Levels::fitting(span, &bodies.radius, crowd, parts);
        // Each image of a solid without end would be near everywhere. Crowds that do not meet
        // fill no cells.
        let can_fold = plan.has_pairs && (!is_periodic || bounded == features.alone().len());
        let is_few =
            !is_periodic && len + features.len() <= FEW && execution.order != Order::Windows;
        let folded = || {
            let cells = fitting(grid.folded(least, radius + radius, &bodies.position));
            cells.finest().can_number(&grid).then_some(cells)
        };
        let cells = match () {
            () if is_few => Levels::whole(grid, radius),
            () if can_fold => folded().unwrap_or_else(|| fitting(grid)),
            () => fitting(grid),
        };
        // Windows want one grid, and a pair near by one image only.
        let is_wide = !is_periodic || !(0..3).any(|axis| cells.coarsest().is_narrow(axis));
        let can_be_windows = plan.has_pairs && !is_few && cells.len() == 1 && is_wide;
        plan.choose_order(execution, can_be_windows);
        let near = Near::new(features.alone(), &images, cells.finest(), radius);
        let has_near = plan.has_pairs || near.has_cells() || features.has_meshes();
        let setting = Self {
            gravity: scene.gravity,
            periodic: scene.periodic,
            features,
            counted,
            images,
            further: further(cells.coarsest(), is_periodic),
            coarse_further: further(cells.coarsest(), is_periodic),
            has_cells: !is_few && has_near,
            near,
            search_bodies: searcher(&plan, is_periodic),
            spacing,
            inverse_mass: bodies.mass.map(|mass| T::ONE / mass),
            inverse_inertia: bodies.inertia.map(|inertia| T::ONE / inertia),
            bodies,
            plan,
        };
        (setting, cells)
    }

    /// The counter of a feature's part, if it has one.
    #[inline(always)]
    pub fn counter(&self, feature: u32) -> Option<Counter> {
        self.counted.counter(self.features.shape_of(feature))
    }

    /// Centre and velocity on a flight at a time.
    #[inline(always)]
    pub fn state_of(&self, flight: &Flight<T>, time: T) -> (Vec3<T>, Vec3<T>) {
        if self.plan.has_field {
            flight.at::<VelocityVerlet>(time, self.gravity)
        } else {
            flight.at::<Coasting>(time, self.gravity)
        }
    }

    /// Angular velocity of the body of an index, rad per time: `changed` if collisions
    /// change it.
    pub fn spin_of(&self, index: u32, changed: Vec3<T>) -> Vec3<T> {
        match &self.bodies.spin {
            _ if self.plan.changes_spins => changed,
            // Given up: nothing spins.
            [x, ..] if x.is_empty() => Vec3::ZERO,
            columns => at(columns, index as usize),
        }
    }

    /// Gives up what the region keeps now.
    pub fn leave_to_region(&mut self) {
        let nothing = || array::from_fn(|_| Column::new(0, T::ZERO));
        (self.bodies.position, self.bodies.velocity) = (nothing(), nothing());
        let is_zero = |spin: &T| *spin == T::ZERO && spin.to_f64().is_sign_positive();
        match self.plan.turning {
            Turning::FromLastContact => {
                (self.bodies.spin, self.bodies.orientation) = (nothing(), None);
            }
            Turning::Never if self.bodies.spin.iter().all(|column| column.iter().all(is_zero)) => {
                self.bodies.spin = nothing();
            }
            _ => {}
        }
    }

    /// The bytes of memory that it holds.
    pub fn bytes(&self) -> usize {
        self.bodies.bytes()
            + self.inverse_mass.bytes()
            + self.inverse_inertia.bytes()
            + self.near.bytes()
            + self.features.bytes()
    }
}
