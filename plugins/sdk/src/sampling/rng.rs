//! A small random number generator, for tests and for the one random sequence of a path.

use super::hash::{hash64, u32_to_unit, u64_to_unit};

/// A PCG32 generator (XSH-RR, 64 bits of state, one stream); equal seeds give equal sequences.
///
/// # Source
/// O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// A generator whose place in the sequence is a hash of `seed`.
    pub const fn new(seed: u64) -> Self {
        Self { state: hash64(seed) }
    }

    /// 32 random bits.
    #[expect(clippy::cast_possible_truncation, reason = "PCG outputs the low half of its mix")]
    #[inline]
    pub const fn u32(&mut self) -> u32 {
        let old = self.state;
        self.state =
            old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(0xda3e_39cb_94b9_5bdb);
        let mixed = (((old >> 18) ^ old) >> 27) as u32;
        mixed.rotate_right((old >> 59) as u32)
    }

    /// 64 random bits.
    pub const fn u64(&mut self) -> u64 {
        ((self.u32() as u64) << 32) | self.u32() as u64
    }

    /// A number in [0, 1) with the resolution of [`u32_to_unit`].
    pub const fn f32(&mut self) -> f32 {
        u32_to_unit(self.u32())
    }

    /// A multiple of 2⁻⁵³ in [0, 1).
    pub const fn f64(&mut self) -> f64 {
        u64_to_unit(self.u64())
    }

    /// A point of [0, 1)².
    pub const fn pair(&mut self) -> [f32; 2] {
        [self.f32(), self.f32()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;

    #[test]
    fn numbers_are_uniform_and_uncorrelated() {
        let (mut first, mut lag) = (Moments::default(), Moments::default());
        let mut rng = Rng::new(8);
        let mut last = 0.5;
        for _ in 0..200_000 {
            let x = rng.f64();
            assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&rng.f32()));
            first.push(x);
            lag.push((x - 0.5) * (last - 0.5));
            last = x;
        }
        // Five standard errors: one failure in two million seeds.
        assert!((first.mean - 0.5).abs() <= 5.0 * first.standard_error());
        assert!(lag.mean.abs() <= 5.0 * lag.standard_error());
        // The variance of the squared distance of a uniform number is 1/180.
        assert!((first.variance() - 1.0 / 12.0).abs() <= 5.0 * (1.0 / 180.0 / 2e5_f64).sqrt());
    }

    #[test]
    fn the_sequence_is_that_of_pcg32() {
        // From the initial state of the reference library, by the formulas of the paper.
        let mut rng = Rng { state: 0x853c_49e6_748f_ea9b };
        let expected = [0x152c_a78d, 0x027c_6003, 0xcb07_bbf3, 0xf98b_efee];
        assert_eq!(expected.map(|_| rng.u32()), expected);
    }

    #[test]
    fn equal_seeds_repeat_and_others_differ() {
        let draw = |seed| Rng::new(seed).u64();
        assert_eq!(draw(1), draw(1));
        assert_ne!(draw(1), draw(2));
    }
}
