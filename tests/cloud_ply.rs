//! The PLY reader: what it accepts, what it says about the rest, and that nothing makes it panic.

mod cloud_common;

use std::fmt::Write as _;

use cloud_common::{fibonacci_sphere, scan};
use glam::DVec3;
use pss::cloud::ply::Cut;
use pss::cloud::{Cloud, CloudError, CloudFault, ply};

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const FOUR: &str = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

fn ascii(count: &str, properties: &str, body: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{body}").into_bytes()
}

fn binary(big: bool, extra: &str, rows: &[[f32; 3]]) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let head = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex {}\n{XYZ}{extra}end_header\n",
        rows.len()
    );
    let mut bytes = head.into_bytes();
    for v in rows.iter().flatten() {
        bytes.extend(if big { v.to_be_bytes() } else { v.to_le_bytes() });
    }
    bytes
}

fn sphere(n: usize) -> Vec<[f32; 3]> {
    fibonacci_sphere(n).iter().map(|p| p.as_vec3().to_array()).collect()
}

fn four() -> Vec<DVec3> {
    vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]
}

#[test]
fn p1_p3_p4_p7_p10_p12_p13_p14_p15_every_bad_file_has_its_sentence() {
    let xyz = |count: &str, body: &str| ascii(count, XYZ, body);
    let header = |text: &str| text.as_bytes().to_vec();
    let long_line = "1 ".repeat(40_000);
    let long_header = format!("ply\nformat ascii 1.0\n{}", "comment a\n".repeat(10_000));
    let million =
        format!("ply\nformat ascii 1.0\n{}{XYZ}end_header\n{FOUR}", "comment a\n".repeat(1_000_000));
    // The head of a gzip file, and deflate's code for the longest run over and over: a thousand bytes out for each one in.
    let bomb = [&b"\x1f\x8b\x08\0\0\0\0\0\0\x03"[..], &[0xec; 1 << 20]].concat();
    let too_large = format!("line 3: the count `{}` of `vertex` is too large", "9".repeat(33));
    let list_x = "property list uchar float x\nproperty float y\nproperty float z\n";
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (vec![], "no points: the file is empty"),
        (b"p".to_vec(), "not a PLY file"),
        (header("ply\n"), "no points: the header has no `end_header` line"),
        (header("ply\nformat ascii 1.0\nend_header\n"), "no points: the file has no element `vertex`"),
        (header("ply\nend_header\n"), "the header has no `format` line"),
        (header("ply\nformat ascii\n"), "line 2: there must be one `format` line with a name and a version"),
        (header("ply\nformat binary 1.0\n"), "line 2: unknown format `binary`"),
        (header("ply\nformat ascii 1.0\nvertex 4\n"), "line 3: `vertex` is no keyword of a PLY header"),
        (xyz("0", ""), "line 3: no points: the count of `vertex` is 0"),
        (xyz("-4", FOUR), "line 3: the count `-4` of `vertex` is no whole number"),
        (xyz("0x4", FOUR), "line 3: the count `0x4` of `vertex` is no whole number"),
        (xyz("", FOUR), "line 3: an element needs a name and one count"),
        (xyz("4 4", FOUR), "line 3: an element needs a name and one count"),
        (xyz(&"9".repeat(33), FOUR), &too_large),
        (
            xyz("1152921504606846976", FOUR),
            "line 3: 1152921504606846976 points are more than the limit of 268435456",
        ),
        // 2^35 and 2^40.
        (xyz("34359738368", FOUR), "line 3: 34359738368 points are more than the limit of 268435456"),
        (xyz("1099511627776", FOUR), "line 3: 1099511627776 points are more than the limit of 268435456"),
        (xyz("1000000", FOUR), "truncated: expected 1000000 points, got 4"),
        (xyz("5", "0.5 0 0\n1 0 0\n0 1 0.5\n0 0 1\n"), "truncated: expected 5 points, got 4"),
        (xyz("4", "0 0 0\n1 0 0\n0 one 0\n0 0 1\n"), "line 10: `one` is no number for `y`"),
        (xyz("4", "0 0 0\n1,5 0 0\n0 1 0\n0 0 1\n"), "line 9: `1,5` is no number for `x`"),
        (
            xyz("4", "0 0 0\n1 0\n0 1 0.5\n0 0 1.5\n"),
            "line 9: this row has fewer values than its 3 properties",
        ),
        (
            xyz("4", "0 0 0\n1 0 0 7\n0 1 0\n0 0 1\n"),
            "line 9: this row has more values than its 3 properties",
        ),
        (xyz("4", &long_line), "line 8: a line is longer than 65536 bytes"),
        (million.into_bytes(), "the header is longer than 65536 bytes"),
        (bomb, "not a PLY file: it looks like a gzip file"),
        (long_header.into_bytes(), "the header is longer than 65536 bytes"),
        (ascii("4", "property float x\nproperty float y\n", FOUR), "line 3: `vertex` has no property `z`"),
        (ascii("4", list_x, FOUR), "line 4: property `x` is a list"),
        (ascii("4", &format!("{XYZ}property float x\n"), FOUR), "line 7: property `x` is declared twice"),
        (ascii("4\nelement vertex 4", XYZ, FOUR), "line 4: element `vertex` is declared twice"),
        (ascii("4", "property quad x\n", FOUR), "line 4: unknown type `quad`"),
        (
            ascii("4", "property list float int x\n", FOUR),
            "line 4: the count of a list must have a whole type",
        ),
        (xyz("4", "1 2 3\n1 2 3\n1 2 3\n1 2 3\n"), "no surface: all points are equal"),
        (xyz("4", "1 2 3\n2 4 6\n3 6 9\n9 18 27\n"), "no surface: all points are on a line"),
        (
            xyz("4", "nan 0 0\ninf 0 0\n0 nan 0\n0 0 -inf\n"),
            "no points: none of the 4 rows has finite coordinates",
        ),
        (xyz("4", "0 0 0\n1e30 1e30 0\n0 1 0\n0 0 1\n"), "the points span more than 1e30"),
        (b"v 1 2 3\nv 2 3 4\n".to_vec(), "not a PLY file: it looks like an OBJ file"),
        (b"# made by hand\nv 1 2 3\n".to_vec(), "not a PLY file: it looks like an OBJ file"),
        (b"solid part\n".to_vec(), "not a PLY file: it looks like an STL file"),
        (b"LASF\0\0".to_vec(), "not a PLY file: it looks like a LAS or LAZ file"),
        (b"\x1f\x8b\x08\0".to_vec(), "not a PLY file: it looks like a gzip file"),
        (b"PK\x03\x04".to_vec(), "not a PLY file: it looks like a zip file"),
        (b"# .PCD v0.7\n".to_vec(), "not a PLY file: it looks like a PCD file"),
        (b"ASTM-E57\0".to_vec(), "not a PLY file: it looks like an E57 file"),
    ];
    for (bytes, message) in cases {
        let error = ply::read(&bytes).expect_err(message);
        assert_eq!(error.to_string(), message);
        assert_eq!(error.kind, CloudFault::Bad, "{message}");
    }
}

