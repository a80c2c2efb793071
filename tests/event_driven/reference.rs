//! The event-driven engine as a program of a page: at every event all pairs, all
//! their images and all features are tried again. No cells, no calendar, nothing
//! kept but the flights.

use carom::bodies::PerBody;
use carom::compensated::CompensatedSum;
use carom::contact::{Impulse, Party, Rough, Smooth, Surface, collide_spread};
use carom::engine::{Event, Partner};
use carom::motion::flight::Wrap;
use carom::motion::integrator::{Coasting, FlightStep, VelocityVerlet};
use carom::real::Real;
use carom::scene::{Encounters, Scene};
use carom::space::{PeriodicBox, Space};
use carom::surroundings::Feature;
use carom::vec3::Vec3;

/// What a ball has met last.
#[derive(Clone, Copy, PartialEq)]
enum Met {
    Nothing,
    Ball(usize),
    Feature(usize),
}

/// A ball in flight since its motion last changed.
#[derive(Clone, Copy)]
struct Ball<T> {
    position: Vec3<T>,
    velocity: Vec3<T>,
    since: T,
    radius: T,
    spin: Vec3<T>,
    last: Met,
    /// How many collisions have led to one at the time at which the flight starts.
    follows: u32,
}

/// A contact: when, how many collisions at that time have led to it, and its rank among
/// those of equal times. The lesser ball comes first, and its contacts with features
/// before those with balls.
type Contact<T> = (T, u32, (usize, bool, usize));

pub struct Reference<'a, T: Real> {
    scene: &'a Scene<T>,
    has_field: bool,
    /// Features, and the parts of the surroundings that they belong to.
    features: Vec<(Feature<T>, u32)>,
    balls: Vec<Ball<T>>,
    spacing: T,
    origin: CompensatedSum,
    period: T,
    too_fast: T,
    /// Time since the period's start.
    now: T,
    is_too_fast: bool,
    /// Periods without a collision, and when there was the last one in this.
    idle: u32,
    last_collision: T,
}

/// What the reference says of a collision: all that an [`Event`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision<T> {
    time: f64,
    a: u32,
    partner: Partner<T>,
    point: Vec3<T>,
    normal: Vec3<T>,
    normal_impulse: T,
    tangential_impulse: Vec3<T>,
    velocity: Vec3<T>,
    spin: Vec3<T>,
}

impl<T: Real> From<Event<T>> for Collision<T> {
    fn from(event: Event<T>) -> Self {
        Self {
            time: event.time,
            a: event.a,
            partner: event.partner,
            point: event.point,
            normal: event.normal,
            normal_impulse: event.normal_impulse,
            tangential_impulse: event.tangential_impulse,
            velocity: event.velocity,
            spin: event.spin,
        }
    }
}

impl<'a, T: Real> Reference<'a, T> {
    pub fn new(scene: &'a Scene<T>) -> Self {
        let bodies = &scene.bodies;
        let ball = |k: usize| Ball {
            position: bodies.position_of(k),
            velocity: bodies.velocity_of(k),
            since: T::ZERO,
            radius: bodies.radius.of(k),
            spin: bodies.spin_of(k),
            last: Met::Nothing,
            follows: 0,
        };
        let parts =
            if scene.encounters == Encounters::None { &[] } else { &scene.surroundings[..] };
        let features = parts.iter().enumerate().flat_map(|(part, shape)| {
            shape.features().into_iter().map(move |feature| (feature, part as u32))
        });
        let mut reference = Self {
            scene,
            has_field: scene.gravity != Vec3::ZERO,
            features: features.collect(),
            balls: (0..bodies.len()).map(ball).collect(),
            spacing: spacing(scene),
            origin: CompensatedSum::default(),
            period: T::ZERO,
            too_fast: T::ZERO,
            now: T::ZERO,
            is_too_fast: false,
            idle: 0,
            last_collision: T::ZERO,
        };
        reference.begin_period(T::ZERO);
        reference
    }

    /// The next collision, if it comes up to a time.
    pub fn next_event(&mut self, until: f64) -> Option<Collision<T>> {
        if self.is_too_fast {
            self.begin_period(self.now);
        }
        loop {
            let window = self.window();
            let contacts = self.contacts().filter(|contact| contact.0 < self.period);
            let first = contacts.reduce(|a, b| if b < a { b } else { a });
            match first {
                Some((time, generation, with)) if time <= self.now + window => {
                    self.now = time;
                    self.last_collision = time;
                    let time = self.not_before(time);
                    return (time <= until).then(|| self.happen(generation, with));
                }
                _ if self.origin.value() + self.now.to_f64() > until => return None,
                _ if self.now + window < self.period => self.now = self.now + window,
                _ => self.begin_period(self.period),
            }
        }
    }

