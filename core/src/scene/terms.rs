//! The hash of a node: the sum of the hashes of what it says. Where one of these changes, the others need
//! not be hashed again.

use luxel_sdk::kind::Kind;

use super::hash::{Hashing, hash_value, text};
use super::{Argument, Hash, Node, NodeId, Value};
use crate::registry::common_params;

/// Seeds of what is hashed by itself.
const PLAIN: [u64; 2] = [0, 1];

/// A sum of hashes: four numbers of 64 bits, each for itself, which wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sum([u64; 4]);

impl Sum {
    pub(super) fn of(hash: &Hash) -> Self {
        let mut words = hash.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word));
        Self(std::array::from_fn(|_| words.next().unwrap_or_default()))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].wrapping_add(other.0[i])))
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].wrapping_sub(other.0[i])))
    }

    pub(super) fn hash(self) -> Hash {
        let mut hash = Hash::default();
        for (to, word) in hash.as_chunks_mut().0.iter_mut().zip(self.0) {
            *to = word.to_le_bytes();
        }
        hash
    }
}

/// Hashes what nodes say. What the last node said too is not hashed again.
///
/// Hashes of nodes that are referred to must be what they are for as long as it is used.
#[derive(Default)]
pub(super) struct Terms {
    class: Option<(Kind, &'static str, Sum)>,
    /// By the place among a node's parameters.
    params: Vec<Param>,
}

/// What was said last of a parameter.
#[derive(Clone, Default)]
struct Param {
    name: &'static str,
    /// Seeds of what its values are hashed by: parts of the hash of its name.
    seeds: [u64; 2],
    said: Option<(Value, Sum)>,
}

impl Terms {
    /// The hash of a node, its children by theirs, and the same without the parameters that the host adds
    /// to its kind. Label and place in the file do not count.
    pub(super) fn hashes(&mut self, node: &Node, child: impl Fn(NodeId) -> Hash) -> [Hash; 2] {
        let (mut own, mut host) = (self.class(node), Sum::default());
        for (k, argument) in node.params.iter().enumerate() {
            let term = self.param((k, argument.name), &argument.value, &child);
            let sum = if is_own(node.kind, argument.name) { &mut own } else { &mut host };
            *sum = sum.plus(term);
        }
        for (name, material) in &node.overrides {
            let mut hashing = Hashing::default();
            hashing.update(b"override");
            text(&mut hashing, name);
            hashing.update(&child(*material));
            own = own.plus(Sum::of(&hashing.finish_soon(PLAIN)));
        }
        [own.plus(host).hash(), own.hash()]
    }

    fn class(&mut self, node: &Node) -> Sum {
        match &self.class {
            Some((kind, class, term)) if *kind == node.kind && *class == node.class => *term,
            _ => {
                let mut hashing = Hashing::default();
                hashing.update(b"class");
                text(&mut hashing, node.kind.word());
                text(&mut hashing, node.class);
                let term = Sum::of(&hashing.finish_soon(PLAIN));
                self.class = Some((node.kind, node.class, term));
                term
            }
        }
    }

