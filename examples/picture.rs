//! Draws a mixture of spheres, some time after its start, as SVG:
//!
//! ```sh
//! cargo run --release --example picture > mixture.svg
//! ```
//!
//! All spheres are of one material. At the start only the large ones move; by
//! then they have given their energy away, and the small ones are the fast ones.

use std::io::Write;

use carom::scene::Impact;
use carom::trigonometry::sin_cos;
use carom::{Bodies, Cuboid, Scene, Spheres, Stepped, Surface, Vec3};

/// Side of the container.
const SIDE: f64 = 10.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let spheres = |count| Spheres::random(count).density(1.0);
    let scene = Scene::<f64>::builder()
        .surface(Surface::Rough)
        .surroundings(Cuboid::container([0.0; 3], [SIDE; 3]))
        .spheres(spheres(12).radius(0.9..=1.3).temperature(400.0))
        .spheres(spheres(120).radius(0.35..=0.5))
        .spheres(spheres(1_400).radius(0.12..=0.2))
        .seed(3)
        .impact(Impact::EndOfStep)
        .dt(5e-4)
        .build()?;
    let mut world = Stepped::new(scene)?;
    world.advance(20.0)?;
    std::io::stdout().write_all(drawing(&world.bodies()).as_bytes())?;
    Ok(())
}

/// From the world to the picture: parallel projection, from the front, from one
/// side and from above.
struct View {
    right: Vec3<f64>,
    up: Vec3<f64>,
    towards_viewer: Vec3<f64>,
}

impl View {
    fn new(turned: f64, raised: f64) -> Self {
        let ((s, c), (rise, level)) = (sin_cos(turned), sin_cos(raised));
        Self {
            right: Vec3::new(c, s, 0.0),
            up: Vec3::new(-s * rise, c * rise, level),
            towards_viewer: Vec3::new(s * level, -c * level, rise),
        }
    }

    /// Position in the picture, in pixels, and how near to the viewer.
    fn project(&self, point: Vec3<f64>) -> [f64; 3] {
        let from_middle = point - Vec3::new(SIDE / 2.0, SIDE / 2.0, SIDE / 2.0);
        [
            WIDTH / 2.0 + SCALE * from_middle.dot(self.right),
            MIDDLE - SCALE * from_middle.dot(self.up),
            from_middle.dot(self.towards_viewer),
        ]
    }
}

/// Pixels.
const WIDTH: f64 = 880.0;
const HEIGHT: f64 = 820.0;
const MIDDLE: f64 = 392.0;
/// Pixels per length.
const SCALE: f64 = 50.0;
/// How many colours there are.
const SHADES: usize = 32;
/// How many layers of haze stand between the back and the front.
const LAYERS: usize = 14;
const BACKGROUND: &str = "#0b1020";

/// From slow to fast: red, green and blue.
const PALETTE: [[f64; 3]; 5] = [
    [58.0, 74.0, 160.0],
    [128.0, 70.0, 170.0],
    [218.0, 76.0, 120.0],
    [250.0, 146.0, 74.0],
    [255.0, 226.0, 130.0],
];