    /// The first time since the start that is not before one of the period.
    fn not_before(&self, time: T) -> f64 {
        let mut now = self.origin.value() + time.to_f64();
        let in_period = |now: f64| {
            T::from_f64(now - self.origin.value()) - T::from_f64(self.origin.remainder())
        };
        while in_period(now) < time {
            now = now.next_up();
        }
        now
    }

    /// Centre and velocity at a time.
    fn at(&self, ball: &Ball<T>, time: T) -> (Vec3<T>, Vec3<T>) {
        let step = if self.has_field { VelocityVerlet::step::<T> } else { Coasting::step::<T> };
        step(ball.position, ball.velocity, self.scene.gravity, time - ball.since)
    }

    /// A time in which no two balls move by more than half a periodic box.
    fn window(&self) -> T {
        let Some(space) = self.scene.periodic else { return self.period };
        let [x, y, z] = space.sides().to_array();
        let side = x.lesser(y).lesser(z);
        let speeds = self.balls.iter().map(|ball| self.at(ball, self.now).1.length());
        let fastest = speeds.fold(T::ZERO, |most, speed| speed.greater(most));
        let fall = T::whole(4) * self.scene.gravity.length();
        (side / (T::whole(8) * fastest)).lesser((side / fall).sqrt()).lesser(self.period)
    }

    /// The shifts to the images around the one that is nearest now.
    fn images(&self, nearby: Vec3<T>) -> impl Iterator<Item = Vec3<T>> {
        let space = self.scene.periodic;
        let turns = space.map_or(Vec3::ZERO, |space| space.turns(nearby));
        let whole = |k: i32| T::whole(k - 1);
        (0..if space.is_some() { 27 } else { 1 }).map(move |k| {
            let step = Vec3::new(whole(k % 3), whole(k / 3 % 3), whole(k / 9));
            space.map_or(Vec3::ZERO, |space| space.shift(turns + step))
        })
    }

    fn contacts(&self) -> impl Iterator<Item = Contact<T>> {
        let count = if self.scene.encounters == Encounters::All { self.balls.len() } else { 0 };
        let pairs = (0..count).flat_map(move |a| (0..a).map(move |b| (b, a)));
        let balls =
            (0..self.balls.len()).flat_map(|a| (0..self.features.len()).map(move |f| (a, f)));
        let pairs = pairs.filter_map(|(a, b)| {
            let time = self.meeting(a, b)?;
            Some((time, self.follows(a, time).max(self.follows(b, time)), (a, true, b)))
        });
        let features = balls.filter_map(|(a, f)| {
            let time = self.balls[a].since + self.wait(a, f)?;
            Some((time, self.follows(a, time), (a, false, f)))
        });
        pairs.chain(features)
    }

    /// How many collisions at a time have led to one of a ball.
    fn follows(&self, ball: usize, time: T) -> u32 {
        if self.balls[ball].since == time { self.balls[ball].follows } else { 0 }
    }

    /// When two balls meet: worked out from their states where the later of the
    /// two flights starts.
    fn meeting(&self, a: usize, b: usize) -> Option<T> {
        let have_met = self.balls[a].last == Met::Ball(b) && self.balls[b].last == Met::Ball(a);
        let (a, b) = (&self.balls[a], &self.balls[b]);
        let from = a.since.greater(b.since);
        let ((position_a, velocity_a), (position_b, velocity_b)) =
            (self.at(a, from), self.at(b, from));
        let (offset, relative) = (position_a - position_b, velocity_a - velocity_b);
        let reach = a.radius + b.radius;
        let nearby = offset + relative * (self.now - from);
        let times = self.images(nearby).filter_map(|shift| {
            let offset = offset - shift;
            let approach = offset.dot(relative);
            let discriminant = relative.length_squared() * (reach * reach)
                - offset.cross(relative).length_squared();
            let excess = offset.length_squared() - reach * reach;
            // In contact and approaching, rounding alone can take the discriminant to 0.
            let is_deep = discriminant > T::ZERO;
            let meets = approach < T::ZERO && (is_deep || excess <= T::ZERO);
            // Two that have just met do not meet again, whatever rounding says.
            let is_over = have_met && excess < reach * reach * T::ratio(1, 1024);
            let root = discriminant.greater(T::ZERO).sqrt();
            let wait = excess.greater(T::ZERO) / (root - approach);
            (meets && !is_over).then_some(from + wait)
        });
        times.reduce(T::lesser)
    }

