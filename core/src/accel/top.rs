//! The boxes of placements, in f64.
//!
//! Boxes are given by the caller, who makes them hold what they stand for.

use glam::{DVec3, Vec3A};

use super::build::{Timber, Tree, build};
use super::collapse::Costs;
use super::node::{Bounds, Child, Order, WIDTH, narrow};
use super::partition::Prim;
use super::passes::fold;
use super::processor::Processor;
use super::slabs::{Boxes, Slabs};
use super::stack::{Stack, is_enough_for};
use super::watch::{STRIDE, Watch};

/// Unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// Boxes in world space in an eight-wide tree.
#[derive(Debug)]
pub struct TopBvh {
    nodes: Vec<TopNode>,
    root: Option<Child>,
}

/// Eight boxes around placements.
pub(super) type TopNode = Boxes<f64>;

/// A box in the world: its least and its greatest corner.
pub type Box64 = (DVec3, DVec3);

impl TopBvh {
    /// How many boxes a tree may hold.
    pub const MOST: usize = Child::BLOCK_LIMIT;

    /// Builds the tree over boxes given as their corners (minimum, maximum), in metres.
    ///
    /// Corners may be infinite. A box that is empty (minimum above maximum) or has a NaN is never
    /// visited. At most [`TopBvh::MOST`] boxes: a scene may hold far fewer placements, and a shape far
    /// fewer parts.
    ///
    /// # Panics
    /// With more boxes than that.
    pub fn build(boxes: &[Box64]) -> Self {
        Self::build_watched(boxes, &Watch::default()).expect("nobody has cancelled it")
    }

    /// The same, followed by `watch`; `None` once that is cancelled.
    ///
    /// # Panics
    /// As `build`.
    pub fn build_watched(boxes: &[Box64], watch: &Watch) -> Option<Self> {
        assert!(boxes.len() <= Self::MOST, "callers bound what they place");
        watch.begin(boxes.len(), "parts");
        let prims = prims(boxes, watch);
        let ignored = boxes.len() - prims.len();
        let Tree { mut nodes, root, .. } = build(&Boxed(boxes), prims, watch)?;
        watch.add(ignored);
        let root = root.map(|root| {
            debug_assert!(is_enough_for(root.depth.max(1)), "builders bound the depth");
            if !root.child.is_leaf() {
                return root.child;
            }
            nodes.push(Boxed::node(&[(root.child, root.bounds)]).0);
            Child::node(0)
        });
        Some(Self { nodes, root })
    }

    /// A ray that looks for the boxes it enters at or before a limit.
    ///
    /// `t` is in units of `d`, whose length is any but zero. A ray that is not finite enters nothing.
    #[inline(always)]
    pub fn walk(&self, o: DVec3, d: DVec3, t_max: f64) -> TopWalk<'_> {
        let is_ray = o.is_finite() && d.is_finite() && d != DVec3::ZERO;
        let current = self.root.filter(|_| is_ray);
        // 8u·|o| wider, for the roundings of whoever carries the ray into a placement's frame.
        let slabs = Slabs::new(o.to_array(), d.to_array(), 8.0 * U * o.abs().max_element());
        TopWalk { nodes: &self.nodes, slabs, current, t_max: t_max.min(f64::MAX) }
    }
}

/// A ray among boxes: gives those that it enters, roughly near to far.
#[derive(Debug)]
pub struct TopWalk<'t> {
    nodes: &'t [TopNode],
    slabs: Slabs<f64>,
    /// The root, until it has been looked at.
    current: Option<Child>,
    /// Boxes that are entered farther away are passed. It may be made smaller at any time.
    pub t_max: f64,
}

impl TopWalk<'_> {
    /// The next box, and where the ray enters it: at least 0 and perhaps a few roundings early. The
    /// stack is this walk's own, empty at first.
    #[inline(always)]
    pub fn next(&mut self, processor: Processor, stack: &mut Stack<'_, f64>) -> Option<(u32, f64)> {
        let (mut current, mut t_enter) = match self.current.take() {
            Some(root) => (root, 0.0),
            None => stack.pop_within(self.t_max)?,
        };
        while !current.is_leaf() {
            let node = &self.nodes[current.index()];
            (current, t_enter) = match processor.enter_top(&self.slabs, node, self.t_max, stack) {
                Some(nearest) => nearest,
                None => stack.pop_within(self.t_max)?,
            };
        }
        Some((narrow(current.blocks().start), t_enter))
    }
}

