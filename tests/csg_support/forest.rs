//! Random objects: leaves that like to share faces, expressions over them, and rays that like to run in faces.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DVec3};
use pss::csg::{Expr, Leaf};
use pss::geom::{Aabb, Interval, Placement, Ray};
use pss::heights::Heights;
use pss::solid::block::Block;
use pss::solid::cylinder::Cylinder;
use pss::solid::half_space::HalfSpace;
use pss::solid::heightfield::HeightField;
use pss::solid::mesh::TriangleMesh;
use pss::solid::sphere::Sphere;
use pss::solid::{Answer, Crossing, Scratch, Solid};

use super::draws::Draws;
use super::scene::shot;

/// Solids of the other kinds as texts, sized so that they meet what has small integers for coordinates.
const OTHERS: [&str; 14] = [
    "torus(major: 1, minor: 0.25)",
    "torus(major: 0.5, minor: 1)",
    "cone(r1: 1, r2: 0, h: 2)",
    "cone(r1: 0.5, r2: 1, h: 1)",
    "capsule(r: 0.5, from: [0, 0, 0], to: [1, 0, 0])",
    "box([-1, -1, -1], [1, 1, 1], round: 0.25)",
    "tube([[0, 0, 0], [1, 0, 0], [1, 1, 1]], r: 0.25)",
    "superellipsoid(r: 1, e1: 0.4, e2: 0.6)",
    "quadric(squares: [1, 1, -1], constant: -0.25)",
    "implicit(x**4 + y**4 + z**4 - 5 * (x**2 + y**2 + z**2) + 11.8 <= 0, inside: box(size: 6))",
    "extrude([[0, 0], [2, 0], [2, 2], [1, 1], [0, 2]], h: 1)",
    "extrude([[0, 0], [2, 0], [1, 2]], h: 2, twist: 90deg)",
    "revolve([[0.5, 0], [1.5, 0], [1, 1]])",
    "points(sphere(r: 1), samples: 400)",
];

/// A solid of each other kind, made once.
fn others() -> &'static [Arc<dyn Solid>] {
    static MADE: OnceLock<Vec<Arc<dyn Solid>>> = OnceLock::new();
    MADE.get_or_init(|| {
        let first = |text: &&str| shot(&format!("draw {text}")).world.solids().leaves()[0].solid.clone();
        let mut all: Vec<Arc<dyn Solid>> = OTHERS.iter().map(first).collect();
        let corners = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
        let faces = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
        let mesh = pss::mesh::read(format!("{corners}{faces}").as_bytes()).expect("an octahedron");
        all.push(Arc::new(TriangleMesh::new(mesh)));
        let values = (0..16).map(|i| [0.0, 0.5, 0.25, 1.0][i % 4 * (i / 4) % 4]).collect();
        let heights = Heights { width: 4, depth: 4, values, notes: Vec::new() };
        all.push(Arc::new(HeightField::new(heights, DVec3::new(2.0, 2.0, 1.0))));
        all
    })
}

/// A solid that does not say that it is of closed form: objects with it go the long way.
#[derive(Debug)]
struct Slow(Arc<dyn Solid>);

impl Solid for Slow {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn crossings(&self, ray: &Ray, range: Interval, s: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        self.0.crossings(ray, range, s, out)
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        self.0.normal(ray, crossing, scratch)
    }
}

/// A random leaf. `earlier` holds the coordinates already in play.
pub fn leaf(draws: &mut Draws, earlier: &mut Vec<f64>, rank: u64) -> Leaf {
    let place = placement(draws, earlier);
    let solid = solid(draws, earlier);
    let mut leaf = Leaf::new(if draws.chance(0.2) { Arc::new(Slow(solid)) } else { solid }, place);
    leaf.rank = rank;
    leaf.material = draws.chance(0.5).then(|| draws.below(4) as u32);
    leaf.cutter = draws.chance(0.3);
    leaf
}

/// The leaf, but that it does not say that it is of closed form.
pub fn slow(leaf: &Leaf) -> Leaf {
    Leaf { solid: Arc::new(Slow(leaf.solid.clone())), ..leaf.clone() }
}

