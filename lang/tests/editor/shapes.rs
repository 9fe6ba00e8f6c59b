//! Outlines, folds, colours and tokens.

use luxel_lang::Budgets;
use luxel_lang::editor::{Colour, Document, Entry, coloured, folds, outline, swatches, written};

const TEXT: &str = "\
//! A scene
//! of things.
scene 1
let gold = material conductor { eta = metal(\"Au\") }
param far: length = 2 m
group \"trees\" {
  shape sphere \"é\" { radius = far }
  for i in 0..3 {
    place gold
  }
}
let t = #[ 1 2
  3 ] mm
let red = rgb.linear_srgb(1, 0, 0)
param many: int = 5 in 2..=9
";

fn never() -> bool {
    false
}

fn names(entries: &[Entry]) -> String {
    let one = |entry: &Entry| {
        let inner = names(&entry.children);
        if inner.is_empty() { entry.name.clone() } else { format!("{}[{inner}]", entry.name) }
    };
    entries.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[test]
fn an_outline_is_the_tree_of_what_has_names() {
    let document = Document::new(TEXT, &Budgets::default());
    let found = outline(&document, &never);
    assert_eq!(
        names(&found),
        "gold[eta] far trees[é for i[gold]] t red many".replace("[eta]", "").replace("[gold]", "")
    );
    for entry in &found {
        assert!(
            entry.range.start <= entry.selection.start && entry.selection.end <= entry.range.end
        );
        assert!(!TEXT[entry.range.clone()].ends_with('\n'), "{entry:?}");
    }
    assert!(outline(&document, &|| true).is_empty(), "it can be stopped");
}

#[test]
fn brackets_tables_and_comments_fold() {
    let document = Document::new(TEXT, &Budgets::default());
    let found: Vec<_> = folds(&document, &never).iter().map(|f| (f.start, f.end)).collect();
    assert_eq!(found, [(0, 1), (7, 8), (5, 9)]);
}

#[test]
fn colours_of_numbers_are_found_and_written() {
    let document = Document::new(TEXT, &Budgets::default());
    let found = swatches(&document, &never);
    assert_eq!(&TEXT[found[0].range.clone()], "metal(\"Au\")");
    assert_eq!(&TEXT[found[1].range.clone()], "rgb.linear_srgb(1, 0, 0)");
    assert_eq!((found[1].srgb.map(f64::round), found.len()), ([1.0, 0.0, 0.0], 2));
    assert!(swatches(&document, &|| true).is_empty(), "it can be stopped");
}

/// The colour of the only call that has one, in 255 steps.
fn swatch(call: &str) -> Option<[f64; 3]> {
    let document = Document::new(format!("scene 1\nlet c = {call}\n"), &Budgets::default());
    let found = swatches(&document, &never);
    assert!(found.len() < 2, "{found:?}");
    found.first().map(|swatch| swatch.srgb.map(|x| (x * 255.0).round()))
}

#[test]
fn colours_of_calls_with_literal_arguments_are_found() {
    assert_eq!(swatch("rgb.srgb(1, 0.5, 0)"), Some([255.0, 128.0, 0.0]));
    assert_eq!(swatch("rgb.srgb(b = 1, r = 0, g = 0)"), Some([0.0, 0.0, 255.0]));
    assert_eq!(swatch("rgb.linear_srgb(-0.1, 1, 9)"), Some([0.0, 255.0, 255.0]));
    assert_eq!(swatch("xyz(0.9505, 1, 1.089)"), Some([255.0, 255.0, 255.0]));
    assert_eq!(swatch("spectrum.constant(1)"), Some([255.0, 255.0, 255.0]));
    let [r, g, b] = swatch("2 * blackbody(2700 K)").unwrap();
    assert!(r > g && g > b, "a warm lamp");
    let [r, _, b] = swatch("blackbody(20000 K)").unwrap();
    assert!(r < b, "a blue star");
    let [r, g, b] = swatch("illuminant(\"D65\")").unwrap();
    assert!(r.min(g).min(b) > 240.0, "white");
    let [r, g, b] = swatch("metal(\"Au\")").unwrap();
    assert!(r > g && g > b, "gold");
    let [r, _, b] = swatch("spectrum([(400 nm, 0), (700 nm, 1)])").unwrap();
    assert!(r > b, "it reflects red");
    // Glass has no colour; the rest is no literal, or a mistake.
    for none in [
        "glass(\"N-BK7\")",
        "blackbody(t)",
        "blackbody(5)",
        "metal(\"X\")",
        "rgb.srgb(1)",
        "rgb.srgb(1, 2, 3, 4)",
        "sin(1, 2, 3)",
        "rgb.srgb(1 m, 0, 0)",
        "rgb.srgb(x = 1)",
        "rgb(1, 0, 0)",
    ] {
        assert_eq!(swatch(none), None, "{none}");
    }
}

#[test]
fn a_colour_is_written_back_where_numbers_stood() {
    let forms = |call: &str| written(call, [1.0, 0.50004, 0.0]);
    assert_eq!(forms("rgb.srgb(0, 0, 0)"), ["rgb.srgb(1, 0.5, 0)"]);
    let linear = forms("rgb.linear_srgb(0, 0, 0)");
    assert_eq!(linear, ["rgb.linear_srgb(1, 0.21408, 0)", "rgb.srgb(1, 0.5, 0)"]);
    for call in ["xyz (0, 0, 0)", "rgb.acescg(0, 0, 0)", "rgb.rec2020(0, 0, 0)"] {
        let found = forms(call);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(swatch(&found[0]), Some([255.0, 128.0, 0.0]), "{found:?}");
    }
    for call in ["blackbody(2700 K)", "metal(\"Au\")", "spectrum.constant(1)", "", "let a = 1"] {
        assert_eq!(forms(call), Vec::<String>::new(), "{call}");
    }
}

#[test]
fn colours_stand_wherever_values_do() {
    let text = "scene 1\nexpect mean = 1 where { tint = rgb.srgb(0, 1, 0) }\n";
    let document = Document::new(text, &Budgets::default());
    let found: Vec<_> = swatches(&document, &never).iter().map(|it| it.srgb).collect();
    assert_eq!(found.len(), 1);
    assert!((found[0][1] - 1.0).abs() < 1e-6, "{found:?}");
}

#[test]
fn tokens_are_what_they_mean() {
    let document = Document::new(TEXT, &Budgets::default());
    let found = coloured(&document, &(0..TEXT.len()), &never);
    let of = |word: &str, nth: usize| {
        let all: Vec<_> = found.iter().filter(|token| &TEXT[token.range.clone()] == word).collect();
        all.get(nth).map(|token| (token.colour, token.is_definition))
    };
    assert_eq!(of("scene", 0), Some((Colour::Keyword, false)));
    assert_eq!(of("gold", 0), Some((Colour::Variable, true)));
    assert_eq!(of("material", 0), Some((Colour::Type, false)));
    assert_eq!(of("conductor", 0), Some((Colour::Class, false)));
    assert_eq!(of("eta", 0), Some((Colour::Property, false)));
    assert_eq!(of("metal", 0), Some((Colour::Function, false)));
    assert_eq!(of("far", 1), Some((Colour::Parameter, false)));
    assert_eq!(of("mm", 0), Some((Colour::Unit, false)));
    assert_eq!(of("in", 1), Some((Colour::Keyword, false)));
    let sorted = found.windows(2).all(|pair| pair[0].range.end <= pair[1].range.start);
    assert!(sorted, "tokens stand in order and apart");
    let part = coloured(&document, &(60..90), &never);
    assert!(!part.is_empty() && part.len() < found.len());
}
