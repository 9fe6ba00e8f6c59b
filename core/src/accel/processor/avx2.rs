//! Boxes with AVX2: a table says where the children that are entered go.

use std::arch::x86_64::{
    __m256, __m256i, _CMP_LE_OQ, _mm256_and_si256, _mm256_cmp_ps, _mm256_loadu_ps,
    _mm256_loadu_si256, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps,
    _mm256_permutevar8x32_epi32, _mm256_permutevar8x32_ps, _mm256_set1_epi32, _mm256_set1_ps,
    _mm256_setzero_ps, _mm256_srlv_epi32, _mm256_storeu_ps, _mm256_storeu_si256, _mm256_sub_ps,
};

use crate::accel::node::{Child, Node};
use crate::accel::slabs::{Real, Slabs};
use crate::accel::stack::Stack;

/// Where each slot starts in the bits of an order.
static SHIFTS: [i32; 8] = [0, 3, 6, 9, 12, 15, 18, 21];

/// For every set of lanes, the lanes that are in it, first to last.
static FIRST: [[u32; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut n) = (0, 0);
        while lane < 8 {
            if set >> lane & 1 == 1 {
                table[set][n] = lane;
                n += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
};

/// Where a ray enters and leaves the boxes of a node, slot by slot.
pub(super) struct Spans {
    t_near: __m256,
    t_far: __m256,
}

/// The boxes of a node in the order in which directions of an octant meet them, the farthest first.
pub(super) struct Ordered {
    pub(super) t_near: __m256,
    pub(super) t_far: __m256,
    pub(super) children: __m256i,
}

impl Spans {
    /// `min` and `max` give their second operand if either is NaN, so that slab does not cut.
    #[inline]
    #[target_feature(enable = "avx2")]
    pub(super) fn of(ray: &Slabs<f32>, node: &Node, t_max: f32) -> Self {
        let mut t_near = _mm256_setzero_ps();
        let mut t_far = _mm256_set1_ps(t_max);
        for axis in 0..3 {
            let side = ray.near[axis] & 1;
            let rdir = _mm256_set1_ps(ray.rdir[axis]);
            let near = from(&node.planes[axis][side], ray.near_o[axis]);
            let far = from(&node.planes[axis][side ^ 1], ray.far_o[axis]);
            t_near = _mm256_max_ps(_mm256_mul_ps(near, rdir), t_near);
            t_far = _mm256_min_ps(_mm256_mul_ps(far, rdir), t_far);
        }
        t_far = _mm256_mul_ps(t_far, _mm256_set1_ps(f32::FAR));
        Self { t_near, t_far }
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    pub(super) fn ordered(&self, node: &Node, octant: usize) -> Ordered {
        let order = order(node.order.bits(octant));
        Ordered {
            t_near: _mm256_permutevar8x32_ps(self.t_near, order),
            t_far: _mm256_permutevar8x32_ps(self.t_far, order),
            children: _mm256_permutevar8x32_epi32(children(&node.children), order),
        }
    }
}

/// See [`Processor::enter_all`](super::Processor::enter_all).
#[inline]
#[target_feature(enable = "avx2,popcnt")]
pub(super) fn enter_all(ray: &Slabs<f32>, node: &Node, t_max: f32, stack: &mut Stack<'_, f32>) {
    let Ordered { t_near, t_far, children } = Spans::of(ray, node, t_max).ordered(node, ray.octant);
    let entered = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(t_near, t_far)) & 0xff;
    let first = &FIRST[entered.cast_unsigned() as usize];
    // SAFETY: 32 bytes are read from an array of 32.
    let first = unsafe { _mm256_loadu_si256(first.as_ptr().cast()) };
    let top = stack.top();
    let entries = _mm256_permutevar8x32_ps(t_near, first);
    // SAFETY: eight values fit at the top of the stack.
    unsafe { _mm256_storeu_ps(top.entries.as_mut_ptr().cast(), entries) };
    let children = _mm256_permutevar8x32_epi32(children, first);
    // SAFETY: as above; a child is one word.
    unsafe { _mm256_storeu_si256(top.children.as_mut_ptr().cast(), children) };
    // SAFETY: all eight have been written.
    unsafe { stack.keep(entered.count_ones() as usize) };
}

/// The slots in the order of these bits; a permutation looks at three bits of each.
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn order(bits: u32) -> __m256i {
    // SAFETY: 32 bytes are read from an array of 32.
    let shifts = unsafe { _mm256_loadu_si256(SHIFTS.as_ptr().cast()) };
    _mm256_and_si256(
        _mm256_srlv_epi32(_mm256_set1_epi32(bits.cast_signed()), shifts),
        _mm256_set1_epi32(7),
    )
}

#[inline]
#[target_feature(enable = "avx2")]
fn from(values: &[f32; 8], o: f32) -> __m256 {
    // SAFETY: 32 bytes are read from an array of 32.
    let values = unsafe { _mm256_loadu_ps(values.as_ptr()) };
    _mm256_sub_ps(values, _mm256_set1_ps(o))
}

#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn children(children: &[Child; 8]) -> __m256i {
    // SAFETY: 32 bytes are read from an array of 32.
    unsafe { _mm256_loadu_si256(children.as_ptr().cast()) }
}
