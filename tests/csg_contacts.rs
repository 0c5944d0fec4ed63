//! Boolean cases and stress cases told by closed forms on every ray: contacts, tangent planes, slivers, cavities, maps, and
//! operands that do nothing. Names and numbers are those of the lists.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::scene::picture;
use csg_support::scene::{ends, prepared, shot, spans};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use pss::csg::Scratch;
use pss::geom::{Interval, Ray};
use pss::shot::Shot;

type Ends = Vec<[f64; 2]>;

fn is_near(have: &Ends, want: &Ends, error: f64) -> bool {
    have.len() == want.len()
        && have.iter().zip(want).all(|(a, b)| (0..2).all(|i| (a[i] - b[i]).abs() <= error))
}

/// A ray from a place well outside to one near the origin.
fn inward(draws: &mut Draws) -> Ray {
    let (from, to) = (4.0 * draws.direction(), 1.2 * draws.unit() * draws.direction());
    Ray::new(from, to - from)
}

/// Where a ray's line is between two corners, by slabs.
fn slab(ray: &Ray, lo: DVec3, hi: DVec3) -> Option<[f64; 2]> {
    let [a, b] = [lo, hi].map(|corner| (corner - ray.origin) / ray.dir);
    let (t0, t1) = (a.min(b).max_element(), a.max(b).min_element());
    (t0 < t1).then_some([t0, t1])
}

/// Whether a line passes an edge of a box so near that a rounding tells whether it meets the box.
fn is_at_an_edge(ray: &Ray, lo: DVec3, hi: DVec3) -> bool {
    let [a, b] = [lo, hi].map(|corner| (corner - ray.origin) / ray.dir);
    (a.min(b).max_element() - a.max(b).min_element()).abs() < 1e-9
}

/// The union of intervals; those that touch within 1e-12 are one.
fn united(all: impl IntoIterator<Item = Option<[f64; 2]>>) -> Ends {
    let mut list: Ends = all.into_iter().flatten().collect();
    list.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut out = Ends::new();
    for next in list {
        match out.last_mut() {
            Some(last) if next[0] <= last[1] + 1e-12 => last[1] = last[1].max(next[1]),
            _ => out.push(next),
        }
    }
    out
}

/// B4 and case 40: two cubes that touch at an edge, at a corner, at a part of a face, and with an edge on a face, joined and
/// cut: on every ray what the slabs of both say.
#[test]
fn b4_case_40_boxes_that_touch_are_two_boxes() {
    let (mut scratch, mut draws, mut both) = (Scratch::default(), Draws::new(40), 0);
    let turn = ".rotate(axis: [0, 0, 1], by: 45deg)";
    let diagonal = DAffine3::from_axis_angle(DVec3::Z, std::f64::consts::FRAC_PI_4);
    let half = 0.5f64.sqrt();
    for (name, other, map, lo, hi) in [
        ("edge to edge", "box([0, 0, -1], [1, 1, 0])", DAffine3::IDENTITY, [0.0, 0.0, -1.0], [1.0, 1.0, 0.0]),
        ("corner to corner", "box([0, 0, 0], [1, 1, 1])", DAffine3::IDENTITY, [0.0; 3], [1.0; 3]),
        (
            "face to face",
            "box([0, -1.5, -0.5], [1, -0.5, 0.5])",
            DAffine3::IDENTITY,
            [0.0, -1.5, -0.5],
            [1.0, -0.5, 0.5],
        ),
        (
            "edge to face",
            "DIAMOND",
            DAffine3::from_translation(dvec3(half, -0.5, 0.0)) * diagonal,
            [-0.5, -0.5, -1.0],
            [0.5, 0.5, 0.0],
        ),
    ] {
        let diamond = format!("box([-0.5, -0.5, -1], [0.5, 0.5, 0]){turn}.move([{half:?}, -0.5, 0])");
        let other = other.replace("DIAMOND", &diamond);
        let cube = "box([-1, -1, -1], [0, 0, 0])";
        let pair = shot(&format!("draw {cube} | {other}"));
        let none = shot(&format!("draw {cube} & {other}"));
        let back = map.inverse();
        for _ in 0..20_000 {
            let ray = inward(&mut draws);
            let there = slab(&ray.transformed(&back), lo.into(), hi.into());
            let here = slab(&ray, DVec3::NEG_ONE, DVec3::ZERO);
            both += i32::from(here.is_some() && there.is_some());
            let at_an_edge = is_at_an_edge(&ray, DVec3::NEG_ONE, DVec3::ZERO)
                || is_at_an_edge(&ray.transformed(&back), lo.into(), hi.into());
            if at_an_edge {
                continue;
            }
            let want = united([here, there]);
            let have = ends(&pair, &ray, &mut scratch);
            assert!(is_near(&have, &want, 1e-12), "{name}: {have:?}, not {want:?} {ray:?}");
            assert_eq!(ends(&none, &ray, &mut scratch), Ends::new(), "{name} {ray:?}");
        }
    }
    assert!(4000 < both, "{both}");
}

