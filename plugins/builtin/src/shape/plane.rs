//! The endless plane.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;

use super::axial::{length_of, local, place};

/// A plane without end: a floor or a wall that reaches the horizon.
///
/// Texture coordinates are metres from `point`: on floors and ceilings `u` along +X, on walls `u`
/// to the right and `v` up for who looks at them. It cannot shine: there is no end to its area.
///
/// ```scene
/// shape plane "floor" { point = (0, -1, 0) m, normal = (0, 1, 0), material = white }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Plane {
    /// Any point of it.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) point: DVec3,
    /// Where it faces; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) normal: DVec3,
    /// Right-handed: both tangents and the normal.
    #[param(derived)]
    frame: [DVec3; 3],
}

/// Up to this share of its normal a plane is a wall, beyond it a floor or a ceiling.
const WALL: f64 = 0.9;

impl Shape for Plane {
    fn prepare(&mut self) {
        let z = (self.normal / self.normal.abs().max_element()).normalize();
        let wall = z.y.abs() <= WALL;
        let u = if wall { DVec3::Y.cross(z) } else { DVec3::X - z * z.x };
        let x = u.normalize();
        self.frame = [x, z.cross(x).normalize(), z];
    }

    fn check(&self) -> Result<(), Fault> {
        super::check_direction("normal", self.normal)?;
        if self.point.is_finite() {
            return Ok(());
        }
        Err(Fault::range("point", format!("{} is not a place", self.point)))
    }

    /// Everything, but for a plane across an axis, which is flat along that.
    fn bounds(&self) -> Bounds3 {
        let z = self.frame[2];
        let room = self.point.abs() * gamma64(8);
        let (mut min, mut max) = (DVec3::NEG_INFINITY, DVec3::INFINITY);
        for axis in 0..3 {
            if z[axis].abs() >= 1.0 {
                (min[axis], max[axis]) =
                    (self.point[axis] - room[axis], self.point[axis] + room[axis]);
            }
        }
        Bounds3 { min, max }
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        length_of(ray)?;
        let z = self.frame[2];
        let to_point = self.point - ray.o;
        let t = z.dot(to_point) / z.dot(ray.d);
        if !(t > 0.0 && t <= ray.t_max && t < f64::INFINITY) {
            return None;
        }
        let at = local(&self.frame, ray.d * t - to_point).truncate();
        // So far out that coordinates overflow is the horizon itself.
        at.is_finite().then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        f64::INFINITY
    }

    fn normal_derivatives(&self, _hit: &Hit, _at: &Surface) -> Option<NormalDerivatives> {
        Some(NormalDerivatives::FLAT)
    }
}

