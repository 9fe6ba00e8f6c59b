//! `param`, `--set` and `set`.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::scene::{Color, NodeId};
use luxel_sdk::params::{Dimension, Unit};

use super::Evaluator;
use super::emit::Set;
use super::env::{Env, File, Override};
use super::include;
use super::object::merged;
use super::ops::with_zeros;
use super::value::{FieldValue, ObjectValue, Range, Value, What, show_number};
use crate::syntax::{self, Expr, ExprNode, Form, Name, ParamDef, StmtNode, Tree};
use crate::{ParamInfo, ParamLimits, ParamValue};

/// Steps that a `set` counts, which builds an object anew: it takes as long as so many others.
const SET: u64 = 60;

/// Bytes of a parameter: what is known of it, its texts and its statement, which are kept for the whole load.
pub(super) const PARAM: usize = 1024;

/// Numbers of a list that whoever offers it is told: more are set nowhere else than in the file.
const MOST_NUMBERS: usize = 16;

impl Evaluator<'_> {
    /// The value of a declared parameter: from outside, or its default.
    pub(super) fn param(&mut self, def: &ParamDef, env: &Env) -> Value {
        let limits =
            |this: &mut Self, range: &Expr| (measured(this.eval(range, env), def, env), range.span);
        let range = def.range.as_ref().map(|range| limits(self, range));
        let own = self.eval(&def.value, env);
        let own = self.fit(&def.ty, own, def.value.span, env);
        let n_before = self.mistakes();
        self.in_range(def, &own, range.as_ref(), def.value.span, "E0405");
        let is_outside = self.mistakes() > n_before;
        let place = env.file.is_root.then(|| self.declare(def, range.as_ref(), &own));
        let Some(given) = env.file.overrides.get(&def.name.text).cloned() else {
            return if is_outside { Value::Poison } else { own };
        };
        let before = self.mistakes();
        let code = if env.file.is_root { Some("E0112") } else { None };
        let value = self.fit_setting(def, &own, &given, env, code);
        self.in_range(def, &value, range.as_ref(), given.span, code.unwrap_or("E0405"));
        // What is no value at all has been told already. The parameter stays known, to be given another.
        if self.mistakes() > before || value.is_poison() {
            return Value::Poison;
        }
        if let Some(info) = place.and_then(|place| self.params.get_mut(place)) {
            info.value = param_value(&value);
        }
        value
    }

    /// Fits a value from outside; from the command line every misfit is an E0112.
    fn fit_setting(
        &mut self,
        def: &ParamDef,
        own: &Value,
        given: &Override,
        env: &Env,
        code: Option<&'static str>,
    ) -> Value {
        let Some(code) = code else {
            return self.fit_given(def, own, given, env);
        };
        let mut trial = crate::sink::Sink::new(usize::MAX);
        std::mem::swap(&mut self.sink, &mut trial);
        let value = self.fit_given(def, own, given, env);
        std::mem::swap(&mut self.sink, &mut trial);
        for mut diagnostic in trial.finish() {
            diagnostic.code = code;
            let ty = self.written(def.ty.name.span);
            let help = format!("`{}` is declared as {ty}", def.name.text);
            self.tell(diagnostic.label(def.name.span, "declared here").help(help));
        }
        value
    }

    /// Fits a value from outside. Of a vector the type does not say what it measures, but the default does.
    fn fit_given(&mut self, def: &ParamDef, own: &Value, given: &Override, env: &Env) -> Value {
        let value = self.fit(&def.ty, given.value.clone(), given.span, env);
        match (of_vector(own), of_vector(&value)) {
            (Some(wanted), Some(found)) if wanted != found => {
                let message = format!(
                    "`{}` is {}, {} is given",
                    def.name.text,
                    numbers_of(wanted),
                    numbers_of(found)
                );
                self.poison("E0202", given.span, message)
            }
            _ => value,
        }
    }

    fn in_range(
        &mut self,
        def: &ParamDef,
        value: &Value,
        range: Option<&(Value, Span)>,
        span: Span,
        code: &'static str,
    ) {
        let Some((range, range_span)) = range else { return };
        let Value::Range(range) = range else {
            if !range.is_poison() {
                self.poison("E0214", *range_span, "a range is wanted, as `1..=200`");
            }
            return;
        };
        let (numbers, dimension) = match value {
            Value::Number(x, dimension) => (std::slice::from_ref(x), dimension),
            Value::Numbers(numbers) => (&*numbers.data, &numbers.dimension),
            Value::Poison => return,
            other => {
                let message = format!("a range bounds numbers, not {}", other.describe());
                self.poison("E0214", *range_span, message);
                return;
            }
        };
        if range.start > range.end {
            self.poison("E0214", *range_span, "the range is empty: it goes up");
        } else if *dimension != range.dimension {
            let message = format!(
                "the range is of {}, the parameter {}",
                range.dimension.name(),
                dimension.name()
            );
            self.poison("E0203", *range_span, message);
        } else if let Some(x) = numbers.iter().find(|x| !range.contains(**x)) {
            let what = if matches!(value, Value::Number(..)) { "is" } else { "has" };
            let message = format!(
                "`{}` {what} {}; it must be from {} to {}",
                def.name.text,
                show_number(*x, *dimension),
                show_number(range.start, range.dimension),
                show_number(range.end, range.dimension),
            );
            self.tell(Diagnostic::error(code, span, message).label(*range_span, "declared here"));
        }
    }

    /// Tells of a parameter of the root file; where among them it stands.
    fn declare(&mut self, def: &ParamDef, range: Option<&(Value, Span)>, own: &Value) -> usize {
        let text = |span: Span| self.written(span).to_owned();
        let dimension = match (super::types::dimension(&def.ty.name.text), own) {
            (None, Value::Numbers(numbers)) => numbers.dimension,
            (dimension, _) => dimension.unwrap_or_default(),
        };
        let limits = match range {
            Some((Value::Range(range), _)) if range.dimension == dimension => {
                Some(ParamLimits { low: range.start, high: range.end, inclusive: range.inclusive })
            }
            _ => None,
        };
        let mut expressions = [Some(&def.value), def.range.as_ref()].into_iter().flatten();
        let written = expressions.find_map(|expr| written_unit(expr, dimension, &text));
        let info = ParamInfo {
            name: def.name.text.to_string(),
            ty: def.ty.name.text.to_string(),
            unit: if dimension.is_none() { String::new() } else { dimension.to_string() },
            doc: def.doc.clone(),
            default: text(def.value.span),
            range: def.range.as_ref().map(|range| text(range.span)),
            value: param_value(own),
            limits,
            written,
            span: def.name.span,
        };
        let bytes = info.doc.len() + info.default.len();
        self.hold(PARAM + bytes, def.name.span);
        self.params.push(info);
        self.params.len() - 1
    }

    /// Reads `--set name=value` against the parameters that the root file declares.
    pub(super) fn settings(
        &mut self,
        tree: &Tree,
        set: &[(String, String)],
    ) -> BTreeMap<Arc<str>, Override> {
        let mut out = BTreeMap::new();
        for (name, value) in set {
            let text: Arc<str> = format!("{name}={value}").into();
            let source = self.sources.add("--set", text.clone());
            let span = Span::new(source, name.len() + 1, text.len());
            let def = tree.stmts.iter().find_map(|stmt| match &stmt.node {
                StmtNode::Param(def) if *def.name.text == **name => Some(def.clone()),
                _ => None,
            });
            let Some(def) = def else {
                if include::is_damaged(tree) {
                    continue;
                }
                self.no_setting(tree, name, Span::new(source, 0, name.len()));
                continue;
            };
            let is_text = &*def.ty.name.text == "string" && !value.trim_start().starts_with('"');
            let value = if is_text {
                Value::Text(value.as_str().into())
            } else {
                self.setting(&def, &text, span)
            };
            out.insert(def.name.text.clone(), Override { value, span });
        }
        out
    }

    /// The value of an expression on the command line, which may name constants alone.
    fn setting(&mut self, def: &ParamDef, text: &str, span: Span) -> Value {
        let mut trial = crate::sink::Sink::new(usize::MAX);
        let expr =
            syntax::parse_expr(text, span.range().start, span.source, &self.budgets, &mut trial);
        let mut value = Value::Poison;
        if let Some(expr) = expr.filter(super::resolve::is_constant) {
            std::mem::swap(&mut self.sink, &mut trial);
            let file = File {
                folder: std::path::PathBuf::new(),
                units: BTreeMap::new(),
                overrides: BTreeMap::new(),
                is_root: false,
            };
            value = self.eval(&expr, &Env::new(Rc::new(file)));
            std::mem::swap(&mut self.sink, &mut trial);
        }
        if value.is_poison() {
            let shown = text.get(span.range()).unwrap_or_default();
            let message = format!("`{shown}` is not a value for `{}`", def.name.text);
            let ty = self.written(def.ty.name.span);
            let mut found = Diagnostic::error("E0112", span, message);
            found = found.label(def.name.span, "declared here");
            found = found.help(format!("`{}` is declared as {ty}", def.name.text));
            if let Some(range) = &def.range {
                found = found.help(format!("it must be in {}", self.written(range.span)));
            }
            self.tell(found);
        }
        value
    }

    fn no_setting(&mut self, tree: &Tree, name: &str, span: Span) {
        let message = format!("the scene declares no parameter `{name}`");
        let known: Vec<&str> = include::params(tree).map(|p| &*p.text).collect();
        let found = Diagnostic::error("E0111", span, message)
            .meant(span, near(name, known.iter().copied()));
        let list = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        self.tell(found.help(format!("declared are {list}")));
    }

    /// `set label.field = value`: kept until the scene is complete.
    pub(super) fn set(&mut self, path: &[Name], value: Value, span: Span, env: &Env) {
        let [label, field] = path else {
            let place = path[0].span.to(path[path.len() - 1].span);
            let message = "`set` changes a field of a labelled object: `set label.field = value`";
            self.poison("E0109", place, message);
            return;
        };
        let field = FieldValue { name: field.clone(), value, span, file: env.file.clone() };
        self.labels.sets.push(Set { label: label.clone(), field });
    }

    /// Changes what `set` names; each object is checked against its schema again.
    pub(super) fn apply_sets(&mut self) {
        for set in std::mem::take(&mut self.labels.sets) {
            let n = self.labels.objects.get(&set.label.text).map_or(1, Vec::len);
            if !self.tick(SET.saturating_mul(n as u64), set.field.span) {
                return;
            }
            let Some(objects) = self.labels.objects.get(&set.label.text).cloned() else {
                let text = format!("\"{}\"", set.label.text);
                // What may be set is known of what was written, not of what is meant by it.
                let is_whole = !self.damaged && !self.sink.tells("E00");
                if is_whole || !self.sink.is_full() && !self.is_written(&text) {
                    self.no_label(&set.label);
                }
                continue;
            };
            let changed: Vec<Option<Rc<ObjectValue>>> = objects
                .into_iter()
                // One that cannot be changed so may be changed otherwise, and that may be wrong too.
                .map(|object| {
                    let object = object?;
                    let changed = self.changed(&object, &set);
                    self.damaged |= changed.is_none();
                    changed.or(Some(object))
                })
                .collect();
            self.labels.objects.insert(set.label.text.clone(), changed);
        }
    }

    fn changed(&mut self, object: &ObjectValue, set: &Set) -> Option<Rc<ObjectValue>> {
        let placed = &*set.field.name.text == "transform";
        let What::Node(old, _) = object.what else {
            let message = "a group's own fields cannot be changed by `set`";
            self.poison("E0109", set.label.span, message);
            return None;
        };
        if placed {
            let message = "`set` does not move things: wrap them in a group or use a `param`";
            self.poison("E0109", set.field.name.span, message);
            return None;
        }
        let fields = merged(&object.fields, vec![set.field.clone()]);
        // It takes the place of one that was counted.
        self.placements = self.placements.saturating_sub(1);
        let changed = self.build(&object.head, fields);
        let Value::Object(changed) = changed else { return None };
        let What::Node(new, kind) = changed.what else { return None };
        if self.holds(new, old) {
            let message = format!("\"{}\" would stand in itself", set.label.text);
            self.poison("E0109", set.field.span, message);
            return None;
        }
        // The new node, the last one, takes the place of the old one, which nothing needs any more.
        self.scene.nodes.swap_remove(old.0 as usize);
        let mut changed = (*changed).clone();
        changed.what = What::Node(old, kind);
        Some(Rc::new(changed))
    }

    /// Whether a node holds another one, at any depth.
    fn holds(&self, outer: NodeId, inner: NodeId) -> bool {
        let (mut open, mut seen) = (vec![outer], BTreeSet::new());
        while let Some(id) = open.pop() {
            if id == inner {
                return true;
            }
            if seen.insert(id) {
                open.extend(self.scene.node(id).children());
            }
        }
        false
    }

    /// Whether some text is written anywhere: what could not be read may have it.
    fn is_written(&self, text: &str) -> bool {
        self.sources
            .texts()
            .any(|source| memchr::memmem::find(source.as_bytes(), text.as_bytes()).is_some())
    }

    fn no_label(&mut self, label: &Name) {
        let message = format!("nothing in the scene is labelled \"{}\"", label.text);
        let found = Diagnostic::error("E0109", label.span, message)
            .meant(label.span, near(&label.text, self.labels.objects.keys().map(|l| &**l)));
        self.tell(found.help("a label is the text after the kind: `shape sphere \"ball\" { … }`"));
    }
}

