//! Rays that meet a closed mesh where they leave it, offset and traced as a stage does it.

use glam::DVec2;
use luxel_core::accel::{Precision, Processor, Work};
use luxel_core::files::MemoryFiles;
use luxel_core::stage::{Geometry, Leaving, Mesh, Stage};
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::{uniform_sphere, uniform_triangle};

use super::knot::Soup;
use super::shots::Random;
use crate::errors::true_t;
use crate::scene::{linked, stage_with};

/// How many of `n` rays from a mesh meet the triangle that they leave, or one behind their origin.
///
/// # Errors
/// If the scene of the mesh does not build.
pub(super) fn count(
    soup: &Soup,
    (precision, processor): (Precision, Processor),
    n: usize,
) -> Result<usize, String> {
    let text = format!(
        "scene 1\ncamera perspective {{ look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m,
            up = (0, 1, 0)), fov = 40 deg }}\n\
         film rgb {{ resolution = (8, 8), precision = \"{}\" }}\n\
         shape mesh {{ file = \"ball.ply\", unit = 1 m }}\n",
        precision.word()
    );
    let files = MemoryFiles::default().with("ball.ply", ply(soup));
    let stage = stage_with(&linked(), files, &text)?;
    let Geometry::Mesh(mesh) = &*stage.geometries[0] else {
        return Err("the scene holds a mesh alone".to_owned());
    };
    let mut found = 0;
    processor.run(Leave { stage: &stage, mesh, precision, n, found: &mut found });
    Ok(found)
}

struct Leave<'a> {
    stage: &'a Stage,
    mesh: &'a Mesh,
    precision: Precision,
    n: usize,
    found: &'a mut usize,
}

impl Work for Leave<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let mut random = Random(98);
        for i in 0..self.n {
            let (face, at) = start(self.mesh, i, &mut random);
            let surface = self.mesh.surface(face, at, self.precision, 0.0);
            // To either side, every second ray close to the surface.
            let d = uniform_sphere([random.next(), random.next()]).as_dvec3().normalize();
            let height = d.dot(surface.ng) * if i % 2 == 0 { 1.0 } else { 1e-2 };
            let d = (d - surface.ng * d.dot(surface.ng) + surface.ng * height).normalize();
            let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
            let ray = Ray { o, d, t_max: f64::INFINITY };
            let from = Some(Leaving { placement: 0, face });
            let hit = self.stage.opening().intersect(processor, &ray, from, &mut 0);
            let is_self = |met: u32| met == face || true_t(self.mesh, &ray, met) <= 0.0;
            *self.found += usize::from(hit.is_some_and(|hit| is_self(hit.hit.face)));
        }
    }
}

/// A point of a triangle with an area: its first corner, one of its edges, or anywhere.
fn start(mesh: &Mesh, i: usize, random: &mut Random) -> (u32, DVec2) {
    let triangles = mesh.triangles();
    let face = loop {
        let face = random.below(triangles.indices.len());
        let face = u32::try_from(face).expect("the ball has 81,590 triangles");
        let [a, b, c] = triangles.corners(face);
        if (b - a).cross(c - a).length_squared() > 0.0 {
            break face;
        }
    };
    let [_, b, c] = uniform_triangle([random.next(), random.next()]).map(f64::from);
    let at = match i % 3 {
        0 => DVec2::ZERO,
        1 => DVec2::new(b, 0.0),
        _ => DVec2::new(b, c),
    };
    (face, at)
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
