//! Each command of the tutorial, run over its own files, which are made small.

use super::program::{Done, Folder};
use crate::disk::{root, text};
use crate::tutorial::texts;

/// The files of the tutorial as they are in its end, of few pixels and samples.
fn folder(page: &str) -> Folder {
    let (_, rest) = page.split_once("\n```expect\n").unwrap();
    let (said, _) = rest.split_once("\n```").unwrap();
    let files = texts(page).into_iter().filter(|(name, _)| !name.starts_with("error "));
    files.fold(Folder::new("tutorial"), |folder, (name, body)| {
        let last = if name == "mine.scene" { said } else { "" };
        let small = body.replace("(480, 300)", "(24, 15)").replace("samples = 64", "samples = 4");
        folder.with(name, &format!("{small}\n{last}\n"))
    })
}

/// The commands of the page in its order: lines of `sh` blocks, and those within a sentence that have an
/// argument.
fn commands(page: &str) -> Vec<String> {
    let blocks = page.split("\n```sh\n").skip(1);
    let blocks = blocks.filter_map(|block| Some(block.split_once("\n```")?.0.lines()));
    let flowing = page.replace('\n', " ");
    let sentences =
        flowing.split("`luxel ").skip(1).filter_map(|rest| Some(rest.split_once('`')?.0));
    let sentences = sentences.map(|rest| rest.split_whitespace().collect::<Vec<_>>());
    let sentences = sentences.filter(|words| words.len() > 1);
    let sentences = sentences.map(|words| format!("luxel {}", words.join(" ")));
    blocks.flatten().map(str::to_owned).chain(sentences).collect()
}

/// A word of a command, or one that asks for less of the same.
fn shorter<'a>(command: &str, word: &'a str) -> &'a str {
    match (command, word) {
        ("render", "30s") => "0.3s",
        ("study", "2%") => "50%",
        _ => word,
    }
}

/// What the command ended with, and whether that is what the tutorial says of it.
fn run(folder: &Folder, words: &[&str]) -> (Done, bool) {
    // So long nobody waits here.
    let words: Vec<&str> = words.iter().map(|it| shorter(words[0], it)).collect();
    // Nor for a sweep of everything that might be varied.
    let fewer: &[&str] = if words[0] == "study" {
        &["--sweep", "spp=4,8", "--size", "16x10", "--time", "2s"]
    } else {
        &[]
    };
    let done = folder.luxel(&[&words[..], fewer].concat());
    let is_right = match words[0] {
        // Whether so few samples are enough is not told here: `crate::tutorial` measures it.
        "verify" => done.code < 2 && done.out.contains("mine.scene"),
        // A target may be out of reach of so few samples.
        "study" => [0, 3].contains(&done.code),
        "diff" => done.code == 1 && !done.out.is_empty() && done.err.is_empty(),
        _ => done.code == 0 && done.err.is_empty(),
    };
    (done, is_right)
}

#[test]
fn every_command_of_the_tutorial_runs_over_its_files() {
    let page = text(&root().join("docs/tutorial.md"));
    let folder = folder(&page);
    let (mut failures, mut names) = (vec![], vec![]);
    for command in commands(&page) {
        let words: Vec<&str> = command.split_whitespace().collect();
        match words[..] {
            ["cargo", ..] => {}
            // It runs until it is ended: that it serves its page is enough.
            ["luxel", "watch", ..] => {
                let args = [&words[1..], &["--port=0", "--no-open"]].concat();
                assert!(folder.start(&args).page().0 > 0, "{command}");
            }
            ["luxel", ..] => {
                let (done, is_right) = run(&folder, &words[1..]);
                if !is_right {
                    failures.push(format!("{command}: {done:?}"));
                }
            }
            _ => failures.push(format!("{command} is no command of the program")),
        }
        names.push(words.get(1).copied().unwrap_or_default().to_owned());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    for name in ["render", "watch", "list", "describe", "explain", "verify", "study", "fmt", "diff"]
    {
        assert!(names.iter().any(|it| it == name), "{name} is not among {names:?}");
    }
    assert!(!folder.read("ball.exr").is_empty() && !folder.read("ball.png").is_empty());
}