/// What the numbers of a vector measure; of a null vector without a unit, anything.
fn of_vector(value: &Value) -> Option<Dimension> {
    match value {
        Value::Numbers(n) if n.form == Form::Tuple => {
            let is_null = n.dimension.is_none() && n.data.iter().all(|x| x.abs() <= 0.0);
            (!is_null).then_some(n.dimension)
        }
        Value::Items(items) if items.form == Form::Tuple => Some(with_zeros(&items.items)?.1),
        _ => None,
    }
}

fn numbers_of(dimension: Dimension) -> String {
    match dimension {
        Dimension::NONE => "a vector of plain numbers".to_owned(),
        of => format!("a vector in {of}"),
    }
}

/// The range of a parameter, bare numbers in the file's unit.
fn measured(range: Value, def: &ParamDef, env: &Env) -> Value {
    let Value::Range(bare) = &range else { return range };
    let unit = super::types::dimension(&def.ty.name.text)
        .filter(|_| bare.dimension.is_none())
        .and_then(|wanted| Some((wanted, env.file.units.get(&wanted)?)));
    match unit {
        Some((dimension, scale)) => {
            let (start, end) = (bare.start * scale, bare.end * scale);
            Value::Range(Range { start, end, dimension, ..*bare })
        }
        None => range,
    }
}

