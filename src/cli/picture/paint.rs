//! Paint: the colour of each sphere, and the legend that says what it means.

use std::collections::BTreeMap;

use carom::bodies::Bodies;
use carom::observe::species;
use carom::study::chart::{Color, Look, Theme};

use super::camera::{Disc, Place};
use super::drawing::{Anchor, Item, LETTERS, Words, mixed};

/// What a colour says of a sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// Radius and mass.
    #[default]
    Species,
    /// The velocity's length.
    Speed,
    /// The angular velocity's length.
    Spin,
}

/// Colours from the least to the greatest figure.
const SHADES: usize = 48;

/// From few to much, on a light ground (viridis) and on a dark one.
const LIGHT: [Color; 5] =
    [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [240, 220, 40]];
const DARK: [Color; 5] =
    [[58, 74, 160], [128, 70, 170], [218, 76, 120], [250, 146, 74], [255, 226, 130]];

/// The height of a legend, pixels.
pub const LEGEND: f64 = 40.0;

/// The most species that a legend names.
const MOST_NAMED: usize = 6;

/// The colours of spheres.
pub struct Paint {
    colors: Vec<Color>,
    meaning: Meaning,
}

enum Meaning {
    /// Of each species its colour and what it is.
    Species(Vec<(Color, String)>),
    /// From where to where, and whether equal ways are equal ratios.
    Figure { name: &'static str, ends: [f64; 2], is_logarithmic: bool },
}

impl Paint {
    /// The colours of all spheres.
    pub fn new(bodies: &Bodies<f64>, by: ColorBy, look: &Look) -> Self {
        let figure = |k: usize| match by {
            ColorBy::Spin => bodies.spin_of(k).length(),
            _ => bodies.velocity_of(k).length(),
        };
        let name = match by {
            ColorBy::Species => return Self::by_species(bodies, look),
            ColorBy::Speed => "speed",
            ColorBy::Spin => "angular speed",
        };
        let figures: Vec<f64> = (0..bodies.len()).map(figure).collect();
        let (ends, is_logarithmic) = spread(&figures);
        let meaning = Meaning::Figure { name, ends, is_logarithmic };
        let scale = |value: f64| if is_logarithmic { value.ln() } else { value };
        let [least, greatest] = ends.map(scale);
        let share = |value: f64| match greatest > least {
            true => ((scale(value) - least) / (greatest - least)).clamp(0.0, 1.0),
            false => 0.5,
        };
        let colors = figures.into_iter().map(|value| shade(share(value), look)).collect();
        Self { colors, meaning }
    }

    fn by_species(bodies: &Bodies<f64>, look: &Look) -> Self {
        let kinds = species(bodies);
        let color = |kind: u32| look.color(Some((kind as usize - 1) % 6));
        let mut named: BTreeMap<u32, String> = BTreeMap::new();
        for (k, kind) in kinds.iter().enumerate() {
            named.entry(*kind).or_insert_with(|| {
                let [radius, mass] = [bodies.radius.of(k), bodies.mass.of(k)].map(few_digits);
                format!("radius {radius}, mass {mass}")
            });
        }
        let meaning = named.into_iter().map(|(kind, name)| (color(kind), name)).collect();
        let colors = kinds.into_iter().map(color).collect();
        Self { colors, meaning: Meaning::Species(meaning) }
    }

    /// Of a sphere.
    pub fn color(&self, index: usize) -> Color {
        self.colors[index]
    }

    /// Whether colours differ in what they mean.
    pub fn has_legend(&self) -> bool {
        match &self.meaning {
            Meaning::Species(named) => named.len() > 1,
            Meaning::Figure { .. } => true,
        }
    }

