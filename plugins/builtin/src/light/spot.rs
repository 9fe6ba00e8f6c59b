//! A lamp that throws a cone of light.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Fault, Look, Quantity};
use luxel_sdk::sampling::one_minus_cos;

use super::point::from_point;

/// A point that shines into a cone, with a soft edge: a stage light, a torch.
///
/// ```scene
/// light spot "beam" {
///   look = look_at(from = (3, 4, 1) m, to = (0, 1, 0) m, up = (0, 1, 0))
///   cone = 12 deg, falloff = 2 deg, spectrum = blackbody(5600 K), power = 4000 lm
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Spot {
    /// Where it stands and what it points at.
    #[param(required)]
    look: Look,
    /// Angle between the axis and the edge of the light: half the angle of the cone.
    #[param(default = 0.5, unit = "rad", min = 0, max = PI)]
    cone: f64,
    /// Width of the soft edge, inside the cone: full light where it begins, none at `cone`.
    #[param(default = 0.0, unit = "rad", min = 0, max = PI)]
    falloff: f64,
    /// How light gathers about the axis: intensity falls with this power of the cosine, and ends at 90
    /// degrees. 0 is even light, 1 that of a flat matt lamp.
    #[param(default = 0.0, min = 0, max = 1000)]
    exponent: f64,
    /// Colour of the light; its amount is given apart. Intensity is that on the axis.
    #[param(emission(intensity, power, scale))]
    emission: Emission,
    /// Unit, where it points.
    #[param(derived)]
    axis: DVec3,
    /// What intensity is integrated over, sr.
    #[param(derived)]
    solid_angle: f64,
}

/// Smoothstep, 3t² − 2t³ for t clamped to [0, 1].
fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// ∫ cosⁿθ·sin θ from 0 to `theta`, less than π; cosines below 0 count as none unless n is 0.
fn within(theta: f64, n: f64) -> f64 {
    let versine = one_minus_cos(theta);
    if n <= 0.0 {
        return versine;
    }
    // (1 − cosⁿ⁺¹)/(n + 1), without cancelling near the axis.
    let m = n + 1.0;
    -(m * (-versine.min(1.0)).ln_1p()).exp_m1() / m
}

/// Pieces of the soft edge, each less than 0.1 rad wide: cos¹⁰⁰⁰ is .03 rad wide, and the error is below
/// 1e-7 of the whole.
const PIECES: u8 = 32;

/// ∫ smoothstep((`outer` − θ)/`width`)·cosⁿθ·sin θ over θ.
///
/// # Source
/// By parts: ∫ s'·`within` dθ with s' = 6t(1 − t), by Gauss–Legendre with five points on each of some
/// pieces, on either side of 90 degrees, where `within` bends. Where `width` is 0 all of them are at the edge.
fn edge((outer, width): (f64, f64), n: f64) -> f64 {
    let bends = n > 0.0 && width > 0.0;
    let bend = if bends { ((outer - FRAC_PI_2) / width).clamp(0.0, 1.0) } else { 0.0 };
    part((outer, width), n, [0.0, bend]) + part((outer, width), n, [bend, 1.0])
}

/// The part of `edge` between two places within the soft edge, 0 at its outer end and 1 at its inner one.
fn part((outer, width): (f64, f64), n: f64, [from, to]: [f64; 2]) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let piece = (to - from) / f64::from(PIECES);
    let term = |i: u8, (x, weight): (f64, f64)| {
        let t = from + (f64::from(i) + 0.5 * (1.0 + x)) * piece;
        let slope = 6.0 * t * (1.0 - t);
        0.5 * weight * piece * slope * within(outer - width * t, n)
    };
    (0..PIECES).map(|i| NODES.map(|node| term(i, node)).iter().sum::<f64>()).sum()
}

impl Spot {
    fn shape(&self, d: DVec3) -> f64 {
        // The angle by its tangent: exact near the axis, where arc cosines are not.
        let along = d.dot(self.axis);
        let theta = d.cross(self.axis).length().atan2(along);
        let edge = if self.falloff > 0.0 {
            smoothstep((self.cone - theta) / self.falloff)
        } else {
            f64::from(u8::from(theta <= self.cone))
        };
        if self.exponent > 0.0 { edge * along.max(0.0).powf(self.exponent) } else { edge }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; intensity is f32")]
    fn on_axis(&self) -> Spectrum {
        match self.emission.quantity {
            Quantity::Power if self.solid_angle <= 0.0 => Spectrum::ZERO,
            Quantity::Power => self.emission.spectrum / self.solid_angle as f32,
            _ => self.emission.spectrum,
        }
    }
}

impl Light for Spot {
    fn prepare(&mut self) {
        self.axis = (self.look.to - self.look.from).normalize();
        self.solid_angle = TAU * edge((self.cone, self.falloff), self.exponent);
    }

