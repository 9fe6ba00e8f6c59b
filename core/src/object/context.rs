//! What an object may read while it is built, and a record of what it read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luxel_sdk::params::BuildContext;

use crate::accel::Watch;
use crate::files::Files;
use crate::scene::Hash;

/// Files that stand inside imported files, by the name that messages show.
pub type Embedded = BTreeMap<PathBuf, Arc<[u8]>>;

/// A file that was read: its path and the hash of its bytes, `None` when it could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Read {
    path: PathBuf,
    hash: Option<Hash>,
    /// How many bytes those were.
    bytes: usize,
}

/// Reads through `Files` and remembers what.
pub struct Reader<'a> {
    files: &'a dyn Files,
    embedded: &'a Embedded,
    /// Tells when the work is not wanted any more.
    watch: Option<&'a Watch>,
    reads: Mutex<Reads>,
    warnings: Mutex<Vec<String>>,
}

impl<'a> Reader<'a> {
    /// A reader of files, and of those inside imported files.
    pub fn new(files: &'a dyn Files, embedded: &'a Embedded) -> Self {
        let (reads, warnings) = Default::default();
        Self { files, embedded, watch: None, reads, warnings }
    }

    /// The same, that gives up when a watch is cancelled.
    #[must_use]
    pub fn watched(self, watch: Option<&'a Watch>) -> Self {
        Self { watch, ..self }
    }

    /// What was read and warned of.
    pub fn finish(self) -> (Reads, Vec<String>) {
        let reads = self.reads.into_inner().unwrap_or_else(PoisonError::into_inner);
        (reads, self.warnings.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn reads(&self) -> MutexGuard<'_, Reads> {
        self.reads.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn read_path(&self, path: &Path) -> Result<Arc<[u8]>, String> {
        let result =
            self.embedded.get(path).map_or_else(|| self.files.read(path), |it| Ok(it.clone()));
        let hash = result.as_ref().ok().and_then(|_| hash(path, self.files, self.embedded));
        let bytes = result.as_ref().map_or(0, |bytes| bytes.len());
        let read = Read { path: path.to_path_buf(), hash, bytes };
        self.reads().files.push(read);
        result.map_err(|error| format!("`{}`: {error}", path.display()))
    }
}

/// Files that were read, as they were then, and what was made of them.
#[derive(Debug, Default)]
pub struct Reads {
    files: Vec<Read>,
    /// Bytes of memory that what was made of them keeps, if that was told.
    held: Option<usize>,
}

impl Reads {
    /// Whether every file is still what it was.
    pub fn are_unchanged(&self, files: &dyn Files, embedded: &Embedded) -> bool {
        self.files.iter().all(|read| hash(&read.path, files, embedded) == read.hash)
    }

    /// How many bytes of memory are kept of it: as was told, or else as many as were read.
    pub fn bytes(&self) -> usize {
        self.held.unwrap_or_else(|| self.files.iter().map(|read| read.bytes).sum())
    }
}

/// What stands inside an imported file may have changed as any other.
fn hash(path: &Path, files: &dyn Files, embedded: &Embedded) -> Option<Hash> {
    embedded.get(path).map_or_else(|| files.hash(path), |it| Some(*blake3::hash(it).as_bytes()))
}

impl BuildContext for Reader<'_> {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
        self.read_path(Path::new(path))
    }

    fn read_beside(&self, base: &str, path: &str) -> Result<Arc<[u8]>, String> {
        let folder = Path::new(base).parent().unwrap_or(Path::new(""));
        self.read_path(&folder.join(path))
    }

    fn warn(&self, message: &str) {
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(message.to_owned());
    }

    fn cancelled(&self) -> bool {
        self.watch.is_some_and(Watch::is_cancelled)
    }

    fn holds(&self, bytes: usize) {
        let held = &mut self.reads().held;
        *held = Some(held.unwrap_or(0).saturating_add(bytes));
    }
}
