//! What a piece of work costs: processor seconds of this thread.

use std::time::Instant;

/// Seconds that this thread has run; where the system does not tell, seconds on the wall since `start`.
fn thread_seconds(start: Instant) -> f64 {
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat");
    let first = |text: String| text.split_whitespace().next().and_then(|n| n.parse::<f64>().ok());
    nanoseconds.ok().and_then(first).map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// Median of the seconds that `work` needs, of `rounds`; once before to warm up.
pub fn median_seconds(rounds: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    work();
    median((0..rounds).map(|_| {
        let before = thread_seconds(start);
        work();
        thread_seconds(start) - before
    }))
}

/// The middle of some numbers.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
