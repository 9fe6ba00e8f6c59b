//! Binary trees: obvhs clusters the parts, we join them.
//!
//! Source: Meister and Bittner 2018 (parallel locally-ordered clustering, reinsertion), in obvhs.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::collapse::Binary;
use super::node::{Bounds, narrow};
use super::partition::{Part, Prim, centres, halve};
use super::watch::Watch;

/// Binary levels a clustered part may have. With the at most 12 + 18 levels above it the stack
/// need stays at 3·78 + 4 entries or fewer, and a stack of 256 is always enough.
const PART_DEPTH: usize = 48;

/// Equal centres that a part may have before it is cut instead of clustered: clustering turns n
/// equal boxes into a chain of depth n, in n² time.
const MAX_EQUAL: usize = 8;

/// Share of the nodes that obvhs tries to place better, in the first round.
const REINSERTION: f32 = 0.02;

/// Shares of that in each round. The twelve of less that obvhs would add change next to nothing.
const ROUNDS: [f32; 4] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0];

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

/// Clusters one part after another in the same memory.
#[derive(Default)]
pub(super) struct Clusters {
    builder: PlocBuilder,
    optimizer: ReinsertionOptimizer,
    bvh: Bvh2,
    walk: Walk,
    groups: Vec<u8>,
}

impl Clusters {
    /// The binary tree of one part, of bounded depth.
    pub(super) fn of(&mut self, prims: &mut [Prim]) -> Binary<'_> {
        if self.has_few_equal(prims) {
            let mut order = std::mem::take(&mut self.bvh.primitive_indices);
            order.clear();
            order.extend(0..narrow(prims.len()));
            let (distance, sort) = (PlocSearchDistance::VeryLow, SortPrecision::U64);
            self.builder.build_with_bvh(&mut self.bvh, distance, prims, order, sort, 0);
            if self.walk.down(&self.bvh.nodes) <= PART_DEPTH {
                self.optimizer.run(&mut self.bvh, REINSERTION, Some(ROUNDS.to_vec()));
                if self.walk.over(&self.bvh.nodes) <= PART_DEPTH {
                    return Binary { nodes: &self.bvh.nodes, order: &self.walk.order };
                }
            }
        }
        let nodes = &mut self.bvh.nodes;
        nodes.clear();
        nodes.push(Bvh2Node::default());
        halves(prims, 0, &mut Halves { nodes, first: 0, watch: Watch::default() }, 0);
        self.walk.over(nodes);
        Binary { nodes, order: &self.walk.order }
    }

    /// Whether no group with the same box centre is large.
    fn has_few_equal(&mut self, prims: &[Prim]) -> bool {
        if prims.len() <= MAX_EQUAL {
            return true;
        }
        // Adding zero makes one key of both zeros.
        let key = |p: &Prim| (p.centre() + 0.0).to_array().map(f32::to_bits);
        // Groups by some bits that are mixed of the key are at least as large.
        self.groups.clear();
        self.groups.resize(GROUPS, 0);
        let most = prims.iter().fold(0, |most, p| {
            let [x, y, z] = key(p);
            let mixed = x.wrapping_mul(0x9E37_79B1).rotate_left(11) ^ y;
            let mixed = mixed.wrapping_mul(0x85EB_CA77).rotate_left(13) ^ z;
            let mixed = (mixed ^ mixed >> 15).wrapping_mul(0xC2B2_AE3D);
            let group = &mut self.groups[(mixed >> (u32::BITS - GROUPS.ilog2())) as usize];
            *group = group.saturating_add(1);
            most.max(*group)
        });
        if usize::from(most) <= MAX_EQUAL {
            return true;
        }
        let mut keys: Vec<[u32; 3]> = prims.iter().map(key).collect();
        keys.sort_unstable();
        keys.chunk_by(|a, b| a == b).all(|equal| equal.len() <= MAX_EQUAL)
    }
}

/// So many that groups of unequal centres are rarely large.
const GROUPS: usize = 1 << 12;

/// The nodes of a tree, parents before their children.
#[derive(Default)]
pub(super) struct Walk {
    pub(super) order: Vec<u32>,
    stack: Vec<(u32, usize)>,
}

impl Walk {
    /// How many nodes the longest path has, where children come after their parents.
    fn down(&mut self, nodes: &[Bvh2Node]) -> usize {
        let levels = &mut self.order;
        levels.clear();
        levels.resize(nodes.len(), 1);
        let mut deepest = 1;
        for (at, node) in nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
            let level = levels[at] + 1;
            let first = node.first_index as usize;
            levels[first..first + 2].fill(level);
            deepest = deepest.max(level);
        }
        deepest as usize
    }

    /// Finds the order, and how many nodes the longest path has.
    pub(super) fn over(&mut self, nodes: &[Bvh2Node]) -> usize {
        self.order.clear();
        self.stack.push((0, 1));
        let mut deepest = 0;
        while let Some((index, level)) = self.stack.pop() {
            self.order.push(index);
            deepest = deepest.max(level);
            let node = &nodes[index as usize];
            if !node.is_leaf() {
                self.stack
                    .extend([(node.first_index, level + 1), (node.first_index + 1, level + 1)]);
            }
        }
        deepest
    }
}

struct Halves<'a> {
    nodes: &'a mut Vec<Bvh2Node>,
    first: usize,
    /// Nobody's: parts are small.
    watch: Watch,
}

/// Builds `nodes[at]` by cutting down to single primitives.
fn halves(prims: &mut [Prim], at: usize, out: &mut Halves<'_>, depth: usize) {
    let all = prims.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    if prims.len() == 1 {
        out.nodes[at] = binary_node(all, 1, out.first);
        out.first += 1;
        return;
    }
    let children = out.nodes.len();
    out.nodes[at] = binary_node(all, 0, children);
    out.nodes.extend([Bvh2Node::default(); 2]);
    let (middle, _) = halve(prims, centres(prims, &out.watch), depth, &out.watch);
    let (left, right) = prims.split_at_mut(middle);
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
    Bounds { min: aabb.min, max: aabb.max }
}

fn binary_node(bounds: Bounds, n_prims: u32, first: usize) -> Bvh2Node {
    Bvh2Node::new(Aabb::new(bounds.min, bounds.max), n_prims, narrow(first))
}
