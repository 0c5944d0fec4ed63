//! Objects within objects: an expression means the same whether its parts are written out or are objects of their own, to
//! the bit where both stand in one frame; instances of one object are where copies of its leaves would be.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::forest;
use glam::{DAffine3, DQuat, DVec3};
use pss::csg::{Boundary, Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Interval, Placement, Ray};

const TREES: u64 = 600;
const RAYS: usize = 100;

/// Some subtrees of an expression made objects; each of its leaves goes where the expression has it.
struct Grouping<'a> {
    leaves: &'a [Leaf],
    out: Vec<Leaf>,
    groups: usize,
}

impl Grouping<'_> {
    fn new(leaves: &[Leaf]) -> Grouping<'_> {
        Grouping { leaves, out: Vec::new(), groups: 0 }
    }

    fn push(&mut self, leaf: Leaf) -> Expr {
        self.out.push(leaf);
        Expr::Leaf(self.out.len() as u32 - 1)
    }

    fn take(&mut self, draws: &mut Draws, expr: &Expr) -> Expr {
        if draws.chance(0.4) {
            let mut inner = Grouping::new(self.leaves);
            let expr = inner.below(draws, expr);
            self.groups += 1 + inner.groups;
            return self.push(Leaf::instance(&Object::new(inner.out, &expr), Placement::IDENTITY));
        }
        self.below(draws, expr)
    }

    fn below(&mut self, draws: &mut Draws, expr: &Expr) -> Expr {
        let mut all = |list: &[Expr]| list.iter().map(|e| self.take(draws, e)).collect();
        match expr {
            Expr::Leaf(i) => self.push(self.leaves[*i as usize].clone()),
            Expr::Or(list) => Expr::Or(all(list)),
            Expr::And(list) => Expr::And(all(list)),
            Expr::Xor(list) => Expr::Xor(all(list)),
            Expr::Not(inner) => Expr::Not(Box::new(self.take(draws, inner))),
            Expr::Shared(inner) => self.take(draws, inner),
        }
    }
}

/// As in scenes, whatever stands below a complement is a cutter.
fn mark_cutters(leaves: &mut [Leaf], expr: &Expr, taken: bool) {
    match expr {
        Expr::Leaf(i) => leaves[*i as usize].cutter |= taken,
        Expr::Not(inner) => mark_cutters(leaves, inner, true),
        Expr::Shared(inner) => mark_cutters(leaves, inner, taken),
        Expr::Or(list) | Expr::And(list) | Expr::Xor(list) => {
            list.iter().for_each(|e| mark_cutters(leaves, e, taken));
        }
    }
}

/// A boundary with ranks in place of indices: those of leaves stand for them, whatever their order.
fn known(object: &Object, b: &Boundary) -> String {
    let rank = |index: u32| object.part(index).leaf.rank;
    let Boundary { t, leaf, crossing, normal, flipped, filler } = *b;
    // A normal turned twice has no zeros below zero.
    let (owner, fills, normal) = (rank(leaf), filler.map(rank), normal + DVec3::ZERO);
    format!("t {t:?} of {owner} filled by {fills:?}, flipped {flipped}, {normal:?}, {crossing:?}")
}

/// All ends of spans; `films` keeps those that stand nearer to each other than any clean-up here reaches.
fn ends(object: &Object, ray: &Ray, films: bool, scratch: &mut Scratch) -> Vec<String> {
    let mut out = Spans::new();
    object.spans(ray, Interval::ALL, scratch, &mut out);
    let all: Vec<Boundary> = out.iter().flat_map(|s| [s.enter, s.exit]).flatten().collect();
    let near = |a: &Boundary, b: &Boundary| a.t != b.t && (a.t - b.t).abs() < 1e-12 * (1.0 + a.t.abs());
    let kept = |b: &&Boundary| films || !all.iter().any(|other| near(b, other));
    all.iter().filter(kept).map(|b| known(object, b)).collect()
}

