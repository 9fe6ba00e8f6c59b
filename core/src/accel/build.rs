//! Building trees: cut into parts, cluster each with obvhs, collapse, join.
#![expect(unsafe_code, reason = "threads fill one array side by side")]

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::cluster::{Clusters, Walk, bounds, join, slices};
use super::collapse::{Binary, Costs, Plans, Root, Sink, collapse};
use super::node::{Bounds, Child};
use super::partition::{Part, Prim};
use super::slabs::Boxes;
use super::watch::Watch;

/// Parts for each thread that are built before their results are joined: enough to keep threads busy,
/// few enough that they are moved in a few milliseconds. No bit of the tree depends on it.
pub(super) const BATCH: usize = 32;

/// What a tree is made of.
pub(super) trait Timber: Sync {
    /// What the boxes of its nodes are made of.
    type Number: Copy + Send + Sync + 'static;
    /// What its leaves refer to.
    type Block: Copy + Send + Sync + 'static;
    /// A box in the precision of the tree.
    type Bounds: Copy + Default + Send + Sync;

    /// What steps cost.
    const COSTS: Costs;

    /// A leaf of primitives, at most `COSTS.max_leaf`, whose blocks are put behind the others.
    fn leaf<'p>(
        &self,
        prims: impl ExactSizeIterator<Item = &'p Prim>,
        blocks: &mut Vec<Self::Block>,
    ) -> (Child, Self::Bounds);

    /// Asks for the memory that leaves of these primitives are made of.
    fn prefetch(&self, _prims: &[Prim]) {}

    /// A node and the box around it.
    fn node(slots: &[(Child, Self::Bounds)]) -> (Boxes<Self::Number>, Self::Bounds);
}

/// Nodes and blocks, and where a ray starts.
pub(super) struct Tree<T: Timber> {
    pub(super) nodes: Vec<Boxes<T::Number>>,
    pub(super) blocks: Vec<T::Block>,
    pub(super) root: Option<Root<T::Bounds>>,
    /// The box of the root as builders see it.
    around: Bounds,
}

impl<T: Timber> Default for Tree<T> {
    fn default() -> Self {
        Self { nodes: vec![], blocks: vec![], root: None, around: Bounds::EMPTY }
    }
}

/// The tree over these primitives; `None` once the watch is cancelled.
pub(super) fn build<T: Timber>(timber: &T, mut prims: Vec<Prim>, watch: &Watch) -> Option<Tree<T>> {
    let mut tree = Tree::default();
    if !prims.is_empty() {
        fill(&mut tree, timber, &mut prims, watch);
    }
    if !watch.is_cancelled() {
        return Some(tree);
    }
    // The system takes many milliseconds to take back as much memory: nobody waits for it.
    let Tree { nodes, blocks, .. } = tree;
    rayon::spawn(move || drop((nodes, blocks, prims)));
    None
}

/// Becomes the tree over these primitives, at least one; left off when the watch is cancelled.
fn fill<T: Timber>(tree: &mut Tree<T>, timber: &T, prims: &mut [Prim], watch: &Watch) {
    let upper = Part::cut(prims, watch);
    if watch.is_cancelled() {
        return;
    }
    let mut parts = slices(prims, &upper);
    if let [part] = parts.as_mut_slice() {
        tree.grow(timber, part, &mut Tools::default(), watch);
        tree.nodes.shrink_to_fit();
        return tree.blocks.shrink_to_fit();
    }
    let mut roots = Vec::with_capacity(parts.len());
    let mut around = Vec::with_capacity(parts.len());
    let n_threads = rayon::current_num_threads();
    let tools: Vec<_> = (0..n_threads).map(|_| Mutex::default()).collect();
    let batch = parts.len().min(BATCH * n_threads);
    let mut grown: Vec<Tree<T>> = (0..batch).map(|_| Tree::default()).collect();
    let n_parts = parts.len();
    for batch in parts.chunks_mut(batch) {
        let grown = &mut grown[..batch.len()];
        batch.par_iter_mut().zip(grown.par_iter_mut()).for_each(|(part, tree)| {
            // A thread's own: nobody waits.
            let own = rayon::current_thread_index().unwrap_or(0);
            let mut tools = tools[own].lock().unwrap_or_else(PoisonError::into_inner);
            tree.grow(timber, part, &mut tools, watch);
        });
        if watch.is_cancelled() {
            return;
        }
        around.extend(grown.iter().map(|part| part.around));
        tree.take(grown, n_parts, &mut roots);
    }
    let binary = join(&upper, &around);
    let mut walk = Walk::default();
    walk.over(&binary);
    let binary = Binary { nodes: &binary, order: &walk.order };
    let costs = Costs { max_leaf: 1, ..T::COSTS };
    let depth = roots.iter().map(|root| root.depth).max().unwrap_or(0);
    let mut joint = Joint::<T> { nodes: &mut tree.nodes, roots: &roots };
    let mut root = collapse(binary, costs, &mut Plans::default(), &mut joint);
    root.depth += depth;
    tree.root = Some(root);
}