/// Case 41: a plane that touches a torus twice meets it in what lies in one of two discs but not in both (Villarceau), on
/// rays in that plane; their circles have the torus's larger radius, their middles are off the axis by the smaller.
#[test]
fn case_41_the_plane_that_touches_a_torus_twice_meets_it_in_two_crescents() {
    let (torus, mut scratch) = (shot("draw torus(major: 1, minor: 0.25)"), Scratch::default());
    let tilt = 0.25f64.asin();
    let (along, across) = (dvec3(tilt.cos(), 0.0, tilt.sin()), DVec3::Y);
    let touch = (1.0 - 0.0625f64).sqrt();
    let (mut draws, mut compared, mut counts) = (Draws::new(41), 0, [0; 4]);
    for _ in 0..20_000 {
        let [a, b] = [draws.between(0.0, 6.3), draws.between(0.0, 6.3)];
        let at = |angle: f64| 2.0 * (angle.cos() * along + angle.sin() * across);
        let ray = Ray::new(at(a), (at(b) - at(a)).normalize_or_zero());
        if ray.dir == DVec3::ZERO {
            continue;
        }
        let (o, d) =
            ([ray.origin.dot(along), ray.origin.dot(across)], [ray.dir.dot(along), ray.dir.dot(across)]);
        let off = |x: f64, y: f64| ((x - o[0]) * d[1] - (y - o[1]) * d[0]).abs();
        // Where the plane touches, and along the circles, roots are double: there is another test (C7).
        let near = [-touch, touch].into_iter().any(|x| off(x, 0.0) < 1e-3);
        let graze = [-0.25, 0.25].into_iter().any(|y| (off(0.0, y) - 1.0).abs() < 1e-3);
        if near || graze {
            continue;
        }
        let chord = |y: f64| {
            let h = off(0.0, y);
            let m = d[1] * (y - o[1]) - d[0] * o[0];
            let half = (1.0 - h * h).max(0.0).sqrt();
            (h < 1.0).then_some([m - half, m + half])
        };
        let mut all: Vec<f64> = [-0.25, 0.25].into_iter().filter_map(chord).flatten().collect();
        all.sort_by(f64::total_cmp);
        let want: Ends = all.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        let have = ends(&torus, &ray, &mut scratch);
        counts[want.len()] += 1;
        compared += 1;
        assert!(is_near(&have, &want, 1e-9), "{have:?}, not {want:?} {ray:?}");
    }
    assert!(15_000 < compared && counts[..3].iter().all(|n| 1000 < *n), "{compared} {counts:?}");
}

