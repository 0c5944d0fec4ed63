//! Goldens can fail: what a mistake in the program, or in a scene, does to them. Each mutation is made of the scenes of
//! `tests/goldens`, or of the solids in them, and must fail some.
//!
//! What no scene and no solid can say was edited by hand in the source, one line at a time; the goldens of so many scenes failed, of 46
//! (`.spans`, `.exr`, `.png`). Who changes one of these places tries it again.
//!
//! | file | edit | spans | exr | png |
//! | --- | --- | --- | --- | --- |
//! | `geom/tolerance.rs` | `cleanup`: `1000.0 * CLEANUP * EPS * scale` (`films` alone knows) | 1 | 1 | 1 |
//! | `csg/owner.rs` | `claim_of`: `outward = \|normal: DVec3\| normal` | 0 | 16 | 16 |
//! | `csg/owner.rs` | `boundary`: `flipped: false` | 35 | 0 | 0 |
//! | `csg/few.rs` | `let normal = normal;` for `if flipped { -normal } else { normal }` | 0 | 7 | 7 |
//! | `csg/few.rs` | `let flipped = false;` | 0 | 7 | 7 |
//! | `csg/handful.rs` | `let normal = normal;` for `if flipped { -normal } else { normal }` | 0 | 10 | 10 |
//! | `csg/sweep.rs` | `schedule`: `if m.next + 1 < m.crossings[1]`, the last event skipped | 46 | 26 | 26 |
//! | `prepare/lower.rs` | `combined`: `exprs.push(Expr::Or(cutters))`, `-` as `&` | 31 | 31 | 31 |
//! | `shot/camera.rs` | `ray`: `let x = x + 0.5;` | 0 | 46 | 46 |
//! | `solid/sphere.rs` | `build`: `let radii = 1.005 * radii;` | 41 | 41 | 41 |

mod golden_support;

use std::sync::Arc;

use glam::DVec3;
use golden_support::{Golden, all};
use pss::csg::{Expr, Leaf, Object};
use pss::geom::{Aabb, Interval, Ray};
use pss::golden::{Differs, Goldens, Kind};
use pss::prepare::Prepared;
use pss::shot::World;
use pss::solid::{Answer, Body, Crossing, Scratch, Solid};

/// Which goldens fail of scenes whose text is another; scenes that the mutation leaves alone do not count.
fn failing(scenes: &[Golden], mutate: impl Fn(&Golden) -> Option<String>) -> Vec<(String, Vec<Kind>)> {
    let fails = |scene: &Golden| {
        let text = mutate(scene).filter(|text| *text != scene.text)?;
        Some((scene.name.clone(), kinds(&scene.compare(&text).differs)))
    };
    scenes.iter().filter_map(fails).collect()
}

fn kinds(differs: &[Differs]) -> Vec<Kind> {
    differs.iter().map(|d| d.kind).collect()
}

/// Those without scans: scans are the same under the same operators, and take their time.
fn exact() -> Vec<Golden> {
    let scanned = |s: &Golden| s.text.contains("points(") || s.text.contains("implicit(");
    all().into_iter().filter(|s| !scanned(s)).collect()
}

/// Minus for and, union for symmetric difference: the picture of a cut closed by half of all scenes would not tell, rays do.
#[test]
fn swapped_operators_fail_every_scene_that_has_them() {
    let scenes = all();
    let swaps = [("a - b", "a & b"), ("a & b", "a - b"), ("a ^ b", "a | b"), ("a | b", "a ^ b")];
    for (from, to) in swaps {
        let failed = failing(&scenes, |s| Some(s.text.replace(&format!("= {from}\n"), &format!("= {to}\n"))));
        assert_eq!(failed.len(), 2, "{from}");
        assert!(failed.iter().all(|(_, kinds)| *kinds == Kind::ALL), "{from} -> {to}: {failed:?}");
    }
    for (from, to) in [("(p - b)", "(p & b)"), ("(p & b)", "(p - b)"), ("(p ^ b)", "(p | b)"), ("(!p", "(p")]
    {
        let from_place = format!("place({from}");
        let swap = |s: &Golden| match from {
            "(!p" => Some(s.text.replace("place(!p", "place(p")),
            _ => Some(s.text.replace(&from_place, &format!("place({to}"))),
        };
        let failed = failing(&exact(), swap);
        assert!(10 < failed.len(), "{from}");
        assert!(failed.iter().all(|(_, kinds)| kinds.contains(&Kind::Spans)), "{from} -> {to}: {failed:?}");
    }
}

