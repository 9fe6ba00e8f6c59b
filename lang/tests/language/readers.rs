//! The reader that is fast against the one that is of record, statement by statement.
#![expect(clippy::disallowed_methods, reason = "tests read the project's own files")]

use std::path::{Path, PathBuf};

use luxel_lang::{Agreement, Budgets, agree};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::fenced::SMALL;
use crate::plant::Dice;

/// Texts that no one wrote, as the formatter's tests make them.
#[path = "../../src/fmt/check/made.rs"]
mod made;

/// What is put into texts: pieces of the language, and what is none.
const PIECES: [&str; 96] = [
    "",
    "",
    "",
    "",
    " ",
    "\n",
    "\t",
    "\r\n",
    ",",
    ";",
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "#[",
    "#[1 2]",
    "\"",
    "\"a\"",
    "\"\\u{e9}\\n\"",
    "\"\\q\"",
    "=",
    "==",
    "=>",
    "!",
    "!=",
    "<",
    ">=",
    "+",
    "-",
    "+-",
    "±",
    "*",
    "/",
    "%",
    "^",
    "^2",
    "^-1",
    "&&",
    "||",
    "..",
    "..=",
    ".",
    ".x",
    "a.b",
    "//",
    "// c\n",
    "///",
    "/// d\n",
    "////\n",
    "/* c */",
    "/*",
    "@off ",
    "@",
    "x",
    "_",
    "1",
    "1.",
    ".5",
    "1e3",
    "1e",
    "1_000",
    "1__0",
    "1e999",
    " m",
    " mm",
    "m/s",
    " W/m^2/sr",
    " m*2",
    " µm",
    "é",
    "\u{FEFF}",
    "if ",
    "else ",
    "for i in ",
    "let ",
    "fn f() ",
    "param p: int = ",
    " in ",
    " with { a = 1 }",
    " where { a = 1 }",
    "as",
    "true",
    "false",
    "include ",
    "include(1)",
    "assert ",
    "expect ",
    "place ",
    "set ",
    "use plugin ",
    "units ",
    "shape box {}",
    "shape box \"b\" {",
    "group {",
];

fn agreed(text: &str, budgets: &Budgets) -> Agreement {
    agree(text, budgets).unwrap_or_else(|why| panic!("{why}"))
}

/// The texts of files with an ending, below a folder.
fn texts(folder: &Path, ending: &str, out: &mut Vec<(PathBuf, String)>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the project") {
        let path = entry.expect("a file of the project").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !name.starts_with('.') && name != "target" && name != "node_modules" {
            texts(&path, ending, out);
        } else if path.extension().is_some_and(|e| e == ending) {
            let text = std::fs::read_to_string(&path).expect("a text");
            out.push((path, text));
        }
    }
}

fn project(ending: &str) -> Vec<(PathBuf, String)> {
    let mut out = vec![];
    texts(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), ending, &mut out);
    out
}

/// Statements that are right, to be edited.
fn statements() -> Vec<String> {
    let mut out = vec![];
    for text in [
        include_str!("../scenes/cornell.scene"),
        include_str!("../scenes/glass_fog.scene"),
        include_str!("../scenes/parametric.scene"),
    ] {
        let starts = luxel_lang::prescan::scan(text, 0..text.len(), 0, 128).starts;
        let ends = starts.iter().skip(1).copied().chain([text.len()]);
        out.extend(
            starts.iter().zip(ends).skip(1).map(|(start, end)| text[*start..end].to_owned()),
        );
    }
    out
}

#[test]
fn every_statement_of_the_project_is_read_directly_and_as_pest_reads_it() {
    let scenes = project("scene");
    assert!(scenes.len() > 50, "{} scenes", scenes.len());
    let mut direct = 0;
    for (path, text) in scenes {
        let found = agreed(&text, &Budgets::default());
        assert_eq!(found.missed, 0, "{}", path.display());
        direct += found.direct;
    }
    assert!(direct > 500, "{direct}");
}

