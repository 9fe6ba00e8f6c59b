//! The end of a load: what the scene lacks.

use luxel_core::diag::Diagnostic;
use luxel_core::scene::{IsOver, NodeId, Placed, Pose, Scene, Target};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::leave;

use super::Evaluator;
use super::note::Noted;
use crate::Loaded;

/// Nodes of a faulty scene that are kept to be looked at.
const LOOKED_AT: usize = 100_000;

impl Evaluator<'_> {
    /// The scene, if there is no error, with everything that was found.
    pub(super) fn finish(mut self) -> Loaded {
        self.lacks();
        self.finished()
    }

    /// The same, where what the scene lacks has been told.
    pub(super) fn finished(mut self) -> Loaded {
        let errors = self.sink.errors();
        let is_good = errors == 0 && !self.damaged && !self.stopped;
        let is_small = self.is_looked_at();
        let is_over = self.sink.over();
        let mut made = if is_good || is_small { self.compacted(&is_over) } else { None };
        if is_over() {
            leave((self.scene, self.open_groups, made.take()));
        }
        let (scene, rest) = if is_good { (made, None) } else { (None, made) };
        let mut diagnostics = self.sink.finish();
        if scene.is_none() && errors == 0 {
            let message = "the scene could not be evaluated";
            diagnostics.push(Diagnostic::unplaced("E0023", message));
        }
        let values = self.noted.map(Noted::values).unwrap_or_default();
        Loaded { scene, rest, diagnostics, sources: self.sources, params: self.params, values }
    }

    /// Whether what a faulty load made is small enough to be looked at.
    pub(super) fn is_looked_at(&self) -> bool {
        !self.stopped && self.scene.nodes.len() <= LOOKED_AT
    }

    /// The scene with all that stands in it; `None` once it is over.
    fn compacted(&mut self, is_over: IsOver<'_>) -> Option<Scene> {
        self.scene.root = self.open_groups.pop().unwrap_or_default().group;
        let orphans: Vec<_> = self.orphans.iter().map(|id| placed(&self.scene, *id)).collect();
        self.scene.root.items.extend(orphans);
        self.scene.compact(is_over)?;
        Some(std::mem::take(&mut self.scene))
    }

    /// Tells what the scene lacks as a whole.
    pub(super) fn lacks(&mut self) {
        let is_whole = !self.damaged && !self.stopped && self.sink.errors() == 0;
        let is_missing = !self.has_asset && self.scene.camera.is_none();
        if is_missing && (is_whole || !self.may_have_camera()) {
            let known: Vec<_> = self.registry.of_kind(Kind::Camera).map(|e| e.class.name).collect();
            self.tell(
                Diagnostic::unplaced("E0409", "the scene has no camera")
                    .help(format!("known are {}", known.join(", "))),
            );
        }
        self.expectations_fit();
    }
}

fn placed(scene: &Scene, id: NodeId) -> Placed {
    let (pose, span) = (Pose::Here, scene.node(id).span);
    Placed { target: Target::Node(id), pose, material: None, span }
}