/// Half a percent more radius of a ball: in every scene that draws it.
#[test]
fn a_radius_of_half_a_percent_more_fails_every_scene() {
    let larger = |s: &Golden| {
        let text = s.text.replace("sphere(r: 0.9, at: [-0.5", "sphere(r: 0.9045, at: [-0.5");
        Some(text.replace("sphere(r: 0.8,", "sphere(r: 0.804,"))
    };
    let failed = failing(&all(), larger);
    assert!(30 < failed.len(), "{}", failed.len());
    for (name, kinds) in failed {
        // Of the list's intersection the ball is no part of the boundary.
        let hidden = name == "intersection-list";
        assert!(hidden || kinds.starts_with(&[Kind::Spans, Kind::Layers]), "{name}: {kinds:?}");
    }
}

/// Half a pixel to the right: rays of the world do not know, layers and picture do.
#[test]
fn half_a_pixel_fails_layers_and_pictures() {
    let shifted = |s: &Golden| {
        let (at, rest) = s.text.split_once("camera(eye: [")?;
        let (eye, rest) = rest.split_once("], look_at: [0, 0, 0], height: ")?;
        let (height, rest) = rest.split_once(',')?;
        let eye: Vec<f64> = eye.split(", ").map(|x| x.parse().unwrap()).collect();
        let eye = DVec3::from_slice(&eye);
        let half = 0.5 * height.parse::<f64>().unwrap() / 54.0;
        let by = half * (-eye).cross(DVec3::Z).normalize();
        let list = |v: DVec3| format!("[{}, {}, {}]", v.x, v.y, v.z);
        Some(format!("{at}camera(eye: {}, look_at: {}, height: {height},{rest}", list(eye + by), list(by)))
    };
    let failed = failing(&exact(), shifted);
    assert!(30 <= failed.len(), "{}", failed.len());
    for (name, kinds) in failed {
        assert_eq!(kinds, [Kind::Layers, Kind::Picture], "{name}");
    }
}

/// A solid with something wrong.
#[derive(Debug)]
struct Wrong {
    solid: Arc<dyn Solid>,
    /// Whether it forgets where a ray last comes out; else its normals point inward.
    forgets: bool,
}

impl Solid for Wrong {
    fn body(&self) -> Body {
        self.solid.body()
    }

    fn bounds(&self) -> Aabb {
        self.solid.bounds()
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        scratch: &mut Scratch,
        out: &mut Vec<Crossing>,
    ) -> Answer {
        let first = out.len();
        let answer = self.solid.crossings(ray, range, scratch, out);
        if self.forgets && first < out.len() {
            out.pop();
        }
        answer
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, scratch: &mut Scratch) -> DVec3 {
        let normal = self.solid.normal(ray, crossing, scratch);
        if self.forgets { normal } else { -normal }
    }
}

/// How scenes fail whose first solid, and no other, is wrong.
fn failing_with(forgets: bool) -> Vec<(String, Vec<Kind>)> {
    let fails = |scene: Golden| {
        let (Prepared { mut shot, outline, .. }, _) = scene.read(&scene.text, false);
        let object = shot.world.solids();
        let mut leaves = object.leaves().to_vec();
        let first: &mut Leaf = leaves.iter_mut().find(|leaf| leaf.group.is_none())?;
        first.solid = Arc::new(Wrong { solid: first.solid.clone(), forgets });
        let expr = Expr::Or(outline.parts.iter().map(|part| part.expr.clone()).collect());
        let sheets = shot.world.open().to_vec();
        let bare = shot.materials.len() as u32;
        shot.world = World::new(Object::new(leaves, &expr), sheets, shot.world.bounds(), bare);
        let goldens = Goldens::read(&scene.path()).unwrap();
        Some((scene.name, kinds(&goldens.compare(&shot).unwrap().differs)))
    };
    exact().into_iter().filter_map(fails).collect()
}

#[test]
fn a_solid_that_forgets_its_last_crossing_fails_every_scene() {
    let failed = failing_with(true);
    assert!(15 < failed.len(), "{}", failed.len());
    for (name, kinds) in failed {
        // Where all meet in the smallest the first never ends anything.
        assert!(name == "intersection-list" || kinds.contains(&Kind::Spans), "{name}: {kinds:?}");
    }
}

/// Layers hold normals, spans do not: they fail too where the clean-up or an owner asked for one.
#[test]
fn a_solid_whose_normals_point_inward_fails_layers() {
    let failed = failing_with(false);
    let layers = failed.iter().filter(|(_, kinds)| kinds.contains(&Kind::Layers)).count();
    assert!(15 < layers, "{layers} of {failed:?}");
}
