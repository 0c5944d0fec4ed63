//! What `pss check` finds in parts of what is drawn: what is nothing, too thin to be meant, apart, or small; letter by letter.

#[macro_use]
mod check_support;

use pss::prepare::{self, Options};
use pss::source::SourceMap;

finds! {
    an_intersection_or_difference_in_a_union_that_is_nothing_is_told: "draw sphere(r: 1) | (sphere(r: 1, at: [3,0,0]) & sphere(r: 1, at: [6,0,0]))\n",
    r#"
warning[W0123]: nothing is left of this part of what is drawn
 --> scene.pss:1:22
  |
1 | draw sphere(r: 1) | (sphere(r: 1, at: [3,0,0]) & sphere(r: 1, at: [6,0,0]))
  |                      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything of it
  = help: look at the sizes and places of its operands: do they meet, are they the same?
"#
}

finds! {
    a_shape_and_itself_in_a_union_are_told: "let a = sphere(r: 1)\ndraw box(size: 1, at: [4,0,0]) | (a ^ a)\n",
    r#"
note[W0121]: faces of copies of `a` coincide
 --> scene.pss:1:9
  |
1 | let a = sphere(r: 1)
  |         ^^^^^^^^^^^^ these
  = help: copies that touch are one solid; a copy that shall cut through another must stand out of it

warning[W0123]: nothing is left of this part of what is drawn
 --> scene.pss:2:35
  |
2 | draw box(size: 1, at: [4,0,0]) | (a ^ a)
  |                                   ^^^^^ no test line finds anything of it
  = help: look at the sizes and places of its operands: do they meet, are they the same?
"#
}

finds! {
    a_clip_of_nothing_beside_another_sheet_is_told: "draw sphere(r: 1).clip(box(size: 1, at: [9,0,0])) | plane(z: -1)\n",
    r#"
warning[W0123]: nothing of what is clipped is inside what clips it
 --> scene.pss:1:24
  |
1 | draw sphere(r: 1).clip(box(size: 1, at: [9,0,0])) | plane(z: -1)
  |                        ^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything of it
  = help: move the one to where it meets the other, or leave the clip out
"#
}

finds! {
    skins_that_the_clean_up_leaves_are_told: "draw box([0,0,0],[1,1,1]) - box([-1,-1,-1],[2,2,0.999999999999])\ndraw box([5,0,0],[6,1,1]) | box([6.0000000000005,0,0],[7,1,1])\n",
    r#"
warning[W0125]: what is left between `box` and `box` is thinner than a billionth of their size
 --> scene.pss:1:29
  |
1 | draw box([0,0,0],[1,1,1]) - box([-1,-1,-1],[2,2,0.999999999999])
  |      --------------------   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ left at this
  |      |
  |      and this
  = help: make it thicker, or let the one stand out of the other

warning[W0125]: the gap between `box` and `box` is thinner than a billionth of their size
 --> scene.pss:2:29
  |
2 | draw box([5,0,0],[6,1,1]) | box([6.0000000000005,0,0],[7,1,1])
  |      --------------------   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ open at this
  |      |
  |      and this
  = help: make it wider, or let the one reach into the other
"#
}

finds! {
    a_part_of_a_cutter_that_misses_is_told: "draw sphere(r: 1) - (sphere(r: 0.3, at: [1,0,0]) | sphere(r: 0.3, at: [0.95,0.95,0]))\n",
    r#"
warning[W0122]: this part of a cutter cuts nothing
 --> scene.pss:1:52
  |
1 | draw sphere(r: 1) - (sphere(r: 0.3, at: [1,0,0]) | sphere(r: 0.3, at: [0.95,0.95,0]))
  |      ------------ from this                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    copies_of_a_cutter_that_miss_though_boxes_meet_are_told: "draw sphere(r: 1) - sphere(r: 0.2).array([[1,0,0], [0.9,0.9,0], [0,1,0], [0,0.9,-0.9]])\n",
    r#"
warning[W0122]: 2 of the 4 copies of this cutter cut nothing
 --> scene.pss:1:21
  |
1 | draw sphere(r: 1) - sphere(r: 0.2).array([[1,0,0], [0.9,0.9,0], [0,1,0], [0,0.9,-0.9]])
  |                     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ the one about [0.9, 0.9, 0] takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    parts_of_a_cutter_that_overlap_are_no_reason_for_doubt:
        "draw box(size: 2) - (cylinder(r: 0.3, from: [0,0,-2], to: [0,0,2]) | cylinder(r: 0.3, from: [0,-2,0], to: [0,2,0]) | sphere(r: 0.2, at: [0,0,0.9]))\n"
}

