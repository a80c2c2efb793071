//! rapier as a peer. `rapier3d` and `rapier3d-f64` are two crates with one
//! interface, so one macro writes the adapter for both.

use crate::peer::Peer;

/// How rapier's solver is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settings {
    /// The best found for these scenes, at no cost of time. In brackets what
    /// each setting, on top of those before it, leaves of the energy change in
    /// 1,080 steps of 1,000 spheres and of the mean velocity error of a pair
    /// (f64; the defaults: −3.6 %, 1.46 %).
    ///
    /// - No continuous collision detection: the same bits, 17 % less time.
    /// - No recycled contacts, and contacts predicted 0.002 diameters ahead
    ///   instead of 0.02 (−1.5 %, 0.71 %). That is less than a sphere moves in a
    ///   step, so most pairs collide where they overlap slightly and not where
    ///   they are about to; 0.005 has the least pair error (−2.0 %, 0.56 %).
    ///   On the floor 0.0003: after 1,000 bounces 0.07 of the apex is left,
    ///   where the default loses all but 1 % of it in 346 bounces. Over hills
    ///   0.2, as far as a sphere falls in a step: in 200 steps 100 spheres gain
    ///   0.2 % of energy, with 0.02 or 0.002 10 %. Where they move 1,000
    ///   diameters a step, 0.002 is best again.
    /// - No greatest speed, which the default has.
    /// - No stabilisation iterations, which are for stacks (±0.4 %, 0.71 %).
    ///
    /// The default of four solver iterations stays. One saves a tenth of the
    /// time, but the gas gains 1 % of energy and the ball stops after 285
    /// bounces; eight cost 14 %, leave 0.43 of the apex and do nothing for the gas.
    Tuned,
    /// rapier's default parameters, but for Δt and the unit of length.
    Defaults,
    /// [`Tuned`](Self::Tuned) with continuous collision detection, for every
    /// body, in one sub-step: 100 take 100 times as long, and the fast spheres
    /// gain 65 % of energy where they gain 1 %.
    Continuous,
    /// [`Tuned`](Self::Tuned) with meshes as they come: their inner edges are
    /// felt. The others have `FIX_INTERNAL_EDGES`.
    PlainMesh,
}