/// Case 36: two balls that touch are two components: a ray between them meets neither, one through the point where they touch
/// both, as one span, and nothing is in both.
#[test]
fn case_36_balls_that_touch_are_two_and_have_nothing_in_common() {
    let mut scratch = Scratch::default();
    let (a, b) = ("sphere(r: 1, at: [-1, 0, 0])", "sphere(r: 1, at: [1, 0, 0])");
    let [or, and] = ["|", "&"].map(|op| shot(&format!("draw {a} {op} {b}")));
    let mut of = |shot: &Shot, x: f64, y: f64, dir: DVec3| {
        ends(shot, &Ray::new(dvec3(x, y, 0.0) - 3.0 * dir, dir), &mut scratch)
    };
    assert_eq!(of(&or, 0.0, 0.0, DVec3::X), [[1.0, 5.0]]);
    assert_eq!(of(&and, 0.0, 0.0, DVec3::X), Ends::new());
    for k in 1..=20 {
        // Beside the point where they touch: a gap of twice the height of the arc, which no clean-up closes.
        let y = 0.5f64.powi(k);
        let half = 1.0 - (1.0 - y * y).sqrt();
        let wide = of(&or, 0.0, y, DVec3::X);
        assert_eq!(wide.len(), 2, "{y}: {wide:?}");
        assert!((wide[1][0] - wide[0][1] - 2.0 * half).abs() < 1e-14, "{y}: {wide:?}");
        // Across, in the plane between them and to either side of it.
        assert_eq!(of(&or, 0.0, 0.0, dvec3(0.0, 0.6, 0.8)), Ends::new());
        assert_eq!(of(&or, y, 0.0, DVec3::Z).len(), 1);
        assert_eq!(of(&or, -y, 0.0, DVec3::Y).len(), 1);
        assert_eq!(of(&and, y, 0.0, DVec3::Z), Ends::new());
    }
}

/// Case 45: a ray exactly through the tip of a cone, cut, joined and turned about.
#[test]
fn case_45_rays_through_the_tip_of_a_cone() {
    let mut scratch = Scratch::default();
    let cone = "cone(r1: 1, r2: 0, h: 1)";
    let tip = dvec3(0.0, 0.0, 1.0);
    for (text, want) in [
        (cone.to_owned(), vec![[0.0, 1.0]]),
        (format!("box([-1, -1, 0], [1, 1, 2]) - {cone}"), vec![[-1.0, 0.0]]),
        (format!("{cone} | {cone}.mirror([0, 0, 1]).move([0, 0, 2])"), vec![[-1.0, 1.0]]),
        (format!("{cone} & half_space(z < 1)"), vec![[0.0, 1.0]]),
    ] {
        let shot = shot(&format!("draw {text}"));
        let have = ends(&shot, &Ray::new(tip, -DVec3::Z), &mut scratch);
        assert!(is_near(&have, &want, 1e-15), "{text}: {have:?}, not {want:?}");
    }
    // Steeper than the wall goes into the cone, flatter passes by; a power of two in each direction, so that t is exact.
    let cone = shot(&format!("draw {cone}"));
    for i in 0..64 {
        let angle = f64::from(i) * std::f64::consts::PI / 32.0;
        for (slope, inside) in [(0.5, true), (0.9, true), (1.1, false), (2.0, false)] {
            let dir = dvec3(slope * angle.cos(), slope * angle.sin(), -1.0);
            let have = ends(&cone, &Ray::new(tip - 2.0 * dir, dir), &mut scratch);
            let want = if inside { vec![[2.0, 3.0]] } else { Ends::new() };
            // By its other nappe, which is not part of the cone, a flatter ray has nothing to meet.
            let thick: Ends = have.iter().filter(|s| 1e-13 < s[1] - s[0]).copied().collect();
            assert!(is_near(&thick, &want, 1e-12), "{slope} {angle}: {have:?}");
        }
    }
}

