//! Completion and hover against a registry of made-up classes.

use luxel_lang::editor::{Completion, Item, complete, hover};

use crate::marked;
use crate::registry::registry;

fn completed(files: &[(&str, &str)]) -> Completion {
    let (files, path, at) = marked(files);
    complete(&files, &path, at, &registry())
}

/// Whether the labels are offered, best first, and others are not.
fn offers(text: &str, wanted: &[&str], others: &[&str]) {
    let mut items = completed(&[("a", &format!("scene 1\n{text}"))]).items;
    items.sort_by_key(|item| item.rank);
    let labels: Vec<&str> = items.iter().map(|item| item.label.as_str()).collect();
    for label in wanted {
        assert!(labels.contains(label), "{label} after {text}: {labels:?}");
    }
    for label in others {
        assert!(!labels.contains(label), "no {label} after {text}: {labels:?}");
    }
}

#[test]
fn statements_kinds_and_parameters_are_offered_where_they_stand() {
    offers("|", &["shape", "material", "group", "let", "param", "expect"], &["radius", "sphere"]);
    offers("let a = 1\nsha|", &["shape", "let"], &["a"]);
    offers("shape |", &["sphere"], &["diffuse", "shape"]);
    offers("let b = shape sph|", &["sphere"], &["diffuse"]);
    offers("shape sphere { | }", &["radius", "center", "transform", "material"], &["shape"]);
    offers("shape sphere { center = a, ra| }", &["radius"], &["center"]);
    offers("shape sphere { |\n center = a }", &["radius"], &["center"]);
    offers("shape sphere \"b\" {\n radius = 1 m\n |", &["center", "for"], &["radius"]);
    offers("let b = shape sphere { radius = 1 m }\nlet c = b with { | }", &["radius"], &["for"]);
    offers("group \"g\" {\n |\n}", &["shape", "transform"], &["radius"]);
    offers("fn f() {\n |\n}", &["shape", "let"], &["radius"]);
    let ball = "group \"g\" {\n let r = 1\n shape sphere \"ball\" { radius = 1 m }\n}\n";
    offers(&format!("{ball}set |"), &["ball", "g"], &["r"]);
    offers(&format!("{ball}set ball.|"), &["radius", "center"], &["for", "sin"]);
    offers("set nobody.|", &[], &["radius"]);
    offers("units { | }", &["length", "angle"], &["int"]);
}

#[test]
fn values_fit_what_they_are_given_to() {
    let paint = "let red = material conductor {}\nlet b = shape sphere {}\nlet n = 3\n";
    let check = |text: &str, wanted: &[&str], others: &[&str]| {
        offers(&format!("{paint}{text}"), wanted, others);
    };
    check("material coated { base = | }", &["red", "material"], &["b", "sin"]);
    check("shape sphere { radius = | }", &["n", "sqrt"], &["red", "metal"]);
    check("material conductor { distribution = | }", &["\"ggx\"", "\"beckmann\""], &["n"]);
    check("material conductor { distribution = \"| }", &["ggx", "beckmann"], &["n"]);
    check("material diffuse { reflectance = | }", &["rgb.srgb", "metal"], &["red", "sin"]);
    check("let q = | ", &["n", "red", "sin", "shape"], &[]);
    check("let q = n + |", &["n", "sin"], &["let"]);
    check("let q = metal(\"|", &["Au", "gold"], &["N-BK7"]);
    check("let q = glass(\"|\")", &["N-BK7"], &["Au"]);
    check("let q = illuminant(\"|\")", &["D65"], &["Au"]);
    check("let q = rgb.|", &["srgb", "acescg"], &["sin"]);
    check("param x: |", &["length", "int"], &["sin"]);
    check("place |", &["b"], &["red"]);
    check("fn f(wide: float) = 1\nlet z = f(|)", &["wide = "], &[]);
    check("for i in 0..3 { shape sphere { radius = |", &["i"], &[]);
    check("let z = f(x // |", &[], &["n"]);
    check("let z = \"|", &[], &["n"]);
}

#[test]
fn units_of_the_wanted_dimension_stand_first() {
    let found = completed(&[("a", "scene 1\nshape sphere { radius = 5 | }")]).items;
    let best = |name: &str| found.iter().find(|item| item.label == name).unwrap().rank;
    assert!(best("cm") < best("deg") && best("m") < best("W"));
    offers("let a = (1, 2, 3) |", &["m", "deg"], &["sin"]);
}

