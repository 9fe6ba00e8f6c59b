//! Noticing saves: events wake, contents decide.
//!
//! Editors save in many ways (in place, by renaming, by deleting first), and no event tells the
//! truth about all of them. So the folders of the files are watched, any event is a reason to look,
//! and a save is what changed the hash of a file's bytes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use notify::event::{AccessKind, AccessMode};
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use crate::exit::{Exit, Failure};
use crate::files::{Seen, Watched, look};

/// What ends a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wake {
    /// Something happened in a watched folder.
    Look,
    /// Ctrl-C.
    Stop,
}

/// What came of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Noticed {
    /// Contents differ from what was seen.
    Save,
    /// The end is asked for.
    Stop,
    /// The time is up.
    Nothing,
}

/// A save is often several events: this long without one means that it is done. What an editor writes
/// in pieces further apart is looked at again.
const QUIET: Duration = Duration::from_millis(8);
/// An editor that deletes or empties a file before it writes it takes at most this long.
const PATIENCE: Duration = Duration::from_millis(120);
/// Events may be lost or never come (network mounts): look this often anyway.
const ANYWAY: Duration = Duration::from_millis(500);

/// Files with what was last seen in them.
pub(super) struct Changes {
    watcher: RecommendedWatcher,
    folders: BTreeSet<PathBuf>,
    seen: Watched,
    stamps: BTreeMap<PathBuf, Stamp>,
    wakes: Receiver<Wake>,
    /// When stamps were compared last.
    compared: Instant,
}

/// What the folder says about a file: cheap to ask, but may stay the same though the bytes change.
type Stamp = Option<(u64, std::time::SystemTime)>;

impl Changes {
    /// Nothing watched yet; the sender can end a wait.
    ///
    /// # Errors
    /// If the system gives no watcher.
    pub(super) fn new() -> Result<(Self, Sender<Wake>), Failure> {
        let (sender, wakes) = mpsc::channel();
        let look = sender.clone();
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            if event.map_or(true, |event| matters(event.kind)) {
                let _ = look.send(Wake::Look);
            }
        })
        .map_err(refused)?;
        let (folders, seen, stamps) = Default::default();
        let compared = Instant::now();
        Ok((Self { watcher, folders, seen, stamps, wakes, compared }, sender))
    }

    /// Watches the folders of these files, those that links lead to included, and folders among
    /// them.
    ///
    /// # Errors
    /// If the system refuses.
    pub(super) fn arm<'a>(
        &mut self,
        files: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), Failure> {
        let mut wanted = BTreeSet::new();
        for file in files {
            wanted.extend(file.is_dir().then(|| file.to_path_buf()));
            wanted.extend(nearest_folder(file));
            wanted.extend(fs::canonicalize(file).ok().and_then(|place| nearest_folder(&place)));
        }
        for folder in wanted.difference(&self.folders.clone()) {
            self.watcher.watch(folder, RecursiveMode::NonRecursive).map_err(refused)?;
            self.folders.insert(folder.clone());
        }
        Ok(())
    }

    /// Sets what the last load saw.
    ///
    /// # Errors
    /// If a folder cannot be watched.
    pub(super) fn expect(&mut self, seen: Watched) -> Result<(), Failure> {
        self.arm(seen.keys().map(PathBuf::as_path))?;
        // Stamps that are not known count as changed, so that the contents are looked at once.
        self.stamps.clear();
        self.seen = seen;
        Ok(())
    }

    /// Waits for a change of what is there now, these files included: the last load told nothing.
    ///
    /// # Errors
    /// If a folder cannot be watched.
    pub(super) fn expect_news<'a>(
        &mut self,
        files: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), Failure> {
        let mut seen = std::mem::take(&mut self.seen);
        seen.extend(files.into_iter().map(|file| (file.to_path_buf(), None)));
        for (path, seen) in &mut seen {
            *seen = look(path);
        }
        self.expect(seen)
    }

    /// Waits until a file's contents differ from what was seen (true) or the end is asked for
    /// (false).
    pub(super) fn wait(&mut self) -> bool {
        loop {
            match self.within(ANYWAY) {
                Noticed::Save => return true,
                Noticed::Stop => return false,
                Noticed::Nothing => {}
            }
        }
    }

    /// Waits for one event, or for so long without one.
    pub(super) fn within(&mut self, time: Duration) -> Noticed {
        let differs = match self.wakes.recv_timeout(time) {
            Ok(Wake::Look) => match self.settle() {
                Wake::Look => self.differs(),
                Wake::Stop => return Noticed::Stop,
            },
            Err(RecvTimeoutError::Timeout) => self.stamps_changed() && self.differs(),
            Ok(Wake::Stop) | Err(RecvTimeoutError::Disconnected) => return Noticed::Stop,
        };
        if differs && self.is_whole() { Noticed::Save } else { Noticed::Nothing }
    }

    /// Lets a burst of events pass.
    fn settle(&self) -> Wake {
        let since = Instant::now();
        while since.elapsed() < PATIENCE {
            match self.wakes.recv_timeout(QUIET) {
                Ok(Wake::Look) => {}
                Ok(Wake::Stop) => return Wake::Stop,
                Err(_) => break,
            }
        }
        Wake::Look
    }

    fn differs(&self) -> bool {
        self.seen.iter().any(|(path, seen)| look(path) != *seen)
    }

    /// Whether a stamp has changed since the last look, a while ago.
    fn stamps_changed(&mut self) -> bool {
        if self.compared.elapsed() < ANYWAY {
            return false;
        }
        self.compared = Instant::now();
        let now: BTreeMap<_, _> =
            self.seen.keys().map(|path| (path.clone(), stamp(path))).collect();
        let changed = now != self.stamps;
        self.stamps = now;
        changed
    }

    /// Gives an editor that writes in two steps time for the second; false when the old contents
    /// are back.
    fn is_whole(&self) -> bool {
        let since = Instant::now();
        let half = |(path, seen): (&PathBuf, &Seen)| {
            seen.is_some() && fs::metadata(path).map_or(true, |about| about.len() == 0)
        };
        while self.seen.iter().any(half) && since.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(5));
        }
        self.differs()
    }
}

