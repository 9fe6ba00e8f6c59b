//! Shapes of which another one is made, and how they stand in the frame of that one.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use luxel_sdk::kind::{
    Hit, Kind, NormalDerivatives, Shape, ShapeRef, ShapeSample, Surface, TriangleMesh,
};
use luxel_sdk::num::{Bounds3, Ray, Transform};
use luxel_sdk::params::Param;

use super::build::Builder;
use super::draft::Draft;
use super::shelf::Kept;
use super::{Object, carried_area};
use crate::cast;
use crate::diag::Diagnostic;
use crate::registry::common_params;
use crate::scene::NodeId;

/// Bits of a hit's face: what a shape that is made of others shares with them.
const FACE_BITS: u32 = 32;
/// Of these a shape of one piece takes at most so many; one of parts two more than their number has.
pub(super) const OWN_BITS: u32 = 16;

impl Builder<'_> {
    /// A shape of which this one is made. What it looks like, the whole says.
    pub(super) fn part(
        &mut self,
        draft: &mut Draft,
        param: &Param,
        id: NodeId,
        place: Option<&DAffine3>,
    ) -> Result<(), String> {
        let (node, name) = (self.scene.node(id), param.name);
        for added in common_params(Kind::Shape) {
            if let Some(own) = node.get(added.name) {
                let what = added.name;
                let message = format!("a shape that is a part of another has no `{what}`");
                let help = format!("give the `{what}` to the whole");
                self.diagnostics.push(Diagnostic::error("E0402", own.span, message).help(help));
            }
        }
        let transform = place
            .map(|place| {
                let found = Transform::new(*place);
                found.ok_or_else(|| {
                    format!("`{name}`: its transform is singular: it flattens space")
                })
            })
            .transpose()?;
        let Some(child) = self.part_of(draft, id) else { return Ok(()) };
        let (body, bits) = match child.fixed().shape().mesh() {
            None => {
                let parts = child.fixed().shape().parts();
                let bits = u32::BITS - parts.leading_zeros() + 2;
                (Body::Object(child.clone()), child.face_bits.max(bits))
            }
            Some(triangles) => {
                let bits = u32::BITS - cast::index(triangles.indices.len()).leading_zeros();
                let tree = self.tree(id, &child, triangles);
                (Body::Triangles(tree.map_err(|why| format!("`{name}`: {why}"))?), bits)
            }
        };
        draft.face_bits = draft.face_bits.max(bits + 1);
        draft.part(param.offset, body, transform);
        draft.parts.push(child);
        if draft.face_bits > FACE_BITS {
            let deepest = FACE_BITS - OWN_BITS;
            return Err(format!("`{name}`: shapes stand in one another more than {deepest} deep"));
        }
        Ok(())
    }
}

impl Builder<'_> {
    /// The tree of a mesh that is a part, which does not depend on what it is a part of.
    fn tree(
        &mut self,
        id: NodeId,
        child: &Arc<Object>,
        triangles: Arc<TriangleMesh>,
    ) -> Result<Arc<dyn Shape>, String> {
        if let Some(known) = self.known_tree(id, child) {
            return Ok(known.shape);
        }
        let make = self.mesh_parts.ok_or("triangles cannot be a part here")?;
        let (shape, bytes) = make(triangles)?;
        let tree = PartTree { of: child.clone(), shape: shape.clone(), bytes };
        self.objects.trees.put(self.scene.own_hash(id), tree);
        self.objects.trees_made += 1;
        Ok(shape)
    }

    /// Keeps a part of what is kept, with its tree.
    pub(super) fn keep_part(&mut self, id: NodeId) {
        if let Some(child) = self.build(id) {
            self.known_tree(id, &child);
        }
    }

    /// The tree of a mesh, if there is one, for this build and the next.
    fn known_tree(&mut self, id: NodeId, child: &Arc<Object>) -> Option<PartTree> {
        let hash = self.scene.own_hash(id);
        let known = self.objects.trees.all(hash).chain(self.before.trees.all(hash));
        let known = known.into_iter().find(|tree| Arc::ptr_eq(&tree.of, child)).cloned()?;
        self.objects.trees.put(hash, known.clone());
        Some(known)
    }
}

