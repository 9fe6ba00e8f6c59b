//! What the formatter keeps: the tree, every comment, and its own output.
#![expect(clippy::disallowed_methods, reason = "tests read the project's own scenes")]

mod made;

use std::path::{Path, PathBuf};

use luxel_core::diag::SourceId;
use proptest::prelude::*;

use crate::sink::Sink;
use crate::syntax::parse;
use crate::{Budgets, format};

/// The tree of a text without its places; `None` if it cannot be read.
fn tree(text: &str) -> Option<String> {
    let mut sink = Sink::new(usize::MAX);
    let tree = parse(text, SourceId(0), &Budgets::default(), &mut sink);
    let told = format!("{:?}", tree.stmts);
    let mut bare = String::with_capacity(told.len());
    let mut parts = told.split("Span { source: SourceId(0)");
    bare.push_str(parts.next()?);
    for part in parts {
        bare.push_str(part.split_once('}')?.1);
    }
    (sink.errors() == 0).then_some(bare)
}

/// The comments of a text in order, found without the formatter's help.
fn comments(text: &str) -> Vec<String> {
    let (mut found, mut rest) = (vec![], text);
    while let Some(at) = rest.find(['"', '/']) {
        rest = &rest[at..];
        let line = rest.find('\n').unwrap_or(rest.len());
        let length = match rest.get(..2) {
            Some("//") => line,
            Some("/*") => rest[2..].find("*/").map_or(rest.len(), |end| end + 4),
            _ if rest.starts_with('"') => {
                // The first quote that has an even number of backslashes before it.
                let ends = |end: &usize| {
                    let body = &rest[1..*end];
                    (body.len() - body.trim_end_matches('\\').len()).is_multiple_of(2)
                };
                let quotes = rest.match_indices('"').map(|(at, _)| at).skip(1);
                quotes.into_iter().find(ends).map_or(rest.len(), |end| end + 1)
            }
            _ => 1,
        };
        if matches!(rest.get(..2), Some("//" | "/*")) {
            let lines = rest[..length].lines().map(str::trim_end);
            found.push(lines.collect::<Vec<_>>().join("\n"));
        }
        rest = &rest[length..];
    }
    found
}

/// Formats, and holds the result against what the formatter promises.
fn formatted(text: &str) -> Result<String, String> {
    let once = format(text, &Budgets::default()).map_err(|told| format!("{told:?}\n{text}"))?;
    let twice = format(&once, &Budgets::default()).map_err(|told| format!("{told:?}\n{once}"))?;
    let check = |kept: bool, what: &str, other: &str| {
        if kept { Ok(()) } else { Err(format!("{what}\n{text}\n=>\n{once}\n=>\n{other}")) }
    };
    check(once == twice, "formatting twice differs", &twice)?;
    check(tree(text) == tree(&once), "another tree", "")?;
    check(comments(text) == comments(&once), "other comments", "")?;
    let tidy = |line: &str| line.trim_end() == line && !line.contains('\r');
    let several = once.contains("/*") || once.split('\n').all(tidy);
    check(several && (once.ends_with('\n') || once.is_empty()), "untidy lines", "")?;
    Ok(once)
}

fn files_below(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !name.starts_with('.') && name != "target" && name != "node_modules" {
            files_below(&path, out);
        } else if path.extension().is_some_and(|e| e == "scene") {
            out.push(path);
        }
    }
}

#[test]
fn every_scene_of_the_project_keeps_its_tree_and_comments() {
    let mut files = vec![];
    files_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), &mut files);
    assert!(files.len() > 50, "{} scenes", files.len());
    let mut refused = 0;
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        if tree(&text).is_none() {
            refused += 1;
            assert!(format(&text, &Budgets::default()).is_err(), "{}", path.display());
            continue;
        }
        formatted(&text).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    }
    assert_eq!(refused, 1, "one scene is wrong on purpose");
}

