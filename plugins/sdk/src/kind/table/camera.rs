use glam::{DVec2, DVec3};

use super::table;
use crate::kind::{Camera, CameraRay, Raster};

table! {
    /// A camera, in world space.
    Camera => CameraTable "luxel_camera_table" {
        /// The ray through a place of the picture; nothing where nothing is seen.
        fn ray(camera, raster: &Raster, p: &DVec2, lens: &[f32; 2]) -> CameraRay {
            camera.ray(*raster, *p, *lens)
        }
        /// Where a point appears through the centre of the lens; nothing behind it.
        fn project(camera, raster: &Raster, p: &DVec3) -> DVec2 { camera.project(*raster, *p) }
    }
}
