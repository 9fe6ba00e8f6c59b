//! The triangles of one mesh, ready to trace.

use std::hint::select_unpredictable;

use glam::{DVec3, Vec3, Vec3A};

use super::build::{Tree, build};
use super::error::BuildError;
use super::node::{Block, Bounds, Child, Node, Shift};
use super::precision::Precision;
use super::processor::{Processor, prefetch};
use super::ray::{Direction, Line, Shear};
use super::slabs::Slabs;
use super::stack::{Room, Stack, is_enough_for};
use super::triangle::Nearest;
use super::triangles::Triangles;
use super::watch::Watch;

/// A mesh's triangles in an eight-wide tree, in f32 about the mesh's own centre.
///
/// Watertight: where two triangles share the same two points, no ray passes between them. There is
/// no smallest distance and no epsilon; a caller that leaves a surface offsets its origin by the
/// error bound of the hit. The tree is scaled by a power of two, so meshes of any size have the
/// same relative accuracy.
#[derive(Debug)]
pub struct MeshBvh {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    /// One for each block, if points move.
    shifts: Vec<Shift>,
    root: Option<Child>,
    /// Power of two from the caller's frame to the tree's.
    unit: f32,
    /// 1 / `unit`, exactly.
    per_unit: f32,
    /// Largest |coordinate| in the tree's frame.
    reach: f32,
    bounds: Option<(Vec3, Vec3)>,
    dropped: usize,
}

/// Where a ray meets a triangle.
///
/// The point is `(1 − b1 − b2)·p0 + b1·p1 + b2·p2`, better known than `o + t·d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// Ray parameter in lengths of the scaled direction, 0 < t <= `t_max`.
    pub t: f64,
    /// Position in the array of triangles that the tree was built from.
    pub triangle: u32,
    /// Barycentric weight of the triangle's second point, in [0, 1] to rounding.
    pub b1: f64,
    /// Barycentric weight of its third point.
    pub b2: f64,
}

impl MeshBvh {
    /// Builds the tree over these triangles. Triangles without area are left out, see
    /// [`MeshBvh::dropped`]; no triangles at all is a mesh that nothing hits. Equal input gives an
    /// equal tree, whatever the number of threads.
    ///
    /// `points` are about the mesh's own centre, in any length unit; they are read, not kept.
    ///
    /// # Errors
    /// A point that is not finite (used or not), an index past the points, more than 2²⁹
    /// triangles, or 2³² points or more.
    pub fn build(points: &[Vec3], indices: &[[u32; 3]]) -> Result<Self, BuildError> {
        Self::build_watched(points, indices, &Watch::default())
    }

    /// The same, followed and perhaps stopped by `watch`.
    ///
    /// # Errors
    /// As `build`; that the watch was cancelled.
    pub fn build_watched(
        points: &[Vec3],
        indices: &[[u32; 3]],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        watch.begin(indices.len(), "triangles");
        Self::of(&Triangles::new(points, indices, watch)?, indices.len(), watch)
    }

    /// The same over triangles whose points move evenly to those of `last`, of which there are as
    /// many. Rays meet them between the two `shares` of the way.
    ///
    /// # Errors
    /// As `build_watched`.
    pub fn build_moving(
        (points, last): (&[Vec3], &[Vec3]),
        indices: &[[u32; 3]],
        shares: [f32; 2],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        watch.begin(indices.len(), "triangles");
        let triangles = Triangles::new(points, indices, watch)?.moving(last, shares, watch)?;
        Self::of(&triangles, indices.len(), watch)
    }

    fn of(triangles: &Triangles<'_>, n: usize, watch: &Watch) -> Result<Self, BuildError> {
        let prims = triangles.prims(watch);
        let dropped = n - prims.len();
        let Tree { nodes, blocks, root, .. } =
            build(triangles, prims, watch).ok_or(BuildError::Cancelled)?;
        watch.add(dropped);
        let size = root.map_or(Bounds { min: Vec3A::ZERO, max: Vec3A::ZERO }, |root| root.bounds);
        debug_assert!(
            root.is_none_or(|root| is_enough_for(root.depth)),
            "builders bound the depth"
        );
        let shifts = blocks.iter().filter_map(|block| triangles.shift(block)).collect();
        let unit = triangles.unit;
        Ok(Self {
            nodes,
            blocks,
            shifts,
            root: root.map(|root| root.child),
            unit,
            per_unit: 1.0 / unit,
            reach: size.min.abs().max(size.max.abs()).max_element(),
            bounds: root.map(|_| ((size.min / unit).into(), (size.max / unit).into())),
            dropped,
        })
    }

    /// Every bit of the tree, mixed.
    #[cfg(test)]
    pub(super) fn fingerprint(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut all = DefaultHasher::new();
        for node in &self.nodes {
            for plane in node.planes.as_flattened() {
                plane.map(f32::to_bits).hash(&mut all);
            }
            format!("{:?} {:?}", node.children, node.order).hash(&mut all);
        }
        for block in &self.blocks {
            for points in block.points.as_flattened() {
                points.to_array().map(f32::to_bits).hash(&mut all);
            }
            block.ids.hash(&mut all);
        }
        format!("{:?} {:?} {}", self.root, self.bounds, self.dropped).hash(&mut all);
        all.finish()
    }