/// The colour at a part between 0 and 1 of the palette, lighter or darker.
fn colour(part: f64, light: f64) -> String {
    let scaled = part.clamp(0.0, 1.0) * (PALETTE.len() - 1) as f64;
    let below = (scaled as usize).min(PALETTE.len() - 2);
    let part = scaled - below as f64;
    let mixed: [u8; 3] = core::array::from_fn(|k| {
        let base = PALETTE[below][k] * (1.0 - part) + PALETTE[below + 1][k] * part;
        let lit = if light > 1.0 { base + (255.0 - base) * (light - 1.0) } else { base * light };
        lit.round() as u8
    });
    format!("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2])
}

fn drawing(bodies: &Bodies<f64>) -> String {
    let view = View::new(0.46, 0.36);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"15\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"18\" fill=\"{BACKGROUND}\"/>\n<defs>\n"
    );
    for shade in 0..SHADES {
        let part = shade as f64 / (SHADES - 1) as f64;
        svg += &format!(
            "<radialGradient id=\"g{shade}\" cx=\".5\" cy=\".5\" r=\".55\" fx=\".36\" fy=\".3\">\
             <stop stop-color=\"{}\"/><stop offset=\".35\" stop-color=\"{}\"/>\
             <stop offset=\"1\" stop-color=\"{}\"/></radialGradient>\n",
            colour(part, 1.62),
            colour(part, 1.0),
            colour(part, 0.3),
        );
    }
    svg += "</defs>\n";

    // The edges of the container that the viewer sees through the spheres, and
    // in front of them.
    let mut edges = [String::new(), String::new()];
    for axis in 0..3 {
        for corner in 0..4 {
            let mut ends = [[0.0; 3]; 2];
            for (end, point) in ends.iter_mut().enumerate() {
                point[axis] = SIDE * end as f64;
                point[(axis + 1) % 3] = SIDE * f64::from(corner & 1);
                point[(axis + 2) % 3] = SIDE * f64::from(corner >> 1);
            }
            let [a, b] = ends.map(|point| view.project(point.into()));
            let is_in_front = a[2] + b[2] > 0.0;
            edges[usize::from(is_in_front)] +=
                &format!("M{:.1} {:.1}L{:.1} {:.1}", a[0], a[1], b[0], b[1]);
        }
    }
    let [behind, in_front] = edges.map(|path| {
        format!("<path d=\"{path}\" stroke=\"#8fa3d8\" stroke-opacity=\".45\" fill=\"none\"/>\n")
    });
    svg += &behind;

    // Painter's order: from the back to the front, with haze in between.
    let mut order: Vec<(usize, [f64; 3])> =
        (0..bodies.len()).map(|k| (k, view.project(bodies.position_of(k)))).collect();
    order.sort_by(|(_, a), (_, b)| a[2].total_cmp(&b[2]));
    let speeds: Vec<f64> = (0..bodies.len()).map(|k| bodies.velocity_of(k).length()).collect();
    let (slow, fast) = spread(&speeds);
    for layer in order.chunks(order.len().div_ceil(LAYERS)) {
        svg +=
            &format!("<path d=\"M0 20H{WIDTH}V740H0z\" fill=\"{BACKGROUND}\" opacity=\".1\"/>\n");
        for &(k, [x, y, _]) in layer {
            let part = ((speeds[k] / slow).ln() / (fast / slow).ln()).clamp(0.0, 1.0);
            let shade = (part * (SHADES - 1) as f64).round();
            let radius = SCALE * bodies.radius.of(k);
            svg += &format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"url(#g{shade})\"/>\n"
            );
        }
    }
    svg += &in_front;
    svg + &legend() + "</svg>\n"
}

/// The speeds that nineteen in twenty spheres lie between.
fn spread(speeds: &[f64]) -> (f64, f64) {
    let mut sorted = speeds.to_vec();
    sorted.sort_by(f64::total_cmp);
    (sorted[sorted.len() / 40], sorted[sorted.len() - 1 - sorted.len() / 40])
}

fn legend() -> String {
    let mut legend = String::new();
    for shade in 0..SHADES {
        let x = WIDTH / 2.0 + 6.0 * (shade as f64 - SHADES as f64 / 2.0);
        legend += &format!(
            "<rect x=\"{x}\" y=\"778\" width=\"6.5\" height=\"10\" fill=\"{}\"/>\n",
            colour(shade as f64 / (SHADES - 1) as f64, 1.0)
        );
    }
    legend
        + "<text x=\"334\" y=\"788\" fill=\"#b8c4e6\" text-anchor=\"end\">slow</text>\n\
           <text x=\"546\" y=\"788\" fill=\"#b8c4e6\">fast</text>\n"
}
