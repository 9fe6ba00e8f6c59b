//! Bytes by path: the only way in which anything outside the program is read.
//!
//! Because every byte comes through here, watch mode watches exactly what the last load asked for.

mod whole;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{fmt, io};

use luxel_sdk::params::Unfinished;

pub use self::whole::{Marks, Whole, hash_whole, read_whole};
use crate::scene::Hash;

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// Nothing is there.
    NotFound,
    /// It is there, but cannot be read: the system's words.
    Unreadable(String),
    /// It is larger than the limit, in bytes.
    TooLarge(u64),
    /// It lies outside the folders that a scene may read.
    Outside,
    /// Whoever asked for it does not want it any more.
    Unwanted,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound => write!(f, "there is no such file"),
            Self::Unreadable(why) => write!(f, "it cannot be read: {why}"),
            Self::TooLarge(limit) => write!(f, "it is larger than the limit of {limit} bytes"),
            Self::Outside => write!(f, "it lies outside the scene's folder (see --allow-path)"),
            Self::Unwanted => Unfinished::Unwanted.fmt(f),
        }
    }
}

impl std::error::Error for FileError {}

impl From<&io::Error> for FileError {
    fn from(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Self::NotFound,
            _ => Self::Unreadable(error.to_string()),
        }
    }
}

/// Where bytes come from.
///
/// Paths are as the scene gives them, already joined to the folder of the file that names them;
/// an implementation decides which it allows. Implementations remember what was asked for, the
/// missing included.
pub trait Files: Send + Sync {
    /// The whole file.
    ///
    /// # Errors
    /// `FileError` says what went wrong.
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError>;

    /// The BLAKE3 hash of the whole file, `None` when it cannot be read: for whoever knows what was in
    /// it. An implementation may know it without reading.
    fn hash(&self, path: &Path) -> Option<Hash> {
        self.read(path).ok().map(|bytes| *blake3::hash(&bytes).as_bytes())
    }

    /// One name for one file, so that a cycle is seen through links and `..`.
    fn canonical(&self, path: &Path) -> PathBuf {
        path.to_path_buf()
    }
}

/// Files held in memory, for tests and for programs that make scenes.
#[derive(Debug, Default)]
pub struct MemoryFiles {
    files: BTreeMap<PathBuf, Arc<[u8]>>,
    asked: Mutex<Vec<PathBuf>>,
}

impl MemoryFiles {
    /// Adds a file.
    #[must_use]
    pub fn with(mut self, path: impl Into<PathBuf>, bytes: impl Into<Arc<[u8]>>) -> Self {
        self.files.insert(path.into(), bytes.into());
        self
    }

    /// Every path that was asked for, in order, the missing ones included.
    pub fn asked(&self) -> Vec<PathBuf> {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Files for MemoryFiles {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        let path = self.canonical(path);
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(path.clone());
        self.files.get(&path).cloned().ok_or(FileError::NotFound)
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        normalise(path)
    }
}

/// Removes `.` and resolves `..` by name alone; leading `..` that cannot be resolved stay.
pub fn normalise(path: &Path) -> PathBuf {
    use std::path::Component;
    let mut parts: Vec<Component<'_>> = vec![];
    for part in path.components() {
        match (part, parts.last()) {
            (Component::CurDir, _) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    parts.iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_files_remember_what_was_missing() {
        let files = MemoryFiles::default().with("a/b.obj", &b"x"[..]);
        assert_eq!(&*files.read(Path::new("a/./c/../b.obj")).unwrap(), b"x");
        assert_eq!(files.read(Path::new("nope")), Err(FileError::NotFound));
        assert_eq!(files.asked(), [PathBuf::from("a/b.obj"), PathBuf::from("nope")]);
    }
}
