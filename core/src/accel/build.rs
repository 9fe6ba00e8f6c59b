//! Building a mesh tree: check, cut into parts, cluster each with obvhs, collapse, join.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use super::collapse::{Costs, Root, Sink, collapse, depth};
use super::node::{Block, Bounds, Child, Node, WIDTH, narrow};
use super::partition::{PART, Part, Prim, halve};

/// Binary levels a clustered part may have. With the at most 12 + 16 levels above it the stack
/// need stays under 3·76 + 1 entries.
const PART_DEPTH: usize = 48;

/// Equal centres that a part may have before it is cut instead of clustered: clustering turns n
/// equal boxes into a chain of depth n, in n² time.
const MAX_EQUAL: usize = 8;

/// Share of the nodes that obvhs tries to place better, per round.
const REINSERTION: f32 = 0.02;

const COSTS: Costs = Costs { node: 1.0, block: 1.3, max_leaf: 8 };

/// Parts built before their results are joined: enough to keep threads busy, few enough that what
/// they hold stays small beside the tree.
const BATCH: usize = 32;

/// Nodes and blocks, and where a ray starts.
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<Block>,
    pub(super) root: Option<Root<Bounds>>,
}

/// The triangles in the scaled frame of the tree.
#[derive(Clone, Copy)]
pub(super) struct Triangles<'a> {
    pub(super) points: &'a [Vec3],
    pub(super) indices: &'a [[u32; 3]],
    pub(super) unit: f32,
}

impl Triangles<'_> {
    pub(super) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|i| self.points[i as usize] * self.unit)
    }

    /// The triangle's box, or `None` if it has no area.
    fn bounds(&self, triangle: u32) -> Option<Bounds> {
        let [a, b, c] = self.corners(triangle);
        let ab = b.as_dvec3() - a.as_dvec3();
        let ac = c.as_dvec3() - a.as_dvec3();
        let area = ab.cross(ac);
        let bounds = Bounds { min: a.min(b).min(c), max: a.max(b).max(c) };
        (area.x != 0.0 || area.y != 0.0 || area.z != 0.0).then_some(bounds)
    }

    /// The triangles that have an area.
    pub(super) fn prims(&self) -> Vec<Prim> {
        let prim = |triangle: usize| {
            let index = narrow(triangle);
            Prim { bounds: self.bounds(index).unwrap_or(Bounds::EMPTY), index }
        };
        let n = self.indices.len();
        let mut prims: Vec<Prim> = if n > PART {
            (0..n).into_par_iter().map(prim).collect()
        } else {
            (0..n).map(prim).collect()
        };
        prims.retain(|p| p.bounds != Bounds::EMPTY);
        prims
    }

    /// The tree over these primitives.
    pub(super) fn tree(&self, mut prims: Vec<Prim>) -> Tree {
        if prims.is_empty() {
            return Tree { nodes: Vec::new(), blocks: Vec::new(), root: None };
        }
        let upper = Part::cut(&mut prims);
        let mut parts = slices(&mut prims, &upper);
        if parts.len() == 1 {
            return self.part(parts[0]);
        }
        let mut tree = Tree { nodes: Vec::new(), blocks: Vec::new(), root: None };
        let mut roots = Vec::with_capacity(parts.len());
        for batch in parts.chunks_mut(BATCH) {
            let built: Vec<Tree> = batch.par_iter_mut().map(|part| self.part(part)).collect();
            roots.extend(built.into_iter().filter_map(|part| tree.append(part)));
        }
        let mut binary = Vec::new();
        binary.push(Bvh2Node::default());
        join(&upper, 0, &mut binary, &mut 0, &roots);
        let costs = Costs { max_leaf: 1, ..COSTS };
        let depth = roots.iter().map(|root| root.depth).max().unwrap_or(0);
        let nodes = &mut tree.nodes;
        let mut root = collapse(&binary, costs, &mut Joint { nodes, roots: &roots });
        root.depth += depth;
        tree.root = Some(root);
        tree.nodes.shrink_to_fit();
        tree.blocks.shrink_to_fit();
        tree
    }

    fn part(&self, prims: &mut [Prim]) -> Tree {
        let binary = cluster(prims);
        let (nodes, blocks) = (Vec::new(), Vec::with_capacity(prims.len() / 2));
        let mut leaves = Leaves { triangles: *self, prims, nodes, blocks };
        let root = collapse(&binary, COSTS, &mut leaves);
        Tree { nodes: leaves.nodes, blocks: leaves.blocks, root: Some(root) }
    }
}

impl Tree {
    /// Takes the nodes of another tree; returns its root as it is numbered here.
    fn append(&mut self, part: Self) -> Option<Root<Bounds>> {
        let (nodes, blocks) = (self.nodes.len(), self.blocks.len());
        self.blocks.extend(part.blocks);
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.children = node.children.map(|child| child.shifted(nodes, blocks));
            node
        }));
        part.root.map(|root| Root { child: root.child.shifted(nodes, blocks), ..root })
    }
}

