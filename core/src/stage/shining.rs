//! Geometry that shines: how large it is, and whether its points can be chosen.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;
use luxel_sdk::num::{Bounds3, Transform};
use luxel_sdk::sampling::{Alias, sobol_owen_2d};

use super::lights::{Facets, LightSource, Quad};
use super::{Geometry, Placement, Stage};
use crate::cast::index;
use crate::diag::{Diagnostic, Span};
use crate::object::{Object, carried_area};
use crate::scene::{NodeId, Scene};

/// What shines by the triangles of a mesh in the stage before: how those are chosen depends on nothing
/// but the mesh and where it stands.
#[derive(Default)]
pub(super) struct Lamps<'a>(HashMap<Standing, (f64, &'a Arc<Facets>), foldhash::fast::RandomState>);

/// A geometry by its address, and the bits of the transform to the world.
type Standing = (usize, Option<[u64; 12]>);

fn standing(geometry: &Arc<Geometry>, placement: &Placement) -> Option<Standing> {
    let is_moving = match &**geometry {
        Geometry::Mesh(mesh) => mesh.is_moving(),
        Geometry::Analytic(_) => true,
    };
    let bits = |place: &Transform| place.affine().to_cols_array().map(f64::to_bits);
    let place = &placement.place;
    let stands = !(is_moving || place.is_moving());
    stands.then(|| (Arc::as_ptr(geometry).addr(), place.first().map(bits)))
}

impl<'a> Lamps<'a> {
    /// Those of a stage, which holds their geometries for as long as these are known by their address.
    pub(super) fn of(stage: &'a Stage) -> Self {
        let of = |source: &'a LightSource| {
            let LightSource::Surface { placement, area, triangles, .. } = source else {
                return None;
            };
            let placement = &stage.placements[*placement as usize];
            let geometry = &stage.geometries[placement.geometry as usize];
            Some((standing(geometry, placement)?, (*area, triangles.as_ref()?)))
        };
        Self(stage.lights.sources.iter().filter_map(of).collect())
    }
}

/// Area in the world, m², and the triangles of a mesh.
pub(super) fn measured(
    geometry: &Arc<Geometry>,
    placement: &Placement,
    [open, close]: [f64; 2],
    lamps: &Lamps<'_>,
) -> (f64, Option<Arc<Facets>>) {
    let mesh = match &**geometry {
        Geometry::Analytic(shape) => return (world_area(shape.object(), placement), None),
        Geometry::Mesh(mesh) => mesh,
    };
    let known = standing(geometry, placement).and_then(|it| lamps.0.get(&it));
    if let Some((area, facets)) = known {
        return (*area, Some((*facets).clone()));
    }
    let triangles = 0..index(mesh.triangles().indices.len());
    let areas = |time: f64| -> Vec<f64> {
        let mut room = None;
        let transform = placement.place.at(time, &mut room);
        let edge = |v: DVec3| transform.map_or(v, |transform| transform.vector(v));
        triangles.clone().map(|i| mesh.area(i, time, edge)).collect()
    };
    let first = areas(open);
    let area = first.iter().sum();
    if placement.place.is_moving() || mesh.is_moving() {
        // What is flat at one time may shine at another.
        let others = [areas(0.5 * open + 0.5 * close), areas(close)];
        let all = first.iter().zip(&others[0]).zip(&others[1]);
        let mean: Vec<f64> = all.map(|((a, b), c)| (a + b + c) / 3.0).collect();
        return (area, Alias::new(&mean).ok().map(|choice| Facets::new(choice, None).into()));
    }
    let transform = placement.place.first();
    let world = |p: DVec3| transform.map_or(p, |transform| transform.point(p));
    let corners: Vec<_> = triangles.map(|i| mesh.opening_corners(i).map(world)).collect();
    (area, Alias::new(&first).ok().map(|choice| Facets::new(choice, Some(&corners)).into()))
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
