//! Sources of light.

use glam::{DVec3, Vec2};

use super::Output;
use crate::color::Spectrum;
use crate::params::Fault;

/// What form of source a light is: decides which of its methods the host calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum LightForm {
    /// A shape's surface shines: `le`. Which shape, the parameter `shape` says, a `ShapeSlot`: without
    /// it the scene is refused.
    Surface,
    /// A point: `sample`, which always finds the same point.
    Point,
    /// Light from far away, from directions that a ray may escape to: `sample` and `escaped`.
    Infinite,
    /// The same, of about the same radiance in all directions: what scatters finds it at least as well
    /// as who looks for it, so it is looked for in scenes with media alone.
    Everywhere,
}

/// For which point light is looked for.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct LightQuery {
    /// The point, in the frame of the light, metres.
    pub p: DVec3,
    /// Uniform in [0, 1)².
    pub u: [f32; 2],
}

/// Light that may reach a point.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct LightSample {
    /// Radiance; for a delta light the irradiance on a surface that faces it.
    pub le: Spectrum,
    /// Unit direction to the light, in its frame.
    pub wi: DVec3,
    /// How far away; infinite for a light without a place.
    pub distance: f64,
    /// Solid-angle density, sr⁻¹; 1 for a delta light.
    pub pdf: f32,
    /// Whether no ray can find it by chance.
    pub delta: bool,
}

/// What a ray that leaves the scene finds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Escaped {
    /// Radiance.
    pub le: Spectrum,
    /// Density with which `sample` would have found the direction, sr⁻¹.
    pub pdf: f32,
}

/// A source of light. Emission arrives in its `Emission` field at the wavelengths of the path.
pub trait Light: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// What form of source it is.
    fn form(&self) -> LightForm;

    /// Radiance that leaves a shining surface of the given area (m², world) at an angle whose cosine
    /// to the outer normal is `cos_o`, where the surface's parameters are `uv`.
    fn le(&self, _cos_o: f32, _uv: Vec2, _area: f64) -> Spectrum {
        Spectrum::ZERO
    }

    /// Light that may reach a point: for all but surfaces.
    fn sample(&self, _query: &LightQuery) -> Option<LightSample> {
        None
    }

    /// What a ray that leaves the scene along `d` (unit, in the light's frame) finds.
    fn escaped(&self, _d: DVec3) -> Escaped {
        Escaped { le: Spectrum::ZERO, pdf: 0.0 }
    }

    /// About how much power it gives, for choosing between lights: W, or the same in lumens over
    /// 683. For a shining surface of the given area; for infinite light through a sphere of the
    /// given radius (m).
    fn power(&self, area: f64, scene_radius: f64) -> f32;

    /// What the lanes of its radiance mean.
    fn output(&self) -> Output {
        Output::Value
    }
}
