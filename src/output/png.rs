//! PNG files: what a display shows of a film.

use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use image::{ImageError, ImageFormat, ImageReader};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, StreamWriter};

use super::rows::{Encode, Picture, write_film};
use super::tone;
use crate::film::Film;
use crate::shot::settings::Tone;

/// Bytes of compressed data in a chunk of the file.
const CHUNK_BYTES: usize = 64 << 10;

/// Writes 8-bit sRGB without alpha: the background is what the colour under it says.
pub fn write_png(film: &Film, exposure: f64, tone: Tone, sink: impl Write) -> io::Result<()> {
    at_once(sink, |sink| {
        write_film(film, |picture| PngRows::begin(sink, &Picture { exposure, tone, ..picture.clone() }))
    })
}

/// Writes 8-bit sRGB, three bytes a pixel, row by row from the top left.
pub fn write_rgb(size: [u32; 2], bytes: &[u8], sink: impl Write) -> io::Result<()> {
    rgb(size, bytes, None, sink)
}

/// The same with a note: a keyword and a text, both Latin-1.
pub fn write_rgb_noted(size: [u32; 2], bytes: &[u8], note: [&str; 2], sink: impl Write) -> io::Result<()> {
    rgb(size, bytes, Some(note), sink)
}

fn rgb(size: [u32; 2], bytes: &[u8], note: Option<[&str; 2]>, sink: impl Write) -> io::Result<()> {
    at_once(sink, |sink| {
        let mut writer = Rgb::begin(sink, size, note)?;
        writer.write(bytes)?;
        writer.finish()
    })
}

/// The text of a note before the pixels; they are not read. Fails where the file is no PNG.
pub fn png_note(path: &Path, keyword: &str) -> io::Result<Option<String>> {
    let file = BufReader::new(std::fs::File::open(path)?);
    let broken = |e: png::DecodingError| io::Error::new(io::ErrorKind::InvalidData, e);
    let reader = png::Decoder::new(file).read_info().map_err(broken)?;
    let mut notes = reader.info().uncompressed_latin1_text.iter();
    Ok(notes.find(|note| note.keyword == keyword).map(|note| note.text.clone()))
}

/// Writes a file that is made in memory: the encoder takes no sinks that are borrowed.
fn at_once(mut sink: impl Write, encode: impl FnOnce(Shared<Vec<u8>>) -> io::Result<()>) -> io::Result<()> {
    let bytes = Shared::new(Vec::new());
    encode(bytes.clone())?;
    let bytes = bytes.with(|bytes| Ok(std::mem::take(bytes)))?;
    sink.write_all(&bytes)?;
    sink.flush()
}

/// What a PNG holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Pixels {
    /// Width and height.
    pub size: [u32; 2],
    /// Red, green, blue and coverage from 0 to 1 as they are encoded, row by row from the top left.
    pub rgba: Vec<[f32; 4]>,
    /// Whether the file holds coverage; else it is 1 here.
    pub has_alpha: bool,
}

/// Reads a PNG of any depth. Fails where it cannot be read or is broken.
pub fn read_png(path: &Path) -> io::Result<Pixels> {
    let mut reader = ImageReader::new(BufReader::new(std::fs::File::open(path)?));
    reader.set_format(ImageFormat::Png);
    let image = reader.decode().map_err(|e| match e {
        ImageError::IoError(e) => e,
        e => io::Error::new(io::ErrorKind::InvalidData, e),
    })?;
    let has_alpha = image.color().has_alpha();
    let image = image.into_rgba32f();
    let size = [image.width(), image.height()];
    Ok(Pixels { size, rgba: image.pixels().map(|p| p.0).collect(), has_alpha })
}

/// The size that the head of a file tells; fails where it cannot be read.
pub fn png_size(mut file: impl Read) -> io::Result<[u32; 2]> {
    let mut head = [0; 24];
    file.read_exact(&mut head)?;
    if !head.starts_with(b"\x89PNG\r\n\x1a\n") || &head[12..16] != b"IHDR" {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "no PNG"));
    }
    let side = |at: usize| u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    Ok([side(16), side(20)])
}

