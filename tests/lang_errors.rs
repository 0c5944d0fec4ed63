//! What users are told, about types and values, letter by letter.

#[macro_use]
mod lang_support;

says! {
    a_wrong_type_is_named: "draw sphere(r: #fff)\n",
    r#"
error[E0501]: `r` wants a length, found a colour
 --> scene.pss:1:16
  |
1 | draw sphere(r: #fff)
  |                ^^^^ a colour
  = help: write a length, such as `10`
"#
}

says! {
    a_bare_number_is_no_angle: "draw sphere(r: 1).rotate_x(90)\ncamera(fov: 28)\n",
    r#"
error[E0502]: `angle` wants an angle, found a bare number
 --> scene.pss:1:28
  |
1 | draw sphere(r: 1).rotate_x(90)
  |                            ^^ which unit?
  = help: write `90deg`

error[E0502]: `fov` wants an angle, found a bare number
 --> scene.pss:2:13
  |
2 | camera(fov: 28)
  |             ^^ which unit?
  = help: write `28deg`
"#
}

says! {
    a_vector_has_its_size: "draw sphere(r: 1, at: [0, 0])\n",
    r#"
error[E0501]: `at` wants 3 numbers, found 2
 --> scene.pss:1:23
  |
1 | draw sphere(r: 1, at: [0, 0])
  |                       ^^^^^^ 2 given
  = help: write `[x, y, z]`
"#
}

says! {
    a_whole_number_has_its_range: "draw points(\"a.ply\", degree: 5)\nrender(samples: 1.5)\n",
    r#"
error[E0503]: `degree` must be a whole number from 0 to 4
 --> scene.pss:1:30
  |
1 | draw points("a.ply", degree: 5)
  |                              ^ 5
  = help: write a whole number from 0 to 4

error[E0503]: `samples` must be a whole number from 1 to 1000000
 --> scene.pss:2:17
  |
2 | render(samples: 1.5)
  |                 ^^^ 1.5
  = help: write a whole number from 1 to 1000000
"#
}

says! {
    a_number_is_finite: "let a = 1e999\n",
    r#"
error[E0504]: `1e999` is not finite
 --> scene.pss:1:9
  |
1 | let a = 1e999
  |         ^^^^^ too large for a number
  = help: numbers reach from -1e18 to 1e18
"#
}

says! {
    results_are_finite_and_nan_is_no_name: "let b = nan\nlet c = 1 / 0\nlet d = sqrt(-1)\nlet e = normalize([0, 0, 0])\n",
    r#"
error[E0504]: `nan` is not finite
 --> scene.pss:1:9
  |
1 | let b = nan
  |         ^^^ not a number of a scene
  = help: scenes have finite numbers only

error[E0504]: the result of `/` is not finite
 --> scene.pss:2:11
  |
2 | let c = 1 / 0
  |           ^ infinite or undefined
  = help: the right side is zero, or the left is too large

error[E0504]: the result of `sqrt` is not finite
 --> scene.pss:3:9
  |
3 | let d = sqrt(-1)
  |         ^^^^^^^^ infinite or undefined
  = help: roots are of numbers from zero on: `sqrt(max(x, 0))`, `sqrt(abs(x))`

error[E0504]: the result of `normalize` is not finite
 --> scene.pss:4:9
  |
4 | let e = normalize([0, 0, 0])
  |         ^^^^^^^^^^^^^^^^^^^^ infinite or undefined
  = help: a vector of length zero has no direction
"#
}

says! {
    a_condition_takes_no_functions_of_coordinates: "let x = 3\ndraw half_space(sqrt(x) < 3)\n",
    r#"
error[E0508]: the condition is not linear
 --> scene.pss:2:17
  |
2 | draw half_space(sqrt(x) < 3)
  |                 ^^^^^^^ x, y and z may be added, and multiplied by numbers
  = help: a half-space has a flat face: `x + 2*y <= 3`
"#
}

says! {
    an_index_lies_in_its_list: "let a = [1, 2, 3][3]\nlet b = 3[0]\n",
    r#"
error[E0503]: there is no element 3
 --> scene.pss:1:19
  |
1 | let a = [1, 2, 3][3]
  |                   ^ no such element
  = help: the list has 3 elements, from `[0]` to `[2]`

error[E0501]: a number has no elements
 --> scene.pss:2:9
  |
2 | let b = 3[0]
  |         ^ a number
  = help: only lists have elements: `list[0]`
"#
}

says! {
    vectors_of_two_sizes_do_not_add: "let a = [1, 2] + [1, 2, 3]\n",
    r#"
error[E0203]: `+` cannot take a vector and a vector
 --> scene.pss:1:16
  |
1 | let a = [1, 2] + [1, 2, 3]
  |         ------ ^ --------- a vector
  |         |      |
  |         |      does not fit its operands
  |         a vector
  = help: vectors of one size are wanted
"#
}

says! {
    an_angle_is_no_length: "draw sphere(r: 3deg)\nlet a = 3 + 3deg\n",
    r#"
error[E0501]: `r` wants a length, found an angle
 --> scene.pss:1:16
  |
1 | draw sphere(r: 3deg)
  |                ^^^^ an angle
  = help: divide by a unit to get a number: `angle / 1deg`

error[E0203]: `+` cannot take a number and an angle
 --> scene.pss:2:11
  |
2 | let a = 3 + 3deg
  |         - ^ ---- an angle
  |         | |
  |         | does not fit its operands
  |         a number
  = help: an angle has a unit, `30deg`, and goes with angles alone
"#
}

says! {
    a_function_wants_arguments: "let a = count\nlet b = 3\nlet c = b(2)\nlet d = sphere(r: 1).move\n",
    r#"
error[E0410]: `count` is called with arguments
 --> scene.pss:1:9
  |
1 | let a = count
  |         ^^^^^ no arguments
  = help: write `count(...)`

error[E0410]: a number cannot be called
 --> scene.pss:3:10
  |
3 | let c = b(2)
  |         -^^^ a call
  |         |
  |         a number
  = help: remove the arguments, or put an operator before the `(`

error[E0410]: `.move` is called with arguments
 --> scene.pss:4:22
  |
4 | let d = sphere(r: 1).move
  |                      ^^^^ no arguments
  = help: write `.move(...)`
"#
}

says! {
    fit_takes_one_measure: "draw sphere(r: 1).fit([0, 0, 0])\ndraw sphere(r: 1).fit([0, 0, 0], height: 1, size: 2)\n",
    r#"
error[E0404]: `fit` needs `height`
 --> scene.pss:1:6
  |
1 | draw sphere(r: 1).fit([0, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^^^^^^^ `height` is missing
  = help: write `height:` or `size:`

error[E0405]: `height` and `size` are both given
 --> scene.pss:2:51
  |
2 | draw sphere(r: 1).fit([0, 0, 0], height: 1, size: 2)
  |                                          -        ^ the size
  |                                          |
  |                                          the height
  = help: remove one of them
"#
}

says! {
    an_unknown_unit_of_the_scene_lists_them: "units(inch)\n",
    r#"
error[E0401]: `inch` is not a unit of length
 --> scene.pss:1:7
  |
1 | units(inch)
  |       ^^^^ unknown unit
  = help: the units are `um` `mm` `cm` `m` `km` `in` `ft`
"#
}

says! {
    an_unknown_type_gets_the_nearest: "param a: lenght = 3\n",
    r#"
error[E0401]: `lenght` is not a type
 --> scene.pss:1:10
  |
1 | param a: lenght = 3
  |          ^^^^^^ unknown type
  = help: did you mean `length`?
"#
}

says! {
    a_number_is_within_the_limit: "draw sphere(r: 1, at: [1e19, 0, 0])\n",
    r#"
error[E0505]: the number is beyond the limit of 1e18
 --> scene.pss:1:24
  |
1 | draw sphere(r: 1, at: [1e19, 0, 0])
  |                        ^^^^ too large
  = help: choose larger units, such as `units(m)`
"#
}

says! {
    two_cameras_of_one_name_show_both: "camera a(eye: [0, 0, 1])\nlight a(intensity: 1)\ncamera a(eye: [0, 0, 2])\n",
    r#"
error[E0402]: `a` is defined twice
 --> scene.pss:3:8
  |
1 | camera a(eye: [0, 0, 1])
  |        - the first time
2 | light a(intensity: 1)
3 | camera a(eye: [0, 0, 2])
  |        ^ the second time
  = help: take another name for one of them
"#
}

says! {
    an_angle_may_be_in_no_list_of_lengths: "draw box(size: [1, 2, 3deg])\n",
    r#"
error[E0501]: `size` wants a number, found an angle
 --> scene.pss:1:23
  |
1 | draw box(size: [1, 2, 3deg])
  |                       ^^^^ an angle
  = help: divide by a unit to get a number: `angle / 1deg`
"#
}

says! {
    a_negative_size_is_refused: "draw sphere(r: -3)\n",
    r#"
error[E0506]: `r` is negative
 --> scene.pss:1:16
  |
1 | draw sphere(r: -3)
  |                ^^ -3
  = help: a size is zero or more
"#
}

says! {
    a_zero_size_is_a_warning: "draw sphere(r: 0)\n",
    r#"
warning[W0101]: `r` is zero: the shape is nothing
 --> scene.pss:1:16
  |
1 | draw sphere(r: 0)
  |                ^ no size
  = help: give it a size, or leave the shape out
"#
}

says! {
    a_word_of_a_choice_gets_the_nearest: "draw points(\"a.ply\", kernel: \"gausian\")\nrender(aov: [\"dept\"])\n",
    r#"
error[E0507]: `kernel` cannot be "gausian"
 --> scene.pss:1:30
  |
1 | draw points("a.ply", kernel: "gausian")
  |                              ^^^^^^^^^ unknown word
  = help: did you mean "gaussian"?

error[E0507]: `aov` cannot be "dept"
 --> scene.pss:2:14
  |
2 | render(aov: ["dept"])
  |              ^^^^^^ unknown word
  = help: did you mean "depth"?
"#
}

says! {
    a_half_space_is_linear: "draw half_space(x * y < 3)\n",
    r#"
error[E0508]: the condition is not linear
 --> scene.pss:1:19
  |
1 | draw half_space(x * y < 3)
  |                   ^ x, y and z may be added, and multiplied by numbers
  = help: a half-space has a flat face: `x + 2*y <= 3`
"#
}

says! {
    a_half_space_is_a_condition: "draw half_space(z)\n",
    r#"
error[E0508]: the half-space is not a condition
 --> scene.pss:1:17
  |
1 | draw half_space(z)
  |                 ^ expected a comparison
  = help: write a linear condition on x, y and z: `z < 60` or `x + 2*y <= 3`
"#
}

says! {
    a_zero_scale_is_refused: "draw sphere(r: 1).scale([1, 0, 1])\n",
    r#"
error[E0510]: the scale is zero
 --> scene.pss:1:25
  |
1 | draw sphere(r: 1).scale([1, 0, 1])
  |                         ^^^^^^^^^ flattens the shape to nothing
  = help: a scale is any number but zero
"#
}

says! {
    a_material_is_wanted: "draw sphere(r: 1).with(#fff)\n",
    r#"
error[E0501]: `material` wants a material, found a colour
 --> scene.pss:1:24
  |
1 | draw sphere(r: 1).with(#fff)
  |                        ^^^^ a colour
  = help: write a material of this colour, such as `matte(#b8683c)`
"#
}
