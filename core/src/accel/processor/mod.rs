//! One piece of work, compiled for what the processor has.
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "calls what was compiled for a processor that has been found")
)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(test)]
mod tests;

use super::node::{Child, Node};
use super::slabs::Slabs;
use super::stack::Stack;
use super::top::TopNode;

/// Work that is compiled for several processors. A closure would not do: the compiler decides
/// whether that stands in its caller, and its caller is what says for which processor it is.
pub trait Work {
    /// Does it; to be `inline(always)`, like everything that it calls and that should be as fast.
    fn run(self, processor: Processor);
}

/// Which instructions there are. Its holder may use them: only what finds them makes one.
///
/// Every choice gives the same results to the last bit: other instructions, not other roundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Processor(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Any,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Processor {
    /// For work that is not worth a copy of its own: instructions that every processor has.
    pub const ANY: Self = Self(Kind::Any);

    /// What there is here, the widest last.
    pub fn all() -> Vec<Self> {
        [
            Some(Self::ANY),
            #[cfg(target_arch = "x86_64")]
            has_avx2().then_some(Self(Kind::Avx2)),
            #[cfg(target_arch = "x86_64")]
            has_avx512().then_some(Self(Kind::Avx512)),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// The widest there is.
    #[inline]
    pub fn widest() -> Self {
        #[cfg(target_arch = "x86_64")]
        if has_avx512() {
            return Self(Kind::Avx512);
        } else if has_avx2() {
            return Self(Kind::Avx2);
        }
        Self::ANY
    }

    /// A name for people.
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Any => "any processor",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "AVX-512",
        }
    }

    /// Does the work in code compiled for these instructions: everything in it that is
    /// `inline(always)` is compiled once for each.
    #[inline]
    pub fn run(self, work: impl Work) {
        match self.0 {
            Kind::Any => work.run(self),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => {
                // SAFETY: whoever made this value found the instructions.
                unsafe { in_avx2(work) }
            }
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => {
                // SAFETY: as above.
                unsafe { in_avx512(work) }
            }
        }
    }

    /// The nearest of the children of a node that the ray enters at or before `t_max`; puts the others
    /// on the stack, the nearest of them last.
    #[inline(always)]
    pub(super) fn enter(
        self,
        ray: &Slabs<f32>,
        node: &Node,
        t_max: f32,
        stack: &mut Stack<'_, f32>,
    ) -> Option<Child> {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => {
                // SAFETY: whoever made this value found the instructions.
                unsafe { avx512::enter(ray, node, t_max, stack) }
            }
            _ => {
                let below = stack.len();
                self.enter_all(ray, node, t_max, stack);
                Some(stack.pop_above(below)?.0)
            }
        }
    }

    /// Puts the children of a node that the ray enters at or before `t_max` on the stack, the nearest
    /// last.
    #[inline(always)]
    pub(super) fn enter_all(
        self,
        ray: &Slabs<f32>,
        node: &Node,
        t_max: f32,
        stack: &mut Stack<'_, f32>,
    ) {
        match self.0 {
            Kind::Any => ray.enter_all(node, t_max, stack),
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => {
                // SAFETY: whoever made this value found the instructions.
                unsafe { avx2::enter_all(ray, node, t_max, stack) }
            }
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => {
                // SAFETY: as above.
                unsafe { avx512::enter_all(ray, node, t_max, stack) }
            }
        }
    }

    /// As `enter` for a node of placements, and where the ray enters the nearest.
    #[inline(always)]
    pub(super) fn enter_top(
        self,
        ray: &Slabs<f64>,
        node: &TopNode,
        t_max: f64,
        stack: &mut Stack<'_, f64>,
    ) -> Option<(Child, f64)> {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => {
                // SAFETY: whoever made this value found the instructions.
                unsafe { avx512::enter_top(ray, node, t_max, stack) }
            }
            _ => ray.enter(node, t_max, stack),
        }
    }
}

/// Asks for the cache line where a small value begins, so that it is near when it is read.
#[inline(always)]
pub fn prefetch_value<T>(value: &T) {
    prefetch::<1>(std::ptr::from_ref(value).cast());
}

/// Asks for the cache lines of so many bytes, so that they are near when they are read.
#[inline(always)]
pub(super) fn prefetch<const BYTES: usize>(at: *const u8) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..BYTES.div_ceil(64) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: it reads nothing, and every x86-64 has it.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(64 * line).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

/// Whether the processor has what x86-64-v3 names.
#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("fma")
}

/// Whether the processor has what x86-64-v4 names.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,fma")]
fn in_avx2(work: impl Work) {
    work.run(Processor(Kind::Avx2));
}

#[cfg(target_arch = "x86_64")]
#[target_feature(
    enable = "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt,fma"
)]
fn in_avx512(work: impl Work) {
    work.run(Processor(Kind::Avx512));
}
