//! Listening to the system: which folders, and what was heard of which names.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::Wake;
use super::file::name;
use super::hops::Hops;
use crate::files::{Identity, identity};

/// What was heard since the last time, by the files that it may concern.
#[derive(Clone, Debug, Default)]
pub(super) struct Heard {
    files: BTreeSet<PathBuf>,
    /// Files that are written and not yet closed.
    open: BTreeSet<PathBuf>,
    /// Files that were closed or put in their place as a whole.
    done: BTreeSet<PathBuf>,
    /// Everything may have changed.
    all: bool,
    /// A path may lead elsewhere.
    pub(super) moved: bool,
    /// There is no reason to wait for more.
    decided: bool,
}

impl Heard {
    /// Whether something happened that may have changed this file.
    pub(super) fn concerns(&self, file: &Path) -> bool {
        self.all || self.files.contains(file) || file.is_dir()
    }

    /// Whether somebody is writing it.
    pub(super) fn is_open(&self, file: &Path) -> bool {
        self.open.contains(file)
    }

    /// Whether somebody may still be writing it.
    pub(super) fn may_go_on(&self, file: &Path) -> bool {
        let done = self.all || self.done.contains(file);
        self.is_open(file) || !done
    }

    /// What was whole before is so still, unless something has happened to it since.
    pub(super) fn after(mut self, before: &Self) -> Self {
        let whole = before.done.difference(&self.files).cloned().collect::<Vec<_>>();
        self.done.extend(whole);
        self
    }

    fn note(&mut self, kind: EventKind, files: Option<&BTreeSet<PathBuf>>, is_way: bool) {
        let files = || files.into_iter().flatten().cloned();
        self.files.extend(files());
        let is_done = match kind {
            EventKind::Modify(ModifyKind::Data(_) | ModifyKind::Any) => {
                self.open.extend(files());
                false
            }
            // Its bytes come next, or it is a link and done; who watches looks a little later.
            EventKind::Create(_) => {
                self.moved = true;
                false
            }
            // What was here before has gone; what comes in its place begins anew.
            EventKind::Modify(ModifyKind::Name(RenameMode::From | RenameMode::Both)) => {
                (self.moved, self.decided) = (true, true);
                false
            }
            EventKind::Modify(ModifyKind::Name(_)) => {
                self.moved = true;
                true
            }
            EventKind::Access(_) => true,
            _ => {
                self.decided = true;
                false
            }
        };
        if is_done {
            files().for_each(|file| _ = self.open.remove(&file));
            self.done.extend(files());
        }
        // A link or a folder was replaced, and whatever it leads to is another and whole.
        self.all |= is_way;
        self.moved |= is_way;
        self.decided |= is_way || is_done;
    }
}

#[derive(Default)]
struct Shared {
    heard: Heard,
    /// Whether whoever waits has been woken.
    woken: bool,
    hops: Hops,
}

impl Shared {
    /// Whether an event is a reason to look.
    fn hear(&mut self, event: notify::Result<Event>) -> bool {
        let Some(event) = event.ok().filter(|event| !event.need_rescan()) else {
            (self.heard.all, self.heard.moved, self.heard.decided) = (true, true, true);
            return true;
        };
        match event.kind {
            EventKind::Access(AccessKind::Close(AccessMode::Write)) => {}
            // Reading a file makes events too.
            EventKind::Access(_) => return false,
            _ => {}
        }
        let mut matters = false;
        for (i, path) in event.paths.iter().enumerate() {
            let name = name(path);
            let is_way = self.hops.ways.contains(&name);
            let files = self.hops.files.get(&name);
            // Elsewhere events name less, or in other letters.
            let known = cfg!(target_os = "linux") && !is_library_name(path);
            if is_way || files.is_some() || !known {
                self.heard.note(of_path(event.kind, i), files, is_way);
                matters = true;
            }
        }
        matters
    }
}

/// What has happened to the path of that number: of two names in one event the first has gone, and the
/// second is there.
fn of_path(kind: EventKind, i: usize) -> EventKind {
    match kind {
        EventKind::Modify(ModifyKind::Name(RenameMode::Both)) if i > 0 => {
            EventKind::Modify(ModifyKind::Name(RenameMode::To))
        }
        kind => kind,
    }
}

/// Folders of libraries are watched for names that are not known.
fn is_library_name(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::env::consts::DLL_SUFFIX)
}

/// The folders that are listened in.
pub(super) struct Ears {
    watcher: Option<RecommendedWatcher>,
    folders: BTreeMap<PathBuf, Identity>,
    shared: Arc<Mutex<Shared>>,
    /// Whether the system refused to tell of a folder.
    refused: bool,
}

impl Ears {
    /// Wakes through `wake`, at most twice until what was heard is taken.
    pub(super) fn new(wake: Sender<Wake>) -> Self {
        let mut ears = Self::deaf();
        ears.watcher = notify::recommended_watcher(ears.hearing(wake)).ok();
        ears
    }

