use std::marker::PhantomData;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::table;
use crate::kind::{Hit, Later, NormalDerivatives, Parallelogram, Shape, ShapeSample, Surface};
use crate::num::{Bounds3, Ray};
use crate::wire::{Slice, expect};

/// Triangles that a shape hands over: lent for the call, the host copies them.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Triangles {
    /// What `points` are relative to, in the frame of the shape, metres.
    pub centre: DVec3,
    /// Corners about `centre`.
    pub points: Slice<Vec3>,
    /// Three corners each, counter-clockwise from outside.
    pub indices: Slice<[u32; 3]>,
    /// A unit shading normal per corner point, or none.
    pub normals: Slice<Vec3>,
    /// Texture coordinates per corner point, or none.
    pub uvs: Slice<Vec2>,
    /// A colour per corner point, linear sRGB, or none.
    pub colors: Slice<Vec3>,
    /// When the corners are at `points`, and when at `later_points`: seconds.
    pub later_times: DVec2,
    /// Where the corners are later, about `centre`; none if they stand.
    pub later_points: Slice<Vec3>,
    /// Their shading normals then, as many as `normals`.
    pub later_normals: Slice<Vec3>,
}

/// Where a shape's triangles go.
#[repr(C)]
pub struct MeshSink {
    /// Copies the triangles; `owner` comes first.
    pub take: unsafe extern "C" fn(*mut u8, &Triangles),
    /// The host's.
    pub owner: *mut u8,
}

impl MeshSink {
    fn take(&mut self, triangles: &Triangles) {
        // SAFETY: function and owner were made together by the host.
        unsafe { (self.take)(self.owner, triangles) }
    }
}

table! {
    /// Geometry in its own frame, in double precision.
    Shape => ShapeTable "luxel_shape_table" {
        /// A box that holds every point of the surface.
        fn bounds(shape) -> Bounds3 { Some(shape.bounds()) }
        /// The nearest hit with 0 < t <= ray->t_max; nothing where there is none.
        fn intersect(shape, ray: &Ray) -> Hit { shape.intersect(ray) }
        /// The point that a hit names.
        fn surface(shape, ray: &Ray, hit: &Hit) -> Surface { Some(shape.surface(ray, hit)) }
        /// Area in the frame of the shape, m²; infinite for one that cannot shine.
        fn area(shape) -> f64 { Some(shape.area()) }
        /// A point of the surface; `from` may be null.
        fn sample(shape, from: Option<&DVec3>, u: &[f32; 2]) -> ShapeSample {
            shape.sample(from.copied(), *u)
        }
        /// The density with which `sample` finds a point, m⁻².
        fn pdf(shape, from: Option<&DVec3>, point: &Surface) -> f64 {
            Some(shape.pdf(from.copied(), point))
        }
        /// Whether the surface encloses a volume: 1 or 0.
        fn is_closed(shape) -> u32 { Some(u32::from(shape.is_closed())) }
        /// Hands triangles over, and says how many; nothing for shapes that intersect themselves.
        fn mesh(shape, sink: &mut MeshSink) -> u64 {
            let mesh = shape.mesh()?;
            let none = Later::default();
            let later = mesh.later.as_ref().unwrap_or(&none);
            sink.take(&Triangles {
                centre: mesh.centre,
                points: Slice::new(&mesh.points),
                indices: Slice::new(&mesh.indices),
                normals: Slice::new(&mesh.normals),
                uvs: Slice::new(&mesh.uvs),
                colors: Slice::new(&mesh.colors),
                later_times: later.times.into(),
                later_points: Slice::new(&later.points),
                later_normals: Slice::new(&later.normals),
            });
            Some(mesh.indices.len() as u64)
        }
        /// How many parts it consists of, over which the host builds a tree; 0 for one all in one.
        fn parts(shape) -> u32 { Some(shape.parts()) }
        /// A box that holds every point of a part, counted from 0.
        fn part_bounds(shape, part: u32) -> Bounds3 { Some(shape.part_bounds(part)) }
        /// The nearest hit of one part.
        fn intersect_part(shape, part: u32, ray: &Ray) -> Hit { shape.intersect_part(part, ray) }
        /// At least how far away the surface is, negative inside; nothing where that is not known.
        fn distance(shape, p: &DVec3) -> f64 { shape.distance(*p) }
        /// The parallelogram that it is, where it is nothing else.
        fn parallelogram(shape) -> Parallelogram { shape.parallelogram() }
        /// How the shading normal turns at a point; nothing where that is not known.
        fn normal_derivatives(shape, hit: &Hit, point: &Surface) -> NormalDerivatives {
            shape.normal_derivatives(hit, point)
        }
    }
}

/// A shape of which another one is made, in the frame of that one.
///
/// It intersects itself: the host hands over no triangles as a part.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ShapeRef<'a> {
    pub(crate) table: &'a ShapeTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

// SAFETY: shapes are `Send + Sync`, and the handle borrows one.
unsafe impl Send for ShapeRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for ShapeRef<'_> {}

impl<'a> ShapeRef<'a> {
    /// Lends a shape.
    pub const fn new<S: Shape>(shape: &'a S) -> Self {
        let at = std::ptr::from_ref(shape).cast();
        Self { table: ShapeTable::of::<S>(), at, lent: PhantomData }
    }

    /// Lends the parameters at an address.
    ///
    /// # Safety
    /// They are those of a class with this table, and lent for `'a`.
    pub const unsafe fn from_raw(table: &'a ShapeTable, at: *const u8) -> Self {
        Self { table, at, lent: PhantomData }
    }
}

/// What stands for the point of a part that has none: its host has then told of a failure.
const NOWHERE: Surface = Surface {
    p: DVec3::ZERO,
    p_err: DVec3::ZERO,
    ng: DVec3::Z,
    ns: DVec3::Z,
    uv: DVec2::ZERO,
    dp_du: DVec3::X,
    dp_dv: DVec3::Y,
};

impl Shape for ShapeRef<'_> {
    fn bounds(&self) -> Bounds3 {
        // SAFETY: the handle lends what the table was made for.
        expect(unsafe { self.table.bounds(self.at) }).unwrap_or(Bounds3::EMPTY)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        // SAFETY: as above.
        expect(unsafe { self.table.intersect(self.at, ray) })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        // SAFETY: as above.
        expect(unsafe { self.table.surface(self.at, ray, hit) }).unwrap_or(NOWHERE)
    }

    fn area(&self) -> f64 {
        // SAFETY: as above.
        expect(unsafe { self.table.area(self.at) }).unwrap_or(f64::INFINITY)
    }

    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        // SAFETY: as above.
        expect(unsafe { self.table.sample(self.at, from.as_ref(), &u) })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        // SAFETY: as above.
        expect(unsafe { self.table.pdf(self.at, from.as_ref(), at) }).unwrap_or(0.0)
    }

    fn is_closed(&self) -> bool {
        // SAFETY: as above.
        expect(unsafe { self.table.is_closed(self.at) }) == Some(1)
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        // SAFETY: as above.
        expect(unsafe { self.table.distance(self.at, &p) })
    }

    fn parallelogram(&self) -> Option<Parallelogram> {
        // SAFETY: as above.
        expect(unsafe { self.table.parallelogram(self.at) })
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        // SAFETY: as above.
        expect(unsafe { self.table.normal_derivatives(self.at, hit, at) })
    }
}
