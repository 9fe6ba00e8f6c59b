//! How many mistakes that are planted in the scenes that ship are told in one run.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::accel::Watch;
use luxel_core::diag::{Diagnostic, Label};
use luxel_core::files::{FileError, Files};
use luxel_core::stage;
use luxel_lang::{Settings, load};

use crate::disk::{OnDisk, files_below, root, text};
use crate::load::registry;
use crate::plant::{Dice, Score};
use crate::published;

/// So often are mistakes planted in each scene.
const ROUNDS: usize = 20;

#[test]
fn nine_of_ten_planted_mistakes_are_told_of_the_shipped_scenes() {
    let registry = registry();
    let (mut score, mut dice) = (Score::default(), Dice(1));
    for path in files_below(&root().join("scenes"), "scene") {
        let lines = |text: &str| {
            let files = Beside(path.clone(), text.as_bytes().into());
            let loaded = load(&path, &files, &registry, &Settings::default());
            let line = |d: &Diagnostic| {
                d.span().map_or(0, |s| loaded.sources.line_column(s.source, s.start as usize).line)
            };
            loaded.diagnostics.iter().map(|d| (line(d), d.code)).collect::<Vec<_>>()
        };
        for _ in 0..ROUNDS {
            score.run(&text(&path), 5, &mut dice, lines);
        }
    }
    let (told, strangers) = score.shares();
    println!("{}", score.table());
    assert!(told >= 0.9 && strangers <= 0.01, "{}", score.table());
}

#[test]
fn nine_of_ten_mistakes_of_another_hand_are_told_and_no_others() {
    let (mut together, mut alone) = (Tally::default(), Tally::default());
    let folder = root().join("tests/seeded");
    let own = |path: &PathBuf| path.parent() == Some(&folder);
    for path in files_below(&folder, "scene").into_iter().filter(own) {
        let right = text(&path);
        let all = mistakes(&text(&path.with_extension("mistakes")));
        together.run(&path, &right, &[]);
        together.run(&path, &right, &all.iter().collect::<Vec<_>>());
        for one in &all {
            alone.run(&path, &right, &[one]);
        }
    }
    let table = format!(
        "| mistakes | told | diagnostics | of these where no mistake is |\n|---|---|---|---|\n\
         | ten at once | {} |\n| one at a time | {} |",
        together.row(),
        alone.row()
    );
    println!("{}\n{}", together.log, alone.log);
    published::hold("language.md", "seeded", &table);
    for score in [together, alone] {
        let (told, planted) = (score.found as f64, score.planted as f64);
        assert!(
            told >= 0.9 * planted && 100 * score.cascades <= score.diagnostics,
            "{}",
            score.log
        );
    }
}

/// The files on disk, one of them with another text.
struct Beside(PathBuf, Arc<[u8]>);

impl Files for Beside {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        if path == self.0 { Ok(self.1.clone()) } else { OnDisk.read(path) }
    }
}

/// A line that a person wrote wrongly.
struct Mistake {
    /// From 1.
    line: usize,
    text: String,
}

/// A mistake on each line that its file names, whatever the rest of the block says.
fn mistakes(text: &str) -> Vec<Mistake> {
    let blocks = text.split("\n\n").filter(|block| !block.trim().is_empty());
    let one = |block: &str| {
        let first = block.trim_start_matches('\n').lines().next()?;
        let (line, text) = first.split_once(':')?;
        let text = text.strip_prefix(' ').unwrap_or(text).replace("\\n", "\n");
        Some(Mistake { line: line.parse().ok()?, text })
    };
    blocks.map(|block| one(block).unwrap_or_else(|| panic!("no mistake: {block}"))).collect()
}

/// A scene of that folder with every mistake that its file names.
pub(crate) fn planted(path: &Path) -> String {
    let right = text(path);
    let mistakes = mistakes(&text(&path.with_extension("mistakes")));
    let mut lines: Vec<&str> = right.split('\n').collect();
    for mistake in &mistakes {
        lines[mistake.line - 1] = &mistake.text;
    }
    lines.join("\n")
}

/// What was told of mistakes.
#[derive(Default)]
struct Tally {
    planted: usize,
    found: usize,
    diagnostics: usize,
    /// Diagnostics at no mistake.
    cascades: usize,
    log: String,
}

impl Tally {
    /// The cells of a table.
    fn row(&self) -> String {
        let share =
            |n: usize, all: usize| format!("{n} of {all}, {:.1} %", 100.0 * n as f64 / all as f64);
        let found = share(self.found, self.planted);
        format!("{found} | {} | {}", self.diagnostics, share(self.cascades, self.diagnostics))
    }

    /// Plants some mistakes in a text at once, and counts what is told of the scene.
    fn run(&mut self, path: &Path, right: &str, mistakes: &[&Mistake]) {
        let mut lines: Vec<&str> = right.split('\n').collect();
        for mistake in mistakes {
            lines[mistake.line - 1] = &mistake.text;
        }
        // A mistake may have brought lines with it.
        let first = |line: usize| 1 + lines[..line - 1].iter().map(|it| n_lines(it)).sum::<usize>();
        let place =
            |mistake: &&Mistake| first(mistake.line)..first(mistake.line) + n_lines(&mistake.text);
        let places: Vec<_> = mistakes.iter().map(place).collect();
        let wrong = lines.join("\n");
        let mut is_found = vec![false; mistakes.len()];
        for (at, told) in told(path, &wrong) {
            self.diagnostics += 1;
            let fits = |i: &usize| at.iter().any(|line| places[*i].contains(line));
            if let Some(i) = (0..places.len()).find(fits) {
                is_found[i] = true;
            } else {
                self.cascades += 1;
                let _ = writeln!(self.log, "  cascade {}:{at:?}: {told}", path.display());
            }
        }
        for (mistake, _) in mistakes.iter().zip(&is_found).filter(|(_, found)| !**found) {
            let Mistake { line, text } = mistake;
            let _ = writeln!(self.log, "  missed {}:{line}: {text}", path.display());
        }
        self.planted += mistakes.len();
        self.found += is_found.iter().filter(|found| **found).count();
    }
}

/// What the language tells of a text: something, if it makes no scene of it.
pub(crate) fn messages(path: &Path, text: &str) -> Vec<String> {
    let files = Beside(path.into(), text.as_bytes().into());
    let loaded = load(path, &files, &registry(), &Settings::default());
    let is_told = loaded.diagnostics.iter().any(Diagnostic::is_error);
    assert!(is_told || loaded.scene.is_some(), "{}: nothing is told of\n{text}", path.display());
    loaded.diagnostics.iter().map(ToString::to_string).collect()
}

/// What `luxel check` tells of a text, with the lines that each diagnostic points to.
fn told(path: &Path, text: &str) -> Vec<(Vec<usize>, String)> {
    let files = Beside(path.into(), text.as_bytes().into());
    let registry = registry();
    let loaded = load(path, &files, &registry, &Settings::default());
    let of_objects = match (&loaded.scene, &loaded.rest) {
        (Some(scene), _) => match stage::build(scene, &registry, &files, None) {
            Ok(built) => built.warnings,
            Err(found) => found,
        },
        (None, Some(rest)) => stage::faults(rest, &registry, &files, None, &Watch::default()),
        (None, None) => vec![],
    };
    let line = |label: &Label| {
        loaded.sources.line_column(label.span.source, label.span.start as usize).line
    };
    let all = loaded.diagnostics.iter().chain(&of_objects);
    all.map(|it| (it.labels.iter().map(line).collect(), it.to_string())).collect()
}

fn n_lines(text: &str) -> usize {
    text.split('\n').count()
}
