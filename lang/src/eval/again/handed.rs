//! Statements that only hand a changed value on: the parameters that it became get the new one, and nothing
//! of the statements is evaluated.

use std::collections::HashMap;
use std::ops::Range;

use luxel_core::diag::{SourceId, Span};
use luxel_core::registry::Registry;
use luxel_core::scene::{self, Changed, IsOver, NewValues, Node, NodeId};

use super::formula::{Formula, narrow};
use super::handing::{Handing, Place, Wanted, is_simple};
use super::made::Cost;
use super::values::KeptValues;
use super::{State, Statement, source_of};
use crate::eval::Evaluator;
use crate::eval::arithmetic::Measured;
use crate::eval::env::Env;
use crate::eval::note::{number_later, shown_vector};
use crate::eval::value::{FieldValue, ObjectValue, Value};
use crate::shares;
use crate::syntax::Name;
use crate::values::{Shown, Unsaid};

/// Bytes that a place, or what is wanted, counts for where threads share them: it takes as long as so much
/// text.
pub(super) const SIZE: usize = 1 << 6;

/// What hands on changed values.
#[derive(Debug, Default)]
pub(super) struct Handed {
    /// The nodes of statements that make several, and how many one makes at most.
    runs: Vec<Range<usize>>,
    most_nodes: usize,
    /// By statement.
    places: Vec<(SourceId, Place)>,
    /// What is wanted there, by number, each once.
    wanted: Vec<u32>,
    /// The names that must have values for that, each once.
    names: Vec<u32>,
    /// The functions that are called for it, by their numbers.
    calls: Vec<u32>,
}

/// What becomes of the values that are handed on.
#[derive(Debug, Default)]
pub(super) struct Fitted {
    values: Vec<FittedValue>,
    /// Which of those each that is wanted has, by number.
    of_wanted: Vec<u32>,
}

/// A value for a parameter.
#[derive(Clone, Debug)]
pub(super) enum FittedValue {
    /// A number, and what it is said to be. It was reckoned, which takes no steps.
    Number {
        value: Measured,
        said: Measured,
    },
    Other(Box<OtherValue>),
    /// A mistake hides it, and nothing more is told of it.
    Hidden,
}

/// A value that was evaluated.
#[derive(Clone, Debug)]
pub(super) struct OtherValue {
    /// By the numbers of nodes that were evaluated.
    value: scene::Value,
    /// How an editor shows it, if it does.
    shown: Option<Shown>,
    /// Steps that it takes to fit.
    steps: u64,
}

impl FittedValue {
    /// How an editor shows it, if it does.
    fn shown(&self) -> Option<Shown> {
        match self {
            Self::Number { said: (x, measure), .. } => Some(number_later(*x, *measure)),
            Self::Other(other) => other.shown.clone(),
            Self::Hidden => Some(Shown::Nothing),
        }
    }

    /// The parameter's value, by the numbers that nodes have now; nothing of one that is hidden.
    fn value(&self, nodes: &[u32]) -> Option<scene::Value> {
        match self {
            Self::Number { value: (x, measure), .. } => Some(scene::Value::Number(*x, *measure)),
            Self::Other(other) => Some(match &other.value {
                scene::Value::Node(NodeId(id)) => scene::Value::Node(NodeId(nodes[*id as usize])),
                value => value.clone(),
            }),
            Self::Hidden => None,
        }
    }
}

impl Fitted {
    /// The value that a place gets.
    fn at(&self, place: &Place) -> &FittedValue {
        &self.values[self.of_wanted[place.wanted as usize] as usize]
    }

    /// What it costs to put the values everywhere, at most: what was there before may have cost as much.
    pub(super) fn cost(&self, handed: &Handed) -> Cost {
        let steps = |(_, place): &(SourceId, Place)| match self.at(place) {
            FittedValue::Other(other) => other.steps,
            FittedValue::Number { .. } | FittedValue::Hidden => 0,
        };
        Cost::of_steps(handed.places.iter().map(steps).sum())
    }

    /// Whether one of them may be a node.
    pub(super) fn has_nodes(&self) -> bool {
        let is_node = |value: &FittedValue| match value {
            FittedValue::Other(other) => matches!(other.value, scene::Value::Node(_)),
            FittedValue::Number { .. } | FittedValue::Hidden => false,
        };
        self.values.iter().any(is_node)
    }
}

impl Handed {
    /// What is wanted, by number, each once.
    pub(super) fn wanted(&self) -> &[u32] {
        &self.wanted
    }

    /// The names that must have values for that, each once.
    pub(super) fn names(&self) -> impl Iterator<Item = u32> {
        self.names.iter().copied()
    }
}

/// What statements do that use a name whose value has changed.
#[derive(Debug, Default)]
pub(super) struct Users {
    /// What those do that only hand it on.
    pub(super) handed: Handed,
    /// The numbers of the others, in order.
    pub(super) others: Vec<usize>,
}