    /// From the start of a ball's flight to when it comes to a feature.
    fn wait(&self, ball: usize, feature: usize) -> Option<T> {
        let is_last = self.balls[ball].last == Met::Feature(feature);
        let ball = &self.balls[ball];
        let feature = &self.features[feature].0;
        let acceleration = self.has_field.then_some(self.scene.gravity);
        let middle = self
            .scene
            .periodic
            .map_or(Vec3::ZERO, |space| (space.lower + space.upper) * T::ratio(1, 2));
        let nearby = self.at(ball, self.now).0 - middle;
        let times = self.images(nearby).filter_map(|shift| {
            let center = ball.position - shift;
            let clearance = feature.clearance(center, ball.radius);
            let gap = clearance.gap.abs();
            // Of a flight that starts with the period the last contact is past.
            let closes = ball.since == T::ZERO && clearance.arm.dot(ball.velocity) < T::ZERO;
            let farthest = center.to_array().map(T::abs).into_iter().fold(T::ZERO, T::greater);
            let rounding = T::whole(64) * T::EPSILON * farthest;
            let near = (self.spacing * T::ratio(1, 1024)).greater(rounding);
            let is_near = self.scene.periodic.is_none() || gap < near;
            let is_leaving = is_last && is_near && !closes;
            feature.contact_time(center, ball.velocity, acceleration, ball.radius, is_leaving)
        });
        times.reduce(T::lesser)
    }

    /// Ends the flight of a ball, and gives it as a party of a contact.
    fn arrive(&mut self, ball: usize, share: T, last: Met) -> Party<T> {
        let (position, velocity) = self.at(&self.balls[ball], self.now);
        let position = self.scene.periodic.map_or(position, |space| space.wrap(position));
        self.balls[ball] = Ball { position, velocity, since: self.now, last, ..self.balls[ball] };
        let bodies = &self.scene.bodies;
        Party {
            velocity,
            spin: self.balls[ball].spin,
            inverse_mass: T::ONE / bodies.mass.of(ball),
            inverse_inertia: T::ONE / bodies.inertia.of(ball),
            share,
        }
    }

    fn depart(&mut self, ball: usize, party: &Party<T>) {
        self.balls[ball].velocity = party.velocity;
        self.balls[ball].spin = party.spin;
        self.is_too_fast |= party.velocity.length_squared() > self.too_fast;
    }

    fn collide(&self, offset: Vec3<T>, a: &mut Party<T>, b: &mut Party<T>) -> Impulse<T> {
        match self.scene.surface {
            Surface::Smooth => collide_spread(Smooth, offset, a, b),
            _ => collide_spread(Rough, offset, a, b),
        }
    }

    /// What happens at a contact now.
    fn happen(&mut self, generation: u32, (a, is_pair, b): (usize, bool, usize)) -> Collision<T> {
        for ball in [Some(a), is_pair.then_some(b)].into_iter().flatten() {
            self.balls[ball].follows = generation + 1;
        }
        let (offset, arm, impulse, partner);
        if is_pair {
            let reach = self.balls[a].radius + self.balls[b].radius;
            let share = |radius: T| match self.scene.bodies.radius {
                PerBody::Same(_) => T::ratio(1, 2),
                PerBody::Each(_) => radius / reach,
            };
            let (share_a, share_b) = (share(self.balls[a].radius), share(self.balls[b].radius));
            let mut party_a = self.arrive(a, share_a, Met::Ball(b));
            let mut party_b = self.arrive(b, share_b, Met::Ball(a));
            let difference = self.balls[a].position - self.balls[b].position;
            offset = self.scene.periodic.map_or(difference, |space| space.nearest(difference));
            arm = offset * share_a;
            impulse = self.collide(offset, &mut party_a, &mut party_b);
            self.depart(a, &party_a);
            self.depart(b, &party_b);
            let Party { velocity, spin, .. } = party_b;
            partner = Partner::Body { index: b as u32, velocity, spin };
        } else {
            let is_hollow = self.features[b].0.is_hollow() && self.scene.periodic.is_none();
            let wait = if is_hollow { self.wait(a, b) } else { None };
            let started = Ball { since: T::ZERO, ..self.balls[a] };
            let mut party = self.arrive(a, T::ONE, Met::Feature(b));
            if let Some(wait) = wait {
                // From the start of the flight, not by the rounded time.
                let (position, velocity) = self.at(&started, wait);
                (self.balls[a].position, self.balls[a].velocity) = (position, velocity);
                party.velocity = velocity;
            }
            let (feature, part) = &self.features[b];
            partner = Partner::Surroundings(*part);
            let images = self.scene.periodic.map_or(vec![Vec3::ZERO], PeriodicBox::images);
            let ball = &self.balls[a];
            let clearances = images
                .into_iter()
                .map(|shift| feature.clearance(ball.position - shift, ball.radius));
            let nearest = clearances.reduce(|a, b| if b.gap.abs() < a.gap.abs() { b } else { a });
            let nearest = nearest.unwrap();
            arm = if is_hollow {
                self.balls[a].position += nearest.way_to_touch();
                feature.clearance(self.balls[a].position, self.balls[a].radius).arm
            } else {
                nearest.arm
            };
            offset = arm;
            impulse = self.collide(arm, &mut party, &mut Party::immovable());
            self.depart(a, &party);
        }
        let ball = &self.balls[a];
        Collision {
            time: self.not_before(self.now),
            a: a as u32,
            partner,
            point: ball.position - arm,
            normal: offset * (T::ONE / offset.length()),
            normal_impulse: impulse.normal.length(),
            tangential_impulse: impulse.tangential,
            velocity: ball.velocity,
            spin: ball.spin,
        }
    }

