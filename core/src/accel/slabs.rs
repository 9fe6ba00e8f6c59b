//! Boxes against a ray, in either precision: the robust slab test.
//!
//! Source: PBR4 §6.8.2 (slabs) with the bound of §6.8.3.

use std::ops::{Add, Mul, Sub};

use super::node::{Child, Order, WIDTH};
use super::stack::Stack;

/// A floating-point number of a tree: f32 for triangles, f64 for placements.
pub trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// Zero.
    const ZERO: Self;

    /// 1 + 2γ(3): each slab distance has three roundings (subtraction, reciprocal, product), so a
    /// far plane this much farther is never before a near plane that it touches.
    const FAR: Self;

    /// One over it.
    fn recip(self) -> Self;

    /// Whether its sign bit is set.
    fn is_negative(self) -> bool;
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const FAR: Self = 1.0 + 2.0 * (1.5 * f32::EPSILON / (1.0 - 1.5 * f32::EPSILON)) + f32::EPSILON;

    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn is_negative(self) -> bool {
        self.is_sign_negative()
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const FAR: Self = 1.0 + 2.0 * (1.5 * f64::EPSILON / (1.0 - 1.5 * f64::EPSILON)) + f64::EPSILON;

    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn is_negative(self) -> bool {
        self.is_sign_negative()
    }
}

/// Eight boxes by coordinate: `planes[axis][0]` holds their minima, `[1]` their maxima. Slots without
/// a child have empty boxes, which no ray enters.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Boxes<T> {
    pub(super) planes: [[[T; WIDTH]; 2]; 3],
    pub(super) children: [Child; WIDTH],
    pub(super) order: Order,
}

/// A ray as the box test wants it.
#[derive(Debug)]
pub(super) struct Slabs<T> {
    /// Origins for the near and the far planes: the ray's own moved apart by the slack.
    pub(super) near_o: [T; 3],
    pub(super) far_o: [T; 3],
    pub(super) rdir: [T; 3],
    /// Which plane of each axis is entered first, 0 or 1.
    pub(super) near: [usize; 3],
    /// One bit per negative component.
    pub(super) octant: usize,
}

impl<T: Real> Slabs<T> {
    /// A ray for which every box is `slack` wider: that is moving the origin, once per ray.
    #[inline(always)]
    pub(super) fn new(o: [T; 3], d: [T; 3], slack: T) -> Self {
        let near = d.map(|c| usize::from(c.is_negative()));
        let moved = |forward: bool, axis: usize| {
            if d[axis].is_negative() == forward { o[axis] - slack } else { o[axis] + slack }
        };
        Self {
            near_o: [moved(true, 0), moved(true, 1), moved(true, 2)],
            far_o: [moved(false, 0), moved(false, 1), moved(false, 2)],
            rdir: d.map(T::recip),
            near,
            octant: near[0] | near[1] << 1 | near[2] << 2,
        }
    }

    /// The nearest of the children that the ray enters at or before `t_max`, and where it does; puts
    /// the others on the stack, the nearest of them last.
    #[inline(always)]
    pub(super) fn enter(
        &self,
        boxes: &Boxes<T>,
        t_max: T,
        stack: &mut Stack<'_, T>,
    ) -> Option<(Child, T)> {
        let below = stack.len();
        self.enter_all(boxes, t_max, stack);
        stack.pop_above(below)
    }

    /// Puts the children that the ray enters at or before `t_max` on the stack, the nearest last.
    ///
    /// A direction component of zero makes infinities, and NaN where the origin lies in a plane: a
    /// slab with a NaN does not cut.
    #[inline(always)]
    pub(super) fn enter_all(&self, boxes: &Boxes<T>, t_max: T, stack: &mut Stack<'_, T>) {
        let mut t_near = [T::ZERO; WIDTH];
        let mut t_far = [t_max; WIDTH];
        for axis in 0..3 {
            let side = self.near[axis] & 1;
            let (near, far) = (&boxes.planes[axis][side], &boxes.planes[axis][side ^ 1]);
            for lane in 0..WIDTH {
                let enter = (near[lane] - self.near_o[axis]) * self.rdir[axis];
                let leave = (far[lane] - self.far_o[axis]) * self.rdir[axis];
                t_near[lane] = if enter > t_near[lane] { enter } else { t_near[lane] };
                t_far[lane] = if leave < t_far[lane] { leave } else { t_far[lane] };
            }
        }
        for slot in boxes.order.far_to_near(self.octant) {
            let entered = t_near[slot] <= t_far[slot] * T::FAR;
            stack.push_if(entered, boxes.children[slot], t_near[slot]);
        }
    }
}

impl<T: Real> Stack<'_, T> {
    /// What was kept last of what is entered at or before `t_max`.
    #[inline(always)]
    pub(super) fn pop_within(&mut self, t_max: T) -> Option<(Child, T)> {
        loop {
            let top = self.pop()?;
            if is_within(top.1, t_max) {
                return Some(top);
            }
        }
    }

    /// Forgets what is entered beyond `t_max`.
    #[inline(always)]
    pub(super) fn keep_within(&mut self, t_max: T) {
        self.keep_if(|entry| is_within(entry, t_max));
    }
}

/// Whether a box that a ray enters there may hold something at or before `t_max`.
#[inline(always)]
fn is_within<T: Real>(t_enter: T, t_max: T) -> bool {
    t_enter <= t_max * T::FAR
}
