//! The boxes of placements, in f64.
//!
//! The slab test is that of [`super::ray`] in double precision; boxes are given by the caller, who
//! makes them hold what they stand for.

use glam::{DVec3, Vec3};

use super::build::binary;
use super::collapse::{Costs, Sink, collapse};
use super::node::{Bounds, Child, Order, WIDTH, narrow};
use super::partition::Prim;

/// Unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// 1 + 2γ(3), see PBR4 §6.8.3.
const FAR: f64 = 1.0 + 2.0 * (3.0 * U / (1.0 - 3.0 * U)) + f64::EPSILON;

/// Visiting one placement costs several box tests.
const COSTS: Costs = Costs { node: 1.0, block: 2.0, max_leaf: 1 };

/// Boxes in world space in a four-wide tree.
#[derive(Debug)]
pub struct TopBvh {
    nodes: Vec<TopNode>,
    root: Option<Child>,
    stack: usize,
    /// Largest finite |coordinate|.
    reach: f64,
}

#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct TopNode {
    planes: [[[f64; WIDTH]; 2]; 3],
    children: [Child; WIDTH],
    order: Order,
}

type Box64 = (DVec3, DVec3);

impl TopBvh {
    /// Builds the tree over boxes given as their corners (minimum, maximum), in metres.
    ///
    /// Corners may be infinite. A box that is empty (minimum above maximum) or has a NaN is never
    /// visited. At most 2²⁹ boxes.
    ///
    /// # Panics
    /// With more boxes than that.
    pub fn build(boxes: &[(DVec3, DVec3)]) -> Self {
        assert!(boxes.len() < Child::BLOCK_LIMIT, "at most 2^29 placements");
        let prims = prims(boxes);
        let reach = boxes.iter().flat_map(|b| [b.0, b.1]).flat_map(|p| p.to_array());
        let reach = reach.map(f64::abs).filter(|c| c.is_finite()).fold(0.0, f64::max);
        if prims.is_empty() {
            return Self { nodes: Vec::new(), root: None, stack: 0, reach };
        }
        let mut prims = prims;
        let binary = binary(&mut prims);
        let mut sink = TopSink { boxes, prims: &prims, nodes: Vec::new() };
        let mut root = collapse(&binary, COSTS, &mut sink);
        if root.child.is_leaf() {
            root.child = sink.node(&[(root.child, root.bounds)]).0;
            root.depth = 1;
        }
        Self { nodes: sink.nodes, root: Some(root.child), stack: 3 * root.depth + 4, reach }
    }

    /// Calls `leaf(index, t_enter, t_max)` for the boxes that the ray enters at or before the
    /// current limit, roughly near to far. What `leaf` returns becomes the limit; the result is the
    /// last such value, or `None` if there was none.
    ///
    /// `t` is in units of `d`, whose length is any but zero. `t_enter` is at least 0 and may be a
    /// few roundings early. A ray that is not finite enters nothing.
    pub fn intersect(
        &self,
        o: DVec3,
        d: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(u32, f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let mut found = None;
        self.walk(o, d, t_max, |index, t_enter, t_max| {
            let nearer = leaf(index, t_enter, t_max);
            found = nearer.or(found);
            Step::Go(nearer.unwrap_or(t_max))
        });
        found
    }

    /// True as soon as `leaf(index, t_enter, t_max)` is, for a box that the ray enters within
    /// `t_max`; in no promised order.
    pub fn any(
        &self,
        o: DVec3,
        d: DVec3,
        t_max: f64,
        mut leaf: impl FnMut(u32, f64, f64) -> bool,
    ) -> bool {
        let mut found = false;
        self.walk(o, d, t_max, |index, t_enter, t_max| {
            found = leaf(index, t_enter, t_max);
            if found { Step::Stop } else { Step::Go(t_max) }
        });
        found
    }

    #[inline(always)]
    fn walk(&self, o: DVec3, d: DVec3, t_max: f64, leaf: impl FnMut(u32, f64, f64) -> Step) {
        let Some(root) = self.root else { return };
        if !(o.is_finite() && d.is_finite() && d != DVec3::ZERO) {
            return;
        }
        let ray = TopRay::new(o, d, self.reach);
        let t_max = t_max.min(f64::MAX);
        match self.stack {
            0..=32 => self.walk_with::<32>(root, &ray, t_max, leaf),
            _ => self.walk_with::<256>(root, &ray, t_max, leaf),
        }
    }

    #[inline]
    fn walk_with<const LEN: usize>(
        &self,
        root: Child,
        ray: &TopRay,
        mut t_max: f64,
        mut leaf: impl FnMut(u32, f64, f64) -> Step,
    ) {
        let mut stack = [(root, 0.0f64); LEN];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (current, t_enter) = stack[top & (LEN - 1)];
            if t_enter > t_max * FAR {
                continue;
            }
            if current.is_leaf() {
                match leaf(narrow(current.blocks().start), t_enter, t_max) {
                    Step::Go(limit) => t_max = limit,
                    Step::Stop => return,
                }
                continue;
            }
            let node = &self.nodes[current.index()];
            let (near, far) = ray.enter(node, t_max);
            for place in (0..WIDTH).rev() {
                let slot = node.order.slot(ray.octant, place);
                stack[top & (LEN - 1)] = (node.children[slot], near[slot]);
                top += usize::from(near[slot] <= far[slot]);
            }
        }
    }
}

