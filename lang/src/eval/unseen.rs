//! Whether a scene with mistakes may have the camera that was not found in it.
//!
//! All mistakes are told at once, and none for another's sake: that there is no camera is told beside
//! other mistakes only where none of them can have hidden one.

use std::collections::HashSet;
use std::ops::RangeInclusive;

use luxel_core::diag::near;
use memchr::memmem;

use super::Evaluator;

/// Words that something stands by that may be the camera of the scene, or bring it.
const WORDS: [&str; 2] = ["camera", "asset"];

/// Bytes of a word that may be a misspelt one of these: it has 4 to 9 letters, as a third of those of the
/// longer one may differ (`near`), and 3 that differ may have 4 bytes each.
const SLIPS: RangeInclusive<usize> = 4..=18;

/// Begins of the codes of mistakes that say that nothing stands there yet, that it is written in another
/// language or version, or that a budget is spent before the end.
const OPEN: [&str; 5] = ["E0001", "E0002", "E0011", "E0021", "E05"];

/// What was not read or not evaluated, for a mistake.
#[derive(Debug, Default)]
pub(super) struct Unseen {
    /// A file that could not be read, or an object of an unknown kind.
    pub(super) thing: bool,
    /// A loop, choice or call of which nothing is known.
    pub(super) block: bool,
}

impl Evaluator<'_> {
    /// Whether a camera may stand in what was not read, not evaluated or not understood.
    pub(super) fn may_have_camera(&self) -> bool {
        let says = |word: &str| self.sources.texts().any(|text| has(text, word));
        self.has_asset
            || self.stopped
            || self.unseen.thing
            || WORDS.iter().any(|word| says(word))
            || (self.unseen.block && says("include"))
            || self.is_unclear()
    }

    /// Whether a part that could not be read may speak of a camera in misspelt words.
    fn is_unclear(&self) -> bool {
        if OPEN.iter().any(|code| self.sink.tells(code)) {
            return true;
        }
        let mut seen = HashSet::new();
        let is_other = |c: char| !c.is_alphanumeric() && c != '_';
        let words = self.sources.texts().flat_map(|text| text.split(is_other));
        let mut words = words.filter(|word| SLIPS.contains(&word.len()));
        self.sink.tells("E00") && words.any(|word| seen.insert(word) && is_slip(word))
    }
}

fn has(text: &str, word: &str) -> bool {
    memmem::find(text.as_bytes(), word.as_bytes()).is_some()
}

/// Whether a word was perhaps to be one that brings a camera.
pub(super) fn is_slip(word: &str) -> bool {
    let known = WORDS.into_iter().chain(["assert"]);
    near(&word.to_lowercase(), known).is_some_and(|near| near.name != "assert")
}
