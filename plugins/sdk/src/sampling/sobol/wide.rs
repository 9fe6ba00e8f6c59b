//! Points of several seeds side by side, where a processor multiplies several numbers of 64 bits and
//! turns the order of bits at once.
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "calls what was compiled for a processor that has been found")
)]

use super::{pair, sobol_owen_1d};

/// The points of two seeds, perhaps for less than twice the price.
#[inline]
pub fn sobol_owen_2d_pair(index: u32, seeds: [u64; 2]) -> [[f32; 2]; 2] {
    #[cfg(target_arch = "x86_64")]
    if x86::is_there() {
        let [a, b] = seeds;
        // SAFETY: the processor was asked.
        return unsafe { x86::pair(index, a, b) };
    }
    pair(index, seeds)
}

/// A number of the first seed and the points of two more, perhaps for the price of those.
#[inline]
pub fn sobol_owen_1d_and_2d_pair(index: u32, seeds: [u64; 3]) -> (f32, [[f32; 2]; 2]) {
    let [a, b, c] = seeds;
    #[cfg(target_arch = "x86_64")]
    if x86::is_there() {
        // SAFETY: the processor was asked.
        return unsafe { x86::three(index, a, b, c) };
    }
    (sobol_owen_1d(index, a), pair(index, [b, c]))
}

