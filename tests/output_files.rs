//! Files: what is written can be read, is the same every time, and never harms what was there.

use std::fs;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use pss::film::{Aov, Film};
use pss::num::hash::unit;
use pss::output::{self, OutputError, Sink, read_exr, write_exr, write_png, write_whole};
use pss::shot::Settings;
use pss::shot::settings::Tone;

/// A film of hashed values with every layer, zero, infinity and small and large numbers among them.
fn film() -> Film {
    let mut film = Film::new([37, 21], &Aov::ALL).unwrap();
    let value = |seed: u64, i: usize| (20.0 * unit(seed, i as u64) - 10.0).exp2() as f32;
    for (i, pixel) in film.rgba.iter_mut().enumerate() {
        *pixel = std::array::from_fn(|c| value(c as u64, i));
    }
    for (seed, layer) in film.layers.iter_mut().enumerate() {
        for (i, x) in layer.data.iter_mut().enumerate() {
            if i % 3 != 0 {
                *x = value(10 + seed as u64, i) * if i % 2 == 0 { 1.0 } else { -1.0 };
            }
        }
    }
    film
}

#[test]
fn an_exr_gives_back_every_bit_of_colour_and_layers() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.exr");
    output::write(&film(), &Settings::default(), &path).unwrap();
    assert_eq!(read_exr(&path).unwrap(), film());
}

#[test]
fn an_exr_is_linear_and_the_same_bytes_every_time() {
    let dir = tempfile::tempdir().unwrap();
    let bytes = |name: &str, exposure: f64| {
        let path = dir.path().join(name);
        output::write(&film(), &Settings { exposure, ..Settings::default() }, &path).unwrap();
        fs::read(path).unwrap()
    };
    let first = bytes("a.exr", 0.0);
    assert_eq!(first, bytes("another-name.exr", 3.0));
    for word in ["another", "capDate", "utcOffset", "owner\0", "comments"] {
        assert!(!first.windows(word.len()).any(|w| w == word.as_bytes()), "the file says {word}");
    }
}

#[test]
fn a_png_gives_back_the_values_shown() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("A.PNG");
    let settings = Settings { exposure: -1.0, tone: Tone::Reinhard, ..Settings::default() };
    output::write(&film(), &settings, &path).unwrap();
    let decoder = image::codecs::png::PngDecoder::new(io::Cursor::new(fs::read(&path).unwrap())).unwrap();
    let image = image::DynamicImage::from_decoder(decoder).unwrap().into_rgb8();
    assert_eq!(image.dimensions(), (37, 21));
    for (x, y, pixel) in image.enumerate_pixels() {
        let [r, g, b, _] = film().pixel(x, y);
        assert_eq!(pixel.0, output::tone::Display::new(-1.0, Tone::Reinhard).of([r, g, b]), "{x} {y}");
    }
}

/// Fails at byte `left`.
struct Failing<'a> {
    sink: &'a mut dyn Sink,
    left: u64,
}

impl Write for Failing<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.left.min(bytes.len() as u64) as usize;
        if n == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.left -= n as u64;
        self.sink.write(&bytes[..n])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

impl Seek for Failing<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.sink.seek(to)
    }
}

fn names(dir: &Path) -> Vec<String> {
    fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_failure_at_any_byte_leaves_the_old_file_and_nothing_else() {
    type Encode = fn(&Film, &mut dyn Sink) -> io::Result<()>;
    let encoders: [Encode; 2] = [|f, sink| write_exr(f, sink), |f, sink| write_png(f, 0.0, Tone::Agx, sink)];
    for encode in encoders {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("picture");
        write_whole(&path, |sink| encode(&film(), sink)).unwrap();
        let whole = fs::read(&path).unwrap();
        fs::write(&path, "old").unwrap();
        let length = whole.len() as u64;
        for left in (0..length).step_by(97).chain([1, length - 1]) {
            let failed = write_whole(&path, |sink| encode(&film(), &mut Failing { sink, left }));
            assert!(matches!(failed, Err(OutputError::Write { .. })), "byte {left}: {failed:?}");
            assert_eq!(fs::read(&path).unwrap(), b"old", "byte {left}");
            assert_eq!(names(dir.path()), ["picture"], "byte {left}");
        }
        // Some formats write a table twice: what matters is that enough room is enough.
        let roomy = write_whole(&path, |sink| encode(&film(), &mut Failing { sink, left: 2 * length }));
        assert!(roomy.is_ok());
        assert_eq!(fs::read(&path).unwrap(), whole);
    }
}

#[test]
fn a_panic_while_writing_leaves_the_old_file_and_nothing_else() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.png");
    fs::write(&path, "old").unwrap();
    let write = || write_whole(&path, |sink| sink.write_all(b"half").map(|()| panic!("on purpose")));
    assert!(std::panic::catch_unwind(write).is_err());
    assert_eq!((fs::read(&path).unwrap(), names(dir.path())), (b"old".to_vec(), vec!["a.png".to_owned()]));
}

#[test]
fn inputs_folders_and_missing_folders_are_refused_before_any_work() {
    let dir = tempfile::tempdir().unwrap();
    let input = dir.path().join("input.png");
    fs::write(&input, "precious").unwrap();
    let folder = dir.path().join("folder.png");
    fs::create_dir(&folder).unwrap();
    let inputs = [input.clone()];
    let detour = dir.path().join("folder.png/../input.png");
    let missing = dir.path().join("nowhere/a.png");
    for path in [&input, &detour, &folder, &missing] {
        let refused = output::check(path, &inputs);
        assert!(matches!(refused, Err(OutputError::Create { .. })), "{path:?}: {refused:?}");
    }
    let fine = dir.path().join("new.png");
    output::check(&fine, &inputs).unwrap();
    assert!(!fine.exists(), "a check writes nothing");
    assert_eq!(names(dir.path()).len(), 2);
}

#[cfg(unix)]
#[test]
fn a_link_keeps_leading_to_the_file_and_the_file_is_open_to_others() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let dir = tempfile::tempdir().unwrap();
    let (real, link) = (dir.path().join("real"), dir.path().join("link"));
    fs::write(&real, "old").unwrap();
    symlink(&real, &link).unwrap();
    write_whole(&link, |sink| sink.write_all(b"new")).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&real).unwrap(), b"new");
    let plain = dir.path().join("plain");
    fs::write(&plain, "").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&real), mode(&plain));
}
