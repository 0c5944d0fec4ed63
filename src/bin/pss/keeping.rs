//! When tiles are kept for a later run: from the third second of a render on, within a second of being painted, and whenever
//! a render ends before its time. Where tiles are painted nearly as fast as they are written, it begins later.
//!
//! A render that is done sooner pays for nothing. Others pay some 20 microseconds a tile, no more than a fiftieth of what the
//! tile itself takes, and once for the hash of the program: 0.3 % of 16 seconds were seen.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use pss::diag::Diagnostic;
use pss::film::Film;
use pss::output::state::{Claim, Layout, Place, State};
use pss::render::{Moment, Slab, Tile, Work};
use pss::shot::Settings;
use pss::source::SourceMap;

use crate::args::RenderArgs;
use crate::console::{Console, Failure};
use crate::identity::Identities;

/// A render that takes no longer is quicker made again than kept.
const BEGIN_AFTER: Duration = Duration::from_secs(3);
/// One whose tiles are too cheap to be kept is made again up to here; no kill loses more.
const BEGIN_ALL_AFTER: Duration = Duration::from_secs(30);
/// Fifty times what keeping a tile takes.
const WORTH_KEEPING: Duration = Duration::from_millis(1);
/// Tiles wait so long to be kept: what a kill costs beside the tiles under way.
const KEEP_EVERY: Duration = Duration::from_secs(1);
/// As many do not wait: they are 4 MiB of colours.
const KEEP_TILES: usize = 256;

/// Keeps tiles beside the first file of a render.
#[derive(Debug)]
pub struct Keeping {
    claim: Claim,
    state: Option<State>,
    identities: Arc<Identities>,
    layout: Layout,
    start: Instant,
    last: Instant,
    /// Tiles painted so far.
    painted: u32,
    /// Whether an earlier run was stopped before the picture was whole.
    follows_a_stop: bool,
    /// Why nothing is kept.
    trouble: Option<String>,
}

impl Keeping {
    /// Claims an output, and finds what an earlier run kept where it shall go on.
    pub fn new(
        args: &RenderArgs,
        output: &Path,
        settings: &Settings,
        identities: &Arc<Identities>,
        console: &Console,
    ) -> Result<Keeping, Failure> {
        let layout = Layout { window: settings.window(), aovs: settings.aov.clone() };
        let mut claim = Claim::new(output)?;
        let follows_a_stop = claim.has_state();
        let (mut state, mut told) = (None, None);
        if args.resume && claim.has_state() {
            match claim.resume(&identities.whole(), layout.clone())? {
                Some((found, tiles)) => {
                    if 0 < tiles.dropped {
                        told = Some(damaged(tiles.dropped));
                    }
                    if !args.quiet {
                        console.note(&format!("{} tiles are kept from an earlier run", tiles.tiles));
                    }
                    state = Some(found);
                }
                None => {
                    told = Some(warning("what was kept of an earlier run cannot be read; it begins anew"))
                }
            }
        } else if claim.has_state() {
            let given_up = warning("what was kept of an earlier run is given up");
            told = Some(given_up.help("with `--resume` a render goes on where it was stopped"));
        } else if args.resume && !args.quiet {
            console.note("nothing is kept of an earlier run: the render begins anew");
        }
        if !args.quiet {
            console.show(told.as_slice(), &SourceMap::default());
        }
        let (identities, now) = (Arc::clone(identities), Instant::now());
        let (start, last, painted, trouble) = (now, now, 0, None);
        Ok(Keeping { claim, state, identities, layout, start, last, painted, follows_a_stop, trouble })
    }

    /// A tile of an earlier run.
    pub fn recall(&mut self, tile: &Tile) -> Option<(Film, Work)> {
        let (film, note) = self.state.as_mut()?.tile(place(tile))?;
        // What the work was is told; the picture does not depend on it.
        Some((film, serde_json::from_str(&note).unwrap_or_default()))
    }

    /// Keeps what was painted, if it is time.
    pub fn painted(&mut self, slab: &mut Slab, moment: Moment) {
        self.painted = self.painted.saturating_add(u32::from(moment == Moment::Tile));
        if self.state.is_none() {
            if moment != Moment::Broken && !self.is_worth_keeping() {
                return;
            }
            self.begin();
        }
        let now = Instant::now();
        let waits = moment == Moment::Tile && slab.fresh.len() < KEEP_TILES;
        let Some(state) = self.state.as_mut().filter(|_| !waits || self.last + KEEP_EVERY <= now) else {
            return;
        };
        self.last = now;
        let tiles = slab.fresh.drain(..).map(|(tile, work)| {
            let note = serde_json::to_string(&work).unwrap_or_default();
            (place(&tile), note, [tile.x - slab.at[0], tile.y - slab.at[1]])
        });
        state.add(&slab.film, tiles);
    }

    fn is_worth_keeping(&self) -> bool {
        let elapsed = self.start.elapsed();
        let a_tile = elapsed * rayon::current_num_threads() as u32 / self.painted.max(1);
        BEGIN_ALL_AFTER <= elapsed || BEGIN_AFTER <= elapsed && WORTH_KEEPING <= a_tile
    }

    fn begin(&mut self) {
        if self.trouble.is_some() {
            return;
        }
        match self.claim.begin(&self.identities.whole(), self.layout.clone()) {
            Ok(state) => self.state = Some(state),
            Err(e) => self.trouble = Some(e.to_string()),
        }
    }

    /// What went wrong with keeping, if something did.
    pub fn trouble(&self) -> Option<Diagnostic> {
        let failed = self.state.as_ref().and_then(|state| state.failure().map(ToString::to_string));
        let why = self.trouble.clone().or(failed)?;
        Some(warning("not all that was painted could be kept for `--resume`").note(why))
    }

    /// Whether an earlier run was stopped, and left what there was.
    pub fn follows_a_stop(&self) -> bool {
        self.follows_a_stop
    }

    /// Whether a later run can go on.
    pub fn is_kept(&self) -> bool {
        self.state.is_some()
    }

    /// The picture is made.
    pub fn end(self) {
        drop(self.state);
        self.claim.remove();
    }
}

fn damaged(tiles: u64) -> Diagnostic {
    let message = format!("{tiles} tiles of an earlier run are damaged, or come after one that is");
    warning(&message).help("they are painted again")
}

fn warning(message: &str) -> Diagnostic {
    Diagnostic::warning("W0204", message)
}

fn place(tile: &Tile) -> Place {
    [tile.x, tile.y, tile.size[0], tile.size[1]]
}
