//! `mesh`: parity on closed meshes, all triangles one by one as an oracle, and files of every kind of damage.

#[path = "cli_common/mod.rs"]
mod cli_common;

use std::f64::consts::PI;

use cli_common::Folder;
use glam::{DVec3, dvec3};
use pss::geom::{Aabb, Interval, Ray};
use pss::mesh::{Mesh, read};
use pss::num::hash::Stream;
use pss::solid::block::Block;
use pss::solid::mesh::TriangleMesh;
use pss::solid::{Body, Crossing, Scratch, Solid};

fn crossings(solid: &dyn Solid, ray: &Ray) -> Vec<Crossing> {
    let mut out = Vec::new();
    solid.crossings(ray, Interval::ALL, &mut Scratch::default(), &mut out);
    assert!(out.len().is_multiple_of(2), "{out:?} {ray:?}");
    for (i, c) in out.iter().enumerate() {
        assert!(c.t.is_finite() && c.entering == (i % 2 == 0), "{out:?} {ray:?}");
    }
    assert!(out.windows(2).all(|w| w[0].t < w[1].t), "{out:?} {ray:?}");
    out
}

fn made(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(Mesh { points, triangles, notes: Vec::new() })
}

fn cube(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let points = Aabb { min: low, max: high }.corners().to_vec();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    (points, triangles)
}

/// A sphere, an octahedron halved so often, its triangles all round the same way.
fn sphere(levels: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut points = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let mut triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut known = std::collections::HashMap::new();
        let mut middle = |a: u32, b: u32, points: &mut Vec<DVec3>| {
            *known.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        let split = |t: &[u32; 3]| {
            let [a, b, c] = *t;
            let (x, y, z) = (middle(a, b, &mut points), middle(b, c, &mut points), middle(c, a, &mut points));
            [[a, x, z], [x, b, y], [z, y, c], [x, y, z]]
        };
        triangles = triangles.iter().flat_map(split).collect();
    }
    (points, triangles)
}

/// Six times the volume, as signed tetrahedra about the origin.
fn six_volumes(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let at = |i: u32| points[i as usize];
    triangles.iter().map(|[a, b, c]| at(*a).dot(at(*b).cross(at(*c)))).sum()
}

