//! Plugins from dynamic libraries, as the host opens them.

mod bad;
mod bits;
mod builtins;
mod c_example;
mod compiler;
pub(crate) mod ember;
mod examples;
mod files;
mod forge;
mod judged;
mod light_tracer;
mod misbehave;
mod raw;
mod schema;
mod shapeless;
mod wrong_pictures;

use std::path::{Path, PathBuf};

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_core::stage::{self, Stage};

use crate::load::{Builtins, registry_of};

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

/// The built-ins, and what libraries offer.
pub(crate) fn registered(libraries: &[&Library]) -> Registry {
    let mut registry = registry_of(Builtins::Linked);
    for library in libraries {
        registry.add(&library.name, &library.classes).unwrap();
    }
    registry
}

/// A scene of these classes, built; or what was found wrong.
pub(crate) fn stage(registry: &Registry, text: &str) -> Result<Stage, Vec<Diagnostic>> {
    stage_after(registry, text, None)
}

/// The same, keeping what has not changed since `before`.
pub(crate) fn stage_after(
    registry: &Registry,
    text: &str,
    before: Option<&Stage>,
) -> Result<Stage, Vec<Diagnostic>> {
    let path = Path::new("a.scene");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    let loaded = luxel_lang::load(path, &files, registry, &settings);
    let Some(scene) = loaded.scene else { return Err(loaded.diagnostics) };
    stage::build(&scene, registry, &files, before).map(|built| built.stage)
}
