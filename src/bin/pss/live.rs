//! The picture while it is made: tiles go to a viewer over the network, or a sketch of it is drawn in the terminal. Neither can
//! hold the render up for long, or end it: a viewer that goes away is left alone.

use std::io::{self, IsTerminal};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use image::{DynamicImage, RgbImage};
use pss::diag::{Diagnostic, Fault};
use pss::film::Film;
use pss::output::tone::Display;
use pss::render::Tile;
use pss::shot::Settings;
use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

use crate::args::RenderArgs;
use crate::console::{Console, Failure};

/// What a viewer calls the colour's channels.
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// So long a viewer may take to answer a call, or to take a tile.
const PATIENCE: Duration = Duration::from_secs(2);

/// How often the sketch is drawn: drawing takes a terminal some hundredths of a second.
const SKETCH_EVERY: Duration = Duration::from_millis(500);

/// The larger side of the sketch, pixels: as many as a wide terminal has columns.
const SKETCH_SIDE: u32 = 160;

/// Whoever is shown the picture while it is made.
#[derive(Default)]
pub struct Live {
    viewer: Option<Viewer>,
    sketch: Option<Sketch>,
    /// The first pixel that is made.
    origin: [u32; 2],
    /// Why the viewer is shown no more.
    trouble: Option<String>,
}

struct Viewer {
    client: TevClient,
    name: String,
}

struct Sketch {
    image: RgbImage,
    display: Display,
    /// Pixels of the picture for one of the sketch.
    scale: u32,
    drawn: Option<Instant>,
}

impl Live {
    /// Calls the viewer and makes room for the sketch, where they are asked for. `name` is that of the picture.
    pub fn begin(args: &RenderArgs, name: &str, settings: &Settings) -> Result<Live, Failure> {
        let viewer =
            args.display_server.as_deref().map(|place| Viewer::call(place, name, settings)).transpose()?;
        if args.preview && !io::stdout().is_terminal() {
            return Err(Diagnostic::error(
                "E0001",
                "`--preview` draws on a terminal, and standard output is none",
            )
            .fault(Fault::Usage)
            .help("leave it out, or show the picture in a viewer: `--display-server 127.0.0.1:14158`")
            .into());
        }
        let [x, y, ..] = settings.window();
        let sketch = args.preview.then(|| Sketch::new(settings));
        Ok(Live { viewer, sketch, origin: [x, y], trouble: None })
    }

    /// Shows a tile, part of a film whose first pixel in the whole picture is `at`.
    pub fn show(&mut self, film: &Film, at: [u32; 2], tile: &Tile) {
        if let Some(viewer) = &mut self.viewer
            && let Err(e) = viewer.send(film, at, tile, self.origin)
        {
            self.trouble = Some(format!("the viewer is shown no more: {e}"));
            self.viewer = None;
        }
        if let Some(sketch) = &mut self.sketch {
            sketch.take(film, at, tile, self.origin);
            sketch.draw_now_and_then();
        }
    }

    /// Draws the last of it.
    pub fn end(&mut self, console: &Console) {
        if let Some(mut sketch) = self.sketch.take() {
            sketch.draw(false);
        }
        if let Some(trouble) = self.trouble.take() {
            console.note(&trouble);
        }
    }
}

/// The pixels of a tile in a film, row by row.
fn pixels<'a>(
    film: &'a Film,
    [x0, y0]: [u32; 2],
    tile: &Tile,
) -> impl Iterator<Item = ([u32; 2], [f32; 4])> + 'a {
    tile.each().map(move |[x, y]| ([x, y], film.pixel(x - x0, y - y0)))
}

impl Viewer {
    /// Calls a viewer that speaks the protocol of tev.
    fn call(place: &str, name: &str, settings: &Settings) -> Result<Viewer, Failure> {
        let refused = |e: io::Error| {
            Failure::from(
                Diagnostic::error("E0001", format!("no viewer answers at `{place}`: {e}"))
                    .fault(Fault::Usage)
                    .help("start tev, which listens at 127.0.0.1:14158, or leave `--display-server` out"),
            )
        };
        let mut places = place.to_socket_addrs().map_err(refused)?;
        let none = || io::Error::new(io::ErrorKind::NotFound, "it is no address");
        let place = places.next().ok_or_else(none).map_err(refused)?;
        let stream = TcpStream::connect_timeout(&place, PATIENCE).map_err(refused)?;
        stream.set_write_timeout(Some(PATIENCE)).map_err(refused)?;
        let mut client = TevClient::wrap(stream);
        let [width, height] = settings.window_size();
        let create =
            PacketCreateImage { image_name: name, grab_focus: true, width, height, channel_names: &CHANNELS };
        client.send(create).map_err(refused)?;
        Ok(Viewer { client, name: name.to_owned() })
    }

    fn send(&mut self, film: &Film, at: [u32; 2], tile: &Tile, [x0, y0]: [u32; 2]) -> io::Result<()> {
        let data: Vec<f32> = pixels(film, at, tile).flat_map(|(_, pixel)| pixel).collect();
        self.client.send(PacketUpdateImage {
            image_name: &self.name,
            grab_focus: false,
            channel_names: &CHANNELS,
            channel_offsets: &[0, 1, 2, 3],
            channel_strides: &[4; 4],
            x: tile.x - x0,
            y: tile.y - y0,
            width: tile.size[0],
            height: tile.size[1],
            data: &data,
        })
    }
}

impl Sketch {
    fn new(settings: &Settings) -> Sketch {
        let [w, h] = settings.window_size();
        let scale = w.max(h).div_ceil(SKETCH_SIDE);
        let image = RgbImage::new(w.div_ceil(scale), h.div_ceil(scale));
        Sketch { image, display: Display::new(settings.exposure, settings.tone), scale, drawn: None }
    }

    /// Takes one pixel of each square: a sketch need not be smooth.
    fn take(&mut self, film: &Film, at: [u32; 2], tile: &Tile, [x0, y0]: [u32; 2]) {
        for ([x, y], [r, g, b, _]) in pixels(film, at, tile) {
            let [x, y] = [x - x0, y - y0];
            if x % self.scale == 0 && y % self.scale == 0 {
                let shown = self.display.of([r, g, b]);
                self.image.put_pixel(x / self.scale, y / self.scale, image::Rgb(shown));
            }
        }
    }

    fn draw_now_and_then(&mut self) {
        if self.drawn.is_none_or(|then| SKETCH_EVERY <= then.elapsed()) {
            self.draw(true);
            self.drawn = Some(Instant::now());
        }
    }

    /// Draws it; `again` where the next is drawn over it.
    fn draw(&mut self, again: bool) {
        let config =
            viuer::Config { absolute_offset: false, restore_cursor: again, ..viuer::Config::default() };
        // A terminal that cannot be drawn on shows no sketch; the picture is made all the same.
        let _ = viuer::print(&DynamicImage::ImageRgb8(self.image.clone()), &config);
    }
}
