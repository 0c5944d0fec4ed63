//! Pictures of one scene at other sizes and places: boolean case 63, and what case 64 says of scenes far from the origin.

mod csg_support;

use csg_support::scene::picture;
use csg_support::scene::shot;

/// A die with dimples, a bored block and a torus on a floor, all lengths times `s`, all places moved by `to`.
fn scene(s: f64, to: [f64; 3]) -> String {
    let p =
        |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", s * x + to[0], s * y + to[1], s * z + to[2]);
    let l = |x: f64| format!("{:?}", s * x);
    format!(
        "camera eye(eye: {}, look_at: {}, fov: 40deg)
         light(at: {}, falloff: false)
         render(size: [96, 72], samples: 1, integrator: \"direct\", tone: \"none\")
         draw (difference(box({}, {}) & sphere(r: {}, at: {}), [sphere(r: {}, at: {}), sphere(r: {}, at: {})])).with(matte(#c04030))
         draw (box({}, {}) - cylinder(r: {}, from: {}, to: {})).with(matte(#4060c0))
         draw torus(major: {}, minor: {}).move({}).with(matte(#d0a020))
         draw half_space(normal: [0, 0, 1], at: {}).with(matte(#808080))",
        p(5.0, -6.0, 4.0), p(0.5, 0.0, 0.0), p(3.0, -8.0, 9.0),
        p(-1.0, -1.0, -1.0), p(1.0, 1.0, 1.0), l(1.35), p(0.0, 0.0, 0.0),
        l(0.3), p(0.0, -1.0, 0.0), l(0.3), p(0.4, 0.4, 1.0),
        p(1.5, -1.0, -1.0), p(3.0, 1.0, 0.5), l(0.4), p(2.25, 0.0, -1.0), p(2.25, 0.0, 0.5),
        l(0.6), l(0.2), p(-1.5, -1.6, -0.8),
        p(0.0, 0.0, -1.0),
    )
}

/// Pixels that differ by more than 2 of 255 in some channel, and of those, how many have no neighbour that agrees with the
/// other picture within that: not an edge moved by a rounding, but a patch.
fn differing(a: &[u8], b: &[u8]) -> Vec<usize> {
    let differs = |i: &usize| (0..3).any(|c| a[3 * i + c].abs_diff(b[3 * i + c]) > 2);
    (0..a.len() / 3).filter(differs).collect()
}

/// Case 63: scaled by 2^-30 and 2^30 the pixels are the same to the bit; by 1e-9 and 1e9 within one step of colour, but for
/// pixels that an edge crosses within a rounding.
#[test]
fn case_63_powers_of_two_change_no_pixel() {
    let here = picture(&shot(&scene(1.0, [0.0; 3])));
    assert!(here.chunks(3).any(|p| p != &here[..3]), "one colour only");
    for s in [2f64.powi(-30), 2f64.powi(30)] {
        assert!(picture(&shot(&scene(s, [0.0; 3]))) == here, "{s}");
    }
    for s in [1e-9, 1e9] {
        let there = picture(&shot(&scene(s, [0.0; 3])));
        let far: Vec<usize> = (0..here.len()).filter(|i| 1 < here[*i].abs_diff(there[*i])).collect();
        assert!(far.len() <= 3, "{s}: {far:?}");
    }
}

/// Case 64: ten million away there is no speckle: what differs from the picture here are pixels on edges, and few.
#[test]
fn case_64_far_from_the_origin_there_is_no_speckle() {
    let here = picture(&shot(&scene(1.0, [0.0; 3])));
    let there = picture(&shot(&scene(1.0, [1e7, -0.7e7, 0.3e7])));
    let wrong = differing(&here, &there);
    assert!(wrong.len() <= 3, "{} pixels differ: {wrong:?}", wrong.len());
}
