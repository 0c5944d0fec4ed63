//! What `pss check` finds in scenes, letter by letter, and where it finds nothing.

#[macro_use]
mod check_support;

use check_support::findings;

finds! {
    a_flush_cutter_shares_faces_with_its_base: "let block = box(size: 2)\nlet bore = cylinder(r: 0.5, h: 2).move([0, 0, -1])\ndraw block - bore\n",
    r#"
note[W0121]: faces of `block` and `bore` coincide
 --> scene.pss:2:12
  |
1 | let block = box(size: 2)
  |             ------------ and this one
2 | let bore = cylinder(r: 0.5, h: 2).move([0, 0, -1])
  |            ^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts
"#
}

finds! {
    copies_that_touch_share_faces: "draw box(size: 1).array([[0, 0, 0], [1, 0, 0]])\n",
    r#"
note[W0121]: faces of copies of `box` coincide
 --> scene.pss:1:6
  |
1 | draw box(size: 1).array([[0, 0, 0], [1, 0, 0]])
  |      ^^^^^^^^^^^^ these
  = help: copies that touch are one solid; a copy that shall cut through another must stand out of it
"#
}

finds! {
    faces_meet_through_different_transforms: "let a = box(size: 1).rotate_z(30deg).move([7, 0, 0])\nlet b = box(size: 1).move([0, 0, 1]).rotate_z(30deg).move([7, 0, 0])\ndraw a | b\n",
    r#"
note[W0121]: faces of `a` and `b` coincide
 --> scene.pss:2:9
  |
1 | let a = box(size: 1).rotate_z(30deg).move([7, 0, 0])
  |         ------------ and this one
2 | let b = box(size: 1).move([0, 0, 1]).rotate_z(30deg).move([7, 0, 0])
  |         ^^^^^^^^^^^^ this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts
"#
}

