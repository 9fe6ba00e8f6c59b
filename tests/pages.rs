//! The pages of the catalogue: each example makes its mistake, and each mended one makes none.

use std::path::Path;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_core::stage;
use luxel_lang::{Budgets, CATALOGUE, Settings, Setup, load, page, setup};

use crate::dynamic::{ember, open, registered};
use crate::fenced::{Fenced, SMALL};

/// The bytes of a text in which `\\xE9` and `\\0` stand for single ones.
fn bytes(text: &str) -> Vec<u8> {
    let text = text.replace("\\0", "\0");
    match text.split_once("\\xE9") {
        Some((before, after)) => [before.as_bytes(), b"\xE9", after.as_bytes()].concat(),
        None => text.into_bytes(),
    }
}

/// Everything that is told of an example, by the language and by the stage.
fn told(registry: &Registry, scene: &'static str, budgets: Budgets) -> Vec<Diagnostic> {
    let Setup { files: texts, set } = setup(scene);
    let files = texts
        .iter()
        .fold(MemoryFiles::default(), |files, (name, text)| files.with(*name, bytes(text)));
    let files = Fenced(files);
    let settings = Settings { set, budgets, ..Settings::default() };
    let loaded = load(Path::new("example.scene"), &files, registry, &settings);
    let mut found = loaded.diagnostics;
    match loaded.scene.map(|scene| stage::build(&scene, registry, &files, None)) {
        Some(Ok(built)) => found.extend(built.warnings),
        Some(Err(wrong)) => found.extend(wrong),
        None => {}
    }
    found
}

#[test]
fn every_example_makes_its_mistake_and_every_mended_one_none() {
    // A few mistakes are those of plugins.
    let registry = registered(&[&open("light_tracer"), &ember::library()]);
    let mut failures = vec![];
    for (code, _) in CATALOGUE {
        let example = page(code).unwrap().example;
        let budgets =
            if code.starts_with("E05") || *code == "E0011" { SMALL } else { Budgets::default() };
        let [wrong, mut right] =
            [example.wrong, example.right].map(|scene| told(&registry, scene, budgets));
        if !wrong.iter().any(|found| found.code == *code) {
            failures.push(format!("{code}: the example tells {wrong:?}"));
        }
        // A snippet without a camera is asked for one, when nothing else is wrong with it.
        right.retain(|found| found.code != "E0409" || *code == "E0409");
        if !right.is_empty() {
            failures.push(format!("{code}: the mended example tells {right:?}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
