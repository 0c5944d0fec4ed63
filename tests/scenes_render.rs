//! Every scene of the project: it reads, it is prepared and rendered without a warning, and there is something to see.

mod cli_common;

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use cli_common::{ply_with_normals, sphere};
use pss::lang::{Read, Reading};
use pss::measure::Measuring;
use pss::prepare::{self, Imports, Options};
use pss::render::Progress;
use pss::source::SourceMap;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scenes() -> Vec<PathBuf> {
    let folders = ["scenes", "scenes/cookbook"].map(|folder| fs::read_dir(root().join(folder)).unwrap());
    let entries = folders.into_iter().flatten().map(|e| e.unwrap().path());
    let mut scenes: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "pss")).collect();
    scenes.sort();
    scenes
}

/// Renders a scene small and gives its pixels.
fn pixels(path: &Path, defines: &[(String, String)]) -> Vec<[f32; 4]> {
    let name = path.display().to_string();
    let mut sources = SourceMap::default();
    let file = sources.add(name.clone(), Some(path.to_owned()), fs::read_to_string(path).unwrap());
    let folder = path.parent().unwrap();
    let measuring = Measuring::new(&Options { scene_dir: folder.to_owned(), ..Options::default() });
    let catalog = prepare::catalog();
    let reading = Reading {
        catalog: &catalog,
        defines,
        files: Some(&Imports {
            scene_dir: folder,
            allow_read: &[],
            limit: 1 << 20,
            inputs: Default::default(),
        }),
        geometry: Some(&measuring),
        expects: true,
        memory: pss::lang::MEMORY,
    };
    let Read { scene, warnings, unmet, .. } = pss::lang::read_with(&mut sources, file, &reading)
        .unwrap_or_else(|e| panic!("{name}: {}", pss::report::text(&e, &sources, false)));
    assert!(unmet.is_empty(), "{name}: {}", pss::report::text(&unmet, &sources, false));
    assert!(warnings.is_empty(), "{name}: {}", pss::report::text(&warnings, &sources, false));
    let options = Options {
        size: Some([64, 48]),
        // Where light goes from surface to surface single samples are black now and then.
        samples: Some(4),
        scene_dir: path.parent().unwrap().to_owned(),
        ..Options::default()
    };
    let prepared = prepare::prepare(&scene, &options)
        .unwrap_or_else(|e| panic!("{name}: {}", pss::report::text(&e, &sources, false)));
    let warnings = &prepared.warnings;
    assert!(warnings.is_empty(), "{name}: {}", pss::report::text(warnings, &sources, false));
    pss::render::render(&prepared.shot, &Progress::default()).unwrap().film.rgba
}

#[test]
fn every_scene_renders_and_shows_something() {
    let scan = tempfile::Builder::new().suffix(".ply").tempfile().unwrap();
    // A ball without its top: the scene has to close it.
    fs::write(scan.path(), ply_with_normals(&sphere(3000, 0.99))).unwrap();
    let scan = scan.path().to_str().unwrap().to_owned();
    assert!(30 <= scenes().len());
    for path in scenes() {
        let text = fs::read_to_string(&path).unwrap();
        let wants_file = text.contains("param file: string");
        let defines = if wants_file { vec![("file".to_owned(), scan.clone())] } else { Vec::new() };
        let pixels = pixels(&path, &defines);
        let colors: HashSet<[u32; 3]> =
            pixels.iter().map(|[r, g, b, _]| [r, g, b].map(|c| c.to_bits())).collect();
        assert!(50 < colors.len(), "{}: {} colours", path.display(), colors.len());
        let black = pixels.iter().filter(|p| p[..3] == [0.0; 3]).count();
        assert!(black < pixels.len() / 10, "{}: {black} black pixels", path.display());
        assert!(pixels.iter().flatten().all(|c| c.is_finite() && 0.0 <= *c), "{}", path.display());
    }
}

#[test]
fn every_scene_says_what_it_shows() {
    for path in scenes() {
        let text = fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(text.starts_with(&format!("// {name}: ")), "{name} begins with its name and what it shows");
    }
}

/// The words of a text that look like files of the project.
fn files_named(text: &str) -> Vec<&str> {
    let is_path = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    let words = text.split(|c| !is_path(c)).map(|w| w.trim_end_matches('.'));
    words
        .filter(|w| ["scenes/", "src/", "tests/", "grammar/"].iter().any(|room| w.starts_with(room)))
        .collect()
}

#[test]
fn the_readme_names_files_that_are_there() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let named = files_named(&readme);
    assert!(!named.is_empty());
    for file in &named {
        assert!(root().join(file).exists(), "README.md names {file}");
    }
    let cookbook = fs::read_to_string(root().join("scenes/cookbook/README.md")).unwrap();
    for path in scenes() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let told = if path.parent().unwrap().ends_with("cookbook") {
            let picture = path.with_extension("png");
            cookbook.contains(&format!("({name})")) && picture.exists()
        } else {
            named.contains(&format!("scenes/{name}").as_str())
        };
        assert!(told, "no README shows {name}");
    }
}

#[test]
fn the_scene_in_the_readme_is_the_one_of_its_first_picture() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let shown = readme.split("```pss\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let scene =
        files_named(&readme).into_iter().find(|f| f.ends_with(".png")).unwrap().replace(".png", ".pss");
    assert!(fs::read_to_string(root().join(&scene)).unwrap().contains(shown.trim()), "{scene} has changed");
}
