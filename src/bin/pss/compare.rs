//! `pss compare`: how far two pictures are apart.

use std::io;
use std::path::Path;

use pss::compare::{Apart, Difference, METRICS, Metric, Picture, difference, heat, layers};
use pss::diag::{Diagnostic, Fault};
use pss::output::{self, Format, write_rgb, write_whole};

use crate::args::CompareArgs;
use crate::console::{self, Console, Failure};

/// Prints what a metric, or each, says; 1 where it is more than is allowed.
pub fn run(args: &CompareArgs, console: &Console) -> Result<u8, Failure> {
    let inputs = [args.a.clone(), args.b.clone()];
    if let Some(path) = &args.diff {
        if Format::of(path) != Some(Format::Png) {
            let error = Diagnostic::error("E0001", format!("`{}` does not end in .png", path.display()));
            return Err(Failure::from(error.fault(Fault::Usage)));
        }
        output::check(path, &inputs)?;
    }
    let [a, b] = [read(&args.a)?, read(&args.b)?];
    let chosen = args.metric.map(|metric| metric.0);
    let metrics = METRICS.iter().filter(|(_, metric)| chosen.is_none_or(|chosen| chosen == *metric));
    let mut found = Vec::new();
    for (word, metric) in metrics {
        let Some(difference) = difference(&a, &b, *metric) else { return Err(sizes(args, &a, &b)) };
        found.push((*word, difference));
    }
    // They are numbers that no eye sees.
    let layers = if found[0].0 == METRICS[0].0 { layers(&a, &b) } else { Vec::new() };
    let mut text: String = found.iter().map(|(word, d)| line(word, d, a.size, chosen.is_none())).collect();
    layers.iter().for_each(|layer| text += &(layer_told(layer, args, a.size) + "\n"));
    console::print(text.as_bytes())?;
    if let Some(path) = &args.diff {
        // Where colour has nothing to show, the first layer that has.
        let color = &found[0].1;
        let shown = layers.iter().filter_map(measured).find(|d| color.value == 0.0 && 0.0 < d.value);
        write_map(path, a.size, shown.unwrap_or(color))?;
    }
    let wrong = wrong(args, &found[0], &layers, a.size);
    if wrong.is_empty() {
        return Ok(0);
    }
    let told = format!("the pictures differ: {}", wrong.join("; "));
    let error = Diagnostic::error("E0803", told).fault(Fault::Unmet);
    let error = match args.diff {
        Some(_) => error,
        None => error.help("`--diff FILE.png` shows where"),
    };
    Ok(console.fail(&Failure::from(error)))
}

/// What is beyond that which passes, in words.
fn wrong(
    args: &CompareArgs,
    (word, color): &(&str, Difference),
    layers: &[(String, Apart)],
    size: [u32; 2],
) -> Vec<String> {
    let most = args.max.unwrap_or(0.0);
    let color = (most < color.value).then(|| format!("{word} {} is more than {most}", color.value));
    let apart = layers.iter().filter(|layer| measured(layer).is_none_or(|d| most < d.value));
    color.into_iter().chain(apart.map(|layer| layer_told(layer, args, size))).collect()
}

/// The difference of a layer that both have.
fn measured((_, apart): &(String, Apart)) -> Option<&Difference> {
    match apart {
        Apart::Rmse(difference) | Apart::Pixels(difference) => Some(difference),
        Apart::First | Apart::Second | Apart::Channels => None,
    }
}

/// What there is to say of a layer.
fn layer_told((name, apart): &(String, Apart), args: &CompareArgs, size: [u32; 2]) -> String {
    let place = |d: &Difference| d.worst(size).map(|[x, y]| format!("{x},{y}"));
    match apart {
        Apart::First => format!("{name} is in `{}` alone", args.a.display()),
        Apart::Second => format!("{name} is in `{}` alone", args.b.display()),
        Apart::Channels => format!("{name} has other channels"),
        Apart::Rmse(d) => {
            place(d).map_or(format!("{name} 0"), |at| format!("{name} {}  most at {at}", d.value))
        }
        Apart::Pixels(d) => {
            place(d).map_or(format!("{name} 0"), |at| format!("{name} {} pixels  first at {at}", d.value))
        }
    }
}

fn read(path: &Path) -> Result<Picture, Failure> {
    Picture::read(path).map_err(|e| {
        let (code, fault, told) = match e.kind() {
            io::ErrorKind::NotFound => ("E0601", Fault::Missing, format!("there is no `{}`", path.display())),
            io::ErrorKind::InvalidInput => ("E0605", Fault::Usage, format!("`{}`: {e}", path.display())),
            io::ErrorKind::InvalidData | io::ErrorKind::Other | io::ErrorKind::UnexpectedEof => {
                ("E0605", Fault::Input, format!("`{}` is no picture that can be read: {e}", path.display()))
            }
            _ => ("E0601", Fault::Missing, format!("cannot read `{}`: {e}", path.display())),
        };
        Failure::from(Diagnostic::error(code, told).fault(fault).help("name a .png or an .exr"))
    })
}

fn sizes(args: &CompareArgs, a: &Picture, b: &Picture) -> Failure {
    let size = |path: &Path, [w, h]: [u32; 2]| format!("`{}` has {w} x {h}", path.display());
    let told =
        format!("the pictures have different sizes: {}, {}", size(&args.a, a.size), size(&args.b, b.size));
    Failure::from(Diagnostic::error("E0804", told).fault(Fault::Unmet).help("render both at one `--size`"))
}

/// A metric's value; with its name and the worst pixel where several are printed.
fn line(word: &str, difference: &Difference, size: [u32; 2], named: bool) -> String {
    match (named, difference.worst(size)) {
        (false, _) => format!("{}\n", difference.value),
        (true, None) => format!("{word:5} 0\n"),
        (true, Some([x, y])) => format!("{word:5} {}  most at {x},{y}\n", difference.value),
    }
}

/// The differences as colours: black for none, light for the largest, or for 1 where that is the most there can be.
fn write_map(path: &Path, size: [u32; 2], difference: &Difference) -> Result<(), Failure> {
    let largest = difference.map.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    let scale = if largest == 0.0 { 0.0 } else { 1.0 / largest };
    let pixel = |d: &f64| heat(if d.is_finite() { d * scale } else { 1.0 });
    let bytes: Vec<u8> = difference.map.iter().flat_map(pixel).collect();
    write_whole(path, |sink| write_rgb(size, &bytes, sink))?;
    Ok(())
}

/// The word of a metric on the command line.
pub fn metric(word: &str) -> Result<MetricWord, String> {
    let words = || METRICS.map(|(word, _)| word).join(", ");
    let found = METRICS.iter().find(|(known, _)| *known == word);
    found.map(|(_, metric)| MetricWord(*metric)).ok_or_else(|| format!("the metrics are {}", words()))
}

/// A metric of the command line.
#[derive(Clone, Copy, Debug)]
pub struct MetricWord(pub Metric);
