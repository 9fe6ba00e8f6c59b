//! From a binary tree to an eight-wide one, by least expected cost.
//!
//! Source: Ylitie, Karras and Laine 2017, §4.1: dynamic programming over how many of a node's eight
//! slots each binary subtree takes.

use obvhs::bvh2::node::Bvh2Node;

use super::cluster::bounds;
use super::node::{Child, WIDTH, narrow};

/// Relative costs of a step; only their ratio matters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs {
    /// Testing eight boxes.
    pub(super) node: f32,
    /// Testing up to four primitives.
    pub(super) block: f32,
    /// Primitives that a leaf may hold, at most eight.
    pub(super) max_leaf: u8,
}

/// What makes the wide tree; children come before their parents.
pub(super) trait Sink {
    /// A box in the precision of the tree.
    type Bounds: Copy + Default;
    fn leaf(&mut self, prims: &[u32]) -> (Child, Self::Bounds);
    fn node(&mut self, slots: &[(Child, Self::Bounds)]) -> (Child, Self::Bounds);
}

/// A finished subtree and how many nodes lie on its longest path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Root<B> {
    pub(super) child: Child,
    pub(super) bounds: B,
    pub(super) depth: usize,
}

/// The best that a binary subtree can cost in 1..=8 slots, and how to reach it.
#[derive(Clone, Copy, Debug, Default)]
struct Plan {
    cost: [f32; WIDTH],
    /// For 2..=8 slots: those of the left child, 0 for "as with one".
    left: [u8; WIDTH],
    /// As a node of its own: the slots of its left child.
    split: u8,
    leaf: bool,
    /// Primitives below; `MANY` for as many or more.
    n: u8,
}

const SLOTS: u8 = 8;

/// Leaves never hold so many primitives.
const MANY: u8 = SLOTS + 1;

/// Room for plans, used again for the next tree.
#[derive(Debug, Default)]
pub(super) struct Plans(Vec<Plan>);

/// A binary tree whose root is node 0, whose leaves hold one primitive each, and whose depth is
/// bounded; `order` holds every node once, parents before their children.
#[derive(Clone, Copy)]
pub(super) struct Binary<'a> {
    pub(super) nodes: &'a [Bvh2Node],
    pub(super) order: &'a [u32],
}

/// Makes the wide tree of a binary one (this recurses).
pub(super) fn collapse<S: Sink>(
    Binary { nodes, order }: Binary<'_>,
    costs: Costs,
    Plans(plans): &mut Plans,
    sink: &mut S,
) -> Root<S::Bounds> {
    // Those of the last tree are written over before they are read: children come first.
    plans.resize(nodes.len(), Plan::default());
    for &index in order.iter().rev() {
        plans[index as usize] = plan(&nodes[index as usize], plans, costs);
    }
    Collapse { nodes, plans, sink }.emit(0)
}

/// The plan of a node whose children have theirs.
fn plan(node: &Bvh2Node, plans: &[Plan], costs: Costs) -> Plan {
    let area = bounds(node).half_area();
    if node.is_leaf() {
        let cost = [area * costs.block; WIDTH];
        return Plan { cost, leaf: true, n: 1, ..Plan::default() };
    }
    let first = node.first_index as usize;
    let (l, r) = (&plans[first], &plans[first + 1]);
    // The cheapest way to give so many slots to the children, and what the left one gets. More slots
    // than primitives cost as much as those, so every way may be tried for every number.
    let mut shifted = [f32::INFINITY; 2 * WIDTH];
    shifted[WIDTH..].copy_from_slice(&r.cost);
    let (mut best, mut ways) = ([f32::INFINITY; WIDTH], [0u32; WIDTH]);
    for (a, left) in (1..WIDTH).zip(&l.cost).take(usize::from(l.n)) {
        let right = &shifted[WIDTH - a..2 * WIDTH - a];
        for slot in 0..WIDTH {
            let cost = left + right[slot];
            let better = cost < best[slot];
            best[slot] = if better { cost } else { best[slot] };
            ways[slot] = if better { narrow(a) } else { ways[slot] };
        }
    }
    let node_cost = best[WIDTH - 1] + area * costs.node;
    let n = (l.n + r.n).min(MANY);
    let leaf_cost = if n < MANY && n <= costs.max_leaf {
        area * costs.block * f32::from(n.div_ceil(4))
    } else {
        f32::INFINITY
    };
    let one = leaf_cost.min(node_cost);
    let (mut cost, mut left) = ([one; WIDTH], [0; WIDTH]);
    for slot in 1..WIDTH {
        cost[slot] = if best[slot] < one { best[slot] } else { one };
        left[slot] = if best[slot] < one { ways[slot] } else { 0 };
    }
    Plan {
        cost,
        left: left.map(slots),
        split: slots(ways[WIDTH - 1]),
        leaf: leaf_cost <= node_cost,
        n,
    }
}

/// A number of slots.
fn slots(n: u32) -> u8 {
    n.to_le_bytes()[0]
}

struct Collapse<'a, S> {
    nodes: &'a [Bvh2Node],
    plans: &'a [Plan],
    sink: &'a mut S,
}

/// Up to eight of something.
#[derive(Clone, Copy, Default)]
struct Few<T> {
    all: [T; WIDTH],
    n: usize,
}

impl<T> Few<T> {
    fn push(&mut self, one: T) {
        self.all[self.n] = one;
        self.n += 1;
    }

    fn get(&self) -> &[T] {
        &self.all[..self.n]
    }
}

impl<S: Sink> Collapse<'_, S> {
    fn emit(&mut self, index: u32) -> Root<S::Bounds> {
        let plan = &self.plans[index as usize];
        if plan.leaf {
            let mut prims = Few::default();
            self.gather(index, &mut prims);
            let (child, bounds) = self.sink.leaf(prims.get());
            return Root { child, bounds, depth: 0 };
        }
        let first = self.nodes[index as usize].first_index;
        let mut members = Few::default();
        self.expand(first, plan.split, &mut members);
        self.expand(first + 1, SLOTS - plan.split, &mut members);
        let mut slots = Few::default();
        let mut depth = 0;
        for &member in members.get() {
            let root = self.emit(member);
            slots.push((root.child, root.bounds));
            depth = root.depth.max(depth);
        }
        let (child, bounds) = self.sink.node(slots.get());
        Root { child, bounds, depth: depth + 1 }
    }

    /// The subtrees that take the slots planned for this one.
    fn expand(&self, index: u32, slots: u8, members: &mut Few<u32>) {
        let k = self.plans[index as usize].left[usize::from(slots) - 1];
        if k == 0 {
            members.push(index);
        } else {
            let first = self.nodes[index as usize].first_index;
            self.expand(first, k, members);
            self.expand(first + 1, slots - k, members);
        }
    }

    fn gather(&self, index: u32, prims: &mut Few<u32>) {
        let node = &self.nodes[index as usize];
        if node.is_leaf() {
            prims.push(node.first_index);
        } else {
            self.gather(node.first_index, prims);
            self.gather(node.first_index + 1, prims);
        }
    }
}
