//! What is wrong with a stage as a whole, and with the objects of a scene of which there is none.

use luxel_sdk::kind::Kind;

use super::Stage;
use super::eye;
use super::features;
use super::geometry::mesh_part;
use super::import;
use super::kept::Cache;
use super::settings::Film;
use crate::accel::Watch;
use crate::cast::index;
use crate::diag::{Diagnostic, tell_once};
use crate::files::Files;
use crate::object::Builder;
use crate::registry::Registry;
use crate::scene::{NodeId, Scene};

/// What is wrong with each object of what could be made of a faulty scene: files that are not there or
/// cannot be understood, numbers that do not fit together. Nothing is placed, and of what stands
/// `before` already nothing is read again.
pub fn faults(
    rest: &Scene,
    registry: &Registry,
    files: &dyn Files,
    before: Option<&Stage>,
    watch: &Watch,
) -> Vec<Diagnostic> {
    let none = Cache::default();
    let cache = before.map_or(&none, |stage| &stage.cache);
    let expanded = import::expand(rest, (registry, files), &cache.assets, watch);
    let Some((scene, _, mut diagnostics)) = expanded else { return vec![] };
    let mode = features::color_mode(&scene, Film::of_scene(&scene).color);
    let mesh_part = |triangles| mesh_part(triangles, watch);
    let mut builder = Builder::new(registry, &scene, files, mode, &cache.objects);
    builder.mesh_parts = Some(&mesh_part);
    builder.watch = Some(watch);
    // Assets have been read, and the film is no object.
    let is_object = |id: &NodeId| !matches!(scene.node(*id).kind, Kind::Importer | Kind::Film);
    for id in (0..scene.nodes.len()).map(|i| NodeId(index(i))).filter(is_object) {
        if watch.is_cancelled() {
            return vec![];
        }
        builder.build(id);
    }
    diagnostics.append(&mut builder.diagnostics);
    tell_once(&mut diagnostics);
    diagnostics
}

/// What is wrong with a stage as a whole.
pub(super) fn of_stage(stage: &Stage) -> Vec<Diagnostic> {
    let mut found = stage.failures();
    found.extend(eye::unseen(stage));
    found.extend(features::lacking(stage));
    found
}