/// The binary tree over all primitives; leaves hold positions in `prims`, which is reordered.
pub(super) fn binary(prims: &mut [Prim]) -> Vec<Bvh2Node> {
    let upper = Part::cut(prims);
    let mut nodes = vec![Bvh2Node::default()];
    let mut first = 0;
    let mut places = Vec::new();
    let parts = slices(prims, &upper);
    let mut roots = Vec::with_capacity(parts.len());
    let mut lower = Vec::with_capacity(parts.len());
    for part in parts {
        let tree = cluster(part);
        let aabb = tree[0].aabb();
        let bounds = Bounds { min: Vec3::from(aabb.min), max: Vec3::from(aabb.max) };
        roots.push(Root { child: Child::node(0), bounds, depth: 0 });
        places.push(first);
        first += part.len();
        lower.push(tree);
    }
    join(&upper, 0, &mut nodes, &mut 0, &roots);
    for at in 0..nodes.len() {
        if nodes[at].is_leaf() {
            let part = nodes[at].first_index as usize;
            // The root of a part replaces its leaf; the others follow at the end.
            let base = narrow(nodes.len());
            let moved = |mut node: Bvh2Node| {
                let by = if node.is_leaf() { narrow(places[part]) } else { base - 1 };
                node.first_index += by;
                node
            };
            nodes[at] = moved(lower[part][0]);
            nodes.extend(lower[part][1..].iter().copied().map(moved));
        }
    }
    nodes
}

fn slices<'a>(mut prims: &'a mut [Prim], upper: &Part) -> Vec<&'a mut [Prim]> {
    let mut parts = Vec::new();
    for size in upper.sizes() {
        let (part, rest) = prims.split_at_mut(size);
        parts.push(part);
        prims = rest;
    }
    parts
}

/// The binary tree of one part, of bounded depth.
fn cluster(prims: &mut [Prim]) -> Vec<Bvh2Node> {
    if most_equal(prims) <= MAX_EQUAL {
        let order = (0..narrow(prims.len())).collect();
        let mut builder = PlocBuilder::new();
        let mut bvh =
            builder.build(PlocSearchDistance::VeryLow, prims, order, SortPrecision::U64, 0);
        if depth(&bvh.nodes, PART_DEPTH).is_some() {
            ReinsertionOptimizer::default().run(&mut bvh, REINSERTION, None);
            if depth(&bvh.nodes, PART_DEPTH).is_some() {
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
            let [x, y, z] =
                (p.bounds.min + p.bounds.max + Vec3::ZERO).to_array().map(|c| u64::from(c.to_bits()));
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

/// Builds `nodes[at]` of the upper tree, whose leaves hold the number of a part.
fn join(
    upper: &Part,
    at: usize,
    nodes: &mut Vec<Bvh2Node>,
    part: &mut usize,
    roots: &[Root<Bounds>],
) -> Bounds {
    match upper {
        Part::Leaf(_) => {
            let bounds = roots[*part].bounds;
            nodes[at] = binary_node(bounds, 1, *part);
            *part += 1;
            bounds
        }
        Part::Split(halves) => {
            let children = nodes.len();
            nodes.extend([Bvh2Node::default(); 2]);
            let left = join(&halves[0], children, nodes, part, roots);
            let right = join(&halves[1], children + 1, nodes, part, roots);
            nodes[at] = binary_node(left.union(right), 0, children);
            left.union(right)
        }
    }
}

fn binary_node(bounds: Bounds, n_prims: u32, first: usize) -> Bvh2Node {
    Bvh2Node::new(Aabb::new(bounds.min.into(), bounds.max.into()), n_prims, narrow(first))
}

/// Fills leaf blocks with triangles.
struct Leaves<'a> {
    triangles: Triangles<'a>,
    prims: &'a [Prim],
    nodes: Vec<Node>,
    blocks: Vec<Block>,
}

impl Sink for Leaves<'_> {
    type Bounds = Bounds;

    fn leaf(&mut self, prims: &[u32]) -> (Child, Bounds) {
        let first = self.blocks.len();
        let mut bounds = Bounds::EMPTY;
        for block in prims.chunks(WIDTH) {
            let members = block.iter().map(|&p| &self.prims[p as usize]);
            bounds = members.clone().fold(bounds, |b, p| b.union(p.bounds));
            let corners = members.map(|p| (p.index, self.triangles.corners(p.index)));
            self.blocks.push(Block::of(corners));
        }
        (Child::leaf(first, self.blocks.len() - first), bounds)
    }

    fn node(&mut self, slots: &[(Child, Bounds)]) -> (Child, Bounds) {
        push_node(&mut self.nodes, slots)
    }
}

/// Joins the roots of parts.
struct Joint<'a> {
    nodes: &'a mut Vec<Node>,
    roots: &'a [Root<Bounds>],
}

impl Sink for Joint<'_> {
    type Bounds = Bounds;

    fn leaf(&mut self, parts: &[u32]) -> (Child, Bounds) {
        let root = self.roots[parts[0] as usize];
        (root.child, root.bounds)
    }

    fn node(&mut self, slots: &[(Child, Bounds)]) -> (Child, Bounds) {
        push_node(self.nodes, slots)
    }
}

fn push_node(nodes: &mut Vec<Node>, slots: &[(Child, Bounds)]) -> (Child, Bounds) {
    let bounds = slots.iter().fold(Bounds::EMPTY, |b, slot| b.union(slot.1));
    nodes.push(Node::of(slots));
    (Child::node(nodes.len() - 1), bounds)
}
