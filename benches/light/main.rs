//! Time against error of adaptive and of even sampling, on five scenes, with a plot.
//!
//!     cargo bench --bench light [-- OUT] [--plot]
//!
//! With `--plot` the plot is drawn anew from the table that is there. Each scene is rendered once with very many samples, under another seed: the truth. Then with so and so many samples for
//! every pixel, and with so and so small an error asked, on one thread, in turns; what is timed is the processor, so that other work on the machine does not
//! count. The error of a picture is the root of the mean
//! squared difference from the truth of what a display shows, sRGB from 0 to 1, of its linear colours cut at one.

mod plot;
mod scenes;

use std::fs;

use cpu_time::ProcessTime;
use pss::film::Film;
use pss::num::srgb;
use pss::shot::Shot;
use scenes::SCENES;

/// One picture.
pub struct Row {
    /// Of which scene.
    pub scene: &'static str,
    /// Whether samples were taken to an error.
    pub adaptive: bool,
    /// Samples a pixel, or the error asked.
    pub asked: f64,
    /// Of a processor, one thread: other work on the machine does not count. The median.
    pub seconds: f64,
    /// The mean number a pixel.
    pub samples: f64,
    /// From the truth.
    pub rmse: f64,
}

/// Samples a pixel of the truth.
const TRUTH: u32 = 4096;

/// How often each picture is timed; the median counts.
const TIMES: usize = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let only_plot = std::env::args().any(|arg| arg == "--plot");
    let out = std::env::args().skip(1).find(|a| !a.starts_with('-')).unwrap_or("benches/light".to_owned());
    if only_plot {
        return plot::write(
            &read(&fs::read_to_string(format!("{out}/table.md"))?),
            &format!("{out}/adaptive"),
        );
    }
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let mut rows = Vec::new();
    for (name, text) in SCENES {
        let mut shot = scenes::shot(text);
        shot.settings.aov = vec![pss::film::Aov::Samples];
        let truth = truth(&mut shot);
        shot.settings.seed = 0;
        for samples in [16, 32, 64, 128, 256, 512, 1024] {
            (shot.settings.samples, shot.settings.error) = (samples, None);
            rows.push(row(name, false, f64::from(samples), &shot, &truth));
        }
        for error in [0.04, 0.02, 0.01, 0.007, 0.005, 0.003] {
            (shot.settings.samples, shot.settings.error) = (4096, Some(error));
            rows.push(row(name, true, error, &shot, &truth));
        }
    }
    fs::write(format!("{out}/table.md"), table(&rows))?;
    plot::write(&rows, &format!("{out}/adaptive"))
}

fn truth(shot: &mut Shot) -> Vec<f64> {
    (shot.settings.samples, shot.settings.error, shot.settings.seed) = (TRUTH, None, 1);
    shown(&film(shot))
}

fn film(shot: &Shot) -> Film {
    pss::render::render(shot, &Default::default()).expect("a picture").film
}

/// What a display shows.
fn shown(film: &Film) -> Vec<f64> {
    film.rgba
        .iter()
        .flat_map(|p| [p[0], p[1], p[2]])
        .map(|c| srgb::encode(f64::from(c).clamp(0.0, 1.0)))
        .collect()
}

fn row(scene: &'static str, adaptive: bool, asked: f64, shot: &Shot, truth: &[f64]) -> Row {
    let mut seconds = Vec::new();
    let mut made = None;
    for _ in 0..TIMES {
        let start = ProcessTime::now();
        made = Some(film(shot));
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_by(f64::total_cmp);
    let made = made.expect("a picture");
    let counts = &made.layers[0].data;
    let samples = counts.iter().map(|n| f64::from(*n)).sum::<f64>() / counts.len() as f64;
    let squares: f64 = shown(&made).iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum();
    let row = Row {
        scene,
        adaptive,
        asked,
        seconds: seconds[TIMES / 2],
        samples,
        rmse: (squares / truth.len() as f64).sqrt(),
    };
    eprintln!(
        "{scene} {adaptive} {asked}: {:.2} s, {:.1} samples, {:.5}",
        row.seconds, row.samples, row.rmse
    );
    row
}

/// The time that even sampling takes to an error, by a straight line between its pictures, both logarithmic.
fn even_time(rows: &[Row], scene: &str, rmse: f64) -> Option<f64> {
    let even: Vec<&Row> = rows.iter().filter(|r| r.scene == scene && !r.adaptive).collect();
    let pair = even.windows(2).find(|pair| pair[1].rmse <= rmse && rmse <= pair[0].rmse)?;
    let share = (rmse / pair[0].rmse).ln() / (pair[1].rmse / pair[0].rmse).ln();
    Some((pair[0].seconds.ln() + share * (pair[1].seconds / pair[0].seconds).ln()).exp())
}

/// The rows of a table.
fn read(table: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let number = |i: usize| cells.get(i)?.parse::<f64>().ok();
        let (scene, _) = SCENES.into_iter().find(|(name, _)| cells.get(1) == Some(name))?;
        Some(Row {
            scene,
            adaptive: cells[2] == "error",
            asked: number(3)?,
            seconds: number(4)?,
            samples: number(5)?,
            rmse: number(6)?,
        })
    };
    table.lines().filter_map(row).collect()
}

fn table(rows: &[Row]) -> String {
    let mut out = String::from(
        "# Adaptive and even sampling, time against error\n\nWritten by `cargo bench --bench light`; seconds of a processor, one thread. The last column is \
         the time of even sampling to the same error over that of adaptive sampling.\n\n| scene | sampling | asked | seconds | samples a pixel | rmse, of a display's 0 to 1 | even / adaptive |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for r in rows {
        let kind = if r.adaptive { "error" } else { "even" };
        let ratio = even_time(rows, r.scene, r.rmse).filter(|_| r.adaptive);
        let ratio = ratio.map_or(String::new(), |t| format!("{:.2}", t / r.seconds));
        out += &format!(
            "| {} | {kind} | {} | {:.3} | {:.1} | {:.5} | {ratio} |\n",
            r.scene, r.asked, r.seconds, r.samples, r.rmse
        );
    }
    out
}