/// Case 46 and B13: a cylinder that rests on a plane touches it in a line: both together have the length of both on each
/// ray, and nothing in common.
#[test]
fn case_46_a_cylinder_that_rests_on_a_plane_has_nothing_of_it() {
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(46));
    let (post, floor) = ("cylinder(r: 1, from: [-1, 0, 1], to: [1, 0, 1])", "half_space(z < 0)");
    let [or, and, minus, a, b] = [
        format!("{post} | {floor}"),
        format!("{post} & {floor}"),
        format!("{post} - {floor}"),
        post.to_owned(),
        floor.to_owned(),
    ]
    .map(|e| shot(&format!("draw {e}")));
    let box_around = Interval::new(0.0, 2.0);
    let mut met = 0;
    for _ in 0..20_000 {
        let ray = inward(&mut draws);
        let mut of = |shot: &Shot| ends(shot, &ray, &mut scratch);
        let (or, and, minus, a, b) = (of(&or), of(&and), of(&minus), of(&a), of(&b));
        let length = |list: &Ends| -> f64 {
            list.iter().map(|s| Interval::new(s[0], s[1]).intersect(box_around).length()).sum()
        };
        met += i32::from(!a.is_empty() && 0.0 < length(&b));
        assert_eq!(and, Ends::new(), "{ray:?}");
        assert_eq!(minus, a, "{ray:?}");
        assert!((length(&or) - length(&a) - length(&b)).abs() < 1e-12, "{or:?} {a:?} {b:?} {ray:?}");
    }
    assert!(5000 < met, "{met}");
}

/// B14: a cube and itself turned by `a` about an edge, one without the other: along x, at height y, two slivers of
/// y tan a and y tan a - (1 / cos a - 1), as long as they are thicker than the clean-up; then an even number of ends.
#[test]
fn b14_a_cube_and_itself_turned_a_little_leave_wedges() {
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(14));
    for j in 1..=15 {
        let a = 10f64.powi(-j);
        let wedge = shot(&format!(
            "let unit = box([0, 0, 0], [1, 1, 1])\ndraw unit ^ unit.rotate(axis: [0, 0, 1], by: {a:e}rad)"
        ));
        for _ in 0..1000 {
            // Where neither's upper or lower face is met.
            let (y, z) = (draws.between(1.1 * a, 1.0 - 1.1 * a - a * a), draws.between(0.01, 0.99));
            if j == 1 && 0.8 < y {
                continue;
            }
            let have = ends(&wedge, &Ray::new(dvec3(-1.0, y, z), DVec3::X), &mut scratch);
            let first = [1.0 - y * a.tan(), 1.0];
            let second = [1.0 + (1.0 - y * a.sin()) / a.cos(), 2.0];
            let second = [second[0].min(second[1]), second[0].max(second[1])];
            let want: Ends = [first, second].into_iter().filter(|s| s[0] < s[1]).collect();
            // Of what is about as thin as 16 eps times the lengths in play it is open whether it is there.
            if want.len() == 2 && want.iter().all(|s| 1e-12 < s[1] - s[0]) {
                assert!(is_near(&have, &want, 4e-15), "{j}: {have:?}, not {want:?} at {y}");
                let thickness = |list: &Ends| list.iter().map(|s| s[1] - s[0]).sum::<f64>();
                assert!(
                    (thickness(&have) / thickness(&want) - 1.0).abs() < 1e-2,
                    "{j}: {have:?}, not {want:?}"
                );
            } else if want.iter().all(|s| s[1] - s[0] < 1e-15) {
                assert_eq!(have, Ends::new(), "{j}");
            }
        }
        // Any ray: what lies in one of the two boxes, by slabs, where that is far from the clean-up's thickness.
        let turned = DAffine3::from_axis_angle(DVec3::Z, a).inverse();
        for _ in 0..1000 {
            let ray = inward(&mut draws);
            let have = ends(&wedge, &ray, &mut scratch);
            let both = [ray, ray.transformed(&turned)].map(|r| slab(&r, DVec3::ZERO, DVec3::ONE));
            let mut all: Vec<f64> = both.into_iter().flatten().flatten().collect();
            all.sort_by(f64::total_cmp);
            if all.windows(2).any(|w| w[1] - w[0] < 1e-11) {
                assert!(have.iter().all(|s| s[0] < s[1]), "{j}: {have:?}");
                continue;
            }
            let want: Ends = all.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
            assert!(is_near(&have, &want, 1e-13), "{j}: {have:?}, not {want:?}");
        }
    }
}

