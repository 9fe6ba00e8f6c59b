//! One file: whether it is as it was seen.

use std::ffi::OsString;
use std::path::Path;
use std::time::{Duration, Instant};

use luxel_core::files::Marks;

use super::Seen;
use super::hear::Heard;
use crate::files::{Stamp, has_changed, look_and_mark};

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

/// Bytes that take so long to read that it is waited first for whoever writes them.
const LARGE: u64 = 1 << 20;

/// So often a file that changes while it is read is read again at once.
const READS: u32 = 3;

/// What was found in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// All of it was looked at.
    Seen(Seen),
    /// It has not the contents in question; what it has is not known.
    Other,
}

/// One file and what is known of it.
pub(super) struct File {
    /// The contents in question.
    pub(super) seen: Seen,
    /// A stamp under which they had these contents.
    known: Option<Known>,
    /// How long they were when that was last known.
    len: Option<u64>,
    /// What told them from others, then.
    marks: Marks,
    /// A stamp under which there were others a moment ago.
    other: Option<Stamp>,
}

struct Known {
    stamp: Stamp,
    since: Instant,
    /// Whether they were read when the stamp was old.
    sure: bool,
}

impl File {
    pub(super) fn new(seen: Seen) -> Self {
        Self { seen, known: None, len: None, marks: Marks::default(), other: None }
    }

    /// The stamp that alone tells that the contents are the same, if there is one.
    pub(super) fn sure(&self) -> Option<&Stamp> {
        self.known.as_ref().filter(|known| known.sure).map(|known| &known.stamp)
    }

    /// What comes now is another save.
    pub(super) fn begin(&mut self) {
        self.other = None;
    }

    /// How the file stands, and what was found there if it has been looked at.
    pub(super) fn check(
        &mut self,
        path: &Path,
        heard: &Heard,
        is_patient: bool,
    ) -> (Standing, Option<Found>) {
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
        // One save makes several events. What comes of the rest of it is loaded whatever it is.
        if self.other.as_ref() == Some(&now) {
            return (Standing::Whole, None);
        }
        if is_patient && heard.is_open(path) && now.len() >= Some(LARGE) {
            self.known = None;
            return (Standing::Half, None);
        }
        // All of it is read, which takes a while, where somebody may still be writing it.
        let may_go_on = heard.may_go_on(path);
        let marks = Some(&self.marks).filter(|_| !may_go_on);
        let Some((stamp, found)) = steady(path, marks) else {
            self.known = None;
            return (Standing::Half, None);
        };
        match found {
            Some((seen, marks)) if seen == self.seen => {
                let kept = self.known.take().filter(|known| known.stamp == stamp);
                (self.len, self.marks) = (stamp.len(), marks);
                let new = || Known { stamp, since: Instant::now(), sure: false };
                self.known = kept.or_else(|| Some(new()));
                (Standing::Same, Some(Found::Seen(seen)))
            }
            found => {
                self.known = None;
                let is_cut = stamp.len() < Some(self.len.unwrap_or(u64::MAX)) && may_go_on;
                let is_half = stamp.len().unwrap_or(0) == 0 || is_cut;
                let standing = if is_half { Standing::Half } else { Standing::Whole };
                self.other = Some(stamp).filter(|_| !is_half);
                let found = found.map_or(Found::Other, |(seen, _)| Found::Seen(seen));
                (standing, Some(found))
            }
        }
    }
}

/// What is there, unless it changes again and again while it is read; nothing, where it surely is not what
/// has these marks.
fn steady(path: &Path, marks: Option<&Marks>) -> Option<(Stamp, Option<(Seen, Marks)>)> {
    let mut before = Stamp::of(path);
    for _ in 0..READS {
        let is_other = marks.is_some_and(|marks| has_changed(path, marks));
        let found = (!is_other).then(|| look_and_mark(path));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::look;
    use crate::testing::Folder;

    #[test]
    fn what_was_another_under_a_stamp_is_so_for_one_save_alone() {
        let folder = Folder::new("watch-other");
        folder.write("a", b"one");
        let path = folder.path("a");
        let mut file = File::new(look(&path));
        // Written back within the same tick of a coarse clock.
        file.other = Some(Stamp::of(&path));
        let standing = |file: &mut File| file.check(&path, &Heard::default(), true).0;
        assert_eq!(standing(&mut file), Standing::Whole);
        file.begin();
        assert_eq!(standing(&mut file), Standing::Same);
    }
}
