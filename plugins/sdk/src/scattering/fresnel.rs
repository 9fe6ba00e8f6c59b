//! How much a smooth boundary reflects, and where the rest goes.

use glam::{Vec3, Vec4};

use crate::color::Spectrum;

/// Fraction of unpolarised light that a boundary of two dielectrics reflects, in [0, 1].
///
/// `cos_i` in [0, 1] is the cosine to the normal, `eta` > 0 the index beyond over the index here.
/// Total reflection gives exactly 1, `eta` 1 exactly 0. Worked out in f64, so that an index of
/// 1 + 1e-6 keeps its 2.5e-13. A NaN gives 1.
///
/// # Source
/// PBR4 §9.3.5, eq. 9.5.
#[expect(clippy::cast_possible_truncation, reason = "rounds; the result is in [0, 1]")]
pub fn dielectric_reflectance(cos_i: f32, eta: f32) -> f32 {
    let (c, eta) = (f64::from(cos_i).clamp(0.0, 1.0), f64::from(eta));
    let Some(h) = beyond(c, eta) else { return 1.0 };
    let [parallel, perpendicular] = polarised(c, eta, h);
    (0.5 * (parallel + perpendicular)) as f32
}

/// The same of light of each polarisation: parallel and perpendicular to the plane of incidence. Their mean
/// is `dielectric_reflectance`.
///
/// # Source
/// PBR4 §9.3.5, eqs. 9.3 and 9.4, squared.
#[expect(clippy::cast_possible_truncation, reason = "rounds; the result is in [0, 1]")]
pub fn polarised_reflectances(cos_i: f32, eta: f32) -> [f32; 2] {
    let (c, eta) = (f64::from(cos_i).clamp(0.0, 1.0), f64::from(eta));
    beyond(c, eta).map_or([1.0; 2], |h| polarised(c, eta, h).map(|share| share as f32))
}

/// Fractions of light of the two polarisations, parallel and perpendicular to the plane of incidence;
/// `h` as `beyond` gives it.
fn polarised(c: f64, eta: f64, h: f64) -> [f64; 2] {
    let parallel = (eta * eta * c - h) / (eta * eta * c + h);
    let perpendicular = (c - h) / (c + h);
    [parallel * parallel, perpendicular * perpendicular]
}

/// Fraction of unpolarised light that a clear film with the same on both sides reflects, per lane, in
/// [0, 1]: all that goes to and fro between its sides, summed as waves.
///
/// `cos_i` in [0, 1] outside the film, `eta` ≥ 1 its index over the index around it, `waves` ≥ 0 its
/// thickness over the wavelength outside. `cos_i` 0 gives 1, and so does a NaN.
///
/// # Source
/// Airy's summation: Born & Wolf §7.6.1.
#[expect(clippy::cast_possible_truncation, reason = "rounds; the result is in [0, 1]")]
pub fn film_reflectance(cos_i: f32, eta: f32, waves: Spectrum) -> Spectrum {
    let (c, eta) = (f64::from(cos_i).clamp(0.0, 1.0), f64::from(eta));
    let Some(h) = beyond(c, eta) else { return Spectrum::ONE };
    let lane = |waves: f64| {
        let out_of_step = (std::f64::consts::TAU * h * waves).sin().powi(2);
        let summed = polarised(c, eta, h).map(|once| {
            let twice = 4.0 * once * out_of_step;
            let all = (1.0 - once) * (1.0 - once) + twice;
            if all > 0.0 { twice / all } else { 1.0 }
        });
        0.5 * (summed[0] + summed[1])
    };
    Spectrum::from_array(waves.to_array().map(|waves| lane(f64::from(waves)) as f32))
}

/// eta times the cosine on the far side, by `η² cos_t² = η² − 1 + cos_i²`: exact for an index of 1, and
/// good at grazing angles. `None` for total reflection and for a NaN.
fn beyond(cos_i: f64, eta: f64) -> Option<f64> {
    let square = (eta - 1.0) * (eta + 1.0) + cos_i * cos_i;
    (square > 0.0).then(|| square.sqrt())
}

/// Fraction of unpolarised light that a metal of index eta − i·k reflects, per lane, in [0, 1].
///
/// `cos_i` in [0, 1]; `eta`, `k` ≥ 0 relative to the medium outside. Written as ratios of sums of
/// squares: nothing cancels at grazing angles or for good metals. Lanes without an answer (NaN, both
/// zero, overflow) give 1.
///
/// # Source
/// Born & Wolf §14.2; PBR4 §9.3.6. With a² − b² = eta² − k² − sin², a·b = eta·k.
pub fn conductor_reflectance(cos_i: f32, eta: Spectrum, k: Spectrum) -> Spectrum {
    let c = cos_i.clamp(0.0, 1.0);
    let sin2 = (1.0 - c) * (1.0 + c);
    let (eta, k) = (eta.0, k.0);

    // The refracted wave's a and b, the smaller of which comes from the product.
    let difference = (eta - k) * (eta + k) - sin2;
    let product = eta * k;
    let length = (difference * difference + 4.0 * product * product).map(f32::sqrt);
    let large = (0.5 * (length + difference.abs())).map(f32::sqrt);
    let small = product / large.max(Vec4::splat(f32::MIN_POSITIVE));
    let dielectric_like = difference.cmpge(Vec4::ZERO);
    let a = Vec4::select(dielectric_like, large, small);
    let b = Vec4::select(dielectric_like, small, large);

    let ratio = |re: Vec4, by: Vec4, im: Vec4| {
        let (minus, plus, im2) = (re - by, re + by, im * im);
        (minus * minus + im2) / (plus * plus + im2)
    };
    let perpendicular = ratio(a, Vec4::splat(c), b);
    let parallel = perpendicular * ratio(a * c, Vec4::splat(sin2), b * c);
    let r = 0.5 * (perpendicular + parallel);
    Spectrum(Vec4::select(r.cmple(Vec4::ONE), r, Vec4::ONE))
}

