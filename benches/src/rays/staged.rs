//! A scene of one mesh, whose rays are traced as those of pictures are: through the whole stage.

use luxel_core::accel::{Precision, Processor, Work};
use luxel_core::files::MemoryFiles;
use luxel_core::stage::{Geometry, Leaving, Mesh, Rooms, SceneHit, Stage};
use luxel_sdk::num::Ray;

use super::knot::Soup;
use crate::scene::{linked, stage_with};

/// Rays that are made and traced at once.
const CHUNK: usize = 4096;

/// The scene of one mesh.
pub(super) struct Staged(Stage);

/// A ray, and the triangle that it leaves, if it starts on one.
pub(super) type Asked = (Ray, Option<u32>);

/// Whether rays wait for each other.
#[derive(Clone, Copy, Debug)]
pub(super) enum Way {
    OneByOne,
    SideBySide,
}

impl Way {
    pub(super) const ALL: [Self; 2] = [Self::OneByOne, Self::SideBySide];

    /// A name for people, behind another.
    pub(super) fn suffix(self) -> &'static str {
        match self {
            Self::OneByOne => "",
            Self::SideBySide => ", side by side",
        }
    }
}

impl Staged {
    /// # Errors
    /// If the scene does not build.
    pub(super) fn new(soup: &Soup, precision: Precision) -> Result<Self, String> {
        let text = format!(
            "scene 1\ncamera perspective {{ look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m,
                up = (0, 1, 0)), fov = 40 deg }}\n\
             film rgb {{ resolution = (8, 8), precision = \"{}\" }}\n\
             shape mesh {{ file = \"ball.ply\", unit = 1 m }}\n",
            precision.word()
        );
        let files = MemoryFiles::default().with("ball.ply", ply(soup));
        stage_with(&linked(), files, &text).map(Self)
    }

    /// The mesh.
    ///
    /// # Panics
    /// Never: the scene holds a mesh alone.
    pub(super) fn mesh(&self) -> &Mesh {
        let Geometry::Mesh(mesh) = &*self.0.geometries[0] else { panic!("the scene is a mesh") };
        mesh
    }

    /// How many of `n` rays, asked for by their numbers, meet something that counts.
    pub(super) fn count(
        &self,
        (processor, way): (Processor, Way),
        n: usize,
        mut ray: impl FnMut(usize) -> Asked,
        counts: impl Fn(&Asked, Option<SceneHit>) -> bool,
    ) -> usize {
        let mut found = 0;
        for first in (0..n).step_by(CHUNK) {
            let rays: Vec<Asked> = (first..n.min(first + CHUNK)).map(&mut ray).collect();
            let mut hits = vec![None; rays.len()];
            processor.run(Trace { stage: &self.0, way, rays: &rays, hits: &mut hits });
            found += rays.iter().zip(hits).filter(|(ray, hit)| counts(ray, *hit)).count();
        }
        found
    }
}

struct Trace<'a> {
    stage: &'a Stage,
    way: Way,
    rays: &'a [Asked],
    hits: &'a mut [Option<SceneHit>],
}

impl Work for Trace<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let Self { stage, way, rays, hits } = self;
        let leaving = |face: Option<u32>| face.map(|face| Leaving { placement: 0, face });
        match way {
            Way::OneByOne => {
                for ((ray, from), hit) in rays.iter().zip(hits) {
                    *hit = stage.opening().intersect(processor, ray, leaving(*from), &mut 0);
                }
            }
            Way::SideBySide => {
                let asked = rays.iter().map(|(ray, from)| (ray, leaving(*from), 0.0));
                let tell = |i: usize, hit, _| hits[i] = hit;
                stage.intersect_all(processor, asked, &mut Rooms::side_by_side(), tell);
            }
        }
    }
}

fn ply(soup: &Soup) -> Vec<u8> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nelement face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        soup.points.len(),
        soup.indices.len()
    );
    let mut bytes = header.into_bytes();
    bytes.extend(soup.points.iter().flat_map(glam::Vec3::to_array).flat_map(f32::to_le_bytes));
    for triangle in &soup.indices {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}
