//! Light through glass: what index 1 hides, what slabs let through, liquids in glasses with and without a gap.

mod picture_common;

use glam::DVec3;
use picture_common::{assert_mean, film, mean, shot};
use pss::csg::Scratch;
use pss::geom::Ray;
use pss::shot::material::glass::{fresnel, refracted};
use pss::shot::{Filling, Material};

const SINGLE: f64 = 1e-5;

/// G7: through a slab of index 1.5 and width 1, entered at 45 degrees, light goes 1 / sqrt(1 - sin^2 / 2.25).
#[test]
fn g7_a_slab_is_crossed_by_the_way_of_snell() {
    let shot = shot(
        "material clear(kind: \"glass\")\ndraw box([-9, -9, 0], [9, 9, 1]).with(clear)\nrender(integrator: \"path\")",
    );
    let mut scratch = Scratch::default();
    let ray = Ray::new(DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, -1.0).normalize());
    let enters = shot.world.meet(&ray, 0.0, &mut scratch);
    assert_eq!((enters.before, enters.beyond), (Filling::Empty, Filling::Clear(0)));
    let hit = enters.hit.unwrap();
    let surface = shot.world.surface(&ray, &hit);
    let inside = refracted(-ray.dir, surface.normal, 1.0 / 1.5).unwrap();
    let within = Ray::new(surface.point - surface.offset * surface.normal, inside);
    let leaves = shot.world.meet(&within, 0.0, &mut scratch);
    assert_eq!((leaves.before, leaves.beyond), (Filling::Clear(0), Filling::Empty));
    let way = shot.world.surface(&within, &leaves.hit.unwrap()).point - surface.point;
    assert!((way.length() - 1.0 / (1.0_f64 - 0.5 / 2.25).sqrt()).abs() < 1e-12, "{}", way.length());
}

