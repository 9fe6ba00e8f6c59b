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
    /// For 2..=8 slots: those of the left child, 0 for "as with one slot less".
    left: [u8; WIDTH],
    /// As a node of its own: the slots of its children.
    split: [u8; 2],
    leaf: bool,
    /// Primitives below; `MANY` for as many or more.
    n: u8,
}

/// One more than slots: more slots than primitives are of no use, nor are leaves of so many.
const MANY: u8 = 9;

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
    let n = (l.n + r.n).min(MANY);
    // The cheapest way to give so many slots to the children, and what the left one gets.
    let mut best = [(f32::INFINITY, 0); MANY as usize];
    for a in 1..=l.n.min(MANY - 2) {
        for b in 1..=r.n.min(MANY - 1 - a) {
            let cost = l.cost[usize::from(a) - 1] + r.cost[usize::from(b) - 1];
            let way = &mut best[usize::from(a + b)];
            if cost < way.0 {
                *way = (cost, a);
            }
        }
    }
    let whole = (3..MANY).fold(2, |whole, slots| {
        if best[usize::from(slots)].0 < best[usize::from(whole)].0 { slots } else { whole }
    });
    let (cost, k) = best[usize::from(whole)];
    let node_cost = cost + area * costs.node;
    let leaf_cost = if n < MANY && n <= costs.max_leaf {
        area * costs.block * f32::from(n.div_ceil(4))
    } else {
        f32::INFINITY
    };
    let mut plan = Plan {
        cost: [leaf_cost.min(node_cost); WIDTH],
        left: [0; WIDTH],
        split: [k, whole - k],
        leaf: leaf_cost <= node_cost,
        n,
    };
    for (slot, &(cost, k)) in (1..WIDTH).zip(&best[2..]) {
        plan.cost[slot] = plan.cost[slot - 1];
        if cost < plan.cost[slot] {
            plan.cost[slot] = cost;
            plan.left[slot] = k;
        }
    }
    plan
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
        self.expand(first, plan.split[0], &mut members);
        self.expand(first + 1, plan.split[1], &mut members);
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
        let plan = &self.plans[index as usize];
        match (2..=slots).rev().find(|&used| plan.left[usize::from(used) - 1] != 0) {
            None => members.push(index),
            Some(used) => {
                let k = plan.left[usize::from(used) - 1];
                let first = self.nodes[index as usize].first_index;
                self.expand(first, k, members);
                self.expand(first + 1, used - k, members);
            }
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
