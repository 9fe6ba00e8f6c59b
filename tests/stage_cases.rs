//! What the stage tells of a scene, case by case: exact in code, in place and in the text underlined.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Sources};
use luxel_core::registry::Registry;
use luxel_core::stage;

use crate::case::{Case, cases_of, differences, head, words};
use crate::dynamic::{ember, open, registered};

/// What the language's own cases leave to the stage (lang/tests/language/cases.rs).
const CODES: [&str; 6] = ["E0411", "E0417", "E0418", "E0421", "E0422", "E0423"];

/// Head and words of each thing told, by the language and by the stage, with the text that it underlines.
fn told(case: &Case, registry: &Registry) -> Vec<(String, String)> {
    let loaded = case.load_with(registry);
    let mut found = loaded.diagnostics;
    let files = case.fenced();
    match loaded.scene.map(|scene| stage::build(&scene, registry, &files, None)) {
        Some(Ok(built)) => found.extend(built.warnings),
        Some(Err(wrong)) => found.extend(wrong),
        None => {}
    }
    let line = |it: &Diagnostic| {
        let words =
            format!("{}; under `{}`", words(it, &loaded.sources), under(it, &loaded.sources));
        (head(it, &loaded.sources), words)
    };
    found.iter().map(line).collect()
}

fn under<'a>(diagnostic: &Diagnostic, sources: &'a Sources) -> &'a str {
    diagnostic.span().map_or("", |span| &sources.text(span.source)[span.range()])
}

#[test]
fn every_case_of_the_stage_tells_exactly_its_mistakes() {
    // A few mistakes are those of plugins.
    let registry = registered(&[&open("light_tracer"), &ember::library()]);
    let (mut failures, mut codes) = (String::new(), BTreeSet::new());
    for (name, body) in cases_of(include_str!("data/stage_cases.txt")) {
        let case = Case::parse(name, body);
        let of = |(head, _): &(String, _)| head.split(' ').nth(1).expect("a code").to_owned();
        codes.extend(case.expected.iter().map(of));
        failures.push_str(&differences(&case, told(&case, &registry)));
    }
    assert!(failures.is_empty(), "{failures}");
    let untold: Vec<_> = CODES.iter().filter(|code| !codes.contains(**code)).collect();
    assert!(untold.is_empty(), "no case tells {untold:?}");
}
