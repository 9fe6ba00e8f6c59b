//! Statements that only hand a value on, as `radius = r` and `radius = r / 2` do: where that has changed,
//! the parameters that it became get the new value, and nothing of the statement is evaluated.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::Span;
use luxel_core::registry::Registry;
use luxel_core::scene::{self, Changed, IsOver, Node, NodeId};
use luxel_sdk::kind::Kind;

use super::formula::Formula;
use super::values::KeptValues;
use super::{State, Statement, source_of};
use crate::eval::Evaluator;
use crate::eval::env::Env;
use crate::eval::object::stands_somewhere;
use crate::eval::value::{FieldValue, ObjectValue, Value};
use crate::shares;
use crate::syntax::{Expr, ExprNode, Name, Object, Stmt, StmtNode, children};
use crate::values::Layer;

/// Expressions that are looked at, at most, by each thread: what is reckoned with others is evaluated.
const FORMULAS: usize = 1 << 10;

/// What hands on changed values.
#[derive(Debug, Default)]
pub(super) struct Handed {
    /// The nodes of each statement.
    runs: Vec<Range<usize>>,
    /// By statement.
    places: Vec<Place>,
    formulas: Vec<Formula>,
    /// Which of those a text is, if it is one.
    of_texts: HashMap<Arc<str>, Option<u32>>,
    wanted: Vec<Wanted>,
    /// Which of those each formula is.
    of_formulas: Vec<Vec<u32>>,
}

/// A parameter that a value is handed on to.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Of which statement, and where in it the parameter's name stands.
    id: u32,
    field: u32,
    /// Of which node, and which of its parameters.
    node: u32,
    argument: u32,
    /// What is wanted there.
    wanted: u32,
}

/// What the value of a formula is for a parameter of a class.
#[derive(Debug, PartialEq)]
struct Wanted {
    formula: u32,
    kind: Kind,
    class: Arc<str>,
    param: &'static str,
    /// It was an object.
    is_node: bool,
}

/// What becomes of the values that are handed on.
#[derive(Debug, Default)]
pub(super) struct Fitted {
    /// What each that is wanted is, by the numbers of nodes that were evaluated.
    values: Vec<scene::Value>,
    /// How an editor shows it, if it does.
    shown: Vec<Option<Arc<str>>>,
}

/// Whether a statement is an object whose fields are objects, or come to the same wherever they are
/// evaluated and however often.
pub(super) fn is_plain(stmt: &Stmt) -> bool {
    matches!(&stmt.node, StmtNode::Object(object) if stmt.attrs.is_empty() && is_plain_object(object))
}

fn is_plain_object(object: &Object) -> bool {
    object.body.stmts.iter().all(|stmt| match &stmt.node {
        StmtNode::Field(field) if stmt.attrs.is_empty() => match &field.value.node {
            ExprNode::Object(inner) => is_plain_object(inner),
            _ => has_no_object(&field.value),
        },
        _ => false,
    })
}

fn has_no_object(expr: &Expr) -> bool {
    use ExprNode::{Broken, Comp, If, With};
    let has_one = |node: &ExprNode| {
        matches!(node, Broken | Comp(_) | If { .. } | ExprNode::Object(_) | With { .. })
    };
    let mut is_so = !has_one(&expr.node);
    children(expr, &mut |child| is_so &= has_no_object(child));
    is_so
}

/// Whether a parameter's value is one that stands for itself: it costs nothing to fit, and nothing but
/// the parameter depends on it.
fn is_simple(value: &scene::Value, nodes: &[Node]) -> bool {
    use scene::Value::{Bool, Color, Node, Number, Path, Text};
    match value {
        Node(NodeId(id)) => !stands_somewhere(nodes[*id as usize].kind),
        value => matches!(value, Bool(_) | Color(..) | Number(..) | Path(_) | Text(_)),
    }
}

impl Handed {
    pub(super) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The names that values are reckoned from.
    pub(super) fn names(&self) -> impl Iterator<Item = u32> {
        self.formulas.iter().flat_map(Formula::names).map(|(name, _)| name)
    }

    /// Which of those that are wanted this is.
    fn number(&mut self, wanted: Wanted) -> u32 {
        let known = &mut self.of_formulas[wanted.formula as usize];
        if let Some(i) = known.iter().find(|i| self.wanted[**i as usize] == wanted) {
            return *i;
        }
        let i = narrow(self.wanted.len());
        known.push(i);
        self.wanted.push(wanted);
        i
    }

