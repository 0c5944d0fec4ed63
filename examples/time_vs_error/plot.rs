//! One plot: each row a mark, error against warm time, both logarithmic.

use std::path::Path;

use plotters::prelude::*;

use crate::{Row, png};

const METHODS: [(&str, RGBColor); 8] = [
    ("this, patches", RGBColor(200, 30, 40)),
    ("this, guides", RGBColor(240, 140, 30)),
    ("this, F alone", RGBColor(170, 110, 60)),
    ("paper's iteration", RGBColor(40, 90, 200)),
    ("marching, bisection", RGBColor(120, 60, 170)),
    ("means of 2003", RGBColor(20, 140, 120)),
    ("cylinder average", RGBColor(110, 110, 110)),
    ("triangles", RGBColor(30, 30, 30)),
];

/// Writes `path` with `.svg` and `.png`: rows of one noise, larger marks for more samples.
pub fn write(rows: &[Row], noise: f64, path: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut svg = String::new();
    draw(rows, noise, &mut svg)?;
    std::fs::write(format!("{path}.svg"), &svg)?;
    png::write(&svg, Path::new(&format!("{path}.png")))
}

fn draw(rows: &[Row], noise: f64, svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, (1000, 640)).into_drawing_area();
    area.fill(&WHITE)?;
    let kind = if noise == 0.0 { "exact samples" } else { "noise of 0.1 % of the diagonal" };
    let mut chart = ChartBuilder::on(&area)
        .caption(format!("Blob, {kind}: 10,000, 40,000 and 160,000 samples"), ("sans-serif", 22))
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(78)
        .build_cartesian_2d((0.1f64..2000.0).log_scale(), (1e-10f64..1e-2).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("microseconds a ray, warm, one thread")
        .y_desc("rms distance from the blob, over its diagonal")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    for (method, color) in METHODS {
        let marks = rows.iter().filter(|r| r.method == method && r.noise == noise).map(|r| {
            let size = 3 + (r.points as f64 / 10_000.0).log2() as i32;
            Circle::new((1e6 * r.warm, r.rms), size, color.mix(0.75).filled())
        });
        chart
            .draw_series(marks)?
            .label(method)
            .legend(move |(x, y)| Circle::new((x + 8, y), 6, color.filled()));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(("sans-serif", 16))
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK)
        .draw()?;
    area.present()?;
    Ok(())
}
