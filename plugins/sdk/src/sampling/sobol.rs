//! Owen-scrambled Sobol' points in one and two dimensions, found from their index alone.
//!
//! Burley 2020, "Practical Hash-based Owen Scrambling", with the Laine–Karras hash as improved by
//! Vegdahl 2021. Higher dimensions are padded: one seed for each pair of dimensions of a path.

mod wide;

use super::hash::{hash32, hash64, u32_to_unit};
pub use wide::{sobol_owen_1d_and_2d_pair, sobol_owen_2d_pair};

/// Number `index` of a scrambled van der Corput sequence, in [0, 1).
///
/// Any 2ᵏ points with indices from an aligned block have one in each interval of length 2⁻ᵏ.
/// Sequences of different seeds are shuffled independently.
#[inline]
pub fn sobol_owen_1d(index: u32, seed: u64) -> f32 {
    let (shuffle, scramble) = halves(hash64(seed));
    let index = owen_reversed(index.reverse_bits(), shuffle).reverse_bits();
    u32_to_unit(owen_reversed(index, scramble).reverse_bits())
}

/// Point `index` of a scrambled (0, 2)-sequence in base 2, in [0, 1)².
///
/// Any 2ᵏ points with indices from an aligned block have one in each elementary interval of area
/// 2⁻ᵏ. The order within every block is shuffled by `seed`, so pairs with different seeds are
/// independent; within a seed, consecutive indices are the samples of one pixel.
#[inline]
pub fn sobol_owen_2d(index: u32, seed: u64) -> [f32; 2] {
    let (shuffle, scramble) = halves(hash64(seed));
    let index = owen_reversed(index.reverse_bits(), shuffle).reverse_bits();
    // The first Sobol' dimension is the reversed index: already in the order that the hash wants.
    let x = owen_reversed(index, scramble);
    let y = owen_reversed(pascal(index), hash32(scramble));
    [x, y].map(u32::reverse_bits).map(u32_to_unit)
}

/// The points of two seeds: both go through every step side by side, written so that the compiler
/// finds the four lanes.
#[inline(always)]
fn pair(index: u32, seeds: [u64; 2]) -> [[f32; 2]; 2] {
    let [(shuffle_a, a), (shuffle_b, b)] = seeds.map(hash64).map(halves);
    let index = index.reverse_bits();
    let [i, j] = [owen_reversed(index, shuffle_a), owen_reversed(index, shuffle_b)];
    let [i, j] = [i, j].map(u32::reverse_bits);
    let points = [i, j, pascal(i), pascal(j)];
    let scrambles = [a, b, hash32(a), hash32(b)];
    let [xa, xb, ya, yb] = std::array::from_fn(|lane| {
        u32_to_unit(owen_reversed(points[lane], scrambles[lane]).reverse_bits())
    });
    [[xa, ya], [xb, yb]]
}

/// The upper and the lower half.
#[expect(clippy::cast_possible_truncation, reason = "the number is split into its two halves")]
#[inline]
const fn halves(x: u64) -> (u32, u32) {
    ((x >> 32) as u32, x as u32)
}

