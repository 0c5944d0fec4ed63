//! EXR files, written while the picture is made: each block of rows when it is whole.

use std::io::{self, Cursor, SeekFrom};

use exr::block::chunk::{CompressedBlock, CompressedScanLineBlock};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::compression::Compression;
use exr::error::Error;
use exr::meta::attribute::{ChannelDescription, ChannelList, Chromaticities, LineOrder, SampleType};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, Headers, compute_chunk_count};
use exr::prelude::Vec2;
use rayon::prelude::*;

use super::{COLOR, io_error};
use crate::film::{Aov, Film};
use crate::output::rows::{Encode, Picture};
use crate::output::{Sink, rows};

/// The primaries of linear Rec. 709 and its white, D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Other compressions of the library were seen to give other bytes from run to run.
const COMPRESSION: Compression = Compression::ZIP16;

/// Blocks that wait to be compressed side by side end at so many bytes, unless one alone has more.
const BATCH_BYTES: usize = 16 << 20;

/// Writes a film.
pub fn write_exr(film: &Film, sink: &mut dyn Sink) -> io::Result<()> {
    rows::write_film(film, |picture| ExrRows::begin(sink, picture))
}

/// A file that grows with its picture.
///
/// The library writes files in one call, and all else in them in an order that changes from run to run; here it makes the
/// head, and compresses blocks.
pub struct ExrRows<W> {
    sink: W,
    headers: Headers,
    /// Where each channel comes from, in the order of the file.
    sources: Vec<Source>,
    /// Where blocks begin in the file, those to come zero.
    table: Vec<u64>,
    table_at: u64,
    /// Where the next block begins.
    position: u64,
    /// Blocks in the table that are written.
    written: usize,
    /// The rows of blocks that are whole and of one that is not, as the library wants them.
    blocks: Vec<Vec<u8>>,
    /// Rows in the last of them.
    last: usize,
}

#[derive(Clone, Copy)]
enum Source {
    Color(usize),
    /// A layer and a channel of it.
    Layer(usize, usize),
}

impl<W: Sink> ExrRows<W> {
    /// Writes the head.
    pub fn begin(mut sink: W, picture: &Picture) -> io::Result<ExrRows<W>> {
        let (header, sources) = header(picture);
        let (head, headers) = head(header, picture)?;
        let table = vec![0; headers[0].chunk_count];
        sink.write_all(&head)?;
        sink.write_all(&vec![0; 8 * table.len()])?;
        let table_at = head.len() as u64;
        let position = table_at + 8 * table.len() as u64;
        let (written, blocks, last) = (0, Vec::new(), 0);
        Ok(ExrRows { sink, headers, sources, table, table_at, position, written, blocks, last })
    }

    fn add_row(&mut self, film: &Film, y: usize) -> io::Result<()> {
        let width = film.size[0] as usize;
        if self.last == 0 {
            self.blocks.push(Vec::new());
        }
        let rows = block_rows(&self.headers[0], self.written + self.blocks.len() - 1);
        let Some(block) = self.blocks.last_mut().filter(|_| self.last < rows) else {
            return Err(io::Error::other("more rows than the picture has"));
        };
        if self.last == 0 {
            let bytes = rows * width * self.sources.len() * size_of::<f32>();
            block.try_reserve_exact(bytes).map_err(|_| io::ErrorKind::OutOfMemory)?;
        }
        for source in &self.sources {
            match *source {
                Source::Color(i) => {
                    let row = &film.rgba[y * width..(y + 1) * width];
                    block.extend(row.iter().flat_map(|pixel| pixel[i].to_ne_bytes()));
                }
                Source::Layer(layer, i) => {
                    let layer = &film.layers[layer];
                    let n = layer.aov.channels().len();
                    let row = &layer.data[y * width * n..(y + 1) * width * n];
                    block.extend(row.iter().skip(i).step_by(n).flat_map(|x| x.to_ne_bytes()));
                }
            }
        }
        self.last = (self.last + 1) % rows;
        Ok(())
    }

