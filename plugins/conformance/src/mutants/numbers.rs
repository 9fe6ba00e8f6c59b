//! Samplers, a tent filter and a flat camera with a fault.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Camera, CameraRay, Filter, Raster, SampleAt, Sampler};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Look;
use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

use super::Mutant;

/// Two independent numbers.
#[expect(clippy::cast_possible_truncation, reason = "the hash is split into its two halves")]
fn pair(at: SampleAt) -> [f32; 2] {
    let path = (u64::from(at.stream) << 32) | u64::from(at.index);
    let bits = hash_combine64(path, u64::from(at.dimension));
    [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
}

/// Independent numbers whose place and values pass through two functions, and how many dimensions
/// on the second of two pairs is, and two pairs are that come with one number.
macro_rules! sampler {
    ($name:ident, $place:expr, $value:expr, $step:expr, $after:expr) => {
        /// Numbers with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Samples for each pixel.
            #[param(default = 64, min = 1, max = 4_294_967_295u32)]
            samples: u32,
            /// Equal seeds give equal numbers.
            #[param(default = 0, min = 0, max = 4_294_967_295u32)]
            seed: u32,
        }

        impl Sampler for $name {
            fn samples(&self) -> u32 {
                self.samples
            }

            fn seed(&self) -> u32 {
                self.seed
            }

            fn get_1d(&self, at: SampleAt) -> f32 {
                self.get_2d(at)[0]
            }

            fn get_2d(&self, at: SampleAt) -> [f32; 2] {
                let place: fn(SampleAt) -> SampleAt = $place;
                let value: fn(f32) -> f32 = $value;
                pair(place(at)).map(value)
            }

            fn get_2d_pair(&self, at: SampleAt) -> [[f32; 2]; 2] {
                let next = SampleAt { dimension: at.dimension + $step, ..at };
                [self.get_2d(at), self.get_2d(next)]
            }

            fn get_1d_and_2d_pair(&self, at: SampleAt) -> (f32, [[f32; 2]; 2]) {
                let next = SampleAt { dimension: at.dimension + $after, ..at };
                (self.get_1d(at), self.get_2d_pair(next))
            }
        }
    };
}

sampler!(SoundNumbers, |at| at, |u| u, 2, 1);
sampler!(PairsOverlap, |at| at, |u| u, 1, 1);
sampler!(PairsComeEarly, |at| at, |u| u, 2, 0);
sampler!(AllPixelsAlike, |at| SampleAt { stream: 7, ..at }, |u| u, 2, 1);
sampler!(ShortPeriod, |at| SampleAt { index: at.index & 0xfff, ..at }, |u| u, 2, 1);
sampler!(EightBits, |at| at, |u| (u * 256.0).floor() / 256.0, 2, 1);

/// A tent whose left side is as wide as a factor says, with the power of its radius in its height.
macro_rules! tent {
    ($name:ident, $left:expr, $power:expr) => {
        /// A tent with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Half the width, pixels.
            #[param(default = 1.0, min = 0.01, max = 16)]
            radius: f32,
        }

        impl Filter for $name {
            fn radius(&self) -> f32 {
                self.radius
            }

            fn eval(&self, offset: [f32; 2]) -> f32 {
                let [x, y] = offset.map(|x| (1.0 - (x / self.radius).abs()).max(0.0));
                x * y / self.radius.powi($power)
            }

            fn sample(&self, u: [f32; 2]) -> [f32; 2] {
                let side = |u: f32| (2.0 * u).sqrt() - 1.0;
                u.map(|u| self.radius * if u < 0.5 { $left * side(u) } else { -side(1.0 - u) })
            }
        }
    };
}

tent!(SoundTent, 1.0, 2);
tent!(UnitTent, 1.0, 1);
tent!(LeansRight, 0.96, 2);

/// A camera of parallel rays, with what it takes for the width of a picture and for its front.
macro_rules! flat {
    ($name:ident, $size:expr, $front:expr) => {
        /// A flat camera with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Where it stands.
            #[param(required)]
            look: Look,
            /// What the picture shows from bottom to top.
            #[param(default = 2.0, unit = "m", min = 1e-6, max = 1e6)]
            height: f64,
        }

        impl Camera for $name {
            fn ray(&self, raster: Raster, p: DVec2, _lens: [f32; 2]) -> Option<CameraRay> {
                let (right, up, backward) = self.look.axes();
                let stretch: fn(Raster) -> f64 = $size;
                let at = raster.to_screen(p) * (0.5 * self.height);
                let o = self.look.from + right * (at.x * stretch(raster)) + up * at.y;
                Some(CameraRay { ray: Ray::new(o, -backward), weight: 1.0 })
            }

            fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
                let (right, up, backward) = self.look.axes();
                let local = p - self.look.from;
                let screen = DVec2::new(local.dot(right), local.dot(up)) / (0.5 * self.height);
                let front: fn(f64) -> bool = $front;
                front(-local.dot(backward)).then(|| raster.of_screen(screen))
            }
        }
    };
}

/// Height over width.
fn portrait(raster: Raster) -> f64 {
    f64::from(raster.size.y) / f64::from(raster.size.x)
}

flat!(SoundFlat, |_| 1.0, |depth| depth > 0.0);
flat!(SquarePictures, portrait, |depth| depth > 0.0);
flat!(SeesBehind, |_| 1.0, |_| true);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: &[Class] = &[
    Class::sampler::<SoundNumbers>("sound_numbers"),
    Class::filter::<SoundTent>("sound_tent"),
    Class::camera::<SoundFlat>("sound_flat"),
];

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::sampler::<PairsOverlap>("pairs_overlap"),
        fault: "pairs one dimension on",
    },
    Mutant {
        class: Class::sampler::<PairsComeEarly>("pairs_come_early"),
        fault: "the number before two pairs is in them too",
    },
    Mutant {
        class: Class::sampler::<AllPixelsAlike>("all_pixels_alike"),
        fault: "ignores the stream",
    },
    Mutant {
        class: Class::sampler::<ShortPeriod>("short_period"),
        fault: "repeats after 4096 samples",
    },
    Mutant { class: Class::sampler::<EightBits>("eight_bits"), fault: "256 different numbers" },
    Mutant { class: Class::filter::<UnitTent>("unit_tent"), fault: "integrates to its radius" },
    Mutant { class: Class::filter::<LeansRight>("leans_right"), fault: "4 % narrower to the left" },
    Mutant {
        class: Class::camera::<SquarePictures>("square_pictures"),
        fault: "rays for square pictures",
    },
    Mutant {
        class: Class::camera::<SeesBehind>("sees_behind"),
        fault: "projects what is behind it",
    },
];
