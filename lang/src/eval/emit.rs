//! What statements put into the scene, and the labels that `set` reaches.

use std::collections::{BTreeMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_core::scene::{NodeId, Placed, Pose, Target};
use luxel_sdk::kind::Kind;
use memchr::memmem;

use super::Evaluator;
use super::env::Env;
use super::exec::{Body, Place};
use super::value::{FieldValue, ObjectValue, Value, What};
use crate::syntax::{Block, Expr, Name, Stmt, StmtNode};

/// Labelled objects, and what `set` will change of them.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// Objects by label, of those that may be set; `None` for one with a mistake, or out of the scene by
    /// `@off`.
    pub(super) objects: BTreeMap<Arc<str>, Vec<Option<Rc<ObjectValue>>>>,
    pub(super) sets: Vec<Set>,
    /// Whether something may be set.
    keeps: bool,
    /// The labels of which something may be set, where not of all.
    named: Option<HashSet<Box<str>>>,
}

/// `set label.field = value`.
#[derive(Debug)]
pub(super) struct Set {
    pub(super) label: Name,
    pub(super) field: FieldValue,
}

impl Labels {
    /// Those of a file of this text: objects are kept only where some `set` may change them.
    pub(super) fn of(text: &str) -> Self {
        let has = |word: &str| memmem::find(text.as_bytes(), word.as_bytes()).is_some();
        let is_alone = !["include", "import"].into_iter().any(has);
        let named = is_alone.then(|| set_names(text)).flatten();
        let keeps = named.as_ref().is_none_or(|named| !named.is_empty());
        Self { keeps, named, ..Self::default() }
    }

    /// How many objects bear a label.
    pub(super) fn n_of(&self, label: &str) -> usize {
        self.objects.get(label).map_or(0, Vec::len)
    }

    /// From here on, objects are kept or not.
    pub(super) fn keep(&mut self, keeps: bool) {
        self.keeps = keeps;
    }

    /// Notes an emitted object.
    pub(super) fn add(&mut self, label: Option<&Name>, value: &Value) {
        let Some(label) = label.filter(|_| self.keeps) else { return };
        let object = match value {
            Value::Object(object) => Some(object.clone()),
            _ => None,
        };
        let objects = self.objects.entry(label.text.clone()).or_default();
        if self.named.as_ref().is_none_or(|named| named.contains(&*label.text)) {
            objects.push(object);
        }
    }

    /// Notes the labels in a statement that is off: `set` may name them.
    pub(super) fn off(&mut self, stmt: &Stmt) {
        match &stmt.node {
            StmtNode::Object(object) => {
                self.add(object.label.as_ref(), &Value::Poison);
                object.body.stmts.iter().for_each(|stmt| self.off(stmt));
            }
            StmtNode::For { body, .. } => body.stmts.iter().for_each(|stmt| self.off(stmt)),
            StmtNode::If { arms, otherwise } => {
                let blocks = arms.iter().map(|(_, block)| block).chain(otherwise.as_deref());
                blocks.flat_map(|block| &block.stmts).for_each(|stmt| self.off(stmt));
            }
            _ => {}
        }
    }
}

/// The names that stand behind `set`, wherever these letters are; `None` if something else does.
fn set_names(text: &str) -> Option<HashSet<Box<str>>> {
    let name = |at: usize| {
        let rest = text[at + "set".len()..].trim_start();
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        (!rest.starts_with('/')).then(|| rest[..end].into())
    };
    memmem::find_iter(text.as_bytes(), "set").map(name).collect()
}

