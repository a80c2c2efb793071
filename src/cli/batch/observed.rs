//! Observed: the figures of a scene's end, by their names.

use carom::bodies::Bodies;
use carom::observe::{Energy, Temperature};
use carom::real::Real;

use crate::cli::failure::Failure;
use crate::cli::summary::shortest;

/// A scene at its end.
pub struct End<'a, T: Real> {
    pub time: f64,
    pub steps: u64,
    pub energy: Energy,
    pub bodies: &'a Bodies<T>,
}

/// A figure of all bodies.
const FIGURES: [&str; 8] = [
    "time",
    "steps",
    "energy",
    "translational",
    "rotational",
    "potential",
    "temperature",
    "spin_temperature",
];

/// A figure of one body, as the state file has it: position, velocity and spin.
const OF_BODY: [&str; 9] = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"];

/// What is observed: a figure of all bodies, or one of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    pub name: String,
    figure: usize,
    /// The body; `None` for figures of all.
    body: Option<usize>,
}

impl Observed {
    /// Reads a name, as `temperature` or `x[3]`.
    pub fn parse(name: &str) -> Result<Self, Failure> {
        let found = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
            None => FIGURES.iter().position(|known| *known == name).map(|figure| (figure, None)),
            Some((column, body)) => {
                let figure = OF_BODY.iter().position(|known| *known == column);
                figure.zip(body.parse().ok()).map(|(figure, body)| (figure, Some(body)))
            }
        };
        let (figure, body) = found.ok_or_else(|| {
            Failure::Argument(format!(
                "--observe {name}: there is no such figure; known are {}, and of body 3 {}",
                FIGURES.join(", "),
                OF_BODY.map(|column| format!("{column}[3]")).join(", ")
            ))
        })?;
        Ok(Self { name: name.to_owned(), figure, body })
    }

    /// The figure; `None` where there is none, as the temperature of one body.
    pub fn of<T: Real>(&self, end: &End<'_, T>) -> Option<f64> {
        let End { time, steps, energy, bodies } = *end;
        let temperature = || Temperature::of(bodies);
        let Some(body) = self.body else {
            return match FIGURES[self.figure] {
                "time" => Some(time),
                "steps" => Some(steps as f64),
                "energy" => Some(energy.total()),
                "translational" => Some(energy.translational),
                "rotational" => Some(energy.rotational),
                "potential" => Some(energy.potential),
                "temperature" => temperature().map(|both| both.translational),
                _ => temperature().map(|both| both.rotational),
            };
        };
        let columns = [&bodies.position, &bodies.velocity, &bodies.spin];
        let column = &columns[self.figure / 3][self.figure % 3];
        column.get(body).map(|value| shortest(*value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_figures() {
        let ball = Bodies::from_positions(&[[0.0_f32; 3], [2.0, 0.1, 0.0]]);
        let ball = ball.velocities(&[[0.0, 0.0, 3.0], [0.0; 3]]).radius(0.5).build().unwrap();
        let energy = Energy::of(&ball, carom::Vec3::ZERO);
        let end = End { time: 1.5, steps: 3, energy, bodies: &ball };
        let of = |name| Observed::parse(name).unwrap().of(&end);
        assert_eq!((of("time"), of("steps"), of("energy")), (Some(1.5), Some(3.0), Some(4.5)));
        assert_eq!((of("y[1]"), of("vz[0]"), of("x[7]")), (Some(0.1), Some(3.0), None));
        for name in ["tim", "x", "x[-1]", "q[0]", "time[0]"] {
            let error = Observed::parse(name).unwrap_err().to_string();
            assert!(error.contains("there is no such figure"), "{error}");
        }
    }
}