/// Reading a file makes events too: only what may have changed a file counts.
fn matters(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(kind) => kind == AccessKind::Close(AccessMode::Write),
        _ => true,
    }
}

fn stamp(path: &Path) -> Stamp {
    let about = fs::metadata(path).ok()?;
    Some((about.len(), about.modified().ok()?))
}

/// The folder of a file, or where that is missing the nearest one above that is there.
fn nearest_folder(file: &Path) -> Option<PathBuf> {
    let above = file.ancestors().skip(1);
    above
        .map(|folder| if folder == Path::new("") { Path::new(".") } else { folder })
        .find(|folder| folder.is_dir())
        .map(Path::to_path_buf)
}

#[expect(clippy::needless_pass_by_value, reason = "the shape that `map_err` wants")]
fn refused(error: notify::Error) -> Failure {
    Failure::new(Exit::Input, format!("cannot watch the scene's files: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    /// Far above the longest wait of `Changes`, on a busy machine.
    const LONG: Duration = Duration::from_secs(10);

    /// What a wait ends with after `act`; a guard ends it when nothing is noticed.
    fn noticed(folder: &Folder, act: impl FnOnce(&Folder) + Send, within: Duration) -> bool {
        let (mut changes, sender) = Changes::new().unwrap();
        let path = folder.path("a.scene");
        changes.expect(BTreeMap::from([(path.clone(), look(&path))])).unwrap();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(move || changes.wait());
            act(folder);
            let since = Instant::now();
            while !waiting.is_finished() && since.elapsed() < within {
                std::thread::sleep(Duration::from_millis(5));
            }
            let _ = sender.send(Wake::Stop);
            waiting.join().unwrap()
        })
    }

    #[test]
    fn saves_in_place_and_by_renaming_are_noticed() {
        let folder = Folder::new("watch-saves");
        folder.write("a.scene", b"one");
        assert!(noticed(&folder, |folder| folder.write("a.scene", b"two"), LONG));
        let rename = |folder: &Folder| {
            folder.write("a.tmp", b"three");
            fs::rename(folder.path("a.tmp"), folder.path("a.scene")).unwrap();
        };
        assert!(noticed(&folder, rename, LONG));
    }

    #[test]
    fn a_file_that_appears_is_noticed() {
        let folder = Folder::new("watch-new");
        assert!(noticed(&folder, |folder| folder.write("a.scene", b"one"), LONG));
    }

    #[test]
    fn saves_that_change_no_byte_and_other_files_are_not_noticed() {
        let folder = Folder::new("watch-same");
        folder.write("a.scene", b"one");
        let act = |folder: &Folder| {
            folder.write("a.scene", b"one");
            folder.write("a.png", b"picture");
        };
        assert!(!noticed(&folder, act, QUIET * 4 + ANYWAY));
    }
}