/// Case 54: a cavity that does not reach the surface: two spans on each ray through it, by the closed form.
#[test]
fn case_54_a_cavity_gives_each_ray_through_it_a_second_interval() {
    let (mut scratch, mut draws, mut two) = (Scratch::default(), Draws::new(54), 0);
    let vug = shot("draw box([-1, -1, -1], [1, 1, 1]) - sphere(r: 0.5)");
    for _ in 0..20_000 {
        let ray = inward(&mut draws);
        let Some([lo, hi]) = slab(&ray, DVec3::NEG_ONE, DVec3::ONE) else { continue };
        let d = ray.dir.length();
        let (middle, off) = (-ray.origin.dot(ray.dir) / (d * d), ray.origin.cross(ray.dir).length() / d);
        let half = (0.25 - off * off).max(0.0).sqrt() / d;
        if half * d < 1e-6 && off < 0.6 && 0.4 < off {
            continue;
        }
        let want = if 0.0 < half { vec![[lo, middle - half], [middle + half, hi]] } else { vec![[lo, hi]] };
        two += i32::from(want.len() == 2);
        let have = ends(&vug, &ray, &mut scratch);
        assert!(is_near(&have, &want, 1e-9), "{have:?}, not {want:?} {ray:?}");
    }
    assert!(5000 < two, "{two}");
}

/// Cases 61 and 62, D6 and D9: what is mirrored, scaled by other numbers along each axis or sheared has its faces where the
/// map puts them, and its normals turned outward, orthogonal to the image of every tangent.
#[test]
fn cases_61_62_mirrored_scaled_and_sheared_operands_keep_their_normals_outward() {
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(61));
    let solid = "(sphere(r: 1) - box([-2, -2, 0.25], [2, 2, 2]) - sphere(r: 0.5, at: [0, 0, -0.75]))";
    let plain = shot(&format!("draw {solid}"));
    let shear = DMat3::from_cols(DVec3::X, dvec3(0.7, 0.8, 0.0), dvec3(-0.4, 0.3, 1.5));
    let rows = shear.transpose();
    let [r0, r1, r2] =
        [rows.x_axis, rows.y_axis, rows.z_axis].map(|r| format!("[{:?}, {:?}, {:?}, 0]", r.x, r.y, r.z));
    for (method, map) in [
        (".scale([-1, 1, 1])".to_owned(), DMat3::from_diagonal(dvec3(-1.0, 1.0, 1.0))),
        (
            ".mirror([0, 0, 1]).mirror([0, 1, 0]).mirror([1, 0, 0])".to_owned(),
            DMat3::from_diagonal(DVec3::NEG_ONE),
        ),
        (".scale([0.5, 2, 1.25])".to_owned(), DMat3::from_diagonal(dvec3(0.5, 2.0, 1.25))),
        (format!(".matrix([{r0}, {r1}, {r2}])"), shear),
        (
            format!(".matrix([{r0}, {r1}, {r2}]).scale([-1, 1, 1])"),
            DMat3::from_diagonal(dvec3(-1.0, 1.0, 1.0)) * shear,
        ),
    ] {
        let mapped = shot(&format!("draw {solid}{method}"));
        let map = DAffine3::from_mat3(map);
        let mut met = 0;
        for _ in 0..5000 {
            let ray = inward(&mut draws);
            let [want, have] = [(&plain, ray), (&mapped, ray.transformed(&map))]
                .map(|(shot, ray)| spans(shot, &ray, &mut scratch));
            if want.iter().any(|s| s.interval().length() < 1e-6) {
                continue;
            }
            assert_eq!(want.len(), have.len(), "{method} {ray:?}");
            let all = |list: &pss::csg::Spans| -> Vec<_> {
                list.iter()
                    .flat_map(|s| [(s.enter, -1.0), (s.exit, 1.0)])
                    .filter_map(|(b, s)| Some((b?, s)))
                    .collect()
            };
            for ((a, _), (b, sign)) in all(&want).into_iter().zip(all(&have)) {
                met += 1;
                assert!((a.t - b.t).abs() <= 1e-9, "{method} {a:?} {b:?}");
                let world = (map.matrix3.inverse().transpose() * a.normal).normalize();
                assert!((world - b.normal).length() <= 1e-6, "{method}: {world} {b:?}");
                assert!(
                    0.0 <= sign * b.normal.dot(ray.transformed(&map).dir) + 1e-12,
                    "{method}: inward {b:?}"
                );
            }
        }
        assert!(5000 < met, "{met}");
    }
}

