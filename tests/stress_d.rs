//! Section D of the stress list: scales, places and transforms, each against its untransformed twin or a closed form.

mod csg_support;
mod solid_support;

use csg_support::scene::{errors, shot, spans};
use glam::{DAffine3, DMat3, DQuat, DVec3, dvec3};
use pss::csg::Scratch;
use pss::geom::{Interval, Placement, Ray};
use pss::num::hash::Stream;
use pss::shot::Shot;
use solid_support::{EPS, cube, line, normal, solid, ts};

/// A scene of every kind of solid, cut and joined, about 10 across.
const SCENE: &str = "(box([-3, -2, -1], [3, 2, 1], round: 0.25) | cone(r1: 1.5, r2: 0.5, h: 3)) \
    - torus(major: 2, minor: 0.5).move([0, 0, 1]) - cylinder(r: 0.4, from: [0, 0, -2], to: [0, 0, 4]) \
    - superellipsoid(r: [0.7, 0.9, 0.5], e1: 0.5, e2: 1.5).move([2, 1, 1])";

const SCENE2: &str = "capsule(r: 0.5, from: [-3, 0, 2], to: [3, 1, 3]) | tube([[-2, -2, 3], [0, 2, 3], [2, -2, 2]], r: 0.3) \
    | sphere(r: [1, 2, 0.5], at: [0, 0, -3])";

fn scene(of: &str, methods: &str) -> Shot {
    let (base, rest) = of.split_once(" - ").unwrap_or((of, ""));
    let cutters = rest.split(" - ").filter(|c| !c.is_empty()).collect::<Vec<_>>().join(", ");
    shot(&format!("draw difference({base}, [{cutters}]){methods}"))
}

/// A ray through the scene.
fn aimed(stream: &mut Stream) -> Ray {
    let at = 3.0 * cube(stream);
    let d = stream.direction();
    Ray::new(at - 12.0 * d, d)
}

type Ends = Vec<(f64, u32, f64)>;

/// t, leaf and |d.n| of all boundaries.
fn ends(shot: &Shot, ray: &Ray, scratch: &mut Scratch) -> Ends {
    let all = spans(shot, ray, scratch);
    let length = ray.dir.length();
    let ends = all.iter().flat_map(|s| [s.enter, s.exit]).flatten();
    ends.map(|b| (b.t, b.leaf, ray.dir.dot(b.normal).abs() / length)).collect()
}

/// How many of the rays see other leaves than the twin; the others agree along the normal to `limit`.
fn compare(twin: &Shot, other: &Shot, map: &DAffine3, limit: f64, rays: usize) -> usize {
    let (mut scratch, mut stream, mut unlike, mut met) = (Scratch::default(), Stream::new(2), 0, 0);
    for _ in 0..rays {
        let ray = aimed(&mut stream);
        let here = ends(twin, &ray, &mut scratch);
        let there = ends(other, &ray.transformed(map), &mut scratch);
        met += here.len();
        if here.len() != there.len() || here.iter().zip(&there).any(|(a, b)| a.1 != b.1) {
            unlike += 1;
            continue;
        }
        for (a, b) in here.iter().zip(&there) {
            let far = (a.0 - b.0).abs() * a.2.min(b.2);
            assert!(far <= limit, "{ray:?} {a:?} {b:?}: {far:e}");
        }
    }
    assert!(rays / 4 < met, "{met}");
    unlike
}

#[test]
fn d1_a_scene_at_any_scale_is_the_same_scene() {
    for of in [SCENE, SCENE2] {
        let twin = scene(of, "");
        for j in -6..=6 {
            let by = 10f64.powi(j);
            let large = scene(of, &format!(".scale({by:?})"));
            let unlike = compare(&twin, &large, &DAffine3::from_scale(DVec3::splat(by)), 1e-12 * 20.0, 2000);
            assert_eq!(unlike, 0, "10^{j}");
        }
        for j in [-20, 20] {
            let by = 2f64.powi(j);
            let large = scene(of, &format!(".scale({by:?})"));
            let unlike = compare(&twin, &large, &DAffine3::from_scale(DVec3::splat(by)), 0.0, 5000);
            assert_eq!(unlike, 0, "2^{j}");
        }
    }
}

