//! Charts: measured points and laws, drawn as SVG and as PNG.

use core::ops::Range;
use std::path::Path;
use std::sync::Once;

use plotters::coord::ranged1d::{NoDefaultFormatting, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::register_font;

use super::StudyError;
use super::file::write_file;

/// How far a scale goes, and how it is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal ways are equal differences.
    #[default]
    Linear,
    /// Equal ways are equal ratios; what is not positive is not drawn.
    Logarithmic,
}

/// One of the two directions of a chart.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How it is divided.
    pub scale: Scale,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Joined by a line.
    Line,
    /// Joined by a line of dashes: for laws.
    Dashes,
    /// Joined, and each with a disc.
    #[default]
    LineAndDiscs,
    /// Each by itself, as a ring: for points that stand out.
    Rings,
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
    /// In the order in which they are joined.
    pub points: Vec<(f64, f64)>,
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

/// Charts side by side.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// From left to right.
    pub charts: Vec<Chart>,
}

/// Of a chart, pixels.
const SIZE: (u32, u32) = (640, 480);

/// In which all text is set. It comes with the program: a PNG looks the same
/// everywhere.
const FONT: &str = "DejaVu Sans, sans-serif";

/// Colours that can be told apart by all (Okabe and Ito 2008).
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

impl Picture {
    /// Writes `NAME.svg` and `NAME.png` into a folder.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, folder: &Path, name: &str) -> Result<(), StudyError> {
        static FONTS: Once = Once::new();
        FONTS.call_once(|| {
            // A font that cannot be read leaves the picture without text.
            let _ = register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
        });
        let size = (SIZE.0 * self.charts.len().max(1) as u32, SIZE.1);
        let failed =
            |path: &Path, reason: String| StudyError::Picture { path: path.into(), reason };

        let path = folder.join(format!("{name}.svg"));
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, size).into_drawing_area())
            .map_err(|reason| failed(&path, reason))?;
        write_file(&path, text.as_bytes())?;

        let path = folder.join(format!("{name}.png"));
        let file = tempfile::Builder::new().prefix(".carom-").suffix(".png").tempfile_in(folder);
        let file = file.map_err(|error| failed(&path, error.to_string()))?;
        self.draw(&BitMapBackend::new(file.path(), size).into_drawing_area())
            .map_err(|reason| failed(&path, reason))?;
        let bytes = std::fs::read(file.path()).map_err(|error| failed(&path, error.to_string()))?;
        write_file(&path, &bytes)
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), String> {
        area.fill(&WHITE).map_err(|error| error.to_string())?;
        for (chart, area) in self.charts.iter().zip(area.split_evenly((1, self.charts.len()))) {
            chart.draw(&area)?;
        }
        area.present().map_err(|error| error.to_string())
    }
}

impl Axis {
    /// What the axis shows.
    #[must_use]
    pub fn new(label: &str, scale: Scale) -> Self {
        Self { label: label.to_owned(), scale }
    }

    /// Where a value is: the axis itself is linear in it.
    fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value > 0.0 => value.log10(),
            Scale::Logarithmic => return None,
        };
        place.is_finite().then_some(place)
    }

    /// From where to where the values reach, with a margin.
    fn range(&self, values: impl Iterator<Item = f64>) -> Range<f64> {
        let (least, greatest) = values
            .filter_map(|value| self.place(value))
            .fold((f64::MAX, f64::MIN), |(least, greatest), v| (least.min(v), greatest.max(v)));
        if least > greatest {
            return 0.0..1.0;
        }
        let margin = match greatest - least {
            0.0 => 0.5,
            span => span * 0.04,
        };
        least - margin..greatest + margin
    }
}

/// A range of an axis with round numbers on it.
struct Divided {
    range: RangedCoordf64,
    span: Range<f64>,
    scale: Scale,
}

impl Ranged for Divided {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<H: plotters::coord::ranged1d::KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let decades = self.span.end - self.span.start;
        if self.scale == Scale::Linear {
            return self.range.key_points(hint);
        }
        // Powers of ten; between them 2 and 5 where there are few.
        let every = (decades / 8.0).ceil().max(1.0);
        let parts: &[f64] = if decades < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let first = (self.span.start / every).floor() * every;
        let powers = (0..).map(|k| first + every * f64::from(k)).take_while(|p| *p < self.span.end);
        let points = powers.flat_map(|power| parts.iter().map(move |part| power + part.log10()));
        points.filter(|point| self.span.contains(point)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.span.clone()
    }
}

impl ValueFormatter<f64> for Divided {
    fn format_ext(&self, place: &f64) -> String {
        match self.scale {
            Scale::Linear => short(*place),
            Scale::Logarithmic => short(10.0_f64.powf(*place)),
        }
    }
}

