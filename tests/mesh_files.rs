//! Mesh files of every format and every kind of damage, and scenes that name them.

#[path = "cli_common/mod.rs"]
mod cli_common;
#[path = "mesh_common/mod.rs"]
mod mesh_common;
#[path = "spans_common/mod.rs"]
mod spans_common;

use cli_common::Folder;
use glam::{DVec3, dvec3};
use mesh_common::{cube, made};
use pss::geom::{Interval, Ray};
use pss::mesh::read;
use pss::num::hash::Stream;
use pss::solid::mesh::TriangleMesh;
use pss::solid::{Body, Scratch, Solid};
use spans_common::crossings;

fn ascii_ply((points, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> String {
    let head = "property double x\nproperty double y\nproperty double z\n";
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n{head}", points.len());
    text +=
        &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len());
    text += &points.iter().map(|p| format!("{} {} {}\n", p.x, p.y, p.z)).collect::<String>();
    text + &triangles.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n")).collect::<String>()
}

fn binary_ply((points, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<u8> {
    let head = "property float x\nproperty float y\nproperty float z\nproperty uchar red\n";
    let mut bytes =
        format!("ply\nformat binary_big_endian 1.0\nelement vertex {}\n{head}", points.len()).into_bytes();
    bytes.extend(
        format!(
            "element face {}\nproperty uchar flag\nproperty list uchar uint vertex_index\nend_header\n",
            triangles.len()
        )
        .bytes(),
    );
    for p in points {
        p.to_array().iter().for_each(|x| bytes.extend((*x as f32).to_be_bytes()));
        bytes.push(7);
    }
    for t in triangles {
        bytes.extend([1, 3]);
        t.iter().for_each(|i| bytes.extend(i.to_be_bytes()));
    }
    bytes
}

fn obj((points, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> String {
    let mut text = "# a mesh\no part\n".to_owned();
    text += &points.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect::<String>();
    text += "vn 0 0 1\r\n";
    text + &triangles
        .iter()
        .map(|[a, b, c]| {
            format!("f {}//1 {}//1 \\\n {}//1\n", a + 1, b + 1, i64::from(*c) - points.len() as i64)
        })
        .collect::<String>()
}

fn binary_stl((points, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes[..5].copy_from_slice(b"solid");
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for t in triangles {
        bytes.extend([0; 12]);
        t.iter()
            .flat_map(|i| points[*i as usize].to_array())
            .for_each(|x| bytes.extend((x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii_stl((points, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> String {
    let corner = |i: &u32| points[*i as usize];
    let facet = |t: &[u32; 3]| {
        let rows: String =
            t.iter().map(corner).map(|p| format!("vertex {} {} {}\n", p.x, p.y, p.z)).collect();
        format!("facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet\n")
    };
    format!("solid part\n{}endsolid part\n", triangles.iter().map(facet).collect::<String>())
}

fn all_files(mesh: &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.ply", ascii_ply(mesh).into_bytes()),
        ("b.ply", binary_ply(mesh)),
        ("c.obj", obj(mesh).into_bytes()),
        ("d.stl", binary_stl(mesh)),
        ("e.stl", ascii_stl(mesh).into_bytes()),
    ]
}

#[test]
fn every_format_gives_the_same_solid() {
    let shape = cube(DVec3::ZERO, dvec3(1.0, 2.0, 4.0));
    let ray = Ray::new(dvec3(-1.0, 0.3, 0.7), dvec3(1.0, 0.1, 0.2));
    let want = crossings(&made(shape.0.clone(), shape.1.clone()), &ray);
    for (name, bytes) in all_files(&shape) {
        let mesh = read(&bytes).unwrap_or_else(|e| panic!("{name} {e}"));
        assert_eq!((mesh.points.len(), mesh.triangles.len(), mesh.notes.len()), (8, 12, 0), "{name}");
        let solid = TriangleMesh::new(mesh);
        assert_eq!((solid.body(), solid.seams().unlike), (Body::Solid, 0), "{name}");
        let have = crossings(&solid, &ray);
        assert!(have.iter().zip(&want).all(|(a, b)| (a.t - b.t).abs() < 1e-13), "{name} {have:?} {want:?}");
    }
}

#[test]
fn polygons_are_cut_and_what_is_no_triangle_is_dropped_and_counted() {
    let quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv nan 0 0\n\
                 f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let mesh = read(quads.as_bytes()).unwrap();
    assert_eq!((mesh.points.len(), mesh.triangles.len(), mesh.notes.len()), (8, 12, 0));
    let damaged = format!("{quads}f 1 2 9\nf 1 2 2\nf 2 3 4\nf 2 4 3\n");
    let mesh = read(damaged.as_bytes()).unwrap();
    assert_eq!(mesh.triangles.len(), 12, "{:?}", mesh.notes);
    assert_eq!(mesh.notes.len(), 3, "{:?}", mesh.notes);
    assert!(
        mesh.notes.iter().any(|n| n.contains("not finite")) && mesh.notes.iter().any(|n| n.contains("twice"))
    );
}

#[test]
fn a_mesh_with_a_hole_is_a_sheet_and_tells_its_open_edges() {
    let (points, mut triangles) = cube(DVec3::ZERO, DVec3::ONE);
    triangles.pop();
    let folder = Folder::new();
    folder.write("open.ply", ascii_ply(&(points, triangles)));
    folder.write("cut.pss", "draw mesh(\"open.ply\") - sphere(r: 0.1)");
    let ran = folder.run(&["check", "cut.pss"]);
    let ran = if ran.code == 2 { folder.run(&["probe", "cut.pss", "--ray", "0,0,0 1,0,0"]) } else { ran };
    assert_eq!(ran.code, 65, "{}", ran.stderr);
    assert!(ran.stderr.contains("E0301") && ran.stderr.contains("3 open edges of 18"), "{}", ran.stderr);
    folder.write("sheet.pss", "draw mesh(\"open.ply\")");
    let ran = folder.run(&["probe", "sheet.pss", "--json", "--ray", "0.3,0.4,-1 0,0,1"]);
    let line = &ran.json_lines()[0];
    assert_eq!(
        (line["spans"].as_array().unwrap().len(), line["sheets"].as_array().unwrap().len()),
        (0, 2),
        "{line}"
    );
}

#[test]
fn a_scene_cuts_a_mesh_and_missing_or_refused_files_are_told() {
    let folder = Folder::new();
    folder.write("part.stl", binary_stl(&cube(-DVec3::ONE, DVec3::ONE)));
    folder.write("cut.pss", "draw mesh(\"part.stl\") - box([0, 0, 0], [2, 2, 2])");
    let ran = folder.run(&["probe", "cut.pss", "--json", "--ray", "-2,0.5,0.5 1,0,0"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let spans = ran.json_lines()[0]["spans"].clone();
    assert_eq!((spans[0]["enter"]["t"].as_f64(), spans[0]["exit"]["t"].as_f64()), (Some(1.0), Some(2.0)));
    for (text, code) in [("\"none.stl\"", 66), ("\"../part.stl\"", 77), ("\".\"", 66), ("\"cut.pss\"", 65)] {
        folder.write("bad.pss", format!("draw mesh({text})"));
        let ran = folder.run(&["probe", "bad.pss", "--ray", "0,0,0 1,0,0"]);
        assert_eq!(ran.code, code, "{text} {}", ran.stderr);
        assert!(ran.stderr.contains("E06") && ran.stderr.contains("bad.pss:1"), "{}", ran.stderr);
    }
    folder.write("given.pss", "param file: string = \"part.stl\"\ndraw mesh(file)");
    let path = format!("file={}", folder.path().join("part.stl").display());
    assert_eq!(folder.run(&["probe", "given.pss", "-D", &path, "--ray", "0,0,0 1,0,0"]).code, 0);
}

#[test]
fn damaged_files_are_refused_or_read_and_nothing_panics() {
    let shape = cube(DVec3::ZERO, DVec3::ONE);
    let ray = Ray::new(dvec3(-1.0, 0.3, 0.7), dvec3(1.0, 0.1, 0.2));
    let try_read = |bytes: &[u8]| {
        if let Ok(mesh) = read(bytes) {
            let solid = TriangleMesh::new(mesh);
            solid.crossings(&ray, Interval::ALL, &mut Scratch::default(), &mut Vec::new());
            return true;
        }
        false
    };
    let mut stream = Stream::new(7);
    for (name, bytes) in all_files(&shape) {
        assert!(try_read(&bytes), "{name}");
        let whole = (0..bytes.len()).filter(|n| try_read(&bytes[..*n])).count();
        // Text may lose its last end of line, an OBJ whole lines.
        assert!(name.ends_with("obj") || whole < 20, "{name}: {whole} truncations were read");
        for _ in 0..3000 {
            let mut damaged = bytes.clone();
            for _ in 0..=(3.0 * stream.unit()) as usize {
                let at = (stream.unit() * damaged.len() as f64) as usize;
                damaged[at] = (stream.unit() * 256.0) as u8;
            }
            try_read(&damaged);
        }
    }
    let huge = ascii_ply(&shape).replace("vertex 8", "vertex 4000000000000");
    assert!(read(huge.as_bytes()).is_err_and(|e| e.message.contains("truncated")));
    let huge = ascii_ply(&shape).replace("face 12", "face 4000000000000");
    assert!(read(huge.as_bytes()).is_err_and(|e| e.message.contains("truncated")));
    let mut many = binary_stl(&shape);
    many[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(read(&many).is_err_and(|e| e.message.contains("truncated")));
    for (text, word) in [
        ("v 0 0\n", "three numbers"),
        ("v 0 0 0\nf 1 2 3\n", "no vertex"),
        ("v 0 0 x\n", "no number"),
        ("", "empty"),
        ("hello\n", "not a mesh"),
        ("v 0 0 0\n", "no triangle"),
    ] {
        let told = read(text.as_bytes()).unwrap_err();
        assert!(told.to_string().contains(word), "{text:?} {told}");
    }
}
