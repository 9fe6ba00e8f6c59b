//! The built-in plugins of kind light.

mod area;
mod constant;
mod directional;
mod distant;
mod environment;
mod point;
mod spot;
mod sun;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::light::<area::Area>("area"),
    Class::light::<point::Point>("point"),
    Class::light::<spot::Spot>("spot"),
    Class::light::<directional::Directional>("directional"),
    Class::light::<sun::Sun>("sun"),
    Class::light::<constant::Constant>("constant"),
    Class::light::<environment::Environment<'static>>("environment"),
];
