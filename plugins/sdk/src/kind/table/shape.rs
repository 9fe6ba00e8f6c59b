use glam::{DVec3, Vec2, Vec3};

use super::table;
use crate::kind::{Hit, Shape, ShapeSample, Surface};
use crate::num::{Bounds3, Ray};
use crate::wire::Slice;

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
        /// Area in the frame of the shape, m²; infinite for one without end.
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
            sink.take(&Triangles {
                centre: mesh.centre,
                points: Slice::new(&mesh.points),
                indices: Slice::new(&mesh.indices),
                normals: Slice::new(&mesh.normals),
                uvs: Slice::new(&mesh.uvs),
                colors: Slice::new(&mesh.colors),
            });
            Some(mesh.indices.len() as u64)
        }
    }
}
