//! Where pictures are taken from.

use glam::{DVec2, DVec3, UVec2};

use crate::num::Ray;
use crate::params::Fault;

/// The picture's size in pixels. Raster coordinates run right and down from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Raster {
    /// Width and height.
    pub size: UVec2,
}

impl Raster {
    /// Raster coordinates as x in [−aspect, aspect] to the right and y in [−1, 1] upwards.
    pub fn to_screen(self, p: DVec2) -> DVec2 {
        let size = self.size.as_dvec2();
        DVec2::new(2.0 * p.x - size.x, size.y - 2.0 * p.y) / size.y
    }

    /// The inverse of `to_screen`.
    pub fn of_screen(self, s: DVec2) -> DVec2 {
        let size = self.size.as_dvec2();
        DVec2::new(s.x * size.y + size.x, size.y - s.y * size.y) / 2.0
    }
}

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct CameraRay {
    /// World space, unit direction, infinite.
    pub ray: Ray,
    /// What radiance along it counts for.
    pub weight: f32,
}

/// A camera, in world space.
pub trait Camera: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// The ray through raster point `p`; `lens` uniform in [0, 1)². `None` where nothing is seen.
    fn ray(&self, raster: Raster, p: DVec2, lens: [f32; 2]) -> Option<CameraRay>;

    /// Where a point in world space appears through the centre of the lens; `None` behind it.
    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2>;
}
