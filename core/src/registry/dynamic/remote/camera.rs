use std::mem::MaybeUninit;

use glam::{DVec2, DVec3};
use luxel_sdk::abi::CameraTable;
use luxel_sdk::kind::{Camera, CameraRay, Raster};
use luxel_sdk::num::Ray;

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
        let mut out = MaybeUninit::uninit();
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let status = unsafe { (self.table().ray)(self.0.at(), &raster, &p, &lens, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: the library has written a result.
        let CameraRay { ray: Ray { o, d, t_max }, weight } = *unsafe { out.assume_init_ref() };
        if o.is_finite() && d.is_normalized() && (0.0..f32::INFINITY).contains(&weight) {
            return Some(CameraRay { ray: Ray { o, d, t_max }, weight });
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