macro_rules! rapier_adapter {
    ($module:ident, $rapier:ident, $name:literal, $precision:expr) => {
        mod $module {
            use std::collections::HashSet;

            use $rapier::prelude::*;

            use super::Settings;
            use crate::mesh::Mesh;
            use crate::peer::{Collisions, Peer, PeerError, Precision, World};
            use crate::scene::{Encounters, RADIUS, Scene, Surroundings};

            /// The engine.
            pub struct Rapier {
                /// How its solver is set.
                pub settings: Settings,
            }

            impl Peer for Rapier {
                fn name(&self) -> &'static str {
                    match self.settings {
                        Settings::Tuned => $name,
                        Settings::Defaults => concat!($name, ", default settings"),
                        Settings::Continuous => concat!($name, ", CCD"),
                        Settings::PlainMesh => concat!($name, ", inner edges felt"),
                    }
                }

                fn precision(&self) -> Precision {
                    $precision
                }

                fn world(
                    &self,
                    scene: &Scene,
                    threads: usize,
                ) -> Result<Box<dyn World>, PeerError> {
                    Ok(Box::new(RapierWorld::new(scene, threads, self.settings)?))
                }
            }

            struct RapierWorld {
                world: PhysicsWorld,
                bodies: Vec<RigidBodyHandle>,
                /// Pairs that pushed each other in the last counted step.
                pushing: HashSet<(ColliderHandle, ColliderHandle)>,
            }

            impl RapierWorld {
                fn new(
                    scene: &Scene,
                    threads: usize,
                    settings: Settings,
                ) -> Result<Self, PeerError> {
                    let mut world = PhysicsWorld::new();
                    world.gravity = Vector::new(0.0, 0.0, scene.gravity as Real);
                    world.integration_parameters = parameters(scene, settings);
                    use_threads(&mut world, threads)?;
                    for wall in walls(&scene.surroundings, settings)? {
                        world.insert_collider(smooth(wall), None);
                    }
                    let bodies = scene
                        .spheres
                        .iter()
                        .map(|sphere| {
                            let body = RigidBodyBuilder::dynamic()
                                .translation(vector(sphere.position))
                                .linvel(vector(sphere.velocity))
                                .angvel(vector(sphere.spin))
                                .can_sleep(false)
                                .ccd_enabled(settings == Settings::Continuous)
                                .gyroscopic_forces_enabled(false);
                            let ball = ColliderBuilder::ball(RADIUS as Real).mass(1.0);
                            if scene.encounters != Encounters::None {
                                let groups = match scene.encounters {
                                    Encounters::All => InteractionGroups::all(),
                                    _ => not_each_other(),
                                };
                                world.insert(body, smooth(ball).collision_groups(groups)).0
                            } else {
                                let mass = ball.build().mass_properties();
                                world.insert_body(body.additional_mass_properties(mass))
                            }
                        })
                        .collect();
                    Ok(Self { world, bodies, pushing: HashSet::new() })
                }

                fn body(&self, index: usize) -> &RigidBody {
                    &self.world.bodies[self.bodies[index]]
                }
            }

            impl World for RapierWorld {
                fn advance(&mut self, steps: usize) -> Result<(), PeerError> {
                    for _ in 0..steps {
                        self.world.step();
                        // rapier puts bodies that are no longer finite aside.
                        if !self.world.quarantine().is_empty() {
                            return Err(PeerError::Engine {
                                engine: $name,
                                message: "a body was put in quarantine".to_owned(),
                            });
                        }
                    }
                    Ok(())
                }

                /// A collision begins in the first step in which a pair pushes.
                fn advance_counted(
                    &mut self,
                    steps: usize,
                ) -> Result<Option<Collisions>, PeerError> {
                    let mut collisions = Collisions::default();
                    for _ in 0..steps {
                        self.advance(1)?;
                        let mut pushing = HashSet::new();
                        for pair in self.world.contact_pairs() {
                            if pair.total_impulse_magnitude() <= 0.0 {
                                continue;
                            }
                            let key = (pair.collider1, pair.collider2);
                            pushing.insert(key);
                            if self.pushing.contains(&key) {
                                continue;
                            }
                            let has_body = |handle: ColliderHandle| {
                                self.world.colliders[handle].parent().is_some()
                            };
                            if has_body(key.0) && has_body(key.1) {
                                collisions.pairs += 1;
                            } else {
                                collisions.surroundings += 1;
                            }
                        }
                        self.pushing = pushing;
                    }
                    Ok(Some(collisions))
                }

                fn position(&self, body: usize) -> [f64; 3] {
                    array(self.body(body).translation())
                }

                fn velocity(&self, body: usize) -> [f64; 3] {
                    array(self.body(body).linvel())
                }

                fn spin(&self, body: usize) -> [f64; 3] {
                    array(self.body(body).angvel())
                }

                fn orientation(&self, body: usize) -> [f64; 4] {
                    let q = self.body(body).rotation();
                    [q.x, q.y, q.z, q.w].map(|c| f64::from(c))
                }
            }

            /// See [`Settings`](super::Settings) for what was measured.
            fn parameters(scene: &Scene, settings: Settings) -> IntegrationParameters {
                let defaults = IntegrationParameters {
                    dt: scene.dt as Real,
                    length_unit: (2.0 * RADIUS) as Real,
                    ..IntegrationParameters::default()
                };
                match settings {
                    Settings::Defaults => defaults,
                    Settings::Tuned | Settings::Continuous | Settings::PlainMesh => {
                        IntegrationParameters {
                            max_ccd_substeps: usize::from(settings == Settings::Continuous),
                            normalized_prediction_distance: match scene.surroundings {
                                Surroundings::Floor | Surroundings::FlatMesh(_) => 0.0003,
                                Surroundings::Terrain(_) if scene.gravity != 0.0 => 0.2,
                                Surroundings::None
                                | Surroundings::Container { .. }
                                | Surroundings::Terrain(_) => 0.002,
                            },
                            normalized_max_linear_velocity: Real::MAX,
                            num_internal_stabilization_iterations: 0,
                            contact_recycling: false,
                            ..defaults
                        }
                    }
                }
            }

            #[cfg(feature = "parallel")]
            fn use_threads(world: &mut PhysicsWorld, threads: usize) -> Result<(), PeerError> {
                world.configure_thread_pool(threads).map_err(|error| PeerError::Engine {
                    engine: $name,
                    message: error.to_string(),
                })
            }

            #[cfg(not(feature = "parallel"))]
            fn use_threads(_: &mut PhysicsWorld, threads: usize) -> Result<(), PeerError> {
                if threads == 1 { Ok(()) } else { Err(PeerError::OneThreadOnly { engine: $name }) }
            }

            fn smooth(collider: ColliderBuilder) -> ColliderBuilder {
                collider
                    .friction(0.0)
                    .friction_combine_rule(CoefficientCombineRule::Max)
                    .restitution(1.0)
                    .restitution_combine_rule(CoefficientCombineRule::Max)
                    .contact_skin(0.0)
            }

            /// Groups of a ball that meets what surrounds it and no other ball.
            fn not_each_other() -> InteractionGroups {
                let balls = Group::GROUP_1;
                InteractionGroups::new(
                    balls,
                    Group::ALL.difference(balls),
                    InteractionTestMode::And,
                )
            }

            fn triangles(mesh: &Mesh, settings: Settings) -> Result<ColliderBuilder, PeerError> {
                let vertices = mesh.vertices.iter().map(|&v| vector(v)).collect();
                let flags = match settings {
                    Settings::PlainMesh => TriMeshFlags::empty(),
                    _ => TriMeshFlags::FIX_INTERNAL_EDGES,
                };
                ColliderBuilder::trimesh_with_flags(vertices, mesh.triangles.clone(), flags)
                    .map_err(|error| PeerError::Engine {
                        engine: $name,
                        message: error.to_string(),
                    })
            }

            /// Fixed boxes, a diameter thick, or triangles. Half-spaces would be in
            /// every body's way: their bounding boxes are infinite.
            fn walls(
                surroundings: &Surroundings,
                settings: Settings,
            ) -> Result<Vec<ColliderBuilder>, PeerError> {
                Ok(match *surroundings {
                    Surroundings::None => Vec::new(),
                    Surroundings::Floor => vec![
                        ColliderBuilder::cuboid(100.0, 100.0, 1.0)
                            .translation(Vector::new(0.0, 0.0, -1.0)),
                    ],
                    Surroundings::FlatMesh(ref mesh) => vec![triangles(mesh, settings)?],
                    Surroundings::Terrain(ref terrain) => {
                        vec![triangles(&terrain.mesh, settings)?]
                    }
                    Surroundings::Container { side } => {
                        let half = (0.5 * side) as Real;
                        let thick = RADIUS as Real;
                        let mut walls = Vec::new();
                        for axis in 0..3 {
                            for centre in [-thick, side as Real + thick] {
                                let mut extents = [half + 2.0 * thick; 3];
                                extents[axis] = thick;
                                let mut place = [half; 3];
                                place[axis] = centre;
                                walls.push(
                                    ColliderBuilder::cuboid(extents[0], extents[1], extents[2])
                                        .translation(Vector::new(place[0], place[1], place[2])),
                                );
                            }
                        }
                        walls
                    }
                })
            }

            fn vector(v: [f64; 3]) -> Vector {
                Vector::new(v[0] as Real, v[1] as Real, v[2] as Real)
            }

            fn array(v: Vector) -> [f64; 3] {
                [v.x, v.y, v.z].map(|c| f64::from(c))
            }
        }
    };
}

rapier_adapter!(single, rapier3d, "rapier3d f32", Precision::F32);
rapier_adapter!(double, rapier3d_f64, "rapier3d-f64", Precision::F64);

/// rapier as it goes with meshes.
pub fn with_meshes() -> Vec<Box<dyn Peer>> {
    [Settings::Tuned, Settings::Continuous, Settings::PlainMesh]
        .into_iter()
        .flat_map(engines)
        .collect()
}

/// rapier in both precisions.
pub fn engines(settings: Settings) -> Vec<Box<dyn Peer>> {
    vec![Box::new(single::Rapier { settings }), Box::new(double::Rapier { settings })]
}
