//! The integrator on a closed form: the unit ball at the origin, seen from the front.

use glam::DVec3;
use pss::csg::{Boundary, Scratch};
use pss::film::{Aov, Film};
use pss::geom::{Aabb, Interval, Ray};
use pss::num::roots::quadratic;
use pss::render::{Progress, RenderError, Rendered, Scenery, View, render_scenery};
use pss::scene::{Arg, Call, Value};
use pss::shot::settings::Integrator;
use pss::shot::{Camera, Hit, Light, Material, Settings, Surface, camera};
use pss::solid::Crossing;
use pss::source::Span;

/// The unit ball; perhaps open at the far side, a sheet of the same shape.
struct Ball {
    sheet: bool,
}

const SOLID: Ball = Ball { sheet: false };

fn roots(ray: &Ray) -> Option<[f64; 2]> {
    let (a, b) = (ray.dir.length_squared(), ray.origin.dot(ray.dir));
    let c = ray.origin.length_squared() - 1.0;
    quadratic(a, b, c, b * b - a * c)
}

impl Scenery for Ball {
    fn bounds(&self) -> Aabb {
        Aabb::of_points([DVec3::NEG_ONE, DVec3::ONE])
    }

    fn first(&self, ray: &Ray, range: Interval, scratch: &mut Scratch) -> Option<Hit> {
        scratch.solid.counts.leaf_queries += 1;
        let roots = roots(ray)?;
        let first = (0..2).find(|&i| range.lo < roots[i] && roots[i] <= range.hi)?;
        let crossing = Crossing::exact(roots[first], first == 0, 0);
        let normal = ray.at(crossing.t).normalize();
        let boundary = Boundary { t: crossing.t, leaf: 0, crossing, normal, flipped: false, filler: None };
        Some(Hit { boundary, entering: first == 0, sheet: self.sheet })
    }

    fn blocked(&self, ray: &Ray, range: Interval, _: &mut Scratch) -> bool {
        let crossed = |t: f64| range.lo < t && t <= range.hi;
        roots(ray).is_some_and(|[lo, hi]| {
            if self.sheet { crossed(lo) || crossed(hi) } else { lo <= range.hi && range.lo < hi }
        })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let point = ray.at(hit.boundary.t);
        Surface { point, normal: point.normalize(), material: 0, offset: 1e-9 }
    }
}

fn arg(value: Value) -> Arg {
    Arg { value, at: Span::default() }
}

/// Looks along +y from (0, -10, 0); the picture is 4 units high.
fn front() -> Camera {
    let args = [
        ("eye", Value::Vector(vec![0.0, -10.0, 0.0])),
        ("look_at", Value::Vector(vec![0.0, 0.0, 0.0])),
        ("height", Value::Number(4.0)),
    ];
    let args = args.into_iter().map(|(name, value)| (name.to_owned(), arg(value))).collect();
    camera::build(&Call { word: "camera".to_owned(), args, at: Span::default() }).unwrap()
}

const CLAY: [f32; 3] = [0.8, 0.4, 0.2];

fn settings(samples: u32) -> Settings {
    Settings { size: [41, 41], samples, ..Settings::default() }
}

fn try_render(
    scenery: &impl Scenery,
    lights: &[Light],
    settings: &Settings,
) -> Result<Rendered, RenderError> {
    let camera = front();
    let view = View { camera: &camera, lights, materials: &[Material::matte(CLAY)], ghosts: None, settings };
    render_scenery(scenery, &view, &Progress::default())
}

fn film(scenery: &impl Scenery, lights: &[Light], settings: &Settings) -> Film {
    try_render(scenery, lights, settings).unwrap().film
}

/// The point of the ball that the centre of a pixel shows.
fn front_point(x: u32, y: u32) -> Option<DVec3> {
    let at = |i: u32| (f64::from(i) + 0.5 - 20.5) * (4.0 / 41.0);
    let (x, z) = (at(x), -at(y));
    let depth = 1.0 - x * x - z * z;
    (0.0 < depth).then(|| DVec3::new(x, -depth.sqrt(), z))
}

/// Compares every pixel's centre with a closed form of the light on a white surface.
fn assert_lit(film: &Film, white: impl Fn(DVec3) -> f64, background: f32) {
    for y in 0..41 {
        for x in 0..41 {
            let [r, g, b, _] = film.pixel(x, y);
            let light = front_point(x, y).map(&white);
            let want = light.map_or([background; 3], |w| CLAY.map(|c| c * w as f32));
            for (have, want) in [r, g, b].iter().zip(want) {
                assert!((have - want).abs() < 1e-5, "pixel {x}, {y}: {have}, not {want}");
            }
        }
    }
}

