//! A scene some of whose parameters get other values.

use std::ops::Range;

use luxel_sdk::kind::Kind;

use super::compact::{IsOver, look};
use super::parts::{each_in_parts, n_cores};
use super::terms::{Sum, Terms, is_own};
use super::{Argument, Arguments, Hash, Node, NodeId, Scene, Value};

/// Another value for a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changed {
    /// The node, by number.
    pub node: u32,
    /// Which of its parameters.
    pub argument: u32,
    /// Which number of a vector, that becomes another one; `None` of the whole value.
    pub item: Option<u8>,
    /// Which of the values that there are.
    pub value: u32,
}

/// Values that parameters get, by their numbers.
#[derive(Clone, Copy)]
pub struct NewValues<'a> {
    /// How many there are.
    pub n: u32,
    /// One of them; `None` where the parameter keeps what it has.
    pub get: &'a (dyn Fn(u32) -> Option<Value> + Sync),
}

/// What changes, and what it takes to hash it.
struct Change<'a> {
    values: NewValues<'a>,
    /// Of each node its hash before, if a value that changes is a node; what refers to it is as it was.
    hashes: Vec<Hash>,
    is_over: IsOver<'a>,
}

/// Neighbours, of which none has its parameters in one piece of memory with one that stands elsewhere.
struct Part<'a> {
    /// The number of the first.
    first: usize,
    nodes: &'a mut [Node],
    own: &'a mut [Hash],
    /// The changes of each parameter.
    each: &'a [&'a [Changed]],
}

/// The values of parameters before and after, hashed.
#[derive(Default)]
struct Said {
    before: Terms,
    after: Terms,
    /// Whether the parameter of that name was one of the class's own.
    is_own: Option<(Kind, &'static str, bool)>,
}

impl Said {
    fn is_own(&mut self, kind: Kind, name: &'static str) -> bool {
        match self.is_own {
            Some((of, last, is_own)) if of == kind && std::ptr::eq(last, name) => is_own,
            _ => self.is_own.insert((kind, name, is_own(kind, name))).2,
        }
    }
}

impl Part<'_> {
    /// The first so many nodes, and the others.
    fn split(self, n: usize) -> (Self, Self) {
        let Self { first, nodes, own, each } = self;
        let (nodes, other_nodes) = nodes.split_at_mut(n);
        let (own, other_own) = own.split_at_mut(n);
        let is_before = |changes: &&[Changed]| (changes[0].node as usize) < first + n;
        let (each, other_each) = each.split_at(each.partition_point(is_before));
        let others =
            Self { first: first + n, nodes: other_nodes, own: other_own, each: other_each };
        (Self { first, nodes, own, each }, others)
    }

    /// So many nodes or a few more: all whose parameters are one piece of memory.
    fn n_beside(&self, n: usize) -> usize {
        let Some(last) = n.checked_sub(1).filter(|last| *last < self.nodes.len()) else { return n };
        let last = &self.nodes[last].params;
        let more = self.nodes[n..].iter().take_while(|node| node.params.is_beside(last));
        n + more.count()
    }

    /// Parts of so many nodes each, or a few more.
    fn parts(self, n: usize) -> Vec<Self> {
        let (mut out, mut left) = (vec![], self);
        while !left.nodes.is_empty() {
            let n = left.n_beside(n).min(left.nodes.len());
            let (part, others) = left.split(n);
            out.push(part);
            left = others;
        }
        out
    }

    fn change(self, change: &Change<'_>) {
        let mut left = self;
        while !left.each.is_empty() && !(change.is_over)() {
            let n = left.n_beside(1);
            let (block, others) = left.split(n);
            block.change_block(change);
            left = others;
        }
    }

    /// The same of nodes whose parameters are one piece of memory.
    fn change_block(self, Change { values, hashes, .. }: &Change<'_>) {
        let Self { first, nodes, own, each } = self;
        if each.is_empty() {
            return;
        }
        let child = |id: NodeId| hashes[id.0 as usize];
        let mut said = Said::default();
        let (mut all, ranges) = Arguments::taken(nodes.iter_mut().map(|node| &mut node.params));
        for changes in each {
            let (i, k) = (changes[0].node as usize - first, changes[0].argument as usize);
            let Argument { name, value, .. } = &mut all[ranges[i].start as usize + k];
            let before = said.before.param((k, name), value, child);
            put(value, changes, *values);
            let term = said.after.param((k, name), value, child).minus(before);
            let is_own = said.is_own(nodes[i].kind, name);
            for hash in [&mut nodes[i].hash].into_iter().chain(is_own.then_some(&mut own[i])) {
                *hash = Sum::of(hash).plus(term).hash();
            }
        }
        for (node, params) in nodes.iter_mut().zip(Arguments::of_one(all, ranges)) {
            node.params = params;
        }
    }
}

/// Puts what changes of one parameter into its value.
fn put(value: &mut Value, changes: &[Changed], values: NewValues<'_>) {
    for change in changes {
        match (&mut *value, change.item, (values.get)(change.value)) {
            (_, _, None) => {}
            (Value::Vector(numbers), Some(i), Some(Value::Number(x, _))) => {
                if let Some(number) = numbers.get_mut(usize::from(i)) {
                    *number = x;
                }
            }
            (_, _, Some(new)) => *value = new,
        }
    }
}

