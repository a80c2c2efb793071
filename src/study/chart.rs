//! Charts: measured points and laws, drawn as SVG and as PNG.

mod axis;

use std::ops::Add;
use std::path::Path;
use std::sync::Once;

use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::StudyError;
use super::folder::{Folder, write};
use axis::Divided;

pub use axis::{Axis, Scale};

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

/// The file of a picture of three bytes a pixel, row by row.
fn png(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut file = encoder.write_header()?;
    file.write_image_data(pixels)?;
    file.finish()?;
    Ok(bytes)
}

/// Charts side by side, each with its legend below; more than three stand in rows of two.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// From left to right, and from the top down.
    pub charts: Vec<Chart>,
}

/// Of a chart without its legend, pixels.
const SIZE: (u32, u32) = (640, 480);

/// Around a chart, pixels.
const MARGIN: i32 = 14;

/// For the numbers and the label of the vertical axis, pixels.
const LABELS: i32 = 76;

/// Of a line of the legend, pixels.
const LINE: i32 = 20;

/// In which all text is set. It comes with the program: a PNG looks the same
/// everywhere.
const FONT: &str = "DejaVu Sans, sans-serif";

/// Colours that colour-blind readers can separate (Okabe and Ito 2008).
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
    pub fn write(&self, folder: &Folder, name: &str) -> Result<(), StudyError> {
        let folder = folder.path();
        let failed =
            |path: &Path, reason: String| StudyError::Picture { path: path.into(), reason };

        let path = folder.join(format!("{name}.svg"));
        let text = self.svg().map_err(|reason| failed(&path, reason))?;
        write(&path, text.as_bytes())?;

        let path = folder.join(format!("{name}.png"));
        let size = self.size();
        let mut pixels = vec![0; 3 * size.0 as usize * size.1 as usize];
        self.draw(&BitMapBackend::with_buffer(&mut pixels, size).into_drawing_area())
            .map_err(|reason| failed(&path, reason))?;
        let bytes = png(&pixels, size).map_err(|error| failed(&path, error.to_string()))?;
        write(&path, &bytes)
    }

    /// The text of the picture as SVG.
    ///
    /// # Errors
    /// If it cannot be drawn, as a sentence.
    pub fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, self.size()).into_drawing_area())?;
        Ok(text)
    }

    /// The charts that stand side by side.
    fn rows(&self) -> impl Iterator<Item = &[Chart]> {
        self.charts.chunks(if self.charts.len() > 3 { 2 } else { 3 })
    }

    /// Width and height, pixels.
    fn size(&self) -> (u32, u32) {
        let charts = self.rows().map(<[Chart]>::len).max().unwrap_or(1).max(1);
        let height = self.rows().map(row_height).sum::<u32>();
        (SIZE.0 * charts as u32, height.max(1))
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), String> {
        static FONTS: Once = Once::new();
        FONTS.call_once(|| {
            // A font that cannot be read leaves the picture without text.
            let _ = register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
        });
        area.fill(&WHITE).map_err(|error| error.to_string())?;
        let mut below = area.clone();
        for row in self.rows() {
            let (mut rest, next) = below.split_vertically(row_height(row));
            for chart in row {
                let (own, right) = rest.split_horizontally(SIZE.0);
                chart.draw(&own)?;
                rest = right;
            }
            below = next;
        }
        area.present().map_err(|error| error.to_string())
    }
}

/// The height of charts side by side, pixels.
fn row_height(row: &[Chart]) -> u32 {
    SIZE.1 + row.iter().map(Chart::legend_height).max().unwrap_or(0)
}

/// A marker at a place.
type MarkerAt<C, B> = <EmptyElement<C, B> as Add<Polygon<(i32, i32)>>>::Output;

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

    fn ink(&self) -> RGBColor {
        self.color.map_or(RGBColor(120, 120, 120), |k| PALETTE[k % PALETTE.len()])
    }

    fn has_markers(&self) -> bool {
        matches!(self.mark, Mark::LineAndMarkers | Mark::Markers)
    }

    /// The marker of a point, as a polygon: of a disc with 16 corners, too many to see.
    fn marker<C, B: DrawingBackend>(&self, place: C) -> MarkerAt<C, B> {
        let corners = match self.shape {
            Shape::Disc => (0..16)
                .map(|k| f64::from(k) * std::f64::consts::TAU / 16.0)
                .map(|angle| {
                    ((4.0 * angle.cos()).round() as i32, (4.0 * angle.sin()).round() as i32)
                })
                .collect(),
            Shape::Square => vec![(-3, -3), (3, -3), (3, 3), (-3, 3)],
        };
        EmptyElement::at(place) + Polygon::new(corners, self.ink().filled())
    }
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self { charts: vec![chart] }
    }
}

