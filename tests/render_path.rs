//! Light that goes from surface to surface, against closed forms: furnaces, integrating spheres, form factors; and the two ways
//! to a light against each other.

mod picture_common;

use std::f64::consts::PI;

use picture_common::{assert_mean, film, mean};

/// What `f32` sums of some thousand samples cost.
const SINGLE: f64 = 1e-5;

/// What the table of a rough coat's albedo costs ([`pss::shot::material::microfacet::Albedo`]).
const TABLE: f64 = 1e-3;

/// What the table of rough glass costs, several turns after each other.
const FACES: f64 = 5e-3;

/// A ball of a material that fills the view, under a sky of radiance one.
fn furnace(material: &str, integrator: &str) -> String {
    format!(
        "camera(eye: [0, -3, 0], look_at: [0, 0, 0], fov: 20deg)
         light(color: rgb(1, 1, 1))
         render(size: [48, 48], samples: 64, integrator: \"{integrator}\")
         draw sphere(r: 1).with({material})"
    )
}

#[test]
fn nothing_white_is_seen_in_a_white_furnace() {
    let white = "rgb(1, 1, 1)";
    let kinds = [
        (format!("matte({white})"), SINGLE),
        (format!("metal({white}, roughness: 0)"), SINGLE),
        (format!("metal({white}, roughness: 0.3)"), TABLE),
        (format!("metal({white}, roughness: 0.7)"), TABLE),
        (format!("metal({white}, roughness: 1)"), TABLE),
        (format!("plastic({white}, roughness: 0)"), TABLE),
        (format!("plastic({white}, roughness: 0.3)"), TABLE),
        (format!("plastic({white}, roughness: 1, ior: 2)"), TABLE),
        (format!("glass({white})"), SINGLE),
        (format!("glass({white}, ior: 2.4)"), SINGLE),
        (format!("glass({white}, roughness: 0.2)"), FACES),
        (format!("glass({white}, roughness: 0.5)"), FACES),
        (format!("glass({white}, roughness: 1, ior: 1.3)"), FACES),
        (format!("glass({white}, roughness: 1)"), FACES),
    ];
    for (kind, rounding) in kinds {
        for integrator in ["path", "direct"] {
            assert_mean(&film(&furnace(&kind, integrator)), 1.0, rounding, &format!("{kind} {integrator}"));
        }
    }
}

#[test]
fn a_clamp_bounds_light_that_has_turned_and_no_other() {
    let at = |kind: &str, clamp: &str| {
        film(&furnace(kind, "path").replace("samples: 64", &format!("samples: 16{clamp}")))
    };
    let mirror = "metal(rgb(1, 1, 1), roughness: 0)";
    // All that a mirror shows has turned once.
    assert_mean(&at(mirror, ", clamp: 0.25"), 0.25, SINGLE, "a mirror");
    // A glowing body is seen straight.
    assert_mean(&at("emissive(rgb(1, 1, 1))", ", clamp: 0.25"), 1.0, SINGLE, "a glow");
    assert_eq!(at(mirror, ", clamp: 1.5").rgba, at(mirror, "").rgba);
}

#[test]
fn rough_glass_within_rough_glass_keeps_its_light() {
    // Faces between two glasses, whose ratio is that of neither against empty space.
    let nested = "camera(eye: [0, -3, 0], look_at: [0, 0, 0], fov: 20deg)
         light(color: rgb(1, 1, 1))
         render(size: [48, 48], samples: 64, integrator: \"path\", bounces: 200)
         draw sphere(r: 1).with(glass(#fff, roughness: 0.6, ior: 1.3))
         draw sphere(r: 0.6).with(glass(#fff, roughness: 0.8, ior: 1.8, priority: 1))";
    assert_mean(&film(nested), 1.0, 2e-2, "nested");
}

#[test]
fn a_pane_reflects_to_and_fro_what_goes_in() {
    // 2 R / (1 + R) of a white sky behind the eye, the rest from behind the pane: all is one, and over a black half only the
    // reflected part is left. At right angles R is 0.04.
    let half = |sky: &str| {
        format!(
            "camera(eye: [0, 0, 1], look_at: [0, 0, 0], up: [0, 1, 0], height: 0.001, kind: \"orthographic\")
             {sky}
             render(size: [64, 64], samples: 64, integrator: \"path\")
             draw plane(z: 0).with(glass(rgb(1, 1, 1)))"
        )
    };
    assert_mean(&film(&half("light(color: rgb(1, 1, 1))")), 1.0, SINGLE, "all around");
    let lamp = "light(color: #000)\ndraw box([-9, -9, 5], [9, 9, 6]).with(emissive(rgb(1, 1, 1)))";
    assert_mean(&film(&half(lamp)), 2.0 * 0.04 / 1.04, SINGLE, "in front");
}

/// The wall of a hollow ball around a shining one is lit evenly, by that and by itself: of what a point of the wall sees, weighed
/// by cosine, k = (r / R)^2 is the lamp, so L = albedo (k E + (1 - k) L).
#[test]
fn an_integrating_sphere_is_as_bright_as_its_series_says() {
    for (albedo, r) in [(0.5, 0.5), (0.8, 0.3)] {
        let scene = format!(
            "camera(eye: [0, 0, 0.9], look_at: [0, 0.2, 1], up: [1, 0, 0], fov: 60deg)
             light(color: #000)
             render(size: [48, 48], samples: 256, bounces: 60, integrator: \"path\")
             draw (sphere(r: 2) - sphere(r: 1)).with(matte(rgb({albedo}, {albedo}, {albedo})))
             draw sphere(r: {r}).with(emissive(rgb(1, 1, 1), intensity: 3))"
        );
        let k: f64 = r * r;
        let wanted = albedo * 3.0 * k / (1.0 - albedo * (1.0 - k));
        assert_mean(&film(&scene), wanted, SINGLE, &format!("{albedo} {r}"));
    }
}

#[test]
fn a_convex_body_alone_gets_the_same_light_from_both_integrators() {
    let scene = |integrator: &str| {
        format!(
            "camera(eye: [0, -3, 0], look_at: [0, 0, 0], fov: 20deg)
             light(direction: [1, 2, -1], intensity: 2)
             light(at: [3, -3, 2], falloff: false)
             render(size: [32, 32], samples: 4, integrator: \"{integrator}\")
             draw sphere(r: 1).with(matte(#808080))"
        )
    };
    let (a, b) = (film(&scene("path")), film(&scene("direct")));
    assert_eq!(a, b);
    // And that of the closed form, color (2 cos sun + cos lamp), at the pixels' middles.
    let middle = a.pixel(16, 16)[0];
    assert!(0.05 < middle && middle < 2.0);
}

/// An area light and a slab that shines as bright are one to a surface: the first is aimed at and found, the second only found.
#[test]
fn lights_are_as_bright_by_either_way() {
    for material in [
        "matte(rgb(0.7, 0.7, 0.7))",
        "plastic(rgb(0.7, 0.7, 0.7), roughness: 0.3)",
        "plastic(rgb(0.7, 0.7, 0.7), roughness: 0)",
        "metal(rgb(0.7, 0.7, 0.7), roughness: 0.3)",
        "metal(rgb(0.7, 0.7, 0.7), roughness: 0.8)",
    ] {
        let scene = |lamp: &str, integrator: &str| {
            format!(
                "camera(eye: [0, -4, 3], look_at: [0, 0, 0], fov: 0.1deg)
                 {lamp}
                 render(size: [48, 48], samples: 256, integrator: \"{integrator}\")
                 draw plane(z: 0).with({material})"
            )
        };
        let area = "light(at: [0, 3, 2], size: [3, 2], look_at: [0, 3, 0], intensity: 6)";
        // Radiance pi I / (w h).
        let slab = format!(
            "light(color: #000)\ndraw box([-1.5, 2, 2], [1.5, 4, 2.00001]).with(emissive(rgb(1, 1, 1), intensity: {}))",
            PI
        );
        let (wanted, error) = mean(&film(&scene(&slab, "path")), 0);
        for integrator in ["path", "direct"] {
            let (seen, other) = mean(&film(&scene(area, integrator)), 0);
            let allowed = 4.0 * (error * error + other * other).sqrt();
            assert!(
                (seen - wanted).abs() < allowed,
                "{material} {integrator}: {seen}, not {wanted} +- {error}"
            );
            assert!(other < 2.0 * error || error == 0.0, "aiming helps: {other} {error}");
        }
    }
}

/// A soft sun over rough metal, by rays that find it alone and by both ways: a sphere so far away shines as bright.
#[test]
fn a_soft_sun_is_as_bright_by_either_way() {
    for material in ["matte(rgb(0.7, 0.7, 0.7))", "metal(rgb(0.7, 0.7, 0.7), roughness: 0.5)"] {
        let scene = |lamp: &str| {
            format!(
                "camera(eye: [0, -4, 4], look_at: [0, 0, 0], fov: 0.1deg)
                 {lamp}
                 render(size: [48, 48], samples: 256, integrator: \"path\")
                 draw plane(z: 0).with({material})"
            )
        };
        // Half angle 10 degrees; radiance I / sin^2.
        let half: f64 = 10.0;
        let sin = half.to_radians().sin();
        let sun = "light(direction: [0, -1, -1], softness: 20deg)";
        let ball = format!(
            "light(color: #000)\ndraw sphere(r: {}, at: [0, 1000, 1000]).with(emissive(rgb(1, 1, 1), intensity: {}))",
            sin * 1000.0 * 2f64.sqrt(),
            1.0 / (sin * sin)
        );
        let ((seen, one), (wanted, other)) = (mean(&film(&scene(sun)), 0), mean(&film(&scene(&ball)), 0));
        let allowed = 4.0 * (one * one + other * other).sqrt();
        assert!((seen - wanted).abs() < allowed, "{material}: {seen}, not {wanted} +- {allowed}");
    }
}

#[test]
fn deeper_paths_only_add_light_and_few_turns_bound_them() {
    let scene = |bounces: u32| {
        format!(
            "camera(eye: [0, 0, 0.5], look_at: [0, 1, 0.5], fov: 60deg)
             light(at: [0, 0, 0.9], intensity: 0.2)
             render(size: [24, 24], samples: 64, bounces: {bounces}, integrator: \"path\")
             draw (box([-2, -2, -1], [2, 2, 2]) - box([-1, -1, 0], [1, 1, 1])).with(matte(rgb(0.8, 0.8, 0.8)))"
        )
    };
    let [one, two, many] = [1, 2, 30].map(|n| mean(&film(&scene(n)), 0).0);
    assert!(1.2 * one < two && 1.2 * two < many, "{one} {two} {many}");
}
