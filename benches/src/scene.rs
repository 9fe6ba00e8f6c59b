//! Scenes as texts, and as stages of this program.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_core::scene::Scene;
use luxel_core::stage::{self, Stage};

/// A text of so many lines.
pub(crate) fn lines(n: usize, line: impl Fn(usize) -> String) -> String {
    (0..n).map(line).collect()
}

/// The built-ins.
pub(crate) fn linked() -> Registry {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).expect("built-ins have names of their own");
    }
    registry
}

/// The stage of a scene.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn stage_of(registry: &Registry, text: &str) -> Result<Stage, String> {
    stage_with(registry, MemoryFiles::default(), text)
}

/// The stage of a scene that reads these files.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn stage_with(
    registry: &Registry,
    files: MemoryFiles,
    text: &str,
) -> Result<Stage, String> {
    let files = files.with("a.scene", text.as_bytes());
    let scene = scene_in(registry, &files)?;
    let built = stage::build(&scene, registry, &files, None);
    built.map(|built| built.stage).map_err(|found| format!("{found:?}"))
}

/// What the text `a.scene` among some files says.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn scene_in(registry: &Registry, files: &MemoryFiles) -> Result<Scene, String> {
    let settings = luxel_lang::Settings::default();
    let loaded = luxel_lang::load(Path::new("a.scene"), files, registry, &settings);
    loaded.scene.ok_or_else(|| format!("{:?}", loaded.diagnostics))
}
