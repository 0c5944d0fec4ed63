//! `mesh`: parity on closed meshes, with all triangles one by one, the winding number and tetrahedra as oracles.

#[path = "mesh_common/mod.rs"]
mod mesh_common;
#[path = "spans_common/mod.rs"]
mod spans_common;

use std::f64::consts::PI;

use glam::{DVec3, dvec3};
use mesh_common::{cube, made};
use pss::geom::{Aabb, Ray};
use pss::num::hash::Stream;
use pss::solid::block::Block;
use pss::solid::{Body, Scratch, Solid};
use spans_common::{assert_is_box, crossings};

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
    assert_is_box(&mesh, &block, 40_000, 2.5, 1e-13, |_, _, _| ());
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

/// How far a point is from a triangle: the nearest of its inside, its edges and its corners (brute force).
fn distance([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let normal = (b - a).cross(c - a);
    let within =
        [[a, b], [b, c], [c, a]].iter().all(|[from, to]| 0.0 < normal.dot((to - from).cross(p - from)));
    let flat = if within { (p - a).dot(normal.normalize()).abs() } else { f64::INFINITY };
    let edge = |[from, to]: [DVec3; 2]| {
        let t = ((p - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        p.distance(from + t * (to - from))
    };
    [[a, b], [b, c], [c, a]].map(edge).into_iter().fold(flat, f64::min)
}

/// A bowl with a hole in its bottom, a fin of no width, and a part apart: what is nearer than half the thickness is inside.
#[test]
fn an_open_mesh_with_a_thickness_is_all_points_so_near_to_it() {
    let (mut points, triangles) = sphere(2);
    let mut triangles: Vec<[u32; 3]> = triangles
        .into_iter()
        .filter(|t| t.iter().all(|i| points[*i as usize].z <= 0.3 && -0.95 < points[*i as usize].z))
        .collect();
    let first = points.len() as u32;
    points.extend([dvec3(2.0, 0.0, 0.0), dvec3(2.0, 1.0, 0.0), dvec3(2.0, 0.5, 0.0), dvec3(2.0, 0.0, 1.0)]);
    triangles.extend([[first, first + 1, first + 2], [first, first + 1, first + 3]]);
    let mesh = made(points.clone(), triangles.clone());
    assert_eq!(mesh.body(), Body::Sheet);
    let radius = 0.07;
    let thick = mesh.thickened(2.0 * radius).unwrap();
    assert_eq!(thick.body(), Body::Solid);
    let near = |p: DVec3| {
        triangles.iter().map(|t| distance(t.map(|i| points[i as usize]), p)).fold(f64::INFINITY, f64::min)
    };
    let (mut stream, mut scratch, mut met) = (Stream::new(9), Scratch::default(), 0);
    for i in 0..4000 {
        let far = [0.0, 1e6][i % 2];
        let ray = Ray::chord(&mut stream, dvec3(0.7, 0.0, 0.0), 2.2);
        let ray = Ray { origin: ray.origin - far * ray.dir.normalize(), dir: ray.dir };
        let found = crossings(&*thick, &ray);
        // The roundings of an origin so far away.
        let room = 1e-12 + far * 1e-15;
        for c in &found {
            let p = ray.at(c.t);
            assert!((near(p) - radius).abs() < room, "{} {ray:?}", near(p) - radius);
            let normal = thick.normal(&ray, c, &mut scratch);
            assert!((normal.length() - 1.0).abs() < 1e-12 && (normal.dot(ray.dir) < 0.0) == c.entering);
            assert!(radius < near(p + 1e-6 * normal) && near(p - 1e-6 * normal) < radius);
            met += 1;
        }
        let ends: Vec<f64> = found.iter().map(|c| c.t).collect();
        for w in ends.windows(2) {
            let middle = near(ray.at(0.5 * (w[0] + w[1])));
            let inside = found.iter().take_while(|c| c.t <= w[0]).last().unwrap().entering;
            assert_eq!(inside, middle < radius, "{ray:?}");
        }
        let place = ray.at(stream.unit() * 4.0 / ray.dir.length() + far / ray.dir.length());
        let t = (place - ray.origin).dot(ray.dir) / ray.dir.length_squared();
        let inside = found.iter().take_while(|c| c.t < t).last().is_some_and(|c| c.entering);
        assert!(inside == (near(ray.at(t)) < radius) || (near(ray.at(t)) - radius).abs() < 2.0 * room);
    }
    assert!(1500 < met, "{met}");
    let bounds = thick.extent_under(&glam::DAffine3::IDENTITY);
    assert!((bounds.max.z - (1.0 + radius)).abs() < 1e-12 && (bounds.max.x - (2.0 + radius)).abs() < 1e-12);
    assert!(made(cube(DVec3::ZERO, DVec3::ONE).0, cube(DVec3::ZERO, DVec3::ONE).1).thickened(0.1).is_none());
}