finds! {
    a_cutter_beside_its_base_cuts_nothing: "let base = box(size: 1)\ndraw base - sphere(r: 1, at: [5, 0, 0])\n",
    r#"
warning[W0122]: this cutter cuts nothing
 --> scene.pss:2:13
  |
2 | draw base - sphere(r: 1, at: [5, 0, 0])
  |      ----   ^^^^^^^^^^^^^^^^^^^^^^^^^^^ takes nothing away
  |      |
  |      from this
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    a_cutter_inside_another_cuts_nothing: "draw difference(box(size: 2), [sphere(r: 0.75), sphere(r: 0.5)])\n",
    r#"
warning[W0122]: this cutter cuts nothing
 --> scene.pss:1:49
  |
1 | draw difference(box(size: 2), [sphere(r: 0.75), sphere(r: 0.5)])
  |                 ------------ from this          ^^^^^^^^^^^^^^ takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    a_complement_beside_the_rest_cuts_nothing: "draw box(size: 1) & !sphere(r: 1, at: [5, 0, 0])\n",
    r#"
warning[W0122]: this cutter cuts nothing
 --> scene.pss:1:22
  |
1 | draw box(size: 1) & !sphere(r: 1, at: [5, 0, 0])
  |                      ^^^^^^^^^^^^^^^^^^^^^^^^^^^ takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    solids_apart_have_no_intersection: "draw sphere(r: 1) & sphere(r: 1, at: [3, 0, 0])\n",
    r#"
warning[W0123]: nothing is left of what is drawn here
 --> scene.pss:1:6
  |
1 | draw sphere(r: 1) & sphere(r: 1, at: [3, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything
  = help: look at the sizes and places of its parts: do they meet, does a cutter take all?
"#
}

finds! {
    a_cutter_can_take_the_whole_base: "let base = box(size: 1)\ndraw base - sphere(r: 2)\n",
    r#"
warning[W0124]: nothing is left of the base of this difference
 --> scene.pss:2:6
  |
2 | draw base - sphere(r: 2)
  |      ^^^^   ------------ this one
  |      |
  |      lies wholly inside the cutter
  = help: make the cutter smaller or move it; what both hold is written `a & b`
"#
}

finds! {
    cutters_together_can_take_the_whole_base: "draw difference(box([0, 0, 0], [2, 1, 1]), [box([-1, -1, -1], [1, 2, 2]), box([0.5, -1, -1], [3, 2, 2])])\n",
    r#"
note[W0121]: faces of `box` and `box` coincide
 --> scene.pss:1:75
  |
1 | draw difference(box([0, 0, 0], [2, 1, 1]), [box([-1, -1, -1], [1, 2, 2]), box([0.5, -1, -1], [3, 2, 2])])
  |                                             ----------------------------  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  |                                             |
  |                                             and this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts

warning[W0124]: nothing is left of the base of this difference
 --> scene.pss:1:17
  |
1 | draw difference(box([0, 0, 0], [2, 1, 1]), [box([-1, -1, -1], [1, 2, 2]), box([0.5, -1, -1], [3, 2, 2])])
  |                 ^^^^^^^^^^^^^^^^^^^^^^^^^ lies wholly inside the cutters together
  = help: make the cutters smaller or move them; what all hold is written `a & b`
"#
}

finds! {
    a_sheet_of_rounding_is_dropped: "let sliver = box([0, 0, 0], [1, 1, 2e-15])\ndraw sliver | sphere(r: 0.25, at: [0.5, 0.5, 3])\n",
    r#"
warning[W0125]: `sliver` is thinner than rounding can tell so far from the origin
 --> scene.pss:1:14
  |
1 | let sliver = box([0, 0, 0], [1, 1, 2e-15])
  |              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ dropped where it is so thin
  = help: make it thicker, or build the scene nearer to the origin
"#
}

finds! {
    what_an_operator_leaves_can_be_a_film: "let base = box([0, 0, 0], [1, 1, 1])\ndraw base - box([-1, -1, -1], [2, 2, 0.999999999999998])\n",
    r#"
warning[W0124]: nothing is left of the base of this difference
 --> scene.pss:2:6
  |
2 | draw base - box([-1, -1, -1], [2, 2, 0.999999999999998])
  |      ^^^^   -------------------------------------------- this one
  |      |
  |      lies wholly inside the cutter
  = help: make the cutter smaller or move it; what both hold is written `a & b`

warning[W0125]: what is left between `base` and `box` is thinner than rounding can tell
 --> scene.pss:2:13
  |
1 | let base = box([0, 0, 0], [1, 1, 1])
  |            ------------------------- and this
2 | draw base - box([-1, -1, -1], [2, 2, 0.999999999999998])
  |             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ dropped at this
  = help: make it thicker, or let the one stand out of the other
"#
}

finds! {
    what_is_thin_to_an_eye_far_away_is_a_film: "let base = box([0, 0, 0], [1, 1, 1])\ndraw base - box([-1, -1, -1], [2, 2, 0.9999999999999])\ncamera eye(eye: [1000, 0, 0], look_at: [0, 0, 0])\n",
    r#"
warning[W0124]: nothing is left of the base of this difference
 --> scene.pss:2:6
  |
2 | draw base - box([-1, -1, -1], [2, 2, 0.9999999999999])
  |      ^^^^   ------------------------------------------ this one
  |      |
  |      lies wholly inside the cutter
  = help: make the cutter smaller or move it; what both hold is written `a & b`

warning[W0125]: what is left between `base` and `box` is thinner than rounding can tell
 --> scene.pss:2:13
  |
1 | let base = box([0, 0, 0], [1, 1, 1])
  |            ------------------------- and this
2 | draw base - box([-1, -1, -1], [2, 2, 0.9999999999999])
  |             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ dropped at this
  = help: make it thicker, or let the one stand out of the other
"#
}

finds! {
    a_gap_can_be_as_thin: "draw box([0, 0, 0], [1, 1, 1]) | box([0, 0, 1.000000000000002], [1, 1, 2])\n",
    r#"
warning[W0125]: the gap between `box` and `box` is thinner than rounding can tell
 --> scene.pss:1:34
  |
1 | draw box([0, 0, 0], [1, 1, 1]) | box([0, 0, 1.000000000000002], [1, 1, 2])
  |      -------------------------   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ closed at this
  |      |
  |      and this
  = help: make it wider, or let the one reach into the other
"#
}

finds! {
    a_clip_can_leave_nothing: "draw plane(z: 0).clip(sphere(r: 1, at: [0, 0, 5]))\ndraw box(size: 1).clip(sphere(r: 0.5, at: [0, 0, 3]))\ndraw sphere(r: 1, at: [9, 0, 0])\n",
    r#"
warning[W0123]: nothing is left of what is drawn here
 --> scene.pss:1:6
  |
1 | draw plane(z: 0).clip(sphere(r: 1, at: [0, 0, 5]))
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything
  = help: look at the sizes and places of its parts: do they meet, does a cutter take all?

warning[W0123]: nothing is left of what is drawn here
 --> scene.pss:2:6
  |
2 | draw box(size: 1).clip(sphere(r: 0.5, at: [0, 0, 3]))
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything
  = help: look at the sizes and places of its parts: do they meet, does a cutter take all?
"#
}

finds! {
    solids_of_a_clip_are_looked_at_too: "let far = box([5, 5, 5], [6, 6, 6])\ndraw (sphere(r: 1) - far).clip(half_space(z < 0))\ndraw sphere(r: 1, at: [4, 0, 0]).clip(half_space(z < 0) - sphere(r: 1, at: [9, 0, 5]))\n",
    r#"
warning[W0122]: this cutter cuts nothing
 --> scene.pss:2:22
  |
2 | draw (sphere(r: 1) - far).clip(half_space(z < 0))
  |       ------------   ^^^ takes nothing away
  |       |
  |       from this
  = help: move it to where it meets what it shall cut, or leave it out

warning[W0122]: this cutter cuts nothing
 --> scene.pss:3:59
  |
3 | draw sphere(r: 1, at: [4, 0, 0]).clip(half_space(z < 0) - sphere(r: 1, at: [9, 0, 5]))
  |                                       -----------------   ^^^^^^^^^^^^^^^^^^^^^^^^^^^ takes nothing away
  |                                       |
  |                                       from this
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! { corners_that_a_ball_leaves_of_a_box_are_left: "draw box(size: 2) - sphere(r: 1.73)\ndraw (box(size: 2) - half_space(x + y + z < 2.98)).rotate_z(20deg).move([5, 0, 0])\ndraw cylinder(r: 1, h: 2).move([9, 0, -1]) - sphere(r: 1.414, at: [9, 0, 0])\n" }

finds! {
    balls_that_touch_at_a_point_share_no_face: "draw sphere(r: 1) & sphere(r: 1, at: [2, 0, 0])\n",
    r#"
warning[W0123]: nothing is left of what is drawn here
 --> scene.pss:1:6
  |
1 | draw sphere(r: 1) & sphere(r: 1, at: [2, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ no test line finds anything
  = help: look at the sizes and places of its parts: do they meet, does a cutter take all?
"#
}

finds! { one_cutter_of_two_solids_shares_no_face_with_itself: "let c = sphere(r: 1)\ndraw box([-2, -2, -2], [-0.1, 2, 2]) - c\ndraw box([0.1, -2, -2], [2, 2, 2]) - c\n" }

/// Too many for each to have lines of its own: what no line told is not told.
#[test]
fn thousands_of_cutters_that_cut_raise_no_doubt() {
    let side = 96;
    let at = |i: u32| f64::from(i) * 32.0 / f64::from(side) + 0.2;
    let one = |i: u32| format!("sphere(r: 0.13, at: [{}, {}, 1])", at(i % side), at(i / side));
    let all: Vec<String> = (0..side * side).map(one).collect();
    let found =
        findings(&format!("draw difference(box([0, 0, 0], [32.2, 32.2, 1]), [{}])\n", all.join(", ")));
    assert_eq!(found, "");
}

finds! { a_clip_that_leaves_something_is_fine: "draw plane(z: 0).clip(sphere(r: 1))\ndraw box(size: 1).clip(sphere(r: 0.55)).move([3, 0, 0])\n" }

finds! { faces_brought_together_by_turns_are_no_film: "let a = box(size: 1).rotate_z(10deg).rotate_x(20deg)\nlet b = box(size: 1, at: [0, 0, 1]).rotate_z(5deg).rotate_z(5deg).rotate_x(8deg).rotate_x(12deg)\ndraw (a | b).move([3, 2, 1])\n",
    r#"
note[W0121]: faces of `a` and `b` coincide
 --> scene.pss:2:9
  |
1 | let a = box(size: 1).rotate_z(10deg).rotate_x(20deg)
  |         ------------ and this one
2 | let b = box(size: 1, at: [0, 0, 1]).rotate_z(5deg).rotate_z(5deg).rotate_x(8deg).rotate_x(12deg)
  |         ^^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts
"#
}

finds! {
    solids_drawn_into_each_other_overlap: "let a = box(size: 2)\ndraw a\ndraw box(size: 2, at: [1.5, 0, 0])\n",
    r#"
note[W0121]: faces of `a` and `box` coincide
 --> scene.pss:3:6
  |
1 | let a = box(size: 2)
  |         ------------ and this one
2 | draw a
3 | draw box(size: 2, at: [1.5, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts

warning[W0126]: the insides of two solids drawn overlap
 --> scene.pss:3:6
  |
2 | draw a
  |      - reaches into this one
3 | draw box(size: 2, at: [1.5, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: move one of them, or draw them as one: `draw a | b`
  = note: by about 0.50, around [0.75, 0.00, 0.00]
"#
}

finds! {
    a_solid_drawn_twice_overlaps_itself: "let a = sphere(r: 1)\ndraw [a, a]\n",
    r#"
note[W0121]: faces of copies of `a` coincide
 --> scene.pss:1:9
  |
1 | let a = sphere(r: 1)
  |         ^^^^^^^^^^^^ these
  = help: copies that touch are one solid; a copy that shall cut through another must stand out of it

warning[W0126]: the insides of two solids drawn overlap
 --> scene.pss:2:10
  |
2 | draw [a, a]
  |       -  ^ this one
  |       |
  |       reaches into this one
  = help: move one of them, or draw them as one: `draw a | b`
  = note: by about 2.0, around [0.0, 0.0, 0.0]
"#
}

finds! {
    a_formula_that_never_holds_is_nothing: "draw implicit(x**2 + 1 <= 0, inside: box(size: 1)) | sphere(r: 1, at: [3, 0, 0])\n",
    r#"
warning[W0127]: `implicit` is nothing: no test line is inside it
 --> scene.pss:1:6
  |
1 | draw implicit(x**2 + 1 <= 0, inside: box(size: 1)) | sphere(r: 1, at: [3, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ never met
  = help: look at its sizes; a formula may hold nowhere in its bounds
"#
}

finds! { a_cutter_that_stands_out_shares_no_face: "draw box(size: 2) - cylinder(r: 0.5, h: 3).move([0, 0, -1.5])\n" }

finds! { cutters_that_cut_are_fine: "draw difference(box(size: 2), [sphere(r: 0.5, at: [1, 0, 0]), sphere(r: 0.5, at: [-1, 0, 0])])\n" }

finds! { a_small_intersection_is_seen: "draw sphere(r: 1) & sphere(r: 1, at: [1.999, 0, 0])\n" }

finds! { a_lens_of_a_ten_millionth_is_seen: "draw (sphere(r: 1) & sphere(r: 1, at: [1.9999999, 0, 0])).rotate_z(33deg).rotate_x(20deg)\n" }

finds! { the_corner_that_two_turned_boxes_share_is_seen: "draw (box(size: 1) & box(size: 1, at: [0.9999, 0.9999, 0.9999])).rotate_z(33deg).rotate_x(20deg)\n" }

finds! { a_cutter_that_takes_a_sliver_cuts: "draw sphere(r: 1) - sphere(r: 1, at: [1.99999, 0, 0])\ndraw (box(size: 2).rotate_z(20deg) - sphere(r: 1, at: [0, 0, 1.99999])).move([9, 0, 0])\n" }

finds! {
    of_cutters_that_cut_the_same_one_is_needed: "let c = box(size: 1)\ndraw box(size: 2) - c - c\n",
    r#"
note[W0121]: faces of copies of `c` coincide
 --> scene.pss:1:9
  |
1 | let c = box(size: 1)
  |         ^^^^^^^^^^^^ these
  = help: copies that touch are one solid; a copy that shall cut through another must stand out of it

warning[W0122]: this cutter cuts nothing
 --> scene.pss:2:25
  |
2 | draw box(size: 2) - c - c
  |      ------------       ^ takes nothing away
  |      |
  |      from this
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    of_equal_cutters_in_a_list_the_first_stays: "draw difference(box(size: 4), [sphere(r: 1), sphere(r: 1)])\n",
    r#"
note[W0121]: faces of `sphere` and `sphere` coincide
 --> scene.pss:1:46
  |
1 | draw difference(box(size: 4), [sphere(r: 1), sphere(r: 1)])
  |                                ------------  ^^^^^^^^^^^^ this one
  |                                |
  |                                and this one
  = help: nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts

warning[W0122]: this cutter cuts nothing
 --> scene.pss:1:46
  |
1 | draw difference(box(size: 4), [sphere(r: 1), sphere(r: 1)])
  |                 ------------ from this       ^^^^^^^^^^^^ takes nothing away
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    solids_drawn_a_ten_thousandth_into_each_other_overlap: "draw sphere(r: 1)\ndraw sphere(r: 1, at: [1.9999, 0, 0])\n",
    r#"
warning[W0126]: the insides of two solids drawn overlap
 --> scene.pss:2:6
  |
1 | draw sphere(r: 1)
  |      ------------ reaches into this one
2 | draw sphere(r: 1, at: [1.9999, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ this one
  = help: move one of them, or draw them as one: `draw a | b`
  = note: by about 0.00010, around [0.99995, 0.00000, 0.00000]
"#
}

finds! { a_thin_wall_is_kept: "draw box(size: 2) - box(size: 1.999999)\n" }

finds! { a_thin_sheet_is_kept: "draw box([0, 0, 0], [1, 1, 1e-9])\n" }

finds! { solids_drawn_apart_do_not_overlap: "draw box(size: 2)\ndraw box(size: 2, at: [3, 0, 0])\ndraw plane(z: -5)\n" }

finds! { half_spaces_alone_are_fine: "draw half_space(z < 3) - half_space(x > 2)\n" }

finds! { complements_in_complements_are_told_apart: "draw box(size: 2) - !sphere(r: 1.2)\n" }

finds! { a_formula_that_holds_somewhere_is_fine: "draw implicit(x**2 + y**2 + z**2 <= 0.04, inside: box(size: 1))\n" }

/// Too many for each to have its own share of the lines: those that none met are looked at alone.
#[test]
fn thousands_of_small_balls_are_all_something() {
    let ball = |i: u32| {
        let at = |k: u32| f64::from(k * 7919 % 199) - 99.0;
        format!("sphere(r: 0.01, at: [{}, {}, {}])", at(i), at(i / 7 + 3), at(i / 49 + 11 * i))
    };
    let balls: Vec<String> = (0..3000).map(ball).collect();
    let found = findings(&format!("draw union([{}])\n", balls.join(", ")));
    assert!(!found.contains("W0127"), "{found}");
}

#[test]
fn findings_of_one_kind_are_counted_past_twenty() {
    let boxes: Vec<String> = (0..8).map(|i| format!("draw box(size: {})", 1 + i)).collect();
    let told = findings(&boxes.join("\n"));
    assert_eq!(told.matches("W0126").count(), 20 + 1, "{told}");
    assert!(told.contains("and 8 more of W0126"), "{told}");
}

#[test]
fn four_hundred_solids_that_are_sound_raise_no_doubt() {
    let at: Vec<String> = (0..200).map(|i| format!("[{}, {}, 0]", 3 * (i % 20), 3 * (i / 20))).collect();
    let at = at.join(", ");
    let text =
        format!("draw box(size: [2, 2, 1]).array([{at}]) - sphere(r: 0.8, at: [0, 0, 0.5]).array([{at}])");
    assert_eq!(findings(&text), "");
}
