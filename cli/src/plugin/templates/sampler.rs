//! A sampler, to be made your own.

use luxel_sdk::Params;
use luxel_sdk::kind::{SampleAt, Sampler};
use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

/// Independent random numbers: a hash of which number is wanted.
///
/// ```scene
/// sampler template_name { samples = 64, seed = 7 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Samples for each pixel.
    #[param(default = 64, min = 1, max = 4_294_967_295u32)]
    samples: u32,
    /// Equal seeds give equal pictures.
    #[param(default = 0, min = 0, max = 4_294_967_295u32)]
    seed: u32,
}

impl Sampler for TemplateName {
    fn samples(&self) -> u32 {
        self.samples
    }

    /// The host mixes it into `stream`.
    fn seed(&self) -> u32 {
        self.seed
    }

    fn get_1d(&self, at: SampleAt) -> f32 {
        self.get_2d(at)[0]
    }

    /// A function of `at` alone, so that pictures do not depend on threads.
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        let path = (u64::from(at.stream) << 32) | u64::from(at.index);
        let bits = hash_combine64(path, u64::from(at.dimension));
        [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
    }
}

luxel_sdk::plugin! { sampler "template_name" => TemplateName; }