finds! {
    a_part_of_a_cutter_that_takes_but_a_corner_is_no_reason_for_doubt:
        "draw box(size: 2) - (sphere(r: 0.5) | sphere(r: 1, at: [1.57,1.57,1.57]))\n"
}

finds! {
    copies_of_a_cutter_that_are_apart_are_told: "draw box([0,0,0],[10,1,1]) - cylinder(r: 0.2, from: [0.5,0.5,-1], to: [0.5,0.5,2]).array([[0,0,0],[3,0,0],[12,0,0],[6,0,0]])\n",
    r#"
warning[W0122]: one of the 4 copies of this cutter cuts nothing
 --> scene.pss:1:30
  |
1 | draw box([0,0,0],[10,1,1]) - cylinder(r: 0.2, from: [0.5,0.5,-1], to: [0.5,0.5,2]).array([[0,0,0],[3,0,0],[12,0,0],[6,0,0]])
  |                              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ the one about [12.5, 0.5, 0.5] takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    a_small_shared_face_is_seen: "draw box([0,0,0],[10,10,1])\ndraw box([3,3,1],[3.05,3.05,2])\n",
    r#"
note[W0121]: faces of `box` and `box` coincide
 --> scene.pss:2:6
  |
1 | draw box([0,0,0],[10,10,1])
  |      ---------------------- and this one
2 | draw box([3,3,1],[3.05,3.05,2])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts
"#
}

finds! {
    parts_that_meet_are_not_told: "draw sphere(r: 1) & sphere(r: 1, at: [1.5,0,0])\ndraw (box(size: 2, at: [5,0,0]) & sphere(r: 1.2, at: [5,0,0])) - cylinder(r: 0.3, from: [5,0,-2], to: [5,0,2])\ndraw sphere(r: 1, at: [0, 0, 4]) | (half_space(z < 3) & box(size: 1, at: [0,0,3]))\n",
    r#""#
}

finds! { a_moved_cube_of_half_spaces_is_seen: "draw (half_space(x>0)&half_space(x<1)&half_space(y>0)&half_space(y<1)&half_space(z>0)&half_space(z<1)).move([100,0,0])\n" }

finds! { a_moved_cylinder_of_a_quadric_is_seen: "draw (quadric(squares:[1,1,0],constant:-1) & half_space(z>0) & half_space(z<1)).move([50,20,10])\n" }

finds! { a_small_cube_of_half_spaces_is_seen: "draw (half_space(x>0)&half_space(x<0.001)&half_space(y>0)&half_space(y<0.001)&half_space(z>0)&half_space(z<0.001))\n" }

finds! { a_cube_as_a_complement_is_seen: "draw !(half_space(x<100)|half_space(x>101)|half_space(y<0)|half_space(y>1)|half_space(z<0)|half_space(z>1))\n" }

finds! { the_tip_of_a_cone_is_seen: "draw cone(r1:1,r2:0,h:1) & half_space(z>0.95)\n" }

finds! { a_cut_tip_is_seen: "draw cone(r1:1,r2:0,h:1) - half_space(z>0.999)\n" }

finds! { a_cut_cap_is_seen: "draw sphere(r:1) - half_space(z>0.999)\n" }

finds! { a_cap_of_a_thousandth_is_seen: "draw sphere(r:1) & half_space(z>0.999999)\n" }

finds! { a_thin_ring_is_seen: "draw torus(major:5,minor:1) & half_space(z>0.9999999)\n" }

finds! { a_corner_cube_is_seen: "draw intersection([box(size:2), half_space(x>0.97), half_space(y>0.97), half_space(z>0.97)])\n" }

finds! { a_cut_corner_is_seen: "draw box(size:2) - (half_space(x>0.97)&half_space(y>0.97)&half_space(z>0.97))\n" }

finds! { a_corner_behind_an_oblique_plane_is_seen: "draw box(size:2) & half_space(normal:[-1,-1,-1],at:[0.999,0.999,0.999])\n" }

