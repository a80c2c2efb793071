//! What commands take that draw: a table, a scene, its motion.

use std::path::PathBuf;

use clap::Args;

use super::{SceneArguments, one_of};
use crate::cli::picture::ColorBy;
use crate::cli::pictures::PictureLook;

/// What `carom plot` takes.
#[derive(Args, Debug)]
pub struct PlotArguments {
    /// A file of comma-separated values with names in its first line, as --series writes
    /// it
    pub file: PathBuf,

    /// The picture, .svg, .png or .pdf [default: the file's name with .svg]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub pictures: PictureLook,

    /// Which columns to draw [default: all that have numbers]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub columns: Vec<String>,

    /// Draw how the values of each column are distributed
    #[arg(long)]
    pub histogram: bool,

    /// Bins of a histogram [default: as many as the values tell apart]
    #[arg(
        long, value_name = "NUMBER", requires = "histogram",
        value_parser = clap::value_parser!(u32).range(1..=10_000)
    )]
    pub bins: Option<u32>,
}

/// What `carom picture` takes.
#[derive(Args, Debug)]
pub struct PictureArguments {
    #[command(flatten)]
    pub scene: SceneArguments,

    /// The picture, .svg, .png or .pdf [default: the subject's name with .svg]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// What the colours of spheres say
    #[arg(long, value_parser = one_of(&COLORS), default_value = "species")]
    pub color: ColorBy,

    /// The direction from which it is seen [default: from the front, the right and above]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub from: Option<[f64; 3]>,

    /// What is up [default: against gravity, or along z]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub up: Option<[f64; 3]>,

    /// The angle of view, degrees: what is nearer is larger then
    #[arg(long, value_name = "DEGREES", value_parser = angle, allow_negative_numbers = true)]
    pub perspective: Option<f64>,

    /// Leave out what says what the colours mean
    #[arg(long)]
    pub no_legend: bool,

    #[command(flatten)]
    pub pictures: PictureLook,
}

/// What `carom view` takes.
#[derive(Args, Debug)]
pub struct ViewArguments {
    #[command(flatten)]
    pub scene: SceneArguments,

    /// The page [default: the subject's name with .html]
    #[arg(short, long, value_name = "FILE.html")]
    pub output: Option<PathBuf>,

    /// How many frames of a scene there are beside its start [default: 300]; of recorded ones
    /// the most that are kept
    #[arg(long, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: Option<u64>,

    /// How large its data may be, megabytes; every second frame is left out until they are not
    /// larger
    #[arg(long, value_name = "MB", default_value_t = 64, allow_negative_numbers = true,
          value_parser = clap::value_parser!(u64).range(1..=1_000))]
    pub limit: u64,
}

const COLORS: [(&str, ColorBy); 3] =
    [("species", ColorBy::Species), ("speed", ColorBy::Speed), ("spin", ColorBy::Spin)];

/// Takes a direction.
fn direction(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> =
        text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 => {
            let length = (x * x + y * y + z * z).sqrt();
            if length.is_normal() {
                return Ok([x / length, y / length, z / length]);
            }
            Err("it must have a length above 0 in the range of numbers".to_owned())
        }
        _ => Err("it must be three numbers, as 1,0,0.5".to_owned()),
    }
}

/// Takes an angle of view.
fn angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1.0..=120.0).contains(&value) => Ok(value),
        _ => Err("it must be a number from 1 to 120".to_owned()),
    }
}
