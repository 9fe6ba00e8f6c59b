//! What one scene has and another has not, in the words of whoever wrote them.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt;
use std::path::Path;

use luxel_sdk::params::{Param, Preset};

use super::hash::{Hash, group_hashes, hash_item};
use super::print::in_line;
use super::{Group, Node, NodeId, Placed, Scene, Target, Value};
use crate::diag::Span;

/// A difference of two scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What differs, as people call it: `sphere "ball"`.
    pub what: String,
    /// How.
    pub how: How,
    /// Where it is written in the first scene and in the second; none where it is not.
    pub spans: [Option<Span>; 2],
    /// Of how many things this is so: of a loop, or of a function that is called often, of many.
    pub n: usize,
}

impl Difference {
    fn new(what: String, how: How, spans: [Option<Span>; 2]) -> Self {
        Self { what, how, spans, n: 1 }
    }

    /// What differs, and how often: `3 × shape sphere`.
    pub fn counted(&self) -> String {
        if self.n > 1 { format!("{} × {}", self.n, self.what) } else { self.what.clone() }
    }
}

/// A parameter that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Its name; `place` is where something stands.
    pub name: String,
    /// Its values in the first scene and in the second; none where it is not given.
    pub spans: [Option<Span>; 2],
    /// What these come to, in SI units: of what a line tells, and alike wherever `n` of them differ.
    pub values: [Option<String>; 2],
}

impl Change {
    /// Of what has no value of its own.
    fn named(name: impl Into<String>) -> Self {
        Self { name: name.into(), spans: [None; 2], values: [None, None] }
    }

    /// Whether it is the same parameter, written in the same places.
    fn is_of(&self, other: &Self) -> bool {
        (&self.name, &self.spans) == (&other.name, &other.spans)
    }
}

impl How {
    /// Whether it is written in the same places.
    fn is_written_as(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Changed(some), Self::Changed(others)) => {
                some.len() == others.len() && some.iter().zip(others).all(|(a, b)| a.is_of(b))
            }
            _ => self == other,
        }
    }

    /// Tells no values that the other has not.
    fn forget_unlike(&mut self, other: &Self) {
        let (Self::Changed(some), Self::Changed(others)) = (self, other) else { return };
        for (change, other) in some.iter_mut().zip(others) {
            if change.values != other.values {
                change.values = [None, None];
            }
        }
    }
}

/// How something differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum How {
    /// Only the second scene has it.
    Added,
    /// Only the first scene has it.
    Removed,
    /// Both have it, with other values of these parameters.
    Changed(Vec<Change>),
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = self.counted();
        match &self.how {
            How::Added => write!(f, "{what} added"),
            How::Removed => write!(f, "{what} removed"),
            How::Changed(changes) => {
                let names: Vec<_> = changes.iter().map(|change| &*change.name).collect();
                write!(f, "{what}: {}", names.join(", "))
            }
        }
    }
}

/// Everything in which the second scene differs from the first. What is the same in another order or
/// under another name is the same; what is shared is told once, and what is written once for many is too.
pub fn diff(first: &Scene, second: &Scene) -> Vec<Difference> {
    diff_in([first, second], [Path::new(""); 2], &|_, _| None)
}

/// What is known of a parameter of an object, by its name.
pub type Known<'a> = dyn Fn(&Node, &str) -> Option<&'a Param> + 'a;

