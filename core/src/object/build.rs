//! From a node of the scene graph to an object: its template and what varies.

use std::collections::HashSet;
use std::sync::Arc;

use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Emission, Fault, Param, Quantity, Role, Type};

use super::Object;
use super::colour::{self, Amount, Brightness};
use super::context::{Embedded, Reader, Reads};
use super::draft::Draft;
use super::part::{MeshParts, PartTree};
use super::shelf::{Kept, Shelf};
use crate::accel;
use crate::diag::{Diagnostic, Span};
use crate::files::Files;
use crate::registry::Registry;
use crate::registry::dynamic::{Alarm, Head, Watch, remote};
use crate::scene::{Argument, Color, Feature, Hash, Node, NodeId, Scene, Value};

/// How colour is carried along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ColorMode {
    /// Lanes are linear sRGB.
    Rgb,
    /// Lanes are four wavelengths.
    Spectral,
}

impl ColorMode {
    /// Whether lanes are wavelengths.
    #[inline(always)]
    pub fn is_spectral(self) -> bool {
        Feature::Spectral.is_compiled() && self == Self::Spectral
    }
}

impl Kept for Arc<Object> {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(self, other)
    }

    fn bytes(&self) -> usize {
        self.reads.bytes()
    }
}

/// Objects of the last builds, by content.
#[derive(Debug, Default)]
pub struct Objects {
    by_content: Shelf<Key, Arc<Object>>,
    /// Trees of meshes that are parts of other shapes, by the content of the mesh.
    pub(super) trees: Shelf<Hash, PartTree>,
    /// How many the last build had to make.
    pub made: usize,
    /// How many of the trees it had to build.
    pub trees_made: usize,
    /// Objects of no node: what the host takes where a scene says nothing.
    presets: Vec<Arc<Object>>,
    /// How many of those by content, and of the presets, are of the world: they were made first.
    of_world: [usize; 2],
    /// Raised by each object that fails, of this build and of those before and after it.
    pub alarm: Alarm,
}

impl Objects {
    /// Every object that has failed, by its content, if a node made it: who and how.
    pub fn failures(&self) -> impl Iterator<Item = (Option<&Hash>, String)> {
        let of_nodes = self.by_content.now().iter();
        let of_nodes = of_nodes.map(|((hash, _), object)| (Some(hash), object));
        let presets = self.presets.iter().map(|object| (None, object));
        of_nodes.chain(presets).filter_map(|(hash, object)| Some((hash, object.failure()?)))
    }

    /// Takes over what builds before have left, of so many bytes at most; returns how many those are.
    pub(crate) fn inherit(&mut self, before: &Self, most: usize) -> usize {
        let trees = self.trees.inherit(&before.trees, most);
        trees + self.by_content.inherit(&before.by_content, most - trees)
    }
}

/// What an object is known by: the content of its node, and how colour is carried if that counts.
type Key = (Hash, Option<ColorMode>);

/// The keys that an object may have; those of which no more than one is taken.
fn keys(hash: Hash, mode: ColorMode) -> [Key; 2] {
    [(hash, None), (hash, Some(mode))]
}

/// The key of an object that was made.
fn key(hash: Hash, mode: ColorMode, object: &Object) -> Key {
    (hash, object.is_by_mode.then_some(mode))
}

