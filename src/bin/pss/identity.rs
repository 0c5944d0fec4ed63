//! Of what a picture is a function, as hashes: what a stopped render is continued by, and what EXR files say of their scene.
//! Names of files count as the scene writes them, below its own folder; where that folder is does not.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use blake3::Hasher;
use pss::output::state::Identity;
use pss::shot::Settings;
use pss::source::SourceMap;

use crate::args::RenderArgs;

/// The hashes of what is rendered.
#[derive(Clone, Debug)]
pub struct Identities {
    scene: [u8; 32],
    files: [u8; 32],
    settings: [u8; 32],
}

impl Identities {
    /// Reads `inputs` again to hash them: a tenth of the time that reading took to understand them. A file that is gone by
    /// now counts as empty.
    pub fn new(
        args: &RenderArgs,
        settings: &Settings,
        sources: &SourceMap,
        inputs: &[PathBuf],
    ) -> Identities {
        let mut scene = Hasher::new();
        for file in sources.files() {
            part(&mut scene, file.text.as_bytes());
        }
        for (name, value) in &args.scene.read.define {
            part(&mut scene, name.as_bytes());
            part(&mut scene, value.as_bytes());
        }
        let folder = args.scene.scene.parent().unwrap_or(Path::new(""));
        let texts: Vec<&PathBuf> = sources.files().filter_map(|f| f.path.as_ref()).collect();
        let mut files = Hasher::new();
        for path in inputs.iter().filter(|path| !texts.contains(path)) {
            part(&mut files, path.strip_prefix(folder).unwrap_or(path).as_os_str().as_encoded_bytes());
            part(&mut files, hash_of(path).unwrap_or_default().as_slice());
        }
        let mut all = Hasher::new();
        part(&mut all, format!("{settings:?}").as_bytes());
        part(&mut all, format!("{:?} {:?}", args.scene.camera, args.scene.read.lenient).as_bytes());
        let [scene, files, settings] = [scene, files, all].map(|hasher| *hasher.finalize().as_bytes());
        Identities { scene, files, settings }
    }

    /// The scene and its files, in hexadecimal digits.
    pub fn scene(&self) -> String {
        let mut both = Hasher::new();
        both.update(&self.scene).update(&self.files);
        both.finalize().to_hex().to_string()
    }

    /// Together with the program, which is read and hashed for it.
    pub fn whole(&self) -> Identity {
        let Identities { scene, files, settings } = *self;
        // The file that runs, also where another has taken its name since.
        let running = Path::new("/proc/self/exe");
        let hash = hash_of(running).or_else(|_| hash_of(&std::env::current_exe()?));
        let version = || *blake3::hash(env!("CARGO_PKG_VERSION").as_bytes()).as_bytes();
        Identity { scene, files, settings, program: hash.unwrap_or_else(|_| version()) }
    }
}

/// Adds bytes so that where they end counts, too.
fn part(hasher: &mut Hasher, bytes: &[u8]) {
    hasher.update(&(bytes.len() as u64).to_le_bytes()).update(bytes);
}

fn hash_of(path: &Path) -> io::Result<[u8; 32]> {
    let mut hasher = Hasher::new();
    // Only a regular file is sure to end.
    if path.metadata()?.is_file() {
        hasher.update_reader(File::open(path)?)?;
    }
    Ok(*hasher.finalize().as_bytes())
}
