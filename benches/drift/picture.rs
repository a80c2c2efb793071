//! The error of the energy against the number of collisions, drawn.

use std::error::Error;
use std::path::Path;

use carom::contact::Surface;
use plotters::prelude::*;

use crate::Case;

/// Of the picture, pixels.
const SIZE: (u32, u32) = (880, 440);

/// A panel for each diameter, all in units of the precision's ε, with two laws
/// to compare.
pub fn draw(path: &Path, points: &[u64], cases: &[Case]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Ok(()) };
    let (first, last) = (first as f64, last as f64);
    let errors = || cases.iter().flat_map(|case| case.statistics.errors.iter().copied());
    let range = errors().fold(f64::MAX, f64::min) / 2.0..errors().fold(0.0, f64::max) * 2.0;
    let start =
        cases.iter().map(|case| case.statistics.errors[0]).sum::<f64>() / cases.len() as f64;

    let mut diameters: Vec<f64> = cases.iter().map(|case| case.diameter).collect();
    diameters.dedup();
    for (panel, diameter) in root.split_evenly((1, diameters.len())).iter().zip(diameters) {
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("diameter {diameter}"), ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(62)
            .build_cartesian_2d((first..last).log_scale(), range.clone().log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .x_desc("collisions")
            .y_desc("error of the energy, ε")
            .x_label_formatter(&|x| format!("{x:.0e}"))
            .y_label_formatter(&|y| format!("{y}"))
            .draw()?;
        for (name, power) in [("√n", 0.5), ("n", 1.0)] {
            let law = |n: f64| (n, start * (n / first).powf(power));
            // Up to where it leaves the panel.
            let end = last.min(first * (range.end / start).powf(1.0 / power));
            let style = BLACK.mix(if power < 1.0 { 0.8 } else { 0.3 });
            chart
                .draw_series(DashedLineSeries::new([law(first), law(end)], 4, 4, style.into()))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        }
        for case in cases.iter().filter(|case| case.diameter == diameter) {
            let color = match (case.precision, case.surface) {
                ("f32", Surface::Smooth) => RGBColor(230, 159, 0),
                ("f32", Surface::Rough) => RGBColor(213, 94, 0),
                (_, Surface::Smooth) => RGBColor(86, 180, 233),
                (_, Surface::Rough) => RGBColor(0, 114, 178),
            };
            let line = points.iter().map(|&n| n as f64).zip(case.statistics.errors.iter().copied());
            let style = color.stroke_width(2);
            chart
                .draw_series(LineSeries::new(line, style))?
                .label(format!("{} {}", case.precision, case.surface()))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .draw()?;
    }
    root.present()?;
    Ok(())
}
