//! A scene whose picture is rendered, or was.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::ScopedJoinHandle;

use luxel_core::diag::Diagnostic;
use luxel_core::render::Control;
use luxel_core::scene::Hash;
use luxel_core::stage::Stage;

use super::round::Read;
use crate::files::{Known, Seen, Watched};
use crate::load::Text;

/// What a picture is of.
#[derive(Clone)]
pub(super) struct Subject {
    pub(super) hash: Hash,
    pub(super) stage: Arc<Stage>,
    pub(super) read: Arc<Read>,
    /// Everything that it was made of, as it was then.
    pub(super) files: Watched,
    /// Those of them that are text, for which the hash speaks.
    pub(super) texts: BTreeSet<PathBuf>,
    /// What was found while it was made ready.
    pub(super) warnings: Vec<Diagnostic>,
}

impl Subject {
    /// Whether a text that was read shows the same scene, of files that have not changed.
    pub(super) fn is_of(&self, text: &Text, known: &Known) -> bool {
        let same = |(path, seen): (&PathBuf, &Seen)| {
            self.texts.contains(path) || known.look(path) == *seen
        };
        text.scene.as_ref().is_some_and(|scene| scene.hash() == self.hash)
            && !self.stage.has_failed()
            && self.files.iter().all(same)
    }

    /// Other texts say the same now.
    pub(super) fn read_again(&mut self, text: &Text) {
        self.files.retain(|path, _| !self.texts.contains(path));
        let asked = text.files.asked();
        self.texts = asked.keys().cloned().collect();
        self.files.extend(asked);
    }
}

/// A render that runs, or has ended.
pub(super) struct Shown<'scope> {
    pub(super) subject: Subject,
    pub(super) control: Arc<Control>,
    pub(super) thread: ScopedJoinHandle<'scope, ()>,
}

impl Shown<'_> {
    /// Waits for the end of the render. What it had to say it has said; a panic was caught and told
    /// inside.
    pub(super) fn ended(self) {
        let _ = self.thread.join();
    }
}