#[test]
fn p15_the_collinear_cloud_of_a_known_report_is_refused() {
    let row = |k: i32| {
        let t = f64::from(k);
        format!("{:.5} {:.5} {:.3}\n", -89.546 + 0.1 * t, 4.03964 + 0.2 * t, 450.883 - 0.3 * t)
    };
    let body: String = (0..30).map(row).collect();
    let error = ply::read(&ascii("30", XYZ, &body)).unwrap_err();
    assert_eq!(error.to_string(), "no surface: all points are on a line");
}

/// Read of a stream that ends after `bytes`, of a file that had `length` when it was opened.
fn read_as(bytes: &[u8], length: usize, cut: Cut) -> Result<Cloud, CloudError> {
    ply::read_from(bytes, length as u64, cut)
}

#[test]
fn p2_the_whole_points_of_a_file_that_is_cut_short_are_kept_on_request() {
    for bytes in small_files() {
        let whole = ply::read(&bytes).unwrap();
        let body = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        // Rows of 12 bytes, or lines.
        let rows = |end: usize| match bytes[..body].windows(5).any(|w| w == b"ascii") {
            true => bytes[body..end].iter().filter(|b| **b == b'\n').count(),
            false => (end - body) / 12,
        };
        // The last line of a text may lack its end; whether half a number is missing cannot be told there.
        let last = bytes.len() - 1 - bytes.iter().rev().skip(1).position(|b| *b == b'\n').unwrap_or(0);
        for end in (body..last).step_by(37) {
            let kept = read_as(&bytes[..end], end, Cut::Kept);
            let count = rows(end);
            let points = kept.as_ref().map(|c| &c.points[..]).unwrap_or_default();
            assert!(points.is_empty() || points == &whole.points[..count], "{end}");
            assert!(count < 10 || points.len() == count, "{end}");
            let note = format!("truncated: expected 60 points, got {count}: these were kept");
            assert!(kept.is_err() || kept.unwrap().notes == [note]);
            assert_eq!(read_as(&bytes[..end], end, Cut::Refused).unwrap_err().kind, CloudFault::Bad);
        }
        assert_eq!(read_as(&bytes, bytes.len(), Cut::Kept).unwrap(), whole);
    }
}

