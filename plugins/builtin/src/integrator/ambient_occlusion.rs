//! How open each place is.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, ArrivalKind, Ask, Host, Job, PathIntegrator, Samples, Wants};
use luxel_sdk::num::Frame;
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::cosine_hemisphere;

/// How much of an even white sky each place sees: 1 in the open, 0 in a crevice. Shows shape
/// without lights or materials.
///
/// ```scene
/// integrator ambient_occlusion { distance = 50 cm }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct AmbientOcclusion {
    /// How far away things still hide the sky; any distance if absent.
    #[param(optional, unit = "m", min = 0)]
    pub(super) distance: Maybe<f32>,
}

impl PathIntegrator for AmbientOcclusion {
    type State = ();

    fn wants(&self) -> Wants {
        Wants::POSITION
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) {
        ask.trace(job.ray);
    }

    fn arrive(
        &self,
        (): &mut (),
        at: &Arrival,
        samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if at.kind != ArrivalKind::Surface {
            return;
        }
        let facing = if at.wo.dot(at.ng) < 0.0 { -1.0 } else { 1.0 };
        let up = cosine_hemisphere(samples.next_2d());
        let frame = Frame::from_z((at.ns * facing).as_vec3());
        let wi = frame.to_world(up).as_dvec3().normalize();
        // A shading normal may point into the surface, which hides the sky.
        if wi.dot(at.ns) * facing > 0.0 {
            let distance = self.distance.get().map_or(f64::INFINITY, f64::from);
            ask.add_if_visible(at.ray_to(wi, distance), Spectrum::ONE);
        }
    }
}
