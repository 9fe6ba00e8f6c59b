//! Where statements hand names on, as `radius = r` and `radius = r / 2` do: which parameters of which nodes
//! these are is found when the statements are evaluated, so that a name that all of them hand on has its
//! new value everywhere soon.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use luxel_core::registry::Registry;
use luxel_core::scene::{self, Argument, IsOver, Node, NodeId};
use luxel_sdk::kind::Kind;

use super::formula::{Formula, Formulas, MOST_ITEMS, narrow};
use super::steps::Called;
use super::vector;
use super::{Statement, source_of};
use crate::Budgets;
use crate::eval::numbered::Known;
use crate::eval::object::stands_somewhere;
use crate::shares;
use crate::syntax::{Expr, ExprNode, FnDef, Object, Stmt, StmtNode, children, read_piece};

/// Texts that are looked at, at most, in each share of the file: what is reckoned with others is evaluated.
const TEXTS: usize = 1 << 12;

/// Vectors that are taken as a whole, in each share of the file: what many statements say alike is evaluated
/// once.
const WHOLE: usize = 1;

/// What values are handed on, and where.
#[derive(Debug, Default)]
pub(super) struct Handing {
    /// By statement; also of statements that are gone.
    places: Vec<Place>,
    formulas: Formulas,
    /// Which of those a text is, if it is one.
    of_texts: HashMap<Arc<str>, Option<u32>>,
    /// Texts that call a function, by the number of its name.
    callers: HashMap<u32, Vec<Arc<str>>>,
    /// How many vectors are.
    n_vectors: usize,
    wanted: Vec<Wanted>,
    /// Which of those each formula is.
    of_formulas: Vec<Vec<u32>>,
}

/// A parameter that a value is handed on to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Where in its statement the parameter's name stands.
    pub(super) field: u32,
    /// Of which node, and which of its parameters; of a vector, which number, if not all of it.
    pub(super) node: u32,
    pub(super) argument: u32,
    pub(super) item: Option<u8>,
    /// What is wanted there.
    pub(super) wanted: u32,
}

/// What the value of a formula is for a parameter of a class.
#[derive(Debug, PartialEq)]
pub(super) struct Wanted {
    pub(super) formula: u32,
    pub(super) kind: Kind,
    pub(super) class: &'static str,
    pub(super) param: &'static str,
    /// It was an object.
    pub(super) is_node: bool,
    /// Of a vector of so many numbers it is one; 0 where it is the whole value.
    pub(super) n_items: u8,
}

/// A formula in a parameter's value: as a `Place` and a `Wanted` have it.
struct Part {
    item: Option<u8>,
    n_items: u8,
    formula: u32,
}

/// What a statement hands on.
#[derive(Clone, Debug, Default)]
pub(super) struct Hands {
    places: Range<u32>,
    /// Of the names that it uses, in their order, those that it only hands on: a bit each.
    names: u32,
}

impl Hands {
    /// Whether it only hands on the name that is the `i`th of those it uses.
    pub(super) fn only_hands_on(&self, i: usize) -> bool {
        u32::try_from(i)
            .ok()
            .and_then(|i| self.names.checked_shr(i))
            .is_some_and(|rest| rest & 1 > 0)
    }
}

/// What statements are written as, and what they came to.
pub(super) struct Written<'a> {
    pub(super) text: &'a str,
    pub(super) nodes: &'a [Node],
    pub(super) names: &'a Known,
    pub(super) budgets: &'a Budgets,
    pub(super) registry: &'a Registry,
    /// How many statements define names that every scene has, which may stand for others further down.
    pub(super) n_shadows: usize,
    /// The text of the statement that defines a name.
    pub(super) definition: &'a (dyn Fn(u32) -> Option<&'a str> + Sync),
}

impl Written<'_> {
    /// The function that has a name, unless something is wrong with it.
    fn function(&self, name: u32) -> Option<Arc<FnDef>> {
        let text = (self.definition)(name)?;
        let (stmts, told) = read_piece(text, false, source_of(u32::MAX), self.budgets);
        match stmts.into_iter().next()?.node {
            StmtNode::Fn(def) if told.is_empty() => Some(def),
            _ => None,
        }
    }
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

/// Whether a parameter's value is one that stands for itself: it costs next to nothing to fit, and nothing
/// but the parameter depends on it.
pub(super) fn is_simple(value: &scene::Value, nodes: &[Node]) -> bool {
    use scene::Value::{Bool, Color, Node, Number, Path, Text, Vector};
    match value {
        Node(NodeId(id)) => !stands_somewhere(nodes[*id as usize].kind),
        Vector(items) => items.len() <= MOST_ITEMS,
        value => matches!(value, Bool(_) | Color(..) | Number(..) | Path(_) | Text(_)),
    }
}

