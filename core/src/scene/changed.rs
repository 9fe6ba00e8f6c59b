//! A scene some of whose parameters get other values.

use std::ops::Range;

use super::compact::{IsOver, STRIDE, look};
use super::terms::{Sum, Terms, is_own};
use super::{Arguments, NodeId, Scene, Value};

/// Another value for a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changed {
    /// The node, by number.
    pub node: u32,
    /// Which of its parameters.
    pub argument: u32,
    /// Which of the values that there are.
    pub value: u32,
}

/// The values of parameters before and after, hashed.
#[derive(Default)]
struct Said {
    before: Terms,
    after: Terms,
}

impl Scene {
    /// Gives parameters other values, in a scene whose nodes are hashed.
    ///
    /// `changes` go by node and parameter. `runs` are nodes that follow one another, of which one may refer to
    /// another before it in its run; nothing else refers to a node that changes, and no value does. `None`,
    /// and a scene of no use, once it is over.
    pub fn change(
        &mut self,
        runs: &[Range<usize>],
        (changes, values): (&[Changed], &[Value]),
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let mut said = Said::default();
        let beside = self.nodes.chunk_by(|one, other| one.params.is_beside(&other.params));
        let lengths: Vec<usize> = beside.map(<[_]>::len).collect();
        let (mut start, mut left) = (0, changes);
        for length in lengths {
            let end = start + length;
            let n = left.iter().take_while(|change| (change.node as usize) < end).count();
            let (own, others) = left.split_at(n);
            if !own.is_empty() {
                self.change_beside(start..end, (own, values), &mut said, is_over)?;
            }
            (start, left) = (end, others);
        }
        self.hash_outer(runs);
        Some(())
    }

    /// The same of neighbours whose parameters are one piece of memory; what refers to them is as it was.
    fn change_beside(
        &mut self,
        nodes: Range<usize>,
        (changes, values): (&[Changed], &[Value]),
        said: &mut Said,
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let lists = self.nodes[nodes.clone()].iter_mut().map(|node| &mut node.params);
        let (mut all, ranges) = Arguments::taken(lists);
        for few in changes.chunks(STRIDE) {
            look(is_over)?;
            for change in few {
                let (i, k) = (change.node as usize, change.argument as usize);
                let argument = &mut all[ranges[i - nodes.start].start as usize + k];
                let value = &values[change.value as usize];
                let child = |id: NodeId| self.node(id).hash;
                let before = said.before.param((k, argument.name), &argument.value, child);
                let after = said.after.param((k, argument.name), value, child);
                argument.value = value.clone();
                let node = &mut self.nodes[i];
                let is_own = is_own(node.kind, argument.name);
                for hash in [&mut node.hash].into_iter().chain(is_own.then_some(&mut self.own[i])) {
                    *hash = Sum::of(hash).minus(before).plus(after).hash();
                }
            }
        }
        for (node, params) in self.nodes[nodes].iter_mut().zip(Arguments::of_one(all, ranges)) {
            node.params = params;
        }
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
        let change = |node, value| Changed { node, argument: 0, value };
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