#[test]
fn parts_that_are_objects_mean_what_they_mean_written_out() {
    let (mut scratch, mut wrong) = (Scratch::default(), Vec::new());
    let (mut groups, mut met, mut thin) = (0, 0, 0);
    for seed in 0..TREES {
        let mut draws = Draws::new(seed);
        let mut earlier = Vec::new();
        let count = 1 + draws.below(8);
        let mut leaves: Vec<Leaf> =
            (0..count).map(|i| forest::leaf(&mut draws, &mut earlier, i as u64)).collect();
        let depth = 1 + draws.below(6);
        let expr = forest::expr(&mut draws, count, depth);
        mark_cutters(&mut leaves, &expr, false);
        let flat = Object::new(leaves.clone(), &expr);
        let mut grouping = Grouping::new(&leaves);
        let grouped = grouping.take(&mut draws, &expr);
        groups += grouping.groups;
        let nested = Object::new(grouping.out, &grouped);
        for i in 0..RAYS {
            let ray = forest::ray(&mut draws, &mut earlier);
            let mut both = |films| [&flat, &nested].map(|object| ends(object, &ray, films, &mut scratch));
            let [want, have] = both(true);
            met += want.len();
            if want != have {
                // The tolerance of a face is that of its own leaf; of one in a group in a group that of the group.
                thin += 1;
                let [want, have] = both(false);
                if want != have {
                    wrong.push(format!("{seed} {i}: want {want:#?}\nhave {have:#?}\n{grouped:?}\n{ray:?}"));
                }
                continue;
            }
            let first = |object: &Object, scratch: &mut Scratch| {
                let found = object.first(&ray, Interval::new(0.0, f64::INFINITY), scratch);
                found.map(|(b, entering)| (known(object, &b), entering))
            };
            let [want, have] = [&flat, &nested].map(|object| first(object, &mut scratch));
            assert_eq!(want, have, "tree {seed} ray {i}");
        }
    }
    assert!(500 < groups && 20_000 < met && thin < 10, "{groups} groups, {met} ends, {thin} films");
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[0]);
}

/// Two levels of instances under turns, scales and mirrors against the leaves placed one by one.
#[test]
fn instances_stand_where_copies_would() {
    let mut draws = Draws::new(7);
    let mut earlier = Vec::new();
    let map = |draws: &mut Draws| {
        let turn = DQuat::from_axis_angle(draws.direction(), draws.between(0.0, 3.0));
        let size = draws.pick(&[1.0, 0.5, 3.0]) * draws.pick(&[DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)]);
        DAffine3::from_scale_rotation_translation(size, turn, 4.0 * draws.direction())
    };
    let place = |map: DAffine3| Placement::new(map).expect("a turn can be undone");
    let (mut scratch, mut met) = (Scratch::default(), 0);
    for _ in 0..100 {
        let base: Vec<Leaf> = (0..3).map(|i| forest::leaf(&mut draws, &mut earlier, i)).collect();
        let difference = |n: u32| {
            Expr::And(vec![
                Expr::Leaf(n),
                Expr::Not(Box::new(Expr::Or(vec![Expr::Leaf(n + 1), Expr::Leaf(n + 2)]))),
            ])
        };
        let one = Object::new(base.clone(), &difference(0));
        let [outer, inner] = [(); 2].map(|()| [(); 2].map(|()| map(&mut draws)));
        let of = |object: &Object, maps: [DAffine3; 2]| {
            let leaves = maps.map(|m| Leaf::instance(object, place(m))).to_vec();
            Object::new(leaves, &Expr::Or(vec![Expr::Leaf(0), Expr::Leaf(1)]))
        };
        let nested = of(&of(&one, inner), outer);
        let (mut copies, mut parts) = (Vec::new(), Vec::new());
        for m in outer.iter().flat_map(|o| inner.iter().map(move |i| *o * *i)) {
            parts.push(difference(copies.len() as u32));
            copies.extend(base.iter().map(|leaf| {
                let placed = Leaf::new(leaf.solid.clone(), place(m * leaf.place.world_from_local));
                Leaf { solid: placed.solid, place: placed.place, bounds: placed.bounds, ..leaf.clone() }
            }));
        }
        let flat = Object::new(copies, &Expr::Or(parts));
        for _ in 0..100 {
            let ray = Ray::new(10.0 * draws.direction(), draws.direction());
            let [a, b] = [&flat, &nested].map(|object| {
                let mut out = Spans::new();
                object.spans(&ray, Interval::ALL, &mut scratch, &mut out);
                out.iter().flat_map(|s| [s.enter, s.exit]).flatten().collect::<Vec<_>>()
            });
            assert_eq!(a.len(), b.len(), "{ray:?}");
            for (a, b) in a.iter().zip(&b) {
                met += 1;
                assert!((a.t - b.t).abs() <= 1e-9 * (1.0 + a.t.abs()), "{a:?} {b:?}");
                assert!((a.normal - b.normal).length() <= 1e-6, "{a:?} {b:?}");
                assert_eq!((a.leaf, a.flipped, a.filler), (b.leaf, b.flipped, b.filler));
                let (want, have) = (flat.part(a.leaf), nested.part(b.leaf));
                let point = ray.at(a.t);
                let local = |p: &pss::csg::Part| p.local_from_world.transform_point3(point);
                assert!((local(&want) - local(&have)).length() <= 1e-9 * (1.0 + local(&want).length()));
                assert!(want.stretch <= have.stretch * (1.0 + 1e-12));
            }
        }
    }
    assert!(1000 < met, "{met}");
}

