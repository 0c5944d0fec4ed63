//! What users are told about methods that place and copy shapes, and about formulas, letter by letter.

#[macro_use]
mod lang_support;

says! {
    a_mirror_wants_an_axis: "draw sphere(r: 1).mirror(\"w\")\ndraw sphere(r: 1).mirror([0, 0, 0])\ndraw sphere(r: 1).mirror(3)\ndraw sphere(r: 1).mirror(#fff)\n",
    r#"
error[E0507]: `axis` cannot be "w"
 --> scene.pss:1:26
  |
1 | draw sphere(r: 1).mirror("w")
  |                          ^^^ unknown word
  = help: write one of "x", "y", "z"

error[E0510]: the axis has no direction
 --> scene.pss:2:26
  |
2 | draw sphere(r: 1).mirror([0, 0, 0])
  |                          ^^^^^^^^^ zero
  = help: write a direction, such as `[0, 0, 1]`

error[E0501]: `axis` wants a vector of 3 numbers, found a number
 --> scene.pss:3:26
  |
3 | draw sphere(r: 1).mirror(3)
  |                          ^ a number
  = help: write `[x, y, z]`

error[E0501]: `axis` wants a vector of 3 numbers, found a colour
 --> scene.pss:4:26
  |
4 | draw sphere(r: 1).mirror(#fff)
  |                          ^^^^ a colour
  = help: write `[x, y, z]`
"#
}

says! {
    a_matrix_has_three_rows_of_four: "draw sphere(r: 1).matrix([[1, 0, 0, 0], [0, 1, 0, 0]])\ndraw sphere(r: 1).matrix([[1, 0, 0], [0, 1, 0], [0, 0, 1]])\ndraw sphere(r: 1).matrix(2)\n",
    r#"
error[E0501]: `rows` wants 3 rows of 4 numbers, found 2
 --> scene.pss:1:26
  |
1 | draw sphere(r: 1).matrix([[1, 0, 0, 0], [0, 1, 0, 0]])
  |                          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^ 2 given
  = help: write 3 rows of 4 numbers: `[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]`

error[E0501]: `rows` wants 4 numbers, found 3
 --> scene.pss:2:27
  |
2 | draw sphere(r: 1).matrix([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
  |                           ^^^^^^^^^ 3 given
  = help: write `[x, y, z, w]`

error[E0501]: `rows` wants 3 rows of 4 numbers, found a number
 --> scene.pss:3:26
  |
3 | draw sphere(r: 1).matrix(2)
  |                          ^ a number
  = help: write 3 rows of 4 numbers: `[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]`
"#
}

says! {
    a_singular_matrix_is_refused: "draw sphere(r: 1).matrix([[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 0, 0]])\n",
    r#"
error[E0505]: the matrix has no inverse
 --> scene.pss:1:26
  |
1 | draw sphere(r: 1).matrix([[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 0, 0]])
  |                          ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ flattens the shape to nothing
  = help: no row may be zero or a sum of multiples of the others
"#
}

says! {
    copies_want_a_list: "draw sphere(r: 1).array([1, 0, 0])\ndraw sphere(r: 1).array(3)\ndraw sphere(r: 1).array([[1, 0]])\ndraw sphere(r: 1).instance([[1, 0, 0], 2])\ndraw sphere(r: 1).instance([[[1, 0, 0, 0], [2, 0, 0, 0], [0, 0, 1, 0]]])\n",
    r#"
error[E0501]: `list` wants a list of vectors, found a vector
 --> scene.pss:1:25
  |
1 | draw sphere(r: 1).array([1, 0, 0])
  |                         ^^^^^^^^^ a vector
  = help: write a list of them, such as `[[0, 0, 0], [10, 0, 0]]`

error[E0501]: `list` wants a list of vectors, found a number
 --> scene.pss:2:25
  |
2 | draw sphere(r: 1).array(3)
  |                         ^ a number
  = help: write a list of them, such as `[[0, 0, 0], [10, 0, 0]]`

error[E0501]: `list` wants 3 numbers, found 2
 --> scene.pss:3:26
  |
3 | draw sphere(r: 1).array([[1, 0]])
  |                          ^^^^^^ 2 given
  = help: write `[x, y, z]`

error[E0501]: `list` wants a vector of 3 numbers, found a number
 --> scene.pss:4:40
  |
4 | draw sphere(r: 1).instance([[1, 0, 0], 2])
  |                                        ^ a number
  = help: write `[x, y, z]`

error[E0505]: the matrix has no inverse
 --> scene.pss:5:29
  |
5 | draw sphere(r: 1).instance([[[1, 0, 0, 0], [2, 0, 0, 0], [0, 0, 1, 0]]])
  |                             ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ flattens the shape to nothing
  = help: no row may be zero or a sum of multiples of the others
"#
}

says! {
    copies_around_are_counted: "draw sphere(r: 1).around(0)\ndraw sphere(r: 1).around(2.5)\ndraw sphere(r: 1).around(1e7)\n",
    r#"
error[E0503]: `n` must be a whole number from 1 to 1000000
 --> scene.pss:1:26
  |
1 | draw sphere(r: 1).around(0)
  |                          ^ 0
  = help: write how many copies there shall be, such as `6`

error[E0503]: `n` must be a whole number from 1 to 1000000
 --> scene.pss:2:26
  |
2 | draw sphere(r: 1).around(2.5)
  |                          ^^^ 2.5
  = help: write how many copies there shall be, such as `6`

error[E0503]: `n` must be a whole number from 1 to 1000000
 --> scene.pss:3:26
  |
3 | draw sphere(r: 1).around(1e7)
  |                          ^^^ 10000000
  = help: write how many copies there shall be, such as `6`
"#
}

says! {
    a_cut_wants_a_material: "draw sphere(r: 1).cut(#f00)\ndraw sphere(r: 1).cut(2)\n",
    r#"
error[E0501]: `material` wants a material, found a colour
 --> scene.pss:1:23
  |
1 | draw sphere(r: 1).cut(#f00)
  |                       ^^^^ a colour
  = help: write a material of this colour, such as `matte(#b8683c)`

error[E0501]: `material` wants a material, found a number
 --> scene.pss:2:23
  |
2 | draw sphere(r: 1).cut(2)
  |                       ^ a number
  = help: name one: `material clay(color: #b8683c)`, then `.cut(clay)`
"#
}

says! {
    a_formula_is_one_comparison: "draw implicit(x + 1, inside: box(size: 1))\ndraw implicit(x == 1, inside: box(size: 1))\ndraw implicit(x < 1 and y < 1, inside: box(size: 1))\ndraw implicit(2 < 1, inside: box(size: 1))\n",
    r#"
error[E0511]: the formula is not a condition
 --> scene.pss:1:15
  |
1 | draw implicit(x + 1, inside: box(size: 1))
  |               ^^^^^ expected a comparison
  = help: write a condition on x, y and z: `x**2 + y**2 + z**2 <= 1`

error[E0511]: the formula has no inside
 --> scene.pss:2:15
  |
2 | draw implicit(x == 1, inside: box(size: 1))
  |               ^^^^^^ a surface, not a solid
  = help: write a condition on x, y and z: `x**2 + y**2 + z**2 <= 1`

error[E0511]: the formula is a condition of several
 --> scene.pss:3:15
  |
3 | draw implicit(x < 1 and y < 1, inside: box(size: 1))
  |               ^^^^^^^^^^^^^^^ one comparison is wanted
  = help: both of two: `max(f, g) <= 0`; any of two: `min(f, g) <= 0`

error[E0511]: the formula does not depend on x, y or z
 --> scene.pss:4:15
  |
4 | draw implicit(2 < 1, inside: box(size: 1))
  |               ^^^^^ the same everywhere
  = help: write a condition on x, y and z: `x**2 + y**2 + z**2 <= 1`
"#
}

says! {
    vectors_of_a_formula_have_sizes: "draw implicit(cross([x, y], [1, 2])[0] <= 1, inside: box(size: 1))\ndraw implicit(normalize([x, y, z])[3] <= 1, inside: box(size: 1))\ndraw implicit(x % 30deg <= 1, inside: box(size: 1))\n",
    r#"
error[E0501]: `cross` wants vectors of 3 numbers, found one of 2
 --> scene.pss:1:29
  |
1 | draw implicit(cross([x, y], [1, 2])[0] <= 1, inside: box(size: 1))
  |                             ^^^^^^ a vector
  = help: write a vector, such as `[x, y, z]`

error[E0512]: there is no number 3 in this vector
 --> scene.pss:2:35
  |
2 | draw implicit(normalize([x, y, z])[3] <= 1, inside: box(size: 1))
  |                                   ^^^ no such index
  = help: write 0 to 2

error[E0203]: `%` cannot take a number and an angle
 --> scene.pss:3:17
  |
3 | draw implicit(x % 30deg <= 1, inside: box(size: 1))
  |               - ^ ----- an angle
  |               | |
  |               | does not fit its operands
  |               a number
  = help: divide an angle by a unit to get a number: `angle / 1rad`
"#
}

says! {
    angles_in_a_formula_have_a_unit: "draw implicit(sin(x) <= 0, inside: box(size: 1))\ndraw implicit(cos(x + 2*y) <= 0, inside: box(size: 1))\ndraw implicit(atan2(y, x) <= 1, inside: box(size: 1))\n",
    r#"
error[E0502]: `sin` wants an angle, found a bare number
 --> scene.pss:1:19
  |
1 | draw implicit(sin(x) <= 0, inside: box(size: 1))
  |                   ^ which unit?
  = help: write `x * 1rad`

error[E0502]: `cos` wants an angle, found a bare number
 --> scene.pss:2:19
  |
2 | draw implicit(cos(x + 2*y) <= 0, inside: box(size: 1))
  |                   ^^^^^^^ which unit?
  = help: write `(x + 2*y) * 1rad`

error[E0203]: `<=` cannot take an angle and a number
 --> scene.pss:3:27
  |
3 | draw implicit(atan2(y, x) <= 1, inside: box(size: 1))
  |               ----------- ^^ - a number
  |               |           |
  |               |           does not fit its operands
  |               an angle
  = help: divide an angle by a unit to get a number: `angle / 1rad`
"#
}

says! {
    a_formula_knows_its_functions: "draw implicit(sine(x * 1rad) <= 0, inside: box(size: 1))\ndraw implicit(sphere(r: x) <= 0, inside: box(size: 1))\ndraw implicit([x, y] <= 1, inside: box(size: 1))\ndraw implicit(sqrt(x, y) <= 1, inside: box(size: 1))\ndraw implicit(length(x) <= 1, inside: box(size: 1))\ndraw implicit(x.y <= 1, inside: box(size: 1))\n",
    r#"
error[E0511]: `sine` is no function of a formula
 --> scene.pss:1:15
  |
1 | draw implicit(sine(x * 1rad) <= 0, inside: box(size: 1))
  |               ^^^^ not known here
  = help: did you mean `sin`?

error[E0511]: `sphere` is no function of a formula
 --> scene.pss:2:15
  |
2 | draw implicit(sphere(r: x) <= 0, inside: box(size: 1))
  |               ^^^^^^ not known here
  = help: the functions are `sqrt` `abs` `floor` `ceil` `round` `exp` `ln` `sin` `cos` `tan` `asin` `acos` `atan2` `min` `max` `clamp` `mix` `length` `normalize` `dot` `cross`

error[E0203]: `<=` cannot take a vector and a number
 --> scene.pss:3:22
  |
3 | draw implicit([x, y] <= 1, inside: box(size: 1))
  |               ------ ^^ - a number
  |               |      |
  |               |      does not fit its operands
  |               a vector
  = help: numbers are wanted, or vectors of one size

error[E0406]: `sqrt` takes one argument by place
 --> scene.pss:4:23
  |
4 | draw implicit(sqrt(x, y) <= 1, inside: box(size: 1))
  |                       ^ which one is this?
  = help: it is `sqrt(x)`

error[E0501]: `length` wants vectors of one size, found a number
 --> scene.pss:5:22
  |
5 | draw implicit(length(x) <= 1, inside: box(size: 1))
  |                      ^ a number
  = help: write a vector, such as `[x, y, z]`

error[E0511]: this cannot stand in a formula of x, y and z
 --> scene.pss:6:15
  |
6 | draw implicit(x.y <= 1, inside: box(size: 1))
  |               ^^^ not a number
  = help: a formula is made of numbers, operators and functions of numbers
"#
}

says! {
    numbers_in_a_formula_are_finite: "draw implicit(x * (1 / 0) <= 1, inside: box(size: 1))\ndraw implicit(x <= \"a\", inside: box(size: 1))\n",
    r#"
error[E0504]: the result of `/` is not finite
 --> scene.pss:1:22
  |
1 | draw implicit(x * (1 / 0) <= 1, inside: box(size: 1))
  |                      ^ infinite or undefined
  = help: the right side is zero, or the left is too large

error[E0501]: `the formula` wants a number, found a string
 --> scene.pss:2:20
  |
2 | draw implicit(x <= "a", inside: box(size: 1))
  |                    ^^^ a string
  = help: write a number, such as `10`
"#
}

says! {
    a_formula_needs_bounds: "draw implicit(x <= 0)\ndraw implicit(x <= 0, inside: 3)\n",
    r#"
error[E0404]: `implicit` needs `inside`
 --> scene.pss:1:6
  |
1 | draw implicit(x <= 0)
  |      ^^^^^^^^^^^^^^^^ `inside` is missing
  = help: it is `implicit(where, inside:)`

error[E0501]: `inside` wants a shape, found a number
 --> scene.pss:2:31
  |
2 | draw implicit(x <= 0, inside: 3)
  |                               ^ a number
  = help: write a shape, such as `sphere(r: 10)`
"#
}