enum Step {
    Go(f64),
    Stop,
}

struct TopRay {
    near_o: [f64; 3],
    far_o: [f64; 3],
    rdir: [f64; 3],
    near: [usize; 3],
    octant: usize,
}

impl TopRay {
    /// Widens boxes by 8u·(|o| + |p|), for the roundings of whoever computed them and of whoever
    /// carries the ray into a placement's frame.
    #[inline]
    fn new(o: DVec3, d: DVec3, reach: f64) -> Self {
        let slack = 8.0 * U * (o.abs().max_element() + reach);
        let negative = d.to_array().map(f64::is_sign_negative);
        let apart = |axis: usize| if negative[axis] { -slack } else { slack };
        Self {
            near_o: [0, 1, 2].map(|axis| o[axis] + apart(axis)),
            far_o: [0, 1, 2].map(|axis| o[axis] - apart(axis)),
            rdir: d.recip().to_array(),
            near: negative.map(usize::from),
            octant: (0..3).map(|axis| usize::from(negative[axis]) << axis).sum(),
        }
    }

    /// Entry and exit of the four boxes; a box is missed where the entry is the later. A slab that
    /// gives NaN (a parallel ray within its plane) does not cut.
    #[inline(always)]
    fn enter(&self, node: &TopNode, t_max: f64) -> ([f64; WIDTH], [f64; WIDTH]) {
        let mut t_near = [0.0; WIDTH];
        let mut t_far = [t_max; WIDTH];
        for axis in 0..3 {
            let side = self.near[axis] & 1;
            let (near, far) = (&node.planes[axis][side], &node.planes[axis][side ^ 1]);
            for lane in 0..WIDTH {
                let enter = (near[lane] - self.near_o[axis]) * self.rdir[axis];
                let leave = (far[lane] - self.far_o[axis]) * self.rdir[axis];
                t_near[lane] = if enter > t_near[lane] { enter } else { t_near[lane] };
                t_far[lane] = if leave < t_far[lane] { leave } else { t_far[lane] };
            }
        }
        (t_near, t_far.map(|t| t * FAR))
    }
}

/// The boxes in f32 within [−1, 1], for the builder alone: only the shape of the tree depends on
/// them, so rounding is harmless and what is infinite is clamped.
fn prims(boxes: &[Box64]) -> Vec<Prim> {
    let real = |b: &&Box64| b.0.cmple(b.1).all();
    let finite = |c: f64| if c.is_finite() { c } else { 0.0 };
    let largest = boxes.iter().filter(real).flat_map(|b| [b.0, b.1]).flat_map(|p| p.to_array());
    let largest = largest.map(|c| finite(c).abs()).fold(f64::MIN_POSITIVE, f64::max);
    let narrow_point =
        |p: DVec3| -> Vec3 { p.map(|c| (c / largest).clamp(-1.0, 1.0)).as_vec3() };
    boxes
        .iter()
        .enumerate()
        .filter(|(_, b)| real(b))
        .map(|(index, b)| {
            let bounds = Bounds { min: narrow_point(b.0), max: narrow_point(b.1) };
            Prim { bounds, index: narrow(index) }
        })
        .collect()
}

struct TopSink<'a> {
    boxes: &'a [Box64],
    prims: &'a [Prim],
    nodes: Vec<TopNode>,
}

impl Sink for TopSink<'_> {
    type Bounds = Box64;

    fn leaf(&mut self, prims: &[u32]) -> (Child, Box64) {
        let index = self.prims[prims[0] as usize].index as usize;
        (Child::leaf(index, 1), self.boxes[index])
    }

    fn node(&mut self, slots: &[(Child, Box64)]) -> (Child, Box64) {
        let mut planes = [[[f64::INFINITY; WIDTH], [f64::NEG_INFINITY; WIDTH]]; 3];
        let mut children = [slots[0].0; WIDTH];
        let mut centres = [[f64::INFINITY; 3]; WIDTH];
        for (slot, (child, (min, max))) in slots.iter().enumerate() {
            children[slot] = *child;
            for axis in 0..3 {
                (planes[axis][0][slot], planes[axis][1][slot]) = (min[axis], max[axis]);
                centres[slot][axis] = 0.5 * min[axis] + 0.5 * max[axis];
            }
        }
        self.nodes.push(TopNode { planes, children, order: Order::of(&centres) });
        let all = slots.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |all, (_, b)| {
            (all.0.min(b.0), all.1.max(b.1))
        });
        (Child::node(self.nodes.len() - 1), all)
    }
}
