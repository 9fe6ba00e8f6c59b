//! A scene that is edited: what its text and files say is chosen by a few numbers.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::ply::grid;
use crate::process::scratch;

/// Vertices along each side of the large mesh: 2 · 708² = 1,002,528 triangles.
pub(super) const LARGE: u32 = 709;
const SMALL: u32 = 33;
/// Instead of the large one: 2 · 64² = 8,192 triangles, whose tree takes several threads.
const MIDDLE: u32 = 65;

/// The golden section of 2³²: its multiples lie apart from each other, anywhere.
const GOLDEN: u32 = 0x9e37_79b9;

/// What can be edited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Camera,
    Material,
    Place,
    Texture,
    SmallMesh,
    LargeMesh,
    LastTriangle,
    Comment,
}

impl Kind {
    pub(super) const ALL: [Self; 8] = [
        Self::Camera,
        Self::Material,
        Self::Place,
        Self::Texture,
        Self::SmallMesh,
        Self::LargeMesh,
        Self::LastTriangle,
        Self::Comment,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Material => "material",
            Self::Place => "transform",
            Self::Texture => "texture, 256 x 256",
            Self::SmallMesh => "mesh of 2,048 triangles",
            Self::LargeMesh => "mesh of 1,002,528 triangles",
            Self::LastTriangle => "the same, its last triangle",
            Self::Comment => "comment",
        }
    }
}

/// How a file is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Emptied and written.
    InPlace,
    /// Written beside it, then renamed over it.
    Renamed,
}

/// A scene on the disk.
pub(super) struct Subject {
    folder: PathBuf,
    size: [u32; 2],
    samples: u32,
    /// How often each kind was edited.
    edits: [u32; Kind::ALL.len()],
    /// Vertices along each side of the large mesh.
    large: u32,
    /// The files of the large and the small mesh, if there is one.
    meshes: [Vec<u8>; 2],
}

impl Subject {
    /// Puts it into a folder of its own. Without `large` the larger mesh is small too.
    ///
    /// # Errors
    /// The system's words.
    pub(super) fn new(
        name: &str,
        size: [u32; 2],
        samples: u32,
        large: bool,
    ) -> Result<Self, String> {
        let folder = scratch()?.join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        let large = if large { LARGE } else { MIDDLE };
        let (edits, meshes) = ([0; Kind::ALL.len()], [grid(large), grid(SMALL)]);
        let mut subject = Self { folder, size, samples, edits, large, meshes };
        for kind in [Kind::LargeMesh, Kind::SmallMesh, Kind::Texture, Kind::Camera] {
            subject.write(kind, Way::InPlace)?;
        }
        Ok(subject)
    }

    pub(super) fn scene(&self) -> PathBuf {
        self.folder.join("a.scene")
    }

    pub(super) fn mesh(&self) -> PathBuf {
        self.folder.join("large.ply")
    }

    pub(super) fn texture(&self) -> PathBuf {
        self.folder.join("soil.hdr")
    }

    /// Edits and saves; the moment in which the save is done.
    ///
    /// # Errors
    /// The system's words.
    pub(super) fn edit(&mut self, kind: Kind, way: Way) -> Result<Instant, String> {
        self.edits[kind as usize] += 1;
        self.write(kind, way)
    }

    fn write(&mut self, kind: Kind, way: Way) -> Result<Instant, String> {
        let n = self.edits[kind as usize];
        match kind {
            Kind::Texture => put(&self.texture(), &soil(n), way),
            Kind::SmallMesh => self.write_mesh(1, n, "small.ply", way),
            Kind::LargeMesh => self.write_mesh(0, n, "large.ply", way),
            Kind::LastTriangle => {
                // The same corners, and other bytes at the end of the file.
                let corners = self.meshes[0].len() - 3 * size_of::<u32>();
                self.meshes[0][corners..].rotate_left(size_of::<u32>());
                put(&self.mesh(), &self.meshes[0], way)
            }
            _ => put(&self.scene(), self.text().as_bytes(), way),
        }
    }

