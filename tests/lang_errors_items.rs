//! What users are told, about materials, parameters, what is not there yet, and how it is shown, letter by letter.

#[macro_use]
mod lang_support;

says! {
    an_unknown_kind_of_material_gets_the_nearest: "material a(kind: \"mate\")\n",
    r#"
error[E0507]: `kind` cannot be "mate"
 --> scene.pss:1:18
  |
1 | material a(kind: "mate")
  |                  ^^^^^^ unknown word
  = help: did you mean "matte"?
"#
}

says! {
    a_method_wants_a_shape: "draw [sphere(r: 1)].move([1, 0, 0])\n",
    r#"
error[E0501]: `.move` is a method of shapes, not of a list
 --> scene.pss:1:21
  |
1 | draw [sphere(r: 1)].move([1, 0, 0])
  |      -------------- ^^^^ needs a shape
  |      |
  |      a list
  = help: combine the list first: `union(list)`
"#
}

says! {
    a_default_lies_in_its_range: "param a: length = 9 in 1..8\n",
    r#"
error[E0503]: `a` is outside of what it allows
 --> scene.pss:1:19
  |
1 | param a: length = 9 in 1..8
  |                   ^ 9  ---- allowed
  = help: write a value from 1 to 8
"#
}

says! {
    without_files_and_geometry_nothing_is_imported_or_measured: "let c = volume(sphere(r: 1))\n",
    r#"
error[E0708]: `volume` cannot be asked here
 --> scene.pss:1:9
  |
1 | let c = volume(sphere(r: 1))
  |         ^^^^^^^^^^^^^^^^^^^^ no geometry
  = help: ask in the scene itself
"#
}

says! {
    hiding_a_builtin_is_a_warning: "let sphere = 3\n",
    r#"
warning[W0201]: `sphere` hides what the language calls so
 --> scene.pss:1:5
  |
1 | let sphere = 3
  |     ^^^^^^ defined here
  = help: take another name
"#
}

says! {
    control_characters_are_escaped: "let a = \"x\x1b[31m\" + 1\n",
    r#"
error[E0203]: `+` cannot take a string and a number
 --> scene.pss:1:23
  |
1 | let a = "x\u{1b}[31m" + 1
  |         ------------- ^ - a number
  |         |             |
  |         |             does not fit its operands
  |         a string
  = help: numbers or vectors are wanted
"#
}

says! {
    a_tab_and_wide_characters_keep_the_place: "let a =\t\"größe\" + 1\r\n",
    r#"
error[E0203]: `+` cannot take a string and a number
 --> scene.pss:1:17
  |
1 | let a =    "größe" + 1
  |            ------- ^ - a number
  |            |       |
  |            |       does not fit its operands
  |            a string
  = help: numbers or vectors are wanted
"#
}

says! {
    an_unknown_define_lists_the_parameters: "param bore: length = 4 in 1..8\nparam name = \"a\"\n",
    -D &[("bohr", "5")],
    r#"
error[E0409]: the scene has no parameter `bohr`
 --> command line:1:1
  |
1 | bohr=5
  | ^^^^ unknown parameter
  = help: the parameters are `bore`, `name`
"#
}

says! {
    a_define_out_of_range_is_refused: "param bore: length = 4 in 1..8\n",
    -D &[("bore", "9")],
    r#"
error[E0503]: `bore` is outside of what it allows
 --> command line:1:6
  |
1 | bore=9
  |      ^ 9
  |
 ::: scene.pss:1:27
  |
1 | param bore: length = 4 in 1..8
  |                           ---- allowed
  = help: write a value from 1 to 8
"#
}

says! {
    a_define_of_a_wrong_type_is_refused: "param bore: length = 4 in 1..8\nparam turn = 30deg\n",
    -D &[("bore", "x y"), ("turn", "40")],
    r#"
error[E0509]: `x y` cannot be read as a value
 --> command line:1:6
  |
1 | bore=x y
  |      ^^^ expected a length
  = help: write a length, such as `-D bore=2.5`

error[E0502]: `turn` wants an angle, found a bare number
 --> command line:1:6
  |
1 | turn=40
  |      ^^ which unit?
  = help: write `40deg`
"#
}

says! {
    a_define_outside_of_a_list_gets_the_nearest: "param mode = \"fast\" in [\"fast\", \"fine\"]\n",
    -D &[("mode", "fin")],
    r#"
error[E0503]: `mode` is outside of what it allows
 --> command line:1:6
  |
1 | mode=fin
  |      ^^^ not in the list
  |
 ::: scene.pss:1:24
  |
1 | param mode = "fast" in ["fast", "fine"]
  |                        ---------------- allowed
  = help: did you mean "fine"?
"#
}
