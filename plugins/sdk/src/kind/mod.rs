//! One file per kind of plugin: the trait that gives a parameter struct its behaviour.

mod camera;
mod filter;
mod flags;
mod importer;
mod integrator;
mod light;
mod material;
mod medium;
mod phase;
mod sampler;
mod shape;
mod texture;

pub use camera::{Camera, CameraRay, Raster};
pub use filter::Filter;
pub use importer::{ImportNode, ImportValue, Imported, Importer};
pub use integrator::{
    Arrival, ArrivalKind, Ask, Direct, Erased, Host, Integrator, Job, Lane, PathIntegrator,
    Requests, Scatter, Shadow, Wants, mis,
};
pub use light::{Escaped, Light, LightForm, LightQuery, LightSample};
pub use material::{Eval, Lobe, Material, MaterialRef, Needs, Sample, reflect};
pub use medium::{FreeFlight, Medium};
pub use phase::{Phase, PhaseRef};
pub use sampler::{SampleAt, Sampler, Samples};
pub use shape::{Hit, Shape, ShapeSample, Surface, TriangleMesh};
pub use texture::{Output, Texture, TexturePoint};

pub use crate::params::Kind;
