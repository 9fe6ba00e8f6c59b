//! From a scene file to a stage: the registry, the language, and what may be changed from outside.

use std::path::Path;
use std::sync::{Arc, Mutex, TryLockError};

use glam::UVec2;
use luxel_core::accel::Watch;
use luxel_core::diag::{Diagnostic, Sources};
use luxel_core::scene::Scene;
use luxel_core::stage::{self, Anew, Stage, Unbuilt};
use luxel_lang::{Kept, ParamInfo};

use crate::args::{LoadArgs, PluginArgs};
use crate::exit::{Exit, Failure, blaming};
use crate::files::{Asked, DiskFiles, Known};
use crate::interrupt::CANCELLED;
use crate::isolate::{Beat, Phase};
use crate::libraries::{Plugins, Session, Surroundings};
use crate::origin::Origin;
use crate::progress;

/// A scene file as far as it could be read, with everything that was found.
pub(crate) struct Loaded {
    /// The scene, if it has no error.
    pub(crate) scene: Option<Scene>,
    /// The stage, if nothing is wrong.
    pub(crate) stage: Option<Stage>,
    /// What was found.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The texts that were read.
    pub(crate) sources: Sources,
    /// The files that were asked for.
    pub(crate) files: DiskFiles,
    /// What had to be made; the rest was kept.
    pub(crate) anew: Anew,
    /// How a picture of the stage comes about.
    pub(crate) origin: Origin,
}

/// Every class that a scene may name: the built-in ones, and those of trusted libraries.
///
/// # Errors
/// A configuration or lock that cannot be understood.
pub(crate) fn registry(args: &PluginArgs) -> Result<Plugins, Failure> {
    registry_telling(args, &Beat::silent())
}

/// The same, telling what is done.
///
/// # Errors
/// As `registry`.
pub(crate) fn registry_telling(args: &PluginArgs, beat: &Beat) -> Result<Plugins, Failure> {
    beat.phase(Phase::Opening);
    let plugins = Session::new().refresh(args, &Surroundings::of_process())?;
    beat.opened(plugins.open(), &plugins.watched);
    Ok(plugins)
}

/// What there is on the search path, none of it opened: everything that could be is refused.
///
/// # Errors
/// As `registry`.
pub(crate) fn look_at_libraries(args: &PluginArgs) -> Result<Plugins, Failure> {
    let args = PluginArgs { builtins: None, ..args.clone() };
    Session::looking().refresh(&args, &Surroundings::of_process())
}

/// How a load is followed and stopped.
#[derive(Clone, Default)]
pub(crate) struct Course {
    /// Tells another process.
    pub(crate) beat: Beat,
    /// Ends reading and the building of trees.
    pub(crate) watch: Arc<Watch>,
    /// Files that need not be read to know what is in them.
    pub(crate) known: Known,
    /// The files that are asked for.
    pub(crate) asked: Asked,
    /// Whether a line tells of it on a terminal.
    pub(crate) line: bool,
    /// What the load before has left to go on from, if there will be another one.
    pub(crate) kept: Option<Arc<Mutex<Kept>>>,
}

/// Reads a scene and makes it ready to trace, at `size` if one is given.
///
/// # Errors
/// As `read` and `build`.
pub(crate) fn load(
    path: &Path,
    args: &LoadArgs,
    size: Option<UVec2>,
    plugins: &Plugins,
    course: &Course,
) -> Result<Loaded, Failure> {
    build(path, read(path, args, size, plugins, course)?, plugins, None, course)
}

/// A scene's text and what it says.
pub(crate) struct Text {
    /// The scene, if it has no error.
    pub(crate) scene: Option<Scene>,
    /// What could be made if it has one.
    pub(crate) rest: Option<Scene>,
    /// What was found.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The texts that were read.
    pub(crate) sources: Sources,
    /// The files that were asked for: so far, texts alone.
    pub(crate) files: DiskFiles,
    /// What may be set.
    pub(crate) params: Vec<ParamInfo>,
    /// What was set.
    pub(crate) set: Vec<(String, String)>,
}

/// Reads a scene, whose picture is to have `size` if one is given.
///
/// # Errors
/// A panic below, as our fault; a feature both required and dropped; that the course's watch was
/// cancelled. The author's mistakes are among what was found.
pub(crate) fn read(
    path: &Path,
    args: &LoadArgs,
    size: Option<UVec2>,
    plugins: &Plugins,
    Course { beat, known, asked, watch, kept, .. }: &Course,
) -> Result<Text, Failure> {
    let mut text = blaming(&path.display().to_string(), || {
        let files = DiskFiles::new(path, &args.allow_path).knowing(known).telling(asked);
        let files = files.until(watch.flag());
        beat.reading(files.shared());
        beat.phase(Phase::Loading);
        let settings = luxel_lang::Settings {
            set: args.set.clone(),
            unloaded: plugins.unloaded(),
            stop: Some(watch.flag()),
            budgets: args.budgets.budgets(),
            ..Default::default()
        };
        let registry = &plugins.registry;
        let mut read = match kept.as_ref().map(|kept| kept.try_lock()) {
            Some(Ok(mut kept)) => kept.load(path, &files, registry, &settings),
            // A panic may have left half of it.
            Some(Err(TryLockError::Poisoned(kept))) => {
                let mut kept = kept.into_inner();
                *kept = Kept::default();
                kept.load(path, &files, registry, &settings)
            }
            // A load that nobody waits for any more has it, or nobody wants it.
            Some(Err(TryLockError::WouldBlock)) | None => {
                luxel_lang::load(path, &files, registry, &settings)
            }
        };
        let mut scene = read.scene.take();
        if let (Some(scene), Some(size)) = (&mut scene, size) {
            scene.set_resolution(size);
        }
        if let (Some(scene), Some(precision)) = (&mut scene, args.precision) {
            scene.set_precision(precision);
        }
        if let Some(scene) = &mut scene {
            let most = args.budgets.budgets().instances;
            scene.allow_instances(usize::try_from(most).unwrap_or(usize::MAX));
            args.layers.iter().for_each(|layer| scene.add_layer(*layer));
        }
        let luxel_lang::Loaded { rest, diagnostics, sources, params, .. } = read;
        Text { scene, rest, diagnostics, sources, files, params, set: settings.set }
    })?;
    go_on(watch)?;
    text.scene.as_mut().map_or(Ok(()), |scene| args.change_features(scene))?;
    Ok(text)
}

