//! Differences of pictures, by closed forms and by values of the reference program of FLIP's authors.

mod cli_common;

use cli_common::{Folder, Ran, png_size};
use pss::compare::{Metric, Picture, difference, heat};

const SIZE: [u32; 2] = [24, 16];

fn picture(pixel: impl Fn(u32, u32) -> [f32; 3]) -> Picture {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let rgba = pixels.map(|(x, y)| {
        let [r, g, b] = pixel(x, y);
        [r, g, b, 1.0]
    });
    Picture { size: SIZE, rgba: rgba.collect(), has_alpha: true, ..Picture::default() }
}

fn ramp(k: u32) -> Picture {
    picture(|x, y| std::array::from_fn(|c| ((x * 7 + y * 3 + k * c as u32 * 11) % 256) as f32 / 255.0))
}

fn value(a: &Picture, b: &Picture, metric: Metric) -> f64 {
    difference(a, b, metric).unwrap().value
}

#[test]
fn pictures_that_are_the_same_do_not_differ() {
    for metric in [Metric::Rmse, Metric::Flip, Metric::Block] {
        let found = difference(&ramp(1), &ramp(1), metric).unwrap();
        assert_eq!((found.value, found.worst(SIZE)), (0.0, None), "{metric:?}");
        assert!(found.map.iter().all(|d| *d == 0.0));
    }
}

/// `flip_evaluator` 1.7 (Andersson et al.), "LDR", 67.02 pixels a degree: the mean, and pixels 0,0 12,7 23,15 and 5,3.
#[test]
fn flip_is_what_its_authors_program_says() {
    let a = ramp(1);
    let red = picture(|x, y| {
        let inside = (5..9).contains(&y) && (10..14).contains(&x);
        if inside { [1.0, 0.0, 0.0] } else { std::array::from_fn(|c| a.rgba[(y * 24 + x) as usize][c]) }
    });
    let darker = picture(|x, y| std::array::from_fn(|c| a.rgba[(y * 24 + x) as usize][c] * 0.9));
    for (b, mean, pixels) in [
        (ramp(2), 0.283_305_913_2, [0.232_135_68, 0.287_075_1, 0.306_820_66, 0.260_253_4]),
        (red, 0.088_278_003_0, [0.000_207_768_8, 0.813_385_6, 0.000_092_191_27, 0.036_994_286]),
        (darker, 0.228_120_014_1, [0.048_433_52, 0.240_738_93, 0.321_250_23, 0.148_084_33]),
    ] {
        let found = difference(&a, &b, Metric::Flip).unwrap();
        assert!((found.value - mean).abs() < 1e-4, "{} {mean}", found.value);
        for ([x, y], wanted) in [[0, 0], [12, 7], [23, 15], [5, 3]].into_iter().zip(pixels) {
            let pixel: f64 = found.map[y * 24 + x];
            assert!((pixel - wanted).abs() < 3e-4, "{x},{y}: {pixel} {wanted}");
        }
    }
}

#[test]
fn rmse_is_the_root_of_the_mean_square_over_four_channels() {
    let black = picture(|_, _| [0.0; 3]);
    let mut one = black.clone();
    one.rgba[24 * 2 + 5] = [0.5, 0.0, 0.0, 1.0];
    let found = difference(&black, &one, Metric::Rmse).unwrap();
    assert!((found.value - (0.25_f64 / (4.0 * 384.0)).sqrt()).abs() < 1e-15);
    assert_eq!(found.worst(SIZE), Some([5, 2]));
    // Encoded numbers beside light: as light.
    let light = Picture { linear: true, ..picture(|_, _| [0.214_041_14; 3]) };
    assert!(value(&light, &picture(|_, _| [0.5; 3]), Metric::Rmse) < 1e-7);
}

#[test]
fn coverage_counts_where_both_files_hold_it() {
    let black = picture(|_, _| [0.0; 3]);
    let mut one = black.clone();
    one.rgba[24 * 2 + 5] = [0.5, 0.0, 0.0, 0.25];
    let without = |picture: &Picture| Picture { has_alpha: false, ..picture.clone() };
    let of_color = (0.25_f64 / (3.0 * 384.0)).sqrt();
    for (a, b) in [(without(&black), without(&one)), (without(&black), one.clone()), (black, without(&one))] {
        assert!((value(&a, &b, Metric::Rmse) - of_color).abs() < 1e-15);
    }
}

