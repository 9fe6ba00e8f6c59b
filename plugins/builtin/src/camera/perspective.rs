//! The pinhole camera.

use glam::{DMat3, DVec2, DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::kind::{Camera, CameraRay, Raster};
use luxel_sdk::num::{Ray, unit_and_length};
use luxel_sdk::params::{Fault, Look};

use super::view::{Back, FovAxis, Plane, Vignetting, axes};

/// A pinhole camera: straight lines stay straight and everything is sharp. State either `fov` or
/// `focal_length` with the `sensor` behind it.
///
/// ```scene
/// camera perspective {
///   look = look_at(from = (0, 1, 4) m, to = (0, 1, 0) m, up = (0, 1, 0))
///   fov  = 40 deg
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Perspective {
    /// Where it stands, what it looks at, which way is up.
    #[param(required)]
    look: Look,
    /// Angle of view along `fov_axis`, between 0 and 180 degrees.
    #[param(
        optional, unit = "rad", min = f64::MIN_POSITIVE, max = std::f64::consts::PI,
        group = "view"
    )]
    fov: f64,
    /// Distance of the sensor from the pinhole.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE, group = "view")]
    focal_length: f64,
    /// Width and height of the sensor, for `focal_length`; full frame by default. If its shape
    /// differs from the picture's, its side along `fov_axis` counts.
    #[param(default = [0.036, 0.024], unit = "m", min = f64::MIN_POSITIVE)]
    sensor: Vec2,
    /// Along which side the angle of view is measured.
    #[param(choice, default = FovAxis::Y)]
    fov_axis: FovAxis,
    /// `natural` darkens the corners by cos⁴, as a plain lens does.
    #[param(choice, default = Vignetting::None)]
    vignetting: Vignetting,
    /// Shift of the picture, in picture heights to the right and up: keeps verticals upright.
    #[param(default = [0.0, 0.0])]
    shift: Vec2,
    #[param(derived)]
    axes: DMat3,
    #[param(derived)]
    tan_half: f64,
}

impl Perspective {
    fn back(&self) -> Back {
        let Self { fov, focal_length: distance, sensor, fov_axis: axis, .. } = *self;
        Back { fov, distance, sensor, axis }
    }

    fn plane(&self) -> Plane {
        Plane { tan_half: self.tan_half, axis: self.fov_axis, shift: self.shift }
    }
}

impl Camera for Perspective {
    fn prepare(&mut self) {
        self.axes = axes(&self.look);
        self.tan_half = self.back().tan_half();
    }

    fn check(&self) -> Result<(), Fault> {
        self.back().check()
    }

    fn ray(&self, raster: Raster, p: DVec2, _lens: [f32; 2]) -> Option<CameraRay> {
        let (d, _) = unit_and_length(self.plane().at_depth_1(raster, p));
        let weight = self.vignetting.weight(-d.z);
        Some(CameraRay { ray: Ray::new(self.look.from, self.axes * d), weight })
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        self.plane().project(raster, self.axes.transpose() * (p - self.look.from))
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn camera(fov: f64, focal_length: f64, fov_axis: FovAxis) -> Perspective {
        let look = Look { from: DVec3::ZERO, to: DVec3::NEG_Z, up: DVec3::Y };
        let mut camera = Perspective {
            look,
            fov,
            focal_length,
            sensor: Vec2::new(0.036, 0.024),
            fov_axis,
            vignetting: Vignetting::Natural,
            shift: Vec2::ZERO,
            axes: DMat3::ZERO,
            tan_half: 0.0,
        };
        camera.prepare();
        camera
    }
    const HD: Raster = Raster { size: UVec2::new(1920, 1080) };

    #[test]
    fn a_point_projects_where_the_closed_form_says() {
        let camera = camera(60f64.to_radians(), 0.0, FovAxis::Y);
        let at = camera.project(HD, DVec3::new(1.0, 0.5, -4.0)).unwrap();
        let expected = DVec2::new(1193.8268590217986, 423.0865704891008);
        // Truth camera.pinhole. A dozen f64 roundings of numbers up to 2000.
        assert!((at - expected).abs().max_element() < 1e-11 * 2000.0, "{at}");
        assert!(camera.project(HD, DVec3::new(1.0, 0.5, 4.0)).is_none());
    }

    #[test]
    fn every_ray_projects_back_to_its_pixel() {
        for axis in [FovAxis::Y, FovAxis::X, FovAxis::Smaller, FovAxis::Larger] {
            let mut camera = camera(0.0, 0.035, axis);
            camera.look.from = DVec3::new(1.0, -2.0, 3e3);
            camera.shift = Vec2::new(0.2, -0.1);
            camera.prepare();
            for p in [DVec2::new(0.0, 0.0), DVec2::new(700.25, 900.0), DVec2::new(1920.0, 1.0)] {
                let ray = camera.ray(HD, p, [0.0; 2]).unwrap().ray;
                assert!((ray.d.length() - 1.0).abs() < 4.0 * f64::EPSILON);
                let back = camera.project(HD, ray.at(7.0)).unwrap();
                // The point is rounded to ulp(3e3)/2 = 2.3e-13 m, 1e-13 of 7 m times 1e4 pixels.
                assert!((back - p).abs().max_element() < 1e-9, "{p} {back}");
            }
        }
    }

    #[test]
    fn the_edge_of_the_picture_is_half_the_angle_of_view_away() {
        for (axis, p) in [
            (FovAxis::Y, DVec2::new(960.0, 0.0)),
            (FovAxis::Smaller, DVec2::new(960.0, 1080.0)),
            (FovAxis::X, DVec2::new(0.0, 540.0)),
            (FovAxis::Larger, DVec2::new(1920.0, 540.0)),
        ] {
            let seen = camera(1.0, 0.0, axis).ray(HD, p, [0.0; 2]).unwrap();
            assert!((-seen.ray.d.z - 0.5f64.cos()).abs() < 8.0 * f64::EPSILON);
            assert!(
                (f64::from(seen.weight) - 0.5f64.cos().powi(4)).abs() < f64::from(f32::EPSILON)
            );
        }
    }

    #[test]
    fn no_angle_and_a_half_turn_are_refused() {
        assert_eq!(camera(0.0, 0.0, FovAxis::Y).check().unwrap_err().field, "fov");
        let half_turn = camera(std::f64::consts::PI, 0.0, FovAxis::Y);
        assert!(half_turn.check().unwrap_err().message.contains("180 deg"));
        assert!(camera(0.0, 0.05, FovAxis::Y).check().is_ok());
    }
}