impl Handed {
    /// Adds what a statement hands on of names that have changed. What is wanted and what is named may stand
    /// here more than once.
    fn add(&mut self, stmt: &Statement, handing: &Handing, is_changed: &[bool]) {
        let nodes = &stmt.made.nodes;
        self.most_nodes = self.most_nodes.max(nodes.len());
        if nodes.len() > 1 {
            self.runs.push(nodes.clone());
        }
        for place in handing.places_of(&stmt.hands) {
            let names = || handing.formula(place.wanted).names();
            if names().any(|name| is_changed[name as usize]) {
                self.places.push((source_of(stmt.id), *place));
                names().for_each(|name| add_unless_last(&mut self.names, name));
                let calls = handing.formula(place.wanted).calls();
                calls.for_each(|body| add_unless_last(&mut self.calls, body));
            }
        }
    }
}

/// Adds a number to a list, unless it is the last one.
fn add_unless_last(list: &mut Vec<u32>, number: u32) {
    if list.last() != Some(&number) {
        list.push(number);
    }
}

impl State {
    /// Whether what a statement makes is only what it says itself.
    pub(super) fn may_hand_on(&self, stmt: &Statement) -> bool {
        let is_set = |label: &u32| self.set_labels.contains(label);
        stmt.is_plain && (self.set_labels.is_empty() || !stmt.names.labels().iter().any(is_set))
    }

    /// What those of a few statements do that use a name which has changed; of those that are `new`, none only
    /// hands it on.
    pub(super) fn users(
        &self,
        stmts: &[Statement],
        is_changed: &[bool],
        is_new: impl Fn(&Statement) -> bool,
    ) -> Users {
        let mut out = Users::default();
        for (i, stmt) in stmts.iter().enumerate() {
            let uses = stmt.names.uses().zip(0..);
            let mut changed = uses.filter(|((name, _), _)| is_changed[*name as usize]).peekable();
            if changed.peek().is_none() {
                continue;
            }
            let only_hands_on = changed.all(|(_, k)| stmt.hands.only_hands_on(k));
            if only_hands_on && self.may_hand_on(stmt) && !is_new(stmt) {
                out.handed.add(stmt, &self.handing, is_changed);
            } else {
                out.others.push(i);
            }
        }
        out
    }

    /// What the parts of a file hand on, each name and what is wanted once.
    pub(super) fn handed(&self, parts: impl IntoIterator<Item = Handed>) -> Handed {
        let mut out = Handed::default();
        let mut is_met = vec![false; self.handing.n_wanted()];
        let mut is_named = vec![false; self.names.len()];
        let mut calls = vec![];
        for part in parts {
            part.places.iter().for_each(|(_, place)| is_met[place.wanted as usize] = true);
            calls.extend(&part.calls);
            part.names.iter().for_each(|name| is_named[*name as usize] = true);
            out.places.extend(part.places);
            out.runs.extend(part.runs);
            out.most_nodes = out.most_nodes.max(part.most_nodes);
        }
        calls.sort_unstable();
        calls.dedup();
        for called in calls.into_iter().map(|body| self.handing.called(body)) {
            let names = called.names.iter().chain(&called.functions);
            names.for_each(|name| is_named[*name as usize] = true);
        }
        let met = |(i, is_met): (u32, bool)| is_met.then_some(i);
        out.wanted = (0..).zip(is_met).filter_map(met).collect();
        out.names = (0..).zip(is_named).filter_map(met).collect();
        out
    }

