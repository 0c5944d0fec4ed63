//! What users are told, about operators, names and arguments, letter by letter.

#[macro_use]
mod lang_support;

says! {
    mixed_operators_get_both_readings: "let a = sphere(r: 1)\nlet b = sphere(r: 2)\nlet c = sphere(r: 3)\ndraw a - b | c\n",
    r#"
error[E0201]: `-` and `|` stand together without parentheses
 --> scene.pss:4:12
  |
4 | draw a - b | c
  |        -   ^ which comes first?
  |        |
  |        the first operator
  = help: write `(a - b) | c` or `a - (b | c)`
"#
}

says! {
    mixing_is_refused_whatever_the_operands_are: "let a = 1 | 2 & 3 & 4\n",
    r#"
error[E0201]: `|` and `&` stand together without parentheses
 --> scene.pss:1:15
  |
1 | let a = 1 | 2 & 3 & 4
  |           -   ^ which comes first?
  |           |
  |           the first operator
  = help: write `(1 | 2) & 3 & 4`, or put the parentheses where they are meant
"#
}

says! {
    a_sum_of_solids_names_the_union: "draw sphere(r: 1) + sphere(r: 2)\n",
    r#"
error[E0202]: `+` does not combine a shape and a shape
 --> scene.pss:1:19
  |
1 | draw sphere(r: 1) + sphere(r: 2)
  |      ------------ ^ ------------ a shape
  |      |            |
  |      |            an operator of numbers
  |      a shape
  = help: the union of two shapes is `a | b`
"#
}

says! {
    a_product_of_solids_names_the_intersection: "draw sphere(r: 1) * sphere(r: 2)\n",
    r#"
error[E0202]: `*` does not combine a shape and a shape
 --> scene.pss:1:19
  |
1 | draw sphere(r: 1) * sphere(r: 2)
  |      ------------ ^ ------------ a shape
  |      |            |
  |      |            an operator of numbers
  |      a shape
  = help: the intersection of two solids is `a & b`
"#
}

says! {
    numbers_are_no_operands_of_sets: "draw sphere(r: 1) | 3\n",
    r#"
error[E0203]: `|` combines shapes, not a number
 --> scene.pss:1:21
  |
1 | draw sphere(r: 1) | 3
  |                   - ^ a number
  |                   |
  |                   wants shapes on both sides
  = help: write a shape, such as `sphere(r: 10)`
"#
}

says! {
    a_list_is_no_operand: "draw sphere(r: 1) - [sphere(r: 2)]\n",
    r#"
error[E0203]: `-` combines shapes, not a list
 --> scene.pss:1:21
  |
1 | draw sphere(r: 1) - [sphere(r: 2)]
  |                   - ^^^^^^^^^^^^^^ a list
  |                   |
  |                   wants shapes on both sides
  = help: combine a list: `union(list)`
"#
}

says! {
    an_empty_intersection_is_refused: "draw intersection([])\n",
    r#"
error[E0303]: the intersection of an empty list is all of space
 --> scene.pss:1:19
  |
1 | draw intersection([])
  |                   ^^ no shapes
  = help: give it at least one shape
"#
}

says! {
    an_unknown_name_gets_the_nearest: "let wedge = sphere(r: 1)\ndraw wegde\n",
    r#"
error[E0401]: `wegde` is not known
 --> scene.pss:2:6
  |
2 | draw wegde
  |      ^^^^^ unknown name
  = help: did you mean `wedge`?
"#
}

says! {
    an_unknown_call_gets_the_nearest: "draw shpere(r: 1)\n",
    r#"
error[E0401]: `shpere` is not known
 --> scene.pss:1:6
  |
1 | draw shpere(r: 1)
  |      ^^^^^^ unknown name
  = help: did you mean `sphere`?
"#
}

