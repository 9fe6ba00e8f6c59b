//! Scenes, loaded and built.

use std::path::Path;
use std::sync::OnceLock;

use glam::UVec2;
use luxel_core::diag::Diagnostic;
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_core::stage::{self, Stage};

use crate::dynamic;

/// How the built-ins come into the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Builtins {
    /// Linked in, as they ship.
    Linked,
    /// From the dynamic library of the same sources.
    Loaded,
}

/// With `LUXEL_TEST_BUILTINS=loaded` in the environment all tests take the built-ins from their dynamic
/// library.
pub(crate) fn takes_loaded_builtins() -> bool {
    #[expect(clippy::disallowed_methods, reason = "one run of the tests takes the other way")]
    let wanted = std::env::var("LUXEL_TEST_BUILTINS");
    wanted.is_ok_and(|wanted| wanted == "loaded")
}

/// Every class that a scene may name.
pub(crate) fn registry() -> Registry {
    let loaded = takes_loaded_builtins();
    registry_of(if loaded { Builtins::Loaded } else { Builtins::Linked })
}

/// The same, by one of the two ways.
pub(crate) fn registry_of(builtins: Builtins) -> Registry {
    let mut registry = Registry::new();
    match builtins {
        Builtins::Linked => {
            for classes in luxel_builtin::CLASSES {
                registry.add("builtin", classes).unwrap();
            }
        }
        Builtins::Loaded => {
            // Once: opened again it would be another generation, which shares no object.
            static LIBRARY: OnceLock<Library> = OnceLock::new();
            let library = LIBRARY.get_or_init(|| dynamic::open("builtins"));
            registry.add("builtin", &library.classes).unwrap();
        }
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
    let settings = luxel_lang::Settings { set: set.to_vec(), ..Default::default() };
    let registry = registry();
    let loaded = luxel_lang::load(path, files, &registry, &settings);
    let Some(scene) = loaded.scene else { return Err(loaded.diagnostics) };
    stage::build(&scene, &registry, files, before).map(|built| built.stage)
}

/// A scene file at another size, with the classes of any registry.
pub(crate) fn stage_with(
    registry: &Registry,
    path: &Path,
    files: &dyn Files,
    size: UVec2,
) -> Result<Stage, Vec<Diagnostic>> {
    let loaded = luxel_lang::load(path, files, registry, &luxel_lang::Settings::default());
    let Some(mut scene) = loaded.scene else { return Err(loaded.diagnostics) };
    scene.set_resolution(size);
    stage::build(&scene, registry, files, None).map(|built| built.stage)
}
