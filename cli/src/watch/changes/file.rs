//! One file: whether it is as it was seen.

use std::ffi::OsString;
use std::path::Path;
use std::time::{Duration, Instant};

use super::hear::Heard;
use super::{Seen, look};
use crate::files::Stamp;

/// How files stand, the later the more there is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Standing {
    /// They are as they were seen.
    Same,
    /// One has other contents.
    Whole,
    /// One is missing, empty, cut off or still being written, and was not.
    Half,
}

/// The coarsest clock that stamps files, that of FAT: a stamp that is older than this stays only as
/// long as the bytes do.
const COARSEST: Duration = Duration::from_millis(2500);

/// So often a file that changes while it is read is read again at once.
const READS: u32 = 3;

/// One file and what is known of it.
pub(super) struct File {
    /// The contents in question.
    pub(super) seen: Seen,
    /// A stamp under which they had these contents.
    known: Option<Known>,
    /// How long they were when that was last known.
    len: Option<u64>,
}

struct Known {
    stamp: Stamp,
    since: Instant,
    /// Whether they were read when the stamp was old.
    sure: bool,
}

impl File {
    pub(super) fn new(seen: Seen) -> Self {
        Self { seen, known: None, len: None }
    }

    /// The stamp that alone tells that the contents are the same, if there is one.
    pub(super) fn sure(&self) -> Option<&Stamp> {
        self.known.as_ref().filter(|known| known.sure).map(|known| &known.stamp)
    }

    /// How the file stands, and what was found if it was read.
    pub(super) fn check(&mut self, path: &Path, heard: &Heard) -> (Standing, Option<Seen>) {
        let now = Stamp::of(path);
        if let Some(known) = &mut self.known
            && known.stamp == now
            && !heard.concerns(path)
        {
            if known.sure || known.since.elapsed() < COARSEST {
                return (Standing::Same, None);
            }
            known.sure = true;
        }
        let Some((stamp, found)) = steady(path) else {
            self.known = None;
            return (Standing::Half, None);
        };
        if found == self.seen {
            let kept = self.known.take().filter(|known| known.stamp == stamp);
            self.len = stamp.len();
            self.known = kept.or_else(|| Some(Known { stamp, since: Instant::now(), sure: false }));
            return (Standing::Same, Some(found));
        }
        self.known = None;
        let is_cut = stamp.len() < Some(self.len.unwrap_or(u64::MAX)) && heard.may_go_on(path);
        let half = stamp.len().unwrap_or(0) == 0 || is_cut;
        (if half { Standing::Half } else { Standing::Whole }, Some(found))
    }
}

/// What is there, unless it changes again and again while it is read.
fn steady(path: &Path) -> Option<(Stamp, Seen)> {
    let mut before = Stamp::of(path);
    for _ in 0..READS {
        let found = look(path);
        let after = Stamp::of(path);
        if before == after {
            return Some((after, found));
        }
        before = after;
    }
    None
}

/// The last part of a path.
pub(super) fn name(path: &Path) -> OsString {
    path.file_name().unwrap_or_default().to_owned()
}
