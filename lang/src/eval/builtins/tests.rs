//! What the manual says of every function, tried.

use std::borrow::Cow;
use std::path::Path;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;

use super::functions;
use crate::Settings;

/// The value of an expression as an editor shows it, and what is told of it.
fn evaluated(expression: &str) -> (Option<String>, Vec<Diagnostic>) {
    let text = format!("scene 1\nlet example = {expression}\n");
    let files = MemoryFiles::default()
        .with("example.scene", text.as_bytes())
        .with("leaf.csv", "nm, lower, upper\n400, 0.05, 0.04\n700, 0.4, 0.5\n".as_bytes());
    let settings = Settings { noting: true, ..Settings::default() };
    let mut loaded = crate::load(Path::new("example.scene"), &files, &Registry::new(), &settings);
    // A scene without a camera is told so.
    loaded.diagnostics.retain(|found| found.code != "E0409");
    (loaded.values.all().into_values().next().map(Cow::into_owned), loaded.diagnostics)
}

#[test]
fn every_function_is_documented_and_its_example_is_evaluated_without_a_message() {
    let mut names: Vec<&str> = functions().map(|function| function.name).collect();
    for function in functions() {
        let told = evaluated(function.example);
        assert!(told.0.is_some() && told.1.is_empty(), "{function:?}: {told:?}");
        let name = if function.name == "rgb" { "rgb.linear_srgb" } else { function.name };
        assert!(function.example.contains(name), "{function:?}");
        assert!(function.doc.len() > 20 && function.doc.ends_with('.'), "{function:?}");
    }
    assert!(super::names().all(|name| names.contains(&name)));
    let many = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), many, "a name stands twice");
}

#[test]
fn what_manuals_say_of_values_is_so() {
    let check = |expression: &str, wanted: &str| {
        assert_eq!(evaluated(expression).0.as_deref(), Some(wanted), "{expression}");
    };
    check("atan2(0, 0) / 1 deg", "0");
    check("acos(-1) / 1 deg", "180");
    check("clamp(5, 2, 1)", "1");
    check("round(-2.5)", "-3");
    check("sqrt(4 m^2)", "2 m");
    check("pow(3 m, 2)", "9 m^2");
    check("len(#[ 1 2 3  4 5 6 ] m)", "6");
    check("len([(1, 2, 3), (4, 5, 6)])", "2");
    check("len((1, 2, 3) m)", "3");
    check("cross((1, 0, 0), (0, 1, 0))", "(0, 0, 1)");
    check("rgb.acescg(1, 1, 1)", "#ffffff");
    check("rgb.rec2020(1, 1, 1)", "#ffffff");
    check("xyz(0.9505, 1, 1.0891)", "#ffffff");
    check("rgb.srgb(0.5, 0.5, 0.5)", "#808080");
}

#[test]
fn what_manuals_call_a_mistake_is_one() {
    let check = |expression: &str, code: &str| {
        let codes: Vec<_> = evaluated(expression).1.iter().map(|found| found.code).collect();
        assert_eq!(codes, [code], "{expression}");
    };
    check("sin(5)", "E0201");
    check("asin(1.1)", "E0209");
    check("acos(-1.1)", "E0209");
    check("sqrt(2 m)", "E0205");
    check("sqrt(-1)", "E0209");
    check("log(0)", "E0209");
    check("normalize((0, 0, 0))", "E0209");
    check("rgb(1, 0, 0)", "E0206");
    // What is nowhere but in the middle is no direction, though it has no unit.
    check("look_at((0, 0, 0), (0, 1, 5) m, (0, 1, 0) m)", "E0201");
    check("look_at((0, 1, 0), (0, 1, 5) m, (0, 0, 0) m)", "E0402");
    check("matrix([1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 1, 0,  0, 0, 0, 1])", "E0412");
}
