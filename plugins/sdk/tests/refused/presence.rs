use luxel_sdk::{Params, params::Emission};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Neither.
    #[param(min = 0)]
    //~ needs one of `default = …`, `required` and `optional`
    neither: f32,
    /// Two of them.
    #[param(default = 0.5, required)]
    //~ `default` and `required` exclude each other: keep one of `default = …`, `required` and `optional`
    both: f32,
    /// All of them.
    #[param(required, optional, default = 0.5)]
    //~ `default` and `required` and `optional` exclude each other: keep one of `default = …`, `required` and `optional`
    all: f32,
    /// An amount is the default.
    #[param(emission(radiance, scale), required, optional)]
    //~ `required` and `optional` exclude each other: keep one of `default = …`, `required` and `optional`
    emission: Emission,
    /// No attribute at all.
    //~ this field is not a parameter yet: it needs #[param(…)], or #[param(derived)] where `prepare` computes it
    bare: f32,
}

fn main() {}