impl Scene {
    /// Gives parameters other values, in a scene whose nodes are hashed.
    ///
    /// `changes` go by node and parameter, of a vector by number. `runs` are nodes that follow one another, of
    /// which one may refer to another before it in its run; nothing else refers to a node that changes, and no
    /// value does. In the place of a node comes a node, and of nothing else. `None`, and a scene of no use, once
    /// it is over.
    pub fn change(
        &mut self,
        runs: &[Range<usize>],
        (changes, values): (&[Changed], NewValues<'_>),
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let is_one = |one: &Changed, other: &Changed| {
            (one.node, one.argument) == (other.node, other.argument)
        };
        let each: Vec<&[Changed]> = changes.chunk_by(is_one).collect();
        let is_node = |i: u32| matches!((values.get)(i), Some(Value::Node(_) | Value::Moved(..)));
        let hashes = if (0..values.n).any(is_node) {
            self.nodes.iter().map(|node| node.hash).collect()
        } else {
            vec![]
        };
        let n = self.nodes.len().div_ceil(n_cores());
        let all = Part { first: 0, nodes: &mut self.nodes, own: &mut self.own, each: &each };
        let change = Change { values, hashes, is_over };
        each_in_parts(all.parts(n), &|part: Part<'_>| part.change(&change));
        look(is_over)?;
        self.hash_outer(runs);
        Some(())
    }

    /// Hashes the nodes of runs that refer to others of their run.
    fn hash_outer(&mut self, runs: &[Range<usize>]) {
        let mut terms = Terms::default();
        for run in runs.iter().filter(|run| run.len() > 1) {
            for i in run.clone() {
                let node = &self.nodes[i];
                if node.children().any(|id| run.contains(&(id.0 as usize))) {
                    let hashes = terms.hashes(node, |id| self.node(id).hash);
                    [self.nodes[i].hash, self.own[i]] = hashes;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::compact::STRIDE;
    use crate::scene::compact::tests::node;
    use crate::scene::{Argument, Node};

    #[test]
    fn what_is_changed_is_what_has_these_values_from_the_first() {
        let made = |numbers: [f64; 5]| {
            let inner = [None, Some(0), Some(1), None, Some(3)];
            let mut scene = Scene {
                nodes: numbers.iter().zip(inner).map(|(x, inner)| numbered(*x, inner)).collect(),
                ..Scene::default()
            };
            scene.prepare(&|span| span, &|| false).unwrap();
            scene
        };
        let mut scene = made([0.0, 1.0, 2.0, 3.0, 4.0]);
        let change = |node, value| Changed { node, argument: 0, item: None, value };
        let values = [7.0, 8.0].map(number);
        let values = NewValues { n: 2, get: &|i| values.get(i as usize).cloned() };
        // What refers to the first is behind it in its run, what refers to the fourth too.
        let put = |scene: &mut Scene, changes: &[Changed]| {
            scene.change(&[0..3, 3..5], (changes, values), &|| false).unwrap();
        };
        put(&mut scene, &[change(0, 0), change(2, 1), change(3, 0)]);
        assert_eq!(scene, made([7.0, 1.0, 8.0, 7.0, 4.0]));
        put(&mut scene, &[change(4, 1)]);
        assert_eq!(scene, made([7.0, 1.0, 8.0, 7.0, 8.0]));
    }

    #[test]
    fn nodes_whose_parameters_lie_far_apart_are_changed_at_once() {
        let n = u32::try_from(2 * STRIDE + 7).unwrap();
        let made = |x: &dyn Fn(u32) -> f64| {
            let nodes = (0..n).map(|i| numbered(x(i), None)).collect();
            let mut scene = Scene { nodes, ..Scene::default() };
            scene.prepare(&|span| span, &|| false).unwrap();
            scene
        };
        let is_changed = |i: u32| i % 3 == 1 && i / 1000 != 5;
        let mut scene = made(&f64::from);
        let change = |node| Changed { node, argument: 0, item: None, value: node % 2 };
        let changes: Vec<_> = (0..n).filter(|i| is_changed(*i)).map(change).collect();
        let values = NewValues { n: 2, get: &|i| Some(number(-1.0 - f64::from(i))) };
        scene.change(&[], (&changes, values), &|| false).unwrap();
        let new = |i: u32| if is_changed(i) { -1.0 - f64::from(i % 2) } else { f64::from(i) };
        assert!(scene == made(&new));
    }

    #[test]
    fn of_a_vector_some_numbers_are_changed() {
        let made = |vectors: [[f64; 3]; 2]| {
            let node = |vector: [f64; 3]| {
                let mut node = numbered(1.0, None);
                node.params.to_mut()[0].value = Value::vector(vector);
                node
            };
            let nodes = vectors.map(node).into();
            let mut scene = Scene { nodes, ..Scene::default() };
            scene.prepare(&|span| span, &|| false).unwrap();
            scene
        };
        let mut scene = made([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let change = |node, item, value| Changed { node, argument: 0, item, value };
        let values = [number(7.0), number(8.0), Value::vector([0.0; 3])];
        let values = NewValues { n: 3, get: &|i| values.get(i as usize).cloned() };
        let changes = [change(0, Some(0), 0), change(0, Some(2), 1), change(1, Some(1), 1)];
        scene.change(&[], (&changes, values), &|| false).unwrap();
        assert_eq!(scene, made([[7.0, 2.0, 8.0], [4.0, 8.0, 6.0]]));
        scene.change(&[], (&[change(1, None, 2)], values), &|| false).unwrap();
        assert_eq!(scene, made([[7.0, 2.0, 8.0], [0.0; 3]]));
    }

    fn number(x: f64) -> Value {
        Value::Number(x, luxel_sdk::params::Dimension::NONE)
    }

    /// A node with a number, that may refer to another.
    fn numbered(x: f64, inner: Option<u32>) -> Node {
        let mut node = node(0, inner);
        let span = node.span;
        node.params.to_mut().insert(0, Argument { name: "number", value: number(x), span });
        node
    }
}
