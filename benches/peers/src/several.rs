//! Many scenes one after the other, as an engine steps them that knows no batches.

use crate::peer::{Collisions, Peer, PeerError, World};
use crate::scene::Scene;

/// Worlds of as many bodies each; a body has its number among those of all.
pub struct Several {
    worlds: Vec<Box<dyn World>>,
    bodies: usize,
}

impl Several {
    /// Scenes of as many spheres in worlds of an engine.
    pub fn of<P: Peer + ?Sized>(
        peer: &P,
        scenes: &[Scene],
        threads: usize,
    ) -> Result<Box<dyn World>, PeerError> {
        let worlds: Result<Vec<_>, _> =
            scenes.iter().map(|scene| peer.world(scene, threads)).collect();
        let bodies = scenes.first().map_or(0, |scene| scene.spheres.len());
        Ok(Box::new(Self { worlds: worlds?, bodies }))
    }

    fn find(&self, body: usize) -> (&dyn World, usize) {
        (self.worlds[body / self.bodies].as_ref(), body % self.bodies)
    }
}

impl World for Several {
    /// Each makes all steps before the next one: what a world reads stays in the caches.
    fn advance(&mut self, steps: usize) -> Result<(), PeerError> {
        self.worlds.iter_mut().try_for_each(|world| world.advance(steps))
    }

    fn advance_counted(&mut self, steps: usize) -> Result<Option<Collisions>, PeerError> {
        let mut sum = Some(Collisions::default());
        for world in &mut self.worlds {
            let counted = world.advance_counted(steps)?;
            sum = sum.zip(counted).map(|(sum, counted)| Collisions {
                pairs: sum.pairs + counted.pairs,
                surroundings: sum.surroundings + counted.surroundings,
            });
        }
        Ok(sum)
    }

    fn position(&self, body: usize) -> [f64; 3] {
        let (world, body) = self.find(body);
        world.position(body)
    }

    fn velocity(&self, body: usize) -> [f64; 3] {
        let (world, body) = self.find(body);
        world.velocity(body)
    }

    fn spin(&self, body: usize) -> [f64; 3] {
        let (world, body) = self.find(body);
        world.spin(body)
    }

    fn orientation(&self, body: usize) -> [f64; 4] {
        let (world, body) = self.find(body);
        world.orientation(body)
    }
}