    /// Compresses and writes all blocks, which are whole.
    fn write_blocks(&mut self) -> io::Result<()> {
        let blocks = std::mem::take(&mut self.blocks);
        let (first, headers) = (self.written, &self.headers);
        let compress = |(i, data): (usize, Vec<u8>)| {
            let index = BlockIndex {
                layer: 0,
                pixel_position: Vec2(0, (first + i) * COMPRESSION.scan_lines_per_block()),
                pixel_size: Vec2(headers[0].layer_size.0, block_rows(&headers[0], first + i)),
                level: Vec2(0, 0),
            };
            UncompressedBlock { index, data }.compress_to_chunk(headers)
        };
        let chunks: Vec<_> = blocks.into_par_iter().enumerate().map(compress).collect();
        for chunk in chunks {
            let CompressedBlock::ScanLine(CompressedScanLineBlock { y_coordinate, compressed_pixels_le }) =
                chunk.map_err(io_error)?.compressed_block
            else {
                return Err(io::Error::other("a block that is none of scan lines"));
            };
            let length = i32::try_from(compressed_pixels_le.len()).map_err(io::Error::other)?;
            self.sink.write_all(&y_coordinate.to_le_bytes())?;
            self.sink.write_all(&length.to_le_bytes())?;
            self.sink.write_all(&compressed_pixels_le)?;
            self.table[self.written] = self.position;
            self.position += 8 + compressed_pixels_le.len() as u64;
            self.written += 1;
        }
        Ok(())
    }
}

/// Rows of a block that comes after `before` others.
fn block_rows(header: &Header, before: usize) -> usize {
    let rows = COMPRESSION.scan_lines_per_block();
    header.layer_size.1.saturating_sub(before * rows).min(rows)
}

impl<W: Sink> Encode for ExrRows<W> {
    fn rows(&mut self, film: &Film) -> io::Result<()> {
        for y in 0..film.size[1] as usize {
            self.add_row(film, y)?;
            let bytes: usize = self.blocks.iter().map(Vec::capacity).sum();
            if self.last == 0 && BATCH_BYTES <= bytes {
                self.write_blocks()?;
            }
        }
        // What is whole does not wait for the rows of another slab.
        if self.last == 0 { self.write_blocks() } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        if self.last != 0 || self.written != self.table.len() {
            return Err(io::Error::other("rows are missing"));
        }
        self.sink.seek(SeekFrom::Start(self.table_at))?;
        let table: Vec<u8> = self.table.iter().flat_map(|at| at.to_le_bytes()).collect();
        self.sink.write_all(&table)?;
        self.sink.flush()
    }
}

/// What the library wants to know of a file, and where its channels come from.
fn header(picture: &Picture) -> (Header, Vec<Source>) {
    let channel = |name: &str, quantize_linearly: bool| ChannelDescription {
        name: name.into(),
        sample_type: SampleType::F32,
        quantize_linearly,
        sampling: Vec2(1, 1),
    };
    let color = COLOR.iter().enumerate().map(|(i, name)| (channel(name, false), Source::Color(i)));
    let layers = picture.aovs.iter().enumerate().flat_map(|(layer, aov): (usize, &Aov)| {
        let names = aov.channels().iter().enumerate();
        // Marks the values as facts, not as something an eye sees.
        names.map(move |(i, name)| (channel(name, true), Source::Layer(layer, i)))
    });
    let mut channels: Vec<(ChannelDescription, Source)> = color.chain(layers).collect();
    // Readers want them by name.
    channels.sort_by(|(a, _), (b, _)| a.name.cmp(&b.name));
    let (channels, sources): (Vec<_>, Vec<_>) = channels.into_iter().unzip();
    let size = Vec2(picture.size[0] as usize, picture.size[1] as usize);
    let mut shared_attributes = ImageAttributes::with_size(size);
    shared_attributes.chromaticities = Some(REC_709);
    let header = Header {
        channels: ChannelList::new(channels.into_iter().collect()),
        compression: COMPRESSION,
        blocks: BlockDescription::ScanLines,
        chunk_count: compute_chunk_count(COMPRESSION, size, BlockDescription::ScanLines),
        line_order: LineOrder::Increasing,
        layer_size: size,
        shared_attributes,
        own_attributes: LayerAttributes::default(),
        deep: false,
        deep_data_version: None,
        max_samples_per_pixel: None,
    };
    (header, sources)
}

/// The bytes before the table.
fn head(header: Header, picture: &Picture) -> io::Result<(Vec<u8>, Headers)> {
    let table = 8 * header.chunk_count;
    let headers: Headers = [header].into_iter().collect();
    let mut head = Cursor::new(Vec::new());
    // Ends when the head and an empty table are there: the library has no other way to make a head.
    match exr::block::write(&mut head, headers.clone(), true, |_, _| Err(Error::Aborted)) {
        Err(Error::Aborted) => {}
        Err(e) => return Err(io_error(e)),
        Ok(()) => return Err(io::Error::other("a file without blocks")),
    }
    let mut head = head.into_inner();
    // Attributes end with a zero. Those that the library does not know it would write in an order that changes.
    head.truncate(head.len() - table - 1);
    for (name, text) in &picture.about {
        let length = i32::try_from(text.len()).map_err(io::Error::other)?;
        head.extend([name.as_bytes(), b"\0string\0", &length.to_le_bytes(), text.as_bytes()].concat());
    }
    head.push(0);
    Ok((head, headers))
}
