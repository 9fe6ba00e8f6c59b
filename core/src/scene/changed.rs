//! A scene some of whose parameters get other values.

use std::ops::Range;

use super::compact::IsOver;
use super::parts::{each_in_parts, in_parts};
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

/// The values of parameters before and after, hashed.
#[derive(Default)]
struct Said {
    before: Terms,
    after: Terms,
}

/// Neighbours whose parameters are one piece of memory.
struct Block<'a> {
    /// The number of the first.
    first: usize,
    nodes: &'a mut [Node],
    own: &'a mut [Hash],
    /// The changes of each parameter, and what they add to its node's hash.
    each: &'a [&'a [Changed]],
    terms: &'a [Sum],
}

impl Block<'_> {
    fn change(self, values: &[Value]) {
        let Self { first, nodes, own, each, terms } = self;
        let (mut all, ranges) = Arguments::taken(nodes.iter_mut().map(|node| &mut node.params));
        for (changes, term) in each.iter().zip(terms) {
            let i = changes[0].node as usize - first;
            let argument = &mut all[ranges[i].start as usize + changes[0].argument as usize];
            put(&mut argument.value, changes, values);
            let is_own = is_own(nodes[i].kind, argument.name);
            for hash in [&mut nodes[i].hash].into_iter().chain(is_own.then_some(&mut own[i])) {
                *hash = Sum::of(hash).plus(*term).hash();
            }
        }
        for (node, params) in nodes.iter_mut().zip(Arguments::of_one(all, ranges)) {
            node.params = params;
        }
    }
}

/// Puts what changes of one parameter into its value.
fn put(value: &mut Value, changes: &[Changed], values: &[Value]) {
    for change in changes {
        let new = &values[change.value as usize];
        match (&mut *value, change.item, new) {
            (Value::Vector(numbers), Some(i), Value::Number(x, _)) => {
                if let Some(number) = numbers.get_mut(usize::from(i)) {
                    *number = *x;
                }
            }
            _ => *value = new.clone(),
        }
    }
}

impl Scene {
    /// Gives parameters other values, in a scene whose nodes are hashed.
    ///
    /// `changes` go by node and parameter, of a vector by number. `runs` are nodes that follow one another, of
    /// which one may refer to another before it in its run; nothing else refers to a node that changes, and no
    /// value does. `None`, and a scene of no use, once it is over.
    pub fn change(
        &mut self,
        runs: &[Range<usize>],
        (changes, values): (&[Changed], &[Value]),
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let is_one = |one: &Changed, other: &Changed| {
            (one.node, one.argument) == (other.node, other.argument)
        };
        let each: Vec<&[Changed]> = changes.chunk_by(is_one).collect();
        let terms = |some: &[&[Changed]], out: &mut Vec<Sum>| {
            let mut said = Said::default();
            out.extend(some.iter().map(|changes| self.term(changes, values, &mut said)));
        };
        let terms = in_parts(&each, is_over, &terms)?;
        each_in_parts(self.blocks(&each, &terms), &|block: Block<'_>| block.change(values));
        self.hash_outer(runs);
        Some(())
    }

    /// What the changes of one parameter add to the hash of its node; what refers to it is as it was.
    fn term(&self, changes: &[Changed], values: &[Value], said: &mut Said) -> Sum {
        let Changed { node, argument, .. } = changes[0];
        let Argument { name, value, .. } = &self.nodes[node as usize].params[argument as usize];
        let (at, child) = ((argument as usize, *name), |id: NodeId| self.node(id).hash);
        let before = said.before.param(at, value, child);
        let after = if let [Changed { item: None, value, .. }] = changes {
            said.after.param(at, &values[*value as usize], child)
        } else {
            let mut new = value.clone();
            put(&mut new, changes, values);
            said.after.param(at, &new, child)
        };
        after.minus(before)
    }

    /// The nodes whose parameters are one piece of memory, as far as they change, with what becomes of each.
    fn blocks<'a>(&'a mut self, each: &'a [&'a [Changed]], terms: &'a [Sum]) -> Vec<Block<'a>> {
        let mut out = vec![];
        let (mut first, mut each, mut terms) = (0, each, terms);
        let mut own = self.own.as_mut_slice();
        let beside = |one: &Node, other: &Node| one.params.is_beside(&other.params);
        for nodes in self.nodes.chunk_by_mut(beside) {
            let (hashes, others) = std::mem::take(&mut own).split_at_mut(nodes.len());
            let end = first + nodes.len();
            let n = each.iter().take_while(|changes| (changes[0].node as usize) < end).count();
            if n > 0 {
                let (each, terms) = (&each[..n], &terms[..n]);
                out.push(Block { first, nodes, own: hashes, each, terms });
            }
            (own, first, each, terms) = (others, end, &each[n..], &terms[n..]);
        }
        out
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
        // What refers to the first is behind it in its run, what refers to the fourth too.
        let put = |scene: &mut Scene, changes: &[Changed]| {
            scene.change(&[0..3, 3..5], (changes, &values), &|| false).unwrap();
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
        scene.change(&[], (&changes, &[-1.0, -2.0].map(number)), &|| false).unwrap();
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
        let changes = [change(0, Some(0), 0), change(0, Some(2), 1), change(1, Some(1), 1)];
        scene.change(&[], (&changes, &values), &|| false).unwrap();
        assert_eq!(scene, made([[7.0, 2.0, 8.0], [4.0, 8.0, 6.0]]));
        scene.change(&[], (&[change(1, None, 2)], &values), &|| false).unwrap();
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
