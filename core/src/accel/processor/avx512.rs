//! Boxes with AVX-512: the children that are entered are written in one piece, in their order. The
//! nearest is found beside that, from the other end: the next step would wait for it to be written
//! and read again.

use std::arch::x86_64::{
    __m256i, __m512d, _CMP_LE_OQ, _mm256_cmp_ps_mask, _mm256_cvtsi256_si32,
    _mm256_maskz_compress_epi32, _mm256_maskz_compress_ps, _mm256_permutevar8x32_epi32,
    _mm256_storeu_ps, _mm256_storeu_si256, _mm512_cmp_pd_mask, _mm512_cvtepu32_epi64,
    _mm512_cvtsd_f64, _mm512_loadu_pd, _mm512_maskz_compress_pd, _mm512_max_pd, _mm512_min_pd,
    _mm512_mul_pd, _mm512_permutexvar_pd, _mm512_set1_pd, _mm512_setzero_pd, _mm512_storeu_pd,
    _mm512_sub_pd,
};

use super::avx2::{Ordered, Spans, children, order};
use crate::accel::node::{Child, Node};
use crate::accel::slabs::{Real, Slabs};
use crate::accel::stack::Stack;
use crate::accel::top::TopNode;

/// See [`Processor::enter`](super::Processor::enter).
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
pub(super) fn enter(
    ray: &Slabs<f32>,
    node: &Node,
    t_max: f32,
    stack: &mut Stack<'_, f32>,
) -> Option<Child> {
    let spans = Spans::of(ray, node, t_max);
    let Ordered { t_near, t_far, children } = spans.ordered(node, against(ray.octant));
    let entered = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(t_near, t_far);
    let nearest = first(_mm256_maskz_compress_epi32(entered, children));
    let others = write(&spans.ordered(node, ray.octant), stack).checked_sub(1)?;
    // SAFETY: all eight have been written.
    unsafe { stack.keep(others) };
    Some(nearest)
}

/// See [`Processor::enter_all`](super::Processor::enter_all).
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
pub(super) fn enter_all(ray: &Slabs<f32>, node: &Node, t_max: f32, stack: &mut Stack<'_, f32>) {
    let entered = write(&Spans::of(ray, node, t_max).ordered(node, ray.octant), stack);
    // SAFETY: all eight have been written.
    unsafe { stack.keep(entered) };
}

/// Writes eight entries on top of a stack, those that are entered first; how many these are.
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
fn write(boxes: &Ordered, stack: &mut Stack<'_, f32>) -> usize {
    let entered = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(boxes.t_near, boxes.t_far);
    let top = stack.top();
    let entries = _mm256_maskz_compress_ps(entered, boxes.t_near);
    // SAFETY: eight values fit at the top of the stack.
    unsafe { _mm256_storeu_ps(top.entries.as_mut_ptr().cast(), entries) };
    let children = _mm256_maskz_compress_epi32(entered, boxes.children);
    // SAFETY: as above; a child is one word.
    unsafe { _mm256_storeu_si256(top.children.as_mut_ptr().cast(), children) };
    entered.count_ones() as usize
}

/// See [`Processor::enter_top`](super::Processor::enter_top).
#[inline]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
pub(super) fn enter_top(
    ray: &Slabs<f64>,
    node: &TopNode,
    t_max: f64,
    stack: &mut Stack<'_, f64>,
) -> Option<(Child, f64)> {
    let mut t_near = _mm512_setzero_pd();
    let mut t_far = _mm512_set1_pd(t_max);
    for axis in 0..3 {
        let side = ray.near[axis] & 1;
        let rdir = _mm512_set1_pd(ray.rdir[axis]);
        let near = wide(&node.planes[axis][side], ray.near_o[axis]);
        let far = wide(&node.planes[axis][side ^ 1], ray.far_o[axis]);
        t_near = _mm512_max_pd(_mm512_mul_pd(near, rdir), t_near);
        t_far = _mm512_min_pd(_mm512_mul_pd(far, rdir), t_far);
    }
    t_far = _mm512_mul_pd(t_far, _mm512_set1_pd(f64::FAR));
    let ordered = |octant| {
        let order = order(node.order.bits(octant));
        let wide_order = _mm512_cvtepu32_epi64(order);
        let t_near = _mm512_permutexvar_pd(wide_order, t_near);
        let t_far = _mm512_permutexvar_pd(wide_order, t_far);
        let children = _mm256_permutevar8x32_epi32(children(&node.children), order);
        (t_near, children, _mm512_cmp_pd_mask::<_CMP_LE_OQ>(t_near, t_far))
    };
    let (near_first, near_children, entered) = ordered(against(ray.octant));
    let t_nearest = _mm512_cvtsd_f64(_mm512_maskz_compress_pd(entered, near_first));
    let nearest = first(_mm256_maskz_compress_epi32(entered, near_children));
    let (t_near, children, entered) = ordered(ray.octant);
    let top = stack.top();
    let entries = _mm512_maskz_compress_pd(entered, t_near);
    // SAFETY: eight values fit at the top of the stack.
    unsafe { _mm512_storeu_pd(top.entries.as_mut_ptr().cast(), entries) };
    let children = _mm256_maskz_compress_epi32(entered, children);
    // SAFETY: as above; a child is one word.
    unsafe { _mm256_storeu_si256(top.children.as_mut_ptr().cast(), children) };
    let others = (entered.count_ones() as usize).checked_sub(1)?;
    // SAFETY: all eight have been written.
    unsafe { stack.keep(others) };
    Some((nearest, t_nearest))
}

/// The octant of the opposite direction, which meets boxes the other way round.
#[inline(always)]
fn against(octant: usize) -> usize {
    octant ^ 7
}

/// The child in the first lane.
#[inline]
#[target_feature(enable = "avx512f")]
fn first(children: __m256i) -> Child {
    Child::from_bits(_mm256_cvtsi256_si32(children).cast_unsigned())
}

#[inline]
#[target_feature(enable = "avx512f")]
fn wide(values: &[f64; 8], o: f64) -> __m512d {
    // SAFETY: 64 bytes are read from an array of 64.
    let values = unsafe { _mm512_loadu_pd(values.as_ptr()) };
    _mm512_sub_pd(values, _mm512_set1_pd(o))
}