#[test]
fn d2_a_small_sphere_on_a_large_slab() {
    let shot = shot("draw box([-1e6, -1e6, -1e6], [1e6, 1e6, 0])\ndraw sphere(r: 1e-6, at: [0, 0, 1e-6])");
    let mut scratch = Scratch::default();
    let (size, mut hits, mut shadows) = (200, 0, 0);
    for i in 0..size * size {
        let [x, y] = [i % size, i / size].map(|k| (f64::from(k) + 0.5) / f64::from(size) * 4e-6 - 2e-6);
        let down = Ray::new(dvec3(x, y, 1e-3), DVec3::NEG_Z);
        let hit = shot.world.first(&down, Interval::AHEAD, &mut scratch).expect("the slab");
        hits += i32::from(hit.boundary.leaf == 1);
        // The shadow of a sun straight above, seen from the slab.
        let floor = Ray::new(dvec3(x, y, 0.0) + 1e-9 * DVec3::Z, DVec3::Z);
        shadows += i32::from(shot.world.blocked(&floor, Interval::AHEAD, &mut scratch));
    }
    let area = |n: i32| f64::from(n) / f64::from(size * size) * 16.0;
    for n in [hits, shadows] {
        assert!((area(n) / std::f64::consts::PI - 1.0).abs() < 0.01, "{}", area(n));
    }
}

#[test]
fn d3_a_scene_moved_far_away_is_the_same_scene() {
    for of in [SCENE, SCENE2] {
        let twin = scene(of, "");
        for j in 0..=7 {
            let far = 10f64.powi(j);
            let to = far * dvec3(1.0, -0.7, 0.3);
            let moved = scene(of, &format!(".move([{:?}, {:?}, {:?}])", to.x, to.y, to.z));
            let ulp = far.next_up() - far;
            let limit = 16.0 * ulp.max(20.0 * EPS);
            let unlike = compare(&twin, &moved, &DAffine3::from_translation(to), limit, 3000);
            // Only rays at edges can tell them apart.
            assert!(unlike <= if j < 6 { 0 } else { 3 }, "10^{j}: {unlike}");
        }
    }
}

#[test]
fn d4_long_and_thin_solids_keep_their_digits() {
    let block = solid("box(size: [1e6, 1, 1e-6])");
    for axis in 0..3 {
        let half = 0.5 * [1e6, 1.0, 1e-6][axis];
        assert_eq!(ts(&*block, &Ray::new(DVec3::ZERO, DVec3::AXES[axis])), [-half, half]);
    }
    let radii = dvec3(1e3, 1.0, 1e-3);
    let egg = solid("sphere(r: [1000, 1, 0.001])");
    let mut stream = Stream::new(4);
    for _ in 0..20_000 {
        let (a, b) = (radii * cube(&mut stream), radii * 3.0 * stream.direction());
        let ray = Ray::new(b, a - b);
        for c in line(&*egg, &ray).0 {
            let at = ray.at(c.t);
            let unit = at / radii;
            // Off the surface along the normal, in units of the point's own coordinates.
            let gradient = unit / radii;
            let rounding = gradient.abs().dot(at.abs().max(ray.origin.abs())).max(1.0);
            assert!((unit.length() - 1.0).abs() <= 64.0 * EPS * rounding, "{ray:?}");
            let n = normal(&*egg, &ray, &c);
            assert!(n.distance(gradient.normalize()) <= 1e-12 && (n.length() - 1.0).abs() <= 1e-15);
        }
    }
}

/// t of an instance is t of the world: an ellipsoid is a sphere scaled, its closed form the same to 4 ulp.
#[test]
fn d5_t_survives_uneven_scales() {
    let (ball, egg) = (shot("draw sphere(r: 1).scale([4, 0.5, 2])"), solid("sphere(r: [4, 0.5, 2])"));
    let (mut scratch, mut stream) = (Scratch::default(), Stream::new(5));
    for i in 0..20_000 {
        let at = dvec3(4.0, 0.5, 2.0) * 0.55 * cube(&mut stream);
        let d = stream.direction() * 10f64.powf(6.0 * stream.unit() - 3.0);
        // From within, and from without: as many of its own lengths away as leave both ends ahead.
        let ray = Ray::new(at - f64::from(i % 2) * 10.0 * d.normalize(), d);
        let have: Vec<f64> = ends(&ball, &ray, &mut scratch).iter().map(|e| e.0).collect();
        let want = ts(&*egg, &ray);
        let ulp = |t: f64| t.abs().next_up() - t.abs();
        assert_eq!(have.len(), want.len());
        assert!(have.iter().zip(&want).all(|(a, b)| (a - b).abs() <= 4.0 * ulp(*b)), "{have:?} {want:?}");
    }
}

