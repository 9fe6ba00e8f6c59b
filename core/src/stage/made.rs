//! What a build has gathered, and the stage that it becomes.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use glam::DVec3;
use luxel_sdk::num::Bounds3;
use luxel_sdk::params::leave;

use super::kept::{Anew, Assets, Cache, Shaped};
use super::lights::LightSource;
use super::nesting;
use super::world::World;
use super::{
    Eye, Features, Film, Geometry, Lights, MediumStack, Place, Placement, Reasons, Skin, Stage,
};
use crate::accel::{Box64, TopBvh, Watch};
use crate::diag::Diagnostic;
use crate::object::{ColorMode, Object, Objects, Shelf};
use crate::scene::{Feature, Hash, NodeId, Scene};

/// The objects that a scene has one of.
pub(super) struct Settings {
    pub(super) camera: Arc<Object>,
    pub(super) integrator: Arc<Object>,
    pub(super) sampler: Arc<Object>,
    pub(super) filter: Arc<Object>,
    pub(super) camera_place: Place,
}

/// Lists in the making, each with the index of what is already in it.
#[derive(Default)]
pub(super) struct Made {
    pub(super) assets: Assets,
    pub(super) geometries: Vec<Arc<Geometry>>,
    pub(super) geometry_of: HashMap<NodeId, u32, foldhash::fast::RandomState>,
    pub(super) shapes: Shelf<Hash, Shaped>,
    /// How many of them had to be made ready.
    pub(super) new_shapes: usize,
    /// How many of their trees had to be built.
    pub(super) new_trees: usize,
    pub(super) placements: Vec<Placement>,
    pub(super) materials: Vec<Arc<Object>>,
    pub(super) material_nodes: Vec<NodeId>,
    pub(super) material_of: BTreeMap<NodeId, u32>,
    pub(super) media: Vec<Arc<Object>>,
    pub(super) medium_of: BTreeMap<NodeId, u32>,
    pub(super) lights: Vec<LightSource>,
    /// Those whose light is everywhere.
    pub(super) everywhere: Vec<NodeId>,
    /// Groups of lights by name, and which of them each light is of.
    pub(super) group_names: Vec<Arc<str>>,
    pub(super) group_of: Vec<Option<u32>>,
    pub(super) default_material: Option<u32>,
    /// What fills the space that no shape encloses.
    pub(super) outside: Option<u32>,
    /// Who of the world requires what, and which settings do.
    pub(super) reasons: Reasons,
    pub(super) setting_reasons: Reasons,
}

impl Made {
    /// What stands in the world, of which so much was told; `None` once the watch is cancelled.
    pub(super) fn world(
        &mut self,
        (scene, film, mode): (&Scene, &Film, ColorMode),
        warnings: &[Diagnostic],
        watch: &Watch,
    ) -> Option<World> {
        let during = film.during();
        let boxed = |placement: &Placement| {
            let local = self.geometries[placement.geometry as usize].bounds();
            let world = placement.place.bounds(local, during);
            (world.min, world.max)
        };
        let boxes: Vec<_> = watch.until(&self.placements).map(boxed).collect();
        if watch.is_cancelled() {
            return None;
        }
        let sphere = around(&boxes);
        let groups = (std::mem::take(&mut self.group_names), std::mem::take(&mut self.group_of));
        let sources = std::mem::take(&mut self.lights);
        let lights = Lights::new(sources, (sphere.1, mode), !self.media.is_empty(), watch);
        let lights = lights.in_groups(groups.0, groups.1);
        let needed = self.needed(scene, &boxes, &lights, watch);
        watch.name("the scene");
        let Some(top) = TopBvh::build_watched(&boxes, watch) else {
            leave(lights);
            return None;
        };
        drop(boxes);
        Some(World {
            lights: lights.into(),
            top: top.into(),
            geometries: std::mem::take(&mut self.geometries).into(),
            placements: std::mem::take(&mut self.placements).into(),
            materials: std::mem::take(&mut self.materials).into(),
            material_nodes: std::mem::take(&mut self.material_nodes).into(),
            media: std::mem::take(&mut self.media).into(),
            outside: self.outside,
            sphere,
            needed,
            reasons: std::mem::take(&mut self.reasons),
            warnings: warnings.into(),
        })
    }