impl Handing {
    /// What statements hand on, each of which is told so; incomplete once it is over.
    pub(super) fn of(stmts: &mut [Statement], written: &Written<'_>, is_over: IsOver<'_>) -> Self {
        let some = |stmts: &[Statement]| {
            let mut handing = Self::default();
            let hands = stmts.iter().take_while(|_| !is_over());
            let hands: Vec<Hands> = hands.map(|stmt| handing.add(stmt, written)).collect();
            (handing, hands)
        };
        let mut all = Self::default();
        let mut each = vec![];
        for (handing, hands) in shares::map(stmts, |stmt| stmt.range.len(), some) {
            let first = narrow(all.places.len());
            let later = |Hands { places, names }: Hands| Hands {
                places: first + places.start..first + places.end,
                names,
            };
            each.extend(hands.into_iter().map(later));
            all = all.with(handing);
        }
        for (stmt, hands) in stmts.iter_mut().zip(each) {
            stmt.hands = hands;
        }
        all
    }

    /// With those of later statements.
    fn with(mut self, other: Self) -> Self {
        let bodies = self.formulas.take_over(&other.formulas);
        let mut formulas = vec![];
        for formula in other.formulas.iter() {
            let known = self.of_texts.get(formula.text).copied().flatten();
            let i = known.unwrap_or_else(|| {
                let i = self.formulas.add(formula, &bodies);
                self.met(i)
            });
            self.of_texts.insert(formula.text.clone(), Some(i));
            formulas.push(i);
        }
        let number = |wanted: Wanted| {
            let formula = formulas[wanted.formula as usize];
            self.number(Wanted { formula, ..wanted })
        };
        let numbers: Vec<u32> = other.wanted.into_iter().map(number).collect();
        let renamed = |place: Place| Place { wanted: numbers[place.wanted as usize], ..place };
        self.places.extend(other.places.into_iter().map(renamed));
        self
    }

    /// Where a statement hands something on.
    pub(super) fn places_of(&self, hands: &Hands) -> &[Place] {
        &self.places[hands.places.start as usize..hands.places.end as usize]
    }

    /// Forgets functions among names that are defined anew, by their numbers, and what is reckoned by them.
    pub(super) fn forget(&mut self, redefined: &HashSet<u32>) {
        self.formulas.forget(redefined);
        for text in redefined.iter().filter_map(|name| self.callers.remove(name)).flatten() {
            self.of_texts.remove(&text);
        }
    }

    /// What is called with a function of the file, by its number.
    pub(super) fn called(&self, body: u32) -> &Called {
        self.formulas.called(body)
    }

    /// How many are wanted.
    pub(super) fn n_wanted(&self) -> usize {
        self.wanted.len()
    }

    /// What is wanted, by its number.
    pub(super) fn wanted(&self, i: u32) -> &Wanted {
        &self.wanted[i as usize]
    }

