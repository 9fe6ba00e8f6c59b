//! How many planted mistakes are told in one run.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_lang::{Settings, load};

use crate::plant::{Dice, Score};
use crate::registry::registry;

/// Scenes with their files; each is planted in so often.
const ROUNDS: usize = 100;

#[test]
fn nine_of_ten_planted_mistakes_are_told_in_one_run_and_no_others() {
    let registry = registry();
    let files = || {
        MemoryFiles::default()
            .with("cornell/white.spd", &b"400 0.3\n700 0.7\n"[..])
            .with("lib/metals.scene", &include_bytes!("../scenes/lib/metals.scene")[..])
            .with("lib/studio.scene", &include_bytes!("../scenes/lib/studio.scene")[..])
    };
    let (mut score, mut dice) = (Score::default(), Dice(1));
    for text in [
        include_str!("../scenes/cornell.scene"),
        include_str!("../scenes/parametric.scene"),
        include_str!("../scenes/glass_fog.scene"),
    ] {
        let lines = |text: &str| {
            let files = files().with("a.scene", text.as_bytes());
            let loaded = load(Path::new("a.scene"), &files, &registry, &Settings::default());
            let line = |d: &luxel_core::diag::Diagnostic| {
                d.span().map_or(0, |s| loaded.sources.line_column(s.source, s.start as usize).line)
            };
            loaded.diagnostics.iter().map(|d| (line(d), d.code)).collect::<Vec<_>>()
        };
        assert_eq!(lines(text), []);
        for _ in 0..ROUNDS {
            score.run(text, 5, &mut dice, lines);
        }
    }
    let (told, strangers) = score.shares();
    assert!(told >= 0.9 && strangers <= 0.01, "{}", score.table());
}