/// What a thread needs for one part after another.
#[derive(Default)]
struct Tools {
    clusters: Clusters,
    plans: Plans,
}

impl<T: Timber> Tree<T> {
    /// Becomes the tree of one part.
    fn grow(&mut self, timber: &T, prims: &mut [Prim], tools: &mut Tools, watch: &Watch) {
        self.nodes.clear();
        self.blocks.clear();
        if watch.is_cancelled() {
            return;
        }
        let Tools { clusters, plans } = tools;
        let binary = clusters.of(prims);
        self.around = bounds(&binary.nodes[0]);
        timber.prefetch(prims);
        let Self { nodes, blocks, .. } = self;
        let mut leaves = Leaves { timber, prims, nodes, blocks };
        self.root = Some(collapse(binary, T::COSTS, plans, &mut leaves));
        watch.add(prims.len());
    }

    /// Takes what some of `n_parts` parts hold behind what it has; their roots are put to the others.
    fn take(&mut self, parts: &mut [Self], n_parts: usize, roots: &mut Vec<Root<T::Bounds>>) {
        let mut at = (self.nodes.len(), self.blocks.len());
        let mut moves = Vec::with_capacity(parts.len());
        for part in &mut *parts {
            roots.extend(part.root.take().map(|root| {
                let child = root.child.shifted(at.0, at.1);
                Root { child, ..root }
            }));
            moves.push(at);
            at = (at.0 + part.nodes.len(), at.1 + part.blocks.len());
        }
        // Parts are alike: room for all of them, of which only what is written takes memory.
        let left = n_parts - roots.len();
        let room = |n: usize| {
            let more = n * left / roots.len();
            // Parts that come may be larger, and to move what is there takes longer than they.
            n + more + more / 8
        };
        append(
            &mut self.nodes,
            room(at.0),
            parts,
            |part| &part.nodes,
            |i, mut node| {
                node.children = node.children.map(|child| child.shifted(moves[i].0, moves[i].1));
                node
            },
        );
        append(&mut self.blocks, room(at.1), parts, |part| &part.blocks, |_, block| block);
    }
}

/// Puts what parts hold behind what is there, in parallel, after it has been changed by `map`, which
/// is told the number of the part.
fn append<P: Sync, X: Copy + Send + Sync>(
    all: &mut Vec<X>,
    room: usize,
    parts: &[P],
    get: impl Fn(&P) -> &[X] + Sync,
    map: impl Fn(usize, X) -> X + Sync,
) {
    let n: usize = parts.iter().map(|part| get(part).len()).sum();
    if all.capacity() < all.len() + n {
        // However often parts turn out to be larger, what is there is moved few times.
        let least = (all.len() + n).max(all.capacity() + all.capacity() / 8);
        all.reserve_exact(room.max(least) - all.len());
    }
    let mut spare = &mut all.spare_capacity_mut()[..n];
    let mut places = Vec::with_capacity(parts.len());
    for part in parts {
        let (place, rest) = spare.split_at_mut(get(part).len());
        places.push(place);
        spare = rest;
    }
    places.into_par_iter().zip(parts).enumerate().for_each(|(i, (place, part))| {
        for (slot, one) in place.iter_mut().zip(get(part)) {
            slot.write(map(i, *one));
        }
    });
    let len = all.len() + n;
    // SAFETY: the places cover the n slots behind the old end, and every slot of each was written.
    unsafe { all.set_len(len) };
}

/// Fills leaf blocks.
struct Leaves<'a, T: Timber> {
    timber: &'a T,
    prims: &'a [Prim],
    nodes: &'a mut Vec<Boxes<T::Number>>,
    blocks: &'a mut Vec<T::Block>,
}

impl<T: Timber> Sink for Leaves<'_, T> {
    type Bounds = T::Bounds;

    fn leaf(&mut self, prims: &[u32]) -> (Child, T::Bounds) {
        self.timber.leaf(prims.iter().map(|&p| &self.prims[p as usize]), self.blocks)
    }

    fn node(&mut self, slots: &[(Child, T::Bounds)]) -> (Child, T::Bounds) {
        push_node::<T>(self.nodes, slots)
    }
}

/// Joins the roots of parts.
struct Joint<'a, T: Timber> {
    nodes: &'a mut Vec<Boxes<T::Number>>,
    roots: &'a [Root<T::Bounds>],
}

impl<T: Timber> Sink for Joint<'_, T> {
    type Bounds = T::Bounds;

    fn leaf(&mut self, parts: &[u32]) -> (Child, T::Bounds) {
        let root = self.roots[parts[0] as usize];
        (root.child, root.bounds)
    }

    fn node(&mut self, slots: &[(Child, T::Bounds)]) -> (Child, T::Bounds) {
        push_node::<T>(self.nodes, slots)
    }
}

fn push_node<T: Timber>(
    nodes: &mut Vec<Boxes<T::Number>>,
    slots: &[(Child, T::Bounds)],
) -> (Child, T::Bounds) {
    let (node, bounds) = T::node(slots);
    nodes.push(node);
    (Child::node(nodes.len() - 1), bounds)
}