/// A round number in few letters.
fn short(value: f64) -> String {
    // What is left of a sum that should be 0.
    let value = if value.abs() < 1e-300 { 0.0 } else { value };
    let size = value.abs();
    if value == 0.0 || (1e-2..1e5).contains(&size) {
        let digits = format!("{value:.3}");
        return digits.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let digits = format!("{value:.1e}");
    digits.replace(".0e", "e")
}

impl Chart {
    /// The upper corner from which most lines go away, or to which they fall.
    fn legend_corner(&self) -> SeriesLabelPosition {
        let ends = self.series.iter().filter_map(|series| {
            let by_x = |a: &&(f64, f64), b: &&(f64, f64)| a.0.total_cmp(&b.0);
            let points = || series.points.iter();
            Some((points().min_by(by_x)?.1, points().max_by(by_x)?.1))
        });
        let (rising, falling) = ends.fold((0, 0), |(rising, falling), (left, right)| {
            (rising + usize::from(right > left), falling + usize::from(right < left))
        });
        if rising > falling {
            SeriesLabelPosition::UpperLeft
        } else {
            SeriesLabelPosition::UpperRight
        }
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), String> {
        self.drawn(area).map_err(|error| error.to_string())
    }

    fn drawn<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let points = || self.series.iter().flat_map(|series| series.points.iter());
        let divided = |axis: &Axis, span: Range<f64>| Divided {
            range: span.clone().into(),
            span,
            scale: axis.scale,
        };
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, (FONT, 18))
            .margin(14)
            .x_label_area_size(46)
            .y_label_area_size(76)
            .build_cartesian_2d(
                divided(&self.x, self.x.range(points().map(|point| point.0))),
                divided(&self.y, self.y.range(points().map(|point| point.1))),
            )?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .label_style((FONT, 13))
            .axis_desc_style((FONT, 15))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .draw()?;
        for series in &self.series {
            let color =
                series.color.map_or(RGBColor(120, 120, 120), |k| PALETTE[k % PALETTE.len()]);
            let places: Vec<(f64, f64)> = series
                .points
                .iter()
                .filter_map(|(x, y)| self.x.place(*x).zip(self.y.place(*y)))
                .collect();
            let stroke = color.stroke_width(2);
            let mark = series.mark;
            let line = move |(x, y)| PathElement::new([(x, y), (x + 20, y)], stroke);
            let drawn = match mark {
                Mark::Line | Mark::LineAndDiscs => {
                    chart.draw_series(LineSeries::new(places.iter().copied(), stroke))?.legend(line)
                }
                Mark::Dashes => chart
                    .draw_series(DashedLineSeries::new(places.iter().copied(), 6, 5, stroke))?
                    .legend(line),
                Mark::Rings => chart
                    .draw_series(places.iter().map(|&place| Circle::new(place, 8, stroke)))?
                    .legend(move |(x, y)| Circle::new((x + 10, y), 6, stroke)),
            };
            if !series.name.is_empty() {
                drawn.label(&series.name);
            }
            if mark == Mark::LineAndDiscs {
                let discs = places.iter().map(|&place| Circle::new(place, 3, color.filled()));
                chart.draw_series(discs)?;
            }
        }
        chart
            .configure_series_labels()
            .position(self.legend_corner())
            .legend_area_size(28)
            .label_font((FONT, 13))
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.2))
            .draw()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_both_kinds_of_files() -> Result<(), Box<dyn std::error::Error>> {
        let law =
            |power: i32| (1..20).map(move |n| (2.0_f64.powi(-n), 1e-3 * 2.0_f64.powi(-n * power)));
        let series = |name: &str, power, color, mark| Series {
            name: name.to_owned(),
            color,
            mark,
            points: law(power).collect(),
        };
        let chart = Chart {
            title: "errors, ε²".to_owned(),
            x: Axis::new("Δt, s", Scale::Logarithmic),
            y: Axis::new("error, m", Scale::Logarithmic),
            series: vec![
                series("first order", 1, Some(0), Mark::LineAndDiscs),
                series("second order", 2, Some(1), Mark::Line),
                series("law", 3, None, Mark::Dashes),
                series("best", 1, Some(3), Mark::Rings),
            ],
        };
        let empty = Chart { title: "empty".to_owned(), ..Chart::default() };
        let folder = tempfile::tempdir()?;
        Picture { charts: vec![chart, empty] }.write(folder.path(), "orders")?;
        let svg = std::fs::read_to_string(folder.path().join("orders.svg"))?;
        for text in ["errors, ε²", "Δt, s", "second order", "1e-3"] {
            assert!(svg.contains(text), "{text} is missing");
        }
        let png = std::fs::read(folder.path().join("orders.png"))?;
        assert!(png.starts_with(b"\x89PNG"));
        // Letters are drawn, not only lines: the picture without a font is
        // smaller.
        assert!(png.len() > 20_000, "{} bytes", png.len());
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 2);
        if let Some(path) = std::env::var_os("CAROM_KEEP_CHART") {
            std::fs::copy(folder.path().join("orders.png"), path)?;
        }
        Ok(())
    }

    #[test]
    fn numbers_are_short() {
        let written = [0.0, 0.05, 1.0, 1234.5, 1e5, 2.5e-7, 1e-12].map(short);
        assert_eq!(written, ["0", "0.05", "1", "1234.5", "1e5", "2.5e-7", "1e-12"]);
    }
}
