//! One plot for each scene, in two rows: error against time, both logarithmic.

use std::path::Path;

use plotters::prelude::*;

use crate::Row;
use crate::scenes::SCENES;

#[path = "../../examples/time_vs_error/png.rs"]
mod png;

/// Writes `path` with `.svg` and `.png`.
pub fn write(rows: &[Row], path: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut svg = String::new();
    draw(rows, &mut svg)?;
    std::fs::write(format!("{path}.svg"), &svg)?;
    png::write(&svg, Path::new(&format!("{path}.png")))
}

fn draw(rows: &[Row], svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, (1320, 880)).into_drawing_area();
    area.fill(&WHITE)?;
    for (part, (scene, _)) in area.split_evenly((2, 3)).iter().zip(SCENES) {
        let rows: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
        let over = |of: fn(&Row) -> f64| {
            let (lo, hi) =
                rows.iter().fold((f64::INFINITY, 0.0_f64), |(lo, hi), r| (lo.min(of(r)), hi.max(of(r))));
            (0.8 * lo..1.25 * hi).log_scale()
        };
        let mut chart = ChartBuilder::on(part)
            .caption(scene, ("sans-serif", 20))
            .margin(10)
            .x_label_area_size(42)
            .y_label_area_size(70)
            .build_cartesian_2d(over(|r| r.seconds), over(|r| r.rmse))?;
        chart
            .configure_mesh()
            .x_desc("seconds, one thread")
            .y_desc("rmse of what a display shows, 0 to 1")
            .max_light_lines(0)
            .x_label_formatter(&|x| format!("{:.1}", x))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .label_style(("sans-serif", 13))
            .draw()?;
        for (adaptive, name, color) in
            [(false, "even", RGBColor(60, 60, 60)), (true, "to an error", RGBColor(200, 30, 40))]
        {
            let points = || rows.iter().filter(move |r| r.adaptive == adaptive).map(|r| (r.seconds, r.rmse));
            chart.draw_series(LineSeries::new(points(), color.stroke_width(2)))?;
            chart
                .draw_series(points().map(|p| Circle::new(p, 4, color.filled())))?
                .label(name)
                .legend(move |(x, y)| Circle::new((x + 8, y), 5, color.filled()));
        }
        chart.configure_series_labels().background_style(WHITE.mix(0.85)).border_style(BLACK).draw()?;
    }
    area.present()?;
    Ok(())
}
