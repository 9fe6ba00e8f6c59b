//! Contents that are known without reading them again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{Seen, Stamp, look};

/// Files with the stamps under which they have certain contents for sure. Shared by who watches them,
/// who alone may say so, and who loads them; empty where nobody watches.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known(Arc<Mutex<BTreeMap<PathBuf, (Stamp, Seen)>>>);

impl Known {
    /// What is there now: read only if it may have changed.
    pub(crate) fn look(&self, path: &Path) -> Seen {
        self.seen(path).unwrap_or_else(|| look(path))
    }

    /// What is there now, if it need not be read to be known.
    pub(super) fn seen(&self, path: &Path) -> Option<Seen> {
        let known = self.lock().get(path).cloned();
        known.filter(|(stamp, _)| Stamp::of(path) == *stamp).map(|(_, seen)| seen)
    }

    /// As long as it has this stamp, a file has these contents; without one, nothing is known.
    pub(crate) fn set(&self, path: &Path, stamp: Option<&Stamp>, seen: Seen) {
        let mut known = self.lock();
        match stamp {
            None => {
                known.remove(path);
            }
            Some(stamp) if known.get(path).is_some_and(|it| it.0 == *stamp && it.1 == seen) => {}
            Some(stamp) => {
                known.insert(path.to_path_buf(), (stamp.clone(), seen));
            }
        }
    }

    /// Nothing is known of other files than these.
    pub(crate) fn keep(&self, concerned: impl Fn(&Path) -> bool) {
        self.lock().retain(|path, _| concerned(path));
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<PathBuf, (Stamp, Seen)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    #[test]
    fn what_is_known_is_not_read_while_its_stamp_stays() {
        let folder = Folder::new("known");
        folder.write("a", b"one");
        let (path, known) = (folder.path("a"), Known::default());
        let one = look(&path);
        assert_eq!(known.seen(&path), None);
        assert_eq!(known.look(&path), one);
        // What is told is believed, so that one sees that nothing was read.
        let told = Some(blake3::hash(b"told"));
        known.set(&path, Some(&Stamp::of(&path)), told);
        assert_eq!(known.look(&path), told);
        folder.write("a", b"other");
        assert_eq!(known.look(&path), look(&path));
        known.set(&path, Some(&Stamp::of(&path)), told);
        known.set(&path, None, told);
        assert_eq!(known.look(&path), look(&path));
        known.set(&path, Some(&Stamp::of(&path)), told);
        known.keep(|path| path.ends_with("b"));
        assert_eq!(known.seen(&path), None);
    }
}
