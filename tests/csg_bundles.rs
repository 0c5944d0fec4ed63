//! Rays that go together: what their beam misses is left out, and no answer changes.

mod csg_support;

use csg_support::draws::Draws;
use csg_support::forest;
use glam::DVec3;
use pss::csg::{Object, Scratch};
use pss::geom::{Beam, Interval, Ray};

/// Corners of a patch of a picture toward a point: of a perspective, or with rays side by side.
fn patch(draws: &mut Draws, toward: DVec3, size: f64) -> [Ray; 4] {
    let forward = draws.direction();
    let eye = toward - draws.between(2.0, 30.0) * forward;
    let (right, up) = forward.any_orthonormal_pair();
    let parallel = draws.chance(0.5);
    let place = [draws.between(-0.3, 0.3), draws.between(-0.3, 0.3)];
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| {
        let offset = (place[0] + size * x) * right + (place[1] + size * y) * up;
        if parallel { Ray::new(eye + 8.0 * offset, forward) } else { Ray::new(eye, forward + offset) }
    })
}

fn between(corners: &[Ray; 4], u: f64, v: f64) -> Ray {
    let mean = |of: fn(&Ray) -> DVec3| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| of(&corners[k]));
        a.lerp(b, u).lerp(d.lerp(c, u), v)
    };
    Ray::new(mean(|r| r.origin), mean(|r| r.dir))
}

/// 240 trees of up to sixty leaves, 8 patches each, 24 rays a patch with its corners: the first boundary is the same to
/// the bit, for the patch's own bundle and for one cut out of a larger patch's.
#[test]
fn a_ray_of_a_bundle_meets_what_it_meets_alone() {
    let (mut draws, mut scratch) = (Draws::new(11), Scratch::default());
    let (mut hits, mut alone, mut bundled) = (0, 0, 0);
    for trial in 0..240 {
        let mut earlier = Vec::new();
        let count = 1 + draws.below(60);
        let leaves: Vec<_> = (0..count).map(|i| forest::leaf(&mut draws, &mut earlier, i as u64)).collect();
        let expr = forest::expr(&mut draws, count, 4);
        let object = Object::new(leaves, &expr);
        for _ in 0..8 {
            let toward = draws.vector(&mut earlier);
            let size = draws.pick(&[1e-6, 0.01, 0.1]);
            let corners = patch(&mut draws, toward, size);
            let [u, v] = [0, 1].map(|_| draws.between(0.0, 0.7));
            let part = [[u, v], [u + 0.3, v], [u + 0.3, v + 0.3], [u, v + 0.3]];
            let part = part.map(|[u, v]| between(&corners, u, v));
            let whole = object.bundle(&Beam::around(&corners));
            let cut = object.part_of_bundle(&whole, &Beam::around(&part));
            for i in 0..24 {
                let [u, v] = if i < 4 { [i / 2, i % 2].map(f64::from) } else { [draws.unit(), draws.unit()] };
                let (corners, bundle) = if i % 2 == 0 { (&corners, &whole) } else { (&part, &cut) };
                let ray = between(corners, u, v);
                let queries = scratch.solid.counts.leaf_queries;
                let want = object.first(&ray, Interval::AHEAD, &mut scratch);
                let between = scratch.solid.counts.leaf_queries;
                let found = object.first_of(bundle, &ray, Interval::AHEAD, &mut scratch);
                assert_eq!(found, want, "trial {trial}: {ray:?}");
                hits += u64::from(found.is_some());
                alone += between - queries;
                bundled += scratch.solid.counts.leaf_queries - between;
            }
        }
    }
    println!("{hits} hits; leaves asked: {alone} one by one, {bundled} of bundles");
    assert!(10_000 < hits && alone != bundled, "{hits} {alone} {bundled}");
}