    /// What is done with an event.
    pub(super) fn hearing(&self, wake: Sender<Wake>) -> impl Fn(notify::Result<Event>) + use<> {
        let shared = self.shared.clone();
        move |event| {
            let mut shared = lock(&shared);
            let waits = shared.woken && !shared.heard.decided;
            // Once, and once more when there is nothing left to wait for.
            if shared.hear(event) && (!shared.woken || waits && shared.heard.decided) {
                shared.woken = true;
                let _ = wake.send(Wake::Look);
            }
        }
    }

    /// Hears nothing.
    pub(super) fn deaf() -> Self {
        let (folders, shared) = Default::default();
        Self { watcher: None, folders, shared, refused: false }
    }

    /// Whether there are folders of which nothing is heard.
    pub(super) fn is_deaf(&self) -> bool {
        self.refused || self.watcher.is_none()
    }

    pub(super) fn folders(&self) -> impl Iterator<Item = &Path> {
        self.folders.keys().map(PathBuf::as_path)
    }

    /// Listens in these folders too; one that was replaced is listened in anew.
    pub(super) fn listen(&mut self, hops: &Hops) {
        {
            let mut shared = lock(&self.shared);
            shared.hops.ways.clone_from(&hops.ways);
            shared.hops.files.clone_from(&hops.files);
        }
        self.refused = false;
        for folder in &hops.folders {
            let Ok(about) = fs::metadata(folder) else { continue };
            let identity = identity(&about);
            if self.folders.get(folder) == Some(&identity) {
                continue;
            }
            if let Some(watcher) = &mut self.watcher {
                // The old folder may be gone, and its watch with it.
                let _ = watcher.unwatch(folder);
                if watcher.watch(folder, RecursiveMode::NonRecursive).is_err() {
                    self.refused = true;
                    self.folders.remove(folder);
                    continue;
                }
            }
            self.folders.insert(folder.clone(), identity);
        }
    }

    /// Stops listening in all other folders.
    pub(super) fn forget_all_but(&mut self, hops: &Hops) {
        let watcher = &mut self.watcher;
        self.folders.retain(|folder, _| {
            let wanted = hops.folders.contains(folder);
            if let Some(watcher) = watcher.as_mut().filter(|_| !wanted) {
                let _ = watcher.unwatch(folder);
            }
            wanted
        });
    }

    /// Whether there is no reason to wait for more before looking.
    pub(super) fn is_decided(&self) -> bool {
        lock(&self.shared).heard.decided
    }

    /// What was heard since the last time.
    pub(super) fn take(&self) -> Heard {
        let mut shared = lock(&self.shared);
        shared.woken = false;
        let open = shared.heard.open.clone();
        std::mem::replace(&mut shared.heard, Heard { open, ..Heard::default() })
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use notify::event::{CreateKind, DataChange};

    use super::*;

    #[test]
    fn what_was_closed_stays_whole_until_it_is_written_again() {
        let file = Path::new("a.scene");
        let files = BTreeSet::from([file.to_path_buf()]);
        let heard = |kind: EventKind| {
            let mut heard = Heard::default();
            heard.note(kind, Some(&files), false);
            heard
        };
        let closed = heard(EventKind::Access(AccessKind::Close(AccessMode::Write)));
        assert!(!closed.may_go_on(file));
        let later = Heard::default().after(&closed);
        assert!(!later.may_go_on(file));
        let written = heard(EventKind::Modify(ModifyKind::Data(DataChange::Any)));
        assert!(written.after(&later).may_go_on(file));
        // Renamed away, as vim does: the half that is then written is not taken for the whole.
        let named = |mode| heard(EventKind::Modify(ModifyKind::Name(mode)));
        for gone in [named(RenameMode::From), named(RenameMode::Both)] {
            assert!(gone.decided && gone.may_go_on(file));
            let created = heard(EventKind::Create(CreateKind::File)).after(&closed);
            assert!(created.after(&gone).may_go_on(file));
        }
        assert!(!named(RenameMode::To).may_go_on(file));
    }

    #[test]
    fn what_takes_a_files_place_is_whole_however_often_that_is_told() {
        let files = BTreeSet::from([PathBuf::from("a.scene")]);
        let mut shared = Shared::default();
        shared.hops.files = BTreeMap::from([("a.scene".into(), files)]);
        // The system tells it as three events, between which somebody may look.
        let mut heard = Heard::default();
        for (mode, paths) in [
            (RenameMode::From, &["new"][..]),
            (RenameMode::To, &["a.scene"]),
            (RenameMode::Both, &["new", "a.scene"]),
        ] {
            let mut event = Event::new(EventKind::Modify(ModifyKind::Name(mode)));
            event.paths = paths.iter().map(PathBuf::from).collect();
            shared.hear(Ok(event));
            heard = std::mem::take(&mut shared.heard).after(&heard);
        }
        assert!(!heard.may_go_on(Path::new("a.scene")));
        // And away again.
        let mut event = Event::new(EventKind::Modify(ModifyKind::Name(RenameMode::Both)));
        event.paths = ["a.scene", "old"].map(PathBuf::from).to_vec();
        shared.hear(Ok(event));
        assert!(shared.heard.after(&heard).may_go_on(Path::new("a.scene")));
    }
}
