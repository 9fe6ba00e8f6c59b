//! A texture as a plugin: noise through space.

use glam::{DVec3, IVec3, Vec3};
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Texture, TexturePoint};
use luxel_sdk::sampling::{hash_combine, u32_to_unit};

/// Clouds, marble, rust: smooth noise from `low` to `high`, through space, so that it fits any shape.
/// Both ends may be textures of their own.
///
/// ```scene
/// let stone = texture noise { size = 20 cm, octaves = 5, low = 0.1, high = 0.7 }
/// let wall  = material diffuse { reflectance = stone }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct Noise {
    /// Where the noise is lowest.
    #[param(default = 0.0, textured)]
    low: Spectrum,
    /// Where it is highest.
    #[param(default = 1.0, textured)]
    high: Spectrum,
    /// Of its largest features.
    #[param(default = 1.0, unit = "m", min = 1e-6, max = 1e6)]
    size: f32,
    /// Layers, each half as large and half as strong as the one before.
    #[param(default = 4, min = 1, max = 16)]
    octaves: u32,
}

impl Texture for Noise {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        let (mut p, mut sum, mut strength) = (at.p / f64::from(self.size), 0.0, 0.5);
        for octave in 0..self.octaves {
            sum += strength * value(p, octave);
            (p, strength) = (p * 2.0, strength * 0.5);
        }
        // The layers together reach 1 − 2^−n.
        let share = sum / (1.0 - strength * 2.0);
        self.low * (1.0 - share) + self.high * share
    }
}

/// Values at the corners of a lattice, in [0, 1), blended smoothly. Beyond what an `i32` counts the
/// lattice ends.
fn value(p: DVec3, octave: u32) -> f32 {
    let cell = p.floor();
    let corner = cell.as_ivec3();
    let t = (p - cell).as_vec3().clamp(Vec3::ZERO, Vec3::ONE);
    let t = t * t * (3.0 - 2.0 * t);
    let line = |y, z| {
        let [a, b] = [0, 1].map(|x| lattice(corner.wrapping_add(IVec3::new(x, y, z)), octave));
        a + (b - a) * t.x
    };
    let plane = |z| {
        let [a, b] = [line(0, z), line(1, z)];
        a + (b - a) * t.y
    };
    let [a, b] = [plane(0), plane(1)];
    a + (b - a) * t.z
}

fn lattice(at: IVec3, octave: u32) -> f32 {
    let at = at.as_uvec3();
    u32_to_unit(hash_combine(hash_combine(hash_combine(octave, at.x), at.y), at.z))
}

luxel_sdk::plugin! { texture "noise" => Noise; }
