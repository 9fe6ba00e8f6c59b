//! From a scene to a stage.

use std::sync::Arc;

use luxel_sdk::kind::{Kind, LightForm};
use luxel_sdk::num::Transform;
use luxel_sdk::params::leave;

use super::analytic::Analytic;
use super::faults::of_stage;
use super::flatten::{Flat, flatten};
use super::geometry::mesh_part;
use super::kept::{Anew, Cache, Shaped};
use super::lights::LightSource;
use super::made::{Made, Settings};
use super::motion::{Motion, Splits};
use super::shining::Lamps;
use super::world::World;
use super::{Film, Geometry, Mesh, Place, Placement, Reasons, Skin, Stage};
use super::{failures, features, import, shining};
use crate::accel::{BuildError, Watch};
use crate::cast::{index, whole};
use crate::diag::{Diagnostic, Span, tell_once};
use crate::files::Files;
use crate::object::{Builder, Object};
use crate::registry::Registry;
use crate::registry::dynamic::{FAILED, remote};
use crate::scene::{Feature, Node, NodeId, Pose, Scene, Setting, Value};

/// A stage with the warnings that arose.
#[derive(Debug)]
pub struct Built {
    /// The stage.
    pub stage: Stage,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// What had to be made; the rest was kept from builds before.
    pub anew: Anew,
}

/// Makes a scene ready to trace, keeping what has not changed since `before`.
///
/// # Errors
/// Everything that was found wrong, warnings included.
pub fn build(
    scene: &Scene,
    registry: &Registry,
    files: &dyn Files,
    before: Option<&Stage>,
) -> Result<Built, Vec<Diagnostic>> {
    match build_watched(scene, registry, files, before, &Watch::default()) {
        Ok(built) => Ok(built),
        Err(Unbuilt::Faulty(found)) => Err(found),
        Err(Unbuilt::Cancelled) => unreachable!("nobody has cancelled it"),
    }
}

/// Why there is no stage.
#[derive(Debug)]
pub enum Unbuilt {
    /// Everything that was found wrong, warnings included.
    Faulty(Vec<Diagnostic>),
    /// The watch was cancelled.
    Cancelled,
}

/// The same, followed and perhaps stopped by `watch`, which tells the mesh whose tree is built. Plugins
/// that build are asked to stop.
///
/// # Errors
/// As `build`; that the watch was cancelled.
pub fn build_watched(
    scene: &Scene,
    registry: &Registry,
    files: &dyn Files,
    before: Option<&Stage>,
    watch: &Watch,
) -> Result<Built, Unbuilt> {
    let none = Cache::default();
    let cache = before.map_or(&none, |stage| &stage.cache);
    let expanded = import::expand(scene, (registry, files), &cache.assets, watch);
    let (scene, assets, mut diagnostics) = expanded.ok_or(Unbuilt::Cancelled)?;
    let film = Film::of_scene(&scene);
    let mode = features::color_mode(&scene, film.color);
    let mut setting_reasons = Reasons::default();
    setting_reasons.add_settings(&scene, (mode, &film));
    if watch.is_cancelled() {
        return Err(given_up((scene, assets)));
    }
    let mesh_part = |triangles| mesh_part(triangles, watch);
    let mut builder = Builder::new(registry, &scene, files, mode, &cache.objects);
    builder.mesh_parts = Some(&mesh_part);
    builder.watch = Some(watch);
    let world = before.and_then(|it| World::taken(it, (&scene, &film, mode), &mut builder));
    let mut maker = Maker {
        scene: &scene,
        during: film.during(),
        splits: Splits::default(),
        builder,
        cache,
        lamps: before.filter(|_| world.is_none()).map(Lamps::of).unwrap_or_default(),
        made: Made { assets, setting_reasons, ..Made::default() },
        watch,
    };
    match &world {
        Some(_) => maker.made.shapes.take(&cache.shapes, usize::MAX),
        None => maker.world().unwrap_or_else(|told| diagnostics.push(*told)),
    }
    maker.builder.end_world();
    let n_of_world = maker.builder.diagnostics.len();
    let settings = if watch.is_cancelled() { None } else { maker.settings() };
    let Maker { mut made, builder, .. } = maker;
    let (objects, mut told) = (builder.objects, builder.diagnostics);
    if watch.is_cancelled() {
        return Err(given_up((scene, made, objects)));
    }
    let warnings = told[..n_of_world].to_vec();
    diagnostics.append(&mut told);
    tell_once(&mut diagnostics);
    let anew = made.anew(&objects);
    let found = match settings {
        Some(settings) if !diagnostics.iter().any(Diagnostic::is_error) => {
            let world = world.or_else(|| made.world((&scene, &film, mode), &warnings, watch));
            let Some(world) = world else { return Err(given_up((scene, made, objects))) };
            let stage = made.finish((world, settings), objects, (scene, film, mode), cache);
            if watch.is_cancelled() {
                return Err(given_up(stage));
            }
            let found = of_stage(&stage);
            if found.is_empty() {
                return Ok(Built { stage, warnings: diagnostics, anew });
            }
            found
        }
        _ => failures(&objects, &scene),
    };
    diagnostics.extend(found);
    Err(Unbuilt::Faulty(diagnostics))
}

