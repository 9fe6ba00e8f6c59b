//! glTF 2.0, text or binary.
//!
//! The file is read through `gltf`'s description of its JSON alone; every index, size and count
//! that stands in it is checked here, where it is used.
//!
//! # Source
//! Khronos Group 2021, glTF 2.0 specification, and the extensions named in `EXTENSIONS`.

mod accessor;
mod lights;
mod material;
mod mesh;
mod nodes;
mod source;
#[cfg(test)]
mod tests;
mod uri;

use glam::{DAffine3, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Importer, Kind};
use luxel_sdk::params::{BuildContext, Fault, File, Maybe};

use self::material::Materials;
use self::mesh::Meshes;
use self::source::Source;
use super::obj::check_unit;
use crate::shape::up::Up;

/// A glTF file (`.gltf` or `.glb`), to be placed any number of times.
///
/// Brings meshes, metallic-roughness materials with their textures, cameras and punctual lights;
/// what shines becomes an area light. Materials keep their names, by which
/// `materials` of the asset replaces them. Skins and morphs stay in their
/// bind pose; normal maps are left out, with a warning.
///
/// ```scene
/// let tree = asset gltf { file = "assets/tree.glb", unit = 1 m }
/// place tree { transform = [move((2, 0, 0) m)] }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Gltf<'a> {
    /// The file; buffers and images that it names are found beside it.
    #[param(required)]
    file: File<'a>,
    /// Length of one unit of the file; the format says 1 m.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    unit: f64,
    /// Which axis of the file is up; the format says y.
    #[param(choice, default = Up::Y)]
    up: Up,
    /// Which of the file's scenes, counted from 0; the file's own choice when not given.
    #[param(optional, min = 0)]
    scene: Maybe<f32>,
}

/// Extensions that are understood.
const EXTENSIONS: [&str; 3] =
    ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform"];

impl Importer for Gltf<'_> {
    fn check(&self) -> Result<(), Fault> {
        check_unit(self.unit)
    }

    fn import(&self, context: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        let path = self.file.path.get();
        let fault = |message: String| Fault::file("file", format!("{path}: {message}"));
        let bytes = context.read(path).map_err(|message| vec![Fault::file("file", message)])?;
        let source = Source::open(path, &bytes, context)
            .map_err(|messages| messages.into_iter().map(fault).collect::<Vec<_>>())?;
        let mut build = Builder::new(&source, self.unit);
        let base = DAffine3::from_mat3(self.up.turn() * self.unit);
        if let Err(message) = nodes::walk(&mut build, self.scene.get(), base) {
            build.faults.push(message);
        }
        if build.faults.is_empty() {
            return Ok(build.out);
        }
        Err(build.faults.into_iter().map(fault).collect())
    }
}

/// The import as far as it has come.
struct Builder<'a> {
    source: &'a Source<'a>,
    /// Length of one unit of the file, m.
    unit: f64,
    out: Imported,
    /// All that is wrong with the file.
    faults: Vec<String>,
    materials: Materials,
    meshes: Meshes,
}

impl<'a> Builder<'a> {
    fn new(source: &'a Source<'a>, unit: f64) -> Self {
        let out = Imported { nodes: vec![], placed: vec![], warnings: source.warnings() };
        let (materials, meshes) = (Materials::default(), Meshes::default());
        Self { source, unit, out, faults: vec![], materials, meshes }
    }

    /// Adds a node; its place.
    fn add(
        &mut self,
        kind: Kind,
        class: &str,
        label: &str,
        params: Vec<(&'static str, ImportValue)>,
    ) -> usize {
        let (class, label) = (class.to_owned(), label.to_owned());
        let params = params.into_iter().map(|(name, value)| (name.into(), value)).collect();
        self.out.nodes.push(ImportNode { kind, class, label, params });
        self.out.nodes.len() - 1
    }

    /// Warns once of each thing.
    fn warn(&mut self, message: String) {
        if !self.out.warnings.contains(&message) {
            self.out.warnings.push(message);
        }
    }
}

/// A vector parameter.
fn vector(v: DVec3) -> ImportValue {
    ImportValue::Vector(v.to_array().to_vec())
}

/// A colour parameter.
fn rgb(c: [f32; 3]) -> ImportValue {
    ImportValue::Rgb(c.map(|x| if x.is_finite() { f64::from(x).max(0.0) } else { 0.0 }))
}
