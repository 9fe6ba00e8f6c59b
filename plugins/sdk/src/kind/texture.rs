//! A value that varies over a surface.

use glam::{DVec3, Vec2};

use crate::color::Spectrum;
use crate::color::Wavelengths;
use crate::params::Fault;

/// Where a texture is looked up.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct TexturePoint {
    /// World space, metres.
    pub p: DVec3,
    /// Surface coordinates; for an environment the direction as (azimuth, polar angle) in [0, 1]².
    pub uv: Vec2,
    /// The wavelengths of the path, nm; meaningless in `rgb` mode.
    pub lambda: Wavelengths,
}

/// What the lanes of a texture's value mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Output {
    /// Values as they are: a number in every lane, or values at the path's wavelengths.
    Value,
    /// Linear sRGB: the host uplifts it where the path is spectral.
    Rgb,
    /// The colours that a surface's corner points have, as linear sRGB: the host takes those, and asks
    /// for the value, linear sRGB too, only where there are none.
    Corners,
}

/// A value that varies over a surface or through space.
pub trait Texture: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// The value; finite for every finite point. Where a number is wanted, the first lane counts, or
    /// the luminance if the lanes are RGB.
    fn eval(&self, at: &TexturePoint) -> Spectrum;

    /// What the lanes mean.
    fn output(&self) -> Output {
        Output::Value
    }
}