#[test]
fn what_is_written_about_the_language_is_read_alike() {
    let (mut direct, mut told) = (0, 0);
    let pages = project("md").into_iter().map(|(_, text)| (text, "```"));
    for (text, cut) in pages.chain(project("txt").into_iter().map(|(_, text)| (text, "\n--- "))) {
        for piece in text.split(cut) {
            // The first line of a piece is its name or language, not its text.
            let body = piece.split_once('\n').map_or("", |(_, body)| body);
            for budgets in [Budgets::default(), SMALL] {
                let found = agreed(&format!("scene 1\n{body}"), &budgets);
                (direct, told) = (direct + found.direct, told + found.told);
            }
        }
    }
    assert!(direct > 1000 && told > 100, "{direct} and {told}");
}

/// Puts a piece in the place of up to `longest` characters.
fn edit(text: &mut String, dice: &mut Dice, longest: usize) {
    let ends: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let start = dice.below(ends.len());
    let end = (start + dice.below(longest)).min(ends.len() - 1);
    text.replace_range(ends[start]..ends[end], PIECES[dice.below(PIECES.len())]);
}

#[test]
fn edited_statements_are_read_alike() {
    let (statements, mut dice, mut sum) = (statements(), Dice(11), Agreement::default());
    for _ in 0..4000 {
        let mut text = statements[dice.below(statements.len())].clone();
        for _ in 0..=dice.below(2) {
            edit(&mut text, &mut dice, 5);
        }
        let found = agreed(&format!("scene 1\n{text}"), &Budgets::default());
        sum.direct += found.direct;
        sum.told += found.told;
        sum.missed += found.missed;
    }
    // Some are left to pest although they are right: it takes back what it has read where another
    // way to read it remains.
    assert!(sum.missed * 20 < sum.direct, "{sum:?}");
    assert!(sum.direct > 500 && sum.told > 1000, "{sum:?}");
}

#[test]
fn what_nests_without_end_is_read_alike() {
    for n in [10, 127, 128, 129, 400] {
        let texts = [
            format!("let a = {}1{}", "[".repeat(n), "]".repeat(n)),
            format!("let a = {}x{}", "(".repeat(n), ")".repeat(n)),
            format!("let a = {}1{}", "f(b + [".repeat(n / 2), "])".repeat(n / 2)),
            format!("{}a = 1{}", "group { b = c\n".repeat(n), " }".repeat(n)),
            format!("let a = {}1{}", "material x { b = ".repeat(n), " }".repeat(n)),
            format!("let a = {}b {}", "if ".repeat(n), "{ 1 } else { 2 }".repeat(n)),
            format!("let a = b{}", ".c".repeat(n)),
            format!("let a = b(){}", ".c".repeat(n)),
            format!("let a = {}b", "-".repeat(n)),
            format!("let a = b{}", " + b".repeat(n * 40)),
        ];
        for text in texts {
            agreed(&format!("scene 1\n{text}\n"), &Budgets::default());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 600,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..<_>::default()
    })]

    #[test]
    fn any_text_is_read_directly_and_as_pest_reads_it(
        words in made::file(),
        noise in prop::collection::vec(any::<u8>(), 1..200),
    ) {
        let text = made::text(&words, &noise);
        match agree(&text, &Budgets::default()) {
            Ok(found) => prop_assert_eq!((found.told, found.missed), (0, 0), "{}", text),
            Err(why) => return Err(TestCaseError::fail(why)),
        }
    }

    #[test]
    fn edited_texts_are_read_alike(
        words in made::file(),
        noise in prop::collection::vec(any::<u8>(), 1..200),
        seed in any::<u64>(),
    ) {
        let (mut text, mut dice) = (made::text(&words, &noise), Dice(seed));
        for _ in 0..4 {
            edit(&mut text, &mut dice, 3);
            if let Err(why) = agree(&text, &Budgets::default()) {
                return Err(TestCaseError::fail(why));
            }
        }
    }
}