    /// A corner is moved a little, each time another one, anywhere in the mesh.
    fn write_mesh(
        &mut self,
        which: usize,
        n: u32,
        name: &str,
        way: Way,
    ) -> Result<Instant, String> {
        let path = self.folder.join(name);
        let side = if which == 0 { self.large } else { SMALL };
        let mesh = &mut self.meshes[which];
        let end = b"end_header\n";
        let begins = mesh.windows(end.len()).position(|bytes| bytes == end);
        let corner = (u64::from(GOLDEN.wrapping_mul(n)) * u64::from(side * side)) >> 32;
        let before = 3 * usize::try_from(corner).map_err(|error| error.to_string())? + 1;
        let y = begins.ok_or("no header")? + end.len() + before * size_of::<f32>();
        mesh[y..y + size_of::<f32>()].copy_from_slice(&(1e-4 * n as f32).to_le_bytes());
        put(&path, mesh, way)
    }

    fn text(&self) -> String {
        let of = |kind: Kind| self.edits[kind as usize];
        let [w, h] = self.size;
        let z = 3.0 + 0.01 * f64::from(of(Kind::Camera) % 50);
        let rho = 0.3 + 0.01 * f64::from(of(Kind::Material) % 50);
        let x = 0.01 * f64::from(of(Kind::Place) % 50);
        format!(
            "scene 1
// {}
camera perspective {{ look = look_at(from = (0, 2, {z}) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}
film rgb {{ resolution = ({w}, {h}) }}
sampler sobol {{ samples = {} }}
light constant {{ radiance = 0.5 W/m^2/sr }}
light area {{ shape = shape sphere {{ center = (0, 5, 0) m, radius = 1 m }}, radiance = 9 W/m^2/sr }}
let soil = material diffuse {{ reflectance = texture image {{ file = \"soil.hdr\" }} }}
shape mesh \"waves\" {{ file = \"large.ply\", unit = 1 m, material = material diffuse {{ reflectance = {rho} }} }}
shape mesh \"small\" {{ file = \"small.ply\", unit = 20 cm, material = soil, transform = move(({x}, 0.5, 0.3) m) }}
shape sphere {{ center = (-0.5, 0.3, 0) m, radius = 25 cm, material = material conductor {{ eta = metal(\"Au\"), roughness = 0.2 }} }}
shape sphere {{ center = (0.5, 0.3, 0.5) m, radius = 20 cm, material = material dielectric {{}} }}
shape rectangle {{ center = (0, -0.1, 0) m, u = (4, 0, 0) m, v = (0, 0, -4) m, material = soil }}
",
            of(Kind::Comment),
            self.samples,
        )
    }
}

#[expect(clippy::disallowed_methods, reason = "a save as editors make it")]
pub(super) fn put(path: &Path, bytes: &[u8], way: Way) -> Result<Instant, String> {
    let told = |error: std::io::Error| format!("{}: {error}", path.display());
    let part = path.with_extension("part");
    let place = if way == Way::Renamed { &part } else { path };
    let mut file = File::create(place).map_err(told)?;
    file.write_all(bytes).map_err(told)?;
    let done = Instant::now();
    drop(file);
    if way == Way::InPlace {
        return Ok(done);
    }
    let done = Instant::now();
    std::fs::rename(part, path).map_err(told)?;
    Ok(done)
}

/// A Radiance picture of noise, 256 × 256, uncompressed.
fn soil(n: u32) -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 256 +X 256\n".to_vec();
    let mut rng = luxel_sdk::sampling::Rng::new(u64::from(n));
    bytes.extend((0..256 * 256).flat_map(|_| {
        let [a, b, c, _] = rng.u32().to_le_bytes();
        [a | 16, b | 16, c | 16, 128]
    }));
    bytes
}
