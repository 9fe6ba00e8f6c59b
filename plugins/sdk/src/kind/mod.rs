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
mod picture;
mod sampler;
mod shape;
mod sight;
mod texture;
pub mod table;

pub use camera::{Camera, CameraRay, Raster};
pub use filter::Filter;
pub use importer::{ImportNode, ImportValue, Imported, Importer};
pub(crate) use integrator::arrive_n;
pub use integrator::{
    Arrival, ArrivalKind, Ask, Direct, Erased, Host, Integrator, Job, Lane, Onward, PathIntegrator,
    Requests, Round, Scatter, Shadow, Wants, mis,
};
pub use light::{Escaped, Light, LightForm, LightQuery, LightSample};
pub use material::{Eval, Lobe, Material, Needs, Sample, reflect};
pub use medium::{FreeFlight, Medium};
pub use phase::Phase;
pub use picture::{Picture, PictureIntegrator, PictureJob};
pub use sampler::{SampleAt, Sampler, Samples};
pub use shape::{
    Hit, Later, NormalDerivatives, Parallelogram, Shape, ShapeSample, Surface, TriangleMesh,
};
pub use sight::Sight;
pub use texture::{Output, Texture, TexturePoint};

pub use table::{MaterialRef, PathsRef, PhaseRef, ShapeRef, TextureRef};

pub use crate::params::Kind;
pub use crate::wire::Queue;