impl Evaluator<'_> {
    /// Puts an object into the scene: into the group that is open, or into the scene's slot.
    pub(super) fn emit(&mut self, value: &Value, span: Span) {
        let Value::Object(object) = value else {
            self.damaged = true;
            return;
        };
        match object.what {
            What::Group(id, material) => {
                self.put(object, Target::Group(id), &Pose::Here, material, span);
            }
            What::Node(id, kind) => match kind {
                Kind::Shape | Kind::Light | Kind::Importer => {
                    self.put(object, Target::Node(id), &Pose::Here, None, span);
                }
                Kind::Material | Kind::Texture | Kind::Phase => {
                    let message = format!("a {kind} that stands alone is seen nowhere");
                    self.tell(
                        Diagnostic::warning("E0420", span, message)
                            .help(format!("give it a name: `let name = {kind} …`")),
                    );
                }
                kind => self.fill_slot(kind, id, object, span),
            },
        }
    }

    fn fill_slot(&mut self, kind: Kind, id: NodeId, object: &ObjectValue, span: Span) {
        if self.quiet > 0 {
            return;
        }
        if let Some((_, first)) = self.slots.iter().find(|(given, _)| *given == kind) {
            let code = if kind == Kind::Camera { "E0409" } else { "E0419" };
            let message = format!("a second {kind}: a scene has one");
            let diagnostic = Diagnostic::error(code, span, message).label(*first, "the first one");
            self.tell(diagnostic.help("`@off` before a statement takes it out of the scene"));
            return;
        }
        self.slots.push((kind, span));
        if kind == Kind::Camera {
            self.scene.camera_pose = object.pose.clone();
        }
        if let Some(slot) = self.scene.slot_mut(kind) {
            *slot = Some(id);
        }
    }

    /// Puts a target into the open group; `outer` is applied after the object's own transform.
    fn put(
        &mut self,
        object: &ObjectValue,
        target: Target,
        outer: &Pose,
        material: Option<NodeId>,
        span: Span,
    ) {
        if !self.count_node(span) {
            return;
        }
        if matches!(object.what, What::Node(_, Kind::Importer)) {
            self.has_asset = true;
        }
        let pose = object.pose.then(outer);
        let limit = self.budgets.instances;
        let Some(open) = self.open_groups.last_mut() else { return };
        open.depth = open.depth.max(object.depth);
        open.instances = open.instances.saturating_add(object.instances);
        open.group.items.push(Placed { target, pose, material, span });
        let (instances, depth) = (open.instances, open.depth);
        if instances > limit {
            let message = format!("more than {limit} things stand in the scene");
            self.over_budget("E0501", span, message, "instances");
        } else if depth >= self.budgets.nesting {
            let message = format!("groups stand in one another more than {depth} deep");
            self.over_budget("E0507", span, message, "nesting");
        }
    }

    /// Counts a node or placement; `false` when there may be no more.
    pub(super) fn count_node(&mut self, span: Span) -> bool {
        self.placements += 1;
        if self.placements > self.budgets.nodes && !self.stopped {
            let message = format!("the scene has more than {} nodes", self.budgets.nodes);
            self.over_budget("E0501", span, message, "nodes");
        }
        !self.stopped
    }

    /// `place x "label" { transform = …, material = … }`.
    pub(super) fn place(
        &mut self,
        what: &Expr,
        label: Option<&Name>,
        block: Option<&Block>,
        span: Span,
        env: &Env,
    ) {
        let value = self.eval(what, env);
        let mut body = Body::new(Place::Object);
        if let Some(block) = block {
            self.block(block, env, &mut body);
        }
        // `place sphere { radius = 1 m }`: its fields are those of another statement, as is told.
        let is_class = |kind| self.registry.class(kind, self.written(what.span)).is_some();
        if self.unknown.contains(&what.span) && [Kind::Shape, Kind::Light].into_iter().any(is_class)
        {
            self.damaged = true;
            return;
        }
        let (outer, material) = self.group_fields(&body.fields);
        let object = match &value {
            Value::Object(object) => object.clone(),
            Value::Poison => {
                self.labels.add(label, &Value::Poison);
                self.damaged = true;
                return;
            }
            other => {
                let message = format!("only objects can be placed, not {}", other.describe());
                self.poison("E0408", what.span, message);
                return;
            }
        };
        self.labels.add(label, &value);
        match object.what {
            What::Group(id, own) => {
                self.put(&object, Target::Group(id), &outer, material.or(own), span);
            }
            What::Node(id, Kind::Shape | Kind::Light | Kind::Importer) => {
                self.put(&object, Target::Node(id), &outer, material, span);
            }
            What::Node(_, kind) => {
                let message =
                    format!("a {kind} has no place: only shapes, lights, groups and assets");
                self.poison("E0408", what.span, message);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_behind_set_are_those_of_which_something_may_be_set() {
        let named = |text: &str| {
            let mut all: Vec<_> = set_names(text)?.into_iter().map(String::from).collect();
            all.sort();
            Some(all)
        };
        assert_eq!(
            named("set one.radius = 1\nset\t größe_2\n.x = 1"),
            Some(vec!["größe_2".into(), "one".into()])
        );
        // More than there are, but never less.
        assert_eq!(named("offset ball"), Some(vec!["ball".into()]));
        assert_eq!(named("set // one\n one.radius = 1"), None);
        assert_eq!(named("shape sphere \"one\" { }"), Some(vec![]));
        assert_eq!(named("set"), Some(vec![String::new()]));
    }
}
