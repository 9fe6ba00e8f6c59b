//! What one scene has and another has not, in the words of whoever wrote them.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt;

use super::value::{Hash, group_hashes, hash_item};
use super::{Group, Node, NodeId, Placed, Scene, Target, Value};
use crate::diag::Span;

/// A difference of two scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What differs, as people call it: `sphere "ball"`.
    pub what: String,
    /// How.
    pub how: How,
    /// Where it is written: in the second scene, or in the first if it is only there.
    pub span: Option<Span>,
}

/// How something differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum How {
    /// Only the second scene has it.
    Added,
    /// Only the first scene has it.
    Removed,
    /// Both have it, with other values of these parameters; `place` is where it stands.
    Changed(Vec<String>),
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.how {
            How::Added => write!(f, "{} added", self.what),
            How::Removed => write!(f, "{} removed", self.what),
            How::Changed(names) => write!(f, "{}: {}", self.what, names.join(", ")),
        }
    }
}

/// Everything in which the second scene differs from the first. What is the same in another order or
/// under another name is the same; what is shared is told once.
pub fn diff(first: &Scene, second: &Scene) -> Vec<Difference> {
    let mut differ = Differ {
        scenes: [first, second],
        groups: [group_hashes(first), group_hashes(second)],
        met: BTreeSet::new(),
        found: vec![],
    };
    differ.settings();
    differ.items([&first.root, &second.root]);
    differ.found
}

struct Differ<'a> {
    scenes: [&'a Scene; 2],
    groups: [Vec<Hash>; 2],
    /// Pairs that have been compared.
    met: BTreeSet<(Target, Target)>,
    found: Vec<Difference>,
}

impl Differ<'_> {
    fn settings(&mut self) {
        let [a, b] = self.scenes;
        if a.camera_pose != b.camera_pose
            && let (Some(_), Some(id)) = (a.camera, b.camera)
        {
            self.changed(b.node(id), vec!["place".to_owned()]);
        }
        let slots = |scene: &Scene| {
            let Scene { camera, film, integrator, sampler, filter, medium, .. } = *scene;
            [camera, film, integrator, sampler, filter, medium]
        };
        for pair in slots(a).into_iter().zip(slots(b)) {
            match pair {
                (Some(a), Some(b)) => self.nodes(a, b),
                (Some(id), None) => self.lone(a.node(id), How::Removed),
                (None, Some(id)) => self.lone(b.node(id), How::Added),
                (None, None) => {}
            }
        }
    }

    /// What stands in two groups: first the same with the same, then by name, then by class.
    fn items(&mut self, groups: [&Group; 2]) {
        let mut left = [0, 1].map(|i| groups[i].items.iter().collect::<Vec<_>>());
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
                self.found.push(Difference { what, how: how.clone(), span: Some(item.span) });
            }
        }
    }

    /// Two placements of what is taken for the same.
    fn placed(&mut self, a: &Placed, b: &Placed) {
        if a.pose != b.pose {
            let (what, how) = (self.called(1, b.target), How::Changed(vec!["place".to_owned()]));
            self.found.push(Difference { what, how, span: Some(b.span) });
        }
        if let (Some(a), Some(b)) = (a.material, b.material) {
            self.nodes(a, b);
        } else if a.material != b.material {
            let (what, how) = (self.called(1, b.target), How::Changed(vec!["material".to_owned()]));
            self.found.push(Difference { what, how, span: Some(b.span) });
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
            self.lone(x, How::Removed);
            self.lone(y, How::Added);
            return;
        }
        let names: BTreeSet<_> = x.params.iter().chain(&y.params).map(|it| it.name).collect();
        let mut changed = vec![];
        for name in names {
            match (x.get(name).map(|it| &it.value), y.get(name).map(|it| &it.value)) {
                (Some(Value::Node(a)), Some(Value::Node(b))) => self.nodes(*a, *b),
                (Some(Value::Moved(a, from)), Some(Value::Moved(b, to))) => {
                    self.nodes(*a, *b);
                    changed.extend((from != to).then(|| name.to_owned()));
                }
                (a, b) if a == b => {}
                _ => changed.push(name.to_owned()),
            }
        }
        let own: BTreeMap<_, _> = x.overrides.iter().map(|(name, id)| (name, *id)).collect();
        for (name, b) in &y.overrides {
            match own.get(name) {
                Some(a) => self.nodes(*a, *b),
                None => changed.push(format!("material of {name}")),
            }
        }
        let gone = own.keys().filter(|name| !y.overrides.iter().any(|(it, _)| it == **name));
        changed.extend(gone.map(|name| format!("material of {name}")));
        if !changed.is_empty() {
            self.changed(y, changed);
        }
    }

    fn changed(&mut self, node: &Node, names: Vec<String>) {
        self.lone(node, How::Changed(names));
    }

    fn lone(&mut self, node: &Node, how: How) {
        self.found.push(Difference { what: called(node), how, span: Some(node.span) });
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
            Target::Node(id) => called(self.scenes[i].node(id)),
            Target::Group(id) => match &self.scenes[i].group(id).label {
                Some(label) => format!("group \"{label}\""),
                None => "group".to_owned(),
            },
        }
    }
}

/// What people call an object: its class, and its name if it has one.
pub fn called(node: &Node) -> String {
    match &node.label {
        Some(label) => format!("{} \"{label}\"", node.class),
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
