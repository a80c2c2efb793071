//! Look: the colours of a picture, and how wide it is.

use crate::numbers::array::{self, Each};

/// What pictures look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Its colours.
    pub theme: Theme,
    /// Of a chart, pixels, 96 to the inch. Text and lines keep their size: a chart of 302
    /// pixels fills a column of 8 cm as it is, one of 480 is made smaller, and its text too.
    pub width: u32,
}

/// On what pictures are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark lines on white.
    #[default]
    Light,
    /// Light lines on a dark ground.
    Dark,
}

impl Default for Look {
    fn default() -> Self {
        Self { theme: Theme::Light, width: 480 }
    }
}

/// Red, green and blue.
pub type Color = [u8; 3];

/// Colours that colour-blind readers can separate (Okabe and Ito 2008); the last one is
/// that of text.
const LIGHT: [Color; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];

/// The same where they are dark themselves made lighter.
const DARK: [Color; 6] = [
    [90, 170, 235],
    [240, 130, 60],
    [50, 190, 145],
    [222, 150, 190],
    [240, 185, 60],
    [150, 215, 250],
];

impl Look {
    /// What is behind everything: red, green and blue.
    #[must_use]
    pub fn ground(&self) -> Color {
        match self.theme {
            Theme::Light => [255; 3],
            Theme::Dark => [18, 20, 24],
        }
    }

    /// This share of the colour of text on the ground.
    #[must_use]
    pub fn ink(&self, share: f64) -> Color {
        let text: Color = match self.theme {
            Theme::Light => [0; 3],
            Theme::Dark => [235; 3],
        };
        let ground = self.ground();
        array::from_fn(|k| {
            let [from, to] = [ground[k], text[k]].each(f64::from);
            (from + share * (to - from)).round() as u8
        })
    }

    /// A colour of the palette; grey for `None`.
    ///
    /// ```
    /// use carom::study::chart::Look;
    /// assert_eq!(Look::default().color(Some(0)), [0, 114, 178]);
    /// ```
    #[must_use]
    pub fn color(&self, color: Option<usize>) -> Color {
        let palette = match self.theme {
            Theme::Light => LIGHT,
            Theme::Dark => DARK,
        };
        match color.map(|color| color % (palette.len() + 1)) {
            None => self.ink(0.53),
            Some(color) => palette.get(color).copied().unwrap_or_else(|| self.ink(1.0)),
        }
    }

    /// The height of a chart without its legend, pixels.
    pub(super) fn height(&self) -> f64 {
        (f64::from(self.width) * 0.75).round()
    }
}
