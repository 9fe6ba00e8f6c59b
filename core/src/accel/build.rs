//! Building a mesh tree: check, cut into parts, cluster each with obvhs, collapse, join.

use glam::Vec3;
use rayon::prelude::*;

use super::cluster::{cluster, join, slices};
use super::collapse::{Costs, Root, Sink, collapse};
use super::node::{Block, Bounds, Child, LANES, Node, narrow};
use super::partition::{PART, Part, Prim};

const COSTS: Costs = Costs { node: 1.0, block: 0.6, max_leaf: 8 };

/// Parts built before their results are joined: enough to keep threads busy, few enough that what
/// they hold stays small beside the tree.
const BATCH: usize = 128;

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
    pub(super) moves: Option<Moves<'a>>,
}

/// Where points move to, and the shares of the way between which they are met.
#[derive(Clone, Copy)]
pub(super) struct Moves<'a> {
    pub(super) last: &'a [Vec3],
    pub(super) shares: [f32; 2],
}

impl Triangles<'_> {
    pub(super) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|i| self.points[i as usize] * self.unit)
    }

    /// The corners when all of the way is done.
    pub(super) fn last_corners(&self, moves: &Moves<'_>, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|i| moves.last[i as usize] * self.unit)
    }

    /// The box of a triangle, wherever it moves to, or `None` if it never has an area: that of one
    /// whose corners move evenly is a square of the time, which is zero at three times or always.
    fn bounds(&self, triangle: u32) -> Option<Bounds> {
        let first = self.corners(triangle);
        let Some(moves) = &self.moves else { return standing_bounds(first) };
        let last = self.last_corners(moves, triangle);
        let [open, close] = moves.shares;
        let at = |share: f32| [0, 1, 2].map(|i| first[i] + (last[i] - first[i]) * share);
        let middle = 0.5 * open + 0.5 * close;
        if [open, middle, close].into_iter().all(|share| standing_bounds(at(share)).is_none()) {
            return None;
        }
        let corners = at(open).into_iter().chain(at(close));
        Some(corners.fold(Bounds::EMPTY, Bounds::grow))
    }
}

/// The box of a triangle, or `None` if it has no area.
fn standing_bounds([a, b, c]: [Vec3; 3]) -> Option<Bounds> {
    let ab = b.as_dvec3() - a.as_dvec3();
    let ac = c.as_dvec3() - a.as_dvec3();
    let area = ab.cross(ac);
    let bounds = Bounds { min: a.min(b).min(c), max: a.max(b).max(c) };
    (area.x != 0.0 || area.y != 0.0 || area.z != 0.0).then_some(bounds)
}

impl Triangles<'_> {
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
        let bounds: Vec<Bounds> = roots.iter().map(|root| root.bounds).collect();
        let binary = join(&upper, &bounds);
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
        for block in prims.chunks(LANES) {
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
