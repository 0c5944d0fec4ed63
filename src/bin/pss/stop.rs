//! What stops a render: signals and the time limit. The first asks it to end soon, a second signal ends the program.

use std::fs;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use pss::render::Progress;

/// Tiles under way may take so long after a stop; then they are dropped.
const GRACE: Duration = Duration::from_millis(600);

/// The render that can be stopped, if there is one now.
static UNDER_WAY: Mutex<Option<UnderWay>> = Mutex::new(None);

struct UnderWay {
    progress: Arc<Progress>,
    /// Files to remove where the program ends at once.
    litter: Vec<PathBuf>,
    /// The first signal.
    signal: Option<u8>,
}

/// A render can be stopped as long as this lives.
#[derive(Debug)]
pub struct Stoppable {
    /// Dropped with it, which ends the wait for the time limit.
    _limit: Option<Sender<()>>,
}

impl Stoppable {
    /// From now on signals stop this render; so does the end of the time that is left.
    pub fn new(progress: &Arc<Progress>, litter: Vec<PathBuf>, time: Option<Duration>) -> Stoppable {
        *under_way() = Some(UnderWay { progress: Arc::clone(progress), litter, signal: None });
        signals::listen();
        if time.is_some_and(|time| time.is_zero()) {
            progress.give_up();
        }
        let limit = time.map(|time| {
            let (ended, wait) = channel::<()>();
            let progress = Arc::clone(progress);
            std::thread::spawn(move || {
                if wait.recv_timeout(time) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
                    stop(&progress);
                }
            });
            ended
        });
        Stoppable { _limit: limit }
    }

    /// The signal that stopped it, if one did.
    pub fn signal(&self) -> Option<u8> {
        under_way().as_ref().and_then(|u| u.signal)
    }
}

impl Drop for Stoppable {
    fn drop(&mut self) {
        *under_way() = None;
    }
}

fn under_way() -> MutexGuard<'static, Option<UnderWay>> {
    UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on writing to a file that may not grow fails, as it does on a full disk, and does not end the program.
pub fn let_writes_fail() {
    signals::heed_limits();
}

/// Lets tiles under way end for a while.
fn stop(progress: &Arc<Progress>) {
    progress.stop();
    let progress = Arc::clone(progress);
    std::thread::spawn(move || {
        std::thread::sleep(GRACE);
        progress.give_up();
    });
}

/// What a signal does.
#[cfg_attr(not(unix), allow(dead_code))]
fn signalled(number: u8) {
    let mut under_way = under_way();
    match under_way.as_mut() {
        Some(u) if u.signal.is_none() => {
            u.signal = Some(number);
            stop(&u.progress);
        }
        other => {
            // What is not removed is only litter.
            other.into_iter().flat_map(|u| &u.litter).for_each(|file| drop(fs::remove_file(file)));
            std::process::exit(128 + i32::from(number));
        }
    }
}

#[cfg(unix)]
mod signals {
    use std::sync::atomic::AtomicBool;
    use std::sync::{Arc, Once};

    use signal_hook::consts::{SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    static LISTENING: Once = Once::new();
    static LIMITS: Once = Once::new();

    /// Turns the signal of a file that grows too large into an error of the write.
    pub fn heed_limits() {
        LIMITS.call_once(|| {
            // Where that is not possible, such a file ends the program, and the old one stays all the same.
            let _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
        });
    }

    /// Handles signals from now on, on a thread of its own.
    pub fn listen() {
        LISTENING.call_once(|| {
            // Where signals cannot be handled, they end the program, which harms no file.
            let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else { return };
            std::thread::spawn(move || {
                for number in signals.forever() {
                    super::signalled(u8::try_from(number).unwrap_or_default());
                }
            });
        });
    }
}

#[cfg(not(unix))]
mod signals {
    pub fn listen() {}
    pub fn heed_limits() {}
}