    fn check(&self) -> Result<(), Fault> {
        if self.cone <= 0.0 {
            return Err(Fault::range("cone", "a cone without width lights nothing"));
        }
        if self.falloff > self.cone {
            let limit = (self.cone.to_degrees() * 1e6).round() / 1e6;
            let message = format!("the soft edge lies inside the cone: at most {limit} deg");
            return Err(Fault::range("falloff", message));
        }
        Ok(())
    }

    fn form(&self) -> LightForm {
        LightForm::Point
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; a factor in [0, 1]")]
    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        let intensity = |d| self.on_axis() * self.shape(d) as f32;
        from_point(self.look.from, query.p, intensity)
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
    fn power(&self, _area: f64, _scene_radius: f64) -> f32 {
        self.on_axis().mean() * self.solid_angle as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(cone: f64, falloff: f64, exponent: f64) -> Spot {
        let look = Look { from: DVec3::Y, to: DVec3::ZERO, up: DVec3::X };
        let emission = Emission { spectrum: Spectrum::splat(10.0), quantity: Quantity::Power };
        let axis = DVec3::ZERO;
        let mut spot = Spot { look, cone, falloff, exponent, emission, axis, solid_angle: 0.0 };
        spot.prepare();
        spot
    }

    #[test]
    fn a_soft_edge_wider_than_the_cone_is_told_as_it_is_written() {
        let fault = spot(12f64.to_radians(), 13f64.to_radians(), 0.0).check().unwrap_err();
        assert!(format!("{fault:?}").contains("at most 12 deg"), "{fault:?}");
    }

    #[test]
    fn power_is_intensity_over_all_directions() {
        let even = [(1e-3, 5e-4), (0.2, 0.0), (0.5, 0.5), (2.5, 0.7), (PI, PI)];
        let even = even.map(|(cone, falloff)| (cone, falloff, 0.0));
        let gathered = [(1e-3, 5e-4, 9.0), (0.5 * PI, 0.0, 4.0), (PI, PI, 1.5), (0.2, 0.2, 1000.0)];
        for (cone, falloff, exponent) in even.into_iter().chain(gathered) {
            let spot = spot(cone, falloff, exponent);
            // Midpoint rule: relative error of the order of (1/n)² and of a jump 1/n.
            let n = 4000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let theta = cone * (f64::from(i) + 0.5) / f64::from(n);
                    let d = DVec3::new(theta.sin(), -theta.cos(), 0.0);
                    spot.shape(d) * TAU * theta.sin() * cone / f64::from(n)
                })
                .sum();
            assert!(
                (spot.solid_angle / sum - 1.0).abs() < 2e-6,
                "{cone} {falloff} {exponent} {sum}"
            );
            assert!((spot.power(0.0, 1.0) / 10.0 - 1.0).abs() <= 4.0 * f32::EPSILON);
        }
    }

    #[test]
    fn power_is_right_where_cosines_end_within_the_soft_edge() {
        for (cone, falloff, exponent) in [(PI, 3.0, 0.1), (3.0, 2.9, 1e-4), (1.7, 0.3, 0.01)] {
            let spot = spot(cone, falloff, exponent);
            // Midpoint rule in s, θ = (1 − s⁴)·π/2, which is smooth where cosines end.
            let n = 4000;
            let term = |i: i32| {
                let s = (f64::from(i) + 0.5) / f64::from(n);
                let theta = FRAC_PI_2 * (1.0 - s.powi(4));
                let d = DVec3::new(theta.sin(), -theta.cos(), 0.0);
                spot.shape(d) * TAU * theta.sin() * TAU * s.powi(3) / f64::from(n)
            };
            let sum: f64 = (0..n).map(term).sum();
            assert!((spot.solid_angle / sum - 1.0).abs() < 1e-6, "{cone} {falloff} {exponent}");
        }
    }

    #[test]
    fn light_is_full_inside_and_none_outside() {
        let spot = spot(0.3, 0.1, 0.0);
        let at = |angle: f64| {
            let p = DVec3::new(angle.sin(), 1.0 - angle.cos(), 0.0);
            spot.sample(&LightQuery { p, u: [0.5; 2] }).map(|s| s.le.lane(0))
        };
        let full = spot.on_axis().lane(0);
        assert!((at(0.19).unwrap() / full - 1.0).abs() < 1e-6);
        assert!((at(0.25).unwrap() / full - 0.5).abs() < 1e-6);
        assert!(at(0.31).is_none() && at(0.5 * PI).is_none());
    }

    #[test]
    fn edges_wider_than_the_cone_are_refused() {
        assert_eq!(spot(0.1, 0.2, 0.0).check().unwrap_err().field, "falloff");
        assert_eq!(spot(0.0, 0.0, 0.0).check().unwrap_err().field, "cone");
        assert!(spot(0.2, 0.2, 0.0).check().is_ok());
    }
}
