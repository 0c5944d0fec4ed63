//! Cameras, lights, materials and settings, built from calls as the language hands them over.

use std::f64::consts::PI;

use glam::DVec3;
use pss::film::Aov;
use pss::geom::Aabb;
use pss::scene::{Arg, Call, Value};
use pss::shot::settings::{Integrator, MAX_PIXELS, Overrides, Tone};
use pss::shot::{Camera, Light, Material, Settings, camera, light, material, settings};
use pss::source::Span;

fn call(word: &str, args: &[(&str, Value)]) -> Call {
    let arg = |value: &Value| Arg { value: value.clone(), at: Span::default() };
    let args = args.iter().map(|(name, value)| ((*name).to_owned(), arg(value))).collect();
    Call { word: word.to_owned(), args, at: Span::default() }
}

fn vector(x: f64, y: f64, z: f64) -> Value {
    Value::Vector(vec![x, y, z])
}

fn text(word: &str) -> Value {
    Value::Text(word.to_owned())
}

/// A camera at (0, -5, 0) that looks at the origin.
fn front(more: &[(&str, Value)]) -> Call {
    let mut args = vec![("eye", vector(0.0, -5.0, 0.0)), ("look_at", vector(0.0, 0.0, 0.0))];
    args.extend_from_slice(more);
    call("camera", &args)
}

#[test]
fn the_middle_of_a_perspective_looks_at_the_point_and_its_top_edge_at_half_the_angle() {
    let camera = camera::build(&front(&[("fov", Value::Angle(PI / 3.0))])).unwrap();
    let size = [30, 20];
    let middle = camera.ray(15.0, 10.0, size);
    assert_eq!(middle.dir.normalize(), DVec3::Y);
    assert_eq!(middle.origin, DVec3::new(0.0, -5.0, 0.0));
    let top = camera.ray(15.0, 0.0, size).dir;
    assert!((top.angle_between(DVec3::Y) - PI / 6.0).abs() < 1e-12 && 0.0 < top.z);
    assert!(0.0 < camera.ray(30.0, 10.0, size).dir.x, "the right of the picture is to the right");
}

#[test]
fn pixels_are_square_in_pictures_of_any_shape() {
    let calls = [
        front(&[("fov", Value::Angle(0.5))]),
        front(&[("height", Value::Number(3.0))]),
        front(&[("kind", text("perspective"))]),
    ];
    for camera in calls.iter().map(|c| camera::build(c).unwrap()).chain([Camera::fit(Aabb::EMPTY)]) {
        for size in [[40, 30], [30, 40], [7, 1]] {
            let at = |x, y| camera.ray(x, y, size).at(1.0);
            let across = at(2.0, 0.0).distance(at(1.0, 0.0));
            let down = at(1.0, 0.0).distance(at(1.0, 1.0));
            assert!((across / down - 1.0).abs() < 1e-12, "{camera:?} {size:?}");
        }
    }
}

#[test]
fn an_orthographic_picture_measures_its_height() {
    let camera = camera::build(&front(&[("height", Value::Number(6.0))])).unwrap();
    let (top, bottom) = (camera.ray(0.0, 0.0, [8, 4]), camera.ray(0.0, 4.0, [8, 4]));
    assert_eq!(top.dir, bottom.dir);
    assert_eq!(top.origin - bottom.origin, DVec3::new(0.0, 0.0, 6.0));
}

#[test]
fn a_spherical_picture_sees_all_around() {
    let camera = camera::build(&front(&[("kind", text("spherical"))])).unwrap();
    let size = [8, 4];
    for (x, y, dir) in [(4.0, 2.0, DVec3::Y), (6.0, 2.0, DVec3::X), (4.0, 0.0, DVec3::Z)] {
        assert!(camera.ray(x, y, size).dir.distance(dir) < 1e-15, "{dir}");
    }
}

#[test]
fn a_fitted_view_holds_the_box_and_wastes_little() {
    let bounds = Aabb { min: DVec3::new(-1.0, 20.0, 3.0), max: DVec3::new(4.0, 21.0, 9.0) };
    let camera = Camera::fit(bounds);
    for size in [[40, 30], [30, 40], [10, 10]] {
        let [w, h] = size.map(f64::from);
        let middle = camera.ray(0.5 * w, 0.5 * h, size).dir;
        let (right, down) = (camera.ray(0.5 * w + 1.0, 0.5 * h, size).dir - middle, {
            camera.ray(0.5 * w, 0.5 * h + 1.0, size).dir - middle
        });
        let reach = bounds.corners().map(|corner| {
            let to = corner - camera.eye();
            let per = middle.length_squared() / to.dot(middle);
            let pixel = |axis: DVec3| (per * to.dot(axis) / axis.length_squared()).abs();
            (pixel(right) / (0.5 * w.min(h))).max(pixel(down) / (0.5 * w.min(h)))
        });
        let reach = reach.into_iter().fold(0.0, f64::max);
        assert!((0.7..1.0).contains(&reach), "{size:?}: {reach}");
    }
}