/// Makes what was read ready to trace, keeping what has not changed since `before`.
///
/// # Errors
/// A panic below, as our fault; that the course's watch was cancelled. The author's mistakes are in
/// `diagnostics`.
pub(crate) fn build(
    path: &Path,
    text: Text,
    plugins: &Plugins,
    before: Option<&Stage>,
    Course { beat, watch, line: shown, .. }: &Course,
) -> Result<Loaded, Failure> {
    let loaded = blaming(&path.display().to_string(), || {
        let Text { scene, rest, mut diagnostics, sources, files, set, .. } = text;
        beat.building(watch);
        let build = |scene: &Scene| {
            // Of what is not wanted any more nothing is told.
            let line = || progress::building(&watch.standing());
            let told = |_| if watch.is_cancelled() { String::new() } else { line() };
            let build = || stage::build_watched(scene, &plugins.registry, &files, before, watch);
            progress::shown_while(told, *shown, build)
        };
        let built = scene.as_ref().map(build);
        if let Some(rest) = &rest {
            let found = stage::faults(rest, &plugins.registry, &files, before, watch);
            diagnostics.extend(shortened(found));
        }
        let mut anew = Anew::default();
        let stage = match built {
            Some(Ok(built)) => {
                diagnostics.extend(built.warnings);
                anew = built.anew;
                Some(built.stage)
            }
            Some(Err(Unbuilt::Faulty(found))) => {
                diagnostics.extend(shortened(found));
                None
            }
            Some(Err(Unbuilt::Cancelled)) | None => None,
        };
        let stage = stage.filter(|_| !diagnostics.iter().any(Diagnostic::is_error));
        let origin = |stage: &Stage| Origin::of(&set, &stage.scene, &plugins.registry, &sources);
        let origin = stage.as_ref().map(origin).unwrap_or_default();
        Loaded { scene, stage, diagnostics, sources, files, anew, origin }
    })?;
    go_on(watch)?;
    Ok(loaded)
}

/// As many as nobody reads to the end are told in part, mistakes first, and counted.
fn shortened(mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let most = luxel_lang::Budgets::default().diagnostics;
    let n_more = found.len().saturating_sub(most);
    if n_more > 0 {
        found.sort_by_key(|found| !found.is_error());
        found.truncate(most);
        let message = format!("{n_more} more mistakes and warnings are not shown");
        found.push(Diagnostic::unplaced("E0508", message));
    }
    found
}

fn go_on(watch: &Watch) -> Result<(), Failure> {
    if watch.is_cancelled() { Err(Failure::new(Exit::Incomplete, CANCELLED)) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    #[test]
    fn mistakes_of_a_thousand_objects_are_counted() {
        let folder = Folder::new("thousand");
        let mesh = "shape mesh { file = \"none.ply\", unit = 1 m }\n".repeat(1000);
        let light = "light constant { scale = 1 }";
        let camera = "camera perspective { fov = 40 deg, look = look_at(from = (0, 0, 9) m, \
                      to = (0, 0, 0) m, up = (0, 1, 0)) }";
        let text = format!("scene 1\n{camera}\n{light}\n{mesh}");
        folder.write("a.scene", text.as_bytes());
        let (path, plugins) = (folder.path("a.scene"), registry(&PluginArgs::default()).unwrap());
        let loaded = load(&path, &LoadArgs::default(), None, &plugins, &Course::default()).unwrap();
        let told = &loaded.diagnostics;
        assert!(loaded.stage.is_none() && told.len() == 101, "{}", told.len());
        assert!(
            told[100].message == "900 more mistakes and warnings are not shown",
            "{}",
            told[100]
        );
    }

    #[test]
    fn what_is_not_wanted_any_more_is_neither_read_nor_built() {
        let folder = Folder::new("unwanted");
        folder.write("a.scene", b"scene 1\nlight constant { scale = 1 }\nnope\n");
        let path = folder.path("a.scene");
        let plugins = registry(&PluginArgs::default()).unwrap();
        let course = Course::default();
        let text = read(&path, &LoadArgs::default(), None, &plugins, &course).unwrap();
        assert!(!text.diagnostics.is_empty() && course.asked.lock().unwrap().contains_key(&path));
        course.watch.cancel();
        let read = read(&path, &LoadArgs::default(), None, &plugins, &course);
        assert!(read.is_err_and(|failure| failure.exit == Exit::Incomplete));
        let built = build(&path, text, &plugins, None, &course);
        assert!(built.is_err_and(|failure| failure.exit == Exit::Incomplete));
    }
}