    /// What the colours mean, below a height.
    pub fn legend(&self, [width, top]: [f64; 2], look: &Look) -> (Vec<Item>, Vec<Words>) {
        let (mut items, mut words) = (Vec::new(), Vec::new());
        let ink = look.ink(0.85);
        let base = top + 0.5 * LEGEND + 0.36 * LETTERS;
        let mut say = |text: String, x: f64, anchor: Anchor| {
            words.push(Words { text, at: [x, base], anchor, color: ink });
        };
        match &self.meaning {
            Meaning::Species(named) => {
                let shown = named.len().min(MOST_NAMED);
                let is_cut = named.len() > shown;
                let room = (width - 32.0) / shown as f64;
                let longest = named.iter().take(shown).map(|(_, name)| name.len()).max();
                // About the width of the letters.
                let fits = 0.6 * LETTERS * longest.unwrap_or(0) as f64 <= room - 20.0;
                for (k, (color, name)) in named.iter().take(shown).enumerate() {
                    let (x, y) = (24.0 + room * k as f64, top + 0.5 * LEGEND);
                    let center = Place { x, y, near: 0.0 };
                    let disc = Disc { center, half: [7.0; 2], along: [1.0, 0.0] };
                    items.push(Item::Sphere { disc, color: *color, haze: 0 });
                    let name = if fits { name.clone() } else { format!("species {}", k + 1) };
                    let more = if is_cut && k + 1 == shown { " …" } else { "" };
                    say(format!("{name}{more}"), x + 14.0, Anchor::Start);
                }
            }
            Meaning::Figure { name, ends, is_logarithmic } => {
                let [least, greatest] = ends.map(few_digits);
                let length = (0.34 * width).min(260.0);
                let left = 0.5 * (width - length);
                let step = length / SHADES as f64;
                for k in 0..SHADES {
                    let x = left + step * k as f64;
                    let share = (k as f64 + 0.5) / SHADES as f64;
                    let [up, down] = [-5.0, 5.0].map(|off| top + 0.5 * LEGEND + off);
                    let at = |x: f64, y: f64| Place { x, y, near: 0.0 };
                    let corners =
                        vec![at(x, up), at(x + step, up), at(x + step, down), at(x, down)];
                    items.push(Item::Area { corners, color: shade(share, look), opacity: 1.0 });
                }
                let scale = if *is_logarithmic { ", logarithmic" } else { "" };
                say(format!("{name} {least}"), left - 10.0, Anchor::End);
                say(format!("{greatest}{scale}"), left + length + 10.0, Anchor::Start);
            }
        }
        (items, words)
    }
}

/// The figures that nineteen in twenty spheres lie between, and whether they are of many
/// sizes.
fn spread(figures: &[f64]) -> ([f64; 2], bool) {
    let mut sorted = figures.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |index: usize| sorted.get(index).copied().unwrap_or_default();
    let aside = sorted.len() / 40;
    let ends = [at(aside), at(sorted.len().saturating_sub(1 + aside))];
    (ends, ends[0] > 0.0 && ends[1] > 12.0 * ends[0])
}

/// The colour at a share of the way from few to much.
fn shade(share: f64, look: &Look) -> Color {
    let palette = if look.theme == Theme::Dark { DARK } else { LIGHT };
    let steps = (SHADES - 1) as f64;
    let place = (share * steps).round() / steps * (palette.len() - 1) as f64;
    let below = (place as usize).min(palette.len() - 2);
    mixed(palette[below], palette[below + 1], place - below as f64)
}

/// A figure in three digits.
fn few_digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{value:.digits$}");
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    format!("{value:.2e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_few_digits() {
        let shown = [0.0, 0.5, 1234.5, 0.12345, 99_999.0, 2.5e-7, 1.0].map(few_digits);
        assert_eq!(shown, ["0", "0.5", "1234", "0.123", "99999", "2.50e-7", "1"]);
    }

    #[test]
    fn few_spheres_are_off_the_scale() {
        let figures: Vec<f64> = (0..=80).map(f64::from).collect();
        assert_eq!(spread(&figures), ([2.0, 78.0], true));
        assert_eq!(spread(&[3.0]), ([3.0, 3.0], false));
        assert_eq!(spread(&[]), ([0.0, 0.0], false));
    }
}
