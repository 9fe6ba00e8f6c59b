//! Assets: nodes that name a file of another format, replaced by what the file holds.

use std::collections::BTreeMap;
use std::sync::Arc;

use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Kind};
use luxel_sdk::params::{Dimension, Param, Type, Unit, leave};

use super::kept::{Assets, Brought};
use crate::accel::Watch;
use crate::cast::index;
use crate::diag::{Diagnostic, Span};
use crate::files::Files;
use crate::object::{Builder, ColorMode, Embedded, Objects, Reader};
use crate::registry::Registry;
use crate::registry::dynamic::FAILED;
use crate::scene::{
    Argument, Color, Given, Group, GroupId, Hash, Node, NodeId, Placed, Pose, Scene, Target, Value,
    conform,
};

/// The scene with every asset replaced by a group, what its assets were found to hold, and what was
/// found wrong. Files that were read `before` and have not changed are not read again. `None` once the
/// watch is cancelled.
pub(super) fn expand(
    scene: &Scene,
    (registry, files): (&Registry, &dyn Files),
    before: &Assets,
    watch: &Watch,
) -> Option<(Scene, Assets, Vec<Diagnostic>)> {
    let out = scene.copied(&|| watch.is_over())?;
    let (done, cameras) = (BTreeMap::new(), BTreeMap::new());
    let assets = Assets::default();
    let mut import = Import { registry, files, before, assets, watch, out, done, cameras };
    let mut diagnostics = vec![];
    for group in 0..scene.groups.len() {
        let mut items = std::mem::take(&mut import.out.groups[group].items);
        import.replace(scene, &mut items, &mut diagnostics);
        import.first_camera(Some(GroupId(index(group))), &items);
        import.out.groups[group].items = items;
    }
    let mut items = std::mem::take(&mut import.out.root.items);
    import.replace(scene, &mut items, &mut diagnostics);
    if let Some((camera, pose)) = import.first_camera(None, &items) {
        import.camera(camera, pose);
    }
    import.out.root.items = items;
    if watch.is_cancelled() {
        leave((import.out, import.assets));
        return None;
    }
    Some((import.out, import.assets, diagnostics))
}

struct Import<'a> {
    registry: &'a Registry,
    files: &'a dyn Files,
    before: &'a Assets,
    assets: Assets,
    watch: &'a Watch,
    out: Scene,
    done: BTreeMap<NodeId, Option<GroupId>>,
    /// The first camera of each group that has one, in the group's frame.
    cameras: BTreeMap<GroupId, (NodeId, Pose)>,
}