    /// How many triangles were left out because they have no area.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The corners of the box around all triangles with an area, or `None` without any.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// Bytes that the tree holds.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.shifts.as_slice())
    }

    /// The nearest hit, of equally near triangles the one that comes first; and how many nodes and
    /// triangle blocks were looked at.
    #[inline(always)]
    pub fn intersect(&self, processor: Processor, query: &Query<'_>) -> (Option<MeshHit>, u32) {
        self.trace::<false>(processor, query)
    }

    /// True if anything is hit; the same answer as that of `intersect`, sooner.
    #[inline(always)]
    pub fn occluded(&self, processor: Processor, query: &Query<'_>) -> bool {
        self.trace::<true>(processor, query).0.is_some()
    }

    #[inline(always)]
    fn trace<const ANY: bool>(
        &self,
        processor: Processor,
        query: &Query<'_>,
    ) -> (Option<MeshHit>, u32) {
        match self.begin::<ANY>(query) {
            Begun::Over(hit, steps) => (hit, steps),
            Begun::Walk(mut walk) => {
                let mut room = Room::default();
                let mut stack = room.stack();
                while !walk.step::<ANY>(processor, &mut stack) {}
                (walk.hit(), walk.steps)
            }
        }
    }

    /// Sets out: a tree of one leaf is done with at once. `ANY` ends at the first hit that is found.
    #[inline(always)]
    pub fn begin<const ANY: bool>(&self, query: &Query<'_>) -> Begun<'_> {
        let Some(root) = self.root else { return Begun::Over(None, 0) };
        let Query { direction, t_max, precision, .. } = *query;
        let line = Line { o: query.o * f64::from(self.unit), d: direction.exact };
        let o = line.o.as_vec3();
        if t_max.is_nan() || !o.is_finite() {
            return Begun::Over(None, 0);
        }
        // An infinite limit would let a ray "enter" the boxes that it misses at infinity.
        let mut best = Nearest::none((t_max * f64::from(self.unit)).min(f64::from(f32::MAX)));
        let shear = Shear::new(direction, o, query.skip.unwrap_or(u32::MAX));
        let probe = Probe { precision, line, shear, share: query.share };
        if root.is_leaf() {
            let steps = self.leaf::<ANY>(root, &probe, &mut best).1;
            return Begun::Over(self.found(&best, precision), steps);
        }
        let slabs = Slabs::through_mesh(o, direction.d, self.reach, precision);
        Begun::Walk(MeshWalk { tree: self, probe, slabs, best, current: root, steps: 0 })
    }

    #[inline(always)]
    fn found(&self, best: &Nearest, precision: Precision) -> Option<MeshHit> {
        let [t, b1, b2] = match precision {
            Precision::Exact => best.exact,
            _ => [best.t, best.b1, best.b2].map(f64::from),
        };
        let t = t * f64::from(self.per_unit);
        (best.id != u32::MAX).then_some(MeshHit { t, triangle: best.id, b1, b2 })
    }

    /// As `block`, of one whose points move. Apart, and by value: it would take registers from all others.
    #[inline(never)]
    fn block_in_motion<const ANY: bool>(
        &self,
        i: usize,
        ray: Probe,
        mut best: Nearest,
    ) -> (bool, Nearest) {
        let found = ray.meets::<ANY>(&self.blocks[i].at(&self.shifts[i], ray.share), &mut best);
        (found, best)
    }

    /// Whether a block has a hit, which `best` takes.
    #[inline(always)]
    fn block<const ANY: bool>(&self, i: usize, ray: &Probe, best: &mut Nearest) -> bool {
        let found = if self.shifts.is_empty() {
            ray.meets::<ANY>(&self.blocks[i], best)
        } else {
            let (found, nearest) = self.block_in_motion::<ANY>(i, *ray, *best);
            *best = nearest;
            found
        };
        if ANY && found {
            best.id = 0;
        }
        found
    }

    /// Whether a leaf has a hit, which `best` takes, and how many blocks were looked at.
    #[inline(always)]
    fn leaf<const ANY: bool>(&self, leaf: Child, ray: &Probe, best: &mut Nearest) -> (bool, u32) {
        let (mut steps, mut found) = (0, false);
        for i in leaf.blocks() {
            steps += 1;
            found |= self.block::<ANY>(i, ray, best);
            if ANY && found {
                break;
            }
        }
        (found, steps)
    }
}

/// A ray in the frame of a mesh's points, and what it asks. Hits have 0 < t <= `t_max`.
///
/// A ray that leaves the triangle `skip` does not meet it: a straight ray cannot, but rounding would
/// let it where the triangle is a sliver. An origin that is not finite and a `t_max` of NaN hit
/// nothing.
#[derive(Clone, Copy, Debug)]
pub struct Query<'a> {
    /// Origin.
    pub o: DVec3,
    /// Direction, made ready.
    pub direction: &'a Direction,
    /// Along the scaled direction; may be infinite. Rounded to single precision unless `exact`.
    pub t_max: f64,
    /// The triangle that the ray leaves.
    pub skip: Option<u32>,
    /// How triangles are met.
    pub precision: Precision,
    /// The share of the way that points have moved; of no account where they stand.
    pub share: f32,
}