/// How often a mesh winds about a point (Van Oosterom and Strackee 1983).
fn winding(points: &[DVec3], triangles: &[[u32; 3]], p: DVec3) -> f64 {
    let angle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| points[i as usize] - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

#[test]
fn a_mesh_of_a_cube_is_a_box_also_in_its_faces_and_edges() {
    let block = Block(Aabb { min: dvec3(-1.0, 0.0, 0.0), max: dvec3(2.0, 1.0, 3.0) });
    let (points, triangles) = cube(block.0.min, block.0.max);
    let mesh = made(points, triangles);
    assert_eq!(mesh.body(), Body::Solid);
    let mut stream = Stream::new(1);
    let mut hits = 0;
    for i in 0..40_000 {
        let ray = if i % 2 == 0 {
            Ray::chord(&mut stream, block.0.center(), 2.5)
        } else {
            let mut whole = || (stream.unit() * 5.0).floor() - 2.0;
            let origin = dvec3(whole(), whole(), whole());
            let step = |x: f64| x.rem_euclid(3.0) - 1.0;
            let dir = dvec3(step(whole()), step(whole()), step(whole()));
            if dir == DVec3::ZERO {
                continue;
            }
            Ray::new(origin, dir)
        };
        let (have, want) = (crossings(&mesh, &ray), crossings(&block, &ray));
        assert_eq!(have.len(), want.len(), "{ray:?} {have:?} {want:?}");
        hits += want.len();
        for (a, b) in have.iter().zip(&want) {
            assert!((a.t - b.t).abs() <= 1e-13 * (1.0 + b.t.abs()), "{ray:?} {a:?} {b:?}");
        }
    }
    assert!(10_000 < hits);
}

#[test]
fn no_ray_slips_through_an_edge_or_a_corner_of_a_closed_mesh() {
    let (points, triangles) = sphere(4);
    let mesh = made(points.clone(), triangles.clone());
    let mut stream = Stream::new(2);
    for i in 0..60_000 {
        let [a, b, c] =
            triangles[(stream.unit() * triangles.len() as f64) as usize].map(|i| points[i as usize]);
        let target = match i % 4 {
            0 => a,
            1 => 0.5 * (a + b),
            2 => a + stream.unit() * (b - a),
            _ => a + 0.5 * stream.unit() * (b - a) + 0.5 * stream.unit() * (c - a),
        };
        let dir = match i % 5 {
            // Along an edge, towards the middle, towards another corner, anywhere.
            0 => b - a,
            1 => -target,
            2 => points[(stream.unit() * points.len() as f64) as usize] - target,
            _ => stream.direction(),
        };
        if dir == DVec3::ZERO {
            continue;
        }
        let far = if i % 7 == 0 { 1e7 } else { 2.0 };
        let ray = Ray::new(target - far * dir.normalize(), dir);
        let found = crossings(&mesh, &ray);
        if i % 5 == 1 && far == 2.0 {
            assert_eq!(found.len(), 2, "{ray:?} {found:?}");
            let length = (found[1].t - found[0].t) * dir.length();
            assert!((length - 2.0).abs() < 0.01, "{length}");
        }
    }
}

#[test]
fn the_hierarchy_answers_what_all_triangles_answer() {
    let (points, triangles) = sphere(3);
    let mesh = made(points.clone(), triangles.clone());
    let mut stream = Stream::new(3);
    let mut hits = 0;
    for _ in 0..5000 {
        let ray = Ray::chord(&mut stream, DVec3::ZERO, 1.4);
        // Moeller and Trumbore's test, each triangle by itself; unsure near edges.
        let (mut want, mut unsure) = (Vec::new(), false);
        for t in &triangles {
            let [a, b, c] = t.map(|i| points[i as usize]);
            let (e, f) = (b - a, c - a);
            let p = ray.dir.cross(f);
            let det = e.dot(p);
            let s = ray.origin - a;
            let q = s.cross(e);
            let (u, v) = (s.dot(p) / det, ray.dir.dot(q) / det);
            let least = u.min(v).min(1.0 - u - v);
            unsure |= least.abs() < 1e-9 || det.abs() < 1e-9;
            if 0.0 < least {
                want.push(f.dot(q) / det);
            }
        }
        if unsure {
            continue;
        }
        want.sort_by(f64::total_cmp);
        let have: Vec<f64> = crossings(&mesh, &ray).iter().map(|c| c.t).collect();
        hits += have.len();
        let close = have.iter().zip(&want).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(have.len() == want.len() && close, "{have:?} {want:?} {ray:?}");
    }
    assert!(3000 < hits);
}

#[test]
fn states_at_mid_points_are_those_of_the_winding_number_however_triangles_face() {
    // Two spheres apart and a cube within one of them, which is a hollow; every other triangle turned round.
    let (mut points, mut triangles) = sphere(2);
    for (more, of, by, size) in
        [(sphere(2), 2, dvec3(3.0, 0.0, 0.0), 1.0), (cube(-DVec3::ONE, DVec3::ONE), 1, DVec3::ZERO, 0.3)]
    {
        let first = points.len() as u32;
        points.extend(more.0.iter().map(|p| size * *p + by));
        triangles.extend(more.1.iter().map(|t| t.map(|i| i + first)));
        assert!(0 < of);
    }
    let facing = triangles.clone();
    for t in triangles.iter_mut().step_by(2) {
        t.swap(0, 1);
    }
    let mesh = made(points.clone(), triangles);
    assert_eq!(mesh.body(), Body::Solid);
    assert!(0 < mesh.seams().unlike);
    let mut stream = Stream::new(4);
    let mut spans = 0;
    for _ in 0..500 {
        let ray = Ray::chord(&mut stream, dvec3(1.5, 0.0, 0.0), 3.0);
        let found = crossings(&mesh, &ray);
        for pair in found.windows(2).filter(|w| 1e-6 < w[1].t - w[0].t) {
            let p = ray.at(0.5 * (pair[0].t + pair[1].t));
            let odd = winding(&points, &facing, p).round().rem_euclid(2.0) == 1.0;
            assert_eq!(odd, pair[0].entering, "{p} {ray:?}");
            spans += 1;
        }
        for c in &found {
            let n = mesh.normal(&ray, c, &mut Scratch::default());
            assert!((n.length() - 1.0).abs() < 1e-12 && (n.dot(ray.dir) < 0.0) == c.entering);
        }
    }
    assert!(100 < spans);
}

#[test]
fn the_volume_by_chords_is_that_of_the_tetrahedra() {
    let (points, triangles) = sphere(3);
    let want = six_volumes(&points, &triangles).abs() / 6.0;
    let mesh = made(points, triangles);
    // Chords uniform in the measure of lines: mean length over the sphere's is the share of the volume.
    let (radius, count) = (1.2, 60_000);
    let mut stream = Stream::new(5);
    let (mut inside, mut whole) = (0.0, 0.0);
    for _ in 0..count {
        let ray = Ray::chord(&mut stream, DVec3::ZERO, radius);
        whole += ray.dir.length();
        inside += crossings(&mesh, &ray).chunks(2).map(|c| (c[1].t - c[0].t) * ray.dir.length()).sum::<f64>();
    }
    let have = inside / whole * 4.0 / 3.0 * PI * radius.powi(3);
    assert!((have / want - 1.0).abs() < 0.01, "{have} {want}");
}

#[test]
fn d1_scaling_by_a_power_of_two_and_both_zeros_change_no_bit() {
    let (points, triangles) = sphere(2);
    let mesh = made(points.clone(), triangles.clone());
    let mut stream = Stream::new(6);
    for s in [2f64.powi(-20), 2f64.powi(20)] {
        let large = made(points.iter().map(|p| s * *p).collect(), triangles.clone());
        for i in 0..500 {
            let ray = Ray::chord(&mut stream, DVec3::ZERO, 1.4);
            // Every second one through corners, from a corner along an axis.
            let ray = if i % 2 == 0 {
                ray
            } else {
                Ray::new(points[i % points.len()], dvec3(1.0, f64::from(i as u32 % 3) - 1.0, 0.0))
            };
            let found = crossings(&mesh, &ray);
            assert_eq!(crossings(&large, &Ray::new(s * ray.origin, s * ray.dir)), found);
            let minus = |v: DVec3| v.map(|x| if x == 0.0 { -0.0 } else { x });
            assert_eq!(crossings(&mesh, &Ray { origin: minus(ray.origin), dir: minus(ray.dir) }), found);
        }
    }
}

// Files.

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

#[test]
fn a_large_mesh_costs_little_more_than_a_small_one() {
    let time = |levels| {
        let (points, triangles) = sphere(levels);
        let mesh = made(points, triangles);
        let mut stream = Stream::new(8);
        let rays: Vec<Ray> = (0..20_000).map(|_| Ray::chord(&mut stream, DVec3::ZERO, 1.2)).collect();
        let began = std::time::Instant::now();
        let count: usize = rays.iter().map(|r| crossings(&mesh, r).len()).sum();
        assert!(20_000 < count);
        began.elapsed().as_secs_f64() / rays.len() as f64
    };
    let (small, large) = (time(2), time(7));
    eprintln!("a ray: {:.2} us at 128 triangles, {:.2} us at 131,072", 1e6 * small, 1e6 * large);
    assert!(large < 30.0 * small, "{small} {large}");
}
