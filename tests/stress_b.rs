//! Part B of the numerical stress list that is about truth, not about volumes (`csg_flush`, `csg_volumes`): B6, every pair of
//! operators over boxes that share faces; and the degenerate operands of boolean cases 59 and 60.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::scene::{ends, errors, prepared, shot, spans};
use glam::DVec3;
use pss::csg::Scratch;
use pss::geom::Ray;
use rayon::prelude::*;

type Box3 = [[f64; 3]; 2];

/// Rays for each pair of operators, bracketing and number of faces shared.
const RAYS: usize = 100_000;

/// An operator's sign and what it makes of two truths.
type Operator = (&'static str, fn(bool, bool) -> bool);

const OPERATORS: [Operator; 4] =
    [("|", |a, b| a || b), ("&", |a, b| a && b), ("-", |a, b| a && !b), ("^", |a, b| a != b)];

/// Boxes of which the first two share one, two or all six faces, and the third some of either.
fn boxes(shared: usize) -> [Box3; 3] {
    let a = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
    let b = match shared {
        1 => [[0.25, 0.5, 0.5], [1.0, 1.5, 1.25]],
        2 => [[0.25, -0.5, 0.0], [1.0, 0.75, 0.5]],
        _ => a,
    };
    [a, b, [[0.25, 0.0, -0.5], [0.75, 1.0, 0.5]]]
}

fn written([lo, hi]: &Box3) -> String {
    format!("box({lo:?}, {hi:?})")
}

fn is_inside([lo, hi]: &Box3, p: DVec3) -> bool {
    (0..3).all(|axis| lo[axis] < p[axis] && p[axis] < hi[axis])
}

/// The pieces of a line that are inside, from where it meets the planes of all faces and the truth in the middle between two:
/// neighbouring pieces as one.
fn pieces(ray: &Ray, all: &[Box3; 3], truth: impl Fn([bool; 3]) -> bool) -> Vec<[f64; 2]> {
    let levels = (0..3).flat_map(|axis| all.iter().flatten().map(move |corner| (axis, corner[axis])));
    let mut at: Vec<f64> = levels
        .map(|(axis, level)| (level - ray.origin[axis]) / ray.dir[axis])
        .filter(|t| t.is_finite())
        .collect();
    at.sort_by(f64::total_cmp);
    at.dedup_by(|a, b| (*a - *b).abs() <= 1e-13);
    let mut pieces: Vec<[f64; 2]> = Vec::new();
    for pair in at.windows(2) {
        let middle = ray.at(0.5 * (pair[0] + pair[1]));
        if !truth([0, 1, 2].map(|i| is_inside(&all[i], middle))) {
            continue;
        }
        match pieces.last_mut() {
            Some(last) if last[1] == pair[0] => last[1] = pair[1],
            _ => pieces.push([pair[0], pair[1]]),
        }
    }
    pieces
}

/// What the rays of one cell of the table meet, and what is wrong.
fn cell(shared: usize, cell: usize) -> (usize, Vec<String>) {
    let (mut scratch, mut met, mut wrong) = (Scratch::default(), 0, Vec::new());
    let mut draws = Draws::new((6 + 32 * shared + cell) as u64);
    let all = boxes(shared);
    let [(one, f), (two, g)] = [OPERATORS[cell % 4], OPERATORS[cell / 4 % 4]];
    let [x, y, z] = all.each_ref().map(written);
    let first = cell < 16;
    let text =
        if first { format!("({x} {one} {y}) {two} {z}") } else { format!("{x} {one} ({y} {two} {z})") };
    let truth = |[x, y, z]: [bool; 3]| if first { g(f(x, y), z) } else { f(x, g(y, z)) };
    let shot = shot(&format!("draw {text}"));
    for _ in 0..RAYS {
        let from = 3.0 * draws.direction() + 0.5;
        let to = DVec3::from_array(std::array::from_fn(|_| draws.between(-0.6, 1.6)));
        let ray = Ray::new(from, to - from);
        let want = pieces(&ray, &all, truth);
        let have = ends(&shot, &ray, &mut scratch);
        met += want.len();
        let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) <= 1e-12;
        if want.len() != have.len() || !want.iter().zip(&have).all(|(a, b)| near(a, b)) {
            wrong.push(format!("{text}, {shared} faces shared: {want:?}, not {have:?} on {ray:?}"));
        }
    }
    (met, wrong)
}

#[test]
fn b6_every_pair_of_operators_follows_its_truth_table() {
    let cells: Vec<(usize, usize)> =
        [1, 2, 6].into_iter().flat_map(|shared| (0..32).map(move |i| (shared, i))).collect();
    let told: Vec<_> = cells.into_par_iter().map(|(shared, i)| cell(shared, i)).collect();
    let met: usize = told.iter().map(|t| t.0).sum();
    assert!(met > 10 * RAYS, "{met}");
    let wrong: Vec<&String> = told.iter().flat_map(|t| &t.1).collect();
    assert!(wrong.is_empty(), "{} wrong, the first: {}", wrong.len(), wrong[0]);
}

#[test]
fn case_59_solids_without_a_size_are_nothing_and_a_warning() {
    let line = Ray::new(DVec3::new(0.01, 0.02, 5.0), -DVec3::Z);
    for (solid, param) in [
        ("sphere(r: 0)", "r"),
        ("cylinder(r: 1, h: 0)", "h"),
        ("box(size: [1, 1, 0])", "size"),
        ("torus(major: 1, minor: 0)", "minor"),
        ("cylinder(r: 0, h: 1)", "r"),
        ("cone(r1: 1, r2: 0.5, h: 0)", "h"),
        ("capsule(r: 0, from: [0, 0, 0], to: [1, 0, 0])", "r"),
        ("tube([[0, 0, 0], [1, 0, 0]], r: 0)", "r"),
        ("superellipsoid(r: 0)", "r"),
        ("extrude([[0, 0], [1, 0], [0, 1]], h: 0)", "h"),
    ] {
        let scene = prepared(&format!("draw {solid}"));
        assert!(spans(&scene.shot, &line, &mut Scratch::default()).is_empty(), "{solid}");
        // Cutting with nothing leaves all.
        let cut = shot(&format!("draw box(size: 2) - {solid}"));
        assert_eq!(spans(&cut, &line, &mut Scratch::default()).len(), 1, "{solid}");
        let mut sources = pss::source::SourceMap::default();
        let file = sources.add("test.pss", None, format!("draw {solid}"));
        let (_, warnings) =
            pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]).expect("a scene");
        assert!(
            warnings.iter().any(|w| w.code == "W0101" && w.message.contains(param)),
            "{solid}: {warnings:?}"
        );
    }
}

#[test]
fn case_60_parameters_that_are_no_size_are_refused_where_they_stand() {
    for (solid, code) in [
        ("sphere(r: -1)", "E0506"),
        ("cylinder(r: 1, h: -2)", "E0506"),
        ("box(size: [1, -1, 1])", "E0506"),
        ("sphere(r: 0 / 0)", "E0504"),
        ("sphere(r: 1, at: [0, 1 / 0, 0])", "E0504"),
    ] {
        let found = errors(&format!("draw {solid}"));
        assert_eq!(found.len(), 1, "{solid}: {found:?}");
        assert!(!found[0].labels.is_empty(), "{solid}: {found:?}");
        assert_eq!(found[0].code, code, "{solid}: {found:?}");
    }
}
