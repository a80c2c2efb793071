//! Boxes: how far through the images of a periodic box bodies have moved on the way.

use carom::bodies::Bodies;
use carom::engine::World;
use carom::observe::Images;
use carom::real::Real;
use carom::space::PeriodicBox;
use carom::study::Course;

/// The boxes that bodies move through, and where on the way to look at them next.
pub struct Boxes<T: Real> {
    images: Images<T>,
    next: f64,
}

impl<T: Real> Boxes<T> {
    /// From now on; `counted` are those of a run that goes on.
    pub fn new(
        space: PeriodicBox<T>,
        world: &World<T>,
        course: &Course,
        counted: Option<&Vec<[i32; 3]>>,
    ) -> Self {
        let bodies = world.bodies();
        let images = Images::new(space, &bodies);
        let images = match counted.filter(|counted| counted.len() == images.counts().len()) {
            Some(counted) => images.after(counted.clone()),
            None => images,
        };
        let next = course.after(world, images.next_look(&bodies, world.gravity()));
        Self { images, next }
    }

    pub fn images(&self) -> &Images<T> {
        &self.images
    }

    /// Where on the way the bodies are to be looked at next.
    pub fn next(&self) -> f64 {
        self.next
    }

    /// Looks at the bodies of a world.
    pub fn look(&mut self, world: &World<T>, bodies: &Bodies<T>, course: &Course) {
        self.images.look(bodies);
        self.next = course.after(world, self.images.next_look(bodies, world.gravity()));
    }
}
