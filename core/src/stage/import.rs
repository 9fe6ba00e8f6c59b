//! Assets: nodes that name a file of another format, replaced by what the file holds.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DAffine3;
use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Kind};
use luxel_sdk::params::{Dimension, Param, Type, Unit};

use crate::cast::index;
use crate::diag::{Diagnostic, Span};
use crate::files::Files;
use crate::object::{Builder, ColorMode, Embedded, Objects, Reader};
use crate::registry::Registry;
use crate::scene::{Argument, Color, Group, GroupId, Node, NodeId, Placed, Scene, Target, Value};

/// The scene with every asset replaced by a group, and what was found wrong.
pub(super) fn expand(
    scene: &Scene,
    registry: &Registry,
    files: &dyn Files,
) -> (Scene, Vec<Diagnostic>) {
    let (out, done, cameras) = (scene.clone(), BTreeMap::new(), BTreeMap::new());
    let mut import = Import { registry, files, out, done, cameras };
    let mut diagnostics = vec![];
    for group in 0..scene.groups.len() {
        let mut items = std::mem::take(&mut import.out.groups[group].items);
        import.replace(scene, &mut items, &mut diagnostics);
        import.first_camera(Some(GroupId(index(group))), &items);
        import.out.groups[group].items = items;
    }
    let mut items = std::mem::take(&mut import.out.root.items);
    import.replace(scene, &mut items, &mut diagnostics);
    if let Some((camera, transform)) = import.first_camera(None, &items) {
        import.camera(camera, transform);
    }
    import.out.root.items = items;
    (import.out, diagnostics)
}

struct Import<'a> {
    registry: &'a Registry,
    files: &'a dyn Files,
    out: Scene,
    done: BTreeMap<NodeId, Option<GroupId>>,
    /// The first camera of each group that has one, in the group's frame.
    cameras: BTreeMap<GroupId, (NodeId, DAffine3)>,
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
        let object = builder.build(id);
        diagnostics.append(&mut builder.diagnostics);
        let object = object?;
        let embedded = Embedded::new();
        let reader = Reader::new(self.files, &embedded);
        let imported = object.fixed().importer().import(&reader);
        let warnings = reader.into_warnings();
        match imported {
            Ok(imported) => {
                for warning in warnings.iter().chain(&imported.warnings) {
                    diagnostics.push(Diagnostic::warning("E0417", node.span, warning));
                }
                Some(self.adopt(node, &imported))
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

    fn adopt(&mut self, asset: &Node, imported: &Imported) -> GroupId {
        let mut ids: Vec<Option<NodeId>> = vec![];
        for node in &imported.nodes {
            let replaced = asset.overrides.iter().find(|(name, _)| {
                node.kind == Kind::Material && **name == *identifier(&node.label)
            });
            let id = match replaced {
                Some((_, material)) => Some(*material),
                None => self.node(node, &ids, asset.span),
            };
            ids.push(id);
        }
        let mut group = Group { label: asset.label.clone(), items: vec![] };
        let mut camera = None;
        for (index, transform) in &imported.placed {
            let Some(id) = ids.get(*index).copied().flatten() else { continue };
            let (transform, span) = (*transform, asset.span);
            if self.out.node(id).kind == Kind::Camera {
                camera = camera.or(Some((id, transform)));
            } else {
                let target = Target::Node(id);
                group.items.push(Placed { target, transform, material: None, span });
            }
        }
        let id = self.group(group);
        self.cameras.extend(camera.map(|camera| (id, camera)));
        id
    }

    /// The first camera among things in their places, in the frame that these stand in; kept for
    /// the group. Groups are asked for before those that hold them.
    fn first_camera(
        &mut self,
        group: Option<GroupId>,
        items: &[Placed],
    ) -> Option<(NodeId, DAffine3)> {
        let found = items.iter().find_map(|item| {
            let Target::Group(inner) = item.target else { return None };
            let (id, transform) = *self.cameras.get(&inner)?;
            Some((id, item.transform * transform))
        });
        self.cameras.extend(group.zip(found));
        found
    }

    /// An asset's camera counts where the scene gives none; the first one that is placed.
    fn camera(&mut self, id: NodeId, transform: DAffine3) {
        if self.out.camera.is_some() {
            return;
        }
        let mut node = self.out.node(id).clone();
        for argument in &mut node.params {
            if let Value::Look(look) = &mut argument.value {
                look.from = transform.transform_point3(look.from);
                look.to = transform.transform_point3(look.to);
                look.up = transform.transform_vector3(look.up);
            }
        }
        self.out.camera = Some(self.out.add(node));
    }

    fn node(&mut self, node: &ImportNode, ids: &[Option<NodeId>], span: Span) -> Option<NodeId> {
        let class = self.registry.class(node.kind, &node.class)?;
        let mut params = vec![];
        for (name, value) in &node.params {
            let param = Registry::params(class).find(|param| param.name == *name)?;
            params.push(Argument { name: param.name, value: convert(param, value, ids)?, span });
        }
        Some(self.out.add(Node {
            kind: node.kind,
            class: Arc::from(class.name),
            label: (!node.label.is_empty()).then(|| Arc::from(node.label.as_str())),
            params,
            overrides: vec![],
            span,
            hash: [0; 32],
        }))
    }
}

/// A name in another format as an identifier of the language: other characters become `_`.
fn identifier(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

fn convert(param: &Param, value: &ImportValue, ids: &[Option<NodeId>]) -> Option<Value> {
    let own = || {
        let unit = param.unit.split('|').next().unwrap_or_default();
        Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
    };
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
        ImportValue::Vector(v) => Value::Vector(v.clone()),
        ImportValue::Text(text) => match param.ty {
            Type::File => Value::Path(text.into()),
            _ => Value::Text(text.as_str().into()),
        },
        ImportValue::Rgb(rgb) => Value::Color(Color::Rgb(*rgb), own()),
        ImportValue::Table(table) => Value::Table(table.clone()),
        ImportValue::Look(look) => Value::Look(*look),
        ImportValue::Bytes(name, bytes) => Value::Bytes(name.as_str().into(), bytes.clone()),
        ImportValue::Node(index) => Value::Node(ids.get(*index).copied().flatten()?),
    })
}