    /// What the values that are handed on have become; `None` if one of them is not that simple, or wrong.
    pub(super) fn fitted(
        &self,
        handed: &Handed,
        env: &Env,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Fitted> {
        let is_over = evaluator.sink.over();
        let n_told = evaluator.sink.kept().len();
        let mut fitted = self.reckoned(handed, env, evaluator);
        let mut of_wanted = vec![u32::MAX; self.handing.n_wanted()];
        for (i, k) in handed.wanted.iter().zip(0..) {
            of_wanted[*i as usize] = k;
        }
        let mut values: HashMap<u32, Value> = HashMap::new();
        let wanted = handed.wanted.iter().zip(&mut fitted);
        for (i, fitted) in wanted.filter(|(_, reckoned)| reckoned.is_none()) {
            if is_over() {
                return None;
            }
            let (wanted, formula) = (self.handing.wanted(*i), self.handing.formula(*i));
            let value = match values.get(&wanted.formula) {
                Some(known) => known.clone(),
                None => evaluator.eval(&formula.expr(&self.settings.budgets)?, env),
            };
            if evaluator.sink.kept().len() > n_told {
                return None;
            }
            values.insert(wanted.formula, value.clone());
            *fitted = Some(if value.is_poison() {
                FittedValue::Hidden
            } else {
                FittedValue::Other(self.fit((wanted, formula), value, (handed, env), evaluator)?)
            });
        }
        let values: Vec<_> = fitted.into_iter().collect::<Option<_>>()?;
        Some(Fitted { values, of_wanted })
    }

    /// The value of a formula for a parameter, and how an editor shows it; `None` if it is not that simple,
    /// or wrong.
    fn fit(
        &self,
        (wanted, formula): (&Wanted, Formula<'_>),
        value: Value,
        (handed, env): (&Handed, &Env),
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Box<OtherValue>> {
        // What it stands in stands in what the statement makes, each in the next one at most.
        let is_deep = |object: &ObjectValue| {
            object.depth + handed.most_nodes >= self.settings.budgets.nesting
        };
        let fits = match &value {
            Value::Object(object) => wanted.is_node && !is_deep(object),
            _ if wanted.is_node => false,
            Value::Number(..) => !formula.is_vector(),
            Value::Numbers(_) | Value::Items(_) => formula.is_vector() || formula.is_name(),
            _ => formula.is_name(),
        };
        // A number of a vector that fits has been reckoned.
        let fits = fits && wanted.n_items == 0;
        let class = evaluator.registry.class(wanted.kind, wanted.class).filter(|_| fits)?;
        let param = Registry::params(class).find(|param| param.name == wanted.param)?;
        let shown = evaluator.shown_later(&value);
        // Nothing can be told of it: it would be told of every place.
        let span = Span::new(source_of(u32::MAX), 0, 0);
        let name = Name { text: param.name.into(), span };
        let field = FieldValue { name, value, span, file: env.file.clone() };
        let spent = |of: &Evaluator<'_>| (of.sink.kept().len(), of.held.get());
        let (before, first) = (spent(evaluator), evaluator.steps);
        let value = evaluator.conform(param, &field)?;
        let steps = evaluator.steps - first;
        let is_fit = before == spent(evaluator) && is_simple(&value, &evaluator.scene.nodes);
        is_fit.then(|| Box::new(OtherValue { value, shown, steps }))
    }

    /// Gives the parameters their new values. `nodes` are the numbers here of those that were evaluated.
    /// `None`, and a scene of no use, where a mistake hides one, or once it is over.
    pub(super) fn hand_on(
        &mut self,
        handed: Handed,
        fitted: &Fitted,
        nodes: &[u32],
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let Fitted { values, of_wanted } = fitted;
        if values.iter().any(|value| matches!(value, FittedValue::Hidden)) {
            return None;
        }
        let value = |i: u32| values[i as usize].value(nodes);
        let values = NewValues { n: narrow(values.len()), get: &value };
        let change = |(_, Place { node, argument, item, wanted, .. }): (SourceId, Place)| Changed {
            node,
            argument,
            item,
            value: of_wanted[wanted as usize],
        };
        let mut changes: Vec<_> = handed.places.into_iter().map(change).collect();
        changes.sort_unstable_by_key(|change| (change.node, change.argument, change.item));
        self.scene.change(&handed.runs, (&changes, values), is_over)
    }
}

impl KeptValues {
    /// With the values that are handed on, of vectors some of whose numbers are those of `nodes`.
    pub(super) fn handed_on(mut self, handed: &Handed, fitted: &Fitted, nodes: &[Node]) -> Self {
        let is_one = |(one, a): &(SourceId, Place), (other, b): &(SourceId, Place)| {
            (one, a.node, a.argument) == (other, b.node, b.argument)
        };
        let each: Vec<&[(SourceId, Place)]> = handed.places.chunk_by(is_one).collect();
        let shown = |places: &[(SourceId, Place)]| {
            let (statement, place) = places[0];
            let shown = match place.item {
                None => fitted.at(&place).shown()?,
                Some(_) => fitted.vector(places, nodes)?,
            };
            Some(((statement, place.field), shown))
        };
        let some = |part: &[&[_]]| -> Vec<_> { part.iter().copied().filter_map(shown).collect() };
        self.own.hand_on(shares::join(shares::map(&each, |_| SIZE, some)));
        self
    }
}

impl Fitted {
    /// A vector some of whose numbers get new values.
    fn vector(&self, places: &[(SourceId, Place)], nodes: &[Node]) -> Option<Shown> {
        let (_, Place { node, argument, .. }) = places[0];
        let argument = nodes[node as usize].params.get(argument as usize)?;
        let scene::Value::Vector(numbers) = &argument.value else { return None };
        let (mut numbers, mut measured) = (numbers.clone(), None);
        for (_, place) in places {
            let (x, measure) = match self.at(place) {
                FittedValue::Number { value, .. } => *value,
                FittedValue::Other(_) => return None,
                FittedValue::Hidden => return Some(Shown::Nothing),
            };
            *numbers.get_mut(usize::from(place.item?))? = x;
            measured = Some(measure);
        }
        Some(Shown::Later(Unsaid { numbers, measure: measured?, say: shown_vector }))
    }
}