    /// Where a period of time begins every flight starts again. It is the power
    /// of two below the time for eight mean distances at the mean speed.
    fn begin_period(&mut self, end: T) {
        for k in 0..self.balls.len() {
            let is_hollow = match self.balls[k].last {
                Met::Feature(feature) => self.features[feature].0.is_hollow(),
                _ => false,
            };
            let is_coarsest = size_of::<T::Coarse>() == size_of::<T>();
            let is_open = self.scene.periodic.is_none();
            if is_hollow && is_coarsest && is_open && self.balls[k].since > T::ZERO {
                self.balls[k].since = self.balls[k].since - end;
                self.balls[k].follows = 0;
                continue;
            }
            let (position, velocity) = self.at(&self.balls[k], end);
            let position = self.scene.periodic.map_or(position, |space| space.wrap(position));
            self.balls[k] =
                Ball { position, velocity, since: T::ZERO, follows: 0, ..self.balls[k] };
        }
        self.idle = if self.last_collision == T::ZERO { self.idle + 1 } else { 0 };
        self.last_collision = T::ZERO;
        self.origin.add(end.to_f64());
        self.now = T::ZERO;
        self.is_too_fast = false;
        let squares = || self.balls.iter().map(|ball| ball.velocity.length_squared().to_f64());
        let mean = squares().sum::<f64>() / self.balls.len() as f64;
        let most = squares().fold(0.0, f64::max);
        let spacing = self.spacing.to_f64();
        let fallen = self.scene.gravity.length().to_f64() * spacing;
        let speed = mean.max(most / 64.0).max(fallen).sqrt();
        // After some periods without a collision they grow.
        let longer = 2.0_f64.powi(self.idle.saturating_sub(16).min(256) as i32);
        let flight = ((8.0 * spacing / speed).max(1e-25) * longer).min(2.0_f64.powi(100));
        self.period = T::from_f64(flight.log2().floor().exp2());
        self.too_fast = T::from_f64((16.0 * speed * (16.0 * speed)).max(1e-30));
    }
}

/// Mean distance of the bodies, or the greatest diameter if that is more.
fn spacing<T: Real>(scene: &Scene<T>) -> T {
    let bodies = &scene.bodies;
    let radius = bodies.radius.greatest();
    let reach = radius + radius;
    let [lower, upper] = match scene.periodic {
        Some(space) => [space.lower, space.upper],
        None => region(scene, radius * T::whole(9)),
    };
    let sides = (upper - lower).to_array().map(|side| side.greater(reach).to_f64());
    let mean = (sides.iter().product::<f64>() / bodies.len() as f64).cbrt();
    T::from_f64(mean).greater(reach)
}

/// The inside of the containers, or what the bodies and the solids span.
fn region<T: Real>(scene: &Scene<T>, least: T) -> [Vec3<T>; 2] {
    let parts = if scene.encounters == Encounters::None { &[] } else { &scene.surroundings[..] };
    let each =
        |f: fn(T, T) -> T, a: Vec3<T>, b: Vec3<T>| Vec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z));
    let insides = parts.iter().filter_map(|shape| shape.interior());
    let inside = insides.reduce(|[a, b], [c, d]| [each(T::greater, a, c), each(T::lesser, b, d)]);
    if let Some(inside) = inside {
        return inside;
    }
    let features = parts.iter().flat_map(|shape| shape.features());
    let solids = features.filter_map(|feature| feature.bounds());
    let centers = (0..scene.bodies.len()).map(|k| [scene.bodies.position_of(k); 2]);
    let all = solids.chain(centers);
    let [lower, upper] =
        all.reduce(|[a, b], [c, d]| [each(T::lesser, a, c), each(T::greater, b, d)]).unwrap();
    let half = |a: T, _: T| a.greater(T::ZERO) * T::ratio(1, 2);
    let missing = each(half, Vec3::new(least, least, least) - (upper - lower), Vec3::ZERO);
    [lower - missing, upper + missing]
}