fn param_value(value: &Value) -> ParamValue {
    match value {
        Value::Number(x, _) => ParamValue::Number(*x),
        Value::Bool(b) => ParamValue::Bool(*b),
        Value::Text(text) => ParamValue::Text(text.to_string()),
        Value::Numbers(numbers) if numbers.data.len() <= MOST_NUMBERS => ParamValue::Numbers {
            values: numbers.data.to_vec(),
            is_list: numbers.form == Form::List,
        },
        Value::Color(Color::Rgb(rgb), Dimension::NONE) => ParamValue::Color(*rgb),
        _ => ParamValue::Other,
    }
}

/// The first unit of a dimension that an expression writes behind a number, and its scale.
fn written_unit(
    expr: &Expr,
    dimension: Dimension,
    text: &impl Fn(Span) -> String,
) -> Option<(String, f64)> {
    let inner = |expr: &Expr| written_unit(expr, dimension, text);
    let same = |name: &str, unit: &Unit| Unit::parse(name).is_ok_and(|found| found == *unit);
    match &expr.node {
        ExprNode::Number(_, Some(unit)) if unit.dimension == dimension => {
            let text = text(expr.span);
            // Behind the digits, whose exponent is a letter too, and is no unit with what follows.
            let mut ends = text.char_indices().filter(|(_, c)| c.is_alphabetic());
            let name = ends.find_map(|(i, _)| same(&text[i..], unit).then(|| &text[i..]))?;
            Some((name.trim().to_owned(), unit.scale))
        }
        ExprNode::Numbers { unit: Some(unit), .. } | ExprNode::Items { unit: Some(unit), .. }
            if unit.dimension == dimension =>
        {
            let text = text(expr.span);
            let (_, name) = text.rsplit_once([')', ']'])?;
            same(name.trim(), unit).then(|| (name.trim().to_owned(), unit.scale))
        }
        ExprNode::Items { items, unit: None, .. } => items.iter().find_map(inner),
        ExprNode::Unary { inner: of, .. } | ExprNode::Paren { inner: of, unit: None } => inner(of),
        ExprNode::Chain { first, rest } => {
            inner(first).or_else(|| rest.iter().find_map(|(_, _, expr)| inner(expr)))
        }
        _ => None,
    }
}
