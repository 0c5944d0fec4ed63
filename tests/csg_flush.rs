//! Flush faces: what two routes of rounding make of one face is one face, at any rotation and offset.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::frames::{each_frame, through};
use csg_support::scene::{shot, spans};
use glam::{DAffine3, DVec3};
use pss::csg::Scratch;
use pss::geom::{Interval, Ray};
use pss::shot::Shot;

fn lengths(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Vec<f64> {
    spans(shot, ray, scratch).iter().map(|s| s.interval().length()).collect()
}

/// The criterion, B1 and FEATURES 21, 28, 29: nothing closes the hole of a full-height cylinder, each operand
/// taking its own way to the same place.
#[test]
fn b1_cases_21_28_29_a_flush_through_hole_is_open_at_any_rotation_and_offset() {
    let mut scratch = Scratch::default();
    each_frame(|place, map| {
        let text = format!(
            "draw (box([-1, -1, -1], [1, 1, 1]) - cylinder(r: 0.5, h: 1).scale([1, 1, 2]).move([0, 0, -1])){place}
             draw (box([9, 9, -1], [11, 11, 1]){place} - cylinder(r: 0.5, from: [10, 10, -1], to: [10, 10, 1]){place})"
        );
        let shot = shot(&text);
        let mut draws = Draws::new(17);
        let mut inside = 0;
        let size = 24;
        for i in 0..size * size {
            let [u, v] = [i % size, i / size].map(|k| (2 * k + 1) as f64 / f64::from(size) - 1.0);
            let (x, y) = (u + draws.between(-0.03, 0.03), v + draws.between(-0.03, 0.03));
            let slant = 0.02 * draws.direction();
            for middle in [DVec3::ZERO, DVec3::new(10.0, 10.0, 0.0)] {
                let start = middle + DVec3::new(x, y, 3.0);
                let ray = through(map, start, start + DVec3::new(slant.x, slant.y, -6.0));
                let have = lengths(&shot, &ray, &mut scratch);
                // The box's margin apart, what passes is the hole.
                inside += i32::from(have.is_empty() && x.abs().max(y.abs()) < 0.95);
                let at =
                    |s: f64| ((x + s * slant.x).hypot(y + s * slant.y), (x.abs() + 0.02).max(y.abs() + 0.02));
                let (near, far) = (at(1.0 / 3.0), at(2.0 / 3.0));
                if near.0.max(far.0) < 0.5 - 1e-6 {
                    assert!(have.is_empty(), "film in the hole: {have:?} {place} {ray:?}");
                } else if 0.5 + 1e-6 < near.0.min(far.0) - 0.01 && near.1 < 1.0 {
                    assert!(have.len() == 1 && 0.2 < have[0], "no wall: {have:?} {place} {ray:?}");
                }
            }
        }
        let fraction = f64::from(inside) / f64::from(2 * size * size);
        assert!((fraction - std::f64::consts::PI / 16.0).abs() < 0.015, "{fraction} {place}");
    });
}

/// B2, B3, B5, B8 and FEATURES 22, 23, 25, 32: lengths on random rays along z are those of the closed form.
#[test]
fn b2_b3_b5_b8_cases_22_23_25_32_flush_faces_leave_no_films_and_no_walls() {
    let mut scratch = Scratch::default();
    type Truth = fn(f64, f64) -> Option<f64>;
    let scenes: [(&str, Truth); 6] = [
        ("box([0, 0, 0], [1, 1, 2]) - box([0.2, 0.2, 1], [0.8, 0.8, 2])", |x, y| {
            Some(if 0.2 < x.min(y) && x.max(y) < 0.8 { 1.0 } else { 2.0 })
        }),
        ("box([0, 0, 0], [1, 1, 1]) | box([0, 0, 1], [1, 1, 2])", |_, _| Some(2.0)),
        ("box([0, 0, 0], [1, 1, 1]) & box([0, 0, 1], [1, 1, 2])", |_, _| None),
        (
            "box([0, 0, 0], [1, 1, 1]) - box([0.3, 0.3, 0], [1.3, 1.3, 1]) - box([-0.3, -0.3, 0], [0.7, 0.7, 1])",
            |x, y| {
                let cut = (0.3 < x && 0.3 < y) || (x < 0.7 && y < 0.7);
                if cut { None } else { Some(1.0) }
            },
        ),
        ("box([0, 0, 0], [1, 1, 2]) - box([0, 0, 0], [1, 1, 0.7]) - box([0, 0, 0.7], [1, 1, 2])", |_, _| {
            None
        }),
        (
            "difference(box([0, 0, 0], [1, 1, 1]), [cylinder(r: 0.4, h: 1).move([0.5, 0.5, 0]), box([0, 0, 0], [0.5, 1, 1]), box([0.5, 0, 0], [1, 0.5, 1])])",
            |x, y| if x < 0.5 || y < 0.5 || (x - 0.5).hypot(y - 0.5) < 0.4 { None } else { Some(1.0) },
        ),
    ];
    let mut draws = Draws::new(5);
    each_frame(|place, map| {
        for (text, truth) in &scenes {
            let shot = shot(&format!("draw ({text}){place}"));
            for _ in 0..20 {
                let [x, y] = [0; 2].map(|_| draws.between(0.01, 0.99));
                let edges = [0.2, 0.3, 0.5, 0.7, 0.8];
                let near = |v: f64| edges.iter().any(|e| (v - e).abs() < 1e-3);
                if near(x) || near(y) || ((x - 0.5).hypot(y - 0.5) - 0.4).abs() < 1e-3 {
                    continue;
                }
                let ray = through(map, DVec3::new(x, y, 4.0), DVec3::new(x, y, 3.0));
                let have = lengths(&shot, &ray, &mut scratch);
                let want: Vec<f64> = truth(x, y).into_iter().collect();
                let close = have.iter().zip(&want).all(|(a, b)| (a - b).abs() < 1e-8);
                assert!(have.len() == want.len() && close, "{have:?} {want:?} {text}{place} {x} {y}");
            }
        }
    });
}

/// B7, A1, A2 and FEATURES 24, 30: each solid of the table, and a scan, against itself by another route.
#[test]
fn b7_cases_24_30_a_solid_and_itself_by_another_route() {
    let routes = [
        ("", ""),
        (".rotate_z(30deg).rotate_z(60deg)", ".rotate_z(90deg)"),
        (".rotate_x(20deg).rotate_x(25deg)", ".rotate_x(45deg)"),
        (".scale(3).scale(1 / 3)", ""),
        (".move([3.7, -1.3, 0.9]).move([-3.7, 1.3, -0.9])", ""),
        (".scale([-1, 1, 1]).scale([-1, 1, 1])", ""),
        (".scale([-1, 1, 1]).scale([1, -1, 1])", ".rotate_z(180deg)"),
        (".scale([2, 1, 0.5]).scale([0.5, 1, 2])", ""),
    ];
    let mut made: Vec<String> =
        pss::solid::table::PRIMITIVES.iter().map(|p| p.decl.example.to_owned()).collect();
    // Sheets, and what needs a file.
    made.retain(|e| !e.starts_with("plane") && !e.contains(".stl") && !e.contains(".png"));
    assert!(made.iter().any(|e| e.starts_with("points")));
    assert!(4 <= made.len());
    let mut scratch = Scratch::default();
    for solid in &made {
        for (route, (one, other)) in routes.into_iter().enumerate() {
            for at in ["", ".move([1000, -700, 300])", ".move([1000000, -700000, 300000])"] {
                let scan = solid.starts_with("points");
                if scan && (route != 2 || !at.is_empty()) {
                    continue;
                }
                let setting = format!("let a = {solid}{one}{at}\nlet b = {solid}{other}{at}\n");
                let of = |e: &str| shot(&format!("{setting}draw {e}"));
                let few = if scan { 1 } else { 9 };
                let none = ["a ^ b", "a - b", "b - a", "a - a", "a ^ a"].into_iter().take(2 * few);
                let empty: Vec<_> = none.map(|e| (e, of(e))).collect();
                let alone = of("a");
                let like = ["a | b", "a & b", "a | a"].into_iter().take(few);
                let same: Vec<_> = like.map(|e| (e, of(e))).collect();
                let middle = alone.world.bounds();
                let middle = if middle.is_finite() { middle.center() } else { DVec3::ZERO };
                let mut draws = Draws::new(9);
                let count = if scan { 12 } else { 60 };
                for _ in 0..count {
                    let target = middle + draws.unit() * draws.direction();
                    let ray = Ray::new(middle + 4.0 * draws.direction(), DVec3::ZERO);
                    let ray = Ray::new(ray.origin, target - ray.origin);
                    for (e, shot) in &empty {
                        let have = lengths(shot, &ray, &mut scratch);
                        assert!(have.is_empty(), "{e} {have:?}\n{setting}{ray:?}");
                    }
                    let want = lengths(&alone, &ray, &mut scratch);
                    for (e, shot) in &same {
                        let have = lengths(shot, &ray, &mut scratch);
                        let close = have.iter().zip(&want).all(|(a, b)| a == b || (a - b).abs() < 1e-7);
                        assert!(have.len() == want.len() && close, "{e} {have:?} {want:?}\n{setting}{ray:?}");
                    }
                }
            }
        }
    }
}

/// The material's and the leaf's name at the first surface of jittered rays down z about (x, y).
fn seen(shot: &Shot, map: &DAffine3, x: f64, y: f64, scratch: &mut Scratch) -> Vec<(u32, String)> {
    let mut draws = Draws::new(3);
    let mut found: Vec<(u32, String)> = Vec::new();
    for _ in 0..100 {
        let start = DVec3::new(x + draws.between(-0.01, 0.01), y + draws.between(-0.01, 0.01), 5.0);
        let slant = 0.1 * draws.direction();
        let ray = through(map, start, start + DVec3::new(0.1 * slant.x, 0.1 * slant.y, -2.0));
        if let Some(hit) = shot.world.first(&ray, Interval::AHEAD, scratch) {
            let material = shot.world.surface(&ray, &hit).material;
            found.push((material, shot.world.leaf_name(&hit).to_owned()));
        }
    }
    found.sort();
    found.dedup();
    found
}

const INKS: &str =
    "material red(color: #ff0000)\nmaterial green(color: #00ff00)\nmaterial blue(color: #0000ff)\n";

/// B19 and FEATURES 34: of two materials on one face the first written, wherever the rays land.
#[test]
fn b19_case_34_the_owner_of_a_flush_face_is_stable() {
    let mut scratch = Scratch::default();
    each_frame(|place, map| {
        let text = format!(
            "{INKS}let a = box([0, 0, 0], [2, 2, 1]).with(red)
             let b = box(size: 1).scale(2).move([2, 1, 0]).with(green)
             draw (b | a){place}"
        );
        let shot = shot(&text);
        let both = seen(&shot, map, 1.5, 0.5, &mut scratch);
        assert_eq!(both.len(), 1, "{both:?} {place}");
        assert_eq!(both[0].0, 0, "{both:?} {place}");
        assert_eq!(seen(&shot, map, 2.5, 0.5, &mut scratch)[0].0, 1);
    });
}

/// A leaf that is cut away at a face has no part in it, even if its own face lies there and it was written first;
/// nor does it fill what it does not hold.
#[test]
fn a_leaf_cut_away_neither_owns_nor_fills_a_face() {
    let mut scratch = Scratch::default();
    let identity = DAffine3::IDENTITY;
    let text = format!(
        "{INKS}let slab = box([-9, -9, -9], [9, 9, 1]).with(green) & box([5, 5, -9], [6, 6, 9])
         draw slab
         draw box([0, 0, 0], [2, 2, 1]).with(red)"
    );
    assert_eq!(seen(&shot(&text), &identity, 1.0, 1.0, &mut scratch)[0].0, 0);
    let text = format!(
        "{INKS}draw box([0, 0, 0], [2, 2, 2]).with(red) - box([0, 0, 1], [2, 2, 2])
         draw box([-9, -9, -9], [9, 9, 9]).with(green) & box([5, 5, -9], [6, 6, 9])"
    );
    assert_eq!(seen(&shot(&text), &identity, 1.0, 1.0, &mut scratch)[0].0, 0);
}

/// Cut faces show the cutter's material; a cutter without one shows what it was cut from, also under a `.with` above.
#[test]
fn cut_faces_show_the_cutters_material_or_the_fillers() {
    let mut scratch = Scratch::default();
    let body = "box([0, 0, 0], [2, 2, 2])";
    let tool = "box([-1, -1, 1], [1, 3, 3])";
    let cases = [
        (format!("{body}.with(red) - {tool}.with(blue)"), 2),
        (format!("{body}.with(red) - {tool}"), 0),
        (format!("({body} - {tool}).with(green)"), 1),
        (format!("({body}.with(red) - {tool}.with(blue)).with(green)"), 2),
        (format!("({body}.with(red) | box([0, 0, 0], [2, 2, 1.5]).with(green)) - {tool}"), 1),
        (format!("{body} - {tool}"), 3),
    ];
    for (text, want) in cases {
        let shot = shot(&format!("{INKS}draw {text}"));
        let found = seen(&shot, &DAffine3::IDENTITY, 0.5, 1.0, &mut scratch);
        assert_eq!(found.len(), 1, "{text} {found:?}");
        assert_eq!(found[0].0, want, "{text} {found:?}");
    }
}