    /// What a parameter adds, the one of that number and name.
    pub(super) fn param(
        &mut self,
        (k, name): (usize, &'static str),
        value: &Value,
        child: impl Fn(NodeId) -> Hash,
    ) -> Sum {
        if self.params.len() <= k {
            self.params.resize(k + 1, Param::default());
        }
        let param = &mut self.params[k];
        if param.name != name {
            *param = Param { name, seeds: seeds(name), said: None };
        }
        match &param.said {
            Some((said, term)) if is_same(said, value) => *term,
            _ => {
                let term = term(value, param.seeds, child);
                param.said = Some((value.clone(), term));
                term
            }
        }
    }
}

/// What the parameters of these names, if they were given, add to a node's hash.
pub(super) fn of_params(node: &Node, names: &[&str], child: impl Fn(NodeId) -> Hash) -> Sum {
    let those = node.params.iter().filter(|argument| names.contains(&argument.name));
    let terms = those.map(|Argument { name, value, .. }| term(value, seeds(name), &child));
    terms.fold(Sum::default(), Sum::plus)
}

/// Seeds of what values of the parameter of a name are hashed by.
fn seeds(name: &str) -> [u64; 2] {
    let mut hashing = Hashing::default();
    hashing.update(b"param");
    text(&mut hashing, name);
    let Sum([one, other, ..]) = Sum::of(&hashing.finish_soon(PLAIN));
    [one, other]
}

/// What the value of a parameter adds.
fn term(value: &Value, seeds: [u64; 2], child: impl Fn(NodeId) -> Hash) -> Sum {
    let mut hashing = Hashing::default();
    hash_value(&mut hashing, value, &child);
    Sum::of(&hashing.finish_soon(seeds))
}

/// Whether a parameter is the class's own, not one that the host adds to its kind.
pub(super) fn is_own(kind: Kind, name: &str) -> bool {
    common_params(kind).iter().all(|param| param.name != name)
}

/// Whether values are found soon to have the same bits.
fn is_same(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Number(x, measure), Value::Number(y, other)) => {
            x.to_bits() == y.to_bits() && measure == other
        }
        (Value::Vector(one), Value::Vector(other)) => {
            one.iter().map(|x| x.to_bits()).eq(other.iter().map(|x| x.to_bits()))
        }
        (Value::Node(one), Value::Node(other)) => one == other,
        (Value::Bool(one), Value::Bool(other)) => one == other,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::params::Dimension;

    use super::*;
    use crate::diag::{SourceId, Span};

    fn node(params: &[(&'static str, Value)]) -> Node {
        let span = Span::new(SourceId(0), 0, 0);
        let argument =
            |(name, value): &(&'static str, Value)| Argument { name, value: value.clone(), span };
        Node {
            kind: Kind::Shape,
            class: "sphere",
            label: None,
            params: params.iter().map(argument).collect(),
            overrides: vec![],
            span,
            hash: [0; 32],
        }
    }

    fn number(x: f64) -> Value {
        Value::Number(x, Dimension::NONE)
    }

    fn child(id: NodeId) -> Hash {
        [u8::try_from(id.0).unwrap(); 32]
    }

    #[test]
    fn what_the_last_said_too_counts_for_both() {
        let values = [number(0.0), number(-0.0), number(1.0), Value::Node(NodeId(1))];
        let vectors = [[0.0, 1.0], [-0.0, 1.0]].map(Value::vector);
        let more = [Value::Node(NodeId(2)), Value::Bool(true), Value::vector([1.0])];
        let all = || values.iter().chain(&more).chain(&vectors);
        let mut terms = Terms::default();
        let mut met = vec![];
        for (radius, material) in all().flat_map(|one| all().map(move |other| (one, other))) {
            let node = node(&[("radius", radius.clone()), ("material", material.clone())]);
            let hashes = terms.hashes(&node, child);
            assert_eq!(hashes, Terms::default().hashes(&node, child), "{radius:?}, {material:?}");
            met.push(hashes[0]);
        }
        let n = met.len();
        met.sort_unstable();
        met.dedup();
        assert_eq!(met.len(), n, "each is another node");
    }

    #[test]
    fn a_hash_without_a_parameter_is_that_of_the_node_without_it() {
        let whole = node(&[("radius", number(2.0)), ("material", Value::Node(NodeId(3)))]);
        let without = node(&[("radius", number(2.0))]);
        let [hash, own] = Terms::default().hashes(&whole, child);
        let [less, same] = Terms::default().hashes(&without, child);
        assert_eq!(Sum::of(&hash).minus(of_params(&whole, &["material"], child)).hash(), less);
        assert_eq!([own, own], [less, same]);
        assert_ne!(hash, less);
    }

    #[test]
    fn sums_are_taken_apart_again() {
        for (one, other) in [(0, 0), (1, 255), (7, 99)] {
            let [one, other] = [one, other].map(|byte: u8| Sum::of(&[byte; 32]));
            assert_eq!(one.plus(other).minus(other), one);
            assert_eq!(Sum::of(&one.hash()), one);
        }
    }
}
