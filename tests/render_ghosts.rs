//! `@ghost`: what is drawn to be seen through.

mod cli_common;

use cli_common::Folder;
use pss::film::Film;
use pss::prepare::{self, Options};
use pss::source::SourceMap;

/// Seen along z by parallel rays, as its plain colours.
const FRONT: &str = "camera(eye: [0, 0, 9], look_at: [0, 0, 0], up: [0, 1, 0], height: 2)
render(size: [4, 4], samples: 1, integrator: \"flat\")
draw box([-5, -5, -1], [5, 5, 0]).with(matte(rgb(0.8, 0.4, 0.2)))
";

/// Light without shadows of its own: one sun from above on a floor.
const LIT: &str = "camera(eye: [0, 0, 9], look_at: [0, 0, 0], up: [0, 1, 0], height: 4)
light sun(direction: [-1, 0, -1])
render(size: [40, 40], samples: 1)
draw box([-5, -5, -1], [5, 5, 0])
";

fn film(text: &str) -> Film {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text.to_owned());
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).unwrap();
    let options = Options { ghosts: true, ..Options::default() };
    let shot = prepare::prepare(&scene, &options).unwrap().shot;
    pss::render::render(&shot, &Default::default()).unwrap().film
}

#[test]
fn each_face_seen_squarely_covers_a_share_of_what_lies_behind() {
    let behind = film(FRONT).rgba[5];
    assert_eq!(behind, [0.8, 0.4, 0.2, 1.0]);
    let ghost = "@ghost draw box([-5, -5, 1], [5, 5, 2]).with(matte(rgb(0.1, 0.2, 0.9)))\n";
    let over = film(&format!("{FRONT}{ghost}")).rgba[5];
    // Two faces, each of which lets 0.88 through.
    let through = 0.88_f32 * 0.88;
    for (i, own) in [0.1, 0.2, 0.9, 1.0].into_iter().enumerate() {
        let wanted = through * behind[i] + (1.0 - through) * own;
        assert!((over[i] - wanted).abs() < 1e-6, "{over:?}");
    }
    // Half of it inside the solid: one face before that.
    let ghost = ghost.replace("[-5, -5, 1]", "[-5, -5, -0.5]");
    let over = film(&format!("{FRONT}{ghost}")).rgba[5];
    assert!((over[2] - (0.88 * 0.2 + 0.12 * 0.9)).abs() < 1e-6, "{over:?}");
    // Behind the solid: not seen.
    let ghost = "@ghost draw box([-5, -5, -4], [5, 5, -2])\n";
    assert_eq!(film(&format!("{FRONT}{ghost}")).rgba[5], behind);
}

#[test]
fn a_ghost_before_nothing_is_as_much_coverage_as_its_faces_are() {
    let text = FRONT.replace("draw box", "@ghost draw box");
    let alpha = film(&text).rgba[5][3];
    assert!((alpha - (1.0 - 0.88 * 0.88)).abs() < 1e-6, "{alpha}");
}

#[test]
fn a_ghost_whose_face_is_the_surface_seen_does_not_speckle() {
    // The hole that a ball left, with the ball in it: its far side is the surface seen.
    let text = |more: &str| {
        format!(
            "camera(eye: [0, 0, 9], look_at: [0, 0, 0], up: [0, 1, 0], height: 1.4)
             render(size: [64, 64], samples: 1, integrator: \"flat\")
             draw box([-2, -2, -4], [2, 2, 0]) - sphere(r: 1.1, at: [0, 0, 0.1])
             {more}"
        )
    };
    let own = film(&text("")).rgba[0][0];
    let tinted = film(&text("@ghost draw sphere(r: 1.1, at: [0, 0, 0.1]).with(matte(rgb(0, 0, 0)))"));
    // The near face is the only one, and covers the more the steeper it is.
    for (i, p) in tinted.rgba.iter().enumerate() {
        let [x, y] = [i % 64, i / 64].map(|k| (k as f64 - 31.5) * 1.4 / 64.0);
        let facing = (1.0 - (x * x + y * y) / 1.21).max(0.0).sqrt();
        let wanted = f64::from(own) * (1.0 - (0.5 - 0.38 * facing));
        assert!((f64::from(p[0]) - wanted).abs() < 1e-5, "{x} {y}: {p:?} {wanted}");
    }
}

#[test]
fn a_ghost_casts_no_shadow_and_changes_nothing_beside_it() {
    let plain = film(LIT);
    let ball = "draw sphere(r: 0.5, at: [0, 0, 1])\n";
    let [ghost, solid] = ["@ghost ", ""].map(|word| film(&format!("{LIT}{word}{ball}")));
    let beside = |film: &Film| {
        let outside = |i: &usize| {
            let [x, y] = [i % 40, i / 40].map(|k| (k as f64 - 19.5) * 0.1);
            0.6 < x.hypot(y)
        };
        (0..1600).filter(outside).filter(|i| film.rgba[*i] != plain.rgba[*i]).count()
    };
    assert_eq!(beside(&ghost), 0);
    assert!(20 < beside(&solid), "a solid casts a shadow there");
    assert_ne!(ghost.rgba, plain.rgba);
}

#[test]
fn sheets_and_lists_can_be_ghosts() {
    let text = format!("{FRONT}@ghost draw [plane(z: 1), plane(z: 2)]\n");
    let alpha = film(&text).rgba[5];
    assert_ne!(alpha, film(FRONT).rgba[5]);
}

#[test]
fn only_and_skip_go_with_it() {
    let ghost = "draw box([-5, -5, 1], [5, 5, 2])\n";
    let alone = film(&format!("{FRONT}@only @ghost {ghost}"));
    assert!(alone.rgba[5][3] < 0.5, "{:?}", alone.rgba[5]);
    let only = format!("{}@ghost {ghost}", FRONT.replace("draw box", "@only draw box"));
    assert_eq!(film(&only), film(FRONT));
    assert_eq!(film(&format!("{FRONT}@ghost @skip {ghost}")), film(FRONT));
}

#[test]
fn neither_probe_nor_a_fitted_view_nor_depth_knows_of_ghosts() {
    let ball = "draw sphere(r: 1)\n";
    let ghost = "@ghost draw sphere(r: 3)\n";
    let folder = Folder::new();
    folder.write("plain.pss", ball).write("ghost.pss", format!("{ball}{ghost}"));
    let probed = |scene: &str| folder.run(&["probe", scene, "--ray", "0,0,9 0,0,-1"]).stdout;
    assert!(!probed("plain.pss").is_empty());
    assert_eq!(probed("plain.pss"), probed("ghost.pss"));
    let depth = "render(size: [32, 32], samples: 1, integrator: \"depth\")\n";
    assert_eq!(film(&format!("{depth}{ball}")), film(&format!("{depth}{ball}{ghost}")));
}

#[test]
fn a_ghost_that_cannot_be_built_is_an_error_where_it_is_shown() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)\n@ghost draw points(\"nowhere.ply\")\n");
    for (args, code) in [
        (&["render", "a.pss", "-o", "a.png"][..], 66),
        (&["check", "a.pss"], 66),
        (&["probe", "a.pss", "--ray", "0,0,9 0,0,-1"], 0),
    ] {
        assert_eq!(folder.run(args).code, code, "{args:?}");
    }
}
