//! The scenes that ship: each loads without a complaint and renders.

use glam::UVec2;
use luxel_core::diag::Diagnostic;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage;

use crate::disk::{OnDisk, files_below, root, text};
use crate::load::registry;

/// Small and short: whether it works, not how it looks.
const SIZE: UVec2 = UVec2::new(24, 24);

#[test]
fn every_shipped_scene_says_what_it_shows_and_renders() {
    let registry = registry();
    let files = files_below(&root().join("scenes"), "scene");
    assert!(files.len() >= 6, "only {} scenes ship", files.len());
    for path in files {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(text(&path).starts_with("//! "), "{name} does not say what it shows");
        let loaded = luxel_lang::load(&path, &OnDisk, &registry, &luxel_lang::Settings::default());
        let told = |said: &[Diagnostic]| said.iter().map(ToString::to_string).collect::<Vec<_>>();
        assert!(loaded.diagnostics.is_empty(), "{name}: {:?}", told(&loaded.diagnostics));
        let mut scene = loaded.scene.unwrap();
        scene.set_resolution(SIZE);
        let built = stage::build(&scene, &registry, &OnDisk, None)
            .unwrap_or_else(|said| panic!("{name}: {:?}", told(&said)));
        assert!(built.warnings.is_empty(), "{name}: {:?}", told(&built.warnings));
        let options = Options { spp: Some(4), ..Options::default() };
        let (film, _) = render(&built.stage, &options, &Control::default());
        let (mean, _) = film.mean();
        assert_eq!(film.bad_samples(), 0, "{name}");
        assert!(mean.y > 0.0 && mean.is_finite(), "{name} is black");
    }
}

#[test]
fn the_readme_shows_the_text_of_the_scene_that_made_its_picture() {
    let readme = text(&root().join("README.md"));
    let shown = readme.split("```scene\n").nth(1).and_then(|rest| rest.split("```").next());
    let scene = text(&root().join("scenes/spot.scene"));
    let (_, body) = scene.split_once('\n').expect("the first line says what it shows");
    assert_eq!(shown, Some(body));
}
