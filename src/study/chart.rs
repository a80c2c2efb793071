//! Charts: measured points and laws, drawn as SVG and PNG, and as PDF with the feature `pdf`.

mod axis;
mod canvas;
mod draw;
mod look;
mod text;

use std::path::Path;

use plotters::prelude::{BitMapBackend, IntoDrawingArea, SVGBackend};

use super::StudyError;
use super::folder::Folder;
use canvas::Canvas;

pub use axis::{Axis, Scale};
pub use look::{Color, Look, Theme};

/// How points are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Joined by a line.
    Line,
    /// Joined by a line of dashes: for laws.
    Dashes,
    /// Joined, and each with a marker.
    #[default]
    LineAndMarkers,
    /// Each by itself, with a marker.
    Markers,
    /// Each by itself, as a ring: for points that stand out.
    Rings,
    /// Joined by a thin line of dashes with its name at the end, and not in the legend: for
    /// the slope of a law, or a bound.
    Guide,
}

/// What a marker looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    #[default]
    Disc,
    /// A square.
    Square,
    /// A triangle that points upwards.
    Triangle,
}

/// Points that belong together.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// Which colour of the palette it has; `None` for grey.
    pub color: Option<usize>,
    /// How the points are drawn.
    pub mark: Mark,
    /// What markers look like.
    pub shape: Shape,
    /// In the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// From where to where single points may lie.
    pub bars: Vec<[(f64, f64); 2]>,
}

/// A chart: two axes and what lies between them.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// Above it.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// From the back to the front.
    pub series: Vec<Series>,
}

/// Charts side by side, each with its legend below; more than three stand in rows of two.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// From left to right, and from the top down.
    pub charts: Vec<Chart>,
}

/// The kind of a file that a picture is written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines, and text as text.
    Svg,
    /// Two of its pixels for each one of the [look](Look), in either direction.
    Png,
    /// Made of the SVG, with its font; it needs the feature `pdf`.
    Pdf,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Png, Self::Pdf];

    /// The ending of its files.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }

    /// Whether this crate is built with it.
    #[must_use]
    pub fn is_built(self) -> bool {
        self != Self::Pdf || cfg!(feature = "pdf")
    }

    /// The one that a file's name ends with.
    ///
    /// ```
    /// use carom::study::chart::Format;
    /// assert_eq!(Format::of("energy.pdf".as_ref()), Some(Format::Pdf));
    /// assert_eq!(Format::of("energy.jpeg".as_ref()), None);
    /// ```
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        Self::ALL.into_iter().find(|format| ending == format.ending())
    }
}

impl Series {
    /// Grey points that are joined, each with a marker.
    pub fn new(name: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { name: name.into(), points: points.into_iter().collect(), ..Self::default() }
    }

    /// The same in a colour of the palette.
    #[must_use]
    pub fn color(self, color: usize) -> Self {
        Self { color: Some(color), ..self }
    }

    /// The same drawn in another way.
    #[must_use]
    pub fn mark(self, mark: Mark) -> Self {
        Self { mark, ..self }
    }
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self { charts: vec![chart] }
    }
}

impl Picture {
    /// Writes `NAME.svg` and `NAME.png` into a folder, with the feature `pdf` also `NAME.pdf`.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, folder: &Folder, name: &str, look: &Look) -> Result<(), StudyError> {
        let formats = Format::ALL.into_iter().filter(|format| format.is_built());
        formats.into_iter().try_for_each(|format| {
            let name = format!("{name}.{}", format.ending());
            let failed = |reason| StudyError::Picture { path: folder.path().join(&name), reason };
            folder.write(&name, &self.bytes(format, look).map_err(failed)?)
        })
    }

    /// The bytes of the picture's file.
    ///
    /// # Errors
    /// If it cannot be drawn, or the format is not [built in](Format::is_built), as a sentence.
    pub fn bytes(&self, format: Format, look: &Look) -> Result<Vec<u8>, String> {
        match format {
            Format::Svg => Ok(self.svg(look)?.into_bytes()),
            Format::Png => self.png(look),
            Format::Pdf => pdf_of(&self.svg(look)?),
        }
    }

    fn svg(&self, look: &Look) -> Result<String, String> {
        /// Places are whole numbers in the file.
        const FINE: f64 = 8.0;
        let mut text = String::new();
        let size = self.size(look);
        let (width, height) = fine(size, FINE);
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        let mut canvas = Canvas::new(area, FINE, look.ground());
        self.draw(&mut canvas, look);
        canvas.finish()?;
        let of = |width: String, height: String| format!("width=\"{width}\" height=\"{height}\"");
        let fine = of(width.to_string(), height.to_string());
        Ok(text.replacen(&fine, &of(size.0.to_string(), size.1.to_string()), 1))
    }

    fn png(&self, look: &Look) -> Result<Vec<u8>, String> {
        /// For fine screens.
        const FINE: f64 = 2.0;
        let size = fine(self.size(look), FINE);
        let mut pixels = vec![0; 3 * size.0 as usize * size.1 as usize];
        let area = BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area();
        let mut canvas = Canvas::new(area, FINE, look.ground());
        self.draw(&mut canvas, look);
        canvas.finish()?;
        png_of(&pixels, size)
    }
}