impl Plane {
    /// The point at metres along both tangents.
    ///
    /// Error: the point takes two products and two sums, and the tangents are orthogonal to the
    /// normal to about eight roundings.
    fn surface_at(&self, at: DVec2) -> Surface {
        let [x, y, z] = self.frame;
        let local = place(&self.frame, at.extend(0.0));
        let reach = x.abs() * at.x.abs() + y.abs() * at.y.abs();
        let tilt = z.abs() * ((at.x.abs() + at.y.abs()) * gamma64(16));
        Surface {
            p: self.point + local,
            p_err: (self.point.abs() + reach) * gamma64(5) + tilt,
            ng: z,
            ns: z,
            uv: at,
            dp_du: x,
            dp_dv: y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::direction;
    use luxel_sdk::num::offset_origin;
    use luxel_sdk::sampling::Rng;

    fn plane(point: DVec3, normal: DVec3) -> Plane {
        let mut p = Plane { point, normal, frame: [DVec3::ZERO; 3] };
        p.prepare();
        p
    }

    #[test]
    fn hits_and_offsets_hold_at_every_distance() {
        let mut rng = Rng::new(81);
        let normal = DVec3::new(3.0, -2.0, 6.0) / 7.0;
        for (point, size) in [(DVec3::ZERO, 1.0), (DVec3::splat(1e6), 1e-3), (DVec3::ONE, 1e6)] {
            let p = plane(point, normal * 1e-200);
            for i in 0..2000 {
                let far = [1.0, 10.0, 100.0, 1e3, 1e4][i % 5];
                let o = point + direction(&mut rng) * (size * far);
                let d = direction(&mut rng) * [1e-6, 1.0, 1e6][i % 3];
                let ray = Ray::new(o, d);
                let (height, fall) = (normal.dot(o - point), normal.dot(d));
                let Some(hit) = p.intersect(&ray) else {
                    assert!(height * fall >= -1e-9 * o.length() * d.length(), "{ray:?} misses");
                    continue;
                };
                let at = p.surface(&ray, &hit);
                // Turned into coordinates and back: ten roundings of what is left of the ray.
                let far = (at.p - point).length() + (o - point).length() + point.length();
                assert!((ray.at(hit.t) - at.p).length() <= 32.0 * f64::EPSILON * far);
                assert!(normal.dot(at.p - point).abs() <= at.p_err.dot(normal.abs()) * 1.5);
                assert!(p.intersect(&Ray { t_max: hit.t, ..ray }).is_some());
                assert!(p.intersect(&Ray { t_max: hit.t.next_down(), ..ray }).is_none());
                let leave = direction(&mut rng);
                let o = offset_origin(at.p, at.p_err, at.ng, leave);
                assert!(p.intersect(&Ray::new(o, leave)).is_none(), "{leave} from {o}");
            }
        }
    }

    #[test]
    fn parallel_rays_and_broken_ones_hit_nothing() {
        let p = plane(DVec3::ZERO, DVec3::Y);
        for zero in [0.0, -0.0] {
            assert!(p.intersect(&Ray::new(DVec3::Y, DVec3::new(1.0, zero, 0.0))).is_none());
            assert!(p.intersect(&Ray::new(DVec3::ZERO, DVec3::new(1.0, zero, 0.0))).is_none());
            let down = Ray::new(DVec3::new(3.0, 2.0, zero), DVec3::new(zero, -1.0, zero));
            assert!((p.intersect(&down).unwrap().t - 2.0).abs() <= 0.0);
        }
        for (o, d) in [(DVec3::NAN, DVec3::Y), (DVec3::Y, DVec3::NAN), (DVec3::Y, DVec3::ZERO)] {
            assert!(p.intersect(&Ray::new(o, d)).is_none());
        }
        let cut = Ray { t_max: f64::NAN, ..Ray::new(DVec3::Y, -DVec3::Y) };
        assert!(p.intersect(&cut).is_none());
        // Towards the horizon, until numbers end.
        let far = p.intersect(&Ray::new(DVec3::Y, DVec3::new(1.0, -1e-300, 0.0)));
        assert!(far.is_none_or(|hit| p.surface(&Ray::new(DVec3::Y, DVec3::X), &hit).p.is_finite()));
    }

    #[test]
    fn textures_lie_upright_on_walls_and_along_x_on_floors() {
        for (normal, u, v) in [
            (DVec3::Y, DVec3::X, -DVec3::Z),
            (-DVec3::Y, DVec3::X, DVec3::Z),
            (DVec3::Z, DVec3::X, DVec3::Y),
            (-DVec3::Z, -DVec3::X, DVec3::Y),
            (DVec3::X, -DVec3::Z, DVec3::Y),
        ] {
            let at = plane(DVec3::ONE, normal).surface_at(DVec2::new(2.0, 3.0));
            assert_eq!((at.dp_du, at.dp_dv, at.ng), (u, v, normal));
            assert_eq!(at.p, DVec3::ONE + u * 2.0 + v * 3.0);
        }
    }

    #[test]
    fn its_box_is_flat_across_an_axis_and_endless_otherwise() {
        let floor = plane(DVec3::new(1.0, 2.0, 3.0), DVec3::Y * 5.0).bounds();
        assert!(floor.min.x.is_infinite() && floor.max.z.is_infinite());
        assert!(floor.min.y < 2.0 && floor.max.y > 2.0 && floor.max.y - floor.min.y < 1e-14);
        assert_eq!(plane(DVec3::ZERO, DVec3::ONE).bounds(), Bounds3::ALL);
    }

    #[test]
    fn it_has_no_end_and_no_samples() {
        let p = plane(DVec3::ZERO, DVec3::Y);
        assert!(p.area().is_infinite() && p.sample(None, [0.5; 2]).is_none() && !p.is_closed());
        assert_eq!(plane(DVec3::ZERO, DVec3::ZERO).check().unwrap_err().field, "normal");
        assert_eq!(plane(DVec3::NAN, DVec3::Y).check().unwrap_err().field, "point");
    }
}
