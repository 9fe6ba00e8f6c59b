//! A scene some of whose parameters get other values.

use std::ops::Range;

use super::compact::IsOver;
use super::gather::in_parts;
use super::{Argument, Arguments, Hash, Node, NodeId, Scene, Value, hash, own_hash};

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

/// Nodes that follow one another, and what changes of them.
type Part<'a> = (&'a Range<usize>, &'a [Changed]);

impl Scene {
    /// Gives parameters other values, in a scene whose nodes are hashed.
    ///
    /// `changes` go by node and parameter, and all lie in `runs` of nodes, which follow one another. No node
    /// but those behind it in its run refers to one of a run. `None`, and a scene of no use, once it is over.
    pub fn change(
        &mut self,
        runs: &[Range<usize>],
        (changes, values): (&[Changed], &[Value]),
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let (mut parts, mut left): (Vec<Part<'_>>, _) = (vec![], changes);
        for run in runs {
            let n = left.partition_point(|change| (change.node as usize) < run.end);
            let (own, others) = left.split_at(n);
            parts.push((run, own));
            left = others;
        }
        let changed =
            |parts: &[Part<'_>], out: &mut Vec<_>| out.extend(self.changed(parts, values));
        let params = in_parts(&parts, is_over, &changed)?;
        let nodes = || runs.iter().cloned().flatten();
        for (i, params) in nodes().zip(params) {
            self.nodes[i].params = params;
        }
        let hashes = in_parts(runs, is_over, &|runs, out| self.hashes_of(runs, out))?;
        for (i, (hash, own)) in nodes().zip(hashes) {
            (self.nodes[i].hash, self.own[i]) = (hash, own);
        }
        Some(())
    }

    /// The parameters of nodes after changes.
    fn changed(&self, parts: &[Part<'_>], values: &[Value]) -> impl Iterator<Item = Arguments> {
        let (mut all, mut lengths) = (vec![], vec![]);
        for (run, changes) in parts {
            let mut changes = changes.iter().peekable();
            for i in (*run).clone() {
                let params = &self.nodes[i].params;
                lengths.push(u32::try_from(params.len()).unwrap_or(u32::MAX));
                for (k, argument) in params.iter().enumerate() {
                    let is_it = |change: &&Changed| {
                        change.node as usize == i && change.argument as usize == k
                    };
                    all.push(match changes.next_if(is_it) {
                        Some(change) => {
                            let value = values[change.value as usize].clone();
                            Argument { value, ..*argument }
                        }
                        None => argument.clone(),
                    });
                }
            }
        }
        Arguments::runs(all, lengths)
    }

    /// Adds the hashes of nodes in runs, of which only nodes behind them in the same run refer to them.
    fn hashes_of(&self, runs: &[Range<usize>], out: &mut Vec<(Hash, Hash)>) {
        for run in runs {
            let first = out.len();
            for node in &self.nodes[run.clone()] {
                out.push(self.hashes_in(node, run.start, &out[first..]));
            }
        }
    }

    /// The hashes of a node, where those of the nodes from `start` on are new.
    fn hashes_in(&self, node: &Node, start: usize, new: &[(Hash, Hash)]) -> (Hash, Hash) {
        let child = |id: NodeId| {
            let new = (id.0 as usize).checked_sub(start).and_then(|i| new.get(i));
            new.map_or_else(|| self.node(id).hash, |(hash, _)| *hash)
        };
        let hash = hash::hash_node(node, child);
        (hash, own_hash(node, hash, child))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::compact::tests::node;

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
