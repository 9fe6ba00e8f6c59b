//! Random numbers from a counter.

use luxel_sdk::Params;
use luxel_sdk::kind::{SampleAt, Sampler};
use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

/// Independent random numbers. The error falls with the square root of the number of samples; take
/// `sobol` unless you study statistics.
///
/// ```scene
/// sampler independent { samples = 256, seed = 7 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Independent {
    /// Samples for each pixel.
    #[param(default = 64, min = 1, max = 4_294_967_295u32)]
    samples: u32,
    /// Equal seeds give equal pictures.
    #[param(default = 0, min = 0, max = 4_294_967_295u32)]
    seed: u32,
}

impl Sampler for Independent {
    fn samples(&self) -> u32 {
        self.samples
    }

    fn seed(&self) -> u32 {
        self.seed
    }

    fn get_1d(&self, at: SampleAt) -> f32 {
        self.get_2d(at)[0]
    }

    #[expect(clippy::cast_possible_truncation, reason = "the hash is split into its two halves")]
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        let path = (u64::from(at.stream) << 32) | u64::from(at.index);
        let bits = hash_combine64(path, u64::from(at.dimension));
        [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_independent_uniform_numbers() {
        let sampler = Independent { samples: 1, seed: 0 };
        let n = 100_000_u32;
        let (mut mean, mut square, mut product) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let at = SampleAt { stream: i / 1000, index: i % 100, dimension: (i / 100) % 10 };
            let [a, b] = sampler.get_2d(at).map(f64::from);
            assert!((0.0..1.0).contains(&a) && (0.0..1.0).contains(&b));
            mean += a;
            square += a * a;
            product += a * b;
        }
        let n = f64::from(n);
        // Five standard errors: √(1/12), √(4/45) and √(7/144) over √n.
        assert!((mean / n - 0.5).abs() < 5.0 * 0.2887 / n.sqrt());
        assert!((square / n - 1.0 / 3.0).abs() < 5.0 * 0.2982 / n.sqrt());
        assert!((product / n - 0.25).abs() < 5.0 * 0.2205 / n.sqrt());
    }
}