/// Makes objects of the nodes of one scene.
pub struct Builder<'a> {
    registry: &'a Registry,
    pub(super) scene: &'a Scene,
    files: &'a dyn Files,
    mode: ColorMode,
    embedded: Embedded,
    brightness: Brightness,
    pub(super) before: &'a Objects,
    /// How triangles become a part of another shape; without it they cannot.
    pub mesh_parts: Option<MeshParts<'a>>,
    /// Ends what plugins do before it is done.
    pub watch: Option<&'a accel::Watch>,
    /// What this build made or kept.
    pub objects: Objects,
    /// Nodes with which something is wrong, which has been said.
    refused: HashSet<(NodeId, ColorMode)>,
    /// What was found wrong.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'a> Builder<'a> {
    /// A builder that keeps what `before` holds and what has not changed.
    pub fn new(
        registry: &'a Registry,
        scene: &'a Scene,
        files: &'a dyn Files,
        mode: ColorMode,
        before: &'a Objects,
    ) -> Self {
        let embedded = embedded_files(scene);
        let objects = Objects { alarm: before.alarm.clone(), ..Objects::default() };
        Self {
            registry,
            scene,
            files,
            mode,
            embedded,
            brightness: Brightness::default(),
            before,
            mesh_parts: None,
            watch: None,
            objects,
            refused: HashSet::new(),
            diagnostics: vec![],
        }
    }

    /// Takes over all of which the world was made before, if that is still what it was.
    pub(crate) fn take_world_over(&mut self) -> bool {
        let [objects, presets] = self.before.of_world;
        let presets = &self.before.presets[..presets];
        let by_content = self.before.by_content.now().values().take(objects);
        let may_stay = |it: &Arc<Object>| {
            it.is_current(self.registry) && it.is_unchanged(self.files, &self.embedded)
        };
        if !by_content.chain(presets).all(may_stay) {
            return false;
        }
        self.objects.by_content.take(&self.before.by_content, objects);
        self.objects.trees.take(&self.before.trees, usize::MAX);
        self.objects.presets.extend(presets.iter().cloned());
        true
    }

    /// What is built from now on is not of the world.
    pub(crate) fn end_world(&mut self) {
        self.objects.of_world = [self.objects.by_content.now().len(), self.objects.presets.len()];
    }

    /// The object of a node. `None` when something is wrong with it, which has then been said.
    pub fn build(&mut self, id: NodeId) -> Option<Arc<Object>> {
        let place = (id, self.mode);
        if self.refused.contains(&place) {
            return None;
        }
        let built = self.build_or_keep(id);
        if built.is_none() {
            self.refused.insert(place);
        }
        built
    }

    fn build_or_keep(&mut self, id: NodeId) -> Option<Arc<Object>> {
        let node = self.scene.node(id);
        let (hash, mode) = (self.scene.own_hash(id), self.mode);
        let now = self.objects.by_content.now();
        if let Some(object) = keys(hash, mode).iter().find_map(|key| now.get(key)) {
            return Some(object.clone());
        }
        let may_stay = |it: &&Arc<Object>| {
            it.is_current(self.registry) && it.is_unchanged(self.files, &self.embedded)
        };
        let known = keys(hash, mode).into_iter().flat_map(|key| self.before.by_content.all(key));
        if let Some(object) = known.into_iter().find(may_stay).cloned() {
            self.keep_parts(object.class(), node);
            self.tell(&object, node);
            self.objects.by_content.put(key(hash, mode, &object), object.clone());
            return Some(object);
        }
        let Some(class) = self.registry.class(node.kind, node.class) else {
            let message = format!("there is no {} `{}`", node.kind, node.class);
            self.diagnostics.push(Diagnostic::error("E0401", node.span, message));
            return None;
        };
        let object = self.make(class, Some(node))?;
        self.objects.by_content.put(key(hash, mode, &object), object.clone());
        self.objects.made += 1;
        Some(object)
    }

    /// Keeps what an object that is kept was made of, in the order in which it was made.
    fn keep_parts(&mut self, class: &Class, node: &Node) {
        for param in class.params.iter().filter(|param| param.offset != usize::MAX) {
            match (param.ty, node.get(param.name).map(|argument| &argument.value)) {
                (Type::Object(Kind::Shape), _) => {}
                (Type::Object(Kind::Texture), Some(Value::Node(id))) => _ = self.build_asked(*id),
                (Type::Part, Some(Value::Node(id) | Value::Moved(id, _))) => self.keep_part(*id),
                (_, Some(Value::Node(id) | Value::Moved(id, _))) => _ = self.build(*id),
                _ => {}
            }
        }
    }

    /// A texture that is asked for numbers says the same in every mode: a mesh keeps its form.
    fn build_asked(&mut self, id: NodeId) -> Option<Arc<Object>> {
        let mode = std::mem::replace(&mut self.mode, ColorMode::Rgb);
        let texture = self.build(id);
        self.mode = mode;
        texture
    }

    /// Tells what an object warned of when it was made.
    fn tell(&mut self, object: &Object, node: &Node) {
        let warning = |told: &String| Diagnostic::warning("E0417", node.span, told);
        self.diagnostics.extend(object.warnings.iter().map(warning));
    }

    /// An object of a class with its defaults alone.
    ///
    /// # Panics
    /// If there is no such class, or it has required parameters.
    pub fn preset(&mut self, kind: Kind, name: &str) -> Arc<Object> {
        let class = self.registry.class(kind, name).expect("the host's presets are registered");
        let object = self.make(class, None).expect("the host's presets need no parameters");
        self.objects.presets.push(object.clone());
        object
    }

    fn make(&mut self, class: &Class, node: Option<&Node>) -> Option<Arc<Object>> {
        let errors = self.diagnostics.len();
        let mut draft = Draft::new(class.size, self.mode);
        let watch = remote(class).map(|remote| {
            let who = format!("{} `{}` of {}", class.kind, class.name, remote.origin());
            let watch = Arc::new(Watch::new(who, self.objects.alarm.clone()));
            draft.block.write_raw(0, Head::new(remote, &watch));
            watch
        });
        for param in class.params.iter().filter(|param| param.offset != usize::MAX) {
            let argument = node.and_then(|node| node.get(param.name));
            if let Err(message) = self.field(&mut draft, param, argument, node) {
                let span = argument.map(|a| a.span).or(node.map(|n| n.span));
                self.fault(Fault::range(param.name, message), span, node);
            }
        }
        let lacks = draft.lacks;
        let mut object = Object {
            class: *class,
            takes_colors: draft.patches.take_colors(),
            need: draft.block.chunks().len().saturating_add(draft.patches.need()),
            template: draft.block,
            patches: draft.patches,
            owned: draft.owned,
            size: draft.parts.iter().fold(1, |size, part| size.saturating_add(part.size)),
            parts: draft.parts,
            is_by_mode: draft.is_by_mode,
            face_bits: draft.face_bits,
            watch,
            needs: None,
            reads: Reads::default(),
            warnings: vec![],
        };
        if let Some(fault) = object.is_too_large() {
            self.fault(fault, None, node);
        }
        if lacks || self.diagnostics[errors..].iter().any(Diagnostic::is_error) {
            return None;
        }
        self.complete(&mut object, node)?;
        Some(Arc::new(object))
    }

    /// Checks, builds the shared table, prepares.
    fn complete(&mut self, object: &mut Object, node: Option<&Node>) -> Option<()> {
        if let Err(fault) = object.run_check() {
            self.fault(fault, None, node);
            return None;
        }
        let reader = Reader::new(self.files, &self.embedded).watched(self.watch);
        let built = object.build_shared(&reader);
        (object.reads, object.warnings) = reader.finish();
        node.inspect(|node| self.tell(object, node));
        if let Err(faults) = built {
            for fault in faults {
                self.fault(fault, None, node);
            }
            return None;
        }
        object.prepare();
        if object.class.kind == Kind::Material && object.is_constant() {
            object.needs = Some(object.fixed().material().needs());
        }
        Some(())
    }

    fn fault(&mut self, fault: Fault, span: Option<Span>, node: Option<&Node>) {
        let place = span.or_else(|| {
            let node = node?;
            Some(node.get(fault.field).map_or(node.span, |argument| argument.span))
        });
        self.diagnostics.push(match place {
            Some(span) => Diagnostic::error(fault.code, span, fault.message),
            None => Diagnostic::unplaced(fault.code, fault.message),
        });
    }

    /// The object of a node of which another one is made.
    pub(super) fn part_of(&mut self, draft: &mut Draft, id: NodeId) -> Option<Arc<Object>> {
        let part = self.build(id);
        draft.lacks |= part.is_none();
        draft.is_by_mode |= part.as_ref().is_some_and(|part| part.is_by_mode);
        part
    }

    fn field(
        &mut self,
        draft: &mut Draft,
        param: &Param,
        argument: Option<&Argument>,
        node: Option<&Node>,
    ) -> Result<(), String> {
        let value = argument.map(|argument| &argument.value);
        match (param.ty, value) {
            (Type::Emission, _) => return self.emission(draft, param, value, node),
            (Type::Object(Kind::Shape), _) => {}
            (Type::Part, Some(Value::Node(id))) => self.part(draft, param, *id, None)?,
            (Type::Part, Some(Value::Moved(id, to))) => self.part(draft, param, *id, Some(to))?,
            (Type::Object(Kind::Texture), Some(Value::Node(id))) => {
                let texture = self.build_asked(*id);
                draft.lacks |= texture.is_none();
                texture.inspect(|texture| draft.asked(param.offset, texture));
            }
            (Type::Object(_), Some(Value::Node(id))) => {
                if let Some(child) = self.part_of(draft, *id) {
                    draft.child(param.offset, &child);
                }
            }
            (Type::Part, None) => return Err(format!("`{}` is missing: a shape", param.name)),
            (Type::Object(Kind::Phase), None) => {
                let child = self.preset(Kind::Phase, "isotropic");
                draft.child(param.offset, &child);
            }
            (_, Some(Value::Node(id))) => {
                if let Some(texture) = self.part_of(draft, *id) {
                    draft.texture(param, texture, 1.0)?;
                }
            }
            (Type::Spectrum | Type::ComplexIor, Some(Value::Color(color, _))) => {
                let mode = draft.mode();
                draft.lanes(param.offset, colour::lanes(color, param.role, mode)?)?;
                if param.ty == Type::ComplexIor
                    && let Some(k) = colour::extinction(color, mode)
                {
                    draft.lanes(param.offset + size_of::<Spectrum>(), k)?;
                }
            }
            // A metal's `eta` has written it already.
            (Type::Spectrum, None) if param.role == Role::ComplexIor => {
                let metal = node.and_then(|node| node.get("eta")).map(|argument| &argument.value);
                if !matches!(metal, Some(Value::Color(Color::Metal(_), _))) {
                    return Err("`k` is missing: `eta` names no measured metal".to_owned());
                }
            }
            (_, Some(value)) => draft.value(param, value)?,
            (_, None) => draft.preset(param),
        }
        Ok(())
    }

    /// The light's field: written once, at its spectrum; the amounts are read along with it.
    fn emission(
        &mut self,
        draft: &mut Draft,
        param: &Param,
        value: Option<&Value>,
        node: Option<&Node>,
    ) -> Result<(), String> {
        if param.group == "amount" {
            return Ok(());
        }
        let given =
            Quantity::ALL.iter().find_map(|(quantity, name, _)| match &node?.get(name)?.value {
                Value::Number(value, dimension) => {
                    Some(Amount { quantity: *quantity, value: *value, dimension: *dimension })
                }
                _ => None,
            });
        let dimension = colour::dimension("");
        let amount = given.unwrap_or(Amount { quantity: Quantity::Scale, value: 1.0, dimension });
        draft
            .block
            .write(param.offset, Emission { spectrum: Spectrum::ZERO, quantity: amount.quantity });
        match value {
            Some(Value::Node(id)) => {
                if let Some(texture) = self.part_of(draft, *id) {
                    draft.texture(
                        param,
                        texture,
                        colour::texture_factor(amount, &mut self.brightness),
                    )?;
                }
            }
            Some(Value::Color(color, _)) => {
                let lanes = colour::emission(color, amount, draft.mode(), &mut self.brightness)?;
                draft.lanes(param.offset, lanes)?;
            }
            Some(other) => return Err(format!("a spectrum cannot be made of {other:?}")),
            None => {
                let lanes =
                    colour::emission(&colour::white(), amount, draft.mode(), &mut self.brightness)?;
                draft.lanes(param.offset, lanes)?;
            }
        }
        Ok(())
    }
}

/// Every file that stands inside an imported one, under the path that `File` parameters see.
fn embedded_files(scene: &Scene) -> Embedded {
    let arguments = scene.nodes.iter().flat_map(|node| &node.params);
    let embedded = arguments.filter_map(|argument| match &argument.value {
        Value::Bytes(name, bytes) => Some((name.as_ref().into(), bytes.clone())),
        _ => None,
    });
    embedded.collect()
}
