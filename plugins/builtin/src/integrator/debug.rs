//! What is where: pictures for finding mistakes.

use glam::{DVec3, Vec3};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, ArrivalKind, Ask, Host, Job, PathIntegrator, Samples, Wants};
use luxel_sdk::sampling::hash32;
use luxel_sdk::{Choice, Params};

/// What is shown.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Show {
    /// Geometric normals: x, y, z as red, green, blue, 0 as half.
    Normals,
    /// Shading normals, alike.
    ShadingNormals,
    /// Surface coordinates, their fractions, as red and green.
    Uv,
    /// Distance from the camera in metres.
    Depth,
    /// A colour for each material.
    Material,
    /// Steps that tracing took.
    Cost,
    /// Mean curvature per metre: red where the surface bulges towards the camera, blue where it is
    /// hollow; smooth meshes by their normals. Black is flat, or unknown.
    Curvature,
}

/// Shows normals, coordinates, distances, materials, cost or curvature in place of light. For `film rgb`:
/// spectral films read the numbers as spectra.
///
/// ```scene
/// integrator debug { show = "normals" }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Debug {
    /// What is shown.
    #[param(choice, default = Show::ShadingNormals)]
    show: Show,
    /// Factor on depth, cost and curvature, which count metres, steps and reciprocal metres.
    #[param(default = 1.0)]
    scale: f32,
}

/// A direction as a colour.
fn normal(n: DVec3) -> Vec3 {
    (0.5 * n + 0.5).as_vec3()
}

/// A colour that differs from those of neighbouring numbers.
fn colour(index: u32) -> Vec3 {
    let bits = hash32(index.wrapping_add(1));
    let [r, g, b, _] = bits.to_le_bytes();
    Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0
}

/// Red for what bulges to the side of the viewer, blue for what is hollow.
fn bend(at: &Arrival, scale: f32) -> Vec3 {
    let seen = if at.wo.dot(at.ns) < 0.0 { -at.curvature } else { at.curvature } * scale;
    Vec3::new(seen.max(0.0), 0.0, (-seen).max(0.0))
}

impl Debug {
    #[expect(clippy::cast_possible_truncation, reason = "rounds; a picture for the eye")]
    fn value(self, at: &Arrival) -> Option<Vec3> {
        if self.show == Show::Cost {
            return Some(Vec3::splat(at.steps as f32 * self.scale));
        }
        let at = (at.kind == ArrivalKind::Surface).then_some(at)?;
        Some(match self.show {
            Show::Normals => normal(at.ng),
            Show::ShadingNormals => normal(at.ns),
            Show::Uv => (at.uv - at.uv.floor()).extend(0.0),
            Show::Depth => Vec3::splat(at.t as f32 * self.scale),
            Show::Material | Show::Cost => colour(at.material),
            Show::Curvature => bend(at, self.scale),
        })
    }
}

impl PathIntegrator for Debug {
    type State = ();

    fn wants(&self) -> Wants {
        if self.show == Show::Curvature { Wants::CURVATURE } else { Wants::POSITION }
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) {
        ask.trace(job.ray);
    }

    fn arrive(
        &self,
        (): &mut (),
        at: &Arrival,
        _samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if let Some(value) = self.value(at) {
            ask.add(Spectrum::from_rgb(value));
        }
    }
}
