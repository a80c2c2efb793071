//! Pictures: what they look like, as the arguments say.

use carom::study::chart::{Look, Theme};
use clap::Args;

use super::arguments::one_of;

/// What pictures look like.
#[derive(Args, Clone, Copy, Debug)]
pub struct PictureLook {
    /// Colours of the pictures
    #[arg(long, value_parser = one_of(&THEMES), default_value = "light")]
    theme: Theme,

    /// Width of each chart, 96 pixels to the inch; text keeps its size: 302 are a column of
    /// 8 cm
    #[arg(long, value_name = "PIXELS", default_value_t = Look::default().width,
        value_parser = clap::value_parser!(u32).range(200..=4000))]
    width: u32,
}

const THEMES: [(&str, Theme); 2] = [("light", Theme::Light), ("dark", Theme::Dark)];

impl PictureLook {
    /// As the library has it.
    pub fn look(self) -> Look {
        Look { theme: self.theme, width: self.width }
    }
}
