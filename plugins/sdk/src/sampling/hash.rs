//! Mixing functions and the way from random bits to numbers in [0, 1).
//!
//! All are fixed for good: pictures are deterministic in (scene, seed, pixel, sample).

/// Mixes 32 bits; a bijection that takes 0 to 0.
///
/// # Source
/// Wellons 2018, "Prospecting for Hash Functions", `lowbias32`.
#[inline]
pub const fn hash32(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Mixes 64 bits; a bijection that takes 0 to a random-looking number.
///
/// # Source
/// Steele et al. 2014, "Fast Splittable Pseudorandom Number Generators", one step of `SplitMix64`
/// with the finaliser of Stafford's variant 13.
#[inline]
pub const fn hash64(x: u64) -> u64 {
    let mut x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A new 32-bit seed from a seed and a number: pixel, dimension, replicate. Not symmetric.
#[inline]
pub const fn hash_combine(seed: u32, x: u32) -> u32 {
    (hash64(((seed as u64) << 32) | x as u64) >> 32) as u32
}

/// A new 64-bit seed from a seed and a number. Not symmetric.
#[inline]
pub const fn hash_combine64(seed: u64, x: u64) -> u64 {
    hash64(seed ^ hash64(x))
}

/// An f32 of [0, 1) at or just below `x` · 2⁻³²: exact below 2⁻⁸, a multiple of 2⁻²⁴ above.
///
/// Rounds down, so that a point never leaves its elementary interval and 1 is never reached; the
/// lowest above zero is 2⁻³².
#[inline]
pub const fn u32_to_unit(x: u32) -> f32 {
    let kept = if x < 1 << 24 { x } else { x & !0xff };
    kept as f32 * (1.0 / (1u64 << 32) as f32)
}

/// A multiple of 2⁻⁵³ in [0, 1) from the upper 53 bits of `x`.
#[inline]
pub const fn u64_to_unit(x: u64) -> f64 {
    (x >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean number of output bits that flip with one input bit, over `n` inputs: 1/2 of `width`.
    fn check_avalanche(width: u32, flips: impl Fn(u64, u32) -> u32) {
        let n = 4096;
        for bit in 0..width {
            let total: u32 = (0..n).map(|i| flips(u64::from(hash32(i)), bit)).sum();
            let mean = f64::from(total) / f64::from(n);
            // Six standard errors of a binomial, and the known bias of lowbias32 (0.17 bits).
            let bound = 6.0 * (f64::from(width) / 4.0 / f64::from(n)).sqrt() + 0.17;
            assert!((mean - f64::from(width) / 2.0).abs() <= bound, "bit {bit}: {mean}");
        }
    }

    #[test]
    fn one_input_bit_flips_half_of_the_output() {
        let low = |x: u64| u32::try_from(x & 0xffff_ffff).unwrap();
        check_avalanche(32, |x, b| (hash32(low(x)) ^ hash32(low(x) ^ (1 << b))).count_ones());
        check_avalanche(64, |x, b| (hash64(x) ^ hash64(x ^ (1 << b))).count_ones());
    }

    #[test]
    fn combining_depends_on_order() {
        assert_ne!(hash_combine(1, 2), hash_combine(2, 1));
        assert_ne!(hash_combine64(1, 2), hash_combine64(2, 1));
        assert_ne!(hash_combine(0, 0), 0);
    }

    #[test]
    fn unit_numbers_round_down_and_stay_below_one() {
        assert!(u32_to_unit(u32::MAX) < 1.0 && u64_to_unit(u64::MAX) < 1.0);
        assert!(u32_to_unit(0).to_bits() == 0 && u32_to_unit(1) > 0.0);
        for i in 0..100_000u32 {
            let x = hash32(i);
            let exact = f64::from(x) / 4_294_967_296.0;
            let found = f64::from(u32_to_unit(x));
            assert!(found <= exact && exact - found < 1.0 / 16_777_216.0);
            let small = f64::from(u32_to_unit(x >> 8));
            assert!((small - f64::from(x >> 8) / 4_294_967_296.0).abs() <= 0.0);
        }
    }
}
