//! What cameras share: the angle of view, and the way between the picture and camera space.

use glam::{DMat3, DVec2, DVec3, Vec2};
use luxel_sdk::Choice;
use luxel_sdk::kind::Raster;
use luxel_sdk::params::{Fault, Look};

/// Along which side of the picture the angle of view is measured.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum FovAxis {
    /// From bottom to top.
    Y,
    /// From left to right.
    X,
    /// Along the shorter side.
    Smaller,
    /// Along the longer side.
    Larger,
}

/// Whether the picture darkens towards its corners.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Vignetting {
    /// Not at all.
    None,
    /// By the fourth power of the cosine to the axis.
    Natural,
}

/// Angle of view as a scene gives it: `fov` (radians) or how far the `sensor` is behind the opening
/// (metres); what is absent is 0.
#[derive(Clone, Copy)]
pub(crate) struct Back {
    pub(crate) fov: f64,
    pub(crate) distance: f64,
    pub(crate) sensor: Vec2,
    pub(crate) axis: FovAxis,
}

impl Back {
    /// Rejects what gives no picture.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        if self.distance > 0.0 {
            return Ok(());
        }
        if self.fov > 0.0 && self.fov < std::f64::consts::PI {
            return Ok(());
        }
        let found = self.fov.to_degrees();
        let message =
            format!("an angle of view between 0 and 180 deg is wanted, found {found} deg");
        Err(Fault::range("fov", message))
    }

    /// Tangent of half the angle of view along `axis`.
    pub(crate) fn tan_half(&self) -> f64 {
        if self.distance > 0.0 { 0.5 * self.side() / self.distance } else { (0.5 * self.fov).tan() }
    }

    /// How far the sensor is behind the opening, metres: given, or what fits it into the angle of view.
    pub(crate) fn distance(&self) -> f64 {
        if self.distance > 0.0 { self.distance } else { 0.5 * self.side() / self.tan_half() }
    }

    /// The sensor's side along `axis`, metres.
    fn side(&self) -> f64 {
        f64::from(match self.axis {
            FovAxis::Y => self.sensor.y,
            FovAxis::X => self.sensor.x,
            FovAxis::Smaller => self.sensor.min_element(),
            FovAxis::Larger => self.sensor.max_element(),
        })
    }
}

/// The rotation from camera space (x right, y up, looking along −z) to world space.
pub(crate) fn axes(look: &Look) -> DMat3 {
    let (right, up, backward) = look.axes();
    DMat3::from_cols(right, up, backward)
}

/// Tangent of half the vertical angle of view, from that along `axis`.
fn vertical(tan_half: f64, axis: FovAxis, raster: Raster) -> f64 {
    let size = raster.size.as_dvec2();
    let aspect = size.x / size.y;
    match axis {
        FovAxis::Y => tan_half,
        FovAxis::X => tan_half / aspect,
        FovAxis::Smaller => tan_half / aspect.min(1.0),
        FovAxis::Larger => tan_half / aspect.max(1.0),
    }
}

/// How a picture plane stands before a pinhole.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    /// Tangent of half the angle of view along `axis`.
    pub(crate) tan_half: f64,
    pub(crate) axis: FovAxis,
    /// Shift in picture heights, to the right and up.
    pub(crate) shift: Vec2,
}

impl Plane {
    /// The point at depth 1 (z = −1) that raster point `p` shows, camera space.
    pub(crate) fn at_depth_1(&self, raster: Raster, p: DVec2) -> DVec3 {
        let screen = raster.to_screen(p) + 2.0 * self.shift.as_dvec2();
        (screen * vertical(self.tan_half, self.axis, raster)).extend(-1.0)
    }

    /// The raster point that shows a point in camera space; `None` behind the camera.
    pub(crate) fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        let tan = vertical(self.tan_half, self.axis, raster);
        let screen = p.truncate() / (-p.z * tan) - 2.0 * self.shift.as_dvec2();
        (p.z < 0.0).then(|| raster.of_screen(screen))
    }
}

impl Vignetting {
    /// What radiance along a direction counts for; `cos` to the axis.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; weights are f32")]
    pub(crate) fn weight(self, cos: f64) -> f32 {
        match self {
            Self::None => 1.0,
            Self::Natural => cos.powi(4) as f32,
        }
    }
}