#[test]
fn cameras_that_see_nothing_are_errors_that_name_the_argument() {
    let straight_up = vector(0.0, 2.0, 0.0);
    let cases = [
        (call("camera", &[("eye", vector(1.0, 2.0, 3.0)), ("look_at", vector(1.0, 2.0, 3.0))]), "look_at"),
        (front(&[("up", straight_up)]), "up"),
        (front(&[("up", vector(0.0, 0.0, 0.0))]), "up"),
        (front(&[("fov", Value::Angle(0.0))]), "fov"),
        (front(&[("fov", Value::Angle(PI))]), "fov"),
        (front(&[("fov", Value::Angle(f64::NAN))]), "fov"),
        (front(&[("kind", text("orthographic"))]), ""),
        (front(&[("kind", text("orthographic")), ("fov", Value::Angle(1.0))]), "fov"),
        (front(&[("kind", text("perspective")), ("height", Value::Number(1.0))]), "height"),
        (front(&[("height", Value::Number(0.0))]), "height"),
    ];
    for (call, param) in cases {
        assert_eq!(camera::build(&call).unwrap_err().param, param, "{call:?}");
    }
}

#[test]
fn what_is_given_decides_what_light_it_is() {
    let direction = ("direction", vector(0.0, 0.0, -2.0));
    let white = ("color", Value::Color([1.0; 3]));
    let sun =
        light::build(&call("light", &[direction.clone(), ("softness", Value::Angle(0.2))]), None).unwrap();
    assert_eq!(sun, Light::Sun { toward: DVec3::Z, half_angle: 0.1, color: [1.0; 3] });
    let point = light::build(&call("light", &[("at", vector(1.0, 2.0, 3.0)), white.clone()]), None).unwrap();
    let at = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(point, Light::Point { at, falloff: true, color: [1.0; 3] });
    let sky = light::build(&call("light", &[white, ("intensity", Value::Number(0.5))]), None).unwrap();
    assert_eq!(sky, Light::Sky { color: [0.5; 3] });
    let wrong = [
        (vec![], ""),
        (vec![("intensity", Value::Number(2.0))], ""),
        (vec![direction.clone(), ("at", vector(0.0, 0.0, 0.0))], "at"),
        (vec![("direction", vector(0.0, 0.0, 0.0))], "direction"),
        (vec![direction.clone(), ("intensity", Value::Number(-1.0))], "intensity"),
        (vec![direction.clone(), ("softness", Value::Angle(4.0))], "softness"),
        (vec![("at", vector(0.0, 0.0, 0.0)), ("softness", Value::Angle(0.1))], "softness"),
        (vec![direction, ("falloff", Value::Bool(false))], "falloff"),
    ];
    for (args, param) in wrong {
        assert_eq!(light::build(&call("light", &args), None).unwrap_err().param, param, "{args:?}");
    }
}

#[test]
fn a_matte_without_colour_is_the_default_material() {
    assert_eq!(material::build(&call("matte", &[])).unwrap().paint, Material::default().paint);
    // #cc as the standard decodes it.
    let linear = ((f64::from(0xcc) / 255.0 + 0.055) / 1.055).powf(2.4) as f32;
    assert!((Material::default().albedo(DVec3::ZERO, None)[0] - linear).abs() < 1e-7);
    assert_eq!(
        material::build(&call("matte", &[("color", Value::Color([-1.0; 3]))])).unwrap_err().param,
        "color"
    );
}

#[test]
fn settings_have_the_defaults_of_the_language() {
    assert_eq!(settings::build(&call("render", &[])).unwrap(), Settings::default());
    let aov = Value::Texts(vec!["normal".to_owned(), "depth".to_owned(), "normal".to_owned()]);
    let built = settings::build(&call("render", &[("integrator", text("ao")), ("aov", aov)])).unwrap();
    assert_eq!((built.integrator, built.tone), (Integrator::Ao, Tone::None));
    assert_eq!(built.aov, [Aov::Depth, Aov::Normal]);
}

#[test]
fn settings_out_of_range_name_the_argument() {
    let cases = [
        ("size", Value::Vector(vec![0.0, 5.0])),
        ("size", Value::Vector(vec![1.5, 5.0])),
        ("size", Value::Vector(vec![-3.0, 5.0])),
        ("size", Value::Vector(vec![65536.0, 65536.0])),
        ("size", Value::Vector(vec![1e300, 1e300])),
        ("size", Value::Vector(vec![f64::NAN, 1.0])),
        ("samples", Value::Number(0.0)),
        ("samples", Value::Number(2.5)),
        ("samples", Value::Number(1e9)),
        ("seed", Value::Number(-1.0)),
        ("exposure", Value::Number(1e6)),
        ("integrator", text("paths")),
        ("error", Value::Number(-1.0)),
        ("bounces", Value::Number(0.0)),
        ("aov", Value::Texts(vec!["dept".to_owned()])),
    ];
    for (param, value) in cases {
        let call = call("render", &[(param, value)]);
        assert_eq!(settings::build(&call).unwrap_err().param, param, "{call:?}");
    }
}

#[test]
fn the_command_line_wins_within_the_same_limits() {
    let mut settings = Settings::default();
    let crop = Some([1, 2, 10, 20]);
    settings.apply(&Overrides { size: Some([10, 20]), samples: Some(3), seed: Some(7), crop }).unwrap();
    assert_eq!((settings.size, settings.samples, settings.seed), ([10, 20], 3, 7));
    assert_eq!((settings.window(), settings.pixels()), ([1, 2, 10, 20], 9 * 18));
    for crop in [[0, 0, 11, 5], [0, 0, 5, 21], [5, 0, 5, 5], [6, 0, 5, 5]] {
        let wrong = Overrides { crop: Some(crop), ..Overrides::default() };
        assert_eq!(settings.apply(&wrong).unwrap_err().param, "crop", "{crop:?}");
    }
    let huge = Overrides { size: Some([u32::MAX, u32::MAX]), ..Overrides::default() };
    assert!(MAX_PIXELS < u64::from(u32::MAX));
    assert_eq!(settings.apply(&huge).unwrap_err().param, "size");
}
