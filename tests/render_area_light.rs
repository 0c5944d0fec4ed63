//! Area lights, against the form factors of rectangles and against point lights from afar.

mod cli_common;

use std::f64::consts::PI;

use cli_common::Folder;
use pss::film::Film;
use pss::prepare::{self, Options};
use pss::source::SourceMap;

fn film(text: &str) -> Film {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text.to_owned());
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).unwrap();
    let shot = prepare::prepare(&scene, &Options::default()).unwrap().shot;
    pss::render::render(&shot, &Default::default()).unwrap().film
}

/// The middle of a floor of colour 0.5, seen from aside, in some light.
fn floor(light: &str) -> f64 {
    let film = film(&format!(
        "camera(eye: [0, -8, 6], look_at: [0, 0, 0], fov: 0.01deg)
         light lamp({light})
         render(size: [1, 1], samples: 65536)
         draw plane(z: 0).with(matte(rgb(0.5, 0.5, 0.5)))"
    ));
    f64::from(film.rgba[0][0])
}

/// The form factor of a rectangle `a` times `b` over a point under its corner, at distance 1 (Howell, C-4).
fn corner(a: f64, b: f64) -> f64 {
    let (p, q) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
}

#[test]
fn a_floor_under_a_rectangle_is_as_bright_as_its_form_factor_says() {
    for (w, h, z) in [(2.0, 1.0, 1.0), (4.0, 4.0, 1.0), (1.0, 0.5, 2.0), (6.0, 2.0, 1.5)] {
        let light = format!(
            "at: [0, 0, {z}], size: [{w}, {h}], look_at: [0, 0, 0], color: rgb(1, 1, 1), intensity: 3"
        );
        let factor = 4.0 * corner(0.5 * w / z, 0.5 * h / z);
        // Radiance 3 pi / (w h), times the factor, times the colour.
        let wanted = 0.5 * 3.0 * PI / (w * h) * factor;
        let seen = floor(&light);
        assert!((seen - wanted).abs() < 2e-3 * wanted, "{w} {h} {z}: {seen} {wanted}");
    }
}

#[test]
fn from_afar_it_is_a_point_light_and_behind_it_is_dark() {
    let area = "at: [3, 4, 12], size: [0.02, 0.01], look_at: [0, 0, 0], intensity: 200";
    let [area, point] = [area, "at: [3, 4, 12], intensity: 200"].map(floor);
    assert!(0.1 < point && (area - point).abs() < 1e-4 * point, "{area} {point}");
    assert_eq!(floor("at: [0, 0, 2], size: [1, 1], look_at: [0, 0, 9]"), 0.0);
}

#[test]
fn its_shadow_is_dark_where_all_of_it_is_covered_and_half_where_half_is() {
    let lit = |blocker: &str| {
        let film = film(&format!(
            "camera(eye: [0, -8, 0.5], look_at: [0, 0, 0], fov: 0.01deg)
             light lamp(at: [0, 0, 4], size: [2, 2], look_at: [0, 0, 0], intensity: 30)
             render(size: [1, 1], samples: 65536)
             draw plane(z: 0)
             {blocker}"
        ));
        f64::from(film.rgba[0][0])
    };
    let open = lit("");
    assert!(0.1 < open);
    assert_eq!(lit("draw box([-1, -1, 2], [1, 1, 2.1])"), 0.0);
    let half = lit("draw box([0, -3, 2], [3, 3, 2.1])");
    assert!((half / open - 0.5).abs() < 2e-3, "{}", half / open);
}

#[test]
fn an_area_light_that_is_none_is_refused() {
    let folder = Folder::new();
    for (light, told) in [
        ("at: [0, 0, 5], size: [1, 1]", "not whole"),
        ("at: [0, 0, 5], look_at: [0, 0, 0]", "not whole"),
        ("at: [0, 0, 5], size: [0, 1], look_at: [0, 0, 0]", "above zero"),
        ("at: [0, 0, 5], size: [1, 1], look_at: [0, 0, 5]", "where the light is"),
        ("at: [0, 0, 5], size: [1, 1], look_at: [0, 0, 0], falloff: false", "no `falloff`"),
        ("direction: [0, 0, -1], at: [0, 0, 5], size: [1, 1], look_at: [0, 0, 0]", "no `direction`"),
    ] {
        folder.write("s.pss", format!("light lamp({light})\ndraw sphere(r: 1)\n"));
        let ran = folder.run(&["render", "s.pss", "--size", "8x8"]);
        assert!(ran.code == 65 && ran.stderr.contains(told), "{light}: {}", ran.stderr);
    }
}
