//! From a binary tree to an eight-wide one, by least expected cost.
//!
//! Source: Ylitie, Karras and Laine 2017, §4.1: dynamic programming over how many of a node's eight
//! slots each binary subtree takes.

use obvhs::bvh2::node::Bvh2Node;

use super::cluster::bounds;
use super::node::{Child, WIDTH};

/// Relative costs of a step; only their ratio matters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs {
    /// Testing eight boxes.
    pub(super) node: f32,
    /// Testing up to four primitives.
    pub(super) block: f32,
    /// Primitives that a leaf may hold.
    pub(super) max_leaf: u32,
}

/// What makes the wide tree; children come before their parents.
pub(super) trait Sink {
    /// A box in the precision of the tree.
    type Bounds: Copy;
    fn leaf(&mut self, prims: &[u32]) -> (Child, Self::Bounds);
    fn node(&mut self, slots: &[(Child, Self::Bounds)]) -> (Child, Self::Bounds);
}

/// A finished subtree and how many nodes lie on its longest path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root<B> {
    pub(super) child: Child,
    pub(super) bounds: B,
    pub(super) depth: usize,
}

/// The best that a binary subtree can cost in 1..=8 slots, and how to reach it.
#[derive(Clone, Copy, Default)]
struct Plan {
    cost: [f32; WIDTH],
    /// For 2..=8 slots: those of the left child, 0 for "as with one slot less".
    left: [u8; WIDTH],
    leaf: bool,
    n_prims: u32,
}

/// Makes the wide tree of a binary one whose root is node 0, whose leaves hold one primitive each,
/// and whose depth is bounded (this recurses).
pub(super) fn collapse<S: Sink>(nodes: &[Bvh2Node], costs: Costs, sink: &mut S) -> Root<S::Bounds> {
    let mut collapse = Collapse { nodes, plans: vec![Plan::default(); nodes.len()], sink };
    collapse.plan(costs);
    collapse.emit(0)
}

struct Collapse<'a, S> {
    nodes: &'a [Bvh2Node],
    plans: Vec<Plan>,
    sink: &'a mut S,
}

/// The cheapest way to give `slots` to two children, and what the left one gets.
fn share(left: &Plan, right: &Plan, slots: usize) -> (f32, usize) {
    (1..slots)
        .map(|k| (left.cost[k - 1] + right.cost[slots - k - 1], k))
        .fold((f32::INFINITY, 1), |a, b| if b.0 < a.0 { b } else { a })
}

impl<S: Sink> Collapse<'_, S> {
    fn plan(&mut self, costs: Costs) {
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut stack = vec![0u32];
        while let Some(index) = stack.pop() {
            order.push(index);
            let node = &self.nodes[index as usize];
            if !node.is_leaf() {
                stack.extend([node.first_index, node.first_index + 1]);
            }
        }
        for &index in order.iter().rev() {
            self.plans[index as usize] = self.plan_one(&self.nodes[index as usize], costs);
        }
    }

    fn plan_one(&self, node: &Bvh2Node, costs: Costs) -> Plan {
        let area = bounds(node).half_area();
        let as_leaf = |n: u32| area * costs.block * n.div_ceil(4) as f32;
        if node.is_leaf() {
            return Plan { cost: [as_leaf(1); WIDTH], left: [0; WIDTH], leaf: true, n_prims: 1 };
        }
        let [l, r] = [0, 1].map(|side| &self.plans[(node.first_index + side) as usize]);
        let n_prims = l.n_prims + r.n_prims;
        let leaf_cost = if n_prims <= costs.max_leaf { as_leaf(n_prims) } else { f32::INFINITY };
        let node_cost = share(l, r, WIDTH).0 + area * costs.node;
        let mut plan = Plan {
            cost: [leaf_cost.min(node_cost); WIDTH],
            left: [0; WIDTH],
            leaf: false,
            n_prims,
        };
        plan.leaf = leaf_cost <= node_cost;
        for slots in 2..=WIDTH {
            let (cost, k) = share(l, r, slots);
            plan.cost[slots - 1] = plan.cost[slots - 2];
            if cost < plan.cost[slots - 1] {
                plan.cost[slots - 1] = cost;
                plan.left[slots - 1] = [0, 1, 2, 3, 4, 5, 6, 7][k];
            }
        }
        plan
    }

    fn emit(&mut self, index: u32) -> Root<S::Bounds> {
        if self.plans[index as usize].leaf {
            let mut prims = Vec::with_capacity(WIDTH);
            self.gather(index, &mut prims);
            let (child, bounds) = self.sink.leaf(&prims);
            return Root { child, bounds, depth: 0 };
        }
        let first = self.nodes[index as usize].first_index;
        let [l, r] = [0, 1].map(|side| &self.plans[(first + side) as usize]);
        let k = share(l, r, WIDTH).1;
        let mut members = Vec::with_capacity(WIDTH);
        self.expand(first, k, &mut members);
        self.expand(first + 1, WIDTH - k, &mut members);
        let roots: Vec<_> = members.iter().map(|&member| self.emit(member)).collect();
        let slots: Vec<_> = roots.iter().map(|root| (root.child, root.bounds)).collect();
        let (child, bounds) = self.sink.node(&slots);
        let depth = 1 + roots.iter().map(|root| root.depth).max().unwrap_or(0);
        Root { child, bounds, depth }
    }

    /// The subtrees that take the slots planned for this one.
    fn expand(&self, index: u32, slots: usize, members: &mut Vec<u32>) {
        let plan = &self.plans[index as usize];
        match (1..slots).rev().find(|&used| plan.left[used] != 0) {
            None => members.push(index),
            Some(used) => {
                let k = usize::from(plan.left[used]);
                let first = self.nodes[index as usize].first_index;
                self.expand(first, k, members);
                self.expand(first + 1, used + 1 - k, members);
            }
        }
    }

    fn gather(&self, index: u32, prims: &mut Vec<u32>) {
        let node = &self.nodes[index as usize];
        if node.is_leaf() {
            prims.push(node.first_index);
        } else {
            self.gather(node.first_index, prims);
            self.gather(node.first_index + 1, prims);
        }
    }
}
