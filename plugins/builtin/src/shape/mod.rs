//! The built-in plugins of kind shape.

mod r#box;
mod cylinder;
mod disk;
mod rectangle;
mod sphere;
#[cfg(test)]
mod testing;

use glam::DVec3;
use luxel_sdk::abi::Class;
use luxel_sdk::num::{Bounds3, gamma64};

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::shape::<sphere::Sphere>("sphere"),
    Class::shape::<rectangle::Rectangle>("rectangle"),
    Class::shape::<disk::Disk>("disk"),
    Class::shape::<r#box::Box>("box"),
    Class::shape::<cylinder::Cylinder>("cylinder"),
];

/// The box of half size `half` (≥ 0) about `centre`, with room for eight roundings of either.
fn bounds_about(centre: DVec3, half: DVec3) -> Bounds3 {
    let room = (centre.abs() + half) * gamma64(8);
    Bounds3 { min: centre - half - room, max: centre + half + room }
}
