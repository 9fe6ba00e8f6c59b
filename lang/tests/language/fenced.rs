//! What snippets are loaded with: their own files and nothing above them, and budgets that a few lines
//! spend. Shared with the tests of the catalogue's pages, as a file that they take in.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::files::{FileError, Files, MemoryFiles, normalise};
use luxel_lang::Budgets;

/// Small enough that a snippet can pass them.
pub(crate) const SMALL: Budgets = Budgets {
    file_bytes: 400,
    total_bytes: 1000,
    include_depth: 1,
    includes: 4,
    brackets: 4,
    operators: 8,
    steps: 1000,
    list: 100,
    nodes: 10,
    instances: 100,
    string: 64,
    statements: 12,
    pieces: 64,
    names: 8,
    value_bytes: 4000,
    nesting: 16,
    diagnostics: 3,
};

/// Files in memory, of which those above the scene's folder may not be read.
pub(crate) struct Fenced(pub(crate) MemoryFiles);

impl Files for Fenced {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        let outside = normalise(path).starts_with("..");
        if outside { Err(FileError::Outside) } else { self.0.read(path) }
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        normalise(path)
    }
}
