//! docs/plugins.md lists the checks: those that there are, and no others.

use std::collections::{BTreeMap, BTreeSet};

use luxel_conformance::mutants::mutants;
use luxel_conformance::{Options, REFERENCE_CLASSES, run};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;

const MANUAL: &str = include_str!("../../../docs/plugins.md");

/// The heading of what is asked of all kinds.
const ALL: &str = "every kind";

/// The names in the tables below "## The checks", by the words of their headings.
fn documented() -> BTreeMap<&'static str, BTreeSet<String>> {
    let (_, section) = MANUAL.split_once("\n## The checks\n").expect("the manual lists them");
    let section = section.split("\n## ").next().unwrap_or_default();
    let mut found = BTreeMap::<_, BTreeSet<_>>::new();
    let mut heading = "";
    for line in section.lines() {
        if let Some(words) = line.strip_prefix("### ") {
            heading = words;
        } else if let Some(row) = line.strip_prefix("| `") {
            let (name, told) = row.split_once("` | ").expect("a name and what it finds");
            assert!(told.len() > 10, "{name}: {told}");
            let is_new = found.entry(heading).or_default().insert(name.replace("\\|", "|"));
            assert!(is_new, "{heading}: {name} is there twice");
        }
    }
    found
}

/// The names of the checks that are made of each kind.
fn reported() -> BTreeMap<&'static str, BTreeSet<String>> {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).expect("built-ins have names of their own");
    }
    for class in REFERENCE_CLASSES {
        // Some have the name of a built-in, which stays.
        registry.add("conformance", &[*class]).ok();
    }
    let few = Options { samples: 256, sets: 0, ..Options::default() };
    let mut rows = run(&registry, |_| true, &few).rows;
    // Points on a shape are judged only where enough lines meet it.
    let many = Options { samples: 16_384, sets: 0, ..few };
    rows.extend(run(&registry, |class| class.name == "reference_ball", &many).rows);
    // Memory is looked at by request, and one class shows it.
    let held = Options { memory: Some(|| Some(1 << 20)), ..few };
    rows.extend(run(&registry, |class| class.name == "box", &held).rows);
    for mutant in mutants().iter().filter(|mutant| mutant.class.kind != Kind::Integrator) {
        let mut registry = Registry::new();
        registry.add("mutants", &[mutant.class]).expect("nothing else is there");
        let is_it = |class: &Class| class.name == mutant.class.name;
        rows.extend(run(&registry, is_it, &few).rows);
    }
    let mut found = BTreeMap::<_, BTreeSet<_>>::new();
    for row in rows {
        found.entry(row.kind).or_default().insert(row.check.into_owned());
    }
    found
}

#[test]
fn the_manual_lists_the_checks_of_each_kind() {
    let (documented, reported) = (documented(), reported());
    let of_all = &documented[ALL];
    let mut wrong = vec![];
    for (kind, checks) in &reported {
        let own: BTreeSet<_> = checks.difference(of_all).collect();
        let told: BTreeSet<_> = documented.get(kind).into_iter().flatten().collect();
        let missing: Vec<_> = own.difference(&told).collect();
        let made_up: Vec<_> = told.difference(&own).collect();
        if !(missing.is_empty() && made_up.is_empty()) {
            wrong.push(format!("{kind}: missing {missing:?}, made up {made_up:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let made: BTreeSet<_> = reported.values().flatten().cloned().collect();
    assert_eq!(of_all.difference(&made).collect::<Vec<_>>(), Vec::<&String>::new());
}