    /// What had to be made.
    pub(super) fn anew(&self, objects: &Objects) -> Anew {
        let trees = self.new_trees + objects.trees_made;
        Anew { objects: objects.made, shapes: self.new_shapes, trees }
    }

    /// The stage of a world.
    pub(super) fn finish(
        self,
        (world, settings): (World, Settings),
        objects: Objects,
        (scene, film, mode): (Scene, Film, ColorMode),
        before: &Cache,
    ) -> Stage {
        let mut cache = Cache { assets: self.assets, objects, shapes: self.shapes };
        cache.inherit(before);
        let mut reasons = self.setting_reasons;
        reasons.add_all(&world.reasons, &scene);
        let (mut needed, sphere) = (world.needed, world.sphere);
        needed.motion |= settings.camera_place.is_moving();
        let mut stage = Stage {
            lights: world.lights.clone(),
            top: world.top.clone(),
            geometries: world.geometries.clone(),
            placements: world.placements.clone(),
            materials: world.materials.clone(),
            material_nodes: world.material_nodes.clone(),
            media: world.media.clone(),
            outside: world.outside,
            camera: settings.camera,
            camera_place: settings.camera_place,
            integrator: settings.integrator,
            sampler: settings.sampler,
            filter: settings.filter,
            reach: sphere.1,
            camera_media: MediumStack::default(),
            eye: None,
            world,
            cache,
            features: needed.and_required(&scene),
            needed,
            reasons,
            scene,
            film,
            mode,
            sphere,
        };
        stage.eye = Eye::of(stage.camera.fixed().camera(), stage.film.resolution);
        let middle = stage.film.resolution.as_dvec2() / 2.0;
        if let Some(seen) = stage.opening().camera_ray(middle, [0.5; 2]) {
            let eye = seen.ray.o;
            stage.reach = FOG_REACH * sphere.1.max(eye.distance(sphere.0));
            if stage.features.is_tracked() {
                stage.camera_media = stage.opening().media_at(eye);
            }
        }
        stage
    }

    /// What is to be modelled of the world; who requires it is noted, and what moves and what is filled
    /// is already. Of no use once the watch is cancelled.
    fn needed(
        &mut self,
        scene: &Scene,
        boxes: &[Box64],
        lights: &Lights,
        watch: &Watch,
    ) -> Features {
        let media = !self.media.is_empty();
        let (places, shapes) = (&mut self.placements, &self.geometries);
        let nested = nesting::settle(places, shapes, boxes, &self.materials, media, watch)
            .filter(|_| !scene.leaves_out(Feature::Nested));
        let open = self.placements.iter().filter(|placement| placement.skin == Skin::Open);
        let within = nested.iter().flatten().map(|at| &self.placements[*at]);
        let found = open.map(|it| (Feature::OpenSurfaces, it.node));
        for (feature, id) in watch.until(found.chain(within.map(|it| (Feature::Nested, it.node)))) {
            self.reasons.add(feature, id, scene.node(id).span);
        }
        let everywhere = std::mem::take(&mut self.everywhere).into_iter().filter(|_| media);
        everywhere.for_each(|id| self.reasons.add(Feature::LightChoice, id, scene.node(id).span));
        let light_choice = lights.is_choice();
        if !light_choice {
            self.reasons.clear(Feature::LightChoice);
        }
        let is_told = |feature| self.reasons.of(feature).next().is_some();
        let [open_surfaces, motion] = [Feature::OpenSurfaces, Feature::Motion].map(is_told);
        Features { media, open_surfaces, nested: nested.is_some(), motion, light_choice }
    }
}

/// A ball around everything that has an end.
fn around(boxes: &[Box64]) -> (DVec3, f64) {
    let all = boxes.iter().fold(Bounds3::EMPTY, |all, (min, max)| {
        let bounds = Bounds3 { min: *min, max: *max };
        if bounds.is_empty() || !bounds.diagonal().is_finite() { all } else { all.union(bounds) }
    });
    if all.is_empty() {
        return (DVec3::ZERO, 1.0);
    }
    (all.centre(), (all.diagonal().length() / 2.0).max(f64::MIN_POSITIVE))
}

/// How far the medium that fills the outside reaches, in radii of what holds the scene and the
/// camera: endless fog would let no light from far away through, and hold paths for ever.
const FOG_REACH: f64 = 2.0;
