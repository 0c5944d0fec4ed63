//! Time and memory of each series against its size, both logarithmic.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::{Cost, Series};

#[path = "../../examples/time_vs_error/png.rs"]
mod png;

/// What is drawn of a cost.
type Line = (&'static str, RGBColor, fn(&Cost) -> f64);

const LINES: [Line; 3] = [
    ("seconds on the wall, all in all", RGBColor(200, 30, 40), |c| c.wall),
    ("of these before the first ray", RGBColor(40, 90, 200), |c| c.stages[0].max(LEAST)),
    ("peak memory, MB", RGBColor(20, 140, 120), |c| c.peak),
];
const STRAIGHT: (&str, RGBColor) = ("in proportion to the size", RGBColor(160, 160, 160));

/// Nothing below is drawn.
const LEAST: f64 = 1e-3;

/// Writes `path` with `.svg` and `.png`.
pub fn write(all: &[(Series, Vec<Cost>)], path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (1200, 720)).into_drawing_area();
        area.fill(&WHITE)?;
        let parts = area.split_evenly((2, 3));
        for ((series, costs), part) in all.iter().zip(&parts) {
            draw(series, costs, part)?;
        }
        if let Some(rest) = parts.get(all.len()) {
            explain(rest)?;
        }
        area.present()?;
    }
    std::fs::write(path.with_extension("svg"), &svg)?;
    png::write(&svg, &path.with_extension("png"))
}

fn draw(
    series: &Series,
    costs: &[Cost],
    area: &DrawingArea<SVGBackend<'_>, Shift>,
) -> Result<(), Box<dyn std::error::Error>> {
    let sizes = costs.iter().map(|c| c.size as f64);
    let (least, most) = sizes.fold((f64::INFINITY, 0.0f64), |(a, b), s| (a.min(s), b.max(s)));
    let mut chart = ChartBuilder::on(area)
        .caption(series.name, ("sans-serif", 18))
        .margin(8)
        .x_label_area_size(34)
        .y_label_area_size(48)
        .build_cartesian_2d((0.8 * least..1.25 * most).log_scale(), (LEAST..1e4).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(series.of)
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .draw()?;
    let first = costs.first().map_or(LEAST, |c| c.wall);
    let straight = [least, most].map(|size| (size, first * size / least));
    chart.draw_series(LineSeries::new(straight, STRAIGHT.1.stroke_width(1)))?;
    for (_, color, of) in LINES {
        let places: Vec<(f64, f64)> = costs.iter().map(|c| (c.size as f64, of(c))).collect();
        chart.draw_series(places.iter().map(|place| Circle::new(*place, 3, color.filled())))?;
        chart.draw_series(LineSeries::new(places, color.stroke_width(2)))?;
    }
    Ok(())
}

/// Says what the lines are.
fn explain(area: &DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), Box<dyn std::error::Error>> {
    let words = LINES.map(|(word, color, _)| (word, color)).into_iter().chain([STRAIGHT]);
    for ((word, color), y) in words.zip((60..).step_by(30)) {
        area.draw(&Circle::new((40, y), 5, color.filled()))?;
        area.draw(&Text::new(word, (56, y - 8), ("sans-serif", 16)))?;
    }
    Ok(())
}
