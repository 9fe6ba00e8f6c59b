//! Every built-in plugin, and the suite's own, judged.

use luxel_conformance::{Options, REFERENCE_CLASSES, Report, Verdict, run};
use luxel_core::registry::Registry;
use luxel_sdk::kind::Kind;

fn builtin() -> Registry {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).expect("built-ins have names of their own");
    }
    registry
}

/// No failure, and every class could be made, with every parameter.
fn check(report: &Report) {
    assert!(report.rows.len() > 5, "nothing was judged");
    assert!(report.is_clean(), "{report}");
    let unmade = |row: &&luxel_conformance::Row| {
        let made = ["parameters", "every parameter is tried"];
        made.contains(&&*row.check) && matches!(row.verdict, Verdict::Skip(_))
    };
    assert_eq!(report.rows.iter().filter(unmade).count(), 0, "{report}");
}

fn check_kind(kind: Kind) {
    let report = run(&builtin(), |class| class.kind == kind, &Options::default());
    check(&report);
}

#[test]
fn the_suites_own_plugins_satisfy_it() {
    let mut registry = Registry::new();
    registry.add("conformance", REFERENCE_CLASSES).unwrap();
    check(&run(&registry, |_| true, &Options::default()));
}

#[test]
fn builtin_materials_satisfy_the_suite() {
    check_kind(Kind::Material);
}

#[test]
fn builtin_media_and_phase_functions_satisfy_the_suite() {
    check_kind(Kind::Phase);
    check_kind(Kind::Medium);
}

#[test]
fn builtin_shapes_satisfy_the_suite() {
    check_kind(Kind::Shape);
}

#[test]
fn builtin_lights_and_textures_satisfy_the_suite() {
    check_kind(Kind::Light);
    check_kind(Kind::Texture);
}

#[test]
fn builtin_cameras_samplers_and_filters_satisfy_the_suite() {
    check_kind(Kind::Camera);
    check_kind(Kind::Sampler);
    check_kind(Kind::Filter);
}

#[test]
fn builtin_integrators_satisfy_the_suite() {
    check_kind(Kind::Integrator);
}

#[test]
fn builtin_importers_satisfy_the_suite() {
    check_kind(Kind::Importer);
}
