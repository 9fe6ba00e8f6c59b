//! The end of a load: what the scene lacks.

use luxel_core::diag::Diagnostic;
use luxel_core::scene::{Node, NodeId, Value};
use luxel_sdk::kind::Kind;

use super::Evaluator;
use crate::Loaded;

impl Evaluator<'_> {
    /// The scene, if there is no error, with everything that was found.
    pub(super) fn finish(mut self) -> Loaded {
        self.lacks();
        let errors = self.sink.errors();
        let scene = (errors == 0 && !self.damaged && !self.stopped).then(|| {
            self.scene.root = self.open_groups.pop().unwrap_or_default().group;
            self.scene.compact();
            self.scene
        });
        let mut diagnostics = self.sink.finish();
        if scene.is_none() && errors == 0 {
            let message = "the scene could not be evaluated";
            diagnostics.push(Diagnostic::unplaced("E0023", message));
        }
        let values = self.values.unwrap_or_default();
        Loaded { scene, diagnostics, sources: self.sources, params: self.params, values }
    }

    /// Tells what the scene lacks as a whole.
    pub(super) fn lacks(&mut self) {
        let incomplete = self.damaged || self.stopped || self.sink.errors() > 0;
        if !self.has_asset && self.scene.camera.is_none() && !incomplete {
            let known: Vec<_> = self.registry.of_kind(Kind::Camera).map(|e| e.class.name).collect();
            self.tell(
                Diagnostic::unplaced("E0409", "the scene has no camera")
                    .help(format!("known are {}", known.join(", "))),
            );
        }
        self.expectations_fit();
    }
}

/// The nodes that a node refers to.
pub(super) fn children(node: &Node) -> impl Iterator<Item = NodeId> {
    let params = node.params.iter().filter_map(|argument| match argument.value {
        Value::Node(id) | Value::Moved(id, _) => Some(id),
        _ => None,
    });
    params.chain(node.overrides.iter().map(|(_, id)| *id))
}