finds! { a_tip_of_an_extrusion_is_seen: "draw extrude([[0,0],[1,0],[1,1]], h:1, scale:0) & box([-1,-1,0.99],[1,1,2])\n" }

finds! { a_cut_tip_of_an_extrusion_is_seen: "draw extrude([[0,0],[1,0],[1,1]], h:1, scale:0) - box([-1,-1,0.999],[1,1,2])\n" }

finds! { a_groove_of_a_hundred_millionth_is_seen: "draw torus(major:1,minor:0.2) - cylinder(r:0.80000001, from:[0,0,-2], to:[0,0,2])\n" }

finds! { an_apex_is_no_film: "draw cone(r1:1,r2:0,h:1) & box([-1,-1,0.9999],[1,1,2])\n" }

finds! { a_small_tip_is_no_film: "draw cone(r1:1,r2:0,h:1) & box([-1,-1,0.999999],[1,1,2])\n" }

finds! { a_complement_of_a_complement_is_seen: "draw !(!box([100,0,0],[101,1,1]))\n" }

/// What does not meet, by little, is told all the same.
#[test]
fn what_stops_short_is_told() {
    for (scene, code) in [
        ("draw sphere(r: 1) - half_space(z > 1.0001)", "W0122"),
        ("draw sphere(r: 1) & half_space(z > 1.0001)", "W0123"),
        ("draw box(size: 2) & half_space(normal: [-1, -1, -1], at: [1.001, 1.001, 1.001])", "W0123"),
        ("draw sphere(r: 1) - cylinder(r: 0.2, from: [0, 0, 1.00001], to: [0, 0, 3])", "W0122"),
        ("draw box(size: 1).rotate_x(30deg).rotate_y(40deg) & half_space(z > 0.8447)", "W0123"),
        ("draw torus(major: 1, minor: 0.2) - cylinder(r: 0.7999, from: [0, 0, -2], to: [0, 0, 2])", "W0122"),
        ("draw sphere(r: 1)\ndraw half_space(z > 0.999)", "W0126"),
    ] {
        let found = check_support::findings(scene);
        assert!(found.starts_with(&format!("warning[{code}]")), "{scene}\n{found}");
        assert_eq!(found.matches("warning[").count(), 1, "{scene}\n{found}");
    }
}

/// Hundreds of copies at one place, and shells in shells, are looked at in a bounded number of steps, and told as few are.
#[test]
fn many_faces_at_one_place_are_told_as_few_are() {
    let copies = |n: usize| format!("let s = sphere(r: 1)\ndraw union([{}])\n", vec!["s"; n].join(", "));
    let told = |scene: &str| check_support::findings(scene).lines().next().unwrap_or_default().to_owned();
    assert_eq!(told(&copies(400)), told(&copies(3)));
    let shells = |n: usize| {
        let more = (2..=n).map(|i| format!("let s{i} = sphere(r: {i}) - s{}\n", i - 1));
        format!("let s1 = sphere(r: 1)\n{}draw s{n}\n", more.collect::<String>())
    };
    assert_eq!(check_support::findings(&shells(150)), "");
}

/// A shape without thickness is told where it was written, once, whatever its arguments are.
#[test]
fn shapes_without_a_thickness_are_told() {
    for call in [
        "box([0, 0, 0], [1, 1, 0])",
        "cone(r1: 0, r2: 0, h: 1)",
        "cylinder(r: 1, from: [0, 0, 1], to: [0, 0, 1])",
        "cone(r1: 1, r2: 0, from: [0, 0, 1], to: [0, 0, 1])",
    ] {
        let mut sources = SourceMap::default();
        let file = sources.add("scene.pss", None, format!("draw {call} | sphere(r: 1)").as_str());
        let (scene, warnings) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).unwrap();
        let prepared = prepare::prepare(&scene, &Options::default()).unwrap();
        let told = warnings.iter().chain(&prepared.warnings);
        let codes: Vec<&str> = told.map(|w| w.code).collect();
        assert_eq!(codes, ["W0101"], "{call}");
    }
}

/// Planes that cross at the edge of what is looked at are no faces that coincide.
#[test]
fn planes_that_cross_do_not_coincide() {
    let empty = "intersection([half_space(x < -1), half_space(y < -1), half_space(normal: [-1, -1, 0], at: [0, 0, 0])])";
    let found = check_support::findings(&format!("draw {empty} | sphere(r: 1)"));
    assert!(!found.contains("W0121") && found.contains("W0123"), "{found}");
}