/// Owen's nested uniform scramble of a bit-reversed number: each bit is flipped by a hash of the
/// bits below it.
#[inline]
const fn owen_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second Sobol' dimension, bit-reversed: Pascal's triangle mod 2 times the index.
///
/// With bits as coefficients this is p(x) → p(x + 1) over GF(2), and (1 + x)^m = 1 + x^m for m a
/// power of two: five halvings do the work of 32 direction numbers.
#[inline]
const fn pascal(mut p: u32) -> u32 {
    p ^= (p >> 16) & 0x0000_ffff;
    p ^= (p >> 8) & 0x00ff_00ff;
    p ^= (p >> 4) & 0x0f0f_0f0f;
    p ^= (p >> 2) & 0x3333_3333;
    p ^ ((p >> 1) & 0x5555_5555)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::Counts;

    /// Cell of `u` among 2^`bits`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "u is in [0, 1)")]
    fn cell(u: f32, bits: u32) -> usize {
        (f64::from(u) * f64::from(1u32 << bits)) as usize
    }

    #[test]
    fn pascal_is_the_second_sobol_dimension() {
        for i in 0..1000u32 {
            let (mut direction, mut expected) = (1u32 << 31, 0);
            for bit in 0..32 {
                expected ^= if (i >> bit) & 1 == 1 { direction } else { 0 };
                direction ^= direction >> 1;
            }
            assert_eq!(pascal(i).reverse_bits(), expected);
        }
    }

    #[test]
    fn aligned_blocks_fill_every_elementary_interval() {
        for (k, block, seed) in [(2, 5, 1u64), (6, 0, 2), (8, 3, 3), (10, 77, 4), (12, 0, 5)] {
            let n = 1usize << k;
            let first = block << k;
            for split in 0..=k {
                let mut count = vec![0u32; n];
                for i in 0..1u32 << k {
                    let [x, y] = sobol_owen_2d(first + i, seed);
                    count[(cell(x, split) << (k - split)) + cell(y, k - split)] += 1;
                }
                assert!(count.iter().all(|&c| c == 1), "2^{k} points, split {split}");
            }
            let mut count = vec![0u32; n];
            for i in 0..1u32 << k {
                count[cell(sobol_owen_1d(first + i, seed), k)] += 1;
            }
            assert!(count.iter().all(|&c| c == 1));
        }
    }

    #[test]
    fn what_comes_at_once_is_what_comes_one_by_one() {
        let mut rng = Rng::new(8);
        for _ in 0..1000 {
            let mut seed = || u64::from(rng.u32()) << 32 | u64::from(rng.u32());
            let (seeds, first) = ([seed(), seed()], seed());
            let index = rng.u32();
            assert_eq!(
                sobol_owen_2d_pair(index, seeds),
                seeds.map(|seed| sobol_owen_2d(index, seed))
            );
            assert_eq!(pair(index, seeds), seeds.map(|seed| sobol_owen_2d(index, seed)));
            let [a, b] = seeds;
            assert_eq!(
                sobol_owen_1d_and_2d_pair(index, [first, a, b]),
                (sobol_owen_1d(index, first), seeds.map(|seed| sobol_owen_2d(index, seed)))
            );
        }
    }

    #[test]
    fn points_stay_below_one_at_any_index_and_seed() {
        let mut rng = Rng::new(9);
        for _ in 0..100_000 {
            let [x, y] =
                sobol_owen_2d(rng.u32(), u64::from(rng.u32()) << 32 | u64::from(rng.u32()));
            assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
        }
    }

    /// Variance over seeds of the mean of a smooth integrand with integral 1 over [0, 1)².
    fn estimator_variance(k: u32) -> f64 {
        let mut m = Moments::default();
        for seed in 0..128 {
            let f = |i| {
                let [x, y] = sobol_owen_2d(i, seed).map(f64::from);
                4.0 * x * y
            };
            m.push((0..1 << k).map(f).sum::<f64>() / f64::from(1 << k));
        }
        // Unbiased: within five standard errors of the mean over seeds.
        assert!((m.mean - 1.0).abs() <= 5.0 * m.standard_error(), "{} {k}", m.mean);
        m.variance()
    }

    #[test]
    fn error_of_a_smooth_integrand_falls_faster_than_that_of_random_points() {
        let (coarse, fine) = (estimator_variance(4), estimator_variance(10));
        // 64 times the points: random variance falls 64-fold, Owen's O(n⁻³ log n) by up to 1e5.
        // Variances of 128 seeds err by 12.5 % each: an 8-fold margin is beyond chance.
        assert!(coarse / fine > 512.0, "{coarse} {fine}");
        let random = (16.0 / 9.0 - 1.0) / 1024.0;
        assert!(fine < random / 1000.0, "{fine}");
    }

    #[test]
    fn one_point_is_uniform_over_seeds() {
        for index in [0, 5, 1 << 20] {
            let mut counts = Counts::new(256);
            for seed in 0..20_000 {
                let [x, y] = sobol_owen_2d(index, seed);
                counts.add(cell(x, 4) * 16 + cell(y, 4));
            }
            counts.check(|_| 1.0 / 256.0);
        }
    }

    #[test]
    fn pairs_with_different_seeds_are_uncorrelated() {
        let mut m = Moments::default();
        for seed in 0..400 {
            for i in 0..64 {
                let [a, _] = sobol_owen_2d(i, seed);
                let [b, c] = sobol_owen_2d(i, seed + 400);
                m.push(f64::from((a - 0.5) * (b - 0.5) + (a - 0.5) * (c - 0.5)));
            }
        }
        // Stratification only lowers the variance of the mean below that of independent terms.
        assert!(m.mean.abs() <= 5.0 * m.standard_error(), "{}", m.mean);
    }
}
