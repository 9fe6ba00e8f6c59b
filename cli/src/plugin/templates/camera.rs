//! A camera, to be made your own.

use glam::{DMat3, DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Camera, CameraRay, Raster};
use luxel_sdk::num::Ray;
use luxel_sdk::params::{Fault, Look};

/// Parallel rays: things keep their size however far away they are.
///
/// ```scene
/// camera template_name {
///   look   = look_at(from = (0, 10, 0) m, to = (0, 0, 0) m, up = (0, 0, -1))
///   height = 6 m
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Where the picture plane stands, what it looks at, which way is up.
    #[param(required)]
    look: Look,
    /// What the picture shows from bottom to top; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    height: f64,
    /// From camera space (x right, y up, looking along -z) to world space.
    #[param(derived)]
    axes: DMat3,
}

impl Camera for TemplateName {
    /// Called after every change of the parameters, before anything else.
    fn prepare(&mut self) {
        let (right, up, backward) = self.look.axes();
        self.axes = DMat3::from_cols(right, up, backward);
    }

    fn check(&self) -> Result<(), Fault> {
        if self.height > 0.0 {
            return Ok(());
        }
        Err(Fault::range("height", "a picture without height shows nothing"))
    }

    fn ray(&self, raster: Raster, p: DVec2, _lens: [f32; 2]) -> Option<CameraRay> {
        let at = raster.to_screen(p).extend(0.0) * (0.5 * self.height);
        let o = self.look.from + self.axes * at;
        Some(CameraRay { ray: Ray::new(o, -self.axes.z_axis), weight: 1.0 })
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        let local = self.axes.transpose() * (p - self.look.from);
        let screen = local.truncate() / (0.5 * self.height);
        (local.z < 0.0).then(|| raster.of_screen(screen))
    }
}

luxel_sdk::plugin! { camera "template_name" => TemplateName; }
