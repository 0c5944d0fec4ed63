//! A picture on its way to its files: they grow row by row, and get their names when all is well.

use std::io::{self, BufWriter, Read, Seek, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pss::film::Film;
use pss::output::{Encode, Growing, Old, OutputError, Picture, PngRows, partial, remove_partial};
use pss::render::{Moment, Onlooker, Slab, Tile, Work};
use tempfile::SpooledTempFile;

use crate::console::{self, Failure};
use crate::keeping::Keeping;
use crate::live::Live;

/// A picture for standard output waits in memory up to this size, bytes, and then on the disk.
const SPOOL_BYTES: usize = 64 << 20;

/// All outputs of a render.
pub struct Making {
    files: Vec<Growing>,
    stdout: Option<(Box<dyn Encode>, Spool)>,
    /// What is kept for a later run, if anything is.
    pub keeping: Option<Keeping>,
    /// Who is shown it while it is made.
    pub live: Live,
    /// Why an output failed.
    pub failure: Option<OutputError>,
}

impl Making {
    /// Begins all files; `-` is standard output.
    pub fn begin(
        outputs: &[PathBuf],
        picture: &Picture,
        keeping: Option<Keeping>,
        live: Live,
    ) -> Result<Making, Failure> {
        let (mut files, mut stdout) = (Vec::new(), None);
        for path in outputs {
            if path.as_os_str() == "-" {
                let spool = Spool(Arc::new(Mutex::new(SpooledTempFile::new(SPOOL_BYTES))));
                let encoder =
                    PngRows::begin(BufWriter::new(spool.clone()), picture).map_err(|e| to_stdout(path, e))?;
                let encoder: Box<dyn Encode> = Box::new(encoder);
                stdout = Some((encoder, spool));
            } else {
                files.push(Growing::begin(path, picture)?);
            }
        }
        Ok(Making { files, stdout, keeping, live, failure: None })
    }

    /// The files that are there for now and have to go.
    pub fn litter(&self) -> Vec<PathBuf> {
        self.files.iter().map(|file| file.temporary().to_owned()).collect()
    }

    /// Gives all files their names, and forgets what was kept. What an earlier run that was stopped left of them goes, but for
    /// files `taken` for something else.
    pub fn finish(self, old: Old, taken: &[PathBuf]) -> Result<(), Failure> {
        let goes_on = self.keeping.as_ref().is_some_and(Keeping::follows_a_stop);
        for file in self.files {
            let path = file.path().to_owned();
            file.finish(old)?;
            if goes_on && !taken.contains(&partial(&path)) {
                remove_partial(&path);
            }
        }
        if let Some((encoder, spool)) = self.stdout {
            encoder.finish().map_err(|e| to_stdout(Path::new("-"), e))?;
            spool.print()?;
        }
        self.keeping.into_iter().for_each(Keeping::end);
        Ok(())
    }

    /// Leaves what there is beside the places of the files, and tells of each what became of it.
    pub fn finish_partial(&mut self, taken: &[PathBuf]) -> Vec<String> {
        let mut told = Vec::new();
        for file in self.files.drain(..) {
            let name = partial(file.path());
            if taken.contains(&name) {
                told.push(format!("what there is was not written: `{}` has another use", name.display()));
                continue;
            }
            match file.finish_partial() {
                Ok(path) => told.push(format!("wrote what there is to `{}`", path.display())),
                Err(e) => told.push(format!("what there is could not be written: {e}")),
            }
        }
        told
    }
}

impl Onlooker for Making {
    fn rows(&mut self, rows: &Film) -> ControlFlow<()> {
        for file in &mut self.files {
            if let Err(e) = file.rows(rows) {
                self.failure = Some(e);
                return ControlFlow::Break(());
            }
        }
        if let Some(Err(source)) = self.stdout.as_mut().map(|(encoder, _)| encoder.rows(rows)) {
            self.failure = Some(OutputError::Write { path: PathBuf::from("-"), source });
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn recall(&mut self, tile: &Tile) -> Option<(Film, Work)> {
        let (film, work) = self.keeping.as_mut()?.recall(tile)?;
        self.live.show(&film, [tile.x, tile.y], tile);
        Some((film, work))
    }

    fn painted(&mut self, slab: &mut Slab, moment: Moment) {
        if let Some((tile, _)) = slab.fresh.last()
            && moment == Moment::Tile
        {
            self.live.show(&slab.film, slab.at, tile);
        }
        if let Some(keeping) = &mut self.keeping {
            keeping.painted(slab, moment);
        }
    }
}

fn to_stdout(path: &Path, source: io::Error) -> Failure {
    Failure::from(OutputError::Write { path: path.to_owned(), source })
}

/// What standard output gets once it is whole.
#[derive(Clone)]
struct Spool(Arc<Mutex<SpooledTempFile>>);

impl Spool {
    fn with<T>(&self, act: impl FnOnce(&mut SpooledTempFile) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn print(&self) -> Result<(), Failure> {
        self.with(|file| {
            file.rewind().map_err(|e| to_stdout(Path::new("-"), e))?;
            let mut bytes = vec![0; 1 << 16];
            loop {
                let n = file.read(&mut bytes).map_err(|e| to_stdout(Path::new("-"), e))?;
                if n == 0 || !console::print(&bytes[..n])? {
                    return Ok(());
                }
            }
        })
    }
}

impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.with(Write::flush)
    }
}
