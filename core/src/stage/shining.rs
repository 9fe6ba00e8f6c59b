//! Geometry that shines: how large it is, and whether its points can be chosen.

use luxel_sdk::num::Bounds3;
use luxel_sdk::sampling::{Alias, sobol_owen_2d};

use super::lights::Quad;
use super::{Geometry, Placement};
use crate::cast::index;
use crate::diag::{Diagnostic, Span};
use crate::object::{Object, carried_area};
use crate::scene::{NodeId, Scene};

/// Area in the world, m², and how a triangle of a mesh is chosen.
pub(super) fn measured(geometry: &Geometry, placement: &Placement) -> (f64, Option<Alias>) {
    let mesh = match geometry {
        Geometry::Analytic(shape) => return (world_area(shape.object(), placement), None),
        Geometry::Mesh(mesh) => mesh,
    };
    let area = |i: u32| {
        let [a, b, c] = mesh.opening_corners(i);
        let normal = (b - a).cross(c - a);
        let area = normal.length() / 2.0;
        if area > 0.0 { area * placement.area_scale(normal / (2.0 * area)) } else { 0.0 }
    };
    let areas: Vec<f64> = (0..index(mesh.triangles().indices.len())).map(area).collect();
    (areas.iter().sum(), Alias::new(&areas).ok())
}

/// The parallelogram of a shape that its placement shears.
pub(super) fn sheared(geometry: &Geometry, placement: &Placement) -> Option<Quad> {
    let Geometry::Analytic(shape) = geometry else { return None };
    Quad::new(shape.object().fixed().shape(), placement.place.first())
}

/// What is to be told of a shape that shines from so large an area.
pub(super) fn doubts(
    geometry: &Geometry,
    area: f64,
    (scene, shape): (&Scene, NodeId),
    span: Span,
) -> Option<Diagnostic> {
    if !area.is_finite() {
        return Some(endless(span, scene, shape, geometry.bounds()));
    }
    let Geometry::Analytic(object) = geometry else { return None };
    (!can_be_sampled(object.object())).then(|| unsampled(span, scene, shape))
}

/// Area of an analytic shape in the world.
fn world_area(shape: &Object, placement: &Placement) -> f64 {
    let shape = shape.fixed().shape();
    match placement.place.first() {
        Some(transform) => carried_area(shape, transform),
        None => shape.area(),
    }
}

/// Points that a shape is asked for before it is said to find none.
const SAMPLES: u32 = 1024;

/// Whether a shape finds points of its surface.
fn can_be_sampled(shape: &Object) -> bool {
    let shape = shape.fixed().shape();
    let found = |i| shape.sample(None, sobol_owen_2d(i, 0x5eed));
    (0..SAMPLES).any(|i| found(i).is_some())
}

/// A lamp whose surface no one can choose points of.
fn unsampled(span: Span, scene: &Scene, shape: NodeId) -> Diagnostic {
    let class = &scene.node(shape).class;
    let message = format!("a light on a `{class}` is found by chance alone: expect noise");
    Diagnostic::warning("E0417", span, message)
        .label(scene.node(shape).span, "has no points to be chosen")
        .help("a lamp of spheres, boxes, rectangles or a mesh is found by its light")
}

/// A surface that is to shine and has no end, or whose points nobody can choose.
fn endless(span: Span, scene: &Scene, shape: NodeId, bounds: Bounds3) -> Diagnostic {
    let class = &scene.node(shape).class;
    if bounds.diagonal().is_finite() {
        let message = format!("a light on `{class}`: points of it cannot be chosen at random");
        return Diagnostic::error("E0423", span, message)
            .label(scene.node(shape).span, "cannot shine")
            .help("use a shape that can: `cylinder`, `capsule`, `torus`, a `mesh`");
    }
    let message = format!("a light on a `{class}` without end: its area is infinite");
    Diagnostic::error("E0423", span, message)
        .label(scene.node(shape).span, "has no end")
        .help("use a `rectangle` or a `disk`, or `light constant` for light from everywhere")
}
