//! The camera with a lens.

use glam::{DMat3, DVec2, DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::kind::{Camera, CameraRay, Raster};
use luxel_sdk::num::Ray;
use luxel_sdk::params::{Fault, Look};
use luxel_sdk::sampling::disk_concentric;

use super::view::{Back, FovAxis, Plane, Vignetting, axes};

/// A camera with a lens: sharp at the distance `focus`, blurred before and behind. State `fov` or
/// `focal_length`, and `f_number` or `aperture`.
///
/// ```scene
/// camera thin_lens {
///   look = look_at(from = (0, 1.6, 7) m, to = (0, 1.1, 0) m, up = (0, 1, 0))
///   fov  = 39.6 deg, f_number = 2.8, focus = 7 m
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct ThinLens {
    /// Where it stands, what it looks at, which way is up.
    #[param(required)]
    look: Look,
    /// Angle of view along `fov_axis`, between 0 and 180 degrees.
    #[param(
        optional, unit = "rad", min = f64::MIN_POSITIVE, max = std::f64::consts::PI,
        group = "view"
    )]
    fov: f64,
    /// Focal length of the lens; the nearer the focus, the farther the sensor is behind it, and the
    /// less it shows.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE, group = "view")]
    focal_length: f64,
    /// Width and height of the sensor; full frame by default. With `fov` it says how long, and so
    /// how wide, the lens of an `f_number` is.
    #[param(default = [0.036, 0.024], unit = "m", min = f64::MIN_POSITIVE)]
    sensor: Vec2,
    /// Along which side the angle of view is measured.
    #[param(choice, default = FovAxis::Y)]
    fov_axis: FovAxis,
    /// `natural` darkens the corners by cos⁴, as a plain lens does.
    #[param(choice, default = Vignetting::None)]
    vignetting: Vignetting,
    /// Shift of the picture, in picture heights to the right and up.
    #[param(default = [0.0, 0.0])]
    shift: Vec2,
    /// Focal length over the diameter of the lens.
    #[param(optional, min = 1e-3, group = "opening")]
    f_number: f64,
    /// Radius of the lens; 0 is a pinhole.
    #[param(optional, unit = "m", min = 0, group = "opening")]
    aperture: f64,
    /// Distance along the view at which the picture is sharp; farther than the focal length.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    focus: f64,
    #[param(derived)]
    axes: DMat3,
    #[param(derived)]
    tan_half: f64,
}

impl ThinLens {
    /// What is sharp at `focus` is so on the sensor: 1/f = 1/focus + 1/distance.
    fn back(&self) -> Back {
        let Self { fov, sensor, fov_axis: axis, .. } = *self;
        let given = self.focal_length > 0.0;
        let distance = if given { 1.0 / (1.0 / self.focal_length - 1.0 / self.focus) } else { 0.0 };
        Back { fov, distance, sensor, axis }
    }

    /// Of the lens, metres.
    fn focal_length(&self) -> f64 {
        1.0 / (1.0 / self.back().distance() + 1.0 / self.focus)
    }

    fn plane(&self) -> Plane {
        Plane { tan_half: self.tan_half, axis: self.fov_axis, shift: self.shift }
    }

    /// Radius of the lens, metres.
    fn radius(&self) -> f64 {
        if self.f_number > 0.0 { 0.5 * self.focal_length() / self.f_number } else { self.aperture }
    }
}

impl Camera for ThinLens {
    fn prepare(&mut self) {
        self.axes = axes(&self.look);
        self.tan_half = self.back().tan_half();
    }

    fn check(&self) -> Result<(), Fault> {
        if self.focus <= 0.0 {
            return Err(Fault::range("focus", "the picture is sharp at a distance above 0"));
        }
        if self.focal_length > 0.0 && self.focus <= self.focal_length {
            let mm = self.focal_length * 1e3;
            let message =
                format!("only what is farther than `focal_length`, {mm:.1} mm, becomes sharp");
            return Err(Fault::range("focus", message));
        }
        self.back().check()
    }

    fn ray(&self, raster: Raster, p: DVec2, lens: [f32; 2]) -> Option<CameraRay> {
        let centre = self.plane().at_depth_1(raster, p);
        // All rays of a pixel meet in the plane of focus.
        let at = disk_concentric(lens).as_dvec2().extend(0.0) * self.radius();
        let d = (centre * self.focus - at).normalize();
        let weight = self.vignetting.weight(-centre.normalize().z);
        Some(CameraRay { ray: Ray::new(self.look.from + self.axes * at, self.axes * d), weight })
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        self.plane().project(raster, self.axes.transpose() * (p - self.look.from))
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn camera() -> ThinLens {
        let look = Look { from: DVec3::new(1.0, 2.0, 3.0), to: DVec3::ZERO, up: DVec3::Y };
        let mut camera = ThinLens {
            look,
            fov: 0.0,
            focal_length: 0.05,
            sensor: Vec2::new(0.036, 0.024),
            fov_axis: FovAxis::Y,
            vignetting: Vignetting::None,
            shift: Vec2::ZERO,
            f_number: 2.0,
            aperture: 0.0,
            focus: 4.0,
            axes: DMat3::ZERO,
            tan_half: 0.0,
        };
        camera.prepare();
        camera
    }

    #[test]
    fn all_rays_of_a_pixel_meet_in_the_plane_of_focus() {
        let (camera, raster) = (camera(), Raster { size: UVec2::new(300, 200) });
        let p = DVec2::new(12.0, 34.0);
        let axis = (camera.look.to - camera.look.from).normalize();
        for lens in [[0.1, 0.9], [0.5, 0.5], [0.99, 0.3]] {
            let ray = camera.ray(raster, p, lens).unwrap().ray;
            let off = ray.o - camera.look.from;
            // The lens is 50 mm / 2 / 2 in radius and flat.
            assert!(off.length() <= 0.0125 * (1.0 + 1e-7) && off.dot(axis).abs() < 1e-15);
            let t = (4.0 - off.dot(axis)) / ray.d.dot(axis);
            let back = camera.project(raster, ray.at(t)).unwrap();
            // A few dozen f64 roundings of numbers below 1000.
            assert!((back - p).length() < 1e-11, "{back}");
        }
    }

    #[test]
    fn a_focus_at_the_lens_is_refused() {
        let mut camera = camera();
        assert!(camera.check().is_ok());
        for focus in [0.0, 0.05] {
            camera.focus = focus;
            assert_eq!(camera.check().unwrap_err().field, "focus");
        }
        let told = "only what is farther than `focal_length`, 50.0 mm, becomes sharp";
        assert_eq!(camera.check().unwrap_err().message, told);
    }

    #[test]
    fn a_near_focus_shows_less_and_an_angle_of_view_says_the_same_lens() {
        let near = camera();
        // The sensor is 50 mm · 4 m/(4 m − 50 mm) behind the lens.
        let tan = 0.5 * 0.024 / (0.05 * 4.0 / 3.95);
        // Half an ulp of the sensor's side, which is f32.
        assert!((near.tan_half / tan - 1.0).abs() < 6e-8);
        let fov = 2.0 * near.tan_half.atan();
        let mut same = ThinLens { fov, focal_length: 0.0, ..near };
        same.prepare();
        assert!((same.radius() / near.radius() - 1.0).abs() < 1e-14);
        assert!((near.radius() / 0.0125 - 1.0).abs() < 1e-14);
    }
}
