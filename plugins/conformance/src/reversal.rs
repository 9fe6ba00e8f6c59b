//! Specular boundaries: light that turns back on its way goes back where it came from.

use glam::Vec3;
use luxel_sdk::kind::{Lobe, Material, Sample};
use luxel_sdk::num::Moments;
use luxel_sdk::sampling::{Rng, uniform_sphere};

use crate::report::Judge;
use crate::statistics::{deviation, mean_error};

/// Viewers of each material, and samples of each.
const VIEWS: u32 = 24;
const SAMPLES: u32 = 1024;

/// Least cosine of both directions: nearer to grazing, what directions round changes the Fresnel
/// terms by more than [`ROUNDING`].
const GRAZING: f32 = 0.1;

/// Lengths along the surface may be off by two dozen roundings of f32, of up to the index.
const OFF: f32 = 1.5e-6;

/// A Fresnel term changes by less than 8 times the cosine, and that by 10 times what lengths along
/// the surface are off at the least cosine.
const ROUNDING: f64 = 80.0 * OFF as f64;

/// From behind a specular boundary the way back is open: with the inverse index, and carrying the
/// same share of the energy.
pub(crate) fn is_reversible(
    m: &dyn Material,
    rng: &mut Rng,
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) {
    for _ in 0..VIEWS {
        let wo = uniform_sphere(rng.pair());
        let passes = |s: &Sample| s.lobe.has(Lobe::DELTA.with(Lobe::TRANSMISSION));
        let Some(s) = (0..8).find_map(|_| draw(m, wo, rng).filter(passes)) else { continue };
        if wo.z.abs() < GRAZING || s.wi.z.abs() < GRAZING {
            continue;
        }
        let (there, _) = carried(m, (wo, s.wi), rng);
        let (back, eta) = carried(m, (s.wi, wo), rng);
        let shown =
            || format!("{}: wo {wo}: {s:?}: {} there, {} back", at(), there.mean, back.mean);
        let sigma = mean_error(&there).hypot(mean_error(&back));
        let z = deviation(there.mean - back.mean, ROUNDING, sigma);
        judge.statistic("what passes in passes out", z, shown);
        if let Some(eta) = eta {
            let off = f64::from((eta * s.eta - 1.0).abs());
            // Two quotients of f32.
            judge.within("the index back is the inverse", off, 1e-6, shown);
        }
    }
}

fn draw(m: &dyn Material, wo: Vec3, rng: &mut Rng) -> Option<Sample> {
    let [u, v] = rng.pair();
    m.sample(wo, [u, v, rng.f32()])
}

/// What goes specularly from one direction to another, energy over energy, in the first lane (its
/// direction is right); and with what index.
fn carried(m: &dyn Material, (wo, wi): (Vec3, Vec3), rng: &mut Rng) -> (Moments, Option<f32>) {
    let (mut energy, mut eta) = (Moments::default(), None);
    for _ in 0..SAMPLES {
        let found = draw(m, wo, rng).filter(|s| {
            let off = (s.wi - wi).truncate().length();
            s.lobe.has(Lobe::DELTA) && s.wi.z * wi.z > 0.0 && off <= OFF * s.eta.max(1.0 / s.eta)
        });
        eta = eta.or(found.map(|s| s.eta));
        energy.push(found.map_or(0.0, |s| f64::from(s.weight.lane(0) * s.eta * s.eta)));
    }
    (energy, eta)
}
