//! What materials share: Fresnel's equations and microfacets, in the local frame of a surface.

mod fresnel;
mod ggx;

pub use fresnel::{
    conductor_reflectance, dielectric_reflectance, film_reflectance, polarised_reflectances,
    refract,
};
pub use ggx::{Ggx, SMOOTH_ALPHA};

use glam::Vec3;

/// Whether both unit vectors are strictly on one side of the plane z = 0. False for a NaN.
pub fn same_side(a: Vec3, b: Vec3) -> bool {
    (a.z > 0.0 && b.z > 0.0) || (a.z < 0.0 && b.z < 0.0)
}
