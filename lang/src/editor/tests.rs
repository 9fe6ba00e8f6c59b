//! An edited document is the document of the edited text.

use luxel_core::diag::{Diagnostic, SourceId};

use super::Document;
use super::check::{same, same_within};
use crate::chance::next;
use crate::sink::Sink;
use crate::{Budgets, eval, syntax};

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

/// Lines about names: defined, used, used too early, mentioned by functions, shadowed, labelled.
const NAMED: [&str; 17] = [
    "let a = 1",
    "let b = a + c",
    "let c = (a, b, a)",
    "let d = [for a in 0..3 => a + b]",
    "param a: length = 1 m in 1 m..=b",
    "fn a(x: length) = b(x)",
    "fn b(y: length = c) = a(y)",
    "fn c() { shape sphere \"a\" { radius = a } }",
    "for b in 0..3 { let a = b place c }",
    "if a { let c = b } else { shape box \"b\" { size = c } }",
    "shape sphere \"a\" { radius = b }",
    "shape sphere \"b\" { radius (a, 1, 1) material = sin(a) }",
    "set a.radius = c",
    "@off let b = nope",
    "let a = )",
    "import \"f\" as c",
    "include \"f\" with { a = b }",
];

/// What a whole reading of a text says of it and its names.
fn whole(text: &str, budgets: &Budgets) -> Vec<Diagnostic> {
    let mut sink = Sink::new(budgets.diagnostics);
    let tree = syntax::parse(text, SourceId(0), budgets, &mut sink);
    eval::resolve(&tree, text, &mut sink);
    sink.finish()
}

#[test]
fn names_of_an_edited_document_are_those_of_a_whole_reading() {
    let mut told = 0;
    for seed in 0..60 {
        let mut state = seed;
        let lines: Vec<_> = (0..12).map(|_| NAMED[next(&mut state, NAMED.len())]).collect();
        let lines = lines.join("\n");
        let mut document = Document::new(format!("scene 1\n{lines}\n"), &Budgets::default());
        for step in 0..12 {
            let line = 1 + next(&mut state, document.n_lines().saturating_sub(2));
            let range = document.line(line);
            let with = NAMED[next(&mut state, NAMED.len())];
            match next(&mut state, 3) {
                0 => document.edit(range, with),
                1 => document.edit(range.start..range.start, &format!("{with}\n")),
                _ => document.edit(range.start..range.end + 1, ""),
            }
            same(&document, &format!("seed {seed}, step {step}"));
            let sorted = |mut found: Vec<Diagnostic>| {
                found.sort_by_key(|found| (found.span(), found.code));
                found
            };
            let text = document.text();
            let found = sorted(document.diagnostics());
            assert_eq!(found, sorted(whole(text, &Budgets::default())), "seed {seed}\n{text}");
            told += found.len();
        }
    }
    assert!(told > 1000, "{told}");
}

#[test]
fn a_definition_that_is_mended_counts_as_one() {
    let mut document = Document::new("scene 1\nlet a = 1\nlet a = )\n", &Budgets::default());
    let at = document.text().find(')').unwrap();
    document.edit(at..at + 1, "2");
    same(&document, "mended");
    assert_eq!(document.diagnostics().iter().map(|it| it.code).collect::<Vec<_>>(), ["E0103"]);
}

#[test]
fn a_bracket_between_a_doc_comment_and_its_statement_closes_what_stands_above() {
    let mut document = Document::new("scene 1\n)\n///\n}let a = 1\n", &Budgets::default());
    document.edit(8..8, "{");
    same(&document, "opened");
    document.edit(8..9, "");
    same(&document, "as before");
}

#[test]
fn a_brace_that_is_missing_further_up_is_told_for_one_that_closes_nothing() {
    let text = "scene 1\nlet a = 1\ngroup \"g\" {\n  for i in 0..3 {\n    let b = i = 2\n  }\n}\nlet c = a\n";
    let mut document = Document::new(text, &Budgets::default());
    let codes = |document: &Document| {
        let place = |found: &Diagnostic| document.line_of(found.span().unwrap().range().start);
        let found = document.diagnostics();
        found.iter().map(|found| (found.code, place(found))).collect::<Vec<_>>()
    };
    let whole = codes(&document);
    let brace = text.find("3 {").unwrap() + 1;
    document.edit(brace..brace + 2, "");
    same(&document, "without the brace");
    assert_eq!(codes(&document), [&[("E0023", 3)], &whole[..]].concat());
    document.edit(8..8, "let d = 1\n");
    same(&document, "further down");
    document.edit(brace + 10..brace + 10, " {");
    same(&document, "mended");
    let further = whole.iter().map(|(code, line)| (*code, line + 1));
    assert_eq!(codes(&document), further.collect::<Vec<_>>());
}

#[test]
fn mistakes_beyond_those_shown_are_counted_as_in_a_whole_reading() {
    let budgets = Budgets { diagnostics: 5, ..Budgets::default() };
    let text = format!("scene 1\nlet r = 1\n{}", "let a = r\nlet b = (r, s, r)\n".repeat(20));
    let mut document = Document::new(text, &budgets);
    for (range, with) in [(12..13, "q"), (12..13, "s"), (8..8, "let s = 2\n")] {
        document.edit(range, with);
        same_within(&document, with, &budgets);
        let counted = |found: Vec<Diagnostic>| found.last().map(|last| last.message.clone());
        let found = counted(document.diagnostics());
        assert!(found.as_ref().is_some_and(|message| message.contains("more mistakes")));
        assert_eq!(found, counted(whole(document.text(), &budgets)));
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
