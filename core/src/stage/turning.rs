//! How surfaces bend.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Hit, NormalDerivatives, Surface};
use luxel_sdk::num::Ray;

use super::geometry::{Geometry, Mesh, by_coordinates};
use super::{Moment, SceneHit};

impl Mesh {
    /// How the shading normal turns along the surface coordinates at a point of a triangle, with `at`
    /// and `time` as in `surface`: the derivatives of the mean of the corners' normals at unit length.
    pub fn normal_derivatives(&self, triangle: u32, at: DVec2, time: f64) -> NormalDerivatives {
        let mesh = self.triangles();
        if mesh.normals.is_empty() {
            return NormalDerivatives::FLAT;
        }
        let corners = self.indices(triangle);
        let [a, b, c] = self.normals(corners, time);
        let mean = a * (1.0 - at.x - at.y) + b * at.x + c * at.y;
        let length = mean.length();
        let n = mean / length;
        let turned = |d: DVec3| (d - n * n.dot(d)) / length;
        let points = self.corners(corners, time);
        let (dn_du, dn_dv) = by_coordinates(mesh, corners, points, [turned(b - a), turned(c - a)]);
        // As `surface` has it: on the side of the face.
        let [p, q, r] = points;
        let side = if n.dot((q - p).cross(r - p)) < 0.0 { -1.0 } else { 1.0 };
        let told = NormalDerivatives { dn_du: dn_du * side, dn_dv: dn_dv * side };
        let finite = dn_du.is_finite() && dn_dv.is_finite();
        if finite { told } else { NormalDerivatives::FLAT }
    }
}

impl Geometry {
    /// How the shading normal turns at the point `at` that a hit names, in the geometry's frame; `None`
    /// where the shape does not say.
    pub fn normal_derivatives(
        &self,
        hit: &Hit,
        at: &Surface,
        time: f64,
    ) -> Option<NormalDerivatives> {
        match self {
            Self::Mesh(mesh) => Some(mesh.normal_derivatives(hit.face, hit.at, time)),
            Self::Analytic(shape) => shape.object().fixed().shape().normal_derivatives(hit, at),
        }
    }
}

impl Moment<'_> {
    /// How the shading normal turns at a hit, in the world, along the derivatives of its surface;
    /// `None` where the shape does not say.
    pub fn normal_derivatives(self, ray: &Ray, hit: &SceneHit) -> Option<NormalDerivatives> {
        let placement = &self.placements[hit.placement as usize];
        let geometry = &self.geometries[placement.geometry as usize];
        let mut room = None;
        let transform = placement.place.at(self.time, &mut room);
        let local = transform.map_or(*ray, |transform| transform.inverse_ray(ray));
        let at = geometry.surface(&local, &hit.hit, self.film.precision, self.time);
        let told = geometry.normal_derivatives(&hit.hit, &at, self.time)?;
        Some(transform.map_or(told, |transform| told.carried(at.ns, transform)))
    }

    /// Mean curvature of the smooth surface at a hit, m⁻¹: above 0 where it bulges to the side of its
    /// normal, below where it is hollow. `surface` is the point of the hit in the world. 0 where the
    /// shape does not say.
    ///
    /// # Source
    /// Half the trace of the shape operator, by the fundamental forms: do Carmo, *Differential
    /// Geometry of Curves and Surfaces*, §3.3.
    #[inline(never)]
    pub fn mean_curvature(self, ray: &Ray, hit: &SceneHit, surface: &Surface) -> f64 {
        let Some(turns) = self.normal_derivatives(ray, hit) else { return 0.0 };
        let NormalDerivatives { dn_du, dn_dv } = turns;
        let (du, dv) = (surface.dp_du, surface.dp_dv);
        let (e, f, g) = (du.length_squared(), du.dot(dv), dv.length_squared());
        let twice = dn_du.dot(du) * g - (dn_du.dot(dv) + dn_dv.dot(du)) * f + dn_dv.dot(dv) * e;
        let mean = 0.5 * twice / (e * g - f * f);
        if mean.is_finite() { mean } else { 0.0 }
    }
}