/// The direction in which light goes on beyond a boundary; `None` for total reflection.
///
/// `wo` and `m` are unit vectors with `wo`·`m` ≥ 0, `eta` > 0 is the index on the far side over that
/// on the side of `wo`. The result is unit length, on the far side.
///
/// # Source
/// PBR4 §9.3.1, eq. 9.4. Totally reflects where [`dielectric_reflectance`] of `wo`·`m` does so.
pub fn refract(wo: Vec3, m: Vec3, eta: f32) -> Option<Vec3> {
    let cos = f64::from(wo.dot(m));
    let (wo, m, eta) = (wo.as_dvec3(), m.as_dvec3(), f64::from(eta));
    let h = beyond(cos, eta)?;
    // All over eta: the part of −wo across m, and the cosine beyond.
    let wi = m * cos - wo - m * h;
    Some(wi.normalize().as_vec3())
}

#[cfg(test)]
#[expect(clippy::cast_possible_truncation, reason = "test input")]
mod tests {
    use super::*;

    fn close(got: f32, expected: f64, rel: f64) {
        assert!((f64::from(got) / expected - 1.0).abs() < rel, "{got} is not {expected}");
    }

    #[test]
    fn glass_reflects_what_the_truth_says() {
        // Truth fresnel.dielectric, n = 1.5. At 89 degrees the rounded cosine is off by 6e-8 of it.
        for (degrees, r) in [
            (0.0, 0.04),
            (30.0, 0.04152262597582152),
            (45.0, 0.05023991101223595),
            (60.0, 0.08918671280221274),
            (80.0, 0.3877043546914726),
            (89.0, 0.9041849497801884),
        ] {
            let cos = f64::to_radians(degrees).cos() as f32;
            close(dielectric_reflectance(cos, 1.5), r, 1e-6);
        }
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "stated as exact")]
    fn dielectric_edges_are_exact() {
        assert_eq!(dielectric_reflectance(0.3, 1.0), 0.0);
        assert_eq!(dielectric_reflectance(0.0, 1.5), 1.0);
        assert_eq!(dielectric_reflectance(0.5, 1.0 / 1.5), 1.0);
        assert_eq!(dielectric_reflectance(f32::NAN, 1.5), 1.0);
        let eta = 1.0f32 + f32::EPSILON;
        close(dielectric_reflectance(1.0, eta), (0.5 * f64::from(f32::EPSILON)).powi(2), 1e-6);
    }

    #[test]
    fn a_metal_reflects_what_the_truth_says() {
        // Truth fresnel.conductor, n = .18, k = 3.42; about 30 f32 roundings of up to 6e-8.
        for (degrees, r) in
            [(0.0, 0.9449911374610354), (60.0, 0.9395398409334175), (85.0, 0.9685002284019043)]
        {
            let cos = f64::to_radians(degrees).cos() as f32;
            let got = conductor_reflectance(cos, Spectrum::splat(0.18), Spectrum::splat(3.42));
            close(got.lane(2), r, 2e-6);
        }
    }

    #[test]
    fn a_metal_without_extinction_is_a_dielectric() {
        for cos in [1.0, 0.7, 0.2, 1e-3, 1e-6, 0.0] {
            let got = conductor_reflectance(cos, Spectrum::splat(1.5), Spectrum::ZERO).lane(0);
            let expected = dielectric_reflectance(cos, 1.5);
            assert!((got - expected).abs() <= 16.0 * f32::EPSILON * expected, "{got} {expected}");
        }
    }

    #[test]
    fn metals_without_an_answer_reflect_all() {
        for (eta, k) in [(0.0, 0.0), (f32::INFINITY, 1.0), (1.0, f32::INFINITY), (f32::NAN, 1.0)] {
            let got = conductor_reflectance(0.5, Spectrum::splat(eta), Spectrum::splat(k));
            assert_eq!(got, Spectrum::ONE, "{eta} {k}");
        }
    }

    #[test]
    fn refraction_obeys_snell() {
        for (degrees, expected) in
            [(10.0, 6.647777092828614), (45.0, 28.125505702055705), (80.0, 41.03641052520335)]
        {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            let wo = Vec3::new(sin as f32, 0.0, cos as f32);
            let wi = refract(wo, Vec3::Z, 1.5).unwrap();
            let angle = f64::from(-wi.x).atan2(f64::from(-wi.z)).to_degrees();
            assert!((angle / expected - 1.0).abs() < 1e-6, "{angle}");
            // Back out again, through the same boundary.
            let back = refract(wi, Vec3::NEG_Z, 1.0 / 1.5).unwrap();
            // f32 rounding of the sine, over the cosine.
            assert!((back - wo).length() < 2e-7 / wo.z);
        }
        assert!(refract(Vec3::new(0.8, 0.0, 0.6), Vec3::Z, 1.0 / 1.5).is_none());
    }
}
