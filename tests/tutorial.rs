//! The tutorial: what a newcomer copies from it works.

use std::path::Path;

use glam::UVec2;
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage;
use luxel_lang::{Budgets, Loaded, Settings};

use crate::disk::{root, text};
use crate::load::registry;

/// Each text of the tutorial with what stands behind `scene` at its head.
pub(crate) fn texts(page: &str) -> Vec<(&str, &str)> {
    let blocks = page.split("\n```scene ").skip(1);
    let blocks = blocks.map(|block| block.split_once("\n```").expect("a text ends").0);
    blocks.map(|block| block.split_once('\n').expect("a head has a line")).collect()
}

fn load(name: &str, files: &MemoryFiles) -> Loaded {
    luxel_lang::load(Path::new(name), files, &registry(), &Settings::default())
}

#[test]
fn every_step_of_the_tutorial_renders_and_is_laid_out() {
    let page = text(&root().join("docs/tutorial.md"));
    let (mut files, mut rendered) = (MemoryFiles::default(), 0);
    for (name, body) in texts(&page) {
        let body = format!("{body}\n");
        let laid_out = luxel_lang::format(&body, &Budgets::default());
        assert_eq!(laid_out.as_deref(), Ok(&*body), "{name}");
        if name.starts_with("error ") {
            continue;
        }
        files = files.with(name, body.as_bytes());
        // A stage has no camera: it is read with the scene that includes it.
        if name == "stage.scene" {
            continue;
        }
        let loaded = load(name, &files);
        assert_eq!(loaded.diagnostics, [], "{name}");
        let mut scene = loaded.scene.unwrap();
        scene.set_resolution(UVec2::new(24, 15));
        let built = stage::build(&scene, &registry(), &files, None).unwrap();
        let options = Options { spp: Some(4), ..Options::default() };
        let (film, _) = render(&built.stage, &options, &Control::default());
        assert!(built.warnings.is_empty() && film.mean().0.y > 0.0, "{name}");
        rendered += 1;
    }
    assert_eq!(rendered, 5);
}

#[test]
fn every_mistake_of_the_tutorial_is_told_by_the_code_that_it_says() {
    let page = text(&root().join("docs/tutorial.md"));
    let mut told = 0;
    for (name, body) in texts(&page) {
        let Some(code) = name.strip_prefix("error ") else { continue };
        let loaded = load("a.scene", &MemoryFiles::default().with("a.scene", body.as_bytes()));
        let codes: Vec<_> = loaded.diagnostics.iter().map(|it| it.code).collect();
        assert_eq!(codes, [code]);
        assert!(code == "E0401" || page.contains(&format!("says {code} with the line")));
        told += 1;
    }
    assert_eq!(told, 2);
}

#[test]
fn what_the_tutorial_expects_of_its_picture_is_so() {
    let page = text(&root().join("docs/tutorial.md"));
    let (_, rest) = page.split_once("\n```expect\n").unwrap();
    let (said, _) = rest.split_once("\n```").unwrap();
    let mut files = MemoryFiles::default();
    for (name, body) in texts(&page) {
        let last = if name == "mine.scene" { said } else { "" };
        files = files.with(name, format!("{body}\n{last}\n").as_bytes());
    }
    let loaded = load("mine.scene", &files);
    assert_eq!(loaded.diagnostics, []);
    let mut scene = loaded.scene.unwrap();
    assert_eq!(scene.expectations.len(), 1);
    scene.set_resolution(UVec2::new(48, 30));
    let built = stage::build(&scene, &registry(), &files, None).unwrap();
    let options = Options { spp: Some(16), ..Options::default() };
    let mean = render(&built.stage, &options, &Control::default()).0.mean().0.y;
    let expected: f64 = said.split(['=', '±']).nth(1).unwrap().trim().parse().unwrap();
    // As `luxel verify` measured it: 1.1e-4 of 64 samples of 100 times as many pixels, five times that.
    assert!((mean - expected).abs() < 5.0 * 1.1e-4 * 20.0, "{mean}");
}