#[test]
fn d6_mirrored_scenes_have_mirrored_spans_and_outward_normals() {
    let mut scratch = Scratch::default();
    for (methods, flip) in
        [(".scale([-1, 1, 1])", dvec3(-1.0, 1.0, 1.0)), (".scale([-1, -1, 1])", dvec3(-1.0, -1.0, 1.0))]
    {
        for of in [SCENE, SCENE2] {
            let unlike = compare(&scene(of, ""), &scene(of, methods), &DAffine3::from_scale(flip), 0.0, 3000);
            assert_eq!(unlike, 0);
        }
        let notched =
            shot(&format!("draw (box([0, 0, 0], [1, 1, 1]) - box([0.5, 0.5, 0], [1, 1, 1])){methods}"));
        let (mut stream, mut crossed, mut volume) = (Stream::new(6), 0u32, 0.0);
        let (chords, radius) = (200_000, 0.9);
        for _ in 0..chords {
            let ray = Ray::chord(&mut stream, 0.5 * flip, radius);
            for s in spans(&notched, &ray, &mut scratch) {
                volume += s.interval().length() * ray.dir.length();
                for b in [s.enter, s.exit].into_iter().flatten() {
                    crossed += 1;
                    let out = ray.dir.dot(b.normal);
                    assert!((s.enter == Some(b)) == (out < 0.0));
                }
            }
        }
        // Crofton: a chord of a sphere of area S crosses an area A 2 A / S times, and is in a volume V for 4 V / S.
        let sphere = 4.0 * std::f64::consts::PI * radius * radius;
        let area = 0.5 * sphere * f64::from(crossed) / f64::from(chords);
        let volume = 0.25 * sphere * volume / f64::from(chords);
        assert!((area / 5.5 - 1.0).abs() < 0.01 && (volume / 0.75 - 1.0).abs() < 0.01, "{area} {volume}");
    }
}

#[test]
fn d7_ten_thousand_rotations_are_none() {
    let step = DAffine3::from_rotation_z(std::f64::consts::TAU / 1e4);
    let map = (0..10_000).fold(DAffine3::IDENTITY, |m, _| m * step);
    let place = Placement::new(map).expect("a rotation");
    let egg = solid("sphere(r: [1, 2, 3])");
    let mut stream = Stream::new(7);
    for _ in 0..1000 {
        let ray = Ray::new(4.0 * stream.direction(), 3.0 * stream.direction());
        let (here, there) = (line(&*egg, &ray).0, line(&*egg, &place.ray_to_local(&ray)).0);
        for (a, b) in here.iter().zip(&there) {
            let far = (a.t - b.t).abs() * ray.dir.dot(normal(&*egg, &ray, a)).abs();
            assert!(here.len() == there.len() && far <= 1e-11, "{far:e}");
        }
    }
    // And as the language composes them.
    let chain = ".rotate_z(0.72deg)".repeat(500);
    let unlike = compare(&scene(SCENE2, ""), &scene(SCENE2, &chain), &DAffine3::IDENTITY, 1e-11, 1000);
    assert_eq!(unlike, 0);
}

#[test]
fn d8_transforms_that_cannot_be_undone_are_told_with_their_place() {
    for method in [
        ".scale(0)",
        ".scale([1, 0, 1])",
        ".scale([1e-13, 1, 1])",
        ".scale(1 / 0)",
        ".move([1e300 * 1e300, 0, 0])",
        ".matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]])",
        ".matrix([[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]])",
        ".matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1e-13, 0]])",
        ".matrix([[1, 0, 0, 0], [0, 0 / 0, 0, 0], [0, 0, 1, 0]])",
    ] {
        for s in ["sphere(r: 1)", "torus(major: 1, minor: 0.5)"] {
            let wrong = errors(&format!("draw {s}{method}"));
            assert_eq!(wrong.len(), 1, "{s}{method}: {wrong:?}");
            assert!(!wrong[0].labels.is_empty(), "{wrong:?}");
        }
    }
}

#[test]
fn d9_a_sheared_sphere_is_the_ellipsoid_of_its_closed_form() {
    let m = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.8, 1.0, 0.0, -0.5, 0.3, 1.0]);
    let place = Placement::new(DAffine3::from_mat3(m)).expect("invertible");
    let (ball, inverse) = (solid("sphere(r: 1)"), m.inverse());
    let bounds = ball.extent_under(&place.world_from_local);
    let (mut stream, mut reach) = (Stream::new(9), DVec3::ZERO);
    for _ in 0..20_000 {
        let ray = Ray::new(3.0 * stream.direction(), stream.direction());
        for t in ts(&*ball, &place.ray_to_local(&ray)) {
            let at = ray.at(t);
            assert!(((inverse * at).length() - 1.0).abs() <= 64.0 * EPS * 3.0, "{ray:?}");
            assert!(solid_support::grown(&bounds, 3.0).contains(at));
            reach = reach.max(at.abs());
        }
    }
    // The box is tight.
    assert!((bounds.max - reach).max_element() < 0.02, "{bounds:?} {reach}");
}

