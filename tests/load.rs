//! Scenes, loaded and built.

use std::path::Path;

use luxel_core::diag::Diagnostic;
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::stage::{self, Stage};

/// Every class that a scene may name.
pub(crate) fn registry() -> Registry {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).unwrap();
    }
    registry
}

/// A scene file, loaded with some parameters set and built; or all that was found wrong.
pub(crate) fn stage_of(
    path: &Path,
    files: &dyn Files,
    set: &[(String, String)],
    before: Option<&Stage>,
) -> Result<Stage, Vec<Diagnostic>> {
    let registry = registry();
    let settings = luxel_lang::Settings { set: set.to_vec(), ..Default::default() };
    let loaded = luxel_lang::load(path, files, &registry, &settings);
    let Some(scene) = loaded.scene else { return Err(loaded.diagnostics) };
    stage::build(&scene, &registry, files, before).map(|built| built.stage)
}
