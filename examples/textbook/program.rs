//! A textbook program: spheres among planes, every formula as it is printed. Explicit Euler,
//! contacts by the discriminant, normals that are divided by their length, `M ← R M`.

use carom::Vec3;
use num_traits::Float;

use super::Number;

/// Centre, velocity, angular velocity, columns of the orientation, and what stays as it is.
#[derive(Clone, Copy)]
pub struct Ball<T> {
    pub c: Vec3<T>,
    pub v: Vec3<T>,
    pub w: Vec3<T>,
    pub m: [Vec3<T>; 3],
    pub radius: T,
    pub mass: T,
    pub inertia: T,
}

/// Balls among planes, each with a point and its normal.
pub struct World<T> {
    pub balls: Vec<Ball<T>>,
    pub planes: Vec<[Vec3<T>; 2]>,
    pub gravity: Vec3<T>,
    pub rough: bool,
    pub collisions: u64,
}

impl<T: Number> World<T> {
    pub fn step(&mut self, dt: T) {
        let mut left = dt;
        while let Some((t, a, b)) = self.first_contact(left) {
            self.fly(t);
            self.collide(a, b);
            left = left - t;
        }
        self.fly(left);
        self.balls.iter_mut().for_each(|ball| ball.v += self.gravity * dt);
    }

    fn fly(&mut self, t: T) {
        for ball in &mut self.balls {
            ball.c += ball.v * t;
            let w = Float::sqrt(ball.w.dot(ball.w));
            let (sin, cos) = Float::sin_cos(w * t);
            if w > T::zero() {
                let u = ball.w * (T::one() / w);
                let turned =
                    |x: Vec3<T>| x * cos + u.cross(x) * sin + u * (u.dot(x) * (T::one() - cos));
                ball.m = ball.m.map(turned);
            }
        }
    }

    /// The first contact within a time: of two balls, or of a ball and a plane.
    fn first_contact(&self, end: T) -> Option<(T, usize, Result<usize, usize>)> {
        let mut found = Vec::new();
        for (i, a) in self.balls.iter().enumerate() {
            for (k, [point, n]) in self.planes.iter().enumerate() {
                if a.v.dot(*n) < T::zero() {
                    found.push(((a.radius - (a.c - *point).dot(*n)) / a.v.dot(*n), i, Err(k)));
                }
            }
            for (j, b) in self.balls.iter().enumerate().skip(i + 1) {
                let (d, u, s) = (a.c - b.c, a.v - b.v, a.radius + b.radius);
                let (p, q, r) = (u.dot(u), d.dot(u), d.dot(d) - s * s);
                let discriminant = q * q - p * r;
                if q < T::zero() && discriminant >= T::zero() {
                    found.push(((-q - Float::sqrt(discriminant)) / p, i, Ok(j)));
                }
            }
        }
        let ahead = found.into_iter().filter(|(t, ..)| *t >= T::zero() && *t <= end);
        ahead.reduce(|first, other| if other.0 < first.0 { other } else { first })
    }

    fn collide(&mut self, i: usize, with: Result<usize, usize>) {
        self.collisions += 1;
        let (a, zero, two) = (self.balls[i], Vec3::ZERO, T::one() + T::one());
        let wall = Ball { v: zero, w: zero, mass: T::infinity(), inertia: T::infinity(), ..a };
        let (b, d) = match with {
            Ok(j) => (self.balls[j], a.c - self.balls[j].c),
            Err(k) => (wall, self.planes[k][1]),
        };
        let n = d * (T::one() / Float::sqrt(d.dot(d)));
        let u = a.v - b.v - (a.w * a.radius + b.w * b.radius).cross(n);
        let masses = T::one() / a.mass + T::one() / b.mass;
        let spins = a.radius * a.radius / a.inertia + b.radius * b.radius / b.inertia;
        let mut impulse = n * (-two * u.dot(n) / masses);
        if self.rough {
            impulse += (u - n * u.dot(n)) * (-two / (masses + spins));
        }
        let act = |ball: &mut Ball<T>, impulse: Vec3<T>, n: Vec3<T>| {
            ball.v += impulse * (T::one() / ball.mass);
            ball.w -= n.cross(impulse) * (ball.radius / ball.inertia);
        };
        act(&mut self.balls[i], impulse, n);
        if let Ok(j) = with {
            act(&mut self.balls[j], -impulse, -n);
        }
    }
}