/// The size in pixels of a file that has `pixels` for each one of a picture.
fn fine((width, height): (f64, f64), pixels: f64) -> (u32, u32) {
    ((width * pixels).ceil() as u32, (height * pixels).ceil() as u32)
}

/// The PNG file of an image of three bytes a pixel, row by row.
///
/// ```
/// use carom::study::chart::png_of;
/// let file = png_of(&[255, 0, 0, 0, 0, 255], (2, 1))?;
/// assert!(file.starts_with(b"\x89PNG"));
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// If there are more or fewer pixels, as a sentence.
pub fn png_of(pixels: &[u8], size: (u32, u32)) -> Result<Vec<u8>, String> {
    encoded(pixels, size).map_err(|error| error.to_string())
}

fn encoded(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // The unit is the metre: 192 to the inch.
    let dims = png::PixelDimensions { xppu: 7559, yppu: 7559, unit: png::Unit::Meter };
    encoder.set_pixel_dims(Some(dims));
    let mut file = encoder.write_header()?;
    file.write_image_data(pixels)?;
    file.finish()?;
    Ok(bytes)
}

/// The PDF file of an SVG.
///
/// # Errors
/// If this crate is built without the feature `pdf`, or it is no SVG, as a sentence.
#[cfg(feature = "pdf")]
pub fn pdf_of(svg: &str) -> Result<Vec<u8>, String> {
    use svg2pdf::usvg::{Options, Tree};
    use svg2pdf::{ConversionOptions, PageOptions};

    let mut options = Options::default();
    options.fontdb_mut().load_font_data(dejavu::sans::regular().to_vec());
    let tree = Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let page = PageOptions { dpi: 96.0 };
    svg2pdf::to_pdf(&tree, ConversionOptions::default(), page).map_err(|error| error.to_string())
}

/// The PDF file of an SVG.
///
/// # Errors
/// This crate is built without the feature `pdf`.
#[cfg(not(feature = "pdf"))]
pub fn pdf_of(_: &str) -> Result<Vec<u8>, String> {
    Err("this program is built without PDF: write an .svg, or build with --features pdf".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orders() -> Picture {
        let law =
            |power: i32| (1..20).map(move |n| (2.0_f64.powi(-n), 1e-3 * 2.0_f64.powi(-n * power)));
        let chart = Chart {
            title: "errors, ε²".to_owned(),
            x: Axis::new("Δt, s", Scale::Logarithmic),
            y: Axis::new("error, m", Scale::Logarithmic),
            series: vec![
                Series::new("first order", law(1)).color(0),
                Series::new("second order", law(2)).color(1).mark(Mark::Line),
                Series::new("law", law(3)).mark(Mark::Dashes),
                Series::new("best", law(1)).color(3).mark(Mark::Rings),
                Series::new("order 2", [(1e-5, 1e-12), (1e-1, 1e-4)]).mark(Mark::Guide),
            ],
        };
        let empty = Chart { title: "empty".to_owned(), ..Chart::default() };
        Picture { charts: vec![chart, empty] }
    }

    #[test]
    fn draws_all_kinds_of_files() -> Result<(), Box<dyn std::error::Error>> {
        let temporary = tempfile::tempdir()?;
        let folder = Folder::open(temporary.path())?;
        orders().write(&folder, "orders", &Look::default())?;
        let svg = std::fs::read_to_string(folder.path().join("orders.svg"))?;
        for text in ["errors, ε²", "Δt, s", "second order", "10⁻³", "order 2"] {
            assert!(svg.contains(text), "{text} is missing");
        }
        let png = std::fs::read(folder.path().join("orders.png"))?;
        assert!(png.starts_with(b"\x89PNG"));
        if Format::Pdf.is_built() {
            let pdf = std::fs::read(folder.path().join("orders.pdf"))?;
            assert!(pdf.starts_with(b"%PDF-") && pdf.len() > 10_000, "{} bytes", pdf.len());
        }
        // Nothing else is left, now that the folder is no longer locked.
        drop(folder);
        assert_eq!(
            std::fs::read_dir(temporary.path())?.count(),
            Format::ALL.iter().filter(|format| format.is_built()).count()
        );
        if let Some(path) = std::env::var_os("CAROM_KEEP_CHART") {
            std::fs::copy(temporary.path().join("orders.png"), path)?;
        }
        Ok(())
    }

    #[test]
    fn looks_differ() -> Result<(), String> {
        let text = |look: &Look| {
            Ok::<_, String>(String::from_utf8(orders().bytes(Format::Svg, look)?).unwrap())
        };
        let light = text(&Look::default())?;
        let dark = text(&Look { theme: Theme::Dark, ..Look::default() })?;
        assert!(light.contains("#FFFFFF") && !dark.contains("#FFFFFF"));
        let narrow = text(&Look { width: 300, ..Look::default() })?;
        assert!(narrow.contains("width=\"600\""), "two charts of 300 pixels");
        // Text keeps its size.
        let sizes = |svg: &str| -> Vec<f64> {
            let after = svg.split("font-size=\"").skip(1);
            after.filter_map(|rest| rest.split('"').next()?.parse().ok()).map(f64::round).collect()
        };
        assert!(sizes(&light).contains(&104.0) && sizes(&narrow).contains(&104.0));
        Ok(())
    }
}
