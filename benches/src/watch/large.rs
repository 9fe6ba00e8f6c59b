//! Large files, in memory, and lines of large scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use jpeg_encoder::{ColorType, Encoder};
use luxel_core::files::{FileError, Files, MemoryFiles};
use luxel_core::scene::Hash;
use luxel_sdk::sampling::Rng;

use super::subject::LARGE;
use crate::ply::grid;
use crate::process::{Luxel, read, scratch, write};

/// Columns and rows of the pictures: as many pixels as 4096 × 2048.
pub(super) const SIDE: u32 = 2896;
/// Those of the landscape whose tree is built: it takes long enough.
pub(super) const SMALL: u32 = 1024;
/// Nodes of the asset, and objects of the scenes and texts of many.
pub(super) const NODES: usize = 100_000;

/// What every scene has.
pub(super) const HEAD: &str = "scene 1
camera perspective { look = look_at(from = (0, 2, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (64, 36) }
";
/// What the pictures show: noise, as each pixel has one sample.
const SEEN: &str = "sampler independent { samples = 1 }
light area { shape = shape sphere { center = (0, 3, 0) m, radius = 1 m }, radiance = 9 W/m^2/sr }
light constant { radiance = 0.1 W/m^2/sr }
shape sphere { center = (0, 0.5, 0) m, radius = 50 cm }
shape rectangle { u = (9, 0, 0) m, v = (0, 0, -9) m }
";

/// Files in memory whose hashes are known: reading and hashing them are measured by themselves.
pub(super) struct Held {
    files: MemoryFiles,
    hashes: BTreeMap<PathBuf, Hash>,
}

impl Held {
    /// A mesh, pictures and an asset.
    ///
    /// # Errors
    /// The program's words.
    pub(super) fn large(luxel: &Luxel) -> Result<Self, String> {
        let none = Self { files: MemoryFiles::default(), hashes: BTreeMap::new() };
        let [_, small] = pictures(luxel, SMALL)?;
        let [exr, png] = pictures(luxel, SIDE)?;
        let files = none.with("large.ply", grid(LARGE)).with("seen.gltf", asset());
        let files = files.with("small.png", small).with("seen.png", png).with("seen.exr", exr);
        Ok(files.with("seen.jpg", jpeg(SIDE)?))
    }

    fn with(mut self, name: &str, bytes: Vec<u8>) -> Self {
        self.files = self.files.with(name, bytes);
        let hash = self.files.hash(Path::new(name)).expect("it has just been put there");
        self.hashes.insert(name.into(), hash);
        self
    }
}

impl Files for Held {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        self.files.read(path)
    }

    fn hash(&self, path: &Path) -> Option<Hash> {
        self.hashes.get(&self.canonical(path)).copied()
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        self.files.canonical(path)
    }
}

/// A ball of glass in a field of them.
pub(super) fn ball(i: usize) -> String {
    format!(
        "shape sphere {{ center = ({}, 1, {}) m, radius = r, material = material dielectric {{ }} }}\n",
        i % 300,
        i / 300
    )
}

/// A lamp in a field of them.
pub(super) fn lamp(i: usize) -> String {
    format!("light point {{ position = ({}, 1, {}) m, intensity = 1 W/sr }}\n", i % 300, i / 300)
}

/// A progressive picture in colours, of so many columns and rows.
fn jpeg(side: u32) -> Result<Vec<u8>, String> {
    let mut rng = Rng::new(7);
    let pixels: Vec<u8> = (0..3 * side * side).map(|_| rng.u32().to_le_bytes()[0]).collect();
    let mut out = vec![];
    let mut encoder = Encoder::new(&mut out, 90);
    encoder.set_progressive(true);
    let side = u16::try_from(side).map_err(|error| error.to_string())?;
    let encoded = encoder.encode(&pixels, side, side, ColorType::Rgb);
    encoded.map_err(|error| error.to_string()).map(|()| out)
}

/// A picture of this program's, as EXR and as PNG, of so many columns and rows.
fn pictures(luxel: &Luxel, side: u32) -> Result<[Vec<u8>; 2], String> {
    let scene = write("seen.scene", format!("{HEAD}{SEEN}").as_bytes())?;
    luxel.render(&scene, side, 1)?;
    let of = |name: &str| read(&scratch()?.join(name));
    Ok([of("picture.exr")?, of("picture.png")?])
}

/// A glTF file of many nodes, that refer to one triangle.
fn asset() -> Vec<u8> {
    let many = |one: &dyn Fn(usize) -> String| (0..NODES).map(one).collect::<Vec<_>>().join(",");
    let nodes = many(&|i| format!(r#"{{"mesh":0,"translation":[{i},0,0]}}"#));
    let roots = many(&|i| i.to_string());
    // The corners (0, 0, 0), (1, 0, 0) and (0, 1, 0).
    let buffer =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":36,"uri":"{buffer}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "nodes":[{nodes}],"scenes":[{{"nodes":[{roots}]}}],"scene":0}}"#
    );
    json.into_bytes()
}
