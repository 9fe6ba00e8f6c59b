//! A square in the plane z = 0, from -1 to 1.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray};

use super::Wrong;

/// A square.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Square {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
    /// Whether it hands triangles over.
    #[param(default = false)]
    mesh: bool,
}

impl Square {
    /// With nothing wrong.
    pub(super) const fn sound() -> Self {
        Self { wrong: Wrong::Nothing, mesh: false }
    }

    fn surface_at(self, at: DVec2) -> Surface {
        let normal = if self.wrong == Wrong::SampleLong { DVec3::ZERO } else { DVec3::Z };
        let p = if self.wrong == Wrong::SampleNan { DVec3::NAN } else { at.extend(0.0) };
        let (ng, ns) = (normal, normal);
        let uv = if self.wrong == Wrong::OtherNan { DVec2::NAN } else { at };
        Surface { p, p_err: DVec3::ZERO, ng, ns, uv, dp_du: DVec3::X, dp_dv: DVec3::Y }
    }
}

impl Shape for Square {
    fn bounds(&self) -> Bounds3 {
        self.wrong.at(Wrong::Prepare);
        let half = DVec3::new(1.0, 1.0, 1e-9);
        if self.wrong == Wrong::SecondNan {
            return Bounds3 { min: DVec3::NAN, max: DVec3::NAN };
        }
        Bounds3 { min: -half, max: half }
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.wrong.at(Wrong::Eval);
        let t = -ray.o.z / ray.d.z;
        let at = ray.at(t).truncate();
        let t = match self.wrong {
            Wrong::Nan => f64::NAN,
            Wrong::Negative => -t,
            Wrong::Zero => 0.0,
            Wrong::Beyond => ray.t_max * 2.0,
            _ => t,
        };
        let inside = self.wrong == Wrong::Zero || at.abs().max_element() <= 1.0;
        let met = t > 0.0 && t <= ray.t_max;
        let lies = [Wrong::Nan, Wrong::Negative, Wrong::Zero, Wrong::Beyond].contains(&self.wrong);
        let at = if self.wrong == Wrong::Infinite { DVec2::INFINITY } else { at };
        (inside && (met || lies)).then_some(Hit { t, at, face: 0 })
    }
    fn surface(&self, _: &Ray, hit: &Hit) -> Surface {
        self.wrong.at(Wrong::Sample);
        self.surface_at(hit.at)
    }
    fn area(&self) -> f64 {
        self.wrong.at(Wrong::Second);
        match self.wrong {
            Wrong::Greedy => f64::NAN,
            Wrong::Foreign => -1.0,
            _ => 4.0,
        }
    }
    fn sample(&self, _: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let at = DVec2::new(f64::from(u[0]), f64::from(u[1])) * 2.0 - 1.0;
        let pdf = if self.wrong == Wrong::SampleZero { 0.0 } else { 0.25 };
        Some(ShapeSample { surface: self.surface_at(at), pdf })
    }
    fn pdf(&self, _: Option<DVec3>, _: &Surface) -> f64 {
        self.wrong.at(Wrong::Other);
        if self.wrong == Wrong::Dangling { f64::NEG_INFINITY } else { 0.25 }
    }
    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        if !self.mesh {
            return None;
        }
        let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let mut mesh = TriangleMesh {
            points: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)],
            indices: vec![[0, 1, 2]],
            ..TriangleMesh::default()
        };
        match self.wrong {
            Wrong::Dangling => mesh.indices[0][1] = 3,
            Wrong::Greedy => mesh.indices[0][1] = u32::MAX,
            Wrong::Nan => mesh.points[0] = Vec3::NAN,
            Wrong::Infinite => mesh.centre = DVec3::INFINITY,
            Wrong::Sample => mesh.normals = vec![Vec3::Z; 2],
            Wrong::SampleNan => mesh.normals = vec![Vec3::NAN; 3],
            Wrong::Other => mesh.uvs = vec![Vec2::ZERO; 1],
            Wrong::OtherNan => mesh.uvs = vec![Vec2::NAN; 3],
            _ => {}
        }
        self.wrong.at(Wrong::Eval);
        Some(Arc::new(mesh))
    }
}
