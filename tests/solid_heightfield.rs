//! `heightfield` against boxes, wedges and saddles in closed form, all cells one by one, and damaged images.

#[path = "cli_common/mod.rs"]
mod cli_common;
#[path = "spans_common/mod.rs"]
mod spans_common;

use std::io::Cursor;

use cli_common::Folder;
use glam::{DVec2, DVec3, dvec3};
use pss::geom::{Aabb, Ray};
use pss::heights::{Heights, read_from};
use pss::num::hash::Stream;
use pss::solid::block::Block;
use pss::solid::heightfield::HeightField;
use pss::solid::{Scratch, Solid};
use spans_common::{assert_is_box, crossings};

fn field(width: usize, depth: usize, of: impl Fn(usize, usize) -> f32) -> Heights {
    let values = (0..depth).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| of(i, j)).collect();
    Heights { width, depth, values, notes: Vec::new() }
}

fn hills(width: usize, depth: usize) -> Heights {
    field(width, depth, |i, j| {
        let (x, y) = (i as f32 / 3.0, j as f32 / 4.0);
        (0.5 + 0.25 * x.sin() + 0.25 * (y + 0.3 * x).cos()).max(0.0)
    })
}

#[test]
fn a_flat_field_is_a_box_also_in_its_faces() {
    let made = HeightField::new(field(5, 4, |_, _| 0.5), dvec3(4.0, 2.0, 6.0));
    let block = Block(Aabb { min: dvec3(-2.0, -1.0, 0.0), max: dvec3(2.0, 1.0, 3.0) });
    assert_is_box(&made, &block, 20_000, 3.0, 1e-13, |_, _, _| ());
}

#[test]
fn a_saddle_of_one_cell_is_the_hyperbolic_paraboloid() {
    // Heights 0, 1, 1, 0 at the corners: z = u + v - 2 u v, with u and v from 0 to 1.
    let made = HeightField::new(field(2, 2, |i, j| ((i + j + 1) % 2) as f32), dvec3(1.0, 1.0, 1.0));
    // Of the first row of the image (high y) the left pixel is 1: at u = 0, v = 1.
    for (x, y) in [(0.25, 0.25), (0.5, 0.5), (0.9, 0.2), (0.1, 0.8)] {
        let found = crossings(&made, &Ray::new(dvec3(x - 0.5, y - 0.5, 5.0), -DVec3::Z));
        let z = x + y - 2.0 * x * y;
        assert!((found[0].t - (5.0 - z)).abs() < 1e-15 && found[1].t == 5.0, "{found:?} {z}");
    }
    // Level at z along x = y: above (1 - sqrt(1 - 2 z)) / 2, until it is as much before the end.
    let z = 0.375;
    let found = crossings(&made, &Ray::new(dvec3(-0.5, -0.5, z), dvec3(1.0, 1.0, 0.0)));
    assert!((found[0].t - 0.25).abs() < 1e-15 && (found[1].t - 0.75).abs() < 1e-15, "{found:?}");
    // Along the ridge line u = 1 - v it is 1 - 2 u + 2 u^2: at 0.625 two pieces, cut by the walls.
    let found = crossings(&made, &Ray::new(dvec3(-0.5, 0.5, 0.625), dvec3(1.0, -1.0, 0.0)));
    let ends: Vec<f64> = found.iter().map(|c| c.t).collect();
    assert!(
        ends.iter().zip([0.0, 0.25, 0.75, 1.0]).all(|(a, b)| (a - b).abs() < 1e-14) && ends.len() == 4,
        "{ends:?}"
    );
}

/// The height by weights of four pixels, in another order of sums.
fn height(h: &Heights, size: DVec3, p: DVec2) -> f64 {
    let (w, d) = (h.width as f64 - 1.0, h.depth as f64 - 1.0);
    let (x, y) = ((p.x / size.x + 0.5) * w, (0.5 - p.y / size.y) * d);
    let (i, j) = ((x.floor() as usize).min(h.width - 2), (y.floor() as usize).min(h.depth - 2));
    let (u, v) = (x - i as f64, y - j as f64);
    let at = |i: usize, j: usize| f64::from(h.values[j * h.width + i]);
    size.z
        * ((1.0 - u) * (1.0 - v) * at(i, j)
            + u * (1.0 - v) * at(i + 1, j)
            + (1.0 - u) * v * at(i, j + 1)
            + u * v * at(i + 1, j + 1))
}

