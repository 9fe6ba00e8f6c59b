//! What the formatter keeps: the tree, every comment, and its own output.
#![expect(clippy::disallowed_methods, reason = "tests read the project's own scenes")]

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::check::{formatted, made_keeps, scene, tree};
use crate::{Budgets, format};

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
fn what_a_bracket_holds_behind_a_comment_passes_no_margin() {
    // Up to the longest that has room with its comment and a comma on a line of its own.
    for n in 60..90 {
        let word = "x".repeat(n);
        for (open, close) in [("[", "]"), ("f(", ")"), ("(b, ", ")")] {
            for held in [format!("{word}\n"), format!("{word},\nb"), format!("b,\n{word}")] {
                let text = format!("scene 1\nlet a = {open}/* c */ {held}{close}\n");
                let text = formatted(&text).unwrap();
                assert!(text.lines().all(|line| line.len() <= super::WIDTH), "{text}");
            }
        }
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
    #![proptest_config(ProptestConfig {
        cases: 600,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..<_>::default()
    })]

    #[test]
    fn any_text_keeps_its_tree_and_comments(scene in scene()) {
        if let Err(why) = made_keeps(&scene) {
            return Err(TestCaseError::fail(why));
        }
    }
}
