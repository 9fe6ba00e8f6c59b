//! The disk and the ring.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;
use luxel_sdk::sampling::disk_concentric;

use super::ellipse::SphericalEllipse;
use super::spherical::NEAR;

/// A flat disk, or with `inner_radius` a ring.
///
/// A texture lies on it as on the square around it: its middle at (0.5, 0.5).
///
/// ```scene
/// shape disk { center = (0, 2, 0) m, normal = (0, -1, 0), radius = 30 cm, material = white }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Disk {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// Where it faces; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) normal: DVec3,
    /// From the middle to the rim; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// Radius of the hole; less than `radius`.
    #[param(default = 0.0, unit = "m", min = 0)]
    pub(crate) inner_radius: f64,
    /// Right-handed frame: both tangents and the normal.
    #[param(derived)]
    x: DVec3,
    #[param(derived)]
    y: DVec3,
    #[param(derived)]
    z: DVec3,
    #[param(derived)]
    p_err: DVec3,
}

impl Shape for Disk {
    fn prepare(&mut self) {
        self.z = (self.normal / self.normal.abs().max_element()).normalize();
        (self.x, self.y) = self.z.any_orthonormal_pair();
        // The point: two products and two sums. The frame is orthogonal to about eight roundings.
        let reach = (self.x.abs() + self.y.abs()) * self.radius;
        self.p_err =
            (self.center.abs() + reach) * gamma64(5) + self.z.abs() * (self.radius * gamma64(16));
    }

    fn check(&self) -> Result<(), Fault> {
        let Self { radius, inner_radius, normal, .. } = *self;
        super::check_direction("normal", normal)?;
        super::check_length("radius", radius)?;
        if inner_radius < radius {
            return Ok(());
        }
        let message = format!("{inner_radius} m leaves nothing of a disk of radius {radius} m");
        Err(Fault::range("inner_radius", message))
    }

    fn bounds(&self) -> Bounds3 {
        let across = (DVec3::ONE - self.z * self.z).max(DVec3::ZERO);
        super::bounds_about(self.center, across.map(f64::sqrt) * self.radius)
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let to_centre = self.center - ray.o;
        let t = self.z.dot(to_centre) / self.z.dot(ray.d);
        // An infinite or NaN t makes coordinates that are NaN and fail.
        let q = ray.d * t - to_centre;
        let at = DVec2::new(self.x.dot(q), self.y.dot(q));
        let r2 = at.length_squared();
        let inside = r2 <= self.radius * self.radius && r2 >= self.inner_radius * self.inner_radius;
        (inside && t > 0.0 && t <= ray.t_max).then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        PI * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)
    }

    /// Uniform in the solid angle, to a few hundredths, from near enough; over the area from afar, in
    /// the disk's plane, and of a ring.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let seen = self.seen_from(from);
        let at = match &seen {
            Some((ellipse, to_centre)) => {
                let d = ellipse.sample(u.map(f64::from));
                let q = d * (self.z.dot(*to_centre) / self.z.dot(d)) - *to_centre;
                DVec2::new(self.x.dot(q), self.y.dot(q)).clamp_length_max(self.radius)
            }
            None => self.by_area(u),
        };
        let surface = self.surface_at(at);
        let pdf = self.density(seen.as_ref(), surface.p);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.density(self.seen_from(from).as_ref(), at.p)
    }

    fn normal_derivatives(&self, _hit: &Hit, _at: &Surface) -> Option<NormalDerivatives> {
        Some(NormalDerivatives::FLAT)
    }
}

impl Disk {
    /// What a viewer sees, and where the middle is from there.
    fn seen_from(&self, from: Option<DVec3>) -> Option<(SphericalEllipse, DVec3)> {
        let to_centre = self.center - from?;
        if self.inner_radius > 0.0 || self.area() < NEAR * to_centre.length_squared() {
            return None;
        }
        Some((SphericalEllipse::new(to_centre, self.z, self.radius)?, to_centre))
    }

    fn by_area(&self, u: [f32; 2]) -> DVec2 {
        let on_disk = disk_concentric(u).as_dvec2();
        let part = on_disk.length_squared().min(1.0);
        let (outer2, inner2) = (self.radius * self.radius, self.inner_radius * self.inner_radius);
        let r = (inner2 + (outer2 - inner2) * part).sqrt();
        on_disk.try_normalize().unwrap_or(DVec2::X) * r
    }