#[test]
fn every_state_along_a_ray_is_that_of_the_height_below() {
    let size = dvec3(3.0, 2.0, 1.0);
    let mut stream = Stream::new(2);
    let mut spans = 0;
    for heights in [hills(37, 29), hills(2, 50), field(16, 16, |i, j| ((i * 7 + j * 3) % 5) as f32 / 4.0)] {
        let made = HeightField::new(heights.clone(), size);
        let inside = |p: DVec3| {
            p.x.abs() < 1.5 && p.y.abs() < 1.0 && 0.0 < p.z && p.z < height(&heights, size, p.truncate())
        };
        for i in 0..400 {
            let mut ray = Ray::chord(&mut stream, 0.5 * DVec3::Z, 1.9);
            if i % 4 == 0 {
                // Level: many crossings.
                ray = Ray::new(ray.origin.with_z(0.6), ray.dir.with_z(0.0));
            }
            let found = crossings(&made, &ray);
            spans += found.len() / 2;
            for k in 0..300 {
                let t = (f64::from(k) + 0.41) / 300.0;
                if found.iter().any(|c| (c.t - t).abs() < 1e-9) {
                    continue;
                }
                let odd = found.iter().filter(|c| c.t < t).count() % 2 == 1;
                assert_eq!(odd, inside(ray.at(t)), "{t} {found:?} {ray:?}");
            }
            for c in &found {
                let n = made.normal(&ray, c, &mut Scratch::default());
                assert!((n.length() - 1.0).abs() < 1e-12 && (n.dot(ray.dir) < 0.0) == c.entering);
            }
        }
    }
    assert!(500 < spans, "{spans}");
}

#[test]
fn rays_along_rows_of_pixels_and_through_pixels_find_both_ends() {
    let heights = hills(9, 9);
    let size = dvec3(8.0, 8.0, 2.0);
    let made = HeightField::new(heights.clone(), size);
    let mut stream = Stream::new(3);
    for i in 0..9i32 {
        for j in 0..9i32 {
            let q = DVec2::new(f64::from(i - 4), f64::from(j - 4));
            let z = height(&heights, size, q);
            // Down on a pixel: what stands on the high borders is outside.
            let found = crossings(&made, &Ray::new(q.extend(9.0), -DVec3::Z));
            let on = i < 8 && j < 8;
            assert_eq!(found.len(), if on { 2 } else { 0 }, "{q}");
            assert!(!on || ((found[0].t - (9.0 - z)).abs() < 1e-13 && found[1].t == 9.0));
            for _ in 0..30 {
                // Through the pixel's own corner of the surface, and along the rows.
                let d = stream.direction();
                crossings(&made, &Ray::new(q.extend(z) - 20.0 * d, d));
                crossings(&made, &Ray::new(q.extend(z) - 20.0 * DVec3::X, dvec3(1.0, 0.0, 0.1 * d.z)));
            }
        }
    }
}

#[test]
fn d1_c2_scaling_changes_no_bit_and_far_rays_find_the_same() {
    let size = dvec3(3.0, 2.0, 1.0);
    let made = HeightField::new(hills(37, 29), size);
    let mut stream = Stream::new(4);
    for s in [2f64.powi(-20), 2f64.powi(20)] {
        let large = HeightField::new(hills(37, 29), s * size);
        for _ in 0..300 {
            let ray = Ray::chord(&mut stream, 0.5 * DVec3::Z, 1.9);
            let found = crossings(&made, &ray);
            assert_eq!(crossings(&large, &Ray::new(s * ray.origin, s * ray.dir)), found);
        }
    }
    for _ in 0..300 {
        let down =
            Ray::new(dvec3(2.0 * stream.unit() - 1.0, stream.unit() - 0.5, 3.0), dvec3(0.3, 0.2, -1.0));
        let (near, far) =
            (crossings(&made, &down), crossings(&made, &Ray::new(down.origin - 1e7 * down.dir, down.dir)));
        assert_eq!(near.len(), far.len());
        assert!(near.iter().zip(&far).all(|(a, b)| (a.t - (b.t - 1e7)).abs() < 1e-7), "{near:?} {far:?}");
    }
}

