//! All digits: what a run in double-double conserves, as texts.

use carom::DoubleDouble;
use carom::bodies::Bodies;
use carom::real::Real;
use carom::scene::Scene;
use carom::study::invariants::Invariants;
use carom::study::table::Table;
use carom::vec3::Vec3;
use serde::Serialize;

/// Energy, momentum and angular momentum in the digits of double-double. They are texts:
/// what reads JSON takes a number for an `f64`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AllDigits {
    /// All of it, mass × length² per time².
    energy: Texts<String>,
    /// Mass × length per time.
    momentum: Texts<[String; 3]>,
    /// About the origin, mass × length² per time.
    angular_momentum: Texts<[String; 3]>,
}

/// At the start, at the end, and the difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Texts<V> {
    initial: V,
    #[serde(rename = "final")]
    end: V,
    change: V,
}

impl AllDigits {
    /// What a scene has at its start, if it is one in double-double.
    #[must_use]
    pub fn at_start<T: Real>(scene: &Scene<T>) -> Option<Invariants> {
        let has_digits = T::NAME == DoubleDouble::NAME;
        has_digits.then(|| Invariants::of(&scene.bodies, scene.gravity.cast()))
    }

    /// Of bodies at the end of a run.
    #[must_use]
    pub fn of<T: Real>(start: &Invariants, bodies: &Bodies<T>, gravity: Vec3<T>) -> Self {
        let end = Invariants::of(bodies, gravity.cast());
        Self {
            energy: Texts {
                initial: start.energy.to_string(),
                end: end.energy.to_string(),
                change: (end.energy - start.energy).to_string(),
            },
            momentum: Texts::of(start.momentum, end.momentum),
            angular_momentum: Texts::of(start.angular_momentum, end.angular_momentum),
        }
    }

    /// The same for a person.
    pub(super) fn table(&self) -> Table {
        let mut table = Table::of_texts();
        let mut row = |label: &str, text: &str| table.row(label, [text.to_owned()]);
        row("all digits, at the end", "");
        row("  energy", &self.energy.end);
        for (what, texts) in
            [("momentum", &self.momentum), ("angular momentum", &self.angular_momentum)]
        {
            for (axis, text) in ["x", "y", "z"].iter().zip(&texts.end) {
                row(&format!("  {what}, {axis}"), text);
            }
        }
        table
    }
}

impl Texts<[String; 3]> {
    fn of(initial: Vec3<DoubleDouble>, end: Vec3<DoubleDouble>) -> Self {
        let texts = |vector: Vec3<DoubleDouble>| vector.to_array().map(|value| value.to_string());
        Self { initial: texts(initial), end: texts(end), change: texts(end - initial) }
    }
}
