//! Plugins of the suite's own: what a scene under test needs besides the plugin that is judged.
//!
//! Each is the simplest of its kind that is right. They see the SDK alone, like any other plugin,
//! and are judged by the suite as well.

mod field;
mod light;
mod settings;
mod shape;
mod surface;

use luxel_sdk::abi::Class;

pub(crate) use field::{Even, Fog, Gradient};
pub(crate) use light::{Lamp, Sky};
pub(crate) use settings::{Block, Numbers, Pinhole, Walk, Way};
pub(crate) use shape::{Ball, Orb};
pub(crate) use surface::{Matt, Veil};

/// All of them. A medium without a phase function asks the registry for `isotropic`, so that one
/// has the name that the host expects.
pub const CLASSES: &[Class] = &[
    Class::shape::<Ball>("reference_ball"),
    Class::shape::<Orb>("reference_orb"),
    Class::material::<Matt>("reference_matt"),
    Class::material::<Veil>("reference_veil"),
    Class::texture::<Gradient>("reference_gradient"),
    Class::light::<Sky>("reference_sky"),
    Class::light::<Lamp>("reference_lamp"),
    Class::medium::<Fog<'static>>("reference_fog"),
    Class::phase::<Even>("isotropic"),
    Class::camera::<Pinhole>("reference_pinhole"),
    Class::sampler::<Numbers>("reference_numbers"),
    Class::filter::<Block>("reference_block"),
    Class::integrator::<Walk>("reference_walk"),
];