impl Import<'_> {
    fn replace(&mut self, scene: &Scene, items: &mut [Placed], diagnostics: &mut Vec<Diagnostic>) {
        for item in items {
            let Target::Node(id) = item.target else { continue };
            if scene.node(id).kind != Kind::Importer {
                continue;
            }
            let known = self.done.get(&id).copied();
            let group = known.unwrap_or_else(|| self.asset(scene, id, diagnostics));
            self.done.insert(id, group);
            if let Some(Value::Node(own)) = scene.node(id).get("material").map(|a| &a.value) {
                item.material = item.material.or(Some(*own));
            }
            // An asset that could not be read leaves an empty place; the error has been said.
            item.target = Target::Group(group.unwrap_or_else(|| self.group(Group::default())));
        }
    }

    fn group(&mut self, group: Group) -> GroupId {
        self.out.groups.push(group);
        GroupId(index(self.out.groups.len() - 1))
    }

    fn asset(
        &mut self,
        scene: &Scene,
        id: NodeId,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<GroupId> {
        let node = scene.node(id);
        let none = Objects::default();
        let mut builder = Builder::new(self.registry, scene, self.files, ColorMode::Rgb, &none);
        builder.watch = Some(self.watch);
        let object = builder.build(id);
        diagnostics.append(&mut builder.diagnostics);
        let object = object?;
        let embedded = Embedded::new();
        let may_stay = |it: &&Arc<Brought>| {
            it.importer.is_current(self.registry) && it.reads.are_unchanged(self.files, &embedded)
        };
        let mut wrong = Wrong::default();
        if let Some(kept) = self.before.all(node.hash).find(may_stay) {
            warn(node, kept, diagnostics);
            let (group, _) = self.adopt(node, (&kept.imported, &kept.hashes), &mut wrong);
            wrong.tell(node, diagnostics);
            self.assets.put(node.hash, kept.clone());
            return Some(group);
        }
        let reader = Reader::new(self.files, &embedded).watched(Some(self.watch));
        let imported = object.fixed().importer().import(&reader);
        let (reads, warnings) = reader.finish();
        match imported {
            Ok(imported) => {
                let (group, hashes) = self.adopt(node, (&imported, &[]), &mut wrong);
                let brought = Brought { importer: object, reads, imported, warnings, hashes };
                warn(node, &brought, diagnostics);
                wrong.tell(node, diagnostics);
                self.assets.put(node.hash, Arc::new(brought));
                Some(group)
            }
            Err(faults) => {
                for fault in faults {
                    let span = node.get(fault.field).map_or(node.span, |argument| argument.span);
                    diagnostics.push(Diagnostic::error(fault.code, span, fault.message));
                }
                None
            }
        }
    }

    /// The group of what a file holds, and the hashes of its nodes, of which some may be known.
    fn adopt(
        &mut self,
        asset: &Node,
        (imported, known): (&Imported, &[Hashes]),
        wrong: &mut Wrong,
    ) -> (GroupId, Vec<Hashes>) {
        let mut ids: Vec<Option<NodeId>> = vec![];
        for node in &imported.nodes {
            let replaced = asset.overrides.iter().find(|(name, _)| {
                node.kind == Kind::Material && **name == *identifier(&node.label)
            });
            let id = match replaced {
                Some((_, material)) => Some(*material),
                None => match self.node(node, &ids, asset.span, known.get(ids.len())) {
                    Ok(id) => Some(id),
                    Err(why) => {
                        let ImportNode { kind, class, .. } = node;
                        wrong.add(|| format!("node {} ({kind} `{class}`) {why}", ids.len()));
                        None
                    }
                },
            };
            ids.push(id);
        }
        let mut group = Group { label: asset.label.clone(), items: vec![] };
        let mut camera = None;
        for (index, transform) in &imported.placed {
            let Some(id) = ids.get(*index) else {
                wrong.add(|| format!("it places node {index} of {}", ids.len()));
                continue;
            };
            // What is wrong with a node that was not made has been said.
            let Some(id) = *id else { continue };
            let (pose, span) = (Pose::from(*transform), asset.span);
            match self.out.node(id).kind {
                Kind::Camera => camera = camera.or(Some((id, pose))),
                Kind::Shape | Kind::Light => {
                    let target = Target::Node(id);
                    group.items.push(Placed { target, pose, material: None, span });
                }
                kind => wrong.add(|| format!("it places node {index}, which is a {kind}")),
            }
        }
        let id = self.group(group);
        self.cameras.extend(camera.map(|camera| (id, camera)));
        let hashes = |id: NodeId| [self.out.node(id).hash, self.out.own_hash(id)];
        (id, ids.into_iter().map(|id| id.map(hashes)).collect())
    }

    /// The first camera among things in their places, in the frame that these stand in; kept for
    /// the group. Groups are asked for before those that hold them.
    fn first_camera(&mut self, group: Option<GroupId>, items: &[Placed]) -> Option<(NodeId, Pose)> {
        let found = items.iter().find_map(|item| {
            let Target::Group(inner) = item.target else { return None };
            let (id, pose) = self.cameras.get(&inner)?;
            Some((*id, pose.then(&item.pose)))
        });
        self.cameras.extend(group.zip(found.clone()));
        found
    }

    /// An asset's camera counts where the scene gives none; the first one that is placed.
    fn camera(&mut self, id: NodeId, pose: Pose) {
        if self.out.camera.is_none() {
            (self.out.camera, self.out.camera_pose) = (Some(id), pose);
        }
    }

    fn node(
        &mut self,
        node: &ImportNode,
        ids: &[Option<NodeId>],
        span: Span,
        known: Option<&Hashes>,
    ) -> Result<NodeId, String> {
        if !MADE.contains(&node.kind) {
            return Err("is of a kind that no file holds".to_owned());
        }
        let class = self.registry.class(node.kind, &node.class).ok_or("is of no known class")?;
        let mut params: Vec<Argument> = vec![];
        for (name, value) in &node.params {
            let param = Registry::params(class).find(|param| param.name == *name);
            let param = param.ok_or_else(|| format!("has no parameter `{name}`"))?;
            let value = convert(param, value, ids)
                .ok_or_else(|| format!("has a `{name}` that is not there: {value:?}"))?;
            self.suits(param, &value)?;
            params.push(Argument { name: param.name, value, span });
        }
        let given = |name| params.iter().any(|argument| argument.name == name);
        let mut needed = Registry::params(class).filter(|p| p.required && p.group.is_empty());
        if let Some(lacking) = needed.find(|param| !given(param.name)) {
            return Err(format!("lacks `{}`", lacking.name));
        }
        let mut made = Node {
            kind: node.kind,
            class: class.name,
            label: (!node.label.is_empty()).then(|| Arc::from(node.label.as_str())),
            params: params.into(),
            overrides: vec![],
            span,
            hash: [0; 32],
        };
        let Some([hash, own]) = known.copied().flatten() else { return Ok(self.out.add(made)) };
        made.hash = hash;
        Ok(self.out.add_hashed(made, own))
    }

    /// Whether a value is of the parameter's type. Numbers beyond its range are left to the class:
    /// files of other formats know other ranges.
    fn suits(&self, param: &Param, value: &Value) -> Result<(), String> {
        let dimension = own_dimension(param);
        let given = match value.clone() {
            Value::Bool(b) => Given::Bool(b),
            Value::Number(x, dimension) => Given::Number(x, dimension),
            Value::Vector(v) => Given::Numbers(v.as_slice().into(), dimension),
            Value::Table(table) => Given::Numbers(table, dimension),
            Value::Text(text) => Given::Text(text),
            Value::Path(path) => Given::Path(path),
            Value::Bytes(name, bytes) => Given::Bytes(name, bytes),
            Value::Color(color, dimension) => Given::Color(color, dimension),
            Value::Look(look) => Given::Look(*look),
            Value::Node(id) | Value::Moved(id, _) => Given::Node(id, self.out.node(id).kind),
        };
        match conform(param, given, &|_| None) {
            Err(misfit) if !["E0405", "E0210"].contains(&misfit.code) => Err(misfit.message),
            _ => Ok(()),
        }
    }
}