#[test]
fn a_sun_gives_colour_times_cosine() {
    let toward = DVec3::new(1.0, -1.0, 2.0).normalize();
    let sun = Light::Sun { toward, half_angle: 0.0, color: [2.0; 3] };
    assert_lit(&film(&SOLID, &[sun], &settings(1)), |n| 2.0 * n.dot(toward).max(0.0), 0.0);
}

#[test]
fn a_point_light_gives_colour_times_cosine_over_distance_squared() {
    let at = DVec3::new(0.0, -3.0, 1.0);
    let cosine = |p: DVec3| p.dot((at - p).normalize()).max(0.0);
    let light = |falloff| [Light::Point { at, falloff, color: [1.0; 3] }];
    assert_lit(&film(&SOLID, &light(false), &settings(1)), cosine, 0.0);
    let fading = |p: DVec3| cosine(p) / (at - p).length_squared();
    assert_lit(&film(&SOLID, &light(true), &settings(1)), fading, 0.0);
}

#[test]
fn a_convex_body_under_a_sky_alone_shows_its_colour_times_the_skys() {
    let film = film(&SOLID, &[Light::Sky { color: [0.5; 3] }], &settings(1));
    assert_lit(&film, |_| 0.5, 0.5);
}

#[test]
fn a_white_body_under_a_white_sky_cannot_be_seen() {
    let camera = front();
    let settings = settings(4);
    let materials = [Material::matte([1.0; 3])];
    let lights = [Light::Sky { color: [1.0; 3] }];
    let view =
        View { camera: &camera, lights: &lights, materials: &materials, ghosts: None, settings: &settings };
    let film = render_scenery(&SOLID, &view, &Progress::default()).unwrap().film;
    assert!(film.rgba.iter().all(|pixel| *pixel == [1.0; 4]));
}

#[test]
fn a_soft_sun_is_as_bright_as_a_hard_one_where_the_whole_of_it_shines() {
    let sun = Light::Sun { toward: DVec3::NEG_Y, half_angle: 0.3, color: [1.0; 3] };
    let film = film(&SOLID, &[sun], &settings(256));
    let [r, ..] = film.pixel(20, 20);
    // Over a pixel of half width a the mean of sqrt(1 - x^2 - z^2) is 1 - a^2 / 3 to second order.
    let want = 1.0 - (2.0_f32 / 41.0).powi(2) / 3.0;
    // Cosines over the cone spread by (1 - cos 0.3) / sqrt(12) = 0.013: less than this for 256 points.
    assert!((r / CLAY[0] - want).abs() < 0.013 / 16.0, "{r}");
}

#[test]
fn no_light_at_all_means_a_sky_and_a_headlight() {
    let film = film(&SOLID, &[], &settings(1));
    assert_lit(&film, |n| 0.4 + 0.6 * -n.y, 0.4);
}

#[test]
fn a_sheet_is_lit_on_the_eyes_side_and_shades_itself() {
    let inside = Light::Point { at: DVec3::new(0.0, -0.5, 0.0), falloff: false, color: [1.0; 3] };
    assert_lit(&film(&Ball { sheet: true }, &[inside], &settings(1)), |_| 0.0, 0.0);
    let outside = Light::Sun { toward: DVec3::NEG_Y, half_angle: 0.0, color: [1.0; 3] };
    assert_lit(&film(&Ball { sheet: true }, &[outside], &settings(1)), |n| -n.y, 0.0);
}

#[test]
fn no_shadow_ray_goes_to_a_light_behind_the_surface() {
    let behind = Light::Sun { toward: DVec3::Y, half_angle: 0.0, color: [1.0; 3] };
    assert_eq!(try_render(&SOLID, &[behind], &settings(1)).unwrap().rays.shadow, 0);
    let dark = Light::Sky { color: [0.0; 3] };
    assert_eq!(try_render(&SOLID, &[dark], &settings(1)).unwrap().rays.shadow, 0);
}

