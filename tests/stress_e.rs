//! Large trees: names and numbers are those of the list of numerical stress cases, section E. Work is counted, not timed;
//! times are for `cargo bench --bench csg`.

mod csg_support;

use std::sync::Arc;

use csg_support::draws::Draws;
use csg_support::scene::prepared;
use glam::{DVec3, dvec3};
use pss::csg::{Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Aabb, Interval, Placement, Ray};
use pss::solid::block::Block;
use pss::solid::sphere::Sphere;

fn ball(center: DVec3, radius: f64) -> Leaf {
    Leaf::new(Arc::new(Sphere { center, radii: DVec3::splat(radius) }), Placement::IDENTITY)
}

fn minus(base: Expr, cutter: Expr) -> Expr {
    Expr::And(vec![base, Expr::Not(Box::new(cutter))])
}

fn all(count: u32) -> Expr {
    Expr::Or((0..count).map(Expr::Leaf).collect())
}

fn spans(object: &Object, ray: &Ray, scratch: &mut Scratch) -> Vec<(f64, f64)> {
    let mut out = Spans::new();
    object.spans(ray, Interval::ALL, scratch, &mut out);
    out.iter().map(|s| (s.interval().lo, s.interval().hi)).collect()
}

/// A chain of alternating `-` and `|` over balls: from the left, from the right, and in halves.
enum Shape {
    Left,
    Right,
    Balanced,
}

fn chain(shape: &Shape, from: u32, to: u32) -> Expr {
    let op = |i: u32, a: Expr, b: Expr| if i % 2 == 1 { minus(a, b) } else { Expr::Or(vec![a, b]) };
    match shape {
        Shape::Left => (from + 1..to).fold(Expr::Leaf(from), |sum, i| op(i, sum, Expr::Leaf(i))),
        Shape::Right => (from..to - 1).rev().fold(Expr::Leaf(to - 1), |sum, i| op(i, Expr::Leaf(i), sum)),
        Shape::Balanced if to - from == 1 => Expr::Leaf(from),
        Shape::Balanced => {
            let middle = (from + to) / 2;
            op(middle, chain(shape, from, middle), chain(shape, middle, to))
        }
    }
}

/// Truth of a chain for what is inside, by its own recursion.
fn truth(shape: &Shape, inside: &[bool], from: usize, to: usize) -> bool {
    let op = |i: usize, a: bool, b: bool| if i % 2 == 1 { a && !b } else { a || b };
    match shape {
        Shape::Left => (from + 1..to).fold(inside[from], |sum, i| op(i, sum, inside[i])),
        Shape::Right => (from..to - 1).rev().fold(inside[to - 1], |sum, i| op(i, inside[i], sum)),
        Shape::Balanced if to - from == 1 => inside[from],
        Shape::Balanced => {
            let middle = (from + to) / 2;
            op(middle, truth(shape, inside, from, middle), truth(shape, inside, middle, to))
        }
    }
}

