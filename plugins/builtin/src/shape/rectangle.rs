//! The parallelogram.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Parallelogram, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;

use super::spherical::{NEAR, SphericalRectangle};

/// What a viewer sees of a rectangle, and where its centre is from the viewer's foot.
struct Seen {
    rectangle: SphericalRectangle,
    foot: DVec2,
    from: DVec3,
}

/// A flat rectangle, or parallelogram, given by its middle and two whole edges.
///
/// Its normal is `u` × `v`: with `u` to the right and `v` up it faces the viewer. Texture
/// coordinates run from 0 to 1 along the edges.
///
/// ```scene
/// shape rectangle "floor" { center = (0, 0, 0) m, u = (0, 0, 2) m, v = (2, 0, 0) m, material = white }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Rectangle {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// One edge, from end to end.
    #[param(required, unit = "m")]
    pub(crate) u: DVec3,
    /// The other edge, from end to end.
    #[param(required, unit = "m")]
    pub(crate) v: DVec3,
    #[param(derived)]
    normal: DVec3,
    /// Vectors whose products with a point about the centre are its coordinates in edges.
    #[param(derived)]
    dual_u: DVec3,
    #[param(derived)]
    dual_v: DVec3,
    #[param(derived)]
    p_err: DVec3,
    #[param(derived)]
    area: f64,
    /// Unit edges where they meet at a right angle, else zero.
    #[param(derived)]
    sides: [DVec3; 2],
}

impl Shape for Rectangle {
    fn prepare(&mut self) {
        let (u, v) = (self.u, self.v);
        // Scaled to unit length first, so that squares of tiny and huge edges keep their digits.
        let (u_length, v_length) = (u.length(), v.length());
        let across = (u / u_length).cross(v / v_length);
        let sin = across.length();
        self.area = sin * u_length * v_length;
        let (x, y) = (u / u_length, v / v_length);
        let right = x.dot(y).abs() <= gamma64(8);
        self.sides = if right { [x, y] } else { [DVec3::ZERO; 2] };
        self.normal = across / sin;
        self.dual_u = (v / v_length).cross(self.normal) / (sin * u_length);
        self.dual_v = self.normal.cross(u / u_length) / (sin * v_length);
        // The point: two products and two sums. The normal: about eight roundings, grown by
        // 1 / sin where the edges are nearly parallel, tilt the plane about the centre.
        let tilt = gamma64(8) / sin * 0.5 * (u_length + v_length);
        self.p_err =
            (self.center.abs() + 0.5 * (u.abs() + v.abs())) * gamma64(5) + self.normal.abs() * tilt;
    }

    fn check(&self) -> Result<(), Fault> {
        // Sine of the angle between the edges: its own rounding error is three roundings.
        let (u, v) = (self.u / self.u.length(), self.v / self.v.length());
        if u.cross(v).length() > gamma64(4) {
            return Ok(());
        }
        let message = format!("edges u = {} and v = {} span no area", self.u, self.v);
        Err(Fault::range("v", message))
    }

    fn bounds(&self) -> Bounds3 {
        super::bounds_about(self.center, 0.5 * (self.u.abs() + self.v.abs()))
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let to_centre = self.center - ray.o;
        let t = self.normal.dot(to_centre) / self.normal.dot(ray.d);
        // A NaN t fails here; an infinite one makes coordinates that are NaN and fail below.
        if !(t > 0.0 && t <= ray.t_max) {
            return None;
        }
        let q = ray.d * t - to_centre;
        let at = DVec2::new(self.dual_u.dot(q), self.dual_v.dot(q));
        let inside = at.x.abs() <= 0.5 && at.y.abs() <= 0.5;
        inside.then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        self.area
    }

    /// Uniform in the solid angle that a rectangle fills; over the area of a parallelogram, and
    /// where the solid angle is very small or half of everything.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let u = u.map(f64::from);
        let seen = self.seen_from(from);
        let at = match &seen {
            Some(seen) => {
                let q = seen.rectangle.sample(u) - seen.foot;
                let at = q / DVec2::new(self.u.length(), self.v.length());
                at.clamp(DVec2::splat(-0.5), DVec2::splat(0.5))
            }
            None => DVec2::from_array(u) - 0.5,
        };
        let surface = self.surface_at(at);
        let pdf = self.density(seen.as_ref(), surface.p);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.density(self.seen_from(from).as_ref(), at.p)
    }

    fn parallelogram(&self) -> Option<Parallelogram> {
        Some(Parallelogram { centre: self.center, u: self.u, v: self.v })
    }

    fn normal_derivatives(&self, _hit: &Hit, _at: &Surface) -> Option<NormalDerivatives> {
        Some(NormalDerivatives::FLAT)
    }
}

impl Rectangle {
    /// What a viewer sees from near enough, if it can be told well.
    fn seen_from(&self, from: Option<DVec3>) -> Option<Seen> {
        let ([x, y], from) = (self.sides, from?);
        let to_centre = self.center - from;
        if self.area < NEAR * to_centre.length_squared() {
            return None;
        }
        let half = 0.5 * DVec2::new(self.u.dot(x), self.v.dot(y));
        let foot = DVec2::new(to_centre.dot(x), to_centre.dot(y));
        let distance = to_centre.dot(self.normal).abs();
        let rectangle = SphericalRectangle::new(foot - half, foot + half, distance)?;
        Some(Seen { rectangle, foot, from })
    }