/// A ball, a box or a cylinder of about unit size at one of two hundred places along x, now and then a torus around two.
pub fn in_a_row(draws: &mut Draws, rank: u64) -> Leaf {
    let x = draws.below(200) as f64;
    let solid: Arc<dyn Solid> = match draws.below(4) {
        0 => Arc::new(Sphere { center: DVec3::X * x, radii: DVec3::splat(0.5) }),
        1 => {
            let (min, max) = (DVec3::new(x, -0.5, -0.5), DVec3::new(x + 1.0, 0.5, 0.5));
            Arc::new(Block(Aabb { min, max }))
        }
        2 => Arc::new(Cylinder::new(0.5, DVec3::X * x, DVec3::X * (x + 1.0))),
        _ => {
            let moved = Placement::new(DAffine3::from_translation(DVec3::X * x)).expect("a move");
            return Leaf { rank, ..Leaf::new(others()[0].clone(), moved) };
        }
    };
    let mut leaf = Leaf::new(solid, Placement::IDENTITY);
    (leaf.rank, leaf.material) = (rank, draws.chance(0.5).then(|| draws.below(4) as u32));
    leaf
}

/// A half-space that holds the origin well, or a ball or a box around it, in its place or turned.
pub fn plain_leaf(draws: &mut Draws, earlier: &mut Vec<f64>, rank: u64) -> Leaf {
    let solid: Arc<dyn Solid> = match draws.below(8) {
        0 => Arc::new(Sphere { center: draws.direction(), radii: DVec3::splat(draws.between(2.0, 4.0)) }),
        1 => {
            let half = DVec3::splat(draws.pick(&[1.0, 1.5, 2.0]));
            Arc::new(Block(Aabb { min: -half, max: half }))
        }
        _ => {
            let normal = if draws.chance(0.3) { draws.pick(&DVec3::AXES) } else { draws.direction() };
            let offset =
                if draws.chance(0.5) { draws.pick(&[1.0, 1.5, 2.0]) } else { draws.between(0.8, 2.0) };
            Arc::new(HalfSpace { normal, offset })
        }
    };
    let turn = DAffine3::from_axis_angle(draws.pick(&DVec3::AXES), draws.pick(&[0.0, 0.0, 0.5, 0.3]) * PI);
    earlier.push(draws.between(-1.0, 1.0));
    let mut leaf = Leaf::new(solid, Placement::new(turn).unwrap_or(Placement::IDENTITY));
    (leaf.rank, leaf.material) = (rank, draws.chance(0.5).then(|| draws.below(4) as u32));
    leaf
}

fn solid(draws: &mut Draws, earlier: &mut Vec<f64>) -> Arc<dyn Solid> {
    let radius = |d: &mut Draws, e: &mut Vec<f64>| d.coordinate(e).abs().max(1e-3);
    match draws.below(6) {
        5 => draws.among(others()).clone(),
        0 => {
            let center = draws.vector(earlier);
            let r = radius(draws, earlier);
            let radii = if draws.chance(0.7) { DVec3::splat(r) } else { r * DVec3::new(1.0, 2.0, 0.5) };
            Arc::new(Sphere { center, radii })
        }
        1 => {
            let (from, mut to) = (draws.vector(earlier), draws.vector(earlier));
            if draws.chance(0.6) {
                (to.x, to.y) = (from.x, from.y);
            }
            Arc::new(Cylinder::new(radius(draws, earlier), from, to))
        }
        2 => {
            let normal = if draws.chance(0.7) { draws.pick(&DVec3::AXES) } else { draws.direction() };
            Arc::new(HalfSpace { normal, offset: draws.coordinate(earlier) })
        }
        _ => {
            let (a, b) = (draws.vector(earlier), draws.vector(earlier));
            Arc::new(Block(Aabb { min: a.min(b), max: a.max(b) }))
        }
    }
}

