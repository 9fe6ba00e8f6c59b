use glam::{DVec2, DVec3};
use luxel_sdk::abi::CameraTable;
use luxel_sdk::kind::{Camera, CameraRay, Raster};

use super::Head;

/// A library's camera.
#[repr(transparent)]
pub(super) struct RemoteCamera(Head);

// SAFETY: the SDK demands of cameras that they are `Send + Sync`.
unsafe impl Send for RemoteCamera {}
// SAFETY: as above.
unsafe impl Sync for RemoteCamera {}

impl RemoteCamera {
    fn table(&self) -> &'static CameraTable {
        // SAFETY: the view was made for cameras.
        unsafe { self.0.table() }
    }
}

impl Camera for RemoteCamera {
    fn ray(&self, raster: Raster, p: DVec2, lens: [f32; 2]) -> Option<CameraRay> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let found = self.0.found(unsafe { self.table().ray(self.0.at(), &raster, &p, &lens) })?;
        let ray = &found.ray;
        let weighs = found.weight >= 0.0 && found.weight.is_finite();
        if ray.o.is_finite() && ray.d.is_normalized() && weighs {
            return Some(found);
        }
        self.0.wrong("gave a ray that is not finite or not of unit length");
        None
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: as above.
        self.0.found(unsafe { self.table().project(self.0.at(), &raster, &p) })
    }
}
