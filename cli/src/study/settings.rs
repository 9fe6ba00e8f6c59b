//! Settings as lines to paste into a scene.

use luxel_core::diag::Sources;
use luxel_core::registry::Registry;
use luxel_core::scene::{Argument, Node, Scene, Setting, Value};
use luxel_sdk::params::Dimension as Unit;

use super::sweep::Change;
use crate::written;

/// The sampler with its number of samples, and what else differs from the scene.
///
/// # Errors
/// As `Change::apply`.
pub(super) fn lines(
    scene: &Scene,
    change: Option<&Change>,
    samples: u32,
    registry: &Registry,
    sources: &Sources,
) -> Result<String, String> {
    let mut scene = scene.clone();
    if let Some(change) = change {
        change.apply(&mut scene, registry)?;
    }
    let samples = Value::Number(f64::from(samples), Unit::NONE);
    scene.set_param(Setting::Sampler, "samples", samples);
    let other = change.and_then(|change| change.dimension.setting());
    let other = other.filter(|setting| *setting != Setting::Sampler);
    let settings = std::iter::once(Setting::Sampler).chain(other);
    let nodes = settings.filter_map(|setting| scene.setting(setting));
    let dropped = scene
        .left_out()
        .map(|feature| format!("// and on the command line: --drop {}", feature.name()));
    let lines = nodes.map(|node| line(node, registry, sources)).chain(dropped);
    Ok(lines.collect::<Vec<_>>().join("\n"))
}

fn line(node: &Node, registry: &Registry, sources: &Sources) -> String {
    let value = |argument: &Argument| written::value(argument, node, registry, sources);
    format!("{} {}", node.kind, written::node(node, value))
}