fn findings(text: &str) -> Vec<String> {
    let scene = prepared(text);
    let found = pss::check::findings(&scene.shot, &scene.outline);
    found.iter().map(|d| d.code.to_string()).collect()
}

const VIEW: &str = "camera eye(eye: [3, -4, 2.5], look_at: [0, 0, 0], fov: 40deg)
    light(direction: [-0.4, 0.6, -0.7])
    render(size: [96, 72], samples: 1, integrator: \"direct\", tone: \"none\")\n";

/// Case 68: a cutter wholly outside leaves the picture as it was, to the bit, and check says so; 69: a base wholly in its
/// cutter leaves the background, and check says so.
#[test]
fn cases_68_69_operands_that_do_nothing_and_that_take_all() {
    let of = |drawn: &str| picture(&shot(&format!("{VIEW}draw {drawn}")));
    let (ball, outside) = ("sphere(r: 1)", "sphere(r: 1) - box([5, 5, 5], [6, 6, 6])");
    let plain = of(ball);
    assert!(plain.chunks(3).any(|p| p != &plain[..3]), "one colour only");
    assert!(of(outside) == plain, "the cutter shows");
    assert_eq!(findings(&format!("draw {outside}")), ["W0122"]);
    let inside = "sphere(r: 1) - box([-2, -2, -2], [2, 2, 2])";
    let gone = of(inside);
    assert!(gone == of("sphere(r: 1, at: [0, 0, 900])"), "something of the base shows");
    assert_eq!(findings(&format!("draw {inside}")), ["W0124"]);
}

/// Case 70: the complement of a ball, seen from within, shows the ball's inside lit as the inside of a hollow ball is; an
/// unbounded base less a finite cutter is unbounded but for that.
#[test]
fn case_70_complements_and_unbounded_bases() {
    let inner = "camera eye(eye: [0.1, -0.2, 0.05], look_at: [1, 0.3, 0.2], fov: 70deg)
        light(at: [-0.3, 0.4, 0.3])
        render(size: [96, 72], samples: 1, integrator: \"direct\", tone: \"none\")\n";
    let of = |drawn: &str| picture(&shot(&format!("{inner}draw {drawn}")));
    let complement = of("!sphere(r: 1)");
    let hollow = of("sphere(r: 1.5) - sphere(r: 1)");
    assert!(complement.chunks(3).any(|p| p != &complement[..3]), "one colour only");
    assert!(complement == hollow, "a complement is lit otherwise than a hollow ball");
    let (mut scratch, mut draws) = (Scratch::default(), Draws::new(70));
    let pit = shot("draw half_space(z < 0) - box([-1, -1, -1], [1, 1, 1])");
    for _ in 0..5000 {
        let from = dvec3(draws.between(-3.0, 3.0), draws.between(-3.0, 3.0), 2.0);
        let have = ends(&pit, &Ray::new(from, -DVec3::Z), &mut scratch);
        let floor = if from.x.abs().max(from.y.abs()) < 1.0 { 3.0 } else { 2.0 };
        assert_eq!(have, [[floor, f64::INFINITY]], "{from}");
    }
}