/// A part split in two, and an inlay, are ordinary: their cutters cut, and nothing thin is left.
#[test]
fn parts_split_in_two_and_inlays_are_no_reason_for_doubt() {
    for scene in [
        "draw (sphere(r: 3) - half_space(z < 0)) | (sphere(r: 3) & half_space(z < 0))",
        "let p = torus(major: 3, minor: 1)\nlet k = half_space(x < 0)\ndraw (p - k) | (p & k)",
        "let p = cylinder(r: 5, h: 10)\ndraw p - half_space(x < 0)\ndraw p & half_space(x < 0)",
        "draw (box([0, 0, 0], [10, 10, 10]) - cylinder(r: 2, from: [5, 5, -1], to: [5, 5, 11])) | cylinder(r: 2, from: [5, 5, 0], to: [5, 5, 10])",
    ] {
        let found = check_support::findings(scene);
        assert!(
            ["W0122", "W0125", "W0123", "W0126"].iter().all(|code| !found.contains(code)),
            "{scene}\n{found}"
        );
    }
}

/// Round things stand and lie on floors of any size, and a cutter within another's cut leaves nothing thin.
#[test]
fn what_touches_a_floor_at_a_point_or_along_a_line_shares_no_face_with_it() {
    for size in [3.0, 30.0, 1e3, 1e5, 1e6] {
        let floor = format!("draw box([-{size}, -{size}, -1], [{size}, {size}, 0])\n");
        for round in [
            "sphere(r: 1, at: [0, 0, 1])",
            "capsule(r: 1, from: [0, 0, 1], to: [3, 0, 1])",
            "capsule(r: 1, from: [0.3, 0.2, 1], to: [2, 1, 1])",
            "cylinder(r: 1, from: [0, 0, 1], to: [2, 2, 1])",
            "torus(major: 2, minor: 0.5).move([0, 0, 0.5])",
        ] {
            let scene = format!("{floor}draw {round}\n");
            assert_eq!(check_support::findings(&scene), "", "{scene}");
        }
        let standing = format!("{floor}draw cylinder(r: 1, h: 2)\n");
        let found = check_support::findings(&standing);
        assert!(found.contains("W0121") && !found.contains("W0125"), "{standing}{found}");
    }
}

/// Unbounded shapes that leave nothing, or do not meet, are told; those that meet far away are not.
#[test]
fn unbounded_shapes_that_do_not_meet_are_told() {
    let cylinder = "quadric(squares: [1, 1, 0], constant: -1)";
    let beside = "quadric(squares: [1, 1, 0], linear: [-20, 0, 0], constant: 99)";
    for (scene, code) in [
        ("half_space(x + y < 0) & half_space(x + y > 1)".into(), "W0123"),
        ("half_space(x + y < 0) - half_space(x + y > 1)".into(), "W0122"),
        ("half_space(z <= 0) & half_space(z >= 0)".into(), "W0123"),
        ("half_space(z < 0) - half_space(z < 0)".into(), "W0124"),
        ("half_space(x < 0) & half_space(y < 0) & half_space(x + y > 2)".into(), "W0123"),
        (format!("{cylinder} & half_space(x > 2)"), "W0123"),
        (format!("{cylinder} & {beside}"), "W0123"),
        (format!("{cylinder} - {beside}"), "W0122"),
    ] {
        let found = check_support::findings(&format!("draw {scene}"));
        assert!(found.contains(code), "{scene}\n{found}");
    }
    for scene in [
        "half_space(z < 0) & half_space(z > 1 + 1e-9 * x)".into(),
        "half_space(z < 0) - half_space(z > 1 + 1e-9 * x)".into(),
        "half_space(x < 0) & half_space(y < 0) & half_space(z < 1) & half_space(x + y + z > -2)".into(),
        "half_space(x < 0) & half_space(y < 0) & half_space(1e-6 * x + 1e-6 * y - z > 1)".into(),
        format!("{cylinder} & half_space(x > 2 - 1e-6 * z)"),
        format!("{cylinder} - half_space(x > 2 - 1e-6 * z)"),
    ] {
        assert_eq!(check_support::findings(&format!("draw {scene}")), "", "{scene}");
    }
}
