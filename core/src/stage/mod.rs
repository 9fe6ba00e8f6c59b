//! The stage: a scene made ready to trace.
//!
//! Immutable. A new edit makes a new stage that shares what did not change with the last one, by
//! content hash.

mod analytic;
mod batch;
mod build;
mod closed;
mod eye;
mod faults;
mod features;
mod flatten;
mod geometry;
mod import;
mod kept;
mod lights;
mod made;
mod media;
mod moment;
mod motion;
mod nesting;
mod placement;
mod probe;
mod settings;
mod shining;
mod trace;
mod turning;
mod world;

use std::sync::Arc;

use glam::DVec3;

use crate::accel::TopBvh;
use crate::cast::index;
use crate::diag::Diagnostic;
use crate::object::{ColorMode, Object, Objects};
use crate::registry::dynamic::{Alarm, FAILED};
use crate::scene::{Hash, NodeId, Scene};
use kept::Cache;
use world::World;

pub use analytic::Analytic;
pub use batch::{Asked, Rooms};
pub use build::{Built, Unbuilt, build, build_watched};
pub use eye::{Eye, Seen};
pub use faults::faults;
pub use features::{Features, Reasons};
pub use geometry::{Geometry, Mesh};
pub use kept::Anew;
pub use lights::{
    EmissionNumbers, Emitted, Emitters, Facets, FoundLight, Lamp, LightSource, Lights, Quad,
};
pub use media::{Crossing, MediumStack};
pub use moment::Moment;
pub use motion::Motion;
pub use placement::{Leaving, Moving, Place, Placement, SceneHit, Skin};
pub use probe::First;
pub use settings::{ColorChoice, Film};

/// A scene made ready to trace.
#[derive(Debug)]
pub struct Stage {
    /// The scene, assets expanded: for messages and metadata.
    pub scene: Scene,
    /// How colour is carried.
    pub mode: ColorMode,
    /// Size, exposure, observer, output.
    pub film: Film,
    /// Geometry, each once.
    pub geometries: Arc<[Arc<Geometry>]>,
    /// Geometry in its places.
    pub placements: Arc<[Placement]>,
    /// Over the placements' boxes.
    pub top: Arc<TopBvh>,
    /// Materials that placements use.
    pub materials: Arc<[Arc<Object>]>,
    /// The node of each material.
    pub material_nodes: Arc<[NodeId]>,
    /// Media that placements use.
    pub media: Arc<[Arc<Object>]>,
    /// What fills the space that no shape encloses: an index into `media`.
    pub outside: Option<u32>,
    /// Sources of light and how one is chosen.
    pub lights: Arc<Lights>,
    /// The camera.
    pub camera: Arc<Object>,
    /// From the frame that the camera's parameters speak of to the world.
    pub camera_place: Place,
    /// The integrator.
    pub integrator: Arc<Object>,
    /// The sampler.
    pub sampler: Arc<Object>,
    /// The pixel filter.
    pub filter: Arc<Object>,
    /// What code is chosen by: what is modelled, and what was required from outside, which changes no
    /// bit.
    pub features: Features,
    /// What is modelled: what the scene requires and was not dropped.
    pub needed: Features,
    /// Who requires what is modelled.
    pub reasons: Reasons,
    /// Centre and radius of a sphere around everything, metres.
    pub sphere: (DVec3, f64),
    /// Radius about the centre of `sphere` to which what fills the outside reaches, metres.
    pub reach: f64,
    /// The media that the camera stands in when the shutter opens.
    pub camera_media: MediumStack,
    /// The camera as paths from lights find it; `None` where its lens is no point.
    pub eye: Option<Eye>,
    /// For the next build: what stands in the world, and all that has been made.
    world: World,
    cache: Cache,
}

impl Stage {
    /// Counts the failures of objects from libraries: of this stage, and of those that were built
    /// from the same beginnings.
    pub fn alarm(&self) -> &Alarm {
        &self.cache.objects.alarm
    }

    /// Whether an object from a library has failed.
    pub fn has_failed(&self) -> bool {
        self.cache.objects.failures().next().is_some()
    }

    /// What objects from libraries said when they failed, each where the scene made it.
    pub fn failures(&self) -> Vec<Diagnostic> {
        failures(&self.cache.objects, &self.scene)
    }
}

fn failures(objects: &Objects, scene: &Scene) -> Vec<Diagnostic> {
    let place = |hash: &Hash| {
        let ids = (0..scene.nodes.len()).map(|i| NodeId(index(i)));
        ids.into_iter().find(|id| scene.own_hash(*id) == *hash).map(|id| scene.node(id).span)
    };
    let told = objects.failures().map(|(hash, message)| match hash.and_then(place) {
        Some(span) => Diagnostic::error(FAILED, span, message).label(span, "this object"),
        None => Diagnostic::unplaced(FAILED, message),
    });
    told.collect()
}