#[test]
fn layers_hold_what_the_centre_ray_sees() {
    let aov = Aov::ALL.to_vec();
    let film = film(&SOLID, &[], &Settings { aov, ..settings(4) });
    let layer = |aov| &film.layer(aov).unwrap().data;
    let near = |a: f32, b: f64| (f64::from(a) - b).abs() < 1e-6;
    for y in 0..41 {
        for x in 0..41 {
            let i = (41 * y + x) as usize;
            let vector = |aov| DVec3::from_array(std::array::from_fn(|k| f64::from(layer(aov)[3 * i + k])));
            match front_point(x, y) {
                None => {
                    assert_eq!(layer(Aov::Depth)[i], f32::INFINITY);
                    assert_eq!(layer(Aov::Leaf)[i], 0.0);
                    assert_eq!(vector(Aov::Normal), DVec3::ZERO);
                }
                Some(p) => {
                    assert!(near(layer(Aov::Depth)[i], 10.0 + p.y));
                    assert_eq!(layer(Aov::Leaf)[i], 1.0);
                    assert!(vector(Aov::Normal).distance(p) < 1e-6);
                    assert!(vector(Aov::Position).distance(p) < 1e-6);
                    assert_eq!(&layer(Aov::Albedo)[3 * i..3 * i + 3], &CLAY);
                }
            }
        }
    }
}

#[test]
fn pictures_of_facts_show_the_facts() {
    let at = |integrator, x| film(&SOLID, &[], &Settings { integrator, ..settings(1) }).pixel(x, 20);
    assert_eq!(at(Integrator::Flat, 20), [0.8, 0.4, 0.2, 1.0]);
    assert_eq!(at(Integrator::Flat, 0), [0.0; 4]);
    assert_eq!(at(Integrator::Normals, 20), [0.5, 0.0, 0.5, 1.0]);
    assert_eq!(at(Integrator::Ao, 20), [1.0; 4]);
    assert_eq!(at(Integrator::Depth, 20), [1.0; 4]);
}

#[test]
fn threads_change_no_bit() {
    let settings = Settings { aov: Aov::ALL.to_vec(), size: [100, 70], ..settings(4) };
    let render = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| try_render(&SOLID, &[], &settings).unwrap())
    };
    assert_eq!(render(1), render(2));
}

#[test]
fn a_crop_has_the_pixels_of_the_whole_picture() {
    let whole_settings = Settings { aov: vec![Aov::Normal], size: [100, 70], ..settings(4) };
    let whole = film(&SOLID, &[], &whole_settings);
    let [x0, y0, x1, y1] = [13, 7, 81, 66];
    let crop = film(&SOLID, &[], &Settings { crop: Some([x0, y0, x1, y1]), ..whole_settings });
    assert_eq!(crop.size, [x1 - x0, y1 - y0]);
    let mut pasted = whole.clone();
    pasted.paste(&crop, [x0, y0]);
    assert_eq!(pasted, whole);
}

#[test]
fn the_seed_changes_the_noise_and_nothing_else_does() {
    let with = |seed| film(&SOLID, &[], &Settings { seed, ..settings(4) });
    assert_eq!(with(1), with(1));
    assert_ne!(with(1), with(2));
}

#[test]
fn counts_are_of_all_tiles() {
    let progress = Progress::default();
    let (camera, settings) = (front(), settings(4));
    let view = View { camera: &camera, lights: &[], materials: &[], ghosts: None, settings: &settings };
    let rendered = render_scenery(&SOLID, &view, &progress).unwrap();
    assert_eq!(rendered.rays.camera, 41 * 41 * 4);
    assert_eq!(rendered.counts.leaf_queries, 41 * 41 * 4);
    assert_eq!(progress.done(), 41 * 41);
}

/// Panics where a ray goes through one place.
struct Mined;

impl Scenery for Mined {
    fn bounds(&self) -> Aabb {
        Aabb::EMPTY
    }

    fn first(&self, ray: &Ray, _: Interval, _: &mut Scratch) -> Option<Hit> {
        assert!(ray.origin.x < 1.9, "the mine went off");
        None
    }

    fn blocked(&self, _: &Ray, _: Interval, _: &mut Scratch) -> bool {
        false
    }

    fn surface(&self, _: &Ray, _: &Hit) -> Surface {
        unreachable!("nothing is met")
    }
}

#[test]
fn a_panic_in_a_tile_is_an_error_that_says_where() {
    match try_render(&Mined, &[], &settings(1)) {
        Err(RenderError::Panicked { at: [32, _], message }) => assert_eq!(message, "the mine went off"),
        other => panic!("{other:?}"),
    }
}
