use std::mem::MaybeUninit;
use std::sync::Arc;

use glam::DVec3;
use luxel_sdk::abi::{MeshSink, ShapeTable, Triangles};
use luxel_sdk::kind::{
    Hit, Later, NormalDerivatives, Parallelogram, Shape, ShapeSample, Surface, TriangleMesh,
};
use luxel_sdk::num::{Bounds3, Ray};

use super::Head;

/// A library's shape.
#[repr(transparent)]
pub(super) struct RemoteShape(Head);

// SAFETY: the SDK demands of shapes that they are `Send + Sync`.
unsafe impl Send for RemoteShape {}
// SAFETY: as above.
unsafe impl Sync for RemoteShape {}

impl RemoteShape {
    #[inline(always)]
    fn table(&self) -> &'static ShapeTable {
        // SAFETY: the view was made for shapes.
        unsafe { self.0.table() }
    }

    /// Whether a point is one: what a library gives is not taken on trust.
    #[inline(always)]
    fn is_usable(&self, surface: &Surface) -> bool {
        let Surface { p, p_err, ng, ns, uv, dp_du, .. } = surface;
        let finite = p.is_finite() && p_err.is_finite() && uv.is_finite() && dp_du.is_finite();
        if finite && ng.is_normalized() && ns.is_normalized() {
            return true;
        }
        self.0.wrong("gave a point of its surface that is not finite or has no unit normal");
        false
    }

    /// A box of numbers, or one of nothing.
    fn boxed(&self, found: Option<Bounds3>) -> Bounds3 {
        let bounds = found.unwrap_or(Bounds3::EMPTY);
        if !(bounds.min.is_nan() || bounds.max.is_nan()) {
            return bounds;
        }
        self.0.wrong("gave bounds that are no numbers");
        Bounds3::EMPTY
    }

    /// A hit within the limits of its ray.
    #[inline(always)]
    fn within(&self, ray: &Ray, Hit { t, at, face }: Hit) -> Option<Hit> {
        if t > 0.0 && t <= ray.t_max && at.is_finite() {
            return Some(Hit { t, at, face });
        }
        self.0.wrong("gave a hit beyond the ray's limits");
        None
    }
}

/// What a shape that has failed is left with.
pub(in super::super) const NOWHERE: Surface = Surface {
    p: DVec3::ZERO,
    p_err: DVec3::ZERO,
    ng: DVec3::Z,
    ns: DVec3::Z,
    uv: glam::DVec2::ZERO,
    dp_du: DVec3::X,
    dp_dv: DVec3::Y,
};

impl Shape for RemoteShape {
    fn bounds(&self) -> Bounds3 {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        self.boxed(self.0.found(unsafe { self.table().bounds(self.0.at()) }))
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if self.0.is_poisoned() {
            return None;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().intersect)(self.0.at(), ray, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: the library has written a result.
        self.within(ray, *unsafe { out.assume_init_ref() })
    }

    #[inline(always)]
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        if self.0.is_poisoned() {
            return NOWHERE;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().surface)(self.0.at(), ray, hit, &mut out) };
        if !self.0.is_ok(status) {
            if !self.0.is_poisoned() {
                self.0.wrong("gave a hit and no point of its surface");
            }
            return NOWHERE;
        }
        // SAFETY: the library has written a result.
        if !self.is_usable(unsafe { out.assume_init_ref() }) {
            return NOWHERE;
        }
        // SAFETY: as above.
        unsafe { out.assume_init() }
    }

    fn area(&self) -> f64 {
        // SAFETY: as above.
        let area = self.0.found(unsafe { self.table().area(self.0.at()) }).unwrap_or(0.0);
        if area >= 0.0 {
            return area;
        }
        self.0.wrong("gave an area that is negative or no number");
        0.0
    }

    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        if self.0.is_poisoned() {
            return None;
        }
        let mut out = MaybeUninit::<ShapeSample>::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().sample)(self.0.at(), from.as_ref(), &u, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: the library has written a result.
        let sample = unsafe { out.assume_init_ref() };
        if !(sample.pdf > 0.0 && sample.pdf < f64::INFINITY) {
            self.0.wrong("gave a sample whose density is not positive and finite");
            return None;
        }
        // SAFETY: as above.
        self.is_usable(&sample.surface).then(|| unsafe { out.assume_init() })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        if self.0.is_poisoned() {
            return 0.0;
        }
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().pdf(self.0.at(), from.as_ref(), at) });
        let pdf = found.unwrap_or(0.0);
        if pdf >= 0.0 && pdf.is_finite() {
            return pdf;
        }
        self.0.wrong("gave a density that is negative or not finite");
        0.0
    }

    fn is_closed(&self) -> bool {
        // SAFETY: as above.
        self.0.found(unsafe { self.table().is_closed(self.0.at()) }) == Some(1)
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: as above.
        let distance = self.0.found(unsafe { self.table().distance(self.0.at(), &p) })?;
        if !distance.is_nan() {
            return Some(distance);
        }
        self.0.wrong("gave a distance that is no number");
        None
    }

    fn parallelogram(&self) -> Option<Parallelogram> {
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().parallelogram(self.0.at()) })?;
        let Parallelogram { centre, u, v } = found;
        if centre.is_finite() && u.is_finite() && v.is_finite() {
            return Some(found);
        }
        self.0.wrong("gave a parallelogram that is not finite");
        None
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: as above.
        let found =
            self.0.found(unsafe { self.table().normal_derivatives(self.0.at(), hit, at) })?;
        if found.dn_du.is_finite() && found.dn_dv.is_finite() {
            return Some(found);
        }
        self.0.wrong("gave derivatives of a normal that are not finite");
        None
    }

    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        let mut copied: Option<Option<TriangleMesh>> = None;
        let mut sink = MeshSink { take: copy, owner: (&raw mut copied).cast() };
        // SAFETY: as above.
        self.0.found(unsafe { self.table().mesh(self.0.at(), &mut sink) })?;
        let mesh = copied?;
        if mesh.as_ref().is_none_or(|mesh| !fits_together(mesh)) {
            self.0.wrong("hands over triangles that are not finite or do not fit together");
            return None;
        }
        mesh.map(Arc::new)
    }

    fn parts(&self) -> u32 {
        // SAFETY: as above.
        self.0.found(unsafe { self.table().parts(self.0.at()) }).unwrap_or(0)
    }

    fn part_bounds(&self, part: u32) -> Bounds3 {
        if self.0.is_poisoned() {
            return Bounds3::EMPTY;
        }
        // SAFETY: as above.
        self.boxed(self.0.found(unsafe { self.table().part_bounds(self.0.at(), part) }))
    }

    #[inline(always)]
    fn intersect_part(&self, part: u32, ray: &Ray) -> Option<Hit> {
        if self.0.is_poisoned() {
            return None;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().intersect_part)(self.0.at(), part, ray, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: the library has written a result.
        self.within(ray, *unsafe { out.assume_init_ref() })
    }
}

