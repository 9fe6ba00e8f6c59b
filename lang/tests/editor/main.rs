//! The editor's services on snippets in which `|` is the cursor.

mod lists;
mod names;
#[path = "../language/registry.rs"]
mod registry;
mod shapes;
mod told;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::files::FileError;
use luxel_lang::Budgets;
use luxel_lang::editor::{Document, Place, Project};

/// Files in memory.
pub(crate) struct Files(BTreeMap<PathBuf, Arc<Document>>);

impl Files {
    /// Files by name.
    pub(crate) fn of(files: &[(&str, &str)]) -> Self {
        let document = |text: &str| Arc::new(Document::new(text, &Budgets::default()));
        Self(files.iter().map(|(name, text)| (PathBuf::from(name), document(text))).collect())
    }
}

impl Project for Files {
    fn document(&self, path: &Path) -> Option<Arc<Document>> {
        self.0.get(path).cloned()
    }

    fn files(&self) -> Vec<PathBuf> {
        self.0.keys().cloned().collect()
    }

    fn size(&self, path: &Path) -> Result<u64, FileError> {
        self.document(path).map(|file| file.text().len() as u64).ok_or(FileError::NotFound)
    }
}

/// Files by name, `|` in one of them; and where it stands.
pub(crate) fn marked(files: &[(&str, &str)]) -> (Files, PathBuf, usize) {
    let mut cursors = files.iter().filter_map(|(name, text)| Some((name.into(), text.find('|')?)));
    let (path, at) = cursors.next_back().expect("a snippet has a cursor");
    let bare: Vec<(&str, String)> =
        files.iter().map(|(name, text)| (*name, text.replacen('|', "", 1))).collect();
    let bare: Vec<(&str, &str)> = bare.iter().map(|(name, text)| (*name, text.as_str())).collect();
    (Files::of(&bare), path, at)
}

/// `name:line:text` of a place.
pub(crate) fn shown(files: &Files, place: &Place) -> String {
    let document = files.document(&place.path).expect("places are in files");
    let text = &document.text()[place.range.0..place.range.1];
    let line = document.line_of(place.range.0) + 1;
    format!("{}:{line}:{text}", place.path.display())
}