impl Chart {
    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), String> {
        self.drawn(area).map_err(|error| error.to_string())
    }

    /// Those that the legend names.
    fn named(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|series| !series.name.is_empty() && series.mark != Mark::Guide)
    }

    /// How wide an entry of the legend is, pixels; as many as fit stand side by side.
    fn legend_entry(&self) -> u32 {
        let longest = self.named().map(|series| series.name.chars().count()).max().unwrap_or(0);
        let width = SIZE.0 - LABELS as u32;
        width / (width / (longest as u32 * 6 + 44)).max(1)
    }

    fn legend_height(&self) -> u32 {
        let columns = (SIZE.0 - LABELS as u32) / self.legend_entry();
        self.named().count().div_ceil(columns as usize) as u32 * LINE as u32
    }

    /// What each series is called: below the chart, where it hides nothing.
    fn legend<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let entry = self.legend_entry() as i32;
        let columns = (SIZE.0 as i32 - LABELS) / entry;
        for (k, series) in (0..).zip(self.named()) {
            let (x, y) = (LABELS + k % columns * entry, LINE * (k / columns) + LINE / 2 - 4);
            let stroke = series.ink().stroke_width(2);
            let dash = |from: i32, to: i32| PathElement::new([(x + from, y), (x + to, y)], stroke);
            match series.mark {
                Mark::Line | Mark::LineAndMarkers => area.draw(&dash(0, 24))?,
                Mark::Dashes => {
                    for from in [0, 9, 18] {
                        area.draw(&dash(from, from + 6))?;
                    }
                }
                Mark::Rings => area.draw(&Circle::new((x + 12, y), 6, stroke))?,
                Mark::Markers | Mark::Guide => {}
            }
            if series.has_markers() {
                area.draw(&series.marker((x + 12, y)))?;
            }
            let text =
                TextStyle::from((FONT, 13).into_font()).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(series.name.as_str(), (x + 32, y), text))?;
        }
        Ok(())
    }

    fn drawn<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let series = || self.series.iter().filter(|series| series.mark != Mark::Guide);
        let points = || series().flat_map(|series| series.points.iter());
        let (area, below) = area.split_vertically(SIZE.1);
        self.legend(&below)?;
        let x = Divided::new(&self.x, points().map(|point| point.0));
        let y = Divided::new(&self.y, points().map(|point| point.1));
        let place = |&(a, b): &(f64, f64)| x.coordinate(a).zip(y.coordinate(b));
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, (FONT, 18))
            .margin(MARGIN)
            .x_label_area_size(46)
            .y_label_area_size(LABELS)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .label_style((FONT, 13))
            .axis_desc_style((FONT, 15))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .draw()?;
        let thin = BLACK.mix(0.5).stroke_width(1);
        // Beyond these lines is nothing but 0.
        let (across, up) = (x.span(), y.span());
        let edges = [
            x.edge_of_zero().map(|edge| [(edge, up.start), (edge, up.end)]),
            y.edge_of_zero().map(|edge| [(across.start, edge), (across.end, edge)]),
        ];
        chart.draw_series(edges.into_iter().flatten().map(|edge| PathElement::new(edge, thin)))?;
        for series in &self.series {
            let color = series.ink();
            let places: Vec<(f64, f64)> = series.points.iter().filter_map(place).collect();
            let stroke = color.stroke_width(2);
            let line = places.iter().copied();
            match series.mark {
                Mark::Markers => chart.draw_series(LineSeries::new([], stroke))?,
                Mark::Line | Mark::LineAndMarkers => {
                    chart.draw_series(LineSeries::new(line, stroke))?
                }
                Mark::Dashes => chart.draw_series(DashedLineSeries::new(line, 6, 5, stroke))?,
                Mark::Rings => chart.draw_series(line.map(|p| Circle::new(p, 8, stroke)))?,
                Mark::Guide => {
                    let soft = BLACK.mix(0.6);
                    let style = TextStyle::from((FONT, 11).into_font())
                        .color(&soft)
                        .pos(Pos::new(HPos::Right, VPos::Bottom));
                    let name = places.last().map(|&end| Text::new(series.name.clone(), end, style));
                    chart.draw_series(name)?;
                    chart.draw_series(DashedLineSeries::new(line, 3, 4, thin))?
                }
            };
            let bars = series.bars.iter().filter_map(|[a, b]| place(a).zip(place(b)));
            let bars = bars.map(|(a, b)| PathElement::new([a, b], color.stroke_width(1)));
            chart.draw_series(bars)?;
            if series.has_markers() {
                chart.draw_series(places.iter().map(|&place| series.marker(place)))?;
            }
        }
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
            ..Series::default()
        };
        let chart = Chart {
            title: "errors, ε²".to_owned(),
            x: Axis::new("Δt, s", Scale::Logarithmic),
            y: Axis::new("error, m", Scale::Logarithmic),
            series: vec![
                series("first order", 1, Some(0), Mark::LineAndMarkers),
                series("second order", 2, Some(1), Mark::Line),
                series("law", 3, None, Mark::Dashes),
                series("best", 1, Some(3), Mark::Rings),
            ],
        };
        let empty = Chart { title: "empty".to_owned(), ..Chart::default() };
        let temporary = tempfile::tempdir()?;
        let folder = Folder::open(temporary.path())?;
        Picture { charts: vec![chart, empty] }.write(&folder, "orders")?;
        let svg = std::fs::read_to_string(folder.path().join("orders.svg"))?;
        for text in ["errors, ε²", "Δt, s", "second order", "10⁻³"] {
            assert!(svg.contains(text), "{text} is missing");
        }
        let png = std::fs::read(folder.path().join("orders.png"))?;
        assert!(png.starts_with(b"\x89PNG"));
        // Letters are drawn, not only lines: the picture without a font is
        // smaller.
        assert!(png.len() > 20_000, "{} bytes", png.len());
        // Nothing else is left, now that the folder is no longer locked.
        drop(folder);
        assert_eq!(std::fs::read_dir(temporary.path())?.count(), 2);
        if let Some(path) = std::env::var_os("CAROM_KEEP_CHART") {
            std::fs::copy(temporary.path().join("orders.png"), path)?;
        }
        Ok(())
    }
}
