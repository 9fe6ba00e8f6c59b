//! The project's own files, as tests read them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::files::{FileError, Files, normalise};

/// The folder of the whole project.
pub(crate) fn root() -> PathBuf {
    normalise(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
}

/// The whole text of one of the project's files.
pub(crate) fn text(path: &Path) -> String {
    let bytes = OnDisk.read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Every file below a folder with this extension, in order.
pub(crate) fn files_below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    let Ok(entries) = std::fs::read_dir(folder) else { return found };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            found.extend(files_below(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found
}

/// Files as they lie on the disk, all of them.
#[derive(Debug)]
pub(crate) struct OnDisk;

impl Files for OnDisk {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        #[expect(clippy::disallowed_methods, reason = "tests read the project's own files")]
        let read = std::fs::read(path);
        read.map(Arc::from).map_err(|_| FileError::NotFound)
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        normalise(path)
    }
}