#[test]
fn numbers_that_are_none_are_alike_only_where_they_are_the_same() {
    let with = |c: f32| {
        let mut p = Picture { linear: true, ..ramp(1) };
        p.rgba[7][1] = c;
        p
    };
    assert_eq!(value(&with(f32::NAN), &with(f32::NAN), Metric::Rmse), 0.0);
    assert_eq!(value(&with(f32::INFINITY), &with(f32::INFINITY), Metric::Rmse), 0.0);
    assert_eq!(value(&with(f32::NAN), &with(0.5), Metric::Rmse), f64::INFINITY);
    for metric in [Metric::Flip, Metric::Block] {
        assert_eq!(value(&with(f32::INFINITY), &with(f32::INFINITY), metric), 0.0, "{metric:?}");
        for c in [f32::NAN, f32::INFINITY] {
            let found = difference(&with(c), &with(1.0), metric).unwrap();
            assert_eq!((found.value, found.worst(SIZE)), (f64::INFINITY, Some([7, 0])), "{metric:?} {c}");
        }
    }
}

#[test]
fn a_block_is_nine_pixels_off_to_one_side() {
    let grey = picture(|_, _| [0.5; 3]);
    let off = |pixels: &[[u32; 2]], by: f32| {
        let mut p = grey.clone();
        for [x, y] in pixels {
            p.rgba[(y * 24 + x) as usize][1] += by;
        }
        p
    };
    let nine: Vec<[u32; 2]> = (0..9).map(|k| [8 + k % 3, 4 + k / 3]).collect();
    let found = difference(&grey, &off(&nine, 10.0 / 255.0), Metric::Block).unwrap();
    assert!((found.value - 10.0).abs() < 1e-4 && found.worst(SIZE) == Some([9, 5]), "{found:?}");
    assert!((value(&grey, &off(&nine, -10.0 / 255.0), Metric::Block) - 10.0).abs() < 1e-4);
    assert_eq!(value(&grey, &off(&nine[..8], 0.4), Metric::Block), 0.0);
    // A checkered pattern of noise is no block, however strong.
    let noise = picture(|x, y| [if (x + y) % 2 == 0 { 0.7 } else { 0.3 }; 3]);
    assert_eq!(value(&grey, &noise, Metric::Block), 0.0);
}

#[test]
fn sizes_have_to_agree() {
    let small = Picture { size: [12, 32], ..ramp(1) };
    assert_eq!(difference(&ramp(1), &small, Metric::Rmse), None);
}

#[test]
fn the_map_of_colours_goes_from_black_to_light_and_grows_brighter() {
    let brightness =
        |v: f64| heat(v).map(f64::from).iter().zip([0.3, 0.6, 0.1]).map(|(c, w)| c * w).sum::<f64>();
    assert!(brightness(0.0) < 2.0 && 230.0 < brightness(1.0));
    assert!((0..100).all(|i| brightness(f64::from(i) / 100.0) < brightness(f64::from(i + 2) / 100.0)));
    assert_eq!(heat(f64::NAN), heat(1.0));
}

fn text(ran: &Ran) -> String {
    String::from_utf8(ran.stdout.clone()).unwrap()
}

#[test]
fn the_command_prints_judges_and_draws() {
    let folder = Folder::new();
    folder.write("s.pss", "param r = 1\nlight sun(direction: [-1, 2, -3])\ndraw sphere(r: r)\ncamera(eye: [0, -6, 0], look_at: [0, 0, 0])\n");
    for (name, r) in [("a.png", "1"), ("b.png", "1.2"), ("a.exr", "1"), ("c.png", "1")] {
        let define = format!("r={r}");
        let ran = folder.run(&["render", "s.pss", "-o", name, "--size", "40x30", "-D", &define]);
        assert_eq!(ran.code, 0, "{}", ran.stderr);
    }
    let run = |args: &[&str]| folder.run(&[&["compare"], args].concat());
    let same = run(&["a.png", "c.png"]);
    assert_eq!((same.code, text(&same)), (0, "rmse  0\nflip  0\nblock 0\n".to_owned()), "{}", same.stderr);
    let other = run(&["a.png", "b.png"]);
    assert_eq!(other.code, 1);
    assert!(other.stderr.contains("error[E0803]") && other.stderr.contains("--diff"), "{}", other.stderr);
    assert!(text(&other).lines().all(|line| line.contains("most at ")), "{}", text(&other));
    let flip = run(&["a.png", "b.png", "--metric", "flip", "--max", "0.9", "--diff", "d.png"]);
    assert_eq!(flip.code, 0, "{}", flip.stderr);
    let value: f64 = text(&flip).trim().parse().unwrap();
    assert!(0.001 < value && value < 0.9, "{value}");
    assert_eq!(png_size(&folder.read("d.png")), [40, 30]);
    // A picture and the light it shows: what eight bits and the curve leave.
    let mixed = run(&["a.exr", "a.exr", "--metric", "rmse"]);
    assert_eq!((mixed.code, text(&mixed)), (0, "0\n".to_owned()));
}

/// A plane that gives light, seen without perspective: its picture is the same however far away it is.
const FLAT: &str = "param y = 0\ncamera(eye: [0, -9, 0], look_at: [0, 0, 0], height: 3, kind: \"orthographic\")\n\
    light(color: #ffffff)\ndraw box([-5, y, -5], [5, y + 1, 5])\n";

