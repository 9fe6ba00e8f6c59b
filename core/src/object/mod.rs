//! Objects: a class with its parameters, ready to be asked at a point.
//!
//! An object keeps the bytes of its parameter struct as a template, and a list of what varies from
//! point to point (textures) or path to path (wavelengths). Where nothing varies the template itself
//! is what the plugin sees; else the host copies it, fills the varying fields, and runs `prepare`.

mod asked;
mod block;
mod build;
mod colour;
mod context;
mod draft;
mod part;
mod patch;
mod resolve;
mod shelf;

#[cfg(test)]
mod tests;

use std::any::Any;
use std::sync::Arc;

use glam::DVec3;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Needs, Shape};
use luxel_sdk::num::Transform;
use luxel_sdk::params::Fault;
use luxel_sdk::sampling::{sobol_owen_2d, uniform_sphere};

use crate::files::Files;
use crate::registry::Registry;
use crate::registry::dynamic::Watch;
use block::Block;
use patch::Patches;
use resolve::SCRATCH;

pub use build::{Builder, ColorMode, Objects};
pub use colour::white;
pub use context::{Embedded, Reader, Reads};
pub use part::MeshParts;
pub use resolve::{Resolved, Scratch, Site};
pub use shelf::{ByContent, Kept, Shelf};

/// The most objects that one may be made of: a mixture of mixtures of the same two doubles them with
/// every step.
const MOST_PARTS: usize = 4096;

/// Points at which the area scale of a transform that is no similarity is averaged.
const AREA_POINTS: u32 = 1024;

/// Area of a shape in the frame that a transform leads to. Exact for similarities; else the mean scale
/// over points that the shape samples uniformly, or, where it samples none, over normals of all
/// directions alike: right for what is round, a guess for what is flat.
pub fn carried_area(shape: &dyn Shape, transform: &Transform) -> f64 {
    if transform.is_rigid_or_uniform() {
        return shape.area() * transform.area_scale(DVec3::Z);
    }
    let scale = |i: u32| {
        let u = sobol_owen_2d(i, 0x5eed);
        let sample = shape.sample(None, u);
        let normal = sample.map_or_else(|| uniform_sphere(u).as_dvec3(), |it| it.surface.ng);
        transform.area_scale(normal)
    };
    shape.area() * (0..AREA_POINTS).map(scale).sum::<f64>() / f64::from(AREA_POINTS)
}

/// A built object. Immutable; shared by everything that uses it.
pub struct Object {
    class: Class,
    template: Block,
    patches: Patches,
    /// Whether it takes the surface's own colours: they are not looked for elsewhere.
    takes_colors: bool,
    /// Scratch that resolving takes, children included, in chunks.
    need: usize,
    /// Tables and texts that the template's bytes point into.
    owned: Vec<Arc<dyn Any + Send + Sync>>,
    /// Objects that this one is made of.
    parts: Vec<Arc<Object>>,
    /// Itself and its parts with theirs, each as often as it is asked.
    size: usize,
    /// Whether it would be another one if colour were carried in another way.
    is_by_mode: bool,
    /// Bits that its hits' faces may take, where it is a shape.
    face_bits: u32,
    /// What a material looks at, where that is the same everywhere.
    needs: Option<Needs>,
    /// What becomes of it, if its class came from a library.
    watch: Option<Arc<Watch>>,
    /// Files that were read to build it, with the hash of their bytes.
    reads: Reads,
    /// What was warned of while it was built: holds for as long as it is kept.
    warnings: Vec<String>,
}

impl Object {
    /// Its class.
    pub fn class(&self) -> &Class {
        &self.class
    }

    /// What a material looks at, where that is the same everywhere.
    #[inline(always)]
    pub fn needs(&self) -> Option<Needs> {
        self.needs
    }

    /// Whether it asks a site for the surface's own colours.
    #[inline(always)]
    pub fn takes_colors(&self) -> bool {
        self.takes_colors
    }

    /// Who failed and how, if a library's code has failed in this object.
    pub fn failure(&self) -> Option<String> {
        self.watch.as_ref()?.told()
    }

    /// Whether it may be used again: its class and those of its parts are still the registry's own,
    /// and none of them has failed.
    pub(crate) fn is_current(&self, registry: &Registry) -> bool {
        let class = &self.class;
        let now = registry.class(class.kind, class.name);
        now.is_some_and(|now| now.is_same(class))
            && self.failure().is_none()
            && self.parts.iter().all(|part| part.is_current(registry))
    }

    /// Whether the files that it and its parts were built from are what they were.
    fn is_unchanged(&self, files: &dyn Files, embedded: &Embedded) -> bool {
        self.reads.are_unchanged(files, embedded)
            && self.parts.iter().all(|part| part.is_unchanged(files, embedded))
    }

    /// What is to be said where it takes more room or time at one point than an object may.
    fn is_too_large(&self) -> Option<Fault> {
        let told = |code, message| Some(Fault { field: "", code, message });
        if self.size > MOST_PARTS {
            let n = self.size;
            let message =
                format!("made of {n} objects, each asked at every point: {MOST_PARTS} are most");
            return told("E0501", message);
        }
        if self.need > SCRATCH {
            let [need, most] = [self.need, SCRATCH].map(|chunks| chunks * block::CHUNK);
            let message =
                format!("objects nested too deeply: {need} bytes at a point, {most} allowed");
            return told("E0507", message);
        }
        None
    }

    /// Whether its parameters are the same everywhere and at every wavelength.
    pub fn is_constant(&self) -> bool {
        self.patches.is_empty()
    }
}

impl std::fmt::Debug for Object {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.class)
    }
}