/// A picture of things behind and within, with something more in it.
fn still(more: &str, integrator: &str) -> String {
    format!(
        "material red(color: #c04030)
         camera(eye: [1, -6, 2.5], look_at: [0, 0, 0.6], fov: 30deg)
         light sun(direction: [-1, 2, -3], softness: 3deg)
         light sky(color: #8090a0)
         light lamp(at: [2, -1, 3], size: [1, 1], look_at: [0, 0, 0], intensity: 4)
         render(size: [48, 36], samples: 16, integrator: \"{integrator}\")
         draw plane(z: 0)
         draw box([-0.3, 0.5, 0], [0.3, 1, 1]).with(red)
         draw sphere(r: 0.4, at: [0.9, 0, 0.4]).with(metal(#e0c080, roughness: 0.3))
         {more}"
    )
}

#[test]
fn glass_of_index_one_cannot_be_seen() {
    // Around things, across a light's way, before the eye, overlapping, and on the floor.
    let more = "material nothing(kind: \"glass\", ior: 1)
         material other(kind: \"glass\", ior: 1)
         draw sphere(r: 1.2, at: [0.3, 0.4, 0.8]).with(nothing)
         draw box([-2, -2, 0], [0.2, 0.2, 1.5]).with(other)
         draw sphere(r: 1, at: [1.5, -0.6, 2.6]).with(nothing)
         draw sphere(r: 0.3, at: [1, -5.9, 2.5]).with(nothing)";
    for integrator in ["path", "direct"] {
        let (with, without) = (film(&still(more, integrator)), film(&still("", integrator)));
        // Rays through the glass start anew nowhere: at most lights on their way are summed in another order.
        for (a, b) in with.rgba.iter().flatten().zip(without.rgba.iter().flatten()) {
            assert!((a - b).abs() <= 1e-5 * (1.0 + b), "{integrator}: {a}, not {b}");
        }
    }
}

/// Layers of indices, each as wide as said, from the eye to a wall of radiance one behind all: the share that arrives, all
/// reflections to and fro counted (Stokes, "On the Intensity of the Light Reflected from or Transmitted through a Pile of
/// Plates", 1862).
fn pile(indices: &[f64]) -> f64 {
    let (mut through, mut back, mut before) = (1.0, 0.0, 1.0);
    for &n in indices.iter().chain(&[1.0]) {
        let r = fresnel(1.0, before / n);
        // Adding a face: what comes through all so far and it, over the series of reflections between.
        (through, back) =
            (through * (1.0 - r) / (1.0 - back * r), r + (1.0 - r) * (1.0 - r) * back / (1.0 - back * r));
        before = n;
    }
    // `back` is seen from behind; a wall that reflects nothing takes what arrives.
    through
}

/// The light of a wall behind some solids, seen at right angles through all of them.
fn through(solids: &str) -> String {
    format!(
        "material hull(kind: \"glass\", ior: 1.6, priority: 1)
         material liquid(kind: \"glass\", ior: 1.33)
         camera(eye: [0, -5, 0], look_at: [0, 0, 0], height: 0.01, kind: \"orthographic\")
         light(color: #000)
         render(size: [64, 64], samples: 64, bounces: 200, integrator: \"path\")
         draw box([-9, 10, -9], [9, 11, 9]).with(emissive(rgb(1, 1, 1)))
         {solids}"
    )
}

#[test]
fn a_liquid_in_glass_lets_through_what_its_faces_do_whatever_the_gap() {
    let hull = "draw (box([-9, 0, -9], [9, 3, 9]) - box([-8, 1, -8], [8, 2, 8])).with(hull)";
    let liquid = |gap: f64| {
        format!("draw box([-{0}, {1}, -{0}], [{0}, {2}, {0}]).with(liquid)", 8.0 - gap, 1.0 + gap, 2.0 - gap)
    };
    let joined = pile(&[1.6, 1.33, 1.6]);
    let apart = pile(&[1.6, 1.0, 1.33, 1.0, 1.6]);
    assert!(0.03 < joined - apart, "{joined} {apart}");
    for (gap, wanted) in [
        (0.0, joined),
        (1e-9, apart),
        (1e-3, apart),
        // Overlaps: the one with the larger priority fills what both want.
        (-1e-9, joined),
        (-1e-3, joined),
    ] {
        for solids in [format!("{hull}\n{}", liquid(gap)), format!("{}\n{hull}", liquid(gap))] {
            assert_mean(&film(&through(&solids)), wanted, SINGLE, &format!("gap {gap}"));
        }
    }
}

#[test]
fn boxes_of_one_glass_that_touch_or_overlap_are_one_body() {
    let whole = film(&through("draw box([-1, 0, -1], [1, 2, 1]).with(hull)"));
    for parts in [
        "draw box([-1, 0, -1], [1, 1, 1]).with(hull)\ndraw box([-1, 1, -1], [1, 2, 1]).with(hull)",
        "draw (box([-1, 0, -1], [1, 1.3, 1]) | box([-1, 1, -1], [1, 2, 1])).with(hull)",
    ] {
        let parts = film(&through(parts));
        let (a, b) = (mean(&whole, 0).0, mean(&parts, 0).0);
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
    assert_mean(&whole, pile(&[1.6]), SINGLE, "one slab");
}

#[test]
fn light_takes_the_colour_of_what_it_goes_through_by_its_way() {
    // Two turns leave the straight way alone: 0.36^(2 / 0.5) of green, 0.5^4 of blue.
    let scene = through("draw box([-1, 0, -1], [1, 2, 1]).with(glass(rgb(1, 0.36, 0.5), depth: 0.5))");
    let film = film(&scene.replace("bounces: 200", "bounces: 2"));
    let [r, g, b] = [0, 1, 2].map(|c| mean(&film, c).0);
    assert!((g / r - 0.36_f64.powi(4)).abs() < 1e-6 && (b / r - 0.5_f64.powi(4)).abs() < 1e-6, "{r} {g} {b}");
}

#[test]
fn what_stands_on_a_floor_or_in_glass_is_seen_where_it_is() {
    // A matte block in a glass block, flush with its front, is seen unbent and hides what is behind; a floor that a glass block
    // stands on is seen through it.
    let shot = shot(
        "material clear(kind: \"glass\")
         draw box([-2, 0, 0], [2, 2, 2]).with(clear)
         draw box([-1, 0, 0.5], [1, 1, 1.5]).with(matte(#fff))
         draw plane(z: 0)
         render(integrator: \"path\")",
    );
    let mut scratch = Scratch::default();
    let mut met = |from: [f64; 3], dir: [f64; 3]| {
        let ray = Ray::new(from.into(), DVec3::from_array(dir));
        let met = shot.world.meet(&ray, 0.0, &mut scratch);
        (met.before, met.beyond, met.hit.map(|hit| hit.sheet))
    };
    assert_eq!(met([0.0, -1.0, 1.0], [0.0, 1.0, 0.0]), (Filling::Empty, Filling::Opaque, Some(false)));
    assert_eq!(met([1.5, -1.0, 1.0], [0.0, 1.0, 0.0]), (Filling::Empty, Filling::Clear(0), Some(false)));
    assert_eq!(met([1.5, 1.0, 1.0], [0.0, 0.0, -1.0]), (Filling::Clear(0), Filling::Clear(0), Some(true)));
    assert_eq!(met([1.5, 0.5, 1.0], [-1.0, 0.0, 0.0]), (Filling::Clear(0), Filling::Opaque, Some(false)));
    assert!(Material::of(&shot.materials, 0).is_clear());
}

#[test]
fn an_ocean_has_no_bottom() {
    // Half of space is water: what goes in is lost in coloured water, and is the sky's light in clear one.
    let scene = |color: &str| {
        format!(
            "camera(eye: [0, 0, 5], look_at: [0, 0, 0], up: [0, 1, 0], height: 0.01, kind: \"orthographic\")
             light(color: rgb(1, 1, 1))
             render(size: [64, 64], samples: 64, integrator: \"path\")
             draw half_space(z < 0).with(glass({color}, ior: 1.33))"
        )
    };
    assert_mean(&film(&scene("rgb(0.9, 0.9, 0.9)")), fresnel(1.0, 1.0 / 1.33), SINGLE, "coloured");
    let (r, growth) = (fresnel(1.0, 1.0 / 1.33), 1.0 / (1.33 * 1.33));
    assert_mean(&film(&scene("rgb(1, 1, 1)")), r + (1.0 - r) * growth, SINGLE, "clear");
}
