//! What a piece of work costs: processor seconds of this thread, and of a command.

use std::process::Command;
use std::time::Instant;

/// Seconds that this thread has run; where the system does not tell, seconds on the wall since `start`.
fn thread_seconds(start: Instant) -> f64 {
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat");
    let first = |text: String| text.split_whitespace().next().and_then(|n| n.parse::<f64>().ok());
    nanoseconds.ok().and_then(first).map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// The system counts a thread's time in steps of some milliseconds: a round lasts for many of them.
const ROUND: f64 = 0.15;

/// Median of the seconds that `work` needs, of `rounds`; once before to warm up and to see how often it goes into a round.
pub fn median_seconds(rounds: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    let times = (ROUND / start.elapsed().as_secs_f64()).ceil().clamp(1.0, 1e6) as usize;
    median((0..rounds).map(|_| {
        let before = thread_seconds(start);
        (0..times).for_each(|_| work());
        (thread_seconds(start) - before) / times as f64
    }))
}

/// The middle of some numbers.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The system counts a command's time in hundredths of a second: one round lasts for this long.
const TOGETHER: f64 = 0.5;

/// How often to run a command in one round, by what it costs once; `None` where it fails or is not there.
pub fn runs_a_round(command: &str) -> Option<usize> {
    command_seconds(command, 1).map(|once| (TOGETHER / once.max(0.01)).ceil() as usize)
}

/// Processor seconds, user and system, of a command run by a shell so many times, for one; `None` where it fails.
pub fn command_seconds(command: &str, times: usize) -> Option<f64> {
    let once = format!("{command} >/dev/null 2>&1 || exit 1; ");
    let script = once.repeat(times) + "times";
    let output = Command::new("sh").args(["-c", &script]).output().ok()?;
    if !output.status.success() {
        return None;
    }
    // Two lines, the shell's own times and its children's: `0m0.012s 0m0.004s`.
    let text = String::from_utf8(output.stdout).ok()?;
    let seconds = |word: &str| {
        let (minutes, seconds) = word.trim_end_matches('s').split_once('m')?;
        Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    };
    let sum: Option<f64> = text.lines().nth(1)?.split_whitespace().map(seconds).sum();
    sum.map(|sum| sum / times as f64)
}
