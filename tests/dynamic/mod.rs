//! Plugins from dynamic libraries, as the host opens them.

mod builtins;

use std::path::PathBuf;

use luxel_core::registry::dynamic::Library;

/// A library of this workspace, built along with these tests: it stands beside them.
pub(crate) fn library(stem: &str) -> PathBuf {
    let name = format!("{}{stem}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let tests = std::env::current_exe().unwrap();
    tests.with_file_name(name)
}

/// The library, opened.
pub(crate) fn open(stem: &str) -> Library {
    Library::open(&library(stem), stem, 0).unwrap_or_else(|error| panic!("{stem}: {error}"))
}