/// Of a node that was made: its hash, and the one without what all of its kind may have. The same file,
/// asked for in the same words, has the same.
type Hashes = Option<[Hash; 2]>;

fn warn(asset: &Node, Brought { imported, warnings, .. }: &Brought, told: &mut Vec<Diagnostic>) {
    let warnings = warnings.iter().chain(&imported.warnings);
    told.extend(warnings.map(|warning| Diagnostic::warning("E0417", asset.span, warning)));
}

/// Kinds of node that a file of another format may hold.
const MADE: [Kind; 7] = [
    Kind::Shape,
    Kind::Material,
    Kind::Texture,
    Kind::Light,
    Kind::Medium,
    Kind::Phase,
    Kind::Camera,
];

/// What an importer got wrong: our mistake or a library's, never the file's.
#[derive(Default)]
struct Wrong {
    told: Vec<String>,
    n: usize,
}

impl Wrong {
    /// Most that are told one by one.
    const MOST: usize = 8;

    fn add(&mut self, told: impl FnOnce() -> String) {
        self.n += 1;
        if self.n <= Self::MOST {
            self.told.push(told());
        }
    }

    fn tell(mut self, asset: &Node, diagnostics: &mut Vec<Diagnostic>) {
        if self.n > Self::MOST {
            self.told.push(format!("{} more faults", self.n - Self::MOST));
        }
        let class = &asset.class;
        diagnostics.extend(self.told.into_iter().map(|told| {
            let message = format!("what the importer `{class}` gives is wrong: {told}");
            Diagnostic::error(FAILED, asset.span, message)
        }));
    }
}

/// The dimension of a parameter's first unit.
fn own_dimension(param: &Param) -> Dimension {
    let unit = param.unit.split('|').next().unwrap_or_default();
    Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
}

/// A name in another format as an identifier of the language: other characters become `_`.
fn identifier(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

fn convert(param: &Param, value: &ImportValue, ids: &[Option<NodeId>]) -> Option<Value> {
    let own = || own_dimension(param);
    Some(match value {
        ImportValue::Bool(b) => Value::Bool(*b),
        ImportValue::Number(x) => match param.ty {
            Type::Spectrum | Type::ComplexIor => Value::Color(Color::Constant(*x), own()),
            _ => Value::Number(*x, own()),
        },
        ImportValue::Quantity(x, unit) => {
            let unit = Unit::parse(unit).ok()?;
            Value::Number(x * unit.scale, unit.dimension)
        }
        ImportValue::Vector(v) => Value::Vector(v.as_slice().try_into().ok()?),
        ImportValue::Text(text) => match param.ty {
            Type::File => Value::Path(text.into()),
            _ => Value::Text(text.as_str().into()),
        },
        ImportValue::Rgb(rgb) => Value::Color(Color::Rgb(*rgb), own()),
        ImportValue::Table(table) => Value::Table(table.clone()),
        ImportValue::Look(look) => Value::look(*look),
        ImportValue::Bytes(name, bytes) => Value::Bytes(name.as_str().into(), bytes.clone()),
        ImportValue::Node(index) => Value::Node(ids.get(*index).copied().flatten()?),
    })
}