/// The boxes in f32 within [−1, 1], for the builder alone: only the shape of the tree depends on
/// them, so rounding is harmless and what is infinite is clamped.
fn prims(boxes: &[Box64], watch: &Watch) -> Vec<Prim> {
    let real = |b: &Box64| b.0.cmple(b.1).all();
    let finite = |c: f64| if c.is_finite() { c.abs() } else { 0.0 };
    let reach = |all: f64, boxes: &[Box64]| {
        let corners = boxes.iter().filter(|b| real(b)).flat_map(|b| [b.0, b.1]);
        corners.flat_map(|p| p.to_array()).map(finite).fold(all, f64::max)
    };
    let largest = fold(boxes, watch, || f64::MIN_POSITIVE, reach, f64::max);
    let narrowed = |p: DVec3| Vec3A::from(p.map(|c| (c / largest).clamp(-1.0, 1.0)).as_vec3());
    let mut prims = Vec::with_capacity(boxes.len());
    for (stride, boxes) in boxes.chunks(STRIDE).enumerate() {
        if watch.is_cancelled() {
            break;
        }
        prims.extend((stride * STRIDE..).zip(boxes).filter(|(_, b)| real(b)).map(|(index, b)| {
            let bounds = Bounds { min: narrowed(b.0), max: narrowed(b.1) };
            Prim::new(bounds, narrow(index))
        }));
    }
    prims
}

/// The box moved outward by 8u of its own coordinates, for the roundings of whoever computed it.
fn widened((min, max): Box64) -> Box64 {
    let finite = |c: f64| if c.is_finite() { c.abs() } else { 0.0 };
    let slack = 8.0 * U * min.map(finite).max(max.map(finite));
    (min - slack, max + slack)
}

/// Boxes as what a tree is built of.
struct Boxed<'a>(&'a [Box64]);

impl Timber for Boxed<'_> {
    type Number = f64;
    /// Leaves are the boxes' own numbers.
    type Block = ();
    type Bounds = Box64;

    /// Visiting one placement costs several box tests.
    const COSTS: Costs = Costs { node: 1.0, block: 2.0, max_leaf: 1 };

    fn leaf<'p>(
        &self,
        prims: impl ExactSizeIterator<Item = &'p Prim>,
        _: &mut Vec<()>,
    ) -> (Child, Box64) {
        let index = prims.last().expect("a leaf has one").index() as usize;
        (Child::leaf(index, 1), widened(self.0[index]))
    }

    fn node(slots: &[(Child, Box64)]) -> (TopNode, Box64) {
        let mut planes = [[[f64::INFINITY; WIDTH], [f64::NEG_INFINITY; WIDTH]]; 3];
        let mut children = [slots[0].0; WIDTH];
        let mut centres = [[0.0; 3]; WIDTH];
        for (slot, (child, (min, max))) in slots.iter().enumerate() {
            children[slot] = *child;
            for axis in 0..3 {
                (planes[axis][0][slot], planes[axis][1][slot]) = (min[axis], max[axis]);
                centres[slot][axis] = 0.5 * min[axis] + 0.5 * max[axis];
            }
        }
        let node = TopNode { planes, children, order: Order::of(&centres[..slots.len()]) };
        let all = slots.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |all, (_, b)| {
            (all.0.min(b.0), all.1.max(b.1))
        });
        (node, all)
    }
}

#[cfg(test)]
mod tests {
    use super::super::slabs::Real;
    use super::super::soup::Rng;
    use super::super::stack::Room;
    use super::*;

    /// Shows the boxes that a ray enters to `see`, which gives the limit from there on, until it
    /// gives none.
    fn walk(
        processor: Processor,
        tree: &TopBvh,
        (o, d): (DVec3, DVec3),
        t_max: f64,
        mut see: impl FnMut(u32, f64, f64) -> Option<f64>,
    ) {
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = tree.walk(o, d, t_max);
        while let Some((index, t_enter)) = walk.next(processor, &mut stack) {
            let Some(limit) = see(index, t_enter, walk.t_max) else { break };
            walk.t_max = limit;
        }
    }

    fn boxes(n: usize, size: f32, rng: &mut Rng) -> Vec<Box64> {
        (0..n)
            .map(|_| {
                let (c, e) = (rng.point().as_dvec3() * 10.0, rng.point().as_dvec3().abs());
                (c - e * f64::from(size), c + e * f64::from(size))
            })
            .collect()
    }

