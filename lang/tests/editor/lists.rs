//! Completion against a registry of made-up classes.

use luxel_lang::editor::{Completion, Item, OnDisk, complete};

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
    for text in ["group { transform = | }", "group { transform = [| }"] {
        check(text, &["move", "rotate", "motion"], &["red", "sin", "shape"]);
    }
    check("for far in | ", &["n"], &["far"]);
    check("for far in 0..3 { let b = |", &["n", "far"], &[]);
    check("let q = [for far in 0..3 => |", &["n", "far"], &[]);
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
    check("group {\n let w = f(1,\n 2)\n let v = max(w, 2, |", &["w"], &["v"]);
    check("group {\n let w = 2\n shape sphere { radius = |", &["w"], &[]);
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
    assert_eq!(found.on_disk, Some(files("sub/l", &[".scene"])));
    assert_eq!(completed(&[("a", "sc|")]).items[0].label, "scene 1");
}

fn files(written: &str, ends: &[&'static str]) -> OnDisk {
    OnDisk::Files { written: written.to_owned(), ends: ends.to_vec() }
}

#[test]
fn a_string_is_completed_by_what_it_is_read_as() {
    let asked = |text: &str, expected: Option<OnDisk>| {
        assert_eq!(completed(&[("a", &format!("scene 1\n{text}"))]).on_disk, expected, "{text}");
    };
    // The manual of `file` says nothing, that of the class names formats.
    let pictures = [".exr", ".jpeg", ".jpg", ".png"];
    asked("texture image { file = \"b|", Some(files("b", &pictures)));
    asked("texture image { file = \"b/c|\" }", Some(files("b/c", &pictures)));
    let known = "let t = texture image { file = \"x.png\" }\n";
    asked(&format!("{known}let u = t with {{ file = \"|\" }}"), Some(files("", &pictures)));
    asked("texture image { space = \"|", None);
    asked("import \"|\" as n", Some(files("", &[".scene"])));
    asked("expect same_as \"x|\"", Some(files("x", &[".scene"])));
    let spectra = [".csv", ".dat", ".spd", ".tsv", ".txt"];
    asked("let s = spectrum.file(\"le|\")", Some(files("le", &spectra)));
    asked("let s = spectrum.file(path = \"le|\")", Some(files("le", &spectra)));
    asked("let s = spectrum.file(\"leaf.csv\", column = \"|\")", None);
    asked("use plugin \"|\"", Some(OnDisk::Libraries));
    asked("use plugin \"velvet\" version \"|\"", None);
    asked("let s = \"|\"", None);
}

#[test]
fn loaded_libraries_and_their_versions_are_offered() {
    let labels = |text: &str| -> Vec<String> {
        let items = completed(&[("a", text)]).items;
        items.into_iter().map(|item| item.label).collect()
    };
    assert_eq!(labels("scene 1\nuse plugin \"ve|\""), ["gyroid", "velvet"]);
    assert_eq!(labels("scene 1\nuse plugin \"velvet\" version \"|\""), ["^1.2.3"]);
    assert_eq!(labels("scene 1\nuse plugin \"felt\" version \"|\""), Vec::<String>::new());
    assert_eq!(labels("scene 1\nuse plugin \"velvet\" |"), ["version"]);
    assert_eq!(labels("scene 1\nimport \"lib\" |"), ["as"]);
}

#[test]
fn an_object_without_a_kind_is_offered_what_all_kinds_take() {
    offers("film { | }", &["resolution", "exposure", "shutter"], &["radius"]);
    offers("shape { | }", &["material", "transform"], &["radius", "points"]);
    offers("shape bal { | }", &["material", "transform"], &["radius"]);
}

#[test]
fn what_comes_of_an_import_is_offered_as_what_it_is() {
    let inner = ("in", "scene 1\nlet orb = shape sphere { radius = 1 m }");
    let lib = (
        "lib",
        "scene 1\nimport \"in\" as deep\nlet gold = material conductor {}\nlet dark = gold\n\
         /// A ball.\nfn ball(r: length, n: int = 2, at: vec3[] = []) {}",
    );
    let labels = |text: &str| -> Vec<String> {
        let text = format!("scene 1\nimport \"lib\" as lib\nlet mine = lib.dark\n{text}");
        let mut items = completed(&[inner, lib, ("a", &text)]).items;
        items.sort_by_key(|item| item.rank);
        items.into_iter().map(|item| item.label).collect()
    };
    let has = |text: &str, wanted: &[&str]| {
        let found = labels(text);
        assert!(wanted.iter().all(|label| found.iter().any(|it| it == label)), "{text}: {found:?}");
    };
    has("let a = lib.gold with { | }", &["eta", "roughness"]);
    has("let a = lib.dark with { eta = x, | }", &["roughness"]);
    has("let a = mine with { | }", &["eta"]);
    has("let a = lib.deep.orb with { | }", &["radius"]);
    has("let a = lib.gold with { distribution = | }", &["\"ggx\""]);
    has("let a = lib.deep.|", &["orb"]);
    let named = ["r = ", "n = ", "at = "];
    assert_eq!(labels("lib.ball(|")[..3], named);
    assert_eq!(labels("let a = 2 * lib.ball(|)")[..3], named);
    assert_eq!(labels("lib.ball(1 m, |)")[..2], named[1..]);
    assert_eq!(labels("lib.ball(|, n = 3)")[..2], ["r = ", "at = "]);
    assert!(!labels("lib.ball(1 m + |)").contains(&"r = ".to_owned()));
    let text = "scene 1\nimport \"lib\" as lib\nlib.b|";
    let items = completed(&[inner, lib, ("a", text)]).items;
    let ball = items.iter().find(|item| item.label == "ball").unwrap();
    let facts = (ball.detail.as_str(), ball.doc.as_str(), ball.insert.as_str());
    assert_eq!(facts, ("ball(r: length, n: int = 2, at: vec3[] = [])", "A ball.", "ball($0)"));
    let called = completed(&[inner, lib, ("a", &format!("{text}(2 m)"))]).items;
    assert_eq!(called.iter().find(|item| item.label == "ball").unwrap().insert, "");
    let items = completed(&[inner, lib, ("a", "scene 1\nimport \"lib\" as l\nl.ball(|")]).items;
    let n = items.iter().find(|item| item.label == "n = ").unwrap();
    assert_eq!(n.detail, "int, default 2");
    assert!(n.doc.contains("fn ball(r: length") && n.doc.ends_with("A ball."), "{}", n.doc);
}

#[test]
fn units_go_on_behind_a_slash_and_stand_in_units() {
    let best = |text: &str| -> Vec<String> {
        let items = completed(&[("a", &format!("scene 1\n{text}"))]).items;
        let least = items.iter().map(|item| item.rank).min();
        let first = items.into_iter().filter(|item| Some(item.rank) == least);
        first.map(|item| item.label).collect()
    };
    assert_eq!(best("light area { radiance = 5 W/|"), ["m^2/sr"]);
    assert_eq!(best("light area { radiance = 5 W/m^2/|"), ["sr"]);
    assert_eq!(best("light area { radiance = 5 W/m^2/s| }"), ["sr"]);
    assert_eq!(best("medium homogeneous { sigma_t = 5 | }"), ["1/m"]);
    assert_eq!(
        best("param x: length = 5 |"),
        ["m", "km", "cm", "mm", "um", "µm", "nm", "inch", "ft"]
    );
    assert_eq!(best("units { angle = | }"), ["rad", "deg"]);
    assert_eq!(best("units { length = mm, time = | }"), ["s", "ms", "us"]);
    offers("let a = 5 W/|", &["m", "sr", "sin"], &["EV"]);
    offers("let a = (1, 2) W/m^2/|", &["sr"], &["EV"]);
    offers("let n = 2\nlet a = 5 / |", &["n", "sin"], &["m", "sr"]);
    offers("let n = 2\nlet a = n/|", &["n", "sin"], &["m", "sr"]);
    offers("units { | }", &["length", "intensity"], &["area", "volume"]);
}

#[test]
fn an_attribute_stands_before_a_statement() {
    offers("@|", &["off"], &["shape", "let"]);
    offers("let a = 1\n@o|", &["off"], &["shape", "let"]);
    offers("group {\n @| shape sphere {}\n}", &["off"], &["shape"]);
    offers("@off |", &["shape", "let"], &["with"]);
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
