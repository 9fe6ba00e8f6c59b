//! The world, ready to trace: taken over as it is where nothing but settings has changed.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::{Features, Film, Geometry, Lights, Placement, Reasons, Stage};
use crate::accel::TopBvh;
use crate::diag::{Diagnostic, Label, Span};
use crate::object::{Builder, ColorMode, Object};
use crate::scene::{Group, NodeId, Scene};

/// What stands in the world, and what follows from that alone: no camera, film, integrator, sampler or
/// filter. Stages of the same world share it.
#[derive(Clone, Debug)]
pub(super) struct World {
    pub(super) geometries: Arc<[Arc<Geometry>]>,
    pub(super) placements: Arc<[Placement]>,
    pub(super) top: Arc<TopBvh>,
    pub(super) materials: Arc<[Arc<Object>]>,
    pub(super) material_nodes: Arc<[NodeId]>,
    pub(super) media: Arc<[Arc<Object>]>,
    pub(super) outside: Option<u32>,
    pub(super) lights: Arc<Lights>,
    pub(super) sphere: (DVec3, f64),
    pub(super) needed: Features,
    /// Who of it requires what, each where its node is written.
    pub(super) reasons: Reasons,
    /// What was warned of.
    pub(super) warnings: Arc<[Diagnostic]>,
}

impl World {
    /// That of the stage before, with the objects of which it is made, if a scene has the same one;
    /// what it warns of is then told where it is written now.
    pub(super) fn taken(
        before: &Stage,
        (scene, film, mode): (&Scene, &Film, ColorMode),
        builder: &mut Builder<'_>,
    ) -> Option<Self> {
        let during = |film: &Film| film.during().map(f64::to_bits);
        let is_same = before.mode == mode
            && during(&before.film) == during(film)
            && before.scene.has_same_world(scene);
        if !is_same {
            return None;
        }
        let mut world = before.world.clone();
        if !world.warnings.is_empty() {
            world.warnings = told_here(&world.warnings, &before.scene, scene)?;
        }
        builder.take_world_over().then(|| {
            builder.diagnostics.extend(world.warnings.iter().cloned());
            world
        })
    }
}

/// What was told of a world, where the same is written in another scene; `None` where that is not clear.
fn told_here(told: &[Diagnostic], before: &Scene, now: &Scene) -> Option<Arc<[Diagnostic]>> {
    let mut places: HashMap<Span, Span, foldhash::fast::RandomState> = HashMap::default();
    let mut is_clear = true;
    let mut put = |there: Span, here: Span| {
        is_clear &= *places.entry(there).or_insert(here) == here;
    };
    for (there, here) in before.nodes.iter().zip(&now.nodes) {
        put(there.span, here.span);
        let arguments = there.params.iter().zip(&here.params);
        arguments.for_each(|(there, here)| put(there.span, here.span));
    }
    let groups = before.groups.iter().zip(&now.groups).chain([(&before.root, &now.root)]);
    let items =
        groups.flat_map(|(there, here): (&Group, &Group)| there.items.iter().zip(&here.items));
    items.for_each(|(there, here)| put(there.span, here.span));
    let moved = |span: Span| places.get(&span).copied();
    let told = told.iter().map(|told| {
        let labels = told
            .labels
            .iter()
            .map(|label| Some(Label { span: moved(label.span)?, text: label.text.clone() }));
        let labels = labels.collect::<Option<_>>()?;
        told.fixes.is_empty().then(|| Diagnostic { labels, ..told.clone() })
    });
    told.collect::<Option<_>>().filter(|_| is_clear)
}
