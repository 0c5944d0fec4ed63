//! The picture while it is made: a viewer gets every tile, and cannot do any harm.

mod cli_common;

use std::io::{BufReader, Read};
use std::net::{TcpListener, TcpStream};
use std::thread;

use cli_common::Folder;

const SCENE: &str = "
    camera(eye: [2, -5, 3], look_at: [0, 0, 0], fov: 30deg)
    render(size: [70, 45], samples: 2)
    draw sphere(r: 1)";

/// Reads what a viewer reads: packets with their length before them, all numbers little endian (the protocol of tev, version of
/// `UpdateImageV3`).
struct Peer(BufReader<TcpStream>);

impl Peer {
    fn packet(&mut self) -> Option<Vec<u8>> {
        let mut length = [0; 4];
        self.0.read_exact(&mut length).ok()?;
        let mut rest = vec![0; u32::from_le_bytes(length) as usize - 4];
        self.0.read_exact(&mut rest).ok()?;
        Some(rest)
    }
}

/// Takes numbers and texts off a packet.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_at(N);
        self.0 = rest;
        head.try_into().unwrap()
    }

    fn number(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|b| *b == 0).unwrap();
        let text = String::from_utf8(self.0[..end].to_vec()).unwrap();
        self.0 = &self.0[end + 1..];
        text
    }
}

#[test]
fn a_viewer_is_sent_the_whole_picture_tile_by_tile() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap().to_string();
    let peer = thread::spawn(move || {
        let mut peer = Peer(BufReader::new(listener.accept().unwrap().0));
        let first = peer.packet().unwrap();
        let mut f = Fields(&first);
        assert_eq!(f.bytes(), [4, 1], "an image is made, and shown");
        assert_eq!(f.text(), "a.exr");
        let (w, h) = (f.number(), f.number());
        let names: Vec<String> = (0..f.number()).map(|_| f.text()).collect();
        assert_eq!((w, h, names.join("")), (70, 45, "RGBA".to_owned()));
        let mut picture = vec![[f32::NAN; 4]; (w * h) as usize];
        while let Some(packet) = peer.packet() {
            let mut f = Fields(&packet);
            assert_eq!(f.bytes(), [6, 0]);
            assert_eq!(f.text(), "a.exr");
            assert_eq!((0..f.number()).map(|_| f.text()).collect::<String>(), "RGBA");
            let [x, y, tw, th] = [0; 4].map(|_| f.number());
            // Offsets and strides.
            f.bytes::<64>();
            for i in 0..tw * th {
                let at = ((y + i / tw) * w + x + i % tw) as usize;
                picture[at] = [0; 4].map(|_| f32::from_bits(f.number()));
            }
            assert!(f.0.is_empty());
        }
        picture
    });
    let ran = folder.run(&["render", "a.pss", "-o", "a.exr", "--display-server", &place]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let film = pss::output::read_exr(&folder.path().join("a.exr")).unwrap();
    assert!(peer.join().unwrap() == film.rgba, "the picture sent is the one written");
}

#[test]
fn a_viewer_that_goes_away_harms_nothing_and_none_at_all_is_told() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    assert_eq!(folder.run(&["render", "a.pss", "-o", "a.png"]).code, 0);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap().to_string();
    let gone = thread::spawn(move || drop(listener.accept().unwrap()));
    let ran = folder.run(&["render", "a.pss", "-o", "b.png", "--display-server", &place]);
    gone.join().unwrap();
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    let ran = folder.run(&["render", "a.pss", "-o", "c.png", "--display-server", &place]);
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert!(
        ran.stderr.contains("no viewer answers") && !folder.path().join("c.png").exists(),
        "{}",
        ran.stderr
    );
}

#[test]
fn a_sketch_wants_a_terminal() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let ran = folder.run(&["render", "a.pss", "-o", "a.png", "--preview"]);
    assert!(ran.code == 2 && ran.stderr.contains("terminal"), "{}", ran.stderr);
    assert!(ran.stdout.is_empty() && !folder.path().join("a.png").exists());
}
