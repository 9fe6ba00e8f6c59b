//! Hover against a registry of made-up classes.

use std::path::Path;

use luxel_lang::editor::{Hover, complete, hover};

use crate::registry::registry;
use crate::{Files, marked, shown};

fn told(files: &[(&str, &str)]) -> Option<Hover> {
    let (files, path, at) = marked(files);
    hover(&files, &path, at, &registry())
}

/// Code and text are told, the text in part.
fn check(text: &str, code: &str, words: &str) {
    let found = told(&[("a", &format!("scene 1\n{text}"))]);
    let (found, said) = found.map_or_else(Default::default, |found| (found.code, found.text));
    assert_eq!(found, code, "{text}");
    assert!(said.contains(words), "{said}");
}

#[test]
fn hover_tells_manual_definition_and_unit() {
    let radius = "radius: number, in m, more than 0, required";
    check("shape sphere { ra|dius = 1 m }", radius, "Its radius.");
    check("sh|ape ball {}", "shape", "Kinds: box, cylinder");
    check("shape |sphere {}", "shape sphere", "A ball.");
    check("/// Wide.\nlet w = 3 m\nlet q = w| + 1 m", "let w = 3 m", "Wide.");
    check("fn f(x: float) = x\nlet q = |f(1)", "fn f(x: float) = x", "");
    check("let q = clam|p(1, 2, 3)", "clamp(x, low, high)", "else the nearer");
    check("let q = rgb.s|rgb(1, 2, 3)", "rgb.srgb(r, g, b)", "```scene\nrgb.srgb(1, 0.5, 0)");
    check("let q = 2 * p|i", "pi", "without a unit");
    check("gr|oup \"g\" {}", "group", "frame of their own");
    check("let q = \"te|xt\"", "", "");
    check("// comm|ent", "", "");
    check("shape sphere { ra|dius = , }\nlet z = (", radius, "Its");
    let ball = "shape sphere \"ball\" {}\n";
    check(&format!("{ball}set ball.ra|dius = 1 m"), radius, "Its radius.");
}

#[test]
fn units_are_told_in_si_units_without_rounding_errors() {
    check("let q = 5 c|m", "cm", "a length; 1 cm is 0.01 m");
    check("let q = (1, 2, 3) d|eg", "deg", "an angle; 1 deg is 0.01745329 rad");
    check("let q = 5 n|m", "nm", "1 nm is 1e-9 m");
    let text = |text: &str| told(&[("a", &format!("scene 1\n{text}"))]).unwrap().text;
    assert_eq!(text("let q = 5 W/m^2/s|r"), "a solid angle");
    assert_eq!(text("let q = 5 l|m"), "a luminous flux, as in lm; 1 lm is 1 cd*sr");
    check("units { length = m|m }", "mm", "1 mm is 0.001 m");
    check(
        "phase henyey_greenstein { |g = 0.5 }",
        "g: number, from -1 to 1, default 0",
        "Asymmetry.",
    );
    check("shape sphere \"m\" {}\nset |m.radius = 1 m", "shape sphere \"m\" {}", "");
}

#[test]
fn an_attribute_tells_what_it_does() {
    check("@o|ff shape sphere {}", "@off", "out of the scene");
    check("let off = 1\nlet q = of|f", "let off = 1", "");
}

#[test]
fn arguments_are_told_with_type_and_default_where_they_stand() {
    let f = "/// A ball.\nfn ball(r: length, n: int[3] = [1,\n 2, 3]) = r\n";
    let check = |text: &str, code: &str, words: &str| check(&format!("{f}{text}"), code, words);
    let usage = "An argument of `ball(r: length, n: int[3] = [1, 2, 3])`.";
    check("let a = ball(|r = 1 m)", "r: length", &format!("{usage}\n\nA ball."));
    check("let a = ball(1 m, |n = 2)", "n: int[3] = [1, 2, 3]", usage);
    check("let a = ball(1 m, |n = ", "n: int[3] = [1, 2, 3]", usage);
    check(
        "let a = clamp(x = 1, |low = 2, high = 3)",
        "low",
        "An argument of `clamp(x, low, high)`.",
    );
    check(
        "fn g(wide: length = 2 cm, deep: vec2 = (1, 2) m) = wi|de",
        "wide: length = 2 cm",
        "An argument of `g(wide: length = 2 cm, deep: vec2 = (1, 2) m)`.",
    );
    check("fn g(deep: vec2 = (1, 2) m, w: int) = de|ep", "deep: vec2 = (1, 2) m", "");
    let local = "group {\n fn g(wide: length) = wide\n let a = g(wi|de = 1 m)\n}";
    check(local, "wide: length", "An argument of `g(wide: length)`.");
}

