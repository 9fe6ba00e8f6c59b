//! A closed mesh as a part of another shape.

use std::sync::Arc;

use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray};

use super::{Approach, Geometry, Mesh, enter};
use crate::accel::{Direction, Precision, Processor, Watch};

/// A mesh that intersects itself: its triangles in double precision, as analytic shapes are.
struct MeshPart {
    mesh: Geometry,
    bounds: Bounds3,
    area: f64,
}

/// Triangles with their tree as a shape, and the bytes of both.
///
/// # Errors
/// Why there is no tree.
pub(in super::super) fn mesh_part(
    triangles: Arc<TriangleMesh>,
    watch: &Watch,
) -> Result<(Arc<dyn Shape>, usize), String> {
    if triangles.later.is_some() {
        return Err("a mesh whose points move is no part of a solid".to_owned());
    }
    let mesh = Mesh::build(triangles, [0.0; 2], watch).map_err(|e| e.to_string())?;
    let triangles = 0..crate::cast::index(mesh.triangles().indices.len());
    let area = triangles.map(|i| mesh.area(i, 0.0, |edge| edge)).sum();
    let bytes = mesh.whole_bytes();
    let mesh = Geometry::Mesh(Arc::new(mesh));
    let bounds = mesh.bounds();
    Ok((Arc::new(MeshPart { mesh, bounds, area }), bytes))
}

impl Shape for MeshPart {
    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let direction = Direction::new(ray.d)?;
        let approach = Approach {
            processor: Processor::ANY,
            precision: Precision::Exact,
            direction: Some(&direction),
            t_enter: enter(&self.bounds, ray)?,
            from: None,
            time: 0.0,
        };
        let hit = self.mesh.intersect(ray, approach, &mut 0)?;
        (hit.t > 0.0 && hit.t <= ray.t_max).then_some(hit)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.mesh.surface(ray, hit, Precision::Exact, 0.0)
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        self.mesh.normal_derivatives(hit, at, 0.0)
    }

    fn area(&self) -> f64 {
        self.area
    }

    fn is_closed(&self) -> bool {
        self.mesh.is_closed()
    }
}