    /// The formula whose value is wanted, by the number of what is.
    pub(super) fn formula(&self, i: u32) -> Formula<'_> {
        self.formulas.get(self.wanted(i).formula)
    }

    /// Adds what a statement hands on, if it does nothing but make objects that nobody names.
    pub(super) fn add(&mut self, stmt: &Statement, written: &Written<'_>) -> Hands {
        let first = self.places.len();
        let makes = stmt.is_plain && stmt.made.rare.is_none() && stmt.names.defines().is_empty();
        let uses: Vec<(u32, u32)> = stmt.names.uses().take(u32::BITS as usize).collect();
        let mut left: Vec<Option<u32>> = uses.iter().map(|(_, times)| Some(*times)).collect();
        if makes && !uses.is_empty() {
            for node in stmt.made.nodes.clone() {
                self.add_node((stmt, node), written, (&uses, &mut left));
            }
        }
        let names = left.iter().rev().fold(0, |bits, left| bits << 1 | u32::from(*left == Some(0)));
        Hands { places: narrow(first)..narrow(self.places.len()), names }
    }

    /// Adds the parameters of a node whose values are reckoned from names that are used.
    fn add_node(
        &mut self,
        (stmt, node): (&Statement, usize),
        written: &Written<'_>,
        (uses, left): (&[(u32, u32)], &mut [Option<u32>]),
    ) {
        let text = &written.text[stmt.range.clone()];
        let it = &written.nodes[node];
        for (argument, k) in it.params.iter().zip(0..) {
            let range = argument.span.range();
            let is_here = argument.span.source == source_of(stmt.id);
            if !is_here || !is_simple(&argument.value, written.nodes) {
                continue;
            }
            let Some(value) = text.get(range.clone()) else { continue };
            let may_reckon =
                matches!(argument.value, scene::Value::Number(..) | scene::Value::Vector(_))
                    && written.n_shadows == 0;
            let is_used = |(name, _): &(u32, u32)| {
                let word = written.names.name(*name);
                value == word || may_reckon && value.contains(word)
            };
            if !uses.iter().any(is_used) {
                continue;
            }
            let before = text[..range.start].trim_end().strip_suffix('=');
            let before = before.and_then(|before| before.trim_end().strip_suffix(argument.name));
            let Some(before) = before else { continue };
            let parts = self.parts(it, argument, value, written);
            let is_node = matches!(argument.value, scene::Value::Node(_));
            for Part { item, n_items, formula } in parts {
                self.use_names(formula, uses, left);
                let (kind, class, param) = (it.kind, it.class, argument.name);
                let wanted = self.number(Wanted { formula, kind, class, param, is_node, n_items });
                let (field, node) = (narrow(before.len()), narrow(node));
                self.places.push(Place { field, node, argument: k, item, wanted });
            }
        }
    }

    /// Counts the names of a formula among those that are used. Of each of these is known how often it is used
    /// elsewhere; nothing, once it was met more often.
    fn use_names(&self, formula: u32, uses: &[(u32, u32)], left: &mut [Option<u32>]) {
        for name in self.formulas.get(formula).names() {
            let met = uses.iter().zip(left.iter_mut()).find(|((used, _), _)| *used == name);
            if let Some((_, left)) = met {
                *left = left.and_then(|left| left.checked_sub(1));
            }
        }
    }

    /// The formulas in a parameter's value: those in its items, if it is a vector of its own, or the whole.
    fn parts(
        &mut self,
        node: &Node,
        argument: &Argument,
        text: &str,
        written: &Written<'_>,
    ) -> Vec<Part> {
        let is_of_its_own = self.n_vectors >= WHOLE && !self.of_texts.contains_key(text);
        let items = is_of_its_own.then(|| self.items((node, argument), text, written)).flatten();
        items.unwrap_or_else(|| {
            let whole = self.formula_of(text, written);
            whole.map(|formula| Part { item: None, n_items: 0, formula }).into_iter().collect()
        })
    }

    /// The formulas in the items of a vector that is written out; `None` if it must be taken as a whole.
    fn items(
        &mut self,
        (node, argument): (&Node, &Argument),
        text: &str,
        written: &Written<'_>,
    ) -> Option<Vec<Part>> {
        let scene::Value::Vector(numbers) = &argument.value else { return None };
        let class = written.registry.class(node.kind, node.class)?;
        let param = Registry::params(class).find(|param| param.name == argument.name)?;
        let items = vector::items(text, vector::dimension(param)?)?;
        let n_items = u8::try_from(items.len()).ok().filter(|_| items.len() == numbers.len())?;
        let mut parts = vec![];
        for (i, (item, x)) in (0..).zip(items.into_iter().zip(numbers)) {
            let text = text[item].trim();
            if vector::literal(text).is_some() {
                continue;
            }
            // What stands for a bare zero is shown as one.
            if x.abs() <= 0.0 {
                return None;
            }
            parts.push(Part { item: Some(i), n_items, formula: self.formula_of(text, written)? });
        }
        Some(parts)
    }

    /// Which of the formulas a text is, if it is one.
    fn formula_of(&mut self, text: &str, written: &Written<'_>) -> Option<u32> {
        if let Some(known) = self.of_texts.get(text) {
            return *known;
        }
        if self.of_texts.len() >= TEXTS {
            return None;
        }
        let function = |name| written.function(name);
        let found = self.formulas.read(text, written.budgets, (written.names, &function));
        let found = found.map(|i| self.met(i));
        self.of_texts.insert(text.into(), found);
        found
    }

    /// Counts a formula that was added last.
    fn met(&mut self, i: u32) -> u32 {
        let formula = self.formulas.get(i);
        self.n_vectors += usize::from(formula.is_vector());
        for function in formula.calls().flat_map(|body| &self.formulas.called(body).functions) {
            self.callers.entry(*function).or_default().push(formula.text.clone());
        }
        self.of_formulas.push(vec![]);
        i
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
}
