//! Scenes of this program, made ready and rendered.

use std::path::Path;

use luxel_core::accel::Precision;
use luxel_core::diag::Diagnostic;
use luxel_core::files::{Files, MemoryFiles};
use luxel_core::film::{Film, Rect};
use luxel_core::render::Options;
use luxel_core::stage::{self, Stage};

use super::texts;
use crate::exit::{Exit, Failure, blaming};
use crate::verify::run::Run;

/// What all truths are tested with.
pub(super) struct Bench<'a> {
    run: &'a Run,
    files: MemoryFiles,
    /// How rays meet meshes, where the command line says it.
    precision: Option<Precision>,
}

impl<'a> Bench<'a> {
    pub(super) fn new(run: &'a Run, precision: Option<Precision>) -> Self {
        Self { run, files: texts::files(), precision }
    }

    /// The picture of one of the scenes with some parameters set, or a part of it.
    pub(super) fn film(
        &self,
        name: &str,
        set: &[(String, String)],
        crop: Option<Rect>,
    ) -> Result<Film, Failure> {
        let path = format!("{name}.scene");
        let stage = self.stage(&path, &self.files, set)?;
        let options = Options { crop, ..self.run.options.clone() };
        self.run.film((Path::new(&path), &stage), &options)
    }

    /// A scene that is given as a text, ready.
    pub(super) fn of_text(&self, text: &str) -> Result<Stage, Failure> {
        let files = MemoryFiles::default().with("unit.scene", text.as_bytes());
        self.stage("unit.scene", &files, &[])
    }

    /// A scene, ready.
    pub(super) fn stage(
        &self,
        path: &str,
        files: &dyn Files,
        set: &[(String, String)],
    ) -> Result<Stage, Failure> {
        let registry = &self.run.plugins.registry;
        let settings = luxel_lang::Settings { set: set.to_vec(), ..Default::default() };
        blaming(path, || {
            let loaded = luxel_lang::load(Path::new(path), files, registry, &settings);
            let mut scene = loaded.scene.ok_or_else(|| unfit(path, &loaded.diagnostics))?;
            if let Some(precision) = self.precision {
                scene.set_precision(precision);
            }
            let built = stage::build(&scene, registry, files, None);
            built.map(|built| built.stage).map_err(|found| unfit(path, &found))
        })?
    }
}

/// The failure of a scene that is right with the classes that the program brings.
fn unfit(path: &str, found: &[Diagnostic]) -> Failure {
    let told = found.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    let message = format!("luxel's own `{path}` cannot be made: {told}");
    Failure::new(Exit::Ours, message).help("a plugin library in place of the built-in classes?")
}
