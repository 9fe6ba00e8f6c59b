//! One file per kind of plugin: the trait that gives a parameter struct its behaviour.

mod camera;
mod filter;
mod importer;
mod integrator;
mod light;
mod material;
mod medium;
mod phase;
mod sampler;
mod shape;
mod texture;

use std::fmt;

pub use camera::{Camera, CameraRay, Raster};
pub use filter::Filter;
pub use importer::{ImportNode, ImportValue, Imported, Importer};
pub use integrator::{
    Arrival, ArrivalKind, Ask, Direct, Erased, Host, Integrator, Job, Lane, PathIntegrator,
    Requests, Scatter, Shadow, Wants, mis,
};
pub use light::{Escaped, Light, LightForm, LightQuery, LightSample};
pub use material::{Eval, Lobe, Material, MaterialRef, Sample, reflect};
pub use medium::{FreeFlight, Medium};
pub use phase::{Phase, PhaseRef};
pub use sampler::{SampleAt, Sampler, Samples};
pub use shape::{Hit, Shape, ShapeSample, Surface, TriangleMesh};
pub use texture::{Output, Texture, TexturePoint};

/// What a plugin is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum Kind {
    /// Geometry.
    Shape,
    /// How a surface scatters light.
    Material,
    /// A value that varies over a surface.
    Texture,
    /// A source of light.
    Light,
    /// What fills space.
    Medium,
    /// How a medium scatters light.
    Phase,
    /// Where pictures are taken from.
    Camera,
    /// Where random numbers come from.
    Sampler,
    /// How samples become pixels.
    Filter,
    /// How light is followed.
    Integrator,
    /// Bytes of another format into nodes of a scene.
    Importer,
    /// What is measured: resolution, colour mode, output. Provided by the host.
    Film,
}

impl Kind {
    /// Every kind with its word in a scene, in the order of `luxel list`.
    pub const ALL: [(Self, &'static str); 12] = [
        (Self::Shape, "shape"),
        (Self::Material, "material"),
        (Self::Texture, "texture"),
        (Self::Light, "light"),
        (Self::Medium, "medium"),
        (Self::Phase, "phase"),
        (Self::Camera, "camera"),
        (Self::Sampler, "sampler"),
        (Self::Filter, "filter"),
        (Self::Integrator, "integrator"),
        (Self::Importer, "asset"),
        (Self::Film, "film"),
    ];

    /// The word in a scene.
    pub fn word(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// The kind of a word.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == word).map(|(kind, _)| *kind)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}
