//! What a file that is no PLY looks like, from its first bytes.

/// Names the format that `head`, the first bytes of a file, belongs to, with the way to turn it into a PLY.
pub fn looks_like(head: &[u8]) -> Option<(&'static str, &'static str)> {
    const MAGIC: [(&[u8], &str, &str); 12] = [
        (b"\x1f\x8b", "a gzip file", "unpack it first: gunzip FILE"),
        (b"PK\x03\x04", "a zip file", "unpack it first: unzip FILE"),
        (b"\x28\xb5\x2f\xfd", "a zstd file", "unpack it first: zstd -d FILE"),
        (b"LASF", "a LAS or LAZ file", CONVERT),
        (b"ASTM-E57", "an E57 file", CONVERT),
        (b"# .PCD", "a PCD file", CONVERT),
        (b"VERSION .7", "a PCD file", CONVERT),
        (b"# .pcd", "a PCD file", CONVERT),
        (b"solid ", "an STL file", "an STL holds triangles, no samples: export the points as PLY"),
        (b"glTF", "a glTF file", CONVERT),
        (b"OFF", "an OFF file", CONVERT),
        (b"\x89PNG", "a PNG image", "give a point cloud in PLY format"),
    ];
    let known = MAGIC.iter().find(|(magic, ..)| head.starts_with(magic));
    known.map(|&(_, name, help)| (name, help)).or_else(|| is_obj(head).then_some(("an OBJ file", CONVERT)))
}

const CONVERT: &str = "convert it to PLY";

/// Whether the first line that is neither blank nor a comment begins with a keyword of OBJ.
fn is_obj(head: &[u8]) -> bool {
    let lines = head.split(|&b| b == b'\n' || b == b'\r').map(<[u8]>::trim_ascii);
    let mut words = lines.filter(|line| !line.is_empty() && line[0] != b'#');
    let first = words.next().unwrap_or_default();
    [b"v ".as_slice(), b"vn ", b"vt ", b"mtllib ", b"o ", b"g "].iter().any(|key| first.starts_with(key))
}
