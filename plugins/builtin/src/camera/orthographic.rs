//! The camera of plans and elevations.

use glam::{DMat3, DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Camera, CameraRay, Raster};
use luxel_sdk::num::Ray;
use luxel_sdk::params::{Fault, Look};

use super::view::axes;

/// Parallel rays: things keep their size however far away they are, as in plans.
///
/// ```scene
/// camera orthographic {
///   look   = look_at(from = (0, 10, 0) m, to = (0, 0, 0) m, up = (0, 0, -1))
///   height = 6 m
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Orthographic {
    /// Where the picture plane stands, what it looks at, which way is up.
    #[param(required)]
    look: Look,
    /// What the picture shows from bottom to top.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    height: f64,
    #[param(derived)]
    axes: DMat3,
}

impl Camera for Orthographic {
    fn prepare(&mut self) {
        self.axes = axes(&self.look);
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

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn rays_are_parallel_and_project_back() {
        let look = Look { from: DVec3::new(1e6, 2.0, 3.0), to: DVec3::ZERO, up: DVec3::Y };
        let mut camera = Orthographic { look, height: 3.0, axes: DMat3::ZERO };
        camera.prepare();
        let raster = Raster { size: UVec2::new(640, 480) };
        for p in [DVec2::ZERO, DVec2::new(640.0, 480.0), DVec2::new(3.0, 400.0)] {
            let ray = camera.ray(raster, p, [0.5; 2]).unwrap().ray;
            let back = camera.project(raster, ray.at(5.0)).unwrap();
            // ulp(1e6)/2 = 6e-11 m at 160 pixels to the metre, three coordinates.
            assert!((back - p).length() < 1e-7, "{back}");
            assert!(camera.project(raster, ray.at(-5.0)).is_none());
        }
        camera.height = 0.0;
        assert_eq!(camera.check().unwrap_err().field, "height");
    }
}