/// The same of scenes that lie in these folders: a file in one has the same name as one in the other if
/// it has that from there on. A parameter that is given its default is the same as one that is not given,
/// if it is known.
pub fn diff_in<'a>(
    scenes: [&'a Scene; 2],
    folders: [&'a Path; 2],
    known: &'a Known<'a>,
) -> Vec<Difference> {
    let [first, second] = scenes;
    let mut differ = Differ {
        scenes,
        folders,
        known,
        groups: [group_hashes(first), group_hashes(second)],
        met: BTreeSet::new(),
        found: vec![],
    };
    differ.settings();
    differ.items([&first.root, &second.root]);
    together(differ.found)
}

/// What is written in the same place and differs in the same way, once.
fn together(found: Vec<Difference>) -> Vec<Difference> {
    let mut out: Vec<Difference> = vec![];
    let mut last: BTreeMap<[Option<Span>; 2], usize> = BTreeMap::new();
    for difference in found {
        let before = last.get(&difference.spans).map(|at| &mut out[*at]);
        let is_same = |it: &&mut Difference| {
            it.what == difference.what && it.how.is_written_as(&difference.how)
        };
        if let Some(same) = before.filter(is_same) {
            same.n += 1;
            same.how.forget_unlike(&difference.how);
        } else {
            last.insert(difference.spans, out.len());
            out.push(difference);
        }
    }
    out
}

struct Differ<'a> {
    scenes: [&'a Scene; 2],
    folders: [&'a Path; 2],
    known: &'a Known<'a>,
    groups: [Vec<Hash>; 2],
    /// Pairs that have been compared.
    met: BTreeSet<(Target, Target)>,
    found: Vec<Difference>,
}

impl Differ<'_> {
    fn settings(&mut self) {
        let [a, b] = self.scenes;
        if a.camera_pose != b.camera_pose
            && let (Some(x), Some(y)) = (a.camera, b.camera)
        {
            self.changed([a.node(x), b.node(y)], vec![Change::named("place")]);
        }
        let slots = |scene: &Scene| {
            let Scene { camera, film, integrator, sampler, filter, medium, .. } = *scene;
            [camera, film, integrator, sampler, filter, medium]
        };
        for pair in slots(a).into_iter().zip(slots(b)) {
            match pair {
                (Some(a), Some(b)) => self.nodes(a, b),
                (Some(id), None) => self.removed(a.node(id)),
                (None, Some(id)) => self.added(b.node(id)),
                (None, None) => {}
            }
        }
    }

    /// What stands in two groups: first the same with the same, then by name, then by class.
    fn items(&mut self, groups: [&Group; 2]) {
        let mut left = self.between(groups).map(|items| items.iter().collect::<Vec<_>>());
        let hash = |i: usize, item: &Placed| hash_item(self.scenes[i], item, &self.groups[i]);
        let _ = pair_off(&mut left, |i, item| Some(hash(i, item)));
        let named = pair_off(&mut left, |i, item| {
            self.name(i, item).map(|name| (self.kind(i, item), name))
        });
        let alike = pair_off(&mut left, |i, item| Some(self.kind(i, item)));
        for (a, b) in named.into_iter().chain(alike) {
            self.placed(a, b);
        }
        for (i, how) in [(0, How::Removed), (1, How::Added)] {
            for item in &left[i] {
                let what = self.called(i, item.target);
                let mut spans = [None; 2];
                spans[i] = Some(item.span);
                self.found.push(Difference::new(what, how.clone(), spans));
            }
        }
    }

    /// What stands between the beginning and the end that two groups have in common, which is all but a
    /// few items of what is being edited.
    fn between<'g>(&self, groups: [&'g Group; 2]) -> [&'g [Placed]; 2] {
        let [a, b] = groups.map(|group| &*group.items);
        let is_same = |(a, b): &(&Placed, &Placed)| self.is_same(a, b);
        let begin = a.iter().zip(b).take_while(is_same).count();
        let (a, b) = (&a[begin..], &b[begin..]);
        let end = a.iter().rev().zip(b.iter().rev()).take_while(is_same).count();
        [&a[..a.len() - end], &b[..b.len() - end]]
    }

    /// Whether an item of the first scene and one of the second are the same in the same place.
    fn is_same(&self, a: &Placed, b: &Placed) -> bool {
        let [first, second] = self.scenes;
        let is_same_target = match (a.target, b.target) {
            (Target::Node(a), Target::Node(b)) => first.node(a).hash == second.node(b).hash,
            (Target::Group(a), Target::Group(b)) => {
                self.groups[0].get(a.0 as usize) == self.groups[1].get(b.0 as usize)
            }
            _ => false,
        };
        let paint = |scene: &Scene, item: &Placed| item.material.map(|id| scene.node(id).hash);
        is_same_target && a.pose == b.pose && paint(first, a) == paint(second, b)
    }

    /// Two placements of what is taken for the same.
    fn placed(&mut self, a: &Placed, b: &Placed) {
        let changed = |name: &str| {
            let how = How::Changed(vec![Change::named(name)]);
            Difference::new(self.called(1, b.target), how, [Some(a.span), Some(b.span)])
        };
        let place = (a.pose != b.pose).then(|| changed("place"));
        let paint = (a.material.is_some() != b.material.is_some()).then(|| changed("material"));
        self.found.extend(place.into_iter().chain(paint));
        if let (Some(a), Some(b)) = (a.material, b.material) {
            self.nodes(a, b);
        }
        match (a.target, b.target) {
            (Target::Node(a), Target::Node(b)) => self.nodes(a, b),
            (Target::Group(x), Target::Group(y)) if self.met.insert((a.target, b.target)) => {
                let [a, b] = self.scenes;
                self.items([a.group(x), b.group(y)]);
            }
            _ => {}
        }
    }

    /// Two objects that are taken for the same.
    fn nodes(&mut self, a: NodeId, b: NodeId) {
        let [first, second] = self.scenes;
        let (x, y) = (first.node(a), second.node(b));
        if x.hash == y.hash || !self.met.insert((Target::Node(a), Target::Node(b))) {
            return;
        }
        if x.class != y.class {
            self.removed(x);
            self.added(y);
            return;
        }
        let names: BTreeSet<_> = x.params.iter().chain(&y.params).map(|it| it.name).collect();
        let mut changed = vec![];
        for name in names {
            let spans = [x, y].map(|node| node.get(name).map(|it| it.span));
            let values = || [x, y].map(|node| node.get(name).and_then(|it| in_line(&it.value)));
            let change = || Change { name: name.to_owned(), spans, values: values() };
            match (x.get(name).map(|it| &it.value), y.get(name).map(|it| &it.value)) {
                (Some(Value::Node(a)), Some(Value::Node(b))) => self.nodes(*a, *b),
                (Some(Value::Moved(a, from)), Some(Value::Moved(b, to))) => {
                    self.nodes(*a, *b);
                    changed.extend((from != to).then(change));
                }
                (Some(Value::Path(a)), Some(Value::Path(b))) if self.is_same_file(a, b) => {}
                (a, b) if a == b => {}
                (Some(value), None) | (None, Some(value)) if self.is_default(x, name, value) => {}
                _ => changed.push(change()),
            }
        }
        let own: BTreeMap<_, _> = x.overrides.iter().map(|(name, id)| (name, *id)).collect();
        for (name, b) in &y.overrides {
            match own.get(name) {
                Some(a) => self.nodes(*a, *b),
                None => changed.push(Change::named(format!("material of {name}"))),
            }
        }
        let gone = own.keys().filter(|name| !y.overrides.iter().any(|(it, _)| it == **name));
        changed.extend(gone.map(|name| Change::named(format!("material of {name}"))));
        if !changed.is_empty() {
            self.changed([x, y], changed);
        }
    }

    fn is_default(&self, node: &Node, name: &str, value: &Value) -> bool {
        (self.known)(node, name).is_some_and(|param| is_default(param, value))
    }

    fn is_same_file(&self, a: &Path, b: &Path) -> bool {
        let [first, second] = self.folders;
        let inside = (a.strip_prefix(first), b.strip_prefix(second));
        matches!(inside, (Ok(a), Ok(b)) if a == b)
    }

    fn changed(&mut self, nodes: [&Node; 2], changes: Vec<Change>) {
        let spans = nodes.map(|node| Some(node.span));
        self.found.push(Difference::new(told(nodes[1]), How::Changed(changes), spans));
    }

    fn removed(&mut self, node: &Node) {
        let spans = [Some(node.span), None];
        self.found.push(Difference::new(told(node), How::Removed, spans));
    }

    fn added(&mut self, node: &Node) {
        let spans = [None, Some(node.span)];
        self.found.push(Difference::new(told(node), How::Added, spans));
    }

    /// What people call something; empty where they gave no name.
    fn name(&self, i: usize, item: &Placed) -> Option<String> {
        let label = match item.target {
            Target::Node(id) => &self.scenes[i].node(id).label,
            Target::Group(id) => &self.scenes[i].group(id).label,
        };
        label.as_ref().map(ToString::to_string)
    }

    /// What is taken for the same, if nothing better is known.
    fn kind(&self, i: usize, item: &Placed) -> String {
        match item.target {
            Target::Node(id) => {
                let node = self.scenes[i].node(id);
                format!("{} {}", node.kind, node.class)
            }
            Target::Group(_) => "group".to_owned(),
        }
    }

    fn called(&self, i: usize, target: Target) -> String {
        match target {
            Target::Node(id) => told(self.scenes[i].node(id)),
            Target::Group(id) => match &self.scenes[i].group(id).label {
                Some(label) => format!("group \"{label}\""),
                None => "group".to_owned(),
            },
        }
    }
}

