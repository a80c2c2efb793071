//! Camera: from places in the world to places in a picture.

use carom::Vec3;

use crate::cli::shown::Bounds;

/// A place in a picture: to the right, down, in pixels, and towards the viewer, length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub x: f64,
    pub y: f64,
    pub near: f64,
}

/// What a sphere looks like: an ellipse, which is a circle but for perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    pub center: Place,
    /// Half of its longer and of its shorter diameter, pixels.
    pub half: [f64; 2],
    /// The direction of the longer one, to the right and down.
    pub along: [f64; 2],
}

/// From where a scene is seen.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    middle: Vec3<f64>,
    right: Vec3<f64>,
    up: Vec3<f64>,
    /// Unit vector from what is seen to the viewer.
    towards: Vec3<f64>,
    /// How far away the viewer is; `None` for parallel lines of sight.
    distance: Option<f64>,
    scale: f64,
    shift: [f64; 2],
}

impl Camera {
    /// Seen from a direction, with another one upwards as far as may be, within an angle of
    /// view in degrees, or by parallel lines of sight.
    pub fn new(bounds: Bounds, from: Vec3<f64>, up: Vec3<f64>, angle: Option<f64>) -> Self {
        let towards = unit(from);
        let other = [Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
        let is_across = |up: &&Vec3<f64>| up.cross(towards).length() > 1e-6 * up.length();
        let up = [up].iter().chain(&other).find(is_across).copied().unwrap_or(other[0]);
        let right = unit(up.cross(towards));
        let middle = (bounds[0] + bounds[1]) * 0.5;
        let reach = (bounds[1] - bounds[0]).length() * 0.5;
        let distance = angle.map(|angle| reach / (angle.to_radians() / 2.0).sin());
        Self {
            middle,
            right,
            up: towards.cross(right),
            towards,
            distance,
            scale: 1.0,
            shift: [0.0; 2],
        }
    }

    /// The same with what it sees between two corners, in its own pixels, brought to a width
    /// with a margin; and the height that this takes, within bounds.
    pub fn fitted(self, corners: [[f64; 2]; 2], width: f64, margin: f64) -> (Self, f64) {
        /// Of a height over the width.
        const SHAPES: [f64; 2] = [0.25, 1.25];
        let [least, most] = corners;
        let sides = [0, 1].map(|k| (most[k] - least[k]).max(f64::MIN_POSITIVE));
        let room = width - 2.0 * margin;
        let height = (room * sides[1] / sides[0] + 2.0 * margin)
            .clamp(SHAPES[0] * width, SHAPES[1] * width)
            .round();
        let scale = (room / sides[0]).min((height - 2.0 * margin) / sides[1]);
        let middle = [0, 1].map(|k| 0.5 * (least[k] + most[k]) * scale);
        let shift = [0.5 * width - middle[0], 0.5 * height - middle[1]];
        (Self { scale, shift, ..self }, height)
    }

    /// Unit vectors to the right, up and towards the viewer.
    pub fn axes(&self) -> [Vec3<f64>; 3] {
        [self.right, self.up, self.towards]
    }

    /// Pixels of a length that is as far away as the middle.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Where a point is seen.
    pub fn place(&self, point: Vec3<f64>) -> Place {
        let [x, y, z] = self.seen(point);
        let larger = self.scale * self.distance.map_or(1.0, |away| away / depth(away, z));
        Place {
            x: self.shift[0] + larger * x,
            y: self.shift[1] - larger * y,
            near: self.near([x, y, z], 0.0),
        }
    }

    /// What a sphere looks like.
    pub fn disc(&self, center: Vec3<f64>, radius: f64) -> Disc {
        let place = self.place(center);
        let Some(away) = self.distance else {
            let half = self.scale * radius;
            return Disc { center: place, half: [half; 2], along: [1.0, 0.0] };
        };
        let [x, y, z] = self.seen(center);
        let (depth, off) = (depth(away, z), x.hypot(y));
        let [angle, half] = [(off / depth).atan(), (radius / off.hypot(depth)).min(0.999).asin()];
        let ends = [(angle - half).tan(), (angle + half).tan()].map(|t| t * away * self.scale);
        let along = if off > 0.0 { [x / off, -y / off] } else { [1.0, 0.0] };
        let out = 0.5 * (ends[0] + ends[1]);
        let across = self.scale * away * radius
            / ((depth - radius) * (depth + radius)).max(f64::MIN_POSITIVE).sqrt();
        let near = self.near([x, y, z], radius);
        let center =
            Place { x: self.shift[0] + out * along[0], y: self.shift[1] + out * along[1], near };
        Disc { center, half: [0.5 * (ends[1] - ends[0]), across], along }
    }

    /// Unit vector from a point to the viewer.
    pub fn sight(&self, point: Vec3<f64>) -> Vec3<f64> {
        let eye = |away: f64| unit(self.middle + self.towards * away - point);
        self.distance.map_or(self.towards, eye)
    }

    /// To the right, up and towards the viewer of the middle.
    fn seen(&self, point: Vec3<f64>) -> [f64; 3] {
        let offset = point - self.middle;
        self.axes().map(|axis| offset.dot(axis))
    }

    /// How near spheres are: of two that do not overlap, the one with more of it is never
    /// hidden by the other. In perspective that is by the tangent from the eye.
    fn near(&self, [x, y, z]: [f64; 3], radius: f64) -> f64 {
        self.distance.map_or(z, |away| {
            let depth = depth(away, z);
            away - (x * x + y * y + depth * depth - radius * radius).max(0.0).sqrt()
        })
    }
}

/// How far from the viewer something is, along the line of sight: never beside the eye, as
/// what goes on without end may be.
fn depth(away: f64, z: f64) -> f64 {
    (away - z).max(1e-3 * away)
}

fn unit(vector: Vec3<f64>) -> Vec3<f64> {
    vector * (1.0 / vector.length())
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(2.0, 2.0, 2.0)];