says! {
    an_unknown_argument_gets_the_nearest: "draw cylinder(raduis: 1, h: 3)\n",
    r#"
error[E0403]: `cylinder` has no argument `raduis`
 --> scene.pss:1:15
  |
1 | draw cylinder(raduis: 1, h: 3)
  |               ^^^^^^ unknown argument
  = help: it is `cylinder(r:, h:, from:, to:)`
"#
}

says! {
    an_unknown_argument_shows_the_signature: "draw sphere(radius: 1)\n",
    r#"
error[E0403]: `sphere` has no argument `radius`
 --> scene.pss:1:13
  |
1 | draw sphere(radius: 1)
  |             ^^^^^^ unknown argument
  = help: write `r:`; it is `sphere(r:, at:)`
"#
}

says! {
    an_unknown_method_gets_the_nearest: "draw sphere(r: 1).mvoe([1, 0, 0])\n",
    r#"
error[E0408]: a shape has no method `mvoe`
 --> scene.pss:1:19
  |
1 | draw sphere(r: 1).mvoe([1, 0, 0])
  |                   ^^^^ unknown method
  = help: did you mean `.move`?
"#
}

says! {
    a_missing_argument_shows_the_signature: "draw sphere(at: [0, 0, 0])\n",
    r#"
error[E0404]: `sphere` needs `r`
 --> scene.pss:1:6
  |
1 | draw sphere(at: [0, 0, 0])
  |      ^^^^^^^^^^^^^^^^^^^^^ `r` is missing
  = help: it is `sphere(r:, at:)`
"#
}

says! {
    an_argument_given_twice_shows_both: "draw box([0, 0, 0], [1, 1, 1], a: [2, 2, 2])\n",
    r#"
error[E0405]: `a` is given twice
 --> scene.pss:1:35
  |
1 | draw box([0, 0, 0], [1, 1, 1], a: [2, 2, 2])
  |          --------- the first time ^^^^^^^^^ the second time
  = help: remove one of them
"#
}

says! {
    an_argument_by_place_must_be_allowed: "draw sphere(3)\n",
    r#"
error[E0406]: the arguments of `sphere` are given by name
 --> scene.pss:1:13
  |
1 | draw sphere(3)
  |             ^ which one is this?
  = help: it is `sphere(r:, at:)`
"#
}

says! {
    operands_of_a_function_stand_in_a_list: "draw union(sphere(r: 1), sphere(r: 2))\n",
    r#"
error[E0406]: `union` takes one argument by place
 --> scene.pss:1:26
  |
1 | draw union(sphere(r: 1), sphere(r: 2))
  |                          ^^^^^^^^^^^^ which one is this?
  = help: put the operands in a list: `union([a, b])`
"#
}

says! {
    a_redefinition_shows_both: "let a = 1\nparam a = 2\n",
    r#"
error[E0402]: `a` is defined twice
 --> scene.pss:2:7
  |
1 | let a = 1
  |     - the first time
2 | param a = 2
  |       ^ the second time
  = help: take another name for one of them
"#
}

says! {
    a_cycle_is_shown_whole: "let a = b + 1\nlet b = c\nlet c = a\n",
    r#"
error[E0407]: `a` is defined by itself
 --> scene.pss:1:5
  |
1 | let a = b + 1
  |     ^ needs `b`
2 | let b = c
  |     - needs `c`
3 | let c = a
  |     - needs `a`
  = help: break the circle: one of these must not use the next
"#
}

says! {
    two_render_items_show_both: "render(samples: 4)\nrender(samples: 5)\n",
    r#"
error[E0402]: `render` is given twice
 --> scene.pss:2:1
  |
1 | render(samples: 4)
  | ------------------ the first time
2 | render(samples: 5)
  | ^^^^^^^^^^^^^^^^^^ the second time
  = help: a scene has one: remove the other
"#
}

says! {
    two_units_items_show_both: "units(mm)\nunits(cm)\n",
    r#"
error[E0402]: `units` is given twice
 --> scene.pss:2:1
  |
1 | units(mm)
  | --------- the first time
2 | units(cm)
  | ^^^^^^^^^ the second time
  = help: a scene has one: remove the other
"#
}