/// Whether a value is what a parameter has that is not given.
fn is_default(param: &Param, value: &Value) -> bool {
    let is = |a: f64, b: f64| a.total_cmp(&b).is_eq();
    match (param.default, value) {
        (Preset::Numbers(own), Value::Bool(yes)) => (own[0] > 0.5) == *yes,
        (Preset::Numbers(own), Value::Number(x, _)) => is(own[0], *x),
        (Preset::Numbers(own), Value::Vector(v)) => v.iter().zip(own).all(|(x, own)| is(own, *x)),
        (Preset::Index(i), Value::Text(word)) => param.words().nth(i as usize) == Some(word),
        (Preset::Text(own), Value::Text(text)) => own == &**text,
        _ => false,
    }
}

/// What people call an object: its class, and its name if it has one.
pub fn called(node: &Node) -> String {
    match &node.label {
        Some(label) => format!("{} \"{label}\"", node.class),
        None => node.class.to_string(),
    }
}

/// The same where its kind is not known: what has no name is told by its kind too.
fn told(node: &Node) -> String {
    match &node.label {
        Some(_) => called(node),
        None => format!("{} {}", node.kind, node.class),
    }
}

/// Takes out of both lists what has the same key, in order, and returns the pairs. What has no key
/// stays.
fn pair_off<'a, K: Ord>(
    lists: &mut [Vec<&'a Placed>; 2],
    key: impl Fn(usize, &Placed) -> Option<K>,
) -> Vec<(&'a Placed, &'a Placed)> {
    let mut firsts: BTreeMap<K, VecDeque<usize>> = BTreeMap::new();
    for (n, item) in lists[0].iter().enumerate() {
        if let Some(key) = key(0, item) {
            firsts.entry(key).or_default().push_back(n);
        }
    }
    let mut taken = vec![false; lists[0].len()];
    let mut pairs = vec![];
    let mut left = vec![];
    for item in &lists[1] {
        let found = key(1, item).and_then(|key| firsts.get_mut(&key)?.pop_front());
        match found {
            Some(n) => {
                taken[n] = true;
                pairs.push((lists[0][n], *item));
            }
            None => left.push(*item),
        }
    }
    let mut taken = taken.into_iter();
    lists[0].retain(|_| taken.next() == Some(false));
    lists[1] = left;
    pairs
}
