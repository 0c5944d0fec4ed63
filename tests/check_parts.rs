//! What `pss check` finds in parts of what is drawn: what is nothing, too thin to be meant, apart, or small; letter by letter.

#[macro_use]
mod check_support;

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
warning[W0121]: faces of copies of `a` coincide
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
    copies_of_a_cutter_that_are_apart_are_told: "draw box([0,0,0],[10,1,1]) - cylinder(r: 0.2, from: [0.5,0.5,-1], to: [0.5,0.5,2]).array([[0,0,0],[3,0,0],[12,0,0],[6,0,0]])\n",
    r#"
warning[W0122]: one of the 4 copies of this cutter cuts nothing
 --> scene.pss:1:30
  |
1 | draw box([0,0,0],[10,1,1]) - cylinder(r: 0.2, from: [0.5,0.5,-1], to: [0.5,0.5,2]).array([[0,0,0],[3,0,0],[12,0,0],[6,0,0]])
  |                              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ the one about [12.5, 0.5, 0.5] is apart from what is cut
  = help: move it to where it meets what it shall cut, or leave it out
"#
}

finds! {
    a_small_shared_face_is_seen: "draw box([0,0,0],[10,10,1])\ndraw box([3,3,1],[3.05,3.05,2])\n",
    r#"
warning[W0121]: faces of `box` and `box` coincide
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
