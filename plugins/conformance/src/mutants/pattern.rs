//! Ramps with a fault.

use std::sync::atomic::{AtomicU32, Ordering};

use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Output, Texture, TexturePoint};

use super::Mutant;

/// A ramp along v whose place and value pass through two functions, and what it says its lanes
/// mean.
macro_rules! ramp {
    ($name:ident, $place:expr, $value:expr, $output:expr) => {
        /// A ramp with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Where v is whole.
            #[param(default = 0.1, textured)]
            from: Spectrum,
            /// Just before the next whole number.
            #[param(default = 0.9, textured)]
            to: Spectrum,
        }

        impl Texture for $name {
            fn eval(&self, at: &TexturePoint) -> Spectrum {
                let place: fn(&TexturePoint) -> f32 = $place;
                let t = place(at);
                let value: fn(Spectrum) -> Spectrum = $value;
                value(self.from * (1.0 - t) + self.to * t)
            }

            fn output(&self) -> Output {
                $output
            }
        }
    };
}

/// Place along the ramp in [0, 1].
fn along(at: &TexturePoint) -> f32 {
    let t = at.uv.y - at.uv.y.floor();
    if t.is_finite() { t } else { 0.0 }
}

/// The place for the row that was looked up last: the memory is shared and knows u alone.
fn remembered(at: &TexturePoint) -> f32 {
    static U: AtomicU32 = AtomicU32::new(u32::MAX);
    static T: AtomicU32 = AtomicU32::new(0);
    let key = at.uv.x.to_bits();
    if U.swap(key, Ordering::Relaxed) == key {
        return f32::from_bits(T.load(Ordering::Relaxed));
    }
    let t = along(at);
    T.store(t.to_bits(), Ordering::Relaxed);
    t
}

/// Looks a table up. What is left of the floor of a tiny number below zero rounds to 1.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 64]")]
fn tabulated(at: &TexturePoint) -> f32 {
    let table: [f32; 64] = std::array::from_fn(|row| row as f32 / 64.0);
    table[(along(at) * 64.0) as usize]
}

/// Overshoots the last tenth of the ramp, by at most 4 %.
fn overshooting(at: &TexturePoint) -> f32 {
    let t = along(at);
    if t > 0.9 { t + 0.4 * (t - 0.9) } else { t }
}

/// First and third lane exchanged.
fn exchanged(value: Spectrum) -> Spectrum {
    let [a, b, c, d] = value.to_array();
    Spectrum::new(c, b, a, d)
}

ramp!(SoundRamp, along, |value| value, Output::Value);
ramp!(Remembers, remembered, |value| value, Output::Value);
ramp!(PastTheTable, tabulated, |value| value, Output::Value);
ramp!(LastTenth, overshooting, |value| value, Output::Value);
ramp!(BlueIsRed, along, exchanged, Output::Value);
// Its colours are at the path's wavelengths already: they would be uplifted twice.
ramp!(SaysRgb, along, |value| value, Output::Rgb);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::texture::<SoundRamp>("sound_ramp");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::texture::<Remembers>("remembers"), fault: "memory that knows u alone" },
    Mutant {
        class: Class::texture::<PastTheTable>("past_the_table"),
        fault: "index out of range just below 0",
    },
    Mutant {
        class: Class::texture::<LastTenth>("last_tenth"),
        fault: "too far in a tenth, by 4 %",
    },
    Mutant { class: Class::texture::<BlueIsRed>("blue_is_red"), fault: "exchanges two lanes" },
    Mutant { class: Class::texture::<SaysRgb>("says_rgb"), fault: "its lanes are not RGB" },
];
