//! Owen-scrambled Sobol' points, padded: one pair of dimensions at a time.

use luxel_sdk::Params;
use luxel_sdk::kind::{SampleAt, Sampler};
use luxel_sdk::sampling::{
    sobol_owen_1d, sobol_owen_1d_and_2d_pair, sobol_owen_2d, sobol_owen_2d_pair,
};

/// Well-spread numbers: each pair of dimensions is a scrambled (0, 2)-sequence (Owen 1997, Burley
/// 2020), so that the error often falls faster than with independent ones. Powers of two are best.
///
/// ```scene
/// sampler sobol { samples = 1024, seed = 7 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Sobol {
    /// Samples for each pixel.
    #[param(default = 64, min = 1, max = 4_294_967_295u32)]
    samples: u32,
    /// Equal seeds give equal pictures.
    #[param(default = 0, min = 0, max = 4_294_967_295u32)]
    seed: u32,
}

impl Sampler for Sobol {
    fn samples(&self) -> u32 {
        self.samples
    }

    fn seed(&self) -> u32 {
        self.seed
    }

    fn get_1d(&self, at: SampleAt) -> f32 {
        sobol_owen_1d(at.index, seed(at))
    }

    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        sobol_owen_2d(at.index, seed(at))
    }

    fn get_2d_pair(&self, at: SampleAt) -> [[f32; 2]; 2] {
        sobol_owen_2d_pair(at.index, [seed(at), seed(at) + 2])
    }

    fn get_1d_and_2d_pair(&self, at: SampleAt) -> (f32, [[f32; 2]; 2]) {
        sobol_owen_1d_and_2d_pair(at.index, [0, 1, 3].map(|next| seed(at) + next))
    }
}

/// A seed of its own for each dimension of each pixel.
fn seed(at: SampleAt) -> u64 {
    u64::from(at.stream) << 32 | u64::from(at.dimension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "u is in [0, 1)")]
    fn sixteen_points_fill_sixteen_elementary_cells_in_every_dimension() {
        let sampler = Sobol { samples: 16, seed: 0 };
        for dimension in 0..20 {
            let mut cells = [0; 16];
            for index in 0..16 {
                let [x, y] = sampler.get_2d(SampleAt { stream: 9, index, dimension });
                cells[(x * 4.0) as usize * 4 + (y * 4.0) as usize] += 1;
            }
            assert_eq!(cells, [1; 16]);
        }
    }
}
