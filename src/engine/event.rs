//! Event: one collision, as an engine reports it.

use crate::real::Real;
use crate::vec3::Vec3;

/// What a body collided with.
///
/// ```
/// use carom::{EventDriven, Partner, Plane, Scene, Sphere};
///
/// let ball = Sphere::new([0.0, 0.0, 1.0]).radius(0.5).velocity([0.0, 0.0, -1.0]);
/// let floor = Plane::new([0.0; 3], [0.0, 0.0, 1.0]);
/// let scene = Scene::<f64>::builder().surroundings(floor).sphere(ball).build()?;
/// EventDriven::new(scene)?.for_each_event(1.0, |event| match event.partner {
///     Partner::Body { index, .. } => println!("{} and {index}", event.a),
///     partner => assert_eq!(partner, Partner::Surroundings(0)),
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Partner<T> {
    /// Another body, with a greater index, and its motion just after.
    Body {
        /// Its index in the scene.
        index: u32,
        /// Its velocity just after, length per time.
        velocity: Vec3<T>,
        /// Its angular velocity just after, rad per time.
        spin: Vec3<T>,
    },
    /// A part of the surroundings, by its index in the scene.
    Surroundings(u32),
}

/// What receives the collisions, if anything does.
///
/// ```
/// use carom::engine::Listener;
/// use carom::{EventDriven, Scene, Sphere};
///
/// fn run(world: &mut EventDriven<f64>, listener: Listener<'_, f64>) {
///     assert_eq!(world.advance_to(1.0, u64::MAX, listener).ok(), Some(true));
/// }
/// let ball = |x| Sphere::new([x, 0.0, 0.0]).radius(0.5).velocity([1.0 - x, 0.0, 0.0]);
/// let scene = Scene::<f64>::builder().sphere(ball(0.0)).sphere(ball(2.0)).build()?;
/// let mut times = Vec::new();
/// run(&mut EventDriven::new(scene)?, Some(&mut |event| times.push(event.time)));
/// assert_eq!(times, [0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub type Listener<'a, T> = Option<&'a mut dyn FnMut(&Event<T>)>;

/// One collision.
///
/// ```
/// use carom::{EventDriven, Partner, Scene, Sphere};
///
/// let scene = Scene::<f64>::builder()
///     .sphere(Sphere::new([0.0; 3]).radius(0.5).velocity([1.0, 0.0, 0.0]))
///     .sphere(Sphere::new([3.0, 0.0, 0.0]).radius(0.5))
///     .build()?;
/// let mut world = EventDriven::new(scene)?;
/// world.for_each_event(3.0, |event| {
///     assert_eq!((event.time, event.a, event.point.x), (2.0, 0, 2.5));
///     assert_eq!(event.normal.x, -1.0);
///     assert!(matches!(event.partner, Partner::Body { index: 1, .. }));
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event<T: Real> {
    /// Time of the collision since the start.
    pub time: f64,
    /// Index of the first body in the scene.
    pub a: u32,
    /// What it collided with.
    pub partner: Partner<T>,
    /// Point of contact, length.
    pub point: Vec3<T>,
    /// Unit normal, from the partner to body `a`.
    pub normal: Vec3<T>,
    /// Normal impulse on body `a`, mass × length per time; not negative.
    pub normal_impulse: T,
    /// Tangential impulse on body `a`, mass × length per time.
    pub tangential_impulse: Vec3<T>,
    /// Velocity of body `a` just after, length per time.
    pub velocity: Vec3<T>,
    /// Angular velocity of body `a` just after, rad per time.
    pub spin: Vec3<T>,
}

/// A collision as an engine knows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Struck<T> {
    /// Index of the first body.
    pub a: u32,
    /// Its centre.
    pub center: Vec3<T>,
    /// From the second body's centre, or the point of contact with what is fixed, to it.
    pub offset: Vec3<T>,
    /// The part of the offset that is its arm; `None` with what is fixed: all of it.
    pub share: Option<T>,
    /// The impulses on it.
    pub normal: Vec3<T>,
    pub tangential: Vec3<T>,
    /// Its motion just after.
    pub velocity: Vec3<T>,
    pub spin: Vec3<T>,
}

impl<T: Real> Struck<T> {
    /// As it is reported.
    pub fn event(&self, time: f64, partner: Partner<T>) -> Event<T> {
        let arm = self.share.map_or(self.offset, |share| self.offset * share);
        let length = self.offset.length();
        Event {
            time,
            a: self.a,
            partner,
            point: self.center - arm,
            normal: self.offset * (T::ONE / length),
            normal_impulse: self.normal.length(),
            tangential_impulse: self.tangential,
            velocity: self.velocity,
            spin: self.spin,
        }
    }
}
