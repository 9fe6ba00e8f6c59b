//! Noticing saves: events wake, contents decide.
//!
//! Editors save in many ways (in place, by renaming, by deleting first), and no event tells the
//! truth about all of them. So the folders of the files are watched, any event is a reason to look,
//! and a save is what changed the hash of a file's bytes. Events may be lost or never come: stamps
//! are compared now and then anyway.

mod file;
mod hear;
mod hops;
mod mounts;
#[cfg(test)]
mod saves;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use crate::files::{Known, Seen, Watched, look};

use file::{File, Found, Standing};
use hear::{Ears, Heard};
use hops::Hops;

/// What ends a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wake {
    /// Something happened in a watched folder, or something else is wished for.
    Look,
    /// Ctrl-C.
    Stop,
}

/// What came of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Noticed {
    /// Contents differ from what was seen, or something else is wished for.
    Save,
    /// The end is asked for.
    Stop,
    /// The time is up.
    Nothing,
}

/// Who writes in place closes the file after so long at most; who does not is looked at meanwhile.
const CLOSE: Duration = Duration::from_millis(8);
/// Of several files all are still for so long before they are read.
const QUIET: Duration = Duration::from_millis(2);
/// An editor that deletes, empties or cuts a file before it writes it takes at most this long.
const PATIENCE: Duration = Duration::from_millis(120);
/// Between two looks at a file that is half written.
const STEP: Duration = Duration::from_millis(5);
/// Events may be lost: look this often anyway.
const ANYWAY: Duration = Duration::from_millis(500);
/// The same where events do not tell what other machines write.
const FAR: Duration = Duration::from_millis(200);

/// Files with what was last seen in them.
pub(super) struct Changes {
    ears: Ears,
    files: BTreeMap<PathBuf, File>,
    /// Those that were watched before these, with stamps that can be relied upon unwatched.
    past: BTreeMap<PathBuf, File>,
    /// What was there at the last look, for loads that tell nothing.
    found: Watched,
    /// What is in files for sure, for whoever loads them.
    known: Known,
    wakes: Receiver<Wake>,
    /// How often stamps are compared, here and where events do not tell all.
    anyway: Duration,
    here: Duration,
    /// When stamps were compared last.
    compared: Instant,
    /// Whether files have to be looked at without being asked to.
    fresh: bool,
    /// Whether something else is wished for than what was loaded.
    wished: Arc<AtomicBool>,
    /// The end was asked for while something else was waited for.
    stopped: bool,
    /// When contents were last found to differ.
    noticed: Option<Instant>,
}

impl Changes {
    /// Nothing watched yet; the sender can end a wait.
    ///
    /// A system that gives no events, of everything or of a folder, is looked at more often instead.
    pub(super) fn new() -> (Self, Sender<Wake>) {
        Self::hearing(Ears::new)
    }

    fn hearing(ears: impl FnOnce(Sender<Wake>) -> Ears) -> (Self, Sender<Wake>) {
        let (sender, wakes) = mpsc::channel();
        let (files, past, found, known) = Default::default();
        let changes = Self {
            ears: ears(sender.clone()),
            files,
            past,
            found,
            known,
            wakes,
            anyway: ANYWAY,
            here: ANYWAY,
            compared: Instant::now(),
            fresh: false,
            wished: Arc::default(),
            stopped: false,
            noticed: None,
        };
        (changes, sender)
    }

    /// What is in files for sure, now and later.
    pub(super) fn known(&self) -> &Known {
        &self.known
    }

    /// Set, waits end as after a save, at once if `Wake::Look` is sent then. Whoever loads clears it.
    pub(super) fn wished(&self) -> Arc<AtomicBool> {
        self.wished.clone()
    }