// Files.

fn png(image: image::DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn ramp() -> Vec<u8> {
    let ramp =
        image::ImageBuffer::from_fn(3, 2, |i, _| image::Luma([(i * 32767 + u32::from(i == 2)) as u16]));
    png(image::DynamicImage::ImageLuma16(ramp))
}

fn exr(values: [f32; 6]) -> Vec<u8> {
    use exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
    };
    let channel = AnyChannel::new("Y", FlatSamples::F32(values.to_vec()));
    let channels = AnyChannels::sort([channel].into_iter().collect());
    let layer = Layer::new((3, 2), LayerAttributes::named("heights"), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn pngs_and_exrs_are_read_with_all_their_digits() {
    let heights = read_from(Cursor::new(ramp())).unwrap();
    assert_eq!((heights.width, heights.depth), (3, 2));
    assert_eq!(heights.values[2], 1.0);
    assert!((f64::from(heights.values[1]) - 32767.0 / 65535.0).abs() < 1e-7);
    let eight = png(image::DynamicImage::ImageLuma8(image::ImageBuffer::from_fn(2, 2, |i, j| {
        image::Luma([(85 * (i + 2 * j)) as u8])
    })));
    assert_eq!(read_from(Cursor::new(eight)).unwrap().values, [0.0, 85.0 / 255.0, 170.0 / 255.0, 1.0]);
    let heights = read_from(Cursor::new(exr([0.1, 2.5, -1.0, f32::NAN, 0.0, 1.0]))).unwrap();
    assert_eq!(heights.values, [0.1, 2.5, 0.0, 0.0, 0.0, 1.0]);
    assert!(heights.notes.len() == 1 && heights.notes[0].starts_with('2'), "{:?}", heights.notes);
}

#[test]
fn a_scene_stands_on_its_image_and_bad_images_are_told() {
    let folder = Folder::new();
    folder.write("ramp.png", ramp());
    folder.write("ramp.pss", "draw heightfield(\"ramp.png\", size: [4, 2, 8]) & box([-9, -9, 1], [9, 9, 9])");
    let ran = folder.run(&["probe", "ramp.pss", "--json", "--ray", "1,0.5,10 0,0,-1"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let span = ran.json_lines()[0]["spans"][0].clone();
    let (enter, exit) = (span["enter"]["t"].as_f64().unwrap(), span["exit"]["t"].as_f64().unwrap());
    assert!((enter - 4.0).abs() < 1e-4 && exit == 9.0, "{span}");
    folder.write("one.png", png(image::DynamicImage::new_luma8(1, 5)));
    folder.write("part.png", &ramp()[..40]);
    for (file, code, word) in [
        ("none.png", 66, "cannot open"),
        ("one.png", 65, "1 x 5"),
        ("part.png", 65, "PNG"),
        ("ramp.pss", 65, "neither"),
        ("../ramp.png", 77, "outside"),
    ] {
        folder.write("bad.pss", format!("draw heightfield(\"{file}\", size: 1)"));
        let ran = folder.run(&["probe", "bad.pss", "--ray", "0,0,0 1,0,0"]);
        assert!(
            ran.code == code && ran.stderr.contains(word) && ran.stderr.contains("bad.pss:1"),
            "{file} {}",
            ran.stderr
        );
    }
}

#[test]
fn damaged_images_are_refused_or_read_and_nothing_panics() {
    let mut stream = Stream::new(6);
    for bytes in [ramp(), exr([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])] {
        let whole = (0..bytes.len()).filter(|n| read_from(Cursor::new(&bytes[..*n])).is_ok()).count();
        assert!(whole < 20, "{whole} truncations were read");
        for _ in 0..2000 {
            let mut damaged = bytes.clone();
            let at = (stream.unit() * damaged.len() as f64) as usize;
            damaged[at] = (stream.unit() * 256.0) as u8;
            let _ = read_from(Cursor::new(damaged));
        }
    }
    // A PNG that says it is as wide as 32 bits allow is refused before room is made.
    let mut wide = ramp();
    wide[16..20].copy_from_slice(&0x7fff_ffffu32.to_be_bytes());
    assert!(read_from(Cursor::new(wide)).is_err());
}