/// A file that grows with its picture.
pub struct PngRows<W: Write + 'static> {
    writer: Rgb<W>,
    display: tone::Display,
    row: Vec<u8>,
}

impl<W: Write + 'static> PngRows<W> {
    /// Writes the head.
    pub fn begin(sink: W, picture: &Picture) -> io::Result<PngRows<W>> {
        let display = tone::Display::new(picture.exposure, picture.tone);
        Ok(PngRows { writer: Rgb::begin(sink, picture.size, None)?, display, row: Vec::new() })
    }
}

impl<W: Write + Send + 'static> Encode for PngRows<W> {
    fn rows(&mut self, film: &Film) -> io::Result<()> {
        for row in film.rgba.chunks_exact(film.size[0] as usize) {
            self.row.clear();
            self.row.extend(row.iter().flat_map(|[r, g, b, _]| self.display.of([*r, *g, *b])));
            self.writer.write(&self.row)?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.writer.finish()
    }
}

/// An encoder of 8-bit RGB.
struct Rgb<W: Write + 'static> {
    stream: StreamWriter<'static, Shared<W>>,
    sink: Shared<W>,
}

impl<W: Write + 'static> Rgb<W> {
    fn begin(sink: W, [w, h]: [u32; 2], note: Option<[&str; 2]>) -> io::Result<Rgb<W>> {
        let sink = Shared::new(sink);
        let mut encoder = Encoder::new(sink.clone(), w, h);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        encoder.set_filter(Filter::Adaptive);
        if let Some([keyword, text]) = note {
            encoder.add_text_chunk(keyword.to_owned(), text.to_owned()).map_err(io_error)?;
        }
        let begun = encoder.write_header().and_then(|w| w.into_stream_writer_with_size(CHUNK_BYTES));
        match (sink.failure(), begun) {
            (Some(e), _) => Err(e),
            (None, begun) => Ok(Rgb { stream: begun.map_err(io_error)?, sink }),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let written = self.stream.write_all(bytes);
        self.sink.failure().map_or(written, Err)
    }

    fn finish(self) -> io::Result<()> {
        // The end of the file is written when the stream is dropped, which it does at the end of this.
        let finished = self.stream.finish();
        let flushed = self.sink.clone().flush();
        self.sink.failure().map_or(finished.map_err(io_error).and(flushed), Err)
    }
}

fn io_error(e: EncodingError) -> io::Error {
    match e {
        EncodingError::IoError(e) => e,
        e => io::Error::other(e),
    }
}

/// Keeps the first failure: the encoder writes the end of the file when it is dropped and says nothing if
/// that fails.
struct Remembering<W> {
    sink: W,
    failure: Option<io::Error>,
}

/// The encoder keeps its sink; this is another handle of it.
struct Shared<W>(Arc<Mutex<Remembering<W>>>);

impl<W> Clone for Shared<W> {
    fn clone(&self) -> Shared<W> {
        Shared(Arc::clone(&self.0))
    }
}

impl<W> Shared<W> {
    fn new(sink: W) -> Shared<W> {
        Shared(Arc::new(Mutex::new(Remembering { sink, failure: None })))
    }

    fn with<T>(&self, act: impl FnOnce(&mut W) -> io::Result<T>) -> io::Result<T> {
        let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut inner.sink).map_err(|e| {
            let kind = e.kind();
            if kind != io::ErrorKind::Interrupted && inner.failure.is_none() {
                inner.failure = Some(e);
            }
            kind.into()
        })
    }

    fn failure(&self) -> Option<io::Error> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).failure.take()
    }
}

impl<W: Write> Write for Shared<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|sink| sink.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.with(|sink| sink.flush())
    }
}