#[test]
fn texts_before_and_after() {
    let cases = include_str!("../../tests/cases/format.txt");
    let mut failures = String::new();
    for case in cases.split("\n--- ").skip(1) {
        let (name, body) = case.split_once(" ---\n").expect("a case has a name");
        let (before, after) = body.split_once("=>\n").expect("a case has an arrow");
        let before = before.replace("<CR>", "\r").replace("<BOM>", "\u{FEFF}");
        match formatted(&format!("scene 1\n{before}")) {
            Ok(text) if text == format!("scene 1\n{}\n", after.trim_end_matches('\n')) => {}
            Ok(other) | Err(other) => failures.extend(["--- ", name, " ---\n", &other]),
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn what_cannot_be_read_is_refused_with_its_mistakes() {
    let codes = |text: &str| {
        let told = format(text, &Budgets::default()).expect_err("it is refused");
        told.iter().map(|it| it.code).collect::<Vec<_>>()
    };
    assert_eq!(codes("scene 1\nlet a = 5 +\nlet b  = 1\nlet c = = 2\n"), ["E0015", "E0013"]);
    assert_eq!(codes("scene 1\nlet a = (1\n"), ["E0008"]);
    assert_eq!(codes(""), ["E0001"]);
    assert_eq!(codes("scene 1\nlet a = 5 meters"), ["E0204"]);
    // Where warnings would take all the room, the mistakes are told alone.
    assert_eq!(
        codes(&format!("{}let a = = 2\n", lone_docs(3))),
        ["E0022", "E0022", "E0022", "E0013"]
    );
    assert_eq!(codes(&format!("{}let a = = 2\n", lone_docs(5000))), ["E0013"]);
}

/// A scene with doc comments that document nothing, of which reading warns.
fn lone_docs(n: usize) -> String {
    format!("scene 1\nshape x {{{}}}\n", "\n  /// a\n  // b\n".repeat(n))
}

#[test]
fn warnings_alone_refuse_nothing() {
    for n in [1, 99, 100, 101, 5000] {
        let text = formatted(&lone_docs(n)).unwrap();
        assert_eq!(text.matches("/// a").count(), n);
    }
}

#[test]
fn long_sequences_take_time_in_proportion_to_them() {
    let members = format!("scene 1\nlet a = x{}\n", ".a".repeat(50_000));
    let notes = format!("scene 1\n{}let a = 3\n", "@off ".repeat(50_000));
    let list = format!("scene 1\nlet a = f({}1)\n", "/* c */ ".repeat(50_000));
    let block = format!("scene 1\nshape a {{{}}}\n", "/* c */ ".repeat(50_000));
    // With a look at all that follows, at each piece, these would take a minute or more.
    for (text, word) in [(members, ".a"), (notes, "@off"), (list, "c"), (block, "c")] {
        let once = format(&text, &Budgets::default()).unwrap();
        assert!(once.matches(word).count() >= 50_000, "{word}");
    }
}

#[test]
fn brackets_as_deep_as_they_may_be_need_little_stack() {
    let lists = format!("scene 1\nlet a = {}1{}\n", "[".repeat(128), "]".repeat(128));
    let calls = format!("scene 1\nlet a = {}1{}\n", "f(b + [".repeat(64), "])".repeat(64));
    let blocks = format!("scene 1\n{}a = 1{}\n", "group { b = c\n".repeat(128), " }".repeat(128));
    for text in [lists, calls, blocks] {
        let run = move || formatted(&text).unwrap();
        let thread = std::thread::Builder::new().stack_size(2 << 20).spawn(run).unwrap();
        assert!(thread.join().unwrap().len() > 256);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..<_>::default() })]

    #[test]
    fn any_text_keeps_its_tree_and_comments(
        words in made::file(),
        noise in prop::collection::vec(any::<u8>(), 1..200),
    ) {
        let text = made::text(&words, &noise);
        prop_assert!(tree(&text).is_some(), "not a scene:\n{text}");
        if let Err(why) = formatted(&text) {
            return Err(TestCaseError::fail(why));
        }
    }
}
