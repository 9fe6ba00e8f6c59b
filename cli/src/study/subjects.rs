//! The scene as it is, and with one setting after another changed.

use std::path::Path;

use glam::UVec2;
use luxel_core::scene::Scene;
use luxel_core::stage::{self, Stage};

use super::args::Args;
use super::lab::Subject;
use super::sweep::{Dimension, unfit};
use crate::exit::{Exit, Failure, blaming};
use crate::load::{self, Loaded};
use crate::report::{self, Stream};
use crate::verify::Run;

/// The longer side of a picture unless the command line says it.
const SIDE: u32 = 64;
/// More pixels are not held at once for every configuration and seed.
const MOST_PIXELS: u32 = 1 << 16;

/// What is studied.
pub(super) struct Subjects {
    /// The scene in its own size.
    pub(super) scene: Scene,
    pub(super) loaded: Loaded,
    pub(super) size: UVec2,
    /// The first is the scene as it is.
    pub(super) all: Vec<Subject>,
    /// What was left out, in words.
    pub(super) notes: Vec<String>,
}

/// Reads a scene and makes it ready in every way that is swept.
///
/// # Errors
/// A scene that cannot be read; a size or a change that cannot be.
pub(super) fn subjects(file: &Path, args: &Args, run: &Run) -> Result<Subjects, Failure> {
    let loaded = load::load(file, &args.load(), None, &run.plugins, &run.course());
    let mut loaded = loaded.map_err(|failure| run.interrupted().unwrap_or(failure))?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, args.form(), Stream::Error)?;
    let (Some(whole), Some(scene)) = (loaded.stage.take(), loaded.scene.take()) else {
        let message = format!("`{}` cannot be studied", file.display());
        return Err(Failure::new(Exit::Input, message));
    };
    let size = args.size.unwrap_or_else(|| small(whole.film.resolution));
    if size.x.saturating_mul(size.y) > MOST_PIXELS {
        let message = format!("{} x {} pixels are too many to be studied", size.x, size.y);
        return Err(Failure::new(Exit::Usage, message)
            .help(format!("at most {MOST_PIXELS}: an error hardly depends on the size")));
    }
    let mut base = scene.clone();
    base.set_resolution(size);
    let build = |scene: &Scene, before: &Stage| rebuilt((file, scene), &loaded, run, before);
    let stage = build(&base, &whole)?.map_err(|message| Failure::new(Exit::Input, message))?;
    let mut all = vec![Subject { change: None, stage }];
    let mut notes = vec![];
    for change in &args.sweep().changes {
        if change.is_of(&all[0].stage) {
            if change.dimension == Dimension::Drop {
                notes
                    .push(format!("{} was left out: the scene does not require it", change.name()));
            }
            continue;
        }
        let mut changed = base.clone();
        match change.apply(&mut changed, &run.plugins.registry) {
            // Of a class that has no such thing, others may be of use still.
            Err(message) if message.contains(" has no ") => {
                notes.push(format!("{} was left out: {message}", change.name()));
                continue;
            }
            applied => applied.map_err(unfit)?,
        }
        match build(&changed, &all[0].stage)? {
            Ok(stage) => all.push(Subject { change: Some(change.clone()), stage }),
            Err(message) => notes.push(format!("{} was left out: {message}", change.name())),
        }
    }
    Ok(Subjects { scene, loaded, size, all, notes })
}

/// A changed scene made ready, or the first thing that is wrong with it.
///
/// # Errors
/// A panic below, as our fault.
pub(super) fn rebuilt(
    (file, scene): (&Path, &Scene),
    loaded: &Loaded,
    run: &Run,
    before: &Stage,
) -> Result<Result<Stage, String>, Failure> {
    blaming(&file.display().to_string(), || {
        let built = stage::build(scene, &run.plugins.registry, &loaded.files, Some(before));
        let first = |found: &[luxel_core::diag::Diagnostic]| {
            found.first().map_or_else(String::new, ToString::to_string)
        };
        built.map(|built| built.stage).map_err(|found| first(&found))
    })
}

/// The same shape with `SIDE` pixels along its longer side, or fewer.
pub(super) fn small(size: UVec2) -> UVec2 {
    let longer = size.max_element().max(1);
    let side = SIDE.min(longer);
    ((size * side + longer / 2) / longer).max(UVec2::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_picture_has_the_shape_of_the_large_one() {
        assert_eq!(small(UVec2::new(512, 512)), UVec2::splat(64));
        assert_eq!(small(UVec2::new(720, 450)), UVec2::new(64, 40));
        assert_eq!(small(UVec2::new(8, 32)), UVec2::new(8, 32));
        assert_eq!(small(UVec2::new(65536, 1)), UVec2::new(64, 1));
    }
}