#[test]
fn a_loop_tells_what_its_name_runs_through() {
    let found = |text: &str| {
        let found = told(&[("a", &format!("scene 1\n{text}"))]).unwrap();
        let (files, ..) = marked(&[("a", &format!("scene 1\n{text}"))]);
        (found.code, found.value_is, found.of.map(|place| shown(&files, &place)).unwrap())
    };
    let of = |code: &str, place: &str| (code.to_owned(), "one of", place.to_owned());
    let text = "for i, x in [1, 2] { shape sphere { radius = x| * 1 m } }";
    assert_eq!(found(text), of("for i, x in [1, 2]", "a:2:x"));
    assert_eq!(found("let f = [for |i in 0..9 if i > 2 => i]"), of("for i in 0..9", "a:2:i"));
    let nested = "for former in 0..3 {\n for i in 0..2 { let a = for|mer }\n}";
    assert_eq!(found(nested), of("for former in 0..3", "a:2:former"));
}

#[test]
fn members_are_told_by_what_has_them() {
    let lib = ("lib", "scene 1\n/// Shiny.\nlet gold = material conductor {}\n");
    let user = "scene 1\nimport \"lib\" as lib\nlet a = lib.g|old";
    let found = told(&[lib, ("a", user)]).unwrap();
    assert_eq!((&*found.code, &*found.text), ("let gold = material conductor {}", "Shiny."));
    let text = "scene 1\n/// Where.\nlet v = (1, 2, 3) m\nlet a = v.|y";
    let found = told(&[("a", text)]).unwrap();
    let of = "Of\n\n```scene\nlet v = (1, 2, 3) m\n```\n\nWhere.";
    assert_eq!((&*found.code, &*found.text), ("v.y", of));
    let (files, ..) = marked(&[("a", text)]);
    assert_eq!(shown(&files, &found.of.unwrap()), "a:4:y", "its own value is told");
}

#[test]
fn files_are_told_with_place_and_size_or_that_they_are_missing() {
    let lib = ("sub/lib", "scene 1\n");
    let check = |text: &str, code: &str, words: &str| {
        let found = told(&[lib, ("sub/a", &format!("scene 1\n{text}"))]).unwrap();
        assert_eq!((&*found.code, &*found.text), (code, words), "{text}");
    };
    check("import \"l|ib\" as n", "\"lib\"", "`sub/lib`, 8 bytes");
    check("include \"../|none\"", "\"../none\"", "`none`: there is no such file");
    check("texture image { file = \"li|b\" }", "\"lib\"", "`sub/lib`, 8 bytes");
    check("let s = spectrum.file(\"x|\")", "\"x\"", "`sub/x`: there is no such file");
    check("use plugin \"vel|vet\"", "use plugin \"velvet\"", "`velvet` 1.2.3 is loaded.");
    check("use plugin \"f|elt\"", "use plugin \"felt\"", "No library of that name is loaded.");
    let facts = "distribution: word, one of ggx, beckmann, default ggx";
    check("material conductor { distribution = \"g|gx\" }", facts, "Distribution.");
}

#[test]
fn spectra_are_told_as_a_screen_shows_them_without_an_evaluation() {
    let value = |text: &str| told(&[("a", &format!("scene 1\nlet q = {text}"))])?.value;
    let has = |text: &str, words: &str| {
        let found = value(text).unwrap_or_default();
        assert!(found.contains(words), "{text}: {found}");
    };
    has("black|body(3000 K)", "█");
    has("2 * black|body(temperature = 3000 K)", "█");
    has("me|tal(\"Au\")", "█");
    has("metal(\"A|u\")", "█");
    has("illuminant(\"D|65\")", "█");
    has("glass(\"N-B|K7\")", "Abbe number 64.2");
    has("rgb.s|rgb(1, 0.5, 0)", "#ff8000");
    has("spec|trum([(400 nm, 0), (700 nm, 1)])", "█");
    has("spectrum.con|stant(0.1)", "0.1 at every wavelength");
    assert_eq!(value("blackb|ody(t)"), None, "an evaluation tells it");
    assert_eq!(value("blackb|ody(0 K)"), None);
    assert_eq!(value("metal(\"u|nobtainium\")"), None);
}

#[test]
fn every_place_of_a_scene_is_answered_also_of_one_that_is_cut_off() {
    let texts = [
        include_str!("../scenes/bad_multi.scene"),
        include_str!("../scenes/glass_fog.scene"),
        include_str!("../scenes/parametric.scene"),
    ];
    let registry = registry();
    let ask = |files: &Files, at: usize| {
        complete(files, Path::new("a"), at, &registry);
        hover(files, Path::new("a"), at, &registry)
    };
    let mut n_told = 0;
    for text in texts {
        let whole = Files::of(&[("a", text)]);
        for (at, _) in text.char_indices() {
            n_told += usize::from(ask(&whole, at).is_some());
        }
        for (at, _) in text.char_indices().step_by(41) {
            ask(&Files::of(&[("a", &text[..at])]), at);
        }
    }
    assert!(n_told > 1000, "only {n_told}");
}
