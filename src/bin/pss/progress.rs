//! Progress on standard error, drawn by a thread that only reads a counter.

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::args::ProgressMode;

/// How often a bar moves: smooth, yet free of cost.
const BAR_EVERY: Duration = Duration::from_millis(100);
/// How often a line of JSON appears.
const JSON_EVERY: Duration = Duration::from_secs(1);
/// How often a plain line appears: logs shall stay short.
const PLAIN_EVERY: Duration = Duration::from_secs(5);

/// Does the work while showing how much of `total` is `done`.
pub fn show<R: Send>(
    mode: ProgressMode,
    total: u64,
    done: &(dyn Fn() -> u64 + Sync),
    work: impl FnOnce() -> R,
) -> R {
    let (every, bar) = match mode {
        ProgressMode::Auto if io::stderr().is_terminal() => (BAR_EVERY, Some(bar(total))),
        ProgressMode::Auto | ProgressMode::None => return work(),
        ProgressMode::Plain => (PLAIN_EVERY, None),
        ProgressMode::Json => (JSON_EVERY, None),
    };
    let (finished, wait) = channel::<()>();
    std::thread::scope(|scope| {
        let bar = bar.as_ref();
        scope.spawn(move || {
            let start = Instant::now();
            while wait.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                match (bar, mode) {
                    (Some(bar), _) => bar.set_position(done()),
                    (None, ProgressMode::Json) => line(&json(done(), total, start.elapsed())),
                    (None, _) => line(&plain(done(), total, start.elapsed())),
                }
            }
            match bar {
                Some(bar) => bar.finish_and_clear(),
                None if mode == ProgressMode::Json => line(&json(done(), total, start.elapsed())),
                None => line(&plain(done(), total, start.elapsed())),
            }
        });
        // Dropped when the work ends, even by a panic: the thread then stops waiting.
        let _finished: Sender<()> = finished;
        work()
    })
}

fn bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_bar} {percent:>3} %  {rate} pixels/s, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", |state: &ProgressState, out: &mut dyn fmt::Write| {
            // A rate that cannot be drawn is left out.
            let _ = write!(out, "{:.0}", state.per_sec());
        });
    ProgressBar::new(total).with_style(style)
}

/// Seconds left at the mean rate so far; `None` before anything is done.
fn left(done: u64, total: u64, elapsed: Duration) -> Option<f64> {
    (0 < done).then(|| elapsed.as_secs_f64() * (total.saturating_sub(done) as f64 / done as f64))
}

fn plain(done: u64, total: u64, elapsed: Duration) -> String {
    let percent = 100.0 * done as f64 / total.max(1) as f64;
    let rate = done as f64 / elapsed.as_secs_f64().max(f64::MIN_POSITIVE);
    let left = left(done, total, elapsed).map_or_else(String::new, |s| format!(", {s:.0} s left"));
    format!("{percent:.0} % of {total} pixels, {rate:.0} pixels/s{left}")
}

fn json(done: u64, total: u64, elapsed: Duration) -> String {
    let elapsed_s = elapsed.as_secs_f64();
    let left_s = left(done, total, elapsed);
    serde_json::json!({ "done": done, "total": total, "elapsed_s": elapsed_s, "left_s": left_s }).to_string()
}

fn line(text: &str) {
    // Whoever closed standard error does not want to hear of it.
    let _ = writeln!(io::stderr(), "{text}");
}