    #[test]
    fn the_front_is_seen_upright() {
        let front = Vec3::new(0.0, -1.0, 0.0);
        let camera = Camera::new(BOUNDS, front, Vec3::new(0.0, 0.0, 1.0), None);
        let (camera, height) = camera.fitted([[-1.0, -1.0], [1.0, 1.0]], 120.0, 10.0);
        assert_eq!((height, camera.scale()), (120.0, 50.0));
        let place = camera.place(Vec3::new(2.0, 0.0, 2.0));
        assert_eq!((place.x, place.y, place.near), (110.0, 10.0, 1.0));
        let disc = camera.disc(Vec3::new(1.0, 1.0, 1.0), 0.5);
        assert_eq!((disc.center.x, disc.center.y, disc.half), (60.0, 60.0, [25.0; 2]));
        // From above, where up is no direction of the picture.
        let above = Camera::new(BOUNDS, Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 1.0), None);
        assert_eq!(above.place(Vec3::new(2.0, 1.0, 1.0)).x, 1.0);
    }

    #[test]
    fn ellipses_go_around_spheres() {
        let (from, up) = (Vec3::new(0.3, -1.0, 0.4), Vec3::new(0.0, 0.0, 1.0));
        let camera = Camera::new(BOUNDS, from, up, Some(50.0));
        let (center, radius) = (Vec3::new(1.9, 0.2, 1.7), 0.3);
        let disc = camera.disc(center, radius);
        let mut farthest = 0.0_f64;
        for k in 0..4000 {
            let height = 1.0 - f64::from(k) / 2000.0;
            let (sine, cosine) = carom::trigonometry::sin_cos(2.399_963 * f64::from(k));
            let out = (1.0 - height * height).sqrt();
            let place = camera.place(center + Vec3::new(out * cosine, out * sine, height) * radius);
            let [x, y] = [place.x - disc.center.x, place.y - disc.center.y];
            let [s, t] = [
                (x * disc.along[0] + y * disc.along[1]) / disc.half[0],
                (y * disc.along[0] - x * disc.along[1]) / disc.half[1],
            ];
            farthest = farthest.max(s.hypot(t));
        }
        assert!((0.995..1.000_001).contains(&farthest), "{farthest}");
        // What is nearer is larger.
        let far = camera.disc(center - unit(from), radius);
        assert!(far.half[0] < disc.half[0] && far.center.near < disc.center.near);
    }
}
