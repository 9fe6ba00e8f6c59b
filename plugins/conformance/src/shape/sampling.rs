//! Sampled points of a shape against isotropic lines, which meet all of it alike.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Hit, Surface};
use luxel_sdk::num::{Moments, Ray};
use luxel_sdk::sampling::Rng;

use super::Look;
use crate::report::Judge;
use crate::statistics::{deviation, mean_error};

/// Points as they are sampled from a place.
pub(super) struct Sampling<'a> {
    pub(super) look: &'a Look<'a>,
    /// `None` for the whole surface alike.
    pub(super) from: Option<DVec3>,
    /// Area that one crossing of a line stands for, m².
    pub(super) per_area: f64,
}

/// Lines that must count, in effect, for a mean over them to be normal.
pub(super) const LEAST_LINES: f64 = 1000.0;

/// How many equal terms would give a mean of this relative error; 0 where all are 0.
pub(super) fn effective(m: &Moments) -> f64 {
    if m.mean > 0.0 { (m.mean / m.standard_error()).powi(2) } else { 0.0 }
}

/// Functions of a surface whose means tell samplings apart.
const FEATURES: usize = 1 + 3 + 6 + 3 + 8;

impl Sampling<'_> {
    fn features(&self, s: &Surface) -> [f64; FEATURES] {
        let p = (s.p - self.look.centre) / self.look.radius;
        let octant =
            usize::from(p.x > 0.0) + 2 * usize::from(p.y > 0.0) + 4 * usize::from(p.z > 0.0);
        let n = s.ng;
        let smooth = [
            1.0,
            p.x,
            p.y,
            p.z,
            p.x * p.x,
            p.y * p.y,
            p.z * p.z,
            p.x * p.y,
            p.y * p.z,
            p.z * p.x,
            n.x,
            n.y,
            n.z,
        ];
        let mut all = [0.0; FEATURES];
        all[..13].copy_from_slice(&smooth);
        all[13 + octant] = 1.0;
        all
    }

    pub(super) fn judge<'c>(
        &self,
        chords: impl Iterator<Item = &'c [(Hit, Surface)]>,
        rng: &mut Rng,
        n: u32,
        judge: &mut Judge,
    ) {
        let shape = self.look.shape;
        let at = || format!("{}: from {:?}", self.look.set.label, self.from);
        let mut by_lines = [Moments::default(); FEATURES];
        for found in chords {
            let mut sum = [0.0; FEATURES];
            for (_, s) in found {
                let pdf = shape.pdf(self.from, s);
                judge.holds("pdf is finite", pdf >= 0.0 && pdf.is_finite(), at);
                let features = self.features(s);
                for (sum, feature) in sum.iter_mut().zip(features) {
                    *sum += feature * pdf * self.per_area;
                }
            }
            for (mean, value) in by_lines.iter_mut().zip(sum) {
                mean.push(value);
            }
        }
        let mut by_samples = [Moments::default(); FEATURES];
        let mut solid_angle = Moments::default();
        for i in 0..n {
            let Some(sample) = shape.sample(self.from, rng.pair()) else {
                for mean in &mut by_samples {
                    mean.push(0.0);
                }
                solid_angle.push(0.0);
                continue;
            };
            let s = &sample.surface;
            for (mean, feature) in by_samples.iter_mut().zip(self.features(s)) {
                mean.push(feature);
            }
            solid_angle.push(self.seen(s, sample.pdf));
            if i < 500 {
                self.one(s, sample.pdf, judge, &at);
            }
        }
        let counted = effective(&by_lines[0]).min(f64::from(n));
        let smooth = |k: usize| k < FEATURES - 8;
        for (k, (lines, samples)) in by_lines.iter().zip(&by_samples).enumerate() {
            let sigma = mean_error(lines).hypot(mean_error(samples));
            let check =
                if k == 0 { "pdf integrates to P(sample)" } else { "samples follow their pdf" };
            // Of a part that few lines meet, or few samples, the mean is not normal.
            let share = if smooth(k) { 1.0 } else { lines.mean.max(samples.mean) };
            if counted < LEAST_LINES || share * counted < LEAST_LINES / 10.0 {
                continue;
            }
            let z = deviation(lines.mean - samples.mean, 1e-9, sigma);
            judge.statistic(check, z, || {
                format!("{}: mean {k}: {} by lines, {} by samples", at(), lines.mean, samples.mean)
            });
        }
        self.solid_angle(&solid_angle, rng, n, judge, &at);
    }

    /// One sample: legal, on the surface, its density that of `pdf`.
    fn one(&self, s: &Surface, pdf: f64, judge: &mut Judge, at: &dyn Fn() -> String) {
        let shape = self.look.shape;
        let at = || format!("{}: {}", at(), s.p);
        self.look.is_legal_surface(s, judge, &at);
        judge.holds("pdf is finite", pdf > 0.0 && pdf.is_finite(), at);
        let off = (shape.pdf(self.from, s) / pdf - 1.0).abs();
        judge.within("pdf of sample is that of pdf", off, 1e-9, at);
        // A ray along the normal from close by meets the point.
        let step = 1e-3 * self.look.radius;
        let ray = Ray { t_max: 2.0 * step, ..Ray::new(s.p + s.ng * step, -s.ng) };
        let met = shape.intersect(&ray).map(|hit| (hit.t - step).abs());
        // Where something else is nearer, that is met; at a rim, nothing.
        let slack = self.look.slack(s.p_err, 1.0);
        if let Some(off) = met.filter(|off| *off < 0.1 * step) {
            judge.within("samples lie on the surface", off / slack, 4.0, at);
        }
        let rim = s.ng * 0.0 + self.look.centre - s.p;
        let inwards = (rim - s.ng * rim.dot(s.ng)).normalize_or_zero() * (1e-6 * self.look.radius);
        let ray = Ray { t_max: 2.0 * step, ..Ray::new(s.p + inwards + s.ng * step, -s.ng) };
        let near = met.is_some() || shape.intersect(&ray).is_some();
        judge.holds("samples are met by rays", near, at);
    }

    /// 1 over the solid-angle density where the sample is what is seen first, else 0: its mean is
    /// the solid angle.
    fn seen(&self, s: &Surface, pdf: f64) -> f64 {
        let Some(from) = self.from else { return 0.0 };
        let to = s.p - from;
        let distance = to.length();
        let d = to / distance;
        let cos = s.ng.dot(d).abs();
        let end = distance - self.look.slack(s.p_err, cos);
        let blocked =
            self.look.shape.intersect(&Ray { t_max: end * (1.0 - 1e-9), ..Ray::new(from, d) });
        if blocked.is_some() { 0.0 } else { cos / (pdf * distance * distance) }
    }

    fn solid_angle(
        &self,
        found: &Moments,
        rng: &mut Rng,
        n: u32,
        judge: &mut Judge,
        at: &dyn Fn() -> String,
    ) {
        let Some(from) = self.from else { return };
        // Rays in the cone around the sphere, or in all directions.
        let to = self.look.centre - from;
        let sin = (self.look.radius / to.length()).min(1.0);
        let inside = sin >= 1.0;
        let versine = if inside { 2.0 } else { 1.0 - (1.0 - sin * sin).sqrt() };
        let (x, y) = to.normalize_or(DVec3::Z).any_orthonormal_pair();
        let z = x.cross(y);
        let z = if z.dot(to) < 0.0 { -z } else { z };
        let mut hits = Moments::default();
        for _ in 0..n {
            let u = DVec2::new(f64::from(rng.f32()), f64::from(rng.f32()));
            let v = u.x * versine;
            let (sin_phi, cos_phi) = (std::f64::consts::TAU * u.y).sin_cos();
            let r = (v * (2.0 - v)).sqrt();
            let d = (x * (r * cos_phi) + y * (r * sin_phi) + z * (1.0 - v)).normalize();
            hits.push(f64::from(u8::from(self.look.shape.intersect(&Ray::new(from, d)).is_some())));
        }
        let cone = std::f64::consts::TAU * versine;
        let sigma = (mean_error(&hits) * cone).hypot(mean_error(found));
        // The mean of few large samples, or of few rays that hit, is not normal.
        if effective(found).min(hits.mean * f64::from(n)) < LEAST_LINES / 2.0 {
            return;
        }
        let z = deviation(hits.mean * cone - found.mean, 1e-9, sigma);
        judge.statistic("solid angle is that of rays", z, || {
            format!("{}: {} by rays, {} by samples", at(), hits.mean * cone, found.mean)
        });
    }
}