/// What the tree over the triangles does not look at: one normal and one place for each corner, or
/// none, and numbers.
fn fits_together(mesh: &TriangleMesh) -> bool {
    let n = mesh.points.len();
    let per_corner = |len: usize| len == 0 || len == n;
    per_corner(mesh.normals.len())
        && per_corner(mesh.uvs.len())
        && per_corner(mesh.colors.len())
        && mesh.later.as_ref().is_none_or(|later| moves_well(mesh, later))
        && mesh.centre.is_finite()
        && mesh.normals.iter().all(|normal| normal.is_finite())
        && mesh.uvs.iter().all(|uv| uv.is_finite())
        && mesh.colors.iter().all(|color| color.is_finite())
}

/// Whether a mesh's second place has as much as its first, of numbers.
fn moves_well(mesh: &TriangleMesh, later: &Later) -> bool {
    let [from, to] = later.times;
    from.is_finite()
        && to.is_finite()
        && from < to
        && (to - from).is_finite()
        && later.points.iter().zip(&mesh.points).all(|(p, first)| (*p - *first).is_finite())
        && later.points.len() == mesh.points.len()
        && later.normals.len() == mesh.normals.len()
        && later.normals.iter().all(|normal| normal.is_finite())
}

/// Most corners or triangles that can be counted: a longer list is none.
const MOST: usize = u32::MAX as usize;

/// Takes triangles over, into the `Option` that the sink belongs to; none that cannot be counted.
unsafe extern "C" fn copy(owner: *mut u8, triangles: &Triangles) {
    // SAFETY: the sink's own owner.
    let out = unsafe { &mut *owner.cast::<Option<Option<TriangleMesh>>>() };
    let Triangles { points, indices, normals, uvs, colors, later_points, later_normals, .. } =
        triangles;
    let lists = [points.len(), indices.len(), normals.len(), uvs.len(), colors.len()];
    let last = [later_points.len(), later_normals.len()];
    if lists.into_iter().chain(last).any(|n| n > MOST) {
        *out = Some(None);
        return;
    }
    // SAFETY: the library lends its triangles to this call.
    let points = unsafe { triangles.points.get() };
    // SAFETY: as above.
    let indices = unsafe { triangles.indices.get() };
    // SAFETY: as above.
    let normals = unsafe { triangles.normals.get() };
    // SAFETY: as above.
    let uvs = unsafe { triangles.uvs.get() };
    // SAFETY: as above.
    let colors = unsafe { triangles.colors.get() };
    // SAFETY: as above.
    let last_points = unsafe { later_points.get() };
    // SAFETY: as above.
    let last_normals = unsafe { later_normals.get() };
    let later = (!last_points.is_empty()).then(|| Later {
        times: triangles.later_times.to_array(),
        points: last_points.to_vec(),
        normals: last_normals.to_vec(),
    });
    *out = Some(Some(TriangleMesh {
        centre: triangles.centre,
        points: points.to_vec(),
        indices: indices.to_vec(),
        normals: normals.to_vec(),
        uvs: uvs.to_vec(),
        colors: colors.to_vec(),
        later,
    }));
}