    /// Entry into one box, by the textbook; `None` if it is missed.
    fn slab((min, max): Box64, o: DVec3, d: DVec3, t_max: f64) -> Option<f64> {
        let (a, b) = ((min - o) / d, (max - o) / d);
        let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element().min(t_max));
        (near <= far).then_some(near)
    }

    /// What a ray enters, which is the same on every processor.
    fn visited(tree: &TopBvh, o: DVec3, d: DVec3, t_max: f64) -> Vec<u32> {
        let mut all = vec![];
        for processor in Processor::all() {
            let mut seen = vec![];
            walk(processor, tree, (o, d), t_max, |index, _, t_max| {
                seen.push(index);
                Some(t_max)
            });
            seen.sort_unstable();
            all.push(seen);
        }
        assert!(all.iter().all(|seen| *seen == all[0]));
        all.swap_remove(0)
    }

    #[test]
    fn visits_are_those_of_every_box_in_turn() {
        let mut rng = Rng(21);
        for n in [1, 2, 4, 5, 17, 40, 1000, 9000] {
            let boxes = boxes(n, 1.0, &mut rng);
            let tree = TopBvh::build(&boxes);
            for _ in 0..20 {
                let (o, d) = (rng.point().as_dvec3() * 20.0, rng.point().as_dvec3());
                let t_max = f64::from(rng.next()) * 60.0;
                let all = (0..).zip(&boxes).filter(|(_, b)| slab(**b, o, d, t_max).is_some());
                let all: Vec<u32> = all.map(|(i, _)| i).collect();
                assert_eq!(visited(&tree, o, d, t_max), all, "{n} boxes");
            }
        }
    }

    #[test]
    fn nearest_entry_is_found_while_the_limit_shrinks() {
        let mut rng = Rng(22);
        let boxes = boxes(3000, 0.3, &mut rng);
        let tree = TopBvh::build(&boxes);
        for _ in 0..500 {
            let (o, d) = (rng.point().as_dvec3() * 15.0, rng.point().as_dvec3());
            let best = boxes.iter().filter_map(|b| slab(*b, o, d, 1e9)).fold(f64::MAX, f64::min);
            let mut found = f64::MAX;
            walk(Processor::widest(), &tree, (o, d), 1e9, |index, t_enter, t_max| {
                if let Some(t) = slab(boxes[index as usize], o, d, t_max) {
                    // Three roundings on either side, and the slack of the origin.
                    assert!(t_enter <= t * <f64 as Real>::FAR, "{t_enter} {t}");
                    found = found.min(t);
                }
                Some(found.min(t_max))
            });
            assert_eq!(found.to_bits(), best.to_bits());
        }
    }

    #[test]
    fn a_walk_may_be_left() {
        let mut rng = Rng(23);
        let tree = TopBvh::build(&boxes(500, 3.0, &mut rng));
        let mut calls = 0;
        let ray = (DVec3::splat(-20.0), DVec3::ONE);
        walk(Processor::ANY, &tree, ray, f64::INFINITY, |_, _, t_max| {
            calls += 1;
            (calls < 3).then_some(t_max)
        });
        assert_eq!(calls, 3);
    }

    #[test]
    fn ten_thousand_equal_boxes_and_no_boxes_are_fine() {
        let unit = (DVec3::ZERO, DVec3::ONE);
        let tree = TopBvh::build(&vec![unit; 10_000]);
        assert_eq!(visited(&tree, DVec3::splat(0.5), DVec3::X, 1.0).len(), 10_000);
        let none = TopBvh::build(&[]);
        assert!(visited(&none, DVec3::ZERO, DVec3::X, f64::INFINITY).is_empty());
    }

    #[test]
    fn infinite_boxes_are_visited_and_broken_ones_are_not() {
        let all = (DVec3::NEG_INFINITY, DVec3::INFINITY);
        let floor = (
            DVec3::new(f64::NEG_INFINITY, -1.0, f64::NEG_INFINITY),
            DVec3::new(f64::INFINITY, -1.0, f64::INFINITY),
        );
        let broken = (DVec3::NAN, DVec3::ONE);
        let empty = (DVec3::ONE, DVec3::ZERO);
        let far = (DVec3::splat(1e300), DVec3::splat(2e300));
        let tree = TopBvh::build(&[all, floor, broken, empty, far]);
        let seen = |d| visited(&tree, DVec3::ZERO, d, f64::INFINITY);
        assert!(seen(DVec3::NEG_Y).contains(&1));
        assert_eq!(seen(DVec3::ONE), [0, 4]);
        assert!(visited(&TopBvh::build(&[all]), DVec3::ZERO, DVec3::NAN, 1.0).is_empty());
    }

    #[test]
    fn flat_boxes_and_parallel_rays_meet_in_their_plane() {
        let flat = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 2.0));
        let tree = TopBvh::build(&[flat]);
        let enter = |o, d| visited(&tree, o, d, f64::INFINITY).len();
        assert_eq!(enter(DVec3::new(-1.0, 1.0, 1.0), DVec3::X), 1);
        assert_eq!(enter(DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, -0.0, 0.0)), 1);
        assert_eq!(enter(DVec3::new(-1.0, 1.0, 2.0), DVec3::new(1.0, 0.0, -0.0)), 1);
        assert_eq!(enter(DVec3::new(-1.0, 1.1, 1.0), DVec3::X), 0);
    }

    #[test]
    fn distance_from_the_world_origin_does_not_lose_a_box() {
        let c = DVec3::splat(1e9);
        let tree = TopBvh::build(&[(c, c + 1e-3), (c + 2.0, c + 3.0)]);
        let o = c + DVec3::new(5e-4, 5e-4, -3.0);
        assert!(visited(&tree, o, DVec3::Z, 10.0).contains(&0));
        assert!(visited(&tree, o, DVec3::NEG_Z, 10.0).is_empty());
    }
}