impl Draft {
    /// Analytic shapes that stand in the frame of the whole are their own handles.
    fn part(&mut self, offset: usize, body: Body, transform: Option<Transform>) {
        if let (Body::Object(child), None) = (&body, transform) {
            return self.block.write_raw(offset, child.fixed().handle());
        }
        let moved = Arc::new(Moved::new(body, transform.unwrap_or(Transform::IDENTITY)));
        // It stays where it is for as long as the object owns it.
        self.block.write_raw(offset, ShapeRef::new(&*moved));
        self.owned.push(moved);
    }
}

/// How triangles become a shape that intersects itself, and how many bytes it and they take.
///
/// # Errors
/// Why they cannot.
pub type MeshParts<'a> = &'a dyn Fn(Arc<TriangleMesh>) -> Result<(Arc<dyn Shape>, usize), String>;

/// A mesh that is a part of other shapes, with its tree.
#[derive(Clone)]
pub(super) struct PartTree {
    /// The mesh: what has its triangles.
    of: Arc<Object>,
    shape: Arc<dyn Shape>,
    bytes: usize,
}

impl Kept for PartTree {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.of, &other.of)
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

impl fmt::Debug for PartTree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tree of {:?}", self.of)
    }
}

/// What a part is.
enum Body {
    Object(Arc<Object>),
    Triangles(Arc<dyn Shape>),
}

/// A shape with a transform of its own.
struct Moved {
    body: Body,
    transform: Transform,
    /// The least by which the transform stretches: distances grow by no less.
    least: f64,
}

impl Moved {
    fn new(body: Body, transform: Transform) -> Self {
        // The inverse stretches by no more than the root of the sum of its squares.
        let inverse = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| transform.inverse_vector(axis));
        let most = if transform.is_rigid_or_uniform() {
            inverse.map(DVec3::length).into_iter().fold(0.0, f64::max)
        } else {
            inverse.map(DVec3::length_squared).iter().sum::<f64>().sqrt()
        };
        // Rounding must not make distances too long.
        let least = (1.0 - 64.0 * f64::EPSILON) / most;
        Self { body, transform, least }
    }

    fn shape(&self) -> &dyn Shape {
        match &self.body {
            Body::Object(object) => object.fixed().shape(),
            Body::Triangles(tree) => &**tree,
        }
    }

    /// A point of the outer frame in the shape's own: what `Surface::carried` takes back.
    fn own(&self, s: &Surface) -> Surface {
        let transform = &self.transform;
        let turn = if transform.swaps_handedness() { -1.0 } else { 1.0 };
        Surface {
            p: transform.inverse_point(s.p),
            ng: transform.inverse_normal(s.ng).normalize(),
            ns: transform.inverse_normal(s.ns).normalize(),
            dp_du: transform.inverse_vector(s.dp_du),
            dp_dv: transform.inverse_vector(s.dp_dv) * turn,
            ..*s
        }
    }
}

impl Shape for Moved {
    fn bounds(&self) -> Bounds3 {
        self.shape().bounds().transform(self.transform.affine())
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.shape().intersect(&self.transform.inverse_ray(ray))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.shape().surface(&self.transform.inverse_ray(ray), hit).carried(&self.transform)
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let own = self.own(at);
        Some(self.shape().normal_derivatives(hit, &own)?.carried(own.ns, &self.transform))
    }

    fn area(&self) -> f64 {
        carried_area(self.shape(), &self.transform)
    }

    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let from = from.map(|p| self.transform.inverse_point(p));
        let sample = self.shape().sample(from, u)?;
        let pdf = sample.pdf / self.transform.area_scale(sample.surface.ng);
        Some(ShapeSample { surface: sample.surface.carried(&self.transform), pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        let (from, own) = (from.map(|p| self.transform.inverse_point(p)), self.own(at));
        self.shape().pdf(from, &own) / self.transform.area_scale(own.ng)
    }

    fn is_closed(&self) -> bool {
        self.shape().is_closed()
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        Some(self.shape().distance(self.transform.inverse_point(p))? * self.least)
    }
}