/// A scene's instances as objects against the same written out, on the rays of a picture.
#[test]
fn a_picture_of_instances_is_that_of_copies() {
    let text = "
        let red = matte(#c03020)
        let blue = matte(#2030c0)
        let peg = cylinder(r: 0.2, from: [0, 0, -1], to: [0, 0, 1])
        let plate = (box(size: [3, 3, 0.4]) - peg.array([[-1, -1, 0], [-1, 0, 0], [-1, 1, 0], [0, -1, 0], [0, 0, 0],
            [0, 1, 0], [1, -1, 0], [1, 0, 0], [1, 1, 0]])).with(red).cut(blue)
        let pile = union([plate, plate.move([0, 0, 0.4]), sphere(r: 0.5, at: [0, 0, 0.8]).with(blue), sphere(r: 0.3, at: [1, 0, 0.8])])
        let ring = pile.move([12, 0, 0]).rotate_z(10deg).around(60)
        draw ring.with(red) - half_space(y < -11)
        draw ring.move([0, 0, 3]).scale([1, 1, -1]).with(blue)
        draw pile.array([[0, 0, 0], [0, 0, 0.4]])
        camera eye(eye: [25, -28, 16], look_at: [0, 0, 0], fov: 50deg)
    ";
    let read = |measure_all| {
        let mut sources = pss::source::SourceMap::default();
        let file = sources.add("test.pss", None, text);
        let (scene, _) = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]).expect("a scene");
        let options = pss::prepare::Options { measure_all, write_out: measure_all, ..Default::default() };
        pss::prepare::prepare(&scene, &options).expect("prepared").shot.world
    };
    let [nested, flat] = [false, true].map(read);
    assert!(nested.solids().leaves().len() * 10 < flat.solids().leaves().len(), "instances are objects");
    let (mut draws, mut scratch, mut met) = (Draws::new(5), Scratch::default(), 0);
    for _ in 0..4000 {
        let eye = DVec3::new(25.0, -28.0, 16.0);
        let to = DVec3::new(draws.between(-13.0, 13.0), draws.between(-13.0, 13.0), draws.between(-1.0, 2.0));
        let ray = Ray::new(eye, (to - eye).normalize());
        let [a, b] = [&flat, &nested].map(|world| {
            let range = Interval::new(0.0, f64::INFINITY);
            let hit = world.first(&ray, range, &mut scratch)?;
            Some((hit.boundary.t, world.surface(&ray, &hit), world.leaf_name(&hit).to_owned()))
        });
        let (Some((t, want, name)), Some((u, have, other))) = (&a, &b) else {
            assert_eq!(a, b);
            continue;
        };
        met += 1;
        assert!((t - u).abs() <= 1e-10 * t, "{a:?} {b:?}");
        assert!((want.normal - have.normal).length() <= 1e-9, "{a:?} {b:?}");
        assert_eq!((want.material, name), (have.material, other), "{ray:?}");
        assert!(have.offset <= 4.0 * want.offset && want.offset <= 4.0 * have.offset, "{a:?} {b:?}");
    }
    assert!(1500 < met, "{met}");
}

/// What stands twice in one place is built once.
#[test]
fn a_subtree_named_twice_is_shared() {
    let lets =
        "let peg = cylinder(r: 0.2, h: 9)\nlet cut = union([peg, peg.move([1, 0, 0]), peg.move([2, 0, 0])])";
    let read = |measure_all| {
        let mut sources = pss::source::SourceMap::default();
        let text = format!("{lets}\ndraw (sphere(r: 2) - cut) | (box(size: 3) - cut)\n");
        let file = sources.add("test.pss", None, &text);
        let (scene, _) = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]).expect("a scene");
        let options = pss::prepare::Options { measure_all, write_out: measure_all, ..Default::default() };
        pss::prepare::prepare(&scene, &options).expect("prepared").shot.world.solids().leaves().len()
    };
    assert_eq!([read(false), read(true)], [5, 8]);
}
