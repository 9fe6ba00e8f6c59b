//! Binary trees: obvhs clusters the parts, we join them.
//!
//! Source: Meister and Bittner 2018 (parallel locally-ordered clustering, reinsertion), in obvhs.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::node::{Bounds, narrow};
use super::partition::{Part, Prim, halve};

/// Binary levels a clustered part may have. With the at most 12 + 18 levels above it the stack
/// need stays at 3·78 + 4 entries or fewer, and a stack of 256 is always enough.
const PART_DEPTH: usize = 48;

/// Equal centres that a part may have before it is cut instead of clustered: clustering turns n
/// equal boxes into a chain of depth n, in n² time.
const MAX_EQUAL: usize = 8;

/// Share of the nodes that obvhs tries to place better, per round.
const REINSERTION: f32 = 0.02;

/// The binary tree over all primitives; leaves hold positions in `prims`, which is reordered.
pub(super) fn binary(prims: &mut [Prim]) -> Vec<Bvh2Node> {
    let upper = Part::cut(prims);
    let parts = slices(prims, &upper);
    let sizes: Vec<usize> = parts.iter().map(|part| part.len()).collect();
    let lower: Vec<Vec<Bvh2Node>> = parts.into_iter().map(cluster).collect();
    let bounds: Vec<Bounds> = lower.iter().map(|tree| bounds(&tree[0])).collect();
    let mut nodes = join(&upper, &bounds);
    for at in 0..nodes.len() {
        if !nodes[at].is_leaf() {
            continue;
        }
        // The root of the part replaces this leaf; its other nodes follow at the end.
        let part = nodes[at].first_index as usize;
        let first: usize = sizes[..part].iter().sum();
        let base = nodes.len() - 1;
        let tree = lower[part].iter().map(|node| {
            let by = if node.is_leaf() { first } else { base };
            Bvh2Node { first_index: node.first_index + narrow(by), ..*node }
        });
        let mut tree = tree.collect::<Vec<_>>().into_iter();
        nodes[at] = tree.next().expect("a part has at least one primitive");
        nodes.extend(tree);
    }
    nodes
}

/// The parts themselves.
pub(super) fn slices<'a>(mut prims: &'a mut [Prim], upper: &Part) -> Vec<&'a mut [Prim]> {
    let mut parts = Vec::new();
    for size in upper.sizes() {
        let (part, rest) = prims.split_at_mut(size);
        parts.push(part);
        prims = rest;
    }
    parts
}

/// The binary tree of one part, of bounded depth.
pub(super) fn cluster(prims: &mut [Prim]) -> Vec<Bvh2Node> {
    if most_equal(prims) <= MAX_EQUAL {
        let order = (0..narrow(prims.len())).collect();
        let mut builder = PlocBuilder::new();
        let mut bvh =
            builder.build(PlocSearchDistance::VeryLow, prims, order, SortPrecision::U64, 0);
        if is_within(PART_DEPTH, &bvh.nodes) {
            ReinsertionOptimizer::default().run(&mut bvh, REINSERTION, None);
            if is_within(PART_DEPTH, &bvh.nodes) {
                return bvh.nodes;
            }
        }
    }
    let mut nodes = vec![Bvh2Node::default()];
    halves(prims, 0, &mut Halves { nodes: &mut nodes, first: 0 }, 0);
    nodes
}

/// The size of the largest group with the same box centre.
fn most_equal(prims: &[Prim]) -> usize {
    if prims.len() <= MAX_EQUAL {
        return prims.len().min(1);
    }
    let mut keys: Vec<u64> = prims
        .iter()
        .map(|p| {
            // Adding zero makes one key of both zeros; unequal centres may share a key, harmlessly.
            let [x, y, z] = (p.bounds.min + p.bounds.max + Vec3::ZERO)
                .to_array()
                .map(|c| u64::from(c.to_bits()));
            (x | y << 32).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29) ^ z << 16
        })
        .collect();
    keys.sort_unstable();
    keys.chunk_by(|a, b| a == b).map(<[u64]>::len).max().unwrap_or(0)
}

struct Halves<'a> {
    nodes: &'a mut Vec<Bvh2Node>,
    first: usize,
}

/// Builds `nodes[at]` by cutting down to single primitives.
fn halves(prims: &mut [Prim], at: usize, out: &mut Halves<'_>, depth: usize) {
    let all = prims.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds));
    if prims.len() == 1 {
        out.nodes[at] = binary_node(all, 1, out.first);
        out.first += 1;
        return;
    }
    let children = out.nodes.len();
    out.nodes[at] = binary_node(all, 0, children);
    out.nodes.extend([Bvh2Node::default(); 2]);
    let (left, right) = halve(prims, depth);
    halves(left, children, out, depth + 1);
    halves(right, children + 1, out, depth + 1);
}

/// The upper tree over the boxes of its parts; leaves hold the number of a part.
pub(super) fn join(upper: &Part, parts: &[Bounds]) -> Vec<Bvh2Node> {
    let mut out = Upper { nodes: vec![Bvh2Node::default()], parts, part: 0 };
    out.fill(upper, 0);
    out.nodes
}

struct Upper<'a> {
    nodes: Vec<Bvh2Node>,
    parts: &'a [Bounds],
    /// How many parts have been met.
    part: usize,
}

impl Upper<'_> {
    fn fill(&mut self, upper: &Part, at: usize) -> Bounds {
        match upper {
            Part::Leaf(_) => {
                let bounds = self.parts[self.part];
                self.nodes[at] = binary_node(bounds, 1, self.part);
                self.part += 1;
                bounds
            }
            Part::Split(halves) => {
                let children = self.nodes.len();
                self.nodes.extend([Bvh2Node::default(); 2]);
                let left = self.fill(&halves[0], children);
                let all = left.union(self.fill(&halves[1], children + 1));
                self.nodes[at] = binary_node(all, 0, children);
                all
            }
        }
    }
}

/// A node's box in our type.
pub(super) fn bounds(node: &Bvh2Node) -> Bounds {
    let aabb = node.aabb();
    Bounds { min: Vec3::from(aabb.min), max: Vec3::from(aabb.max) }
}

fn binary_node(bounds: Bounds, n_prims: u32, first: usize) -> Bvh2Node {
    Bvh2Node::new(Aabb::new(bounds.min.into(), bounds.max.into()), n_prims, narrow(first))
}

/// True if no path of the tree has more nodes than this.
fn is_within(depth: usize, nodes: &[Bvh2Node]) -> bool {
    let mut stack = vec![(0u32, 1usize)];
    while let Some((index, level)) = stack.pop() {
        if level > depth {
            return false;
        }
        let node = &nodes[index as usize];
        if !node.is_leaf() {
            stack.extend([(node.first_index, level + 1), (node.first_index + 1, level + 1)]);
        }
    }
    true
}