    /// Which of the formulas a text is, if it is one.
    fn formula(&mut self, text: &str, state: &State) -> Option<u32> {
        if let Some(known) = self.of_texts.get(text) {
            return *known;
        }
        if self.of_texts.len() >= FORMULAS {
            return None;
        }
        let found = Formula::of(text, state).map(|formula| self.put(formula));
        self.of_texts.insert(text.into(), found);
        found
    }

    fn put(&mut self, formula: Formula) -> u32 {
        self.formulas.push(formula);
        self.of_formulas.push(vec![]);
        narrow(self.formulas.len() - 1)
    }

    /// With those of later statements.
    fn with(mut self, other: Self) -> Self {
        let mut formulas = vec![];
        for formula in other.formulas {
            let text = formula.text.clone();
            let known = self.of_texts.get(&text).copied().flatten();
            let i = known.unwrap_or_else(|| self.put(formula));
            self.of_texts.insert(text, Some(i));
            formulas.push(i);
        }
        let renamed =
            |wanted: Wanted| Wanted { formula: formulas[wanted.formula as usize], ..wanted };
        let numbers: Vec<u32> =
            other.wanted.into_iter().map(|it| self.number(renamed(it))).collect();
        let renamed = |place: Place| Place { wanted: numbers[place.wanted as usize], ..place };
        self.places.extend(other.places.into_iter().map(renamed));
        self.runs.extend(other.runs);
        self
    }

    /// Adds a statement, if it only hands on those of the names it uses that have changed.
    fn add(&mut self, stmt: &Statement, state: &State, is_changed: &[bool]) -> bool {
        let first = self.places.len();
        for (name, times) in stmt.names.uses().filter(|(name, _)| is_changed[*name as usize]) {
            let mut n_written = 0;
            for node in stmt.made.nodes.clone() {
                n_written += self.add_places((stmt, node), state, (name, is_changed));
            }
            if n_written != times {
                self.places.truncate(first);
                return false;
            }
        }
        self.runs.push(stmt.made.nodes.clone());
        true
    }

    /// Adds the parameters of a node whose value is reckoned from a name, the first there that has changed;
    /// how often it stands in what the parameters are reckoned from.
    fn add_places(
        &mut self,
        (stmt, node): (&Statement, usize),
        state: &State,
        (name, is_changed): (u32, &[bool]),
    ) -> u32 {
        let (text, word) = (&state.text[stmt.range.clone()], state.names.name(name));
        let (nodes, number) = (&state.scene.nodes, narrow(node));
        let mut n_written = 0;
        for (argument, k) in nodes[node].params.iter().zip(0..) {
            let range = argument.span.range();
            let Some(written) = text.get(range.clone()).filter(|it| it.contains(word)) else {
                continue;
            };
            // Names that every scene has may stand for others further down.
            let may_reckon =
                matches!(argument.value, scene::Value::Number(..)) && state.n_shadows == 0;
            let is_written = argument.span.source == source_of(stmt.id)
                && (written == word || may_reckon)
                && is_simple(&argument.value, nodes);
            if !is_written {
                continue;
            }
            let before = text[..range.start].trim_end().strip_suffix('=');
            let before = before.and_then(|before| before.trim_end().strip_suffix(argument.name));
            let Some(before) = before else { continue };
            let Some(formula) = self.formula(written, state) else { continue };
            let names = || self.formulas[formula as usize].names();
            n_written += names().find(|(it, _)| *it == name).map_or(0, |(_, times)| times);
            if names().find(|(it, _)| is_changed[*it as usize]).is_none_or(|(it, _)| it != name) {
                continue;
            }
            let is_node = matches!(argument.value, scene::Value::Node(_));
            let (kind, class) = (nodes[node].kind, nodes[node].class.clone());
            let wanted = Wanted { formula, kind, class, param: argument.name, is_node };
            let wanted = self.number(wanted);
            let (id, field) = (stmt.id, narrow(before.len()));
            self.places.push(Place { id, field, node: number, argument: k, wanted });
        }
        n_written
    }
}

impl State {
    /// Whether a statement does nothing but make objects that nobody names.
    pub(super) fn may_hand_on(&self, stmt: &Statement) -> bool {
        let is_set = |label: &u32| self.set_labels.contains(label);
        stmt.is_plain
            && stmt.made.rare.is_none()
            && stmt.names.defines().is_empty()
            && !stmt.names.labels().iter().any(is_set)
    }

