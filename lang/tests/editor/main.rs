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
    let (mut out, mut cursor) = (BTreeMap::new(), None);
    for (name, text) in files {
        let path = PathBuf::from(name);
        if let Some(at) = text.find('|') {
            cursor = Some((path.clone(), at));
        }
        let document = Document::new(text.replacen('|', "", 1), &Budgets::default());
        out.insert(path, Arc::new(document));
    }
    let (path, at) = cursor.expect("a snippet has a cursor");
    (Files(out), path, at)
}

/// `name:line:text` of a place.
pub(crate) fn shown(files: &Files, place: &Place) -> String {
    let document = files.document(&place.path).expect("places are in files");
    let text = &document.text()[place.range.0..place.range.1];
    let line = document.line_of(place.range.0) + 1;
    format!("{}:{line}:{text}", place.path.display())
}