    /// Watches what leads to these files too, before they are read.
    pub(super) fn arm<'a>(&mut self, files: impl IntoIterator<Item = &'a Path>) {
        let new: Vec<_> = files.into_iter().map(Path::to_path_buf).collect();
        let all = self.files.keys().chain(&new).map(PathBuf::as_path);
        self.ears.listen(&Hops::of(all));
        for file in new {
            self.found.entry(file).or_insert_with_key(|file| look(file));
        }
    }

    /// Sets what the last load saw; whatever differs from it by now is a save.
    pub(super) fn expect(&mut self, seen: Watched) {
        let mut before = std::mem::take(&mut self.files);
        let mut past = std::mem::take(&mut self.past);
        for (path, seen) in seen {
            // What had the same contents and has been watched since need not be read again.
            let known = before.remove(&path).or_else(|| past.remove(&path));
            let same = known.filter(|file| file.seen == seen);
            self.files.insert(path, same.unwrap_or_else(|| File::new(seen)));
        }
        before.retain(|_, file| file.sure().is_some());
        self.past = before;
        self.found.retain(|path, _| self.files.contains_key(path));
        self.known.keep(|path| self.files.contains_key(path) || self.past.contains_key(path));
        self.listen();
        self.anyway = if self.is_far() { FAR } else { self.here };
        self.fresh = true;
    }

    /// Waits for a change of what was there before the last load, of these files, and of those that
    /// the load told of before it came to no good end.
    pub(super) fn expect_more_than<'a>(
        &mut self,
        told: Watched,
        files: impl IntoIterator<Item = &'a Path>,
    ) {
        let mut seen = told;
        let also: Vec<_> = files.into_iter().map(Path::to_path_buf).collect();
        for path in self.files.keys().chain(&also) {
            let found = || self.found.get(path).copied().unwrap_or_else(|| look(path));
            seen.entry(path.clone()).or_insert_with(found);
        }
        self.expect(seen);
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
        self.within_then(time, || {})
    }

    /// The same, with something to be done before it is looked at what has happened to files.
    pub(super) fn within_then(&mut self, time: Duration, then: impl FnOnce()) -> Noticed {
        if std::mem::take(&mut self.stopped) {
            return Noticed::Stop;
        }
        if self.wished.load(Ordering::Acquire) {
            // However fast wishes come, Ctrl-C is heard; what else woke is looked for afterwards.
            let mut woken = self.wakes.try_iter();
            let stop = woken.any(|wake| wake == Wake::Stop);
            self.fresh = true;
            return if stop { Noticed::Stop } else { Noticed::Save };
        }
        if std::mem::take(&mut self.fresh) {
            return self.decide();
        }
        let until = Instant::now() + time;
        let next = until.min(self.compared + self.anyway);
        match self.pause(next) {
            Err(Stopped) => Noticed::Stop,
            // What else has happened is looked for after the load.
            Ok(true) if self.wished.load(Ordering::Acquire) => Noticed::Save,
            Ok(true) => {
                let closed = Instant::now() + CLOSE;
                while !self.ears.is_decided() && Instant::now() < closed {
                    if self.pause(closed).is_err() {
                        return Noticed::Stop;
                    }
                }
                then();
                self.decide()
            }
            Ok(false) if self.compared.elapsed() < self.anyway => Noticed::Nothing,
            Ok(false) => {
                self.compared = Instant::now();
                // A folder may have been replaced far above, where nothing is heard of it.
                self.listen();
                self.decide()
            }
        }
    }

    /// Gives a mistake that was just saved time to be the half of a save: whether there is more to
    /// load, which the next wait tells at once.
    pub(super) fn more_to_come(&mut self) -> bool {
        let until = self.noticed.map(|noticed| noticed + PATIENCE);
        while let Some(left) = until.and_then(|until| until.checked_duration_since(Instant::now()))
        {
            match self.within(left) {
                Noticed::Nothing => {}
                Noticed::Stop => {
                    self.stopped = true;
                    return true;
                }
                Noticed::Save => {
                    self.fresh = true;
                    return true;
                }
            }
        }
        false
    }

    /// Sleeps until something is heard (true) or the time has come (false).
    fn pause(&self, until: Instant) -> Result<bool, Stopped> {
        match self.wakes.recv_timeout(until.saturating_duration_since(Instant::now())) {
            Ok(Wake::Look) => Ok(true),
            Err(RecvTimeoutError::Timeout) => Ok(false),
            Ok(Wake::Stop) | Err(RecvTimeoutError::Disconnected) => Err(Stopped),
        }
    }

    /// Looks until every file is whole and still.
    fn decide(&mut self) -> Noticed {
        let since = Instant::now();
        let mut heard = Heard::default();
        self.files.values_mut().for_each(File::begin);
        loop {
            // Before the look: what is half in the end is so after all the patience.
            let waited = since.elapsed();
            heard = self.ears.take().after(&heard);
            if heard.moved {
                self.listen();
            }
            let (is_patient, looked) = (waited < PATIENCE, Instant::now());
            let standing = self.check(&heard, is_patient);
            let until = match standing {
                Standing::Same => return Noticed::Nothing,
                // Large files are still while they are looked at.
                Standing::Whole if self.files.len() > 1 && waited < CLOSE => looked + QUIET,
                Standing::Half if is_patient => Instant::now() + STEP,
                Standing::Whole | Standing::Half => return self.save(),
            };
            match self.pause(until) {
                Err(Stopped) => return Noticed::Stop,
                Ok(false) if standing == Standing::Whole => return self.save(),
                Ok(_) => {}
            }
        }
    }

    fn save(&mut self) -> Noticed {
        self.noticed = Some(Instant::now());
        Noticed::Save
    }

    /// Compares all files with what was seen in them, reading those that may have changed.
    fn check(&mut self, heard: &Heard, is_patient: bool) -> Standing {
        let mut all = Standing::Same;
        for (path, file) in &mut self.files {
            let (standing, found) = file.check(path, heard, is_patient);
            self.known.set(path, file.sure(), file.seen);
            match found {
                Some(Found::Seen(seen)) => _ = self.found.insert(path.clone(), seen),
                Some(Found::Other) => _ = self.found.remove(path),
                None => {}
            }
            all = all.max(standing);
        }
        all
    }

    /// Watches every folder on the way to the files as it is now.
    fn listen(&mut self) {
        let hops = Hops::of(self.files.keys().map(PathBuf::as_path));
        self.ears.listen(&hops);
        self.ears.forget_all_but(&hops);
    }

    fn is_far(&self) -> bool {
        self.ears.is_deaf() || self.ears.folders().any(mounts::is_remote)
    }
}

/// The end is asked for.
#[derive(Debug)]
struct Stopped;
