//! The built-in plugins of kind shape.

mod axial;
mod r#box;
mod capsule;
mod cone;
mod csg;
mod curves;
mod cylinder;
mod disk;
mod ellipse;
mod gyroid_wall;
mod heightfield;
mod implicit;
mod mesh;
mod plane;
mod rectangle;
mod root;
mod sphere;
mod spherical;
#[cfg(test)]
mod testing;
mod torus;
pub(crate) mod up;

use glam::DVec3;
use luxel_sdk::abi::Class;
use luxel_sdk::num::{Bounds3, gamma64};
use luxel_sdk::params::Fault;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::shape::<sphere::Sphere>("sphere"),
    Class::shape::<rectangle::Rectangle>("rectangle"),
    Class::shape::<disk::Disk>("disk"),
    Class::shape::<r#box::Box>("box"),
    Class::shape::<cylinder::Cylinder>("cylinder"),
    Class::shape::<cone::Cone>("cone"),
    Class::shape::<capsule::Capsule>("capsule"),
    Class::shape::<torus::Torus>("torus"),
    Class::shape::<curves::Curves<'_>>("curves"),
    Class::shape::<plane::Plane>("plane"),
    Class::shape::<heightfield::Heightfield<'_>>("heightfield"),
    Class::shape::<mesh::Mesh<'_>>("mesh"),
    Class::shape::<gyroid_wall::GyroidWall<'_>>("gyroid_wall"),
    Class::shape::<csg::Union<'_>>("union"),
    Class::shape::<csg::Intersection<'_>>("intersection"),
    Class::shape::<csg::Difference<'_>>("difference"),
];

/// The box of half size `half` (≥ 0) about `centre`, with room for eight roundings of either.
fn bounds_about(centre: DVec3, half: DVec3) -> Bounds3 {
    let room = (centre.abs() + half) * gamma64(8);
    Bounds3 { min: centre - half - room, max: centre + half + room }
}

/// Longest length whose square, times that of a far point, is still a number.
const LONGEST: f64 = 1e75;

/// Refuses a length that is not above 0, or whose powers overflow.
fn check_length(field: &'static str, length: f64) -> Result<(), Fault> {
    if length > 0.0 && length <= LONGEST {
        return Ok(());
    }
    let message = if length > 0.0 {
        format!("{length:e} m: it is beyond every measure")
    } else {
        format!("{length} m: it must exceed 0")
    };
    Err(Fault::range(field, message))
}

/// Refuses a vector without a direction.
fn check_direction(field: &'static str, v: DVec3) -> Result<(), Fault> {
    let largest = v.abs().max_element();
    if largest > 0.0 && largest.is_finite() {
        return Ok(());
    }
    Err(Fault::range(field, format!("{v} has no direction")))
}