/// Leaves what was made so far.
fn given_up<T: Send + 'static>(made: T) -> Unbuilt {
    leave(made);
    Unbuilt::Cancelled
}

struct Maker<'a> {
    scene: &'a Scene,
    /// When the shutter opens and closes, seconds.
    during: [f64; 2],
    splits: Splits,
    builder: Builder<'a>,
    cache: &'a Cache,
    lamps: Lamps<'a>,
    made: Made,
    watch: &'a Watch,
}

/// Most groups of lights: each is a picture of its own.
const GROUPS: usize = 32;
/// Most letters of the name of a group of lights.
const GROUP_NAME: usize = 32;

impl Maker<'_> {
    /// All that stands in the world, and what is around it.
    ///
    /// # Errors
    /// There is too much of it.
    fn world(&mut self) -> Result<(), Box<Diagnostic>> {
        let flats = flatten(self.scene, self.watch);
        for flat in self.watch.until(flats.iter().flatten()) {
            self.place(flat);
        }
        let outside = self.scene.medium.filter(|_| !self.scene.leaves_out(Feature::Media));
        self.made.outside = outside.and_then(|id| self.medium(id));
        flats.map(drop)
    }

    fn place(&mut self, flat: &Flat) {
        if self.scene.node(flat.node).kind == Kind::Shape {
            self.shape(flat, flat.node, None);
        } else {
            self.light(flat);
        }
    }

    fn light(&mut self, flat: &Flat) {
        let Some(object) = self.builder.build(flat.node) else { return };
        let form = object.fixed().light().form();
        if form == LightForm::Everywhere {
            self.made.everywhere.push(flat.node);
        } else {
            self.requires(Feature::LightChoice, flat.node);
        }
        if form == LightForm::Surface {
            match self.child(flat.node, "shape") {
                Some(shape) => self.shape(flat, shape, Some(object)),
                None => self.shapeless(flat, &object),
            }
            return;
        }
        if let Some(place) = self.stand(&flat.pose, flat.span) {
            if place.is_moving() {
                self.requires(Feature::Motion, flat.node);
            }
            self.made.lights.push(LightSource::Free { object, place });
            let group = self.group(flat.node);
            self.made.group_of.push(group);
        }
    }

    /// The group that a light is of.
    fn group(&mut self, light: NodeId) -> Option<u32> {
        if self.scene.leaves_out(Feature::Layers) {
            return None;
        }
        let mut given = self.scene.node(light).params.iter();
        let (name, span) = given.find_map(|argument| match &argument.value {
            Value::Text(name) if argument.name == "group" => Some((name, argument.span)),
            _ => None,
        })?;
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || name.len() > GROUP_NAME || !name.chars().all(is_plain) {
            let message = "the name of a group is of letters, digits, `_` and `-`";
            let wrong = Diagnostic::error("E0405", span, message);
            let help = format!("at most {GROUP_NAME} of them: it names channels of the EXR");
            self.builder.diagnostics.push(wrong.help(help));
        }
        self.requires(Feature::Layers, light);
        let names = &mut self.made.group_names;
        if let Some(known) = names.iter().position(|group| **group == **name) {
            return Some(index(known));
        }
        if names.len() == GROUPS {
            let message = format!("more than {GROUPS} groups of lights");
            self.builder.diagnostics.push(Diagnostic::error("E0405", span, message));
            return None;
        }
        names.push((**name).into());
        Some(index(names.len() - 1))
    }

    /// A light of a surface that nobody gave: it would shine from nowhere.
    fn shapeless(&mut self, flat: &Flat, light: &Object) {
        let (class, span) = (light.class(), self.scene.node(flat.node).span);
        let name = class.name;
        let told = if class.params.iter().any(|param| param.name == "shape") {
            Diagnostic::error("E0403", span, format!("`{name}` wants `shape`"))
                .help("`shape` is a shape: what shines")
        } else {
            let of = remote(class).map_or_else(String::new, |it| format!(" of {}", it.origin()));
            let message = format!(
                "light `{name}`{of} shines from a shape's surface, but takes no shape: its class \
                 lacks the parameter `shape`"
            );
            Diagnostic::error(FAILED, span, message).label(span, "this object")
        };
        self.builder.diagnostics.push(told);
    }

    /// Where something stands or moves; `None`, and told, when that flattens space.
    fn stand(&mut self, pose: &Pose, span: Span) -> Option<Place> {
        if pose.is_identity() {
            return Some(Place::Here);
        }
        let [open, _] = self.during;
        let place = match pose {
            Pose::Moving(steps) => Motion::new(steps, &mut self.splits).and_then(|motion| {
                if motion.stands(self.during) {
                    return motion.at(open).map(Place::fixed);
                }
                Place::moving(motion, open)
            }),
            stands => stands.fixed().and_then(Transform::new).map(Place::fixed),
        };
        if place.is_none() {
            let message = "the transform is singular: it flattens space or is not finite";
            self.builder.diagnostics.push(Diagnostic::error("E0412", span, message));
        }
        place
    }

    fn shape(&mut self, flat: &Flat, shape: NodeId, light: Option<Arc<Object>>) {
        let Some(geometry) = self.geometry(shape) else { return };
        let Some(place) = self.stand(&flat.pose, flat.span) else { return };
        let filling = self.filling(shape, flat.material);
        let skin = self.skin(shape, flat.material, light.is_some(), filling.is_some());
        let Some(skin) = skin else { return };
        let has_media = !self.scene.leaves_out(Feature::Media);
        if skin == Skin::Open && !has_media {
            return;
        }
        if place.is_moving() || self.made.geometries[geometry as usize].is_moving() {
            self.requires(Feature::Motion, shape);
        }
        let interior = filling.filter(|_| has_media).and_then(|id| self.medium(id));
        let placement = Placement {
            geometry,
            place,
            skin,
            light: light.is_some().then_some(index(self.made.lights.len())),
            interior,
            closed: false,
            bends: false,
            priority: self.priority(shape),
            rank: 0,
            node: shape,
        };
        if let Some(object) = light {
            self.shining(object, &placement, flat.span);
            let group = self.group(flat.node);
            self.made.group_of.push(group);
        }
        self.made.placements.push(placement);
    }

    /// The source of light that a shining placement is.
    fn shining(&mut self, object: Arc<Object>, placement: &Placement, span: Span) {
        let place = index(self.made.placements.len());
        let geometry = &self.made.geometries[placement.geometry as usize];
        let (area, triangles) = shining::measured(geometry, placement, self.during, &self.lamps);
        let shape = (self.scene, placement.node);
        self.builder.diagnostics.extend(shining::doubts(geometry, area, shape, span));
        let quad = shining::sheared(geometry, placement);
        let source = LightSource::Surface { object, placement: place, area, triangles, quad };
        self.made.lights.push(source);
    }

    fn geometry(&mut self, id: NodeId) -> Option<u32> {
        if let Some(index) = self.made.geometry_of.get(&id) {
            return Some(*index);
        }
        let object = self.builder.build(id)?;
        let hash = self.scene.own_hash(id);
        // The object itself is kept only where no file that it read has changed.
        let may_stay =
            |(kept, geometry): &&Shaped| Arc::ptr_eq(kept, &object) && geometry.is_of(self.during);
        let (own, before) = (&self.made.shapes, &self.cache.shapes);
        let is_told = own.now().contains_key(&hash);
        let known = own.now().get(&hash).into_iter().chain(before.all(hash)).find(may_stay);
        let geometry = match known {
            Some((_, geometry)) => geometry.clone(),
            None => Arc::new(self.new_geometry(id, &object)?),
        };
        if let (false, Geometry::Mesh(mesh)) = (is_told, &*geometry)
            && mesh.dropped() > 0
        {
            let message = format!("{} triangles without area left out", mesh.dropped());
            let span = self.scene.node(id).span;
            self.builder.diagnostics.push(Diagnostic::warning("E0417", span, message));
        }
        self.made.shapes.put(hash, (object, geometry.clone()));
        self.made.geometries.push(geometry);
        let last = index(self.made.geometries.len() - 1);
        self.made.geometry_of.insert(id, last);
        Some(last)
    }

    fn new_geometry(&mut self, id: NodeId, object: &Arc<Object>) -> Option<Geometry> {
        self.made.new_shapes += 1;
        self.watch.name(&name(self.scene.node(id)));
        let shape = object.fixed().shape();
        let Some(triangles) = shape.mesh() else {
            return Some(Geometry::Analytic(Analytic::new(object.clone(), self.watch)?));
        };
        self.made.new_trees += 1;
        let span = self.scene.node(id).span;
        match Mesh::build(triangles, self.during, self.watch) {
            Ok(mesh) => Some(Geometry::Mesh(Arc::new(mesh))),
            Err(BuildError::Cancelled) => None,
            Err(error) => {
                self.builder.diagnostics.push(mesh_error(error, span));
                None
            }
        }
    }

    fn priority(&self, shape: NodeId) -> u32 {
        match self.scene.node(shape).get("priority").map(|it| &it.value) {
            Some(Value::Number(priority, _)) => whole(*priority),
            _ => 0,
        }
    }

    fn child(&self, id: NodeId, name: &str) -> Option<NodeId> {
        match self.scene.node(id).get(name)?.value {
            Value::Node(child) => Some(child),
            _ => None,
        }
    }

    /// The medium that fills a shape, by itself or by its material.
    fn filling(&self, shape: NodeId, inherited: Option<NodeId>) -> Option<NodeId> {
        let material = self.child(shape, "material").or(inherited);
        self.child(shape, "interior")
            .or_else(|| material.and_then(|material| self.child(material, "interior")))
    }

    /// Notes that a node requires a feature.
    fn requires(&mut self, feature: Feature, id: NodeId) {
        self.made.reasons.add(feature, id, self.scene.node(id).span);
    }

    fn medium(&mut self, id: NodeId) -> Option<u32> {
        if let Some(index) = self.made.medium_of.get(&id) {
            return Some(*index);
        }
        let object = self.builder.build(id)?;
        self.requires(Feature::Media, id);
        self.made.media.push(object);
        let last = index(self.made.media.len() - 1);
        self.made.medium_of.insert(id, last);
        Some(last)
    }

    fn skin(
        &mut self,
        shape: NodeId,
        inherited: Option<NodeId>,
        shines: bool,
        filled: bool,
    ) -> Option<Skin> {
        let Some(id) = self.child(shape, "material").or(inherited) else {
            return Some(match (shines, filled) {
                (true, _) => Skin::Black,
                (false, true) => Skin::Open,
                (false, false) => Skin::Material(self.default_material()),
            });
        };
        if let Some(index) = self.made.material_of.get(&id) {
            return Some(Skin::Material(*index));
        }
        let object = self.builder.build(id)?;
        let index = self.push_material(object, id);
        self.made.material_of.insert(id, index);
        Some(Skin::Material(index))
    }

    fn push_material(&mut self, object: Arc<Object>, node: NodeId) -> u32 {
        self.made.materials.push(object);
        self.made.material_nodes.push(node);
        index(self.made.materials.len() - 1)
    }

    /// What a shape without a material looks like: matt, its default grey.
    fn default_material(&mut self) -> u32 {
        if let Some(index) = self.made.default_material {
            return index;
        }
        let object = self.builder.preset(Kind::Material, "diffuse");
        let index = self.push_material(object, NodeId(u32::MAX));
        self.made.default_material = Some(index);
        index
    }

    fn settings(&mut self) -> Option<Settings> {
        let scene = self.scene;
        if scene.camera.is_none() {
            let error = Diagnostic::unplaced("E0409", "the scene has no camera")
                .help("add `camera perspective { look = look_at(from = …, to = …, up = …) }`");
            self.builder.diagnostics.push(error);
        }
        let camera = scene.camera.and_then(|id| self.builder.build(id));
        let camera_place =
            scene.camera.and_then(|id| self.stand(&scene.camera_pose, scene.node(id).span));
        if let (Some(id), Some(place)) = (scene.camera, &camera_place)
            && place.is_moving()
        {
            self.made.setting_reasons.add(Feature::Motion, id, scene.node(id).span);
        }
        let mut pick = |id: Option<NodeId>, setting: Setting| match id {
            Some(id) => self.builder.build(id),
            None => Some(self.builder.preset(setting.kind(), setting.default_class())),
        };
        let integrator = pick(scene.integrator, Setting::Integrator);
        let sampler = pick(scene.sampler, Setting::Sampler);
        let filter = pick(scene.filter, Setting::Filter);
        Some(Settings {
            camera: camera?,
            camera_place: camera_place?,
            integrator: integrator?,
            sampler: sampler?,
            filter: filter?,
        })
    }
}

/// What people call a shape: by its file, its label or its class.
fn name(node: &Node) -> String {
    let file = node.params.iter().find_map(|argument| match &argument.value {
        Value::Path(path) => Some(path.file_name()?.to_string_lossy().into_owned()),
        _ => None,
    });
    let label = || node.label.as_ref().map(|label| format!("`{label}`"));
    file.or_else(label).unwrap_or_else(|| node.class.to_string())
}

fn mesh_error(error: BuildError, span: Span) -> Diagnostic {
    Diagnostic::error("E0411", span, error.to_string())
}
