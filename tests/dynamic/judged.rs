//! Libraries that are wrong, judged by the suite: what ends a render must not pass for sound.

use luxel_conformance::{Options, Report, Verdict, run};
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_sdk::abi::{Class, LibraryTable};
use luxel_sdk::kind::Kind;

use super::bad::always::{CLASSES, quiet};
use crate::load::{Builtins, registry_of};

/// The classes that always fail, through the boundary, each under its own name.
fn judged(kind: &str, name: &str) -> Report {
    static TABLE: LibraryTable =
        LibraryTable { begin: None, ..luxel_sdk::library_table!(&[CLASSES]) };
    quiet();
    let mut registry = Registry::new();
    registry.add("always", &Library::linked(&TABLE).unwrap().classes).unwrap();
    let options = Options { samples: 1024, sets: 0, ..Options::default() };
    run(&registry, |class: &Class| (class.kind.word(), class.name) == (kind, name), &options)
}

#[test]
fn a_shape_whose_bounds_leave_out_a_part_is_caught() {
    let report = judged("shape", "narrow");
    assert!(report.failed().any(|row| row.check == "hits inside bounds"), "{report}");
}

/// Checks that ask no object anything.
const OF_THE_SCHEMA: [&str; 7] = [
    "documented",
    "snake case",
    "units are known",
    "default in range",
    "refuses out of range",
    "errors have a place",
    "never ends a render",
];

#[test]
fn plugins_that_panic_are_caught() {
    for (kind, name) in [("material", "panics"), ("shape", "panics"), ("texture", "panics")] {
        let report = judged(kind, name);
        let caught = report.failed().find(|row| row.check == "never panics");
        let caught = caught.unwrap_or_else(|| panic!("{kind} {name}: {report}"));
        assert!(caught.detail.contains("fell over on purpose"), "{}", caught.detail);
        let passed = report.rows.iter().filter(|row| row.verdict == Verdict::Pass);
        let of_behaviour = |check: &str| !OF_THE_SCHEMA.contains(&check);
        let untried: Vec<_> = passed.filter(|row| of_behaviour(&row.check)).collect();
        assert!(untried.is_empty(), "{kind} {name} was not tried: {untried:#?}");
    }
}

#[test]
fn sound_plugins_are_as_sound_through_the_boundary() {
    let registry = registry_of(Builtins::Loaded);
    let options = Options { samples: 256, sets: 0, ..Options::default() };
    let kinds = [Kind::Material, Kind::Texture, Kind::Light, Kind::Medium, Kind::Phase];
    let more = [Kind::Camera, Kind::Sampler, Kind::Filter, Kind::Shape];
    let report = run(&registry, |c| kinds.contains(&c.kind) || more.contains(&c.kind), &options);
    let failed = |check: &str| report.failed().any(|row| row.check == check);
    assert!(!failed("never ends a render") && !failed("never panics"), "{report}");
}