    /// Which of statements that may only hand on do so, and the numbers of those that do not.
    pub(super) fn handed(
        &self,
        stmts: &[(usize, &Statement)],
        is_changed: &[bool],
    ) -> (Handed, Vec<usize>) {
        let some = |stmts: &[(usize, &Statement)]| {
            let mut handed = Handed::default();
            let others = stmts.iter().filter(|(_, stmt)| !handed.add(stmt, self, is_changed));
            let others: Vec<usize> = others.map(|(i, _)| *i).collect();
            (handed, others)
        };
        let mut all = (Handed::default(), vec![]);
        for (handed, others) in shares::map(stmts, |(_, stmt)| stmt.range.len(), some) {
            all.0 = all.0.with(handed);
            all.1.extend(others);
        }
        all
    }

    /// What the values that are handed on have become; `None` if one of them is not that simple, or wrong.
    pub(super) fn fitted(
        &self,
        handed: &Handed,
        env: &Env,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Fitted> {
        let n_nodes = handed.runs.iter().map(Range::len).max().unwrap_or(0);
        // What it stands in stands in what the statement makes, each in the next one at most.
        let is_deep =
            |object: &ObjectValue| object.depth + n_nodes >= self.settings.budgets.nesting;
        let is_over = evaluator.sink.over();
        let n_told = evaluator.sink.kept().len();
        let mut values = vec![];
        for formula in &handed.formulas {
            let value = evaluator.eval(&formula.expr, env);
            if !(formula.is_name() || matches!(value, Value::Number(..))) || is_over() {
                return None;
            }
            values.push(value);
        }
        if evaluator.sink.kept().len() > n_told {
            return None;
        }
        let mut out = Fitted::default();
        for wanted in &handed.wanted {
            let value = values[wanted.formula as usize].clone();
            let fits = match &value {
                Value::Object(object) => wanted.is_node && !is_deep(object),
                _ => !wanted.is_node,
            };
            let class = evaluator.registry.class(wanted.kind, &wanted.class).filter(|_| fits)?;
            let param = Registry::params(class).find(|param| param.name == wanted.param)?;
            out.shown.push(evaluator.shown(&value).map(Arc::from));
            // Nothing can be told of it: it would be told of every place.
            let span = Span::new(source_of(u32::MAX), 0, 0);
            let name = Name { text: param.name.into(), span };
            let field = FieldValue { name, value, span, file: env.file.clone() };
            let spent = |of: &Evaluator<'_>| (of.sink.kept().len(), of.steps, of.held.get());
            let before = spent(evaluator);
            let fitted = evaluator.conform(param, &field)?;
            if before != spent(evaluator) || !is_simple(&fitted, &evaluator.scene.nodes) {
                return None;
            }
            out.values.push(fitted);
        }
        Some(out)
    }

    /// Gives the parameters their new values. `nodes` are the numbers here of those that were evaluated.
    /// `None`, and a scene of no use, once it is over.
    pub(super) fn hand_on(
        &mut self,
        handed: Handed,
        fitted: Fitted,
        nodes: &[u32],
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let Handed { mut runs, places, .. } = handed;
        let mut values = fitted.values;
        for value in &mut values {
            if let scene::Value::Node(NodeId(id)) = value {
                *id = nodes[*id as usize];
            }
        }
        let change =
            |Place { node, argument, wanted, .. }| Changed { node, argument, value: wanted };
        let mut changes: Vec<_> = places.into_iter().map(change).collect();
        changes.sort_unstable_by_key(|change| (change.node, change.argument));
        runs.sort_unstable_by_key(|run| run.start);
        self.scene.change(&runs, (&changes, &values), is_over)
    }
}

impl KeptValues {
    /// With the values that are handed on.
    pub(super) fn handed_on(mut self, handed: &Handed, fitted: &Fitted) -> Self {
        let mut layer = Layer::default();
        for places in handed.places.chunk_by(|one, other| one.id == other.id) {
            let id = source_of(places[0].id);
            let before = self.own.of(id).unwrap_or_default();
            let new = places.iter().filter_map(|place| {
                let k = before.binary_search_by_key(&place.field, |note| note.0).ok()?;
                Some((k, fitted.shown[place.wanted as usize].clone()?))
            });
            let mut notes = vec![];
            for (k, shown) in new {
                if notes.is_empty() {
                    notes = before.to_vec();
                }
                notes[k].1 = shown;
            }
            if !notes.is_empty() {
                layer.insert(id, notes.into());
            }
        }
        self.own.push(layer);
        self
    }
}

fn narrow(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