/// A ray as leaves want it.
#[derive(Clone, Copy, Debug)]
struct Probe {
    precision: Precision,
    line: Line,
    shear: Shear,
    share: f32,
}

impl Probe {
    /// Whether a block has a hit, which `best` takes.
    #[inline(always)]
    fn meets<const ANY: bool>(&self, block: &Block, best: &mut Nearest) -> bool {
        let Self { precision, line, shear, .. } = self;
        match precision {
            Precision::Standard => block.intersect::<ANY>(shear, best),
            Precision::Fast => block.intersect_fast::<ANY>(line, shear.skip, best),
            Precision::Exact => match block.intersect_exact::<ANY>(*line, shear.skip, *best) {
                Some(nearer) => {
                    *best = nearer;
                    true
                }
                None => false,
            },
        }
    }
}

/// A ray that has been given to a tree.
#[derive(Debug)]
pub enum Begun<'t> {
    /// It is done with: what it met, and how many nodes and triangle blocks were looked at.
    Over(Option<MeshHit>, u32),
    /// It is on its way.
    Walk(MeshWalk<'t>),
}

/// A ray on its way through a mesh's tree: beside others in a [`Flock`](super::Flock).
#[derive(Debug)]
pub struct MeshWalk<'t> {
    tree: &'t MeshBvh,
    probe: Probe,
    slabs: Slabs<f32>,
    best: Nearest,
    pub(super) current: Child,
    /// Nodes and triangle blocks looked at so far.
    pub steps: u32,
}

impl MeshWalk<'_> {
    /// Looks at a node or at a leaf; true when there is nothing left. `ANY` as it began; the stack is
    /// this walk's own, empty at first.
    #[inline(always)]
    fn step<const ANY: bool>(&mut self, processor: Processor, stack: &mut Stack<'_, f32>) -> bool {
        if self.current.is_leaf() {
            let (found, n) = self.tree.leaf::<ANY>(self.current, &self.probe, &mut self.best);
            self.steps += n;
            if found && ANY {
                return true;
            }
        } else {
            let node = &self.tree.nodes[self.current.index()];
            self.steps += 1;
            if let Some(nearest) = processor.enter(&self.slabs, node, self.best.t, stack) {
                self.current = nearest;
                return false;
            }
        }
        match stack.pop_within(self.best.t) {
            Some((child, _)) => {
                self.current = child;
                false
            }
            None => true,
        }
    }

    /// Looks at a node. The stack is this walk's own, [`Child::OVER`] at its bottom, and holds nothing
    /// that is entered beyond the nearest hit: so that no branch depends on what is found.
    #[inline(always)]
    pub(super) fn at_node(&mut self, processor: Processor, stack: &mut Stack<'_, f32>) {
        self.steps += 1;
        let node = &self.tree.nodes[self.current.index()];
        processor.enter_all(&self.slabs, node, self.best.t, stack);
        self.go_to(stack.pop_unless(false, Child::OVER));
    }

    /// Looks at the first block of a leaf; true if it has a hit and any is enough. If not, `nearer` is
    /// told which triangle is the nearest now. The stack as above.
    #[inline(always)]
    pub(super) fn at_block<const ANY: bool>(
        &mut self,
        stack: &mut Stack<'_, f32>,
        nearer: impl Fn(u32),
    ) -> bool {
        self.steps += 1;
        let (rest, is_more) = self.current.behind_first();
        let first = self.current.blocks().start;
        if self.tree.block::<ANY>(first, &self.probe, &mut self.best) {
            if ANY {
                return true;
            }
            nearer(self.best.id);
            stack.keep_within(self.best.t);
        }
        self.go_to(stack.pop_unless(is_more, rest));
        false
    }

    /// Goes on there, and asks for its memory.
    #[inline(always)]
    fn go_to(&mut self, next: Child) {
        self.current = next;
        self.prefetch();
    }

    /// Asks for the memory of the next step, whatever that is.
    #[inline(always)]
    pub(super) fn prefetch(&self) {
        let MeshBvh { nodes, blocks, .. } = self.tree;
        let node = nodes.as_ptr().wrapping_add(self.current.index()).cast();
        let block = blocks.as_ptr().wrapping_add(self.current.blocks().start).cast();
        prefetch::<{ size_of::<Node>() }>(select_unpredictable(
            self.current.is_leaf(),
            block,
            node,
        ));
    }

    /// The triangle that is the nearest so far.
    #[inline(always)]
    pub(super) fn nearest(&self) -> Option<u32> {
        (self.best.id != u32::MAX).then_some(self.best.id)
    }

    /// What has been met, once it is over.
    #[inline(always)]
    pub fn hit(&self) -> Option<MeshHit> {
        self.tree.found(&self.best, self.probe.precision)
    }
}
