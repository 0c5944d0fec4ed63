//! What users are told, about how a scene is written, letter by letter.

#[macro_use]
mod lang_support;

says! {
    a_missing_comma_is_named: "draw sphere(r: 10 at: [0, 0, 0])\n",
    r#"
error[E0101]: expected `,` or `)`, found `at`
 --> scene.pss:1:19
  |
1 | draw sphere(r: 10 at: [0, 0, 0])
  |            -      ^^ does not fit here
  |            |
  |            inside this `(`
  = help: put a comma before `at`
"#
}

says! {
    a_missing_bracket_shows_the_opening_one_and_costs_one_item: "draw sphere(r: 10\nlet a = sphere(r: )\ncamera(eye: [0, 0, 1])\n",
    r#"
error[E0102]: `(` is not closed
 --> scene.pss:1:12
  |
1 | draw sphere(r: 10
  |            ^ opened here
2 | let a = sphere(r: )
  | --- expected `)` before this
  = help: add the missing `)`

error[E0101]: expected a value after `:`, found `)`
 --> scene.pss:2:19
  |
2 | let a = sphere(r: )
  |                   ^ not a value
  = help: a value is a number, a colour, a string, a list, a name or a call
"#
}

says! {
    a_wrong_bracket_shows_both: "draw box([0, 0, 0), [1, 1, 1])\n",
    r#"
error[E0102]: `)` does not close `[`
 --> scene.pss:1:18
  |
1 | draw box([0, 0, 0), [1, 1, 1])
  |          -       ^ expected `]`
  |          |
  |          opened here
  = help: put `]` before `)`
"#
}

says! {
    a_bracket_open_at_the_end_is_shown: "draw box([0, 0, 0], [1, 1, 1]\n",
    r#"
error[E0102]: `(` is not closed
 --> scene.pss:1:9
  |
1 | draw box([0, 0, 0], [1, 1, 1]
  |         ^ opened here
  = help: add the missing `)`
"#
}

says! {
    an_unknown_keyword_gets_the_nearest: "units(mm)\nlett a = 3\n",
    r#"
error[E0106]: `lett` begins no item
 --> scene.pss:2:1
  |
2 | lett a = 3
  | ^^^^ not a keyword
  = help: did you mean `let`?
"#
}

says! {
    an_unknown_first_keyword_gets_the_nearest: "drow sphere(r: 1)\n",
    r#"
error[E0106]: `drow` begins no item
 --> scene.pss:1:1
  |
1 | drow sphere(r: 1)
  | ^^^^ not a keyword
  = help: did you mean `draw`?
"#
}

says! {
    a_keyword_cannot_be_a_name: "let in = 3\n",
    r#"
error[E0101]: expected a name after `let`, found `in`
 --> scene.pss:1:5
  |
1 | let in = 3
  |     ^^ not a name
  = help: `in` is a keyword: take another name
"#
}

says! {
    an_item_that_ends_too_early_is_shown_at_its_end: "let a = 2 +\ndraw sphere(r: 1)\n",
    r#"
error[E0101]: the item ends after `+`
 --> scene.pss:1:12
  |
1 | let a = 2 +
  |            ^ expected a value after `+`
  = help: write the missing value, or remove the sign
"#
}

says! {
    a_let_needs_its_sign: "let a 3\n",
    r#"
error[E0101]: expected `=` after the name, found `3`
 --> scene.pss:1:7
  |
1 | let a 3
  |       ^ expected `=`
  = help: write `let name = value`
"#
}

says! {
    arguments_take_a_colon: "draw sphere(r = 3)\n",
    r#"
error[E0101]: `=` has no place in arguments
 --> scene.pss:1:15
  |
1 | draw sphere(r = 3)
  |               ^ expected `:`
  = help: an argument is named with a colon: `r: value`
"#
}

says! {
    a_call_opens_on_its_own_line: "draw sphere\n(r: 3)\n",
    r#"
error[E0101]: `(` stands on a line of its own
 --> scene.pss:2:1
  |
2 | (r: 3)
  | ^ what does it belong to?
  = help: the `(` of a call or an index stands on the line of what it follows
"#
}

says! {
    digits_stand_before_the_point: "let a = .5\n",
    r#"
error[E0101]: a number begins with its point
 --> scene.pss:1:9
  |
1 | let a = .5
  |         ^ digits are missing
  = help: write `0.5`
"#
}

says! {
    digits_stand_after_the_point: "let a = 5.\n",
    r#"
error[E0101]: a number ends with its point
 --> scene.pss:1:10
  |
1 | let a = 5.
  |          ^ digits are missing
  = help: write `5.0`
"#
}

says! {
    two_pi_is_a_product: "let a = 2pi\n",
    r#"
error[E0105]: `pi` is not a unit
 --> scene.pss:1:10
  |
1 | let a = 2pi
  |          ^^ not a unit
  = help: write `2 * pi`
"#
}

says! {
    an_unknown_unit_gets_the_nearest: "let a = 2dge\n",
    r#"
error[E0105]: `dge` is not a unit
 --> scene.pss:1:10
  |
1 | let a = 2dge
  |          ^^^ not a unit
  = help: did you mean `2deg`?
"#
}

says! {
    a_colour_has_three_or_six_digits: "let a = #ffff\n",
    r#"
error[E0105]: `#ffff` is not a colour
 --> scene.pss:1:9
  |
1 | let a = #ffff
  |         ^^^^^ expected 3 or 6 hexadecimal digits
  = help: write `#rgb` or `#rrggbb`, such as `#b8683c`
"#
}

says! {
    a_string_ends_on_its_line: "let a = \"abc\nlet b = 3\n",
    r#"
error[E0104]: the string does not end
 --> scene.pss:1:9
  |
1 | let a = "abc
  |         ^^^^ no closing `"` on this line
  = help: strings end on their line; a line break inside is written `\n`
"#
}

says! {
    an_unknown_escape_is_shown: "let a = \"a\\qb\"\n",
    r#"
error[E0104]: `\q` is no escape
 --> scene.pss:1:11
  |
1 | let a = "a\qb"
  |           ^^ unknown escape
  = help: the escapes are `\"` `\\` `\n` `\t`; a backslash is written `\\`
"#
}

says! {
    a_comment_must_end: "let a = 1 /* no end\n",
    r#"
error[E0108]: the comment does not end
 --> scene.pss:1:11
  |
1 | let a = 1 /* no end
  |           ^^ opened here
  = help: add the missing `*/`
"#
}

says! {
    names_are_ascii: "let größe = 3\n",
    r#"
error[E0103]: `ö` has no meaning here
 --> scene.pss:1:7
  |
1 | let größe = 3
  |       ^ unexpected character
  = help: names are made of ASCII letters, digits and `_`
"#
}

says! {
    a_semicolon_has_no_place: "let a = 3;\n",
    r#"
error[E0103]: `;` has no meaning here
 --> scene.pss:1:10
  |
1 | let a = 3;
  |          ^ unexpected character
  = help: items and expressions need nothing between them: remove it
"#
}

says! {
    a_nul_is_no_text: "let a = \"\0\"\n",
    r#"
error[E0103]: the text holds a NUL character
 --> scene.pss:1:10
  |
1 | let a = "\u{0}"
  |          ^^^^^ not text
  = help: is this a scene file?
"#
}

says! {
    comparisons_do_not_chain: "let a = 1 < 2 < 3\n",
    r#"
error[E0107]: comparisons do not chain
 --> scene.pss:1:15
  |
1 | let a = 1 < 2 < 3
  |           -   ^ a second one
  |           |
  |           the first
  = help: compare twice: `a < b and b < c`; a half-space has one side: `z < 60`
"#
}

says! {
    doubled_signs_are_explained: "let a = true && false\n",
    r#"
error[E0101]: `&&` is no operator
 --> scene.pss:1:15
  |
1 | let a = true && false
  |               ^ one sign too many
  = help: solids take `&`, conditions `and`
"#
}
