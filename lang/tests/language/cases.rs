//! Cases: a snippet, then the mistakes that must be told of it, all of them and nothing else.
//!
//! `--- name ---` begins a case. Lines of the form `// error: E0402 3:5-3:10 fragment & fragment` (or
//! `// warning: …`) at its end say code, place and parts of the message, its help, its further places
//! (`see 2:5 first`) or its mends (``sure `radus` → `radius` ``). A place in another text than the
//! snippet begins with its name: `--set:1:1-1:6`; `-` is no place. `// set: a=b` gives a value on the
//! command line, `// file: name` begins another file, `// small` loads with small budgets.

use std::fmt::Write as _;

use luxel_core::diag::{Diagnostic, Fix};
use luxel_lang::Loaded;

use crate::case::{Case, cases_of, differences, head, words};
use crate::registry::registry;

/// Every case: its name and its text.
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    const CASES: [&str; 9] = [
        include_str!("../cases/catalogue.txt"),
        include_str!("../cases/syntax.txt"),
        include_str!("../cases/names.txt"),
        include_str!("../cases/habits.txt"),
        include_str!("../cases/unfinished.txt"),
        include_str!("../cases/units.txt"),
        include_str!("../cases/schema.txt"),
        include_str!("../cases/plugins.txt"),
        include_str!("../cases/expect.txt"),
    ];
    CASES.into_iter().flat_map(cases_of)
}

fn load(case: &Case) -> Loaded {
    case.load_with(&registry())
}

/// What is wrong with a case; empty when all is as it says.
fn check(case: &Case) -> String {
    let loaded = load(case);
    let mut told: Vec<(String, String)> = vec![];
    for diagnostic in &loaded.diagnostics {
        told.push((head(diagnostic, &loaded.sources), words(diagnostic, &loaded.sources)));
        let known = luxel_lang::CATALOGUE.iter().any(|(code, _)| *code == diagnostic.code);
        assert!(known, "{} is not in the catalogue", diagnostic.code);
    }
    differences(case, told)
}

#[test]
fn every_case_tells_exactly_its_mistakes() {
    let mut failures = String::new();
    let mut codes = std::collections::BTreeSet::new();
    for (name, body) in all() {
        let case = Case::parse(name, body);
        codes.extend(
            case.expected
                .iter()
                .map(|(head, _)| head.split(' ').nth(1).expect("a code").to_owned()),
        );
        failures.push_str(&check(&case));
    }
    assert!(failures.is_empty(), "{failures}");
    // What solids, meshes and the stage tell has its cases with them (tests/data/stage_cases.txt).
    let elsewhere = ["E0411", "E0417", "E0418", "E0421", "E0422", "E0423"];
    let mut untold = luxel_lang::CATALOGUE.iter().map(|(code, _)| *code);
    let untold: Vec<_> = untold.by_ref().filter(|code| !codes.contains(*code)).collect();
    assert_eq!(untold, elsewhere);
}

/// What the mends of a case leave wrong; empty when each does what it is for.
///
/// A mend takes its mistake away and brings none but that a scene of which all was read is asked
/// for its camera.
fn check_mends(case: &Case) -> String {
    let before = load(case);
    let told = |found: &[Diagnostic]| -> Vec<(&'static str, String)> {
        let errors = found.iter().filter(|d| d.is_error() && d.code != "E0409");
        errors.map(|d| (d.code, d.message.clone())).collect()
    };
    let (mut out, old) = (String::new(), told(&before.diagnostics));
    for diagnostic in &before.diagnostics {
        for fix in &diagnostic.fixes {
            let Some(mended) = mended(case, fix, before.sources.name(fix.span.source)) else {
                continue;
            };
            let new = told(&load(&mended).diagnostics);
            let mut left = old.clone();
            let this = (diagnostic.code, diagnostic.message.clone());
            left.retain(|one| *one != this);
            if new.iter().any(|one| !left.contains(one)) {
                let why = words(diagnostic, &before.sources);
                let _ = writeln!(out, "--- {} ---\n {why}\n leaves {new:?}", case.name);
            }
        }
    }
    out
}

/// A case with a mend applied; `None` if the mend is on the command line.
fn mended(case: &Case, fix: &Fix, name: &str) -> Option<Case> {
    let mut mended = case.clone();
    let (_, bytes) = mended.files.iter_mut().find(|(path, _)| path == name)?;
    let text = String::from_utf8(std::mem::take(bytes)).expect("places are told of texts alone");
    *bytes = fix.applied(&text).into_bytes();
    Some(mended)
}

#[test]
fn every_mend_of_every_case_takes_its_mistake_away_and_brings_none() {
    let mut failures = String::new();
    let mut count = 0;
    for (name, body) in all() {
        let case = Case::parse(name, body);
        count += load(&case).diagnostics.iter().map(|d| d.fixes.len()).sum::<usize>();
        failures.push_str(&check_mends(&case));
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(count >= 60, "only {count} mends are offered by the cases");
}