#[test]
fn layers_are_compared_by_rmse_and_whole_numbers_by_pixels() {
    let folder = Folder::new();
    let scene =
        |aov: &str, more: &str| format!("{FLAT}render(size: [8, 6], samples: 1, aov: [{aov}])\n{more}");
    let far = "\"depth\", \"position\", \"owner\"";
    folder.write("s.pss", scene(far, "")).write("depth.pss", scene("\"depth\"", ""));
    folder.write("two.pss", scene(far, "draw box([-9, 5, -9], [9, 6, 9])\n"));
    folder.write("one.pss", scene(far, "").replace("draw", "draw box([-9, 15, -9], [9, 16, 9])\ndraw"));
    for (scene, out, y) in [
        ("s.pss", "a.exr", "y=0"),
        ("s.pss", "b.exr", "y=5"),
        ("depth.pss", "d.exr", "y=0"),
        ("two.pss", "two.exr", "y=0"),
        ("one.pss", "one.exr", "y=0"),
        ("s.pss", "a.png", "y=0"),
    ] {
        assert_eq!(folder.run(&["render", scene, "-o", out, "-D", y, "-q"]).code, 0, "{out}");
    }
    let run = |args: &[&str]| folder.run(&[&["compare"], args].concat());
    let same = run(&["a.exr", "two.exr"]);
    assert_eq!(same.code, 0, "{}", same.stderr);
    assert!(text(&same).contains("\nposition 0\n") && text(&same).contains("\ndepth 0\n"), "{}", text(&same));
    let moved = run(&["a.exr", "b.exr", "--diff", "d.png"]);
    assert_eq!(moved.code, 1);
    assert!(text(&moved).starts_with("rmse  0\nflip  0\nblock 0\n"), "{}", text(&moved));
    assert!(text(&moved).contains("\ndepth 5  most at 0,0\n"), "{}", text(&moved));
    assert!(text(&moved).contains("\nposition 2.88675"), "of three channels: {}", text(&moved));
    assert!(folder.read("d.png").len() > 60 && moved.stderr.contains("depth 5"), "{}", moved.stderr);
    for (metric, max, code) in [("rmse", "4.9", 1), ("rmse", "5", 0), ("flip", "0", 0), ("block", "0", 0)] {
        let ran = run(&["a.exr", "b.exr", "--metric", metric, "--max", max]);
        assert_eq!(ran.code, code, "{metric} {max} {}", ran.stderr);
    }
    // The plane is the second solid there: every pixel has another owner, and nothing else.
    let owner = run(&["a.exr", "one.exr", "--max", "47"]);
    assert!(
        owner.code == 1 && text(&owner).contains("\nowner 48 pixels  first at 0,0\n"),
        "{}",
        text(&owner)
    );
    let fewer = run(&["d.exr", "a.exr", "--max", "1000"]);
    assert!(fewer.code == 1 && text(&fewer).contains("owner is in `a.exr` alone"), "{}", text(&fewer));
    let png = run(&["a.exr", "a.png", "--max", "1"]);
    assert!(png.code == 0 && !text(&png).contains("depth"), "a PNG cannot hold any: {}", text(&png));
}

#[test]
fn what_cannot_be_compared_is_told_and_nothing_is_lost() {
    let folder = Folder::new();
    folder.write("s.pss", "draw sphere(r: 1)\n").write("broken.png", "not a picture").write("a.txt", "x");
    folder.run(&["render", "s.pss", "-o", "a.png", "--size", "8x8"]);
    folder.run(&["render", "s.pss", "-o", "b.png", "--size", "8x9"]);
    for (args, code, told) in [
        (&["a.png", "nowhere.png"][..], 66, "E0601"),
        (&["a.png", "broken.png"], 65, "E0605"),
        (&["broken.png", "a.png", "--format", "json"], 65, "\"E0605\""),
        (&["a.png", "a.txt"], 2, "E0605"),
        (&["a.png", "b.png"], 1, "E0804"),
        (&["a.png", "a.png", "--metric", "ssim"], 2, "rmse, flip, block"),
        (&["a.png", "a.png", "--max", "-1"], 2, "from 0 on"),
        (&["a.png", "a.png", "--diff", "d.exr"], 2, "E0001"),
        (&["a.png", "a.png", "--diff", "a.png"], 73, "E0608"),
        (&["a.png"], 2, "<B>"),
    ] {
        let ran = folder.run(&[&["compare"], args].concat());
        assert_eq!(ran.code, code, "{args:?} {}", ran.stderr);
        assert!(ran.stderr.contains(told), "{args:?} {}", ran.stderr);
        assert!(ran.stdout.is_empty(), "{args:?}");
    }
    assert_eq!(png_size(&folder.read("a.png")), [8, 8]);
}
