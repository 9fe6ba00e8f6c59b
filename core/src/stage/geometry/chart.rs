//! Surface coordinates of triangles, and derivatives by them.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::TriangleMesh;

/// How surface coordinates differ from the first corner of a triangle to the others.
struct Chart {
    d1: DVec2,
    d2: DVec2,
}

impl Chart {
    /// Of a triangle with these edges from its first corner, and the derivatives of its points;
    /// `None` where points are no function of the coordinates.
    #[inline(always)]
    fn of(
        mesh: &TriangleMesh,
        corners: [usize; 3],
        edges: [DVec3; 2],
    ) -> Option<(Self, (DVec3, DVec3))> {
        if mesh.uvs.is_empty() {
            return None;
        }
        let [ta, tb, tc] = corners.map(|i| mesh.uvs[i].as_dvec2());
        let chart = Self { d1: tb - ta, d2: tc - ta };
        let (dp_du, dp_dv) = chart.derivatives(edges);
        let usable = dp_du.is_finite() && dp_dv.is_finite() && dp_du != DVec3::ZERO;
        usable.then_some((chart, (dp_du, dp_dv)))
    }

    /// Derivatives by the barycentrics of the second and the third corner as those by the coordinates
    /// (PBR4 §6.5.3).
    #[inline(always)]
    fn derivatives(&self, [x, y]: [DVec3; 2]) -> (DVec3, DVec3) {
        let Self { d1, d2 } = *self;
        let det = d1.perp_dot(d2);
        ((x * d2.y - y * d1.y) / det, (y * d1.x - x * d2.x) / det)
    }
}

/// Surface coordinates and the derivatives of the point by them; by barycentrics without.
#[inline(always)]
pub(super) fn parametrisation(
    mesh: &TriangleMesh,
    corners: [usize; 3],
    [a, b, c]: [DVec3; 3],
    w: [f64; 3],
) -> (DVec2, DVec3, DVec3) {
    let edges = [b - a, c - a];
    let uv = if mesh.uvs.is_empty() {
        DVec2::new(w[1], w[2])
    } else {
        let [ta, tb, tc] = corners.map(|i| mesh.uvs[i].as_dvec2());
        ta * w[0] + tb * w[1] + tc * w[2]
    };
    let (dp_du, dp_dv) = Chart::of(mesh, corners, edges).map_or((edges[0], edges[1]), |it| it.1);
    (uv, dp_du, dp_dv)
}

/// Derivatives by the barycentrics of the second and the third corner as those by what
/// `parametrisation` tells the point's by.
pub(in super::super) fn by_coordinates(
    mesh: &TriangleMesh,
    corners: [usize; 3],
    [a, b, c]: [DVec3; 3],
    barycentric: [DVec3; 2],
) -> (DVec3, DVec3) {
    let chart = Chart::of(mesh, corners, [b - a, c - a]);
    let [x, y] = barycentric;
    chart.map_or((x, y), |(chart, _)| chart.derivatives(barycentric))
}
