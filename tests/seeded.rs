//! How many mistakes that are planted in the scenes that ship are told in one run.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::{FileError, Files};
use luxel_lang::{Settings, load};

use crate::disk::{OnDisk, files_below, root, text};
use crate::load::registry;
use crate::plant::{Dice, Score};

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

/// The files on disk, one of them with another text.
struct Beside(PathBuf, Arc<[u8]>);

impl Files for Beside {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        if path == self.0 { Ok(self.1.clone()) } else { OnDisk.read(path) }
    }
}
