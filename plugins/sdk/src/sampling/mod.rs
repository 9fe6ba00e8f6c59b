//! Sampling: random numbers, low-discrepancy points, warps with their densities, distributions.
//!
//! A warp takes `u` in [0, 1)² to a domain, and a density says how often it lands where; both are
//! in one file and are tested against each other.

mod alias;
#[cfg(test)]
mod chi_square;
mod disk;
mod ggx;
mod hash;
mod mis;
mod piecewise;
mod piecewise2;
mod rng;
mod sobol;
mod sphere;
mod spherical_triangle;
mod weights;

pub use alias::{Alias, AliasSample};
pub use disk::{DISK_PDF, disk_concentric, exponential, exponential_pdf, uniform_triangle};
pub use ggx::{visible_normal, visible_normal_pdf};
pub use hash::{hash_combine, hash_combine64, hash32, hash64, u32_to_unit, u64_to_unit};
pub use mis::{balance_heuristic, power_heuristic};
pub use piecewise::{Piecewise1, Piecewise1Sample};
pub use piecewise2::{Piecewise2, Piecewise2Sample};
pub use rng::Rng;
pub use sobol::{sobol_owen_1d, sobol_owen_1d_and_2d_pair, sobol_owen_2d, sobol_owen_2d_pair};
pub use sphere::{
    HEMISPHERE_PDF, SPHERE_PDF, cosine_hemisphere, cosine_hemisphere_pdf, one_minus_cos,
    one_minus_cos_from_sin2, uniform_cone, uniform_cone_pdf, uniform_hemisphere, uniform_sphere,
};
pub use spherical_triangle::SphericalTriangle;
pub use weights::WeightError;
