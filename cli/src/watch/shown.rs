//! A scene whose picture is rendered, or was.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::ScopedJoinHandle;

use luxel_core::diag::Diagnostic;
use luxel_core::render::{Control, Options, can_take_more};
use luxel_core::scene::{Hashes, Scene};
use luxel_core::stage::Stage;

use super::round::{Read, Sitting};
use crate::files::{Known, Seen, Watched};
use crate::load::Text;

/// What a picture is of.
#[derive(Clone)]
pub(super) struct Subject {
    /// As the text says, assets not expanded.
    pub(super) scene: Arc<Scene>,
    pub(super) hashes: Hashes,
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
    /// Whether a scene that was read is the same, of files that have not changed.
    pub(super) fn is_of(&self, hashes: &Hashes, known: &Known) -> bool {
        let same = |(path, seen): (&PathBuf, &Seen)| {
            self.texts.contains(path) || known.look(path) == *seen
        };
        hashes.shown == self.hashes.shown && !self.stage.has_failed() && self.files.iter().all(same)
    }

    /// Whether what is measured for another subject is right for this one too: it is only shown in
    /// another way, or written to another place.
    pub(super) fn is_measured_by(&self, other: &Self) -> bool {
        self.hashes.measured == other.hashes.measured
            && !other.stage.has_failed()
            && self.other_files() == other.other_files()
    }

    /// Whether what is measured for another subject is the beginning of what this one needs: more
    /// samples of the same.
    pub(super) fn goes_on_from(&self, other: &Self, options: &Options) -> bool {
        self.hashes.sampled == other.hashes.sampled
            && options.samples(&self.stage) > options.samples(&other.stage)
            && !other.stage.has_failed()
            && can_take_more(&self.stage)
            && self.other_files() == other.other_files()
    }

    /// Files that are no text.
    fn other_files(&self) -> Watched {
        let mut files = self.files.clone();
        files.retain(|path, _| !self.texts.contains(path));
        files
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
    pub(super) sitting: Arc<Sitting>,
    pub(super) control: Arc<Control>,
    pub(super) thread: ScopedJoinHandle<'scope, ()>,
}

impl Shown<'_> {
    /// Whether nothing more comes of it, on the disk either.
    pub(super) fn is_done(&self) -> bool {
        self.thread.is_finished() && !self.sitting.is_in_press()
    }

    /// Has a render that is seen stand still while a save is looked at, so that who looks on sees soon what
    /// comes of it.
    pub(super) fn hold(&self, is_seen: bool) {
        if is_seen {
            self.control.hold();
        }
    }

    /// Waits for the end of the render, and gives its picture. What it had to say it has said; a panic
    /// was caught and told inside.
    pub(super) fn ended(self) -> Arc<Sitting> {
        let _ = self.thread.join();
        self.sitting
    }
}
