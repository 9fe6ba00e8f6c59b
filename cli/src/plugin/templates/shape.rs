//! A shape, to be made your own.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::Fault;

/// A square that lies flat and faces up (+Y), its middle at the origin; `transform` places it.
///
/// ```scene
/// shape template_name { side = 2 m, transform = move((0, 1, 0) m) }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Length of a side; greater than 0.
    #[param(default = 1.0, unit = "m", min = f64::MIN_POSITIVE)]
    side: f64,
}

impl TemplateName {
    /// The point at coordinates x and z, which lies on the surface exactly: y is 0.
    fn surface_at(&self, at: DVec2) -> Surface {
        Surface {
            p: DVec3::new(at.x, 0.0, at.y),
            p_err: DVec3::ZERO,
            ng: DVec3::Y,
            ns: DVec3::Y,
            uv: DVec2::new(at.x, -at.y) / self.side + 0.5,
            dp_du: DVec3::X * self.side,
            dp_dv: -DVec3::Z * self.side,
        }
    }
}

impl Shape for TemplateName {
    fn check(&self) -> Result<(), Fault> {
        if self.side > 0.0 && (self.side * self.side).is_finite() {
            return Ok(());
        }
        Err(Fault::range("side", format!("a side of {} m has no area", self.side)))
    }

    fn bounds(&self) -> Bounds3 {
        let half = DVec3::new(0.5 * self.side, 0.0, 0.5 * self.side);
        Bounds3::of_points([-half, half])
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let t = -ray.o.y / ray.d.y;
        // An infinite or NaN t makes coordinates that are in no square.
        let p = ray.o + ray.d * t;
        let inside = p.x.abs() <= 0.5 * self.side && p.z.abs() <= 0.5 * self.side;
        let hit = Hit { t, at: DVec2::new(p.x, p.z), face: 0 };
        (inside && t > 0.0 && t <= ray.t_max).then_some(hit)
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        self.side * self.side
    }

    fn sample(&self, _from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let at = (DVec2::from(u.map(f64::from)) - 0.5) * self.side;
        Some(ShapeSample { surface: self.surface_at(at), pdf: self.area().recip() })
    }

    fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
        self.area().recip()
    }
}

luxel_sdk::plugin! { shape "template_name" => TemplateName; }
