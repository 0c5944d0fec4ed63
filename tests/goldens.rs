//! Goldens of every operator and of every primitive under every operator, on analytic solids and on scans: where fixed rays go in
//! and out, layers, and pictures, all in `tests/goldens`, on which `pss test tests/goldens` runs as on any folder.
//!
//! Each scene has a number that a formula knows, so that a wrong golden cannot be blessed unseen; goldens are shown to fail in
//! `golden_mutations`. `PSS_BLESS=1 cargo test --test goldens` rewrites what differs.

mod golden_support;

use golden_support::primitives::assets;
use golden_support::{Golden, all, blessing, folder, holds, primitives};
use pss::golden::{self, Goldens, Kind, rays, spans};
use pss::solid::table::PRIMITIVES;

/// Scenes that are as they were; all differences in words.
fn unlike(scenes: &[Golden]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, bytes) in assets() {
        if !holds(&folder().join(name), &bytes) {
            wrong.push(name.to_owned());
        }
    }
    for scene in scenes {
        if !holds(&scene.path(), scene.text.as_bytes()) {
            wrong.push(format!("{}.pss", scene.name));
        }
        let (prepared, unmet) = scene.read(&scene.text, true);
        if !unmet.is_empty() {
            wrong.push(format!("{}: {unmet:#?}", scene.name));
        } else if blessing() {
            let goldens = Goldens::read(&scene.path()).unwrap();
            golden::bless(&scene.path(), &goldens, &prepared.shot, &[]).unwrap();
        } else {
            let differs = scene.compare(&scene.text).differs;
            wrong.extend(differs.iter().map(|d| format!("{}: {d:?}", scene.name)));
        }
    }
    wrong
}

/// What formulas say, where rays go, which leaf is seen where, and what is seen.
#[test]
fn scenes_are_what_their_formulas_and_goldens_say() {
    let wrong = unlike(&all());
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_primitive_has_a_golden_and_every_golden_a_number() {
    let scenes = primitives::subjects();
    for p in PRIMITIVES.iter().filter(|p| p.decl.word != "plane") {
        let word = p.decl.word;
        assert!(
            scenes.iter().any(|s| s.name.starts_with(word) && s.text.contains(&format!("{word}("))),
            "{word}"
        );
    }
    assert!(all().iter().all(|scene| scene.text.contains(" ~= ")));
}

/// No file without its scene: a golden that nothing compares would rot.
#[test]
fn every_file_belongs_to_a_scene() {
    let scenes = all();
    let mut known: Vec<_> = scenes.iter().map(Golden::path).collect();
    known.extend(scenes.iter().flat_map(|s| Kind::ALL.map(|kind| kind.beside(&s.path()))));
    known.extend(assets().map(|(name, _)| folder().join(name)));
    // That of the language's tests.
    known.push(folder().join("mistakes.txt"));
    let mut open = vec![folder()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let is_difference = path.to_string_lossy().ends_with(".diff.png");
                assert!(is_difference || known.contains(&path), "{}", path.display());
            }
        }
    }
}

/// A golden is text by one rule: the rays of another thread, run or machine are those of its head.
#[test]
fn one_thread_and_many_write_the_same_bytes() {
    let scenes = all();
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    for name in ["xor-scans", "primitives/extrude", "films"] {
        let scene = scenes.iter().find(|s| s.name == name).unwrap();
        let made = [1, 4].map(|threads| {
            pool(threads).install(|| {
                let (prepared, _) = scene.read(&scene.text, false);
                let rays = rays::Rays::of(prepared.shot.world.bounds());
                let text = spans::text(&spans::trace(&prepared.shot.world, rays));
                (text, golden::layers::film(&prepared.shot).unwrap())
            })
        });
        assert!(made[0] == made[1], "{name}");
    }
}