    /// Density over the area, m⁻², of a point that is sampled by a viewer who sees this.
    fn density(&self, seen: Option<&(SphericalEllipse, DVec3)>, p: DVec3) -> f64 {
        let Some((ellipse, to_centre)) = seen else { return self.area().recip() };
        let to = *to_centre + (p - self.center);
        let d2 = to.length_squared();
        ellipse.density(to) * self.z.dot(to).abs() / (d2.sqrt() * d2)
    }

    fn surface_at(&self, at: DVec2) -> Surface {
        Surface {
            p: self.center + (self.x * at.x + self.y * at.y),
            p_err: self.p_err,
            ng: self.z,
            ns: self.z,
            uv: at / (2.0 * self.radius) + 0.5,
            dp_du: self.x * (2.0 * self.radius),
            dp_dv: self.y * (2.0 * self.radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{
        check_convex, check_sampling, check_solid_angle, solid_angle, visible_area,
    };

    fn disk(center: DVec3, normal: DVec3, radius: f64, inner_radius: f64) -> Disk {
        let zero = DVec3::ZERO;
        let (x, y, z, p_err) = (zero, zero, zero, zero);
        let mut d = Disk { center, normal, radius, inner_radius, x, y, z, p_err };
        d.prepare();
        d
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        let normal = DVec3::new(3.0, -2.0, 6.0);
        for (center, radius) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ZERO, 1e-9),
            (DVec3::splat(2.0), 1e6),
        ] {
            let d = disk(center, normal, radius, 0.0);
            check_convex(&d, 21, |p| (normal / 7.0).dot(p - center).abs());
        }
    }

    #[test]
    fn a_ring_has_a_hole_and_samples_around_it() {
        let d = disk(DVec3::ZERO, DVec3::Z * 1e-200, 2.0, 1.0);
        let along = |x: f64| d.intersect(&Ray::new(DVec3::new(x, 0.0, 1.0), -DVec3::Z)).is_some();
        assert!(!along(0.5) && along(1.5) && !along(2.5));
        assert!((d.area() - 3.0 * PI).abs() <= 1e-15 * 10.0);
        check_sampling(&d, None, 22);
        check_solid_angle(&d, DVec3::new(0.3, 0.1, 1.0), 23);
        for u in [[0.5, 0.5], [0.0, 0.0], [0.3, 0.6]] {
            let p = d.sample(None, u).unwrap().surface.p;
            let r = p.length();
            assert!((1.0 - 1e-15..=2.0 + 1e-15).contains(&r), "{r}");
        }
    }

    #[test]
    fn a_near_disk_is_sampled_by_its_solid_angle() {
        let d = disk(DVec3::ONE, DVec3::new(1.0, 2.0, -0.5), 0.8, 0.0);
        for (k, from) in (0..).zip([
            d.center + d.z * 0.3 + d.x * 0.2,
            d.center + d.z * 0.05 - d.y * 0.9,
            d.center - d.z * 1.1 + d.x * 0.7,
            d.center + d.z * 1e-3 + d.y * 0.6,
            d.center + d.x * 2.0,
            d.center + d.z * 9.0,
        ]) {
            check_sampling(&d, Some(from), 24 + k);
            let area = visible_area(&d, Some(from), 100_000, 34 + k);
            let off = (area.mean - d.area()).abs();
            assert!(off <= 5.0 * area.standard_error() + 1e-9, "{from}: {}", area.mean);
        }
        // What a lamp near it gives is known from one sample, to what the polygon leaves.
        let from = d.center + d.z * 0.3 + d.x * 0.5;
        let near = solid_angle(&d, from, 10_000, 44);
        let spread = near.standard_error() * 100.0 / near.mean;
        assert!(spread < 0.02, "{spread}");
    }

    #[test]
    fn impossible_disks_are_refused() {
        let fault = |normal, radius, inner| {
            disk(DVec3::ZERO, normal, radius, inner).check().map_err(|f| f.field)
        };
        assert_eq!(fault(DVec3::ZERO, 1.0, 0.0), Err("normal"));
        assert_eq!(fault(DVec3::Y, 0.0, 0.0), Err("radius"));
        assert_eq!(fault(DVec3::Y, 1.0, 1.0), Err("inner_radius"));
        assert_eq!(fault(DVec3::Y, 1.0, 0.5), Ok(()));
    }
}
