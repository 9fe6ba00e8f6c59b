use luxel_sdk::{Params, color::Spectrum, params::Emission};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Unknown key.
    //~ unknown key `minimum`; the keys are default, required, optional, min, max, unit, role, textured, choice, name, group, deprecated, emission, derived, shared
    #[param(default = 0.5, minimum = 0)]
    key: f32,
    /// Unknown role.
    //~ unknown role `refletance`; the roles are plain, reflectance, illuminant, ior, complex_ior, coefficient, waves, count
    #[param(default = 0.5, role = refletance)]
    role: f32,
    /// Twice.
    //~ `min` is given twice
    #[param(default = 0.5, min = 0, min = 1)]
    twice: f32,
    /// No texture.
    #[param(default = 1, textured)]
    //~ a texture cannot drive this, only f32, Vec3, Spectrum, Emission, ComplexIor
    count: u32,
    /// Not a length by wavelength.
    //~ `role = waves` is for a Spectrum with `unit = "m"`, without `default` and `textured`
    #[param(default = 0.0, unit = "m", role = waves)]
    thickness: Spectrum,
    /// Unknown amount.
    //~ unknown amount `brightness`; the amounts are scale, power, radiance, intensity, illuminance
    #[param(emission(radiance, brightness))]
    emission: Emission,
    /// No emission.
    #[param(emission(radiance))]
    //~ an Emission and the key `emission(…)` with its amounts go together
    number: f32,
    #[param(derived, min = 0)]
    //~ a `derived` field is not a parameter: without `min`
    derived: f32,
}

fn main() {}