/// E1: ten thousand operators are what each point of the ray says of them, on a stack of 2 MiB, dropped too.
#[test]
fn e1_ten_thousand_operators_in_a_chain_equal_the_truth_of_points() {
    let run = || {
        const COUNT: u32 = 10_001;
        let mut draws = Draws::new(1);
        let mut axis = || draws.between(-1.0, 1.0);
        let centers: Vec<DVec3> = (0..COUNT).map(|_| DVec3::new(axis(), axis(), axis())).collect();
        let (radius, mut scratch, mut met) = (0.06, Scratch::default(), 0);
        for shape in [Shape::Left, Shape::Right, Shape::Balanced] {
            let leaves = centers.iter().map(|c| ball(*c, radius)).collect();
            let object = Object::new(leaves, &chain(&shape, 0, COUNT));
            let mut draws = Draws::new(2);
            for _ in 0..200 {
                let from = 1.7 * draws.direction();
                let ray = Ray::new(from, 1.7 * draws.direction() - from);
                let list = spans(&object, &ray, &mut scratch);
                met += list.len();
                let ends = list.iter().flat_map(|s| [s.0, s.1]);
                let ends: Vec<f64> = [-0.5].into_iter().chain(ends).chain([1.5]).collect();
                for (i, pair) in ends.windows(2).enumerate().filter(|(_, p)| 1e-9 < p[1] - p[0]) {
                    for share in [0.2, 0.5, 0.9] {
                        let p = ray.at(pair[0] + share * (pair[1] - pair[0]));
                        let inside: Vec<bool> = centers.iter().map(|c| c.distance(p) < radius).collect();
                        assert_eq!(truth(&shape, &inside, 0, COUNT as usize), i % 2 == 1, "{ray:?} {pair:?}");
                    }
                }
            }
        }
        assert!(500 < met, "{met}");
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

/// The same by names in a scene: read, checked for its size, prepared, dropped, on a stack of 2 MiB.
#[test]
fn e1_ten_thousand_named_operators_are_prepared() {
    let run = || {
        let mut text = String::from("let a0 = sphere(r: 1)\n");
        for i in 1..=10_000 {
            let op = ["|", "-"][i % 2];
            text +=
                &format!("let a{i} = a{} {op} sphere(r: 0.01, at: [0, 0, {}])\n", i - 1, 0.0001 * i as f64);
        }
        text += "draw a10000";
        let shot = prepared(&text).shot;
        let mut out = Spans::new();
        let ray = Ray::new(dvec3(-2.0, 0.0, 0.5), DVec3::X);
        shot.world.spans(&ray, Interval::ALL, &mut Scratch::default(), &mut out);
        assert!(!out.is_empty());
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

/// E2: A1 - (A2 - (A3 - ...)) of n balls, each smaller: the ray through the centre has n spans.
#[test]
fn e2_nested_shells_have_exactly_their_spans() {
    const COUNT: u32 = 10_000;
    let radius = |i: u32| 1.0 - 0.9e-4 * f64::from(i);
    let leaves = (0..COUNT).map(|i| ball(DVec3::ZERO, radius(i))).collect();
    let expr = (0..COUNT - 1).rev().fold(Expr::Leaf(COUNT - 1), |inner, i| minus(Expr::Leaf(i), inner));
    let list = spans(
        &Object::new(leaves, &expr),
        &Ray::new(dvec3(-2.0, 0.0, 0.0), DVec3::X),
        &mut Scratch::default(),
    );
    assert_eq!(list.len(), COUNT as usize);
    for (i, span) in (0..COUNT / 2).zip(&list) {
        let want = [2.0 - radius(2 * i), 2.0 - radius(2 * i + 1)];
        assert!(
            (span.0 - want[0]).abs() < 1e-15 * 4.0 && (span.1 - want[1]).abs() < 1e-15 * 4.0,
            "{span:?} {want:?}"
        );
    }
}

const SIDE: u32 = 47;

fn lattice(pitch: f64) -> Vec<Leaf> {
    let at = |i: u32| pitch * f64::from(i);
    let cells = (0..SIDE.pow(3)).map(|i| (i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE));
    cells.map(|(x, y, z)| ball(dvec3(at(x), at(y), at(z)), 1.0)).collect()
}

/// E3, E4, E5: 103,823 balls apart, overlapping, and taken from a box: exact rows, few leaves asked, on rays along axes too.
#[test]
fn e3_e4_e5_a_lattice_of_a_hundred_thousand_balls() {
    let (count, row) = (SIDE.pow(3), Ray::new(dvec3(-2.0, 25.0, 50.0), DVec3::X));
    let mut scratch = Scratch::default();
    let apart = Object::new(lattice(2.5), &all(count));
    let list = spans(&apart, &row, &mut scratch);
    assert_eq!(list.len(), SIDE as usize);
    assert!(list.iter().all(|s| s.1 - s.0 == 2.0), "{list:?}");
    assert!(scratch.solid.counts.leaf_queries < 3 * u64::from(SIDE), "{:?}", scratch.solid.counts);

    // Between the rows nothing is met, and next to nothing asked.
    let before = scratch.solid.counts.leaf_queries;
    for i in 0..40 {
        let ray = Ray::new(dvec3(-2.0, 1.25 + 2.5 * f64::from(i), 50.0), DVec3::X);
        assert_eq!(spans(&apart, &ray, &mut scratch), []);
    }
    let asked = scratch.solid.counts.leaf_queries - before;
    assert!(asked <= 80, "{asked} questions on 40 rays between the rows");

    let mut cut = lattice(2.5);
    let bounds = Aabb { min: DVec3::splat(-1.5), max: DVec3::splat(2.5 * 46.0 + 1.5) };
    cut.push(Leaf::new(Arc::new(Block(bounds)), Placement::IDENTITY));
    let cut = Object::new(cut, &minus(Expr::Leaf(count), all(count)));
    let rest = spans(&cut, &row, &mut scratch);
    assert_eq!(rest.len(), SIDE as usize + 1);
    let known = |t: f64| list.iter().any(|s| s.0 == t || s.1 == t);
    assert!(rest.iter().flat_map(|s| [s.0, s.1]).filter(|t| !known(*t)).count() == 2, "{rest:?}");

    let overlapping = Object::new(lattice(1.5), &all(count));
    let row = Ray::new(dvec3(-2.0, 15.0, 30.0), DVec3::X);
    let list = spans(&overlapping, &row, &mut scratch);
    assert!(matches!(list[..], [(a, b)] if (b - a - 71.0).abs() < 1e-12), "{list:?}");
}

/// E6: n copies in an exclusion are nothing where n is even and the thing itself where it is odd.
#[test]
fn e6_a_tower_of_exclusions() {
    let mut scratch = Scratch::default();
    let ray = Ray::new(dvec3(-2.0, 0.1, 0.2), DVec3::X);
    let alone = spans(&Object::new(vec![ball(DVec3::ZERO, 1.0)], &Expr::Leaf(0)), &ray, &mut scratch);
    for (count, want) in [(1000, vec![]), (1001, alone)] {
        let copies = (0..count).map(|_| ball(DVec3::ZERO, 1.0)).collect();
        let flat = Object::new(copies, &Expr::Xor((0..count).map(Expr::Leaf).collect()));
        assert_eq!(spans(&flat, &ray, &mut scratch), want);
        let copies = (0..count).map(|_| ball(DVec3::ZERO, 1.0)).collect();
        let nested = (1..count).fold(Expr::Leaf(0), |sum, i| Expr::Xor(vec![sum, Expr::Leaf(i)]));
        assert_eq!(spans(&Object::new(copies, &nested), &ray, &mut scratch), want);
    }
}

/// E7: a ray that misses everything asks nothing; one that begins inside asks next to nothing before it knows.
#[test]
fn e7_rays_that_miss_all_and_rays_that_begin_inside() {
    let object = Object::new(lattice(1.5), &all(SIDE.pow(3)));
    let mut scratch = Scratch::default();
    for i in 0..1000 {
        let ray = Ray::new(dvec3(-10.0, f64::from(i), -20.0), dvec3(0.3, 1.0, 0.0));
        assert_eq!(object.first(&ray, Interval::AHEAD, &mut scratch), None);
    }
    assert_eq!(scratch.solid.counts.leaf_queries, 0);
    let middle = DVec3::splat(1.5 * 23.0);
    let mut draws = Draws::new(7);
    for _ in 0..1000 {
        assert!(object.any(&Ray::new(middle, draws.direction()), Interval::AHEAD, &mut scratch));
    }
    assert!(scratch.solid.counts.leaf_queries <= 40_000, "{:?}", scratch.solid.counts);
}

/// E8: a tree of a million nodes is built and dropped on a stack of 2 MiB.
#[test]
fn e8_a_million_nodes_are_dropped() {
    let run = || {
        let deep = (0..1_000_000).fold(Expr::Leaf(0), |inner, i| match i % 3 {
            0 => Expr::Not(Box::new(inner)),
            1 => Expr::Or(vec![inner, Expr::Leaf(1)]),
            _ => Expr::And(vec![inner, Expr::Leaf(2)]),
        });
        let leaves = (0..3).map(|i| ball(dvec3(f64::from(i), 0.0, 0.0), 1.0)).collect();
        let object = Object::new(leaves, &deep);
        drop(deep);
        let list = spans(&object, &Ray::new(dvec3(-5.0, 0.0, 0.0), DVec3::X), &mut Scratch::default());
        // Between the ends of the three balls, -1 .. 1, 0 .. 2 and 1 .. 3, the truth of each operator in turn.
        let holds = |x: f64| {
            let inside: [bool; 3] = std::array::from_fn(|i| (x - i as f64).abs() < 1.0);
            (0..1_000_000).fold(inside[0], |inner, i| match i % 3 {
                0 => !inner,
                1 => inner || inside[1],
                _ => inner && inside[2],
            })
        };
        for x in [-1.5, -0.5, 0.5, 1.5, 2.5, 3.5] {
            assert_eq!(list.iter().any(|(lo, hi)| *lo < x + 5.0 && x + 5.0 < *hi), holds(x), "{x} {list:?}");
        }
        drop(object);
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap().join().unwrap();
}

/// E9: forty doublings by reference, 2^40 solids, are refused by their number before anything is built.
#[test]
fn e9_forty_doublings_are_refused_by_count() {
    let mut text = String::from("let a0 = sphere(r: 1)\n");
    for i in 1..=40 {
        text += &format!("let a{i} = a{} | a{}.move([{i}, 0, 0])\n", i - 1, i - 1);
    }
    text += "draw a40";
    let errors = csg_support::scene::errors(&text);
    assert!(errors.iter().any(|e| e.code == "E0703"), "{errors:?}");
}
