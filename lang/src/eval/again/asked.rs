//! What a load asked for, so that the next one can ask again whether it is still so.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use luxel_core::files::{FileError, Files};

/// A question, and its answer.
#[derive(Clone, Debug)]
enum Asked {
    Bytes(PathBuf, Result<Arc<[u8]>, FileError>),
    Name(PathBuf, PathBuf),
}

/// Files that remember what they were asked.
pub(super) struct Remembering<'f> {
    files: &'f dyn Files,
    asked: Mutex<Vec<Asked>>,
}

/// The questions of a load that is over.
#[derive(Debug, Default)]
pub(super) struct Questions(Vec<Asked>);

impl<'f> Remembering<'f> {
    pub(super) fn new(files: &'f dyn Files) -> Self {
        Self { files, asked: Mutex::default() }
    }

    fn note(&self, asked: Asked) {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(asked);
    }

    /// What was asked about other files than the one at `root`.
    pub(super) fn beside(self, root: &Path) -> Questions {
        let mut asked = self.asked.into_inner().unwrap_or_else(PoisonError::into_inner);
        asked.retain(|asked| {
            let (Asked::Bytes(path, _) | Asked::Name(path, _)) = asked;
            path != root
        });
        Questions(asked)
    }
}

impl Files for Remembering<'_> {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        let answer = self.files.read(path);
        self.note(Asked::Bytes(path.to_owned(), answer.clone()));
        answer
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        let answer = self.files.canonical(path);
        self.note(Asked::Name(path.to_owned(), answer.clone()));
        answer
    }
}

impl Questions {
    /// Asks again; whether every answer is what it was.
    pub(super) fn are_answered_alike(&self, files: &dyn Files) -> bool {
        self.0.iter().all(|asked| match asked {
            Asked::Bytes(path, answer) => files.read(path) == *answer,
            Asked::Name(path, answer) => files.canonical(path) == *answer,
        })
    }
}