#[test]
fn p17_a_file_that_shrinks_while_it_is_read_is_a_fault_of_the_reading() {
    for bytes in small_files() {
        let header = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        for end in (header..bytes.len() - 1).step_by(37) {
            for cut in [Cut::Refused, Cut::Kept] {
                let error = read_as(&bytes[..end], bytes.len(), cut).unwrap_err();
                assert_eq!(error.kind, CloudFault::Io, "{end}: {error}");
                let said = format!("{} {}", error.message, error.help.unwrap_or_default());
                assert!(said.contains("the file changed while it was read"), "{said}");
            }
        }
    }
}

#[test]
fn p8_a_declared_byte_order_that_is_wrong_is_noticed() {
    for big in [false, true] {
        let (from, to) = if big { ("big", "little") } else { ("little", "big") };
        let bytes = binary(big, "", &sphere(200));
        let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        let swapped = [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat();
        let error = ply::read(&swapped).unwrap_err();
        assert!(error.message.ends_with("wrong byte order?"), "{error}");
    }
}

#[test]
fn p9_the_three_encodings_and_line_ends_agree() {
    for end in ["\n", "\r\n", "\r"] {
        let text = String::from_utf8(ascii("4", XYZ, FOUR)).unwrap().replace('\n', end);
        assert_eq!(ply::read(text.as_bytes()).unwrap().points, four(), "ascii {end:?}");
        for big in [false, true] {
            // The first byte of the body is a line feed: only the header's own end of line is eaten.
            let first =
                if big { f32::from_be_bytes([10, 0, 0, 0]) } else { f32::from_le_bytes([10, 0, 0, 0]) };
            let rows = [[first, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let bytes = binary(big, "", &rows);
            let head = bytes.len() - 48;
            let text = std::str::from_utf8(&bytes[..head]).unwrap().replace('\n', end);
            let cloud = ply::read(&[text.as_bytes(), &bytes[head..]].concat()).unwrap();
            assert_eq!(cloud.points[0].x, f64::from(first), "{end:?}");
            assert_eq!(cloud.points[3], DVec3::Z);
            assert_eq!(cloud.notes, Vec::<String>::new());
        }
    }
}

#[test]
fn p7_p11_any_type_any_order_and_other_elements_are_read() {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\ncomment x\nobj_info y\nelement camera 2\n\
        property list uchar short path\nproperty double f\nelement empty 1000000000\nelement vertex 4\n\
        property double z\nproperty list int uchar tags\nproperty short y\nproperty uchar x\n\
        property uint unused\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    for n in [3u8, 0] {
        bytes.push(n);
        bytes.extend(vec![1u8; 2 * usize::from(n)]);
        bytes.extend(1.5f64.to_be_bytes());
    }
    for (k, p) in four().iter().enumerate() {
        bytes.extend((p.z * 0.1).to_be_bytes());
        bytes.extend((k as i32).to_be_bytes());
        bytes.extend(vec![9u8; k]);
        bytes.extend((-300 * p.y as i16).to_be_bytes());
        bytes.push(200 * p.x as u8);
        bytes.extend(7u32.to_be_bytes());
    }
    let cloud = ply::read(&bytes).unwrap();
    let scaled: Vec<DVec3> = four().iter().map(|p| *p * DVec3::new(200.0, -300.0, 0.1)).collect();
    assert_eq!(cloud.points, scaled);

    let text = "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int i\nelement vertex 4\n\
        property list uchar int tags\nproperty int y\nproperty float z\nproperty double x\nend_header\n\
        3 0 1 2\n\n3 1 2 3\n0 0 0 0\n2 5 6 0 0 1\n0 1 0 0\n1 4 0 1 0\n";
    assert_eq!(ply::read(text.as_bytes()).unwrap().points, four());
}

#[test]
fn p6_a_list_that_leaves_the_file_is_an_error() {
    for count in [[0xff, 0xff, 0xff, 0x7f], [0xff, 0xff, 0xff, 0xff]] {
        let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list int int i\n\
            element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
            .to_vec();
        bytes.extend(count);
        bytes.extend([0; 64]);
        assert_eq!(ply::read(&bytes).unwrap_err().kind, CloudFault::Bad);
    }
}

#[test]
fn p16_normals_and_colours_are_cleaned() {
    let properties = format!(
        "{XYZ}property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n\
         property uchar blue\n"
    );
    let body = "0 0 0 0 0 2 0 255 188\n1 0 0 0 0 0 0 0 0\n0 1 0 nan 0 1 0 0 0\n0 0 1 1e30 0 0 0 0 0\n";
    let cloud = ply::read(&ascii("4", &properties, body)).unwrap();
    assert_eq!(cloud.normals.unwrap(), [DVec3::Z, DVec3::ZERO, DVec3::ZERO, DVec3::X]);
    let [red, green, blue] = cloud.colors.unwrap()[0];
    assert_eq!((red, green), (0.0, 1.0));
    assert!((blue - 0.5029).abs() < 1e-3, "{blue}");
    assert_eq!(cloud.notes, ["2 normals are zero or not finite and count as missing"]);

    let floats = format!("{XYZ}property float red\nproperty float green\nproperty float blue\n");
    let body = "0 0 0 0.5 0 1\n1 0 0 0 0 0\n0 1 0 0 0 0\n0 0 1 0 0 0\n";
    assert_eq!(ply::read(&ascii("4", &floats, body)).unwrap().colors.unwrap()[0], [0.5, 0.0, 1.0]);
}

#[test]
fn p10_points_that_are_not_finite_are_dropped_and_counted() {
    let body = "0 0 0\n1 0 0\nnan 0 0\n0 1 0\n0 1e400 0\n0 0 1\n-nan(ind) 0 0\n";
    let cloud = ply::read(&ascii("7", XYZ, body)).unwrap();
    assert_eq!(cloud.points, four());
    assert_eq!(
        cloud.notes,
        ["3 points with coordinates that are not finite were dropped, the first is point 2"]
    );
}

#[test]
fn p5_data_after_the_last_point_are_noted() {
    let mut bytes = binary(false, "", &sphere(20));
    let at = bytes.len();
    bytes.extend([0; 12]);
    let cloud = ply::read(&bytes).unwrap();
    let note = format!("data after the last point, from byte {at}, were ignored: is the count too small?");
    assert_eq!(cloud.notes, [note]);
}

fn small_files() -> Vec<Vec<u8>> {
    let rows = sphere(60);
    let mut body = String::new();
    for [x, y, z] in &rows {
        writeln!(body, "{x} {y} {z}").unwrap();
    }
    vec![ascii("60", XYZ, &body), binary(false, "", &rows), binary(true, "", &rows)]
}

#[test]
fn p2_prefixes_are_refused_and_never_panic() {
    for bytes in small_files() {
        for end in (0..bytes.len() - 1).step_by(37) {
            assert!(ply::read(&bytes[..end]).is_err(), "{end} of {}", bytes.len());
        }
        assert_eq!(ply::read(&bytes).unwrap().points.len(), 60);
    }
}

#[test]
fn only_regular_files_that_exist_are_opened() {
    let dir = tempfile::tempdir().unwrap();
    let error = ply::read_path(dir.path()).unwrap_err();
    assert_eq!((error.to_string().as_str(), error.kind), ("this is a directory", CloudFault::Missing));
    let error = ply::read_path(&dir.path().join("none.ply")).unwrap_err();
    assert!(error.message.starts_with("cannot open: "), "{error}");
    #[cfg(unix)]
    assert_eq!(ply::read_path("/dev/zero".as_ref()).unwrap_err().message, "this is no regular file");
    let path = dir.path().join("a.ply");
    std::fs::write(&path, ascii("4", XYZ, FOUR)).unwrap();
    assert_eq!(ply::read_path(&path).unwrap(), ply::read(&ascii("4", XYZ, FOUR)).unwrap());
}

#[test]
fn scans_are_read_whole() {
    for (name, points) in
        [("bunny.ply", 34_834), ("lion.ply", 341_989), ("pump.ply", 155_201), ("dragon.ply", 437_645)]
    {
        let Some(path) = scan(name) else { return };
        let Cloud { points: read, normals, colors, notes, .. } = ply::read_path(&path).unwrap();
        assert_eq!(read.len(), points);
        assert_eq!(normals.is_some(), name != "pump.ply");
        assert_eq!(colors.is_some(), name == "lion.ply" || name == "pump.ply");
        assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn p18_a_sparse_file_of_terabytes_is_refused_before_it_is_read() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.ply");
    let count = 700_000_000_000_u64;
    let text = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{XYZ}end_header\n");
    std::fs::write(&path, &text).unwrap();
    let file = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    if file.set_len(text.len() as u64 + 12 * count).is_err() {
        println!("skipped: this file system has no files of 8 TB");
        return;
    }
    let error = ply::read_path(&path).unwrap_err();
    assert!(error.message.contains("more than the limit of 268435456"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn p19_strange_names_work_and_endless_ones_are_missing() {
    use std::os::unix::ffi::OsStrExt;
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(std::ffi::OsStr::from_bytes(b"scan\xff.ply"));
    std::fs::write(&path, ascii("4", XYZ, FOUR)).unwrap();
    assert_eq!(ply::read_path(&path).unwrap().points, four());
    let endless = dir.path().join("a/".repeat(3000));
    assert_eq!(ply::read_path(&endless).unwrap_err().kind, CloudFault::Missing);
}
