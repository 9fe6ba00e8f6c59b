//! The files that an editor has open, over those on disk.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::files::{FileError, Files, normalise};
use luxel_lang::Budgets;
use luxel_lang::editor::{Document, Project};

use super::Limits;
use crate::files::DiskFiles;

/// Scene files that are looked for below the folders of a workspace, at most.
const MAX_FILES: usize = 1000;
/// Files and folders that are looked at for it, at most.
const MAX_ENTRIES: usize = 20_000;
/// How deep below them.
const MAX_DEPTH: usize = 8;

/// A file that is open in the editor.
pub(super) struct Open {
    /// As the editor writes it.
    pub(super) uri: String,
    pub(super) version: i64,
    pub(super) document: Arc<Document>,
}

/// A file on disk as it was read last.
struct Known {
    hash: blake3::Hash,
    document: Arc<Document>,
    /// When it was looked at.
    round: u64,
}

/// Every file of a session.
pub(super) struct Opened {
    pub(super) open: BTreeMap<PathBuf, Open>,
    /// The folders of the workspace.
    pub(super) folders: Vec<PathBuf>,
    limits: Limits,
    known: RefCell<BTreeMap<PathBuf, Known>>,
    /// Files on disk are looked at once in each.
    round: u64,
}

impl Opened {
    pub(super) fn new(limits: Limits) -> Self {
        let (open, folders, known) = Default::default();
        Self { open, folders, limits, known, round: 0 }
    }

    /// What reading a file may cost.
    pub(super) fn budgets(&self) -> &Budgets {
        &self.limits.budgets
    }

    /// What is on disk may have changed.
    pub(super) fn look_again(&mut self) {
        self.round += 1;
    }

    /// What each of the open files may read, and what scenes of the workspace may.
    fn readers(&self) -> impl Iterator<Item = DiskFiles> {
        let scenes = self.open.keys().cloned();
        let scenes = scenes.chain(self.folders.iter().map(|folder| folder.join("x")));
        scenes.map(|scene| DiskFiles::new(&scene, &self.limits.allow))
    }

    /// A file on disk that one of the open files may read.
    fn on_disk(&self, path: &Path) -> Option<Arc<Document>> {
        if let Some(known) = self.known.borrow().get(path).filter(|k| k.round == self.round) {
            return Some(known.document.clone());
        }
        let limit = self.budgets().file_bytes;
        let small = fs::metadata(path).is_ok_and(|about| about.len() <= limit as u64);
        let read = |files: DiskFiles| files.read(path).ok();
        let bytes = self.readers().filter(|_| small).find_map(read)?;
        let hash = blake3::hash(&bytes);
        let mut known = self.known.borrow_mut();
        if let Some(known) = known.get_mut(path).filter(|known| known.hash == hash) {
            known.round = self.round;
            return Some(known.document.clone());
        }
        let text = str::from_utf8(&bytes).ok()?;
        let document = Arc::new(Document::new(text, self.budgets()));
        let round = self.round;
        known.insert(path.to_owned(), Known { hash, document: document.clone(), round });
        Some(document)
    }

    /// The texts that are open, as bytes.
    pub(super) fn texts(&self) -> BTreeMap<PathBuf, Arc<[u8]>> {
        let bytes = |open: &Open| Arc::from(open.document.text().as_bytes());
        self.open.iter().map(|(path, open)| (path.clone(), bytes(open))).collect()
    }
}

impl Project for Opened {
    fn document(&self, path: &Path) -> Option<Arc<Document>> {
        match self.open.get(path) {
            Some(open) => Some(open.document.clone()),
            None => self.on_disk(path),
        }
    }

    fn files(&self) -> Vec<PathBuf> {
        let mut out: Vec<PathBuf> = self.open.keys().cloned().collect();
        let mut left = MAX_ENTRIES;
        for folder in &self.folders {
            below(folder, MAX_DEPTH, &mut left, &mut out);
        }
        out
    }

    fn size(&self, path: &Path) -> Result<u64, FileError> {
        if let Some(open) = self.open.get(path) {
            return Ok(open.document.text().len() as u64);
        }
        let about = fs::metadata(path).map_err(|_| FileError::NotFound)?;
        if self.readers().all(|files| files.forbids(path)) {
            return Err(FileError::Outside);
        }
        if about.is_file() { Ok(about.len()) } else { Err(FileError::NotFound) }
    }
}

/// Names in the folder that a path in a scene begins with; folders end in `/`.
pub(super) fn names_beside(path: &Path, written: &str, ends: &[&str]) -> Vec<String> {
    let folder = &written[..written.rfind('/').map_or(0, |at| at + 1)];
    let folder = path.parent().unwrap_or(Path::new("")).join(folder);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .take(MAX_ENTRIES)
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_folder = entry.path().is_dir();
            let lower = name.to_ascii_lowercase();
            let fits = ends.is_empty() || ends.iter().any(|end| lower.ends_with(end));
            let shown = !name.starts_with('.') && (is_folder || fits);
            shown.then(|| if is_folder { format!("{name}/") } else { name })
        })
        .take(MAX_FILES)
        .collect();
    names.sort();
    names
}

/// Adds the scene files below a folder, among as many entries as are `left` to be looked at.
fn below(folder: &Path, depth: usize, left: &mut usize, out: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.take(*left).map(|entry| entry.path()).collect();
    *left -= paths.len();
    paths.sort();
    for path in paths {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or(".");
        if name.starts_with('.') || name == "target" || out.len() >= MAX_FILES {
            continue;
        }
        if path.is_dir() && !path.is_symlink() && depth > 0 {
            below(&path, depth - 1, left, out);
        } else if path.extension().is_some_and(|end| end == "scene") && !out.contains(&path) {
            out.push(path);
        }
    }
}

/// What an evaluation reads: open texts, then the disk.
pub(super) struct Overlay {
    disk: DiskFiles,
    texts: Arc<BTreeMap<PathBuf, Arc<[u8]>>>,
}

impl Overlay {
    pub(super) fn new(
        root: &Path,
        allow: &[PathBuf],
        texts: &Arc<BTreeMap<PathBuf, Arc<[u8]>>>,
    ) -> Self {
        Self { disk: DiskFiles::new(root, allow), texts: texts.clone() }
    }
}

impl Files for Overlay {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        match self.texts.get(&normalise(path)) {
            Some(_) if self.disk.forbids(path) => Err(FileError::Outside),
            Some(text) => Ok(text.clone()),
            None => self.disk.read(path),
        }
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        self.disk.canonical(path)
    }
}
