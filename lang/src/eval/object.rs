//! Objects: fields against the schema of their class, and what becomes of them in the scene.

use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::registry::{Registry, common_params};
use luxel_core::scene::{Argument, GroupId, Node, NodeId, Pose, Value as Fitted};
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type};

use super::elsewhere::{self, form, meant};
use super::env::Env;
use super::exec::{Body, Place};
use super::value::{FieldValue, Head, ObjectValue, Value, What};
use super::{Evaluator, OpenGroup};
use crate::syntax::{Name, Object};

/// Bytes between two parameters of one object that are looked through.
const BESIDE: usize = 1 << 12;
/// Fields before and behind one that are told with it.
const NEIGHBOURS: usize = 8;

/// What the fields of an object came to.
struct Taken {
    params: Vec<Argument>,
    overrides: Vec<(Arc<str>, NodeId)>,
    pose: Pose,
    /// How deep objects stand in it.
    depth: usize,
    /// Of each name that is no parameter, the one that was probably meant.
    meant: Vec<Option<&'static str>>,
    /// Nothing is wrong with where it stands, its material and what fills it, nor with the rest.
    is_placed: bool,
    /// Something is wrong with what its class takes.
    lacks_own: bool,
}

impl Evaluator<'_> {
    /// The object that an expression or statement describes; `within` is the class of the object in which
    /// it stands without a name.
    pub(super) fn object(&mut self, object: &Object, env: &Env, within: Option<&Class>) -> Value {
        let span = object.category.span.to(object.body.span);
        if &*object.category.text == "group" {
            if let Some(name) = &object.kind {
                let message = "a group is of no kind: its label is a text";
                let found = Diagnostic::error("E0401", name.span, message);
                let is_labelled = object.label.is_some();
                let label = if is_labelled { String::new() } else { format!("\"{}\"", name.text) };
                let all = object.category.span.to(name.span);
                let named = format!("let {} = group", name.text);
                self.tell(found.guess(name.span, label).guess(all, named));
            }
            return self.group(object, span, env);
        }
        let head = self.head(object, span, within, Some(env));
        let mut body = Body::new(Place::Object);
        let class = |head: &Head| self.registry.class(head.kind?, &head.class.text);
        let known = head.as_ref().map_or_else(|meant| meant.as_ref(), Some);
        body.class = known.and_then(class).copied();
        self.block(&object.body, env, &mut body);
        self.tell_strays(&mut body);
        match head {
            Ok(head) if body.is_whole() => self.build(&head, body.fields),
            head => {
                self.damaged = true;
                let head = head.map_or_else(|meant| meant, Some);
                if let (Some(head), Some(class), false) = (head, body.class, body.broken) {
                    self.look_over(&head, &class, &body);
                }
                Value::Poison
            }
        }
    }

    /// Tells what is wrong with an object beside fields of it that cannot be read.
    fn look_over(&mut self, head: &Head, class: &Class, body: &Body) {
        let mut meant = self.taken(class, &body.fields).meant;
        meant.extend(&body.meant);
        for span in &body.unread {
            let text = self.written(*span);
            let word = text.trim_start().split(|c: char| !c.is_alphanumeric() && c != '_').next();
            let known = Registry::params(class).map(|param| param.name);
            // What begins with no parameter may be any, and so may what goes on in other lines.
            let name = near(word.unwrap_or(""), known).map(|near| near.name);
            meant.push(name.filter(|_| !text.trim().contains('\n') && !has_nameless(text)));
        }
        self.complete(class, head, &body.fields, &meant);
    }

    fn group(&mut self, object: &Object, span: Span, env: &Env) -> Value {
        self.open_groups.push(OpenGroup::default());
        let mut body = Body::new(Place::Group);
        self.block(&object.body, env, &mut body);
        let open = self.open_groups.pop().unwrap_or_default();
        let mut group = open.group;
        group.label = object.label.as_ref().map(|label| label.text.clone());
        let (pose, material) = self.group_fields(&body.fields);
        let held = self.hold_object(body.fields.len(), span);
        let id = GroupId(u32::try_from(self.scene.groups.len()).unwrap_or(u32::MAX));
        self.scene.groups.push(group);
        let head =
            Head { kind: None, class: object.category.clone(), label: object.label.clone(), span };
        Value::Object(Rc::new(ObjectValue {
            what: What::Group(id, material),
            fields: body.fields,
            pose,
            head,
            depth: open.depth + 1,
            instances: open.instances.max(1),
            held,
        }))
    }

    /// The transform and material of a group or a placement.
    pub(super) fn group_fields(&mut self, fields: &[FieldValue]) -> (Pose, Option<NodeId>) {
        let (mut pose, mut material) = (Pose::Here, None);
        self.given_twice(fields.iter().map(|field| &field.name));
        for (i, field) in fields.iter().enumerate() {
            match &*field.name.text {
                "transform" => {
                    pose = self.transform(&field.value, field.span).unwrap_or_default();
                }
                "material" => material = self.node_of(field, Kind::Material),
                _ => {
                    let known = ["transform", "material"];
                    let _ = self.unknown((fields, i), "a group or placement", &known);
                }
            }
        }
        (pose, material)
    }

    /// `object with { … }`: the same object with some fields given anew.
    pub(super) fn amend(&mut self, value: Value, fields: Vec<FieldValue>, span: Span) -> Value {
        let (old, is_kept) = match &value {
            Value::Object(object) => (object.fields.len(), 0),
            Value::Record(record) => (record.fields.len(), 1),
            _ => (0, 0),
        };
        let all = old + fields.len();
        if !self.tick((old * fields.len()) as u64, span)
            || !self.hold(is_kept * all * size_of::<FieldValue>(), span)
        {
            return Value::Poison;
        }
        match value {
            Value::Object(object) if object.head.kind.is_some() => {
                let all = merged(&object.fields, fields);
                self.build(&object.head, all)
            }
            Value::Object(object) => {
                let mut all: Vec<FieldValue> = merged(&object.fields, fields);
                let (pose, material) = self.group_fields(&all);
                let What::Group(id, _) = object.what else { return Value::Poison };
                let fields = std::mem::take(&mut all);
                let what = What::Group(id, material);
                let held = self.hold_object(fields.len(), span);
                let (head, depth) = (object.head.clone(), object.depth);
                let instances = object.instances;
                let made = ObjectValue { what, fields, pose, head, depth, instances, held };
                Value::Object(Rc::new(made))
            }
            Value::Record(old) => self.shallow(Value::record(merged(&old.fields, fields)), span),
            Value::Poison => Value::Poison,
            other => {
                let message =
                    format!("`with` changes objects and records, not {}", other.describe());
                self.poison("E0214", span, message)
            }
        }
    }

    /// Makes a node of fields that are checked against the schema.
    pub(super) fn build(&mut self, head: &Head, fields: Vec<FieldValue>) -> Value {
        let Some(class) = head.kind.and_then(|kind| self.registry.class(kind, &head.class.text))
        else {
            return Value::Poison;
        };
        let class = *class;
        let before = self.mistakes();
        let taken = self.taken(&class, &fields);
        self.complete(&class, head, &fields, &taken.meant);
        let Taken { params, overrides, pose, depth, is_placed, lacks_own, .. } = taken;
        if depth >= self.budgets.nesting {
            let message = format!("objects stand in one another more than {depth} deep");
            return self.poison("E0507", head.span, message);
        }
        let is_whole = !lacks_own && self.mistakes() == before && self.count_node(head.span);
        if !is_whole {
            return Value::Poison;
        }
        let node = Node {
            kind: class.kind,
            class: class.name,
            label: head.label.as_ref().map(|label| self.label_text(&label.text)),
            params: params.into(),
            overrides,
            span: head.span,
            hash: [0; 32],
        };
        let id = self.add(node);
        if !is_placed {
            self.orphans.push(id);
            return Value::Poison;
        }
        let what = What::Node(id, class.kind);
        let held = self.hold_object(fields.len(), head.span);
        let head = head.clone();
        let depth = depth + 1;
        Value::Object(Rc::new(ObjectValue { what, fields, pose, head, depth, instances: 1, held }))
    }

    /// Fields of an object, as far as they fit its class.
    fn taken(&mut self, class: &Class, fields: &[FieldValue]) -> Taken {
        let mut out = Taken {
            params: Vec::with_capacity(fields.len()),
            overrides: vec![],
            pose: Pose::Here,
            depth: 0,
            meant: vec![],
            is_placed: true,
            lacks_own: false,
        };
        // What stands there twice may have been meant for any.
        if self.given_twice(fields.iter().map(|field| &field.name)) {
            out.meant.push(None);
        }
        for (i, field) in fields.iter().enumerate() {
            let Some(param) = Registry::params(class).find(|p| p.name == &*field.name.text) else {
                match &*field.name.text {
                    "transform" if stands_somewhere(class.kind) => {
                        let found = self.transform(&field.value, field.span);
                        out.is_placed &= found.is_some();
                        out.pose = out.pose.then(&found.unwrap_or_default());
                    }
                    "materials" if class.kind == Kind::Importer => {
                        out.overrides = self.materials(field, &mut out.is_placed);
                    }
                    _ => out.meant.extend(self.unknown_param(class, fields, i)),
                }
                continue;
            };
            self.deprecated(param, field, fields);
            if let Value::Object(inner) = &field.value {
                out.depth = out.depth.max(inner.depth);
                if param.ty != Type::Part {
                    let pose = std::mem::replace(&mut out.pose, Pose::Here);
                    out.pose = self.lifted(class, inner, field.span, pose);
                }
            }
            if let Some(value) = self.conform(param, field) {
                out.params.push(self.in_its_place(value, param, field));
            } else {
                out.is_placed = false;
                out.lacks_own |= common_params(class.kind).iter().all(|it| it.name != param.name);
            }
        }
        out
    }

    /// Keeps a node; its hash is computed when the scene is complete.
    fn add(&mut self, node: Node) -> NodeId {
        let id = NodeId(u32::try_from(self.scene.nodes.len()).unwrap_or(u32::MAX));
        self.scene.nodes.push(node);
        id
    }

    /// The text of a label, one for objects of the same that follow one another.
    fn label_text(&mut self, text: &Arc<str>) -> Arc<str> {
        if self.last_label != *text {
            self.last_label = text.clone();
        }
        self.last_label.clone()
    }

    /// `materials = { name = material, … }`: what takes the place of an asset's own.
    fn materials(&mut self, field: &FieldValue, is_placed: &mut bool) -> Vec<(Arc<str>, NodeId)> {
        let Value::Record(record) = &field.value else {
            let message = "`materials` is a record: `{ name_in_the_file = material, … }`";
            self.poison("E0214", field.span, message);
            return vec![];
        };
        let mut out = vec![];
        for entry in &record.fields {
            match self.node_of(entry, Kind::Material) {
                Some(id) => out.push((entry.name.text.clone(), id)),
                None => *is_placed = false,
            }
        }
        out
    }

    /// A shape that shines stands where its light does: the shape's transform becomes the light's.
    fn lifted(&mut self, class: &Class, inner: &ObjectValue, span: Span, pose: Pose) -> Pose {
        if inner.pose.is_identity() {
            return pose;
        }
        if class.kind == Kind::Light {
            return inner.pose.then(&pose);
        }
        let message = format!("a {} inside a {} has no place of its own", inner.word(), class.kind);
        let diagnostic = Diagnostic::error("E0418", span, message);
        self.tell(diagnostic.help("leave its `transform` out"));
        pose
    }

    /// What a field gives a parameter. A shape that is a part of another keeps its transform.
    fn in_its_place(&mut self, value: Fitted, param: &Param, field: &FieldValue) -> Argument {
        let value = match (value, &field.value) {
            (Fitted::Node(id), Value::Object(part)) if param.ty == Type::Part => match &part.pose {
                Pose::Here => Fitted::Node(id),
                Pose::Fixed(transform) => Fitted::Moved(id, Arc::clone(transform)),
                Pose::Moving(_) => {
                    let message = "a part of a solid does not move in it";
                    let told = Diagnostic::error("E0418", field.span, message);
                    self.tell(told.help("let the whole solid move"));
                    Fitted::Node(id)
                }
            },
            (value, _) => value,
        };
        Argument { name: param.name, value, span: field.span }
    }

    /// Tells of fields that have the name of one before; whether there are any.
    pub(super) fn given_twice<'n>(&mut self, names: impl Iterator<Item = &'n Name>) -> bool {
        let mut any = false;
        let mut firsts: BTreeMap<&str, Span> = BTreeMap::new();
        for name in names {
            let first = *firsts.entry(&name.text).or_insert(name.span);
            if first != name.span {
                let message = format!("`{}` is given twice", name.text);
                let diagnostic = Diagnostic::error("E0404", name.span, message);
                self.tell(diagnostic.label(first, "first given here"));
                any = true;
            }
        }
        any
    }

    fn deprecated(&mut self, param: &Param, field: &FieldValue, all: &[FieldValue]) {
        if param.deprecated.is_empty() {
            return;
        }
        let message = format!("`{}` is now called `{}`", param.name, param.deprecated);
        let found = Diagnostic::warning("E0410", field.name.span, message);
        self.tell(match all.iter().find(|other| &*other.name.text == param.deprecated) {
            Some(new) => found.label(new.name.span, "it is given here as well"),
            None => found.fix(field.name.span, param.deprecated),
        });
    }

    /// Tells of a field, by its number, that the class does not have; gives the parameters that were
    /// probably meant, `None` for any.
    pub(super) fn unknown_param(
        &mut self,
        class: &Class,
        all: &[FieldValue],
        i: usize,
    ) -> Vec<Option<&'static str>> {
        let mut known: Vec<&'static str> =
            Registry::params(class).filter(|p| p.deprecated.is_empty()).map(|p| p.name).collect();
        if stands_somewhere(class.kind) {
            known.push("transform");
        }
        if class.kind == Kind::Importer {
            known.push("materials");
        }
        self.unknown((all, i), &format!("{} {}", class.kind, class.name), &known)
    }

    /// Tells of the name of a field among others that is no parameter; gives those that were probably
    /// meant. What is given is not offered again, and what neighbours also mean is told once.
    fn unknown(
        &mut self,
        (all, i): (&[FieldValue], usize),
        what: &str,
        known: &[&'static str],
    ) -> Vec<Option<&'static str>> {
        let name = &all[i].name;
        let (form, near) = (form(&name.text, known), meant(&name.text, known));
        let meant: Vec<_> = match form {
            Some(form) => form.ours.iter().copied().map(Some).collect(),
            None => vec![near.map(|near| near.name)],
        };
        let is_beside = |other: &&FieldValue| self.is_beside(other.name.span, name.span);
        let is_same = |other: &&FieldValue| {
            let other = elsewhere::form(&other.name.text, known);
            form.zip(other).is_some_and(|(form, other)| std::ptr::eq(form, other))
        };
        let before = &all[i.saturating_sub(NEIGHBOURS)..i];
        if before.iter().rev().filter(is_same).any(|other| is_beside(&other)) {
            return meant;
        }
        let after = &all[i + 1..all.len().min(i + 1 + NEIGHBOURS)];
        let others: Vec<_> = after.iter().filter(is_same).filter(is_beside).collect();
        let same: Vec<&Name> = [&all[i]].into_iter().chain(others).map(|it| &it.name).collect();
        let names: Vec<_> = same.iter().map(|name| format!("`{}`", name.text)).collect();
        let message = match &names[..] {
            [] | [_] => format!("`{what}` has no parameter `{}`", name.text),
            [several @ .., last] => {
                format!("`{what}` has no parameters {} and {last}", several.join(", "))
            }
        };
        let given = |ours: Option<&str>| {
            let is_ours = |other: &&FieldValue| ours == Some(&*other.name.text);
            all.iter().filter(is_ours).find(is_beside)
        };
        let all_given: Option<Vec<_>> = meant.iter().map(|ours| given(*ours)).collect();
        let mut found = Diagnostic::error("E0402", name.span, message);
        for other in same.iter().skip(1) {
            found = found.label(other.span, "and this one");
        }
        let found = match (all_given.as_deref(), form) {
            (Some([given, ..]), _) => found.label(given.name.span, "this one is given already"),
            (_, Some(form)) => found.help(format!("it is written `{}`", form.written)),
            (_, None) => found.meant(name.span, near),
        };
        self.tell(found.help(format!("known are {}", known.join(", "))));
        meant
    }

    /// Whether two names stand in the same braces, not one of them in a `set` or `with`.
    fn is_beside(&self, one: Span, other: Span) -> bool {
        let (start, end) = (one.end.min(other.end), one.start.max(other.start));
        let text = self.written(Span { start, end, ..one });
        let mut depth = 0_usize;
        let stays = |byte: u8| {
            match byte {
                b'{' => depth += 1,
                b'}' if depth == 0 => return false,
                b'}' => depth -= 1,
                _ => {}
            }
            true
        };
        let is_near = one.source == other.source && text.len() <= BESIDE;
        is_near && text.bytes().all(stays) && depth == 0
    }
}

/// Whether objects of a class are given something of this name.
pub(super) fn has_param(class: &Class, name: &str) -> bool {
    let is_known = Registry::params(class).any(|param| param.name == name);
    let is_place = name == "transform" && stands_somewhere(class.kind);
    is_known || is_place || name == "materials" && class.kind == Kind::Importer
}

/// Whether objects of a kind stand in the scene and so take a `transform`.
pub(super) fn stands_somewhere(kind: Kind) -> bool {
    matches!(kind, Kind::Shape | Kind::Light | Kind::Importer | Kind::Camera)
}

/// Fields with some given anew, which take the place of old ones.
pub(super) fn merged(old: &[FieldValue], new: Vec<FieldValue>) -> Vec<FieldValue> {
    let kept = old.iter().filter(|f| !new.iter().any(|n| n.name.text == f.name.text));
    let mut out: Vec<FieldValue> = kept.cloned().collect();
    out.extend(new);
    out
}

/// Whether a value stands in a text that no name stands before.
fn has_nameless(text: &str) -> bool {
    text.match_indices('=').any(|(at, _)| {
        let before = text[..at].trim_end_matches([' ', '\t']);
        before.is_empty() || before.ends_with([',', ';', '{', '\n'])
    })
}