#[test]
fn other_files_offer_their_names_and_parameters() {
    let lib = ("lib", "scene 1\n/// How far.\nparam far: length = 1 m\nlet tree = group {}");
    let labels = |text: &str| -> Vec<String> {
        let items = completed(&[lib, ("a", text)]).items;
        items.into_iter().map(|item| item.label).collect()
    };
    assert_eq!(labels("scene 1\nimport \"lib\" as n\nplace n.|"), ["far", "tree"]);
    assert_eq!(labels("scene 1\ninclude \"lib\" with { | }"), ["far"]);
    let found = completed(&[lib, ("a", "scene 1\ninclude \"sub/l|\"")]);
    assert_eq!(found.files, Some(("sub/l".to_owned(), vec![".scene"])));
    let found = completed(&[("a", "scene 1\ntexture image { file = \"b|")]);
    assert_eq!(found.files, Some(("b".to_owned(), vec![])));
    assert_eq!(completed(&[("a", "sc|")]).items[0].label, "scene 1");
}

#[test]
fn an_item_says_type_unit_and_default_and_writes_what_is_required() {
    let items = completed(&[("a", "scene 1\nshape sphere { | }")]).items;
    let radius = items.iter().find(|item| item.label == "radius").unwrap();
    assert_eq!(radius.detail, "number, in m, more than 0, required");
    assert_eq!((radius.doc.as_str(), radius.insert.as_str()), ("Its radius.", "radius = $0"));
    let items = completed(&[("a", "scene 1\nlet q = spectrum.|")]).items;
    let file = items.iter().find(|item| item.label == "file").unwrap();
    assert_eq!(
        (file.detail.as_str(), file.insert.as_str()),
        ("spectrum.file(path, column)", "file(\"$0\")")
    );
    assert!(file.doc.contains("wavelength in nm"), "{}", file.doc);
    let items = completed(&[("a", "scene 1\nlet q = |")]).items;
    let pi = items.iter().find(|item| item.label == "pi").unwrap();
    assert!(pi.detail == "a constant" && pi.doc.contains("3.14159"), "{pi:?}");
    let items = completed(&[("a", "scene 1\nshape |")]).items;
    assert_eq!(sphere_of(&items), ("A ball.", "sphere { radius = $0 }"));
}

fn sphere_of(items: &[Item]) -> (&str, &str) {
    let sphere = items.iter().find(|item| item.label == "sphere").expect("it is there");
    (&sphere.detail, &sphere.insert)
}

fn told(text: &str) -> (String, String) {
    let (files, path, at) = marked(&[("a", text)]);
    let found = hover(&files, &path, at, &registry());
    found.map_or_else(Default::default, |found| (found.code, found.text))
}

#[test]
fn hover_tells_manual_definition_and_unit() {
    let check = |text: &str, code: &str, words: &str| {
        let (found, said) = told(&format!("scene 1\n{text}"));
        assert_eq!(found, code, "{text}");
        assert!(said.contains(words), "{said}");
    };
    let radius = "radius: number, in m, more than 0, required";
    check("shape sphere { ra|dius = 1 m }", radius, "Its radius.");
    check("sh|ape ball {}", "shape", "Kinds: box, cylinder");
    check("shape |sphere {}", "shape sphere", "A ball.");
    check("/// Wide.\nlet w = 3 m\nlet q = w| + 1 m", "let w = 3 m", "Wide.");
    check("fn f(x: float) = x\nlet q = |f(1)", "fn f(x: float) = x", "");
    check("let q = clam|p(1, 2, 3)", "clamp(x, low, high)", "else the nearer");
    check("let q = rgb.s|rgb(1, 2, 3)", "rgb.srgb(r, g, b)", "```scene\nrgb.srgb(1, 0.5, 0)");
    check("let q = 2 * p|i", "pi", "without a unit");
    check("let q = 5 c|m", "cm", "a length");
    check("gr|oup \"g\" {}", "group", "frame of their own");
    check("let q = \"te|xt\"", "", "");
    check("// comm|ent", "", "");
    check("shape sphere { ra|dius = , }\nlet z = (", radius, "Its");
}