#[test]
fn d10_sixty_four_transforms_and_their_inverses_are_none() {
    let mut stream = Stream::new(10);
    let (mut there, mut back) = (String::new(), String::new());
    for i in 0..64 {
        let v = cube(&mut stream);
        let (one, other) = match i % 3 {
            0 => (
                format!(".move([{:?}, {:?}, {:?}])", v.x, v.y, v.z),
                format!(".move([{:?}, {:?}, {:?}])", -v.x, -v.y, -v.z),
            ),
            1 => (format!(".rotate_x({:?}deg)", 90.0 * v.x), format!(".rotate_x({:?}deg)", -90.0 * v.x)),
            _ => {
                let s = 2f64.powf(v.x);
                (format!(".scale({s:?})"), format!(".scale({:?})", 1.0 / s))
            }
        };
        there += &one;
        back = other + &back;
    }
    let twin = scene(SCENE2, "");
    let unlike = compare(&twin, &scene(SCENE2, &(there + &back)), &DAffine3::IDENTITY, 1e-12, 2000);
    assert_eq!(unlike, 0);
    // Instances within instances, each back at the place of the one before the last.
    let mut nested = String::new();
    for _ in 0..64 {
        let v = cube(&mut stream);
        nested += &format!(".instance([[{:?}, {:?}, {:?}]]).rotate_z(31deg)", v.x, v.y, v.z);
        nested += &format!(".rotate_z(-31deg).instance([[{:?}, {:?}, {:?}]])", -v.x, -v.y, -v.z);
    }
    let unlike = compare(&twin, &scene(SCENE2, &nested), &DAffine3::IDENTITY, 1e-12, 2000);
    assert_eq!(unlike, 0);
}

/// The same part in millimetres and in metres.
#[test]
fn d11_units_change_nothing_but_the_numbers() {
    let part = |unit: &str| {
        "draw difference(box([-3mm, -2mm, -1mm], [3mm, 2mm, 1mm], round: 0.25mm), [cylinder(r: 0.4mm, from: [0, 0, -2mm], to: [0, 0, 4mm]), torus(major: 2mm, minor: 0.5mm, at: [0, 0, 1mm]), cone(r1: 1mm, r2: 0, h: 0.7mm).rotate_y(40deg)])"
            .replace("draw", &format!("units({unit})\ndraw"))
    };
    let unlike = compare(
        &shot(&part("mm")),
        &shot(&part("m")),
        &DAffine3::from_scale(DVec3::splat(1e-3)),
        1e-13,
        20_000,
    );
    assert_eq!(unlike, 0);
}

/// Where a solid stands, its box is tight: the language's `bounds` and `.fit` read it.
#[test]
fn boxes_under_a_map_are_reached_by_the_surface() {
    let map = DAffine3::from_scale_rotation_translation(
        dvec3(1.0, 2.0, 0.5),
        DQuat::from_axis_angle(dvec3(0.6, 0.0, 0.8), 0.7),
        dvec3(3.0, 1.0, -2.0),
    );
    let place = Placement::new(map).expect("invertible");
    for s in solid_support::subjects() {
        let bounds = s.solid.extent_under(&map);
        if !bounds.is_finite() {
            continue;
        }
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut stream = Stream::new(12);
        // Lines along an axis find the surface's reach along it by its own extreme points.
        for _ in 0..20_000 {
            let at = bounds.min + bounds.size() * (0.5 * cube(&mut stream) + 0.5);
            let ray = Ray::new(at, DVec3::AXES[(3.0 * stream.unit()) as usize]);
            for t in ts(&*s.solid, &place.ray_to_local(&ray)) {
                (min, max) = (min.min(ray.at(t)), max.max(ray.at(t)));
            }
        }
        let scale = bounds.diagonal();
        let grown = bounds.inflated(64.0 * EPS * (scale + 4.0));
        assert!(grown.contains(min) && grown.contains(max), "{} {bounds:?} {min} {max}", s.text);
        let loose = (min - bounds.min).max(bounds.max - max).max_element() / scale;
        assert!(loose < 0.06, "{}: {loose}", s.text);
    }
}