fn placement(draws: &mut Draws, earlier: &mut Vec<f64>) -> Placement {
    let mut map = DAffine3::IDENTITY;
    for _ in 0..draws.below(4) {
        let step = match draws.below(5) {
            0 => DAffine3::from_translation(draws.vector(earlier)),
            1 => DAffine3::from_axis_angle(draws.pick(&DVec3::AXES), draws.pick(&[0.5, 1.0, 1.5]) * PI),
            2 => DAffine3::from_axis_angle(draws.direction(), draws.between(0.0, PI)),
            3 => DAffine3::from_scale(draws.pick(&[DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)])),
            _ => DAffine3::from_scale(DVec3::new(draws.pick(&[1.0, 3.0]), 1.0, draws.pick(&[1.0, 0.25]))),
        };
        map = step * map;
    }
    Placement::new(map).unwrap_or(Placement::IDENTITY)
}

/// A random expression over `leaves` leaves, some used more than once.
pub fn expr(draws: &mut Draws, leaves: usize, depth: usize) -> Expr {
    if depth == 0 || draws.chance(0.15) {
        return Expr::Leaf(draws.below(leaves) as u32);
    }
    if draws.chance(0.15) {
        return Expr::Not(Box::new(expr(draws, leaves, depth - 1)));
    }
    let list = (0..1 + draws.below(3)).map(|_| expr(draws, leaves, depth - 1)).collect();
    match draws.below(5) {
        0 | 1 => Expr::Or(list),
        2 => Expr::And(list),
        3 => Expr::Xor(list),
        _ => {
            let base = expr(draws, leaves, depth - 1);
            Expr::And(vec![base, Expr::Not(Box::new(Expr::Or(list)))])
        }
    }
}

/// A ray: along an axis, along small integers, or any; from coordinates in play.
pub fn ray(draws: &mut Draws, earlier: &mut Vec<f64>) -> Ray {
    let small = |d: &mut Draws| d.below(5) as f64 - 2.0;
    let mut origin = draws.vector(earlier);
    let dir = match draws.below(4) {
        0 => draws.pick(&DVec3::AXES) * draws.pick(&[-1.0, 1.0, 2.0]),
        1 => DVec3::new(small(draws), small(draws), small(draws)),
        _ => 10f64.powf(draws.between(-1.0, 1.0)) * draws.direction(),
    };
    let dir = if dir == DVec3::ZERO { DVec3::X } else { dir };
    if draws.chance(0.3) {
        origin -= dir * draws.between(0.0, 100.0);
    }
    Ray::new(origin, dir)
}

/// The same expression with the operands of each node in another order.
pub fn permuted(draws: &mut Draws, expr: &Expr) -> Expr {
    let mut again = |list: &[Expr]| {
        let mut list: Vec<Expr> = list.iter().map(|e| permuted(draws, e)).collect();
        draws.shuffle(&mut list);
        list
    };
    match expr {
        Expr::Leaf(i) => Expr::Leaf(*i),
        Expr::Or(list) => Expr::Or(again(list)),
        Expr::And(list) => Expr::And(again(list)),
        Expr::Xor(list) => Expr::Xor(again(list)),
        Expr::Not(inner) => Expr::Not(Box::new(permuted(draws, inner))),
        Expr::Shared(inner) => Expr::Shared(Arc::new(permuted(draws, inner))),
    }
}

/// The same expression with other brackets: every list is cut into lists of lists.
pub fn bracketed(draws: &mut Draws, expr: &Expr) -> Expr {
    let mut again = |list: &[Expr], node: fn(Vec<Expr>) -> Expr| {
        let mut list: Vec<Expr> = list.iter().map(|e| bracketed(draws, e)).collect();
        while 2 < list.len() {
            let at = draws.below(list.len() - 1);
            let pair: Vec<Expr> = list.drain(at..at + 2).collect();
            list.insert(at, node(pair));
        }
        node(list)
    };
    match expr {
        Expr::Leaf(i) => Expr::Leaf(*i),
        Expr::Or(list) => again(list, Expr::Or),
        Expr::And(list) => again(list, Expr::And),
        Expr::Xor(list) => again(list, Expr::Xor),
        Expr::Not(inner) => Expr::Not(Box::new(bracketed(draws, inner))),
        Expr::Shared(inner) => Expr::Shared(Arc::new(bracketed(draws, inner))),
    }
}
