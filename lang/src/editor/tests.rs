//! An edited document is the document of the edited text.

use super::Document;
use super::check::same;
use crate::Budgets;

const START: &str = r#"//! A scene.
scene 1
/// Documented.
let gold = material conductor { eta = metal("Au"), roughness = 0.1 }
let r = 2 m
fn twice(x: length) = x * 2
for i in 0..3 {
  shape sphere "ball" { radius = twice(r), material = gold }
}
expect mean = 1
  where { r = 3 }
@off
shape box "box" { size = (1, 2, 3) m }
let a, b = 1
shape sphere { radius = é }
"#;

/// What people type, paste and delete.
const PASTES: [&str; 24] = [
    "",
    "",
    "",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "\"",
    "\n",
    " ",
    "x",
    "let q = 1\n",
    "/*",
    "*/",
    "//",
    "///",
    "@off ",
    ",",
    "= ",
    "\nshape sphere { radius = 1 m }\n",
    "for ",
    "é",
];

/// The next number of a sequence that looks random.
fn next(state: &mut u64, below: usize) -> usize {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    usize::try_from(*state >> 33).unwrap() % below.max(1)
}

#[test]
fn an_edited_document_is_the_document_of_the_edited_text() {
    for seed in [208, 2240, 12358, 41230].into_iter().chain(0..120) {
        let mut state = seed;
        let mut document = Document::new(START, &Budgets::default());
        for step in 0..25 {
            let length = document.text().len();
            let start = next(&mut state, length + 1);
            let end = start + [0, 0, 1, 3, 40][next(&mut state, 5)];
            let with = PASTES[next(&mut state, PASTES.len())];
            document.edit(start..end, with);
            same(&document, &format!("seed {seed}, step {step}, {start}..{end} {with:?}"));
        }
    }
}

#[test]
fn a_mend_in_a_text_that_is_cut_short_reads_it_to_the_end() {
    let open = "group {\nlet a = 1\n".repeat(12);
    let strays = format!("{}shape sphere {{}}\n", "let s = )\n".repeat(1100));
    for (text, steps) in [(open, 20), (strays, 1)] {
        for seed in 0..6 {
            let mut state = seed;
            let mut document = Document::new(format!("scene 1\n{text}"), &Budgets::default());
            for step in 0..steps {
                let start = 8 + next(&mut state, document.text().len() - 8);
                let end = start + [0, 1, 9, 40][next(&mut state, 4)];
                let with = PASTES[next(&mut state, PASTES.len())];
                document.edit(start..end, with);
                same(&document, &format!("seed {seed}, step {step}, {start}..{end} {with:?}"));
            }
        }
    }
}

#[test]
fn each_letter_of_a_statement_can_be_typed_and_deleted() {
    let typed =
        "shape sphere \"new\" {\n  radius = r\n  material = gold with { roughness = 0.2 }\n}\n";
    for at in [START.find("let r").unwrap(), START.len(), START.find("/// Doc").unwrap(), 0] {
        let mut document = Document::new(START, &Budgets::default());
        for (i, letter) in typed.char_indices() {
            document.edit(at + i..at + i, &letter.to_string());
            same(&document, &typed[..=i]);
        }
        for i in (0..typed.len()).rev() {
            document.edit(at + i..at + i + 1, "");
            same(&document, &typed[..i]);
        }
        assert_eq!(document.text(), START);
    }
}

#[test]
fn only_what_an_edit_changes_is_read_again() {
    let text = format!("scene 1\n{}", "shape sphere { radius = 1 m }\n".repeat(100));
    let mut document = Document::new(text.as_str(), &Budgets::default());
    let before: Vec<_> = document.pieces().iter().map(|piece| piece.read.clone()).collect();
    let at = text.len() / 2;
    document.edit(at..at, "2");
    let anew = document.pieces().iter().zip(&before);
    assert_eq!(anew.filter(|(piece, old)| !std::sync::Arc::ptr_eq(&piece.read, old)).count(), 1);
}