/// Each function does to every lane what its namesake does to one number.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{
        __m128, __m128i, __m256, __m256i, _mm_and_si128, _mm_cvtss_f32, _mm_movehl_ps,
        _mm_mullo_epi32, _mm_set_epi8, _mm_set1_epi32, _mm_srli_epi32, _mm_storeu_ps,
        _mm_unpacklo_ps, _mm_xor_si128, _mm256_add_epi32, _mm256_add_epi64,
        _mm256_broadcastsi128_si256, _mm256_castps256_ps128, _mm256_castsi256_si128,
        _mm256_cmpge_epu32_mask, _mm256_cvtepi32_ps, _mm256_cvtepi64_epi32, _mm256_extractf128_ps,
        _mm256_gf2p8affine_epi64_epi8, _mm256_mask_blend_ps, _mm256_mask_srli_epi32, _mm256_mul_ps,
        _mm256_mullo_epi32, _mm256_mullo_epi64, _mm256_or_si256, _mm256_set_epi64x,
        _mm256_set_m128i, _mm256_set1_epi32, _mm256_set1_epi64x, _mm256_set1_ps,
        _mm256_shuffle_epi8, _mm256_srli_epi32, _mm256_srli_epi64, _mm256_xor_si256,
    };

    /// The matrix that turns eight bits round.
    const MIRROR: i64 = 0x8040_2010_0804_0201_u64.cast_signed();

    /// 2⁻³².
    const UNIT: f32 = 1.0 / (1u64 << 32) as f32;

    /// Whether the processor has all that this takes.
    #[inline]
    pub(super) fn is_there() -> bool {
        is_x86_feature_detected!("gfni")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
    }

    /// The seeds come one by one, in registers: read as one right after they were written apart, they
    /// would be waited for.
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    pub(super) fn pair(index: u32, a: u64, b: u64) -> [[f32; 2]; 2] {
        let (x, y) = points(index, a, b, b);
        stored(_mm_unpacklo_ps(x, y))
    }

    /// See [`pair`].
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    pub(super) fn three(index: u32, a: u64, b: u64, c: u64) -> (f32, [[f32; 2]; 2]) {
        let (x, y) = points(index, b, c, a);
        (_mm_cvtss_f32(_mm_movehl_ps(x, x)), stored(_mm_unpacklo_ps(x, y)))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn stored(points: __m128) -> [[f32; 2]; 2] {
        let mut out = [[0.0; 2]; 2];
        // SAFETY: four numbers fit.
        unsafe { _mm_storeu_ps(out.as_mut_ptr().cast(), points) };
        out
    }

    /// The first and the second coordinates of three points.
    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn points(index: u32, a: u64, b: u64, c: u64) -> (__m128, __m128) {
        let [a, b, c] = [a, b, c].map(u64::cast_signed);
        let hashes = hash64(_mm256_set_epi64x(c, c, b, a));
        let shuffles = both(_mm256_cvtepi64_epi32(_mm256_srli_epi64::<32>(hashes)));
        let scrambles = _mm256_cvtepi64_epi32(hashes);
        let index = reverse_bits(_mm256_set1_epi32(index.cast_signed()));
        let x = _mm256_castsi256_si128(reverse_bits(owen_reversed(index, shuffles)));
        let x = _mm256_set_m128i(pascal(x), x);
        let scrambles = _mm256_set_m128i(hash32(scrambles), scrambles);
        let points = u32_to_unit(reverse_bits(owen_reversed(x, scrambles)));
        (_mm256_castps256_ps128(points), _mm256_extractf128_ps::<1>(points))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn both(x: __m128i) -> __m256i {
        _mm256_broadcastsi128_si256(x)
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn hash64(x: __m256i) -> __m256i {
        let of = |x: u64| _mm256_set1_epi64x(x.cast_signed());
        let mut x = _mm256_add_epi64(x, of(0x9e37_79b9_7f4a_7c15));
        x = _mm256_xor_si256(x, _mm256_srli_epi64::<30>(x));
        x = _mm256_mullo_epi64(x, of(0xbf58_476d_1ce4_e5b9));
        x = _mm256_xor_si256(x, _mm256_srli_epi64::<27>(x));
        x = _mm256_mullo_epi64(x, of(0x94d0_49bb_1331_11eb));
        _mm256_xor_si256(x, _mm256_srli_epi64::<31>(x))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn hash32(mut x: __m128i) -> __m128i {
        let of = |x: u32| _mm_set1_epi32(x.cast_signed());
        x = _mm_xor_si128(x, _mm_srli_epi32::<16>(x));
        x = _mm_mullo_epi32(x, of(0x7feb_352d));
        x = _mm_xor_si128(x, _mm_srli_epi32::<15>(x));
        x = _mm_mullo_epi32(x, of(0x846c_a68b));
        _mm_xor_si128(x, _mm_srli_epi32::<16>(x))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn owen_reversed(mut x: __m256i, seed: __m256i) -> __m256i {
        let times = |x, factor| _mm256_mullo_epi32(x, _mm256_set1_epi32(factor));
        x = _mm256_xor_si256(x, times(x, 0x3d20_adea));
        x = _mm256_add_epi32(x, seed);
        let odd = _mm256_or_si256(_mm256_srli_epi32::<16>(seed), _mm256_set1_epi32(1));
        x = _mm256_mullo_epi32(x, odd);
        x = _mm256_xor_si256(x, times(x, 0x0552_6c56));
        _mm256_xor_si256(x, times(x, 0x53a2_2864))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn pascal(mut p: __m128i) -> __m128i {
        let kept = |p, mask| _mm_and_si128(p, _mm_set1_epi32(mask));
        p = _mm_xor_si128(p, _mm_srli_epi32::<16>(p));
        p = _mm_xor_si128(p, kept(_mm_srli_epi32::<8>(p), 0x00ff_00ff));
        p = _mm_xor_si128(p, kept(_mm_srli_epi32::<4>(p), 0x0f0f_0f0f));
        p = _mm_xor_si128(p, kept(_mm_srli_epi32::<2>(p), 0x3333_3333));
        _mm_xor_si128(p, kept(_mm_srli_epi32::<1>(p), 0x5555_5555))
    }

    /// The bits of each byte by a product of matrices over GF(2), then the bytes.
    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn reverse_bits(x: __m256i) -> __m256i {
        let x = _mm256_gf2p8affine_epi64_epi8::<0>(x, _mm256_set1_epi64x(MIRROR));
        let bytes = _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3);
        _mm256_shuffle_epi8(x, both(bytes))
    }

    #[inline]
    #[target_feature(enable = "gfni,avx512dq,avx512vl")]
    fn u32_to_unit(x: __m256i) -> __m256 {
        let is_large = _mm256_cmpge_epu32_mask(x, _mm256_set1_epi32(1 << 24));
        let kept = _mm256_mask_srli_epi32::<8>(x, is_large, x);
        let one =
            _mm256_mask_blend_ps(is_large, _mm256_set1_ps(UNIT), _mm256_set1_ps(256.0 * UNIT));
        _mm256_mul_ps(_mm256_cvtepi32_ps(kept), one)
    }
}