    /// Density over the area, m⁻², of a point that is sampled by a viewer who sees this.
    fn density(&self, seen: Option<&Seen>, p: DVec3) -> f64 {
        let Some(seen) = seen else { return self.area.recip() };
        let to = seen.from - p;
        let d2 = to.length_squared();
        self.normal.dot(to).abs() / (d2.sqrt() * d2 * seen.rectangle.solid_angle)
    }

    fn surface_at(&self, at: DVec2) -> Surface {
        Surface {
            p: self.center + (self.u * at.x + self.v * at.y),
            p_err: self.p_err,
            ng: self.normal,
            ns: self.normal,
            uv: at + 0.5,
            dp_du: self.u,
            dp_dv: self.v,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{
        check_convex, check_sampling, check_solid_angle, solid_angle, visible_area,
    };

    fn rectangle(center: DVec3, u: DVec3, v: DVec3) -> Rectangle {
        let zero = DVec3::ZERO;
        let (normal, dual_u, dual_v, p_err, area) = (zero, zero, zero, zero, 0.0);
        let sides = [zero; 2];
        let mut r = Rectangle { center, u, v, normal, dual_u, dual_v, p_err, area, sides };
        r.prepare();
        r
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        let (u, v) = (DVec3::new(1.0, 0.3, -0.2), DVec3::new(0.5, 2.0, 1.0));
        for (center, scale) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ZERO, 1e-9),
            (DVec3::splat(-3.0), 1e6),
        ] {
            let r = rectangle(center, u * scale, v * scale);
            let n = u.cross(v).normalize();
            check_convex(&r, 11, |p| n.dot(p - center).abs());
        }
    }

    #[test]
    fn the_normal_is_u_cross_v_and_the_coordinates_run_along_the_edges() {
        let r = rectangle(DVec3::new(0.0, 1.0, 0.0), DVec3::X * 2.0, DVec3::Z * 4.0);
        let ray = Ray::new(DVec3::new(0.5, 3.0, -1.0), -DVec3::Y * 2.0);
        let hit = r.intersect(&ray).unwrap();
        let at = r.surface(&ray, &hit);
        assert!((hit.t - 1.0).abs() <= f64::EPSILON);
        assert_eq!((at.ng, at.p), (-DVec3::Y, DVec3::new(0.5, 1.0, -1.0)));
        assert!((at.uv - DVec2::new(0.75, 0.25)).length() <= 4.0 * f64::EPSILON);
        let edge = Ray::new(DVec3::new(1.0, 2.0, 2.0), -DVec3::Y);
        assert!(r.intersect(&edge).is_some(), "the corner belongs to it");
        assert!(r.intersect(&Ray::new(DVec3::new(0.0, 1.0, 0.0), DVec3::X)).is_none());
    }

    #[test]
    fn samples_cover_the_area_and_the_solid_angle() {
        let (u, v) = (DVec3::X * 2.0, DVec3::new(1.0, 1.5, 0.0));
        let r = rectangle(DVec3::new(0.0, 0.0, -1.0), u, v);
        check_sampling(&r, None, 12);
        assert!((r.area() - 3.0).abs() <= 8.0 * f64::EPSILON);
        assert!((visible_area(&r, None, 3, 13).mean - 3.0).abs() <= 8.0 * f64::EPSILON);
        check_solid_angle(&r, DVec3::new(0.2, -0.1, 0.0), 14);
    }

    #[test]
    fn a_right_angled_one_is_sampled_by_its_solid_angle() {
        let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
        let (u, v, n) = (turn * DVec3::X * 2.0, turn * DVec3::Y * 0.5, turn * DVec3::Z);
        let centre = DVec3::new(5.0, -3.0, 1.0);
        let r = rectangle(centre, u, v);
        let near = centre + u * 0.3 + v * 2.0 + n * 0.4;
        for from in [near, centre + n * 0.1, centre - n * 3.0, centre + u * 9.0 + n * 1e-3] {
            check_sampling(&r, Some(from), 15);
        }
        check_solid_angle(&r, near, 16);
        // Each sample has the same density per solid angle, so that one tells the whole.
        let found = solid_angle(&r, centre + n, 10, 17);
        let truth = 4.0 * (0.25 / (1.0 + 1.0 + 0.0625f64).sqrt()).atan();
        assert!((found.mean / truth - 1.0).abs() <= 1e-13, "{} {truth}", found.mean);
        assert!(found.standard_error() <= 1e-13);
        // From far away by its area, which then is as good.
        let far = centre + n * 1e7;
        assert!((r.sample(Some(far), [0.3, 0.6]).unwrap().pdf - 1.0).abs() <= 1e-15);
    }

    #[test]
    fn edges_that_span_no_area_are_refused() {
        let flat = rectangle(DVec3::ZERO, DVec3::ONE, DVec3::ONE * 3.0);
        assert_eq!(flat.check().unwrap_err().field, "v");
        assert!(rectangle(DVec3::ZERO, DVec3::ZERO, DVec3::X).check().is_err());
        assert!(rectangle(DVec3::ZERO, DVec3::X * 1e-12, DVec3::Y * 1e12).check().is_ok());
    }
}
