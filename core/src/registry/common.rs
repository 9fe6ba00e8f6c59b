//! Parameters that the host adds to every object of a kind.

use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Preset, Role, Type};

const fn handle(name: &'static str, kind: Kind, doc: &'static str) -> Param {
    Param {
        name,
        doc,
        ty: Type::Object(kind),
        unit: "",
        role: Role::Plain,
        default: Preset::Absent,
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
        choices: &[],
        group: "",
        required: false,
        textured: false,
        deprecated: "",
        offset: usize::MAX,
    }
}

const PRIORITY: Param = Param {
    ty: Type::Int,
    default: Preset::Numbers([0.0; 4]),
    min: 0.0,
    max: 1e6,
    ..handle(
        "priority",
        Kind::Shape,
        "Which counts where refracting shapes or media overlap: the highest; among equals the smaller.",
    )
};

const LIGHT: &[Param] = &[Param {
    ty: Type::Text,
    ..handle(
        "group",
        Kind::Light,
        "Lights of this name are recorded beside colour too, as layers that sum to the picture.",
    )
}];
const SHAPE: &[Param] = &[
    PRIORITY,
    handle("material", Kind::Material, "How the surface scatters; a group's material if absent."),
    handle("interior", Kind::Medium, "What fills a closed shape."),
];
const IMPORTER: &[Param] =
    &[handle("material", Kind::Material, "For shapes to which the file gives no material.")];
const MATERIAL: &[Param] =
    &[handle("interior", Kind::Medium, "What fills closed shapes of this material.")];

/// The parameters that the host adds to every object of this kind. A `transform` is not among
/// them: the language applies it to shapes, lights and groups itself.
pub fn common_params(kind: Kind) -> &'static [Param] {
    match kind {
        Kind::Shape => SHAPE,
        Kind::Light => LIGHT,
        Kind::Material => MATERIAL,
        Kind::Importer => IMPORTER,
        _ => &[],
    }
}
