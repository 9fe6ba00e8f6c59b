//! Made-up classes: schemas without behaviour.

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Kind, MaterialRef, PhaseRef};
use luxel_sdk::params::{ComplexIor, Emission, File, Look, Maybe, ShapeSlot, Table, Text};
use luxel_sdk::{Choice, Params};

/// How facets are distributed.
#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum Facets {
    /// With long tails.
    Ggx,
    /// Normal slopes.
    Beckmann,
}

/// A ball.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Sphere {
    /// Its centre.
    #[param(default = [0.0; 3], unit = "m")]
    center: glam::DVec3,
    /// Its radius.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    radius: f64,
    /// The radius under its old name.
    #[param(optional, unit = "m", deprecated = "radius")]
    size: f64,
}

/// A parallelogram.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Rectangle {
    /// Its centre.
    #[param(default = [0.0; 3], unit = "m")]
    center: glam::DVec3,
    /// One edge.
    #[param(default = [1.0, 0.0, 0.0], unit = "m")]
    u: glam::DVec3,
    /// The other edge.
    #[param(default = [0.0, 0.0, 1.0], unit = "m")]
    v: glam::DVec3,
}

/// A box.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Cuboid {
    /// Its centre.
    #[param(default = [0.0; 3], unit = "m")]
    center: glam::DVec3,
    /// Its edges.
    #[param(default = [1.0; 3], unit = "m", min = 0)]
    size: glam::DVec3,
}

/// A cylinder.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Cylinder {
    /// The centre of its base.
    #[param(required, unit = "m")]
    base: glam::DVec3,
    /// Where it points.
    #[param(default = [0.0, 1.0, 0.0])]
    axis: glam::DVec3,
    /// Its radius.
    #[param(required, unit = "m", min = 0)]
    radius: f64,
    /// Its height.
    #[param(required, unit = "m", min = 0)]
    height: f64,
}

/// Triangles.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Mesh<'a> {
    /// Corners.
    #[param(required, unit = "m")]
    points: Table<'a>,
    /// Three corners each.
    #[param(required)]
    indices: Table<'a>,
}

/// A matt surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Diffuse {
    /// Fraction of light reflected.
    #[param(default = 0.5, role = reflectance, textured)]
    reflectance: Spectrum,
}

/// A metal.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Conductor {
    /// Index of refraction.
    #[param(required, role = complex_ior)]
    eta: ComplexIor,
    /// Roughness.
    #[param(default = 0.1, min = 0, max = 1, textured)]
    roughness: f32,
    /// Distribution.
    #[param(choice, default = Facets::Ggx)]
    distribution: Facets,
}

/// Glass.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Dielectric {
    /// Index of refraction.
    #[param(default = 1.5, role = ior)]
    ior: Spectrum,
    /// Roughness.
    #[param(default = 0.0, min = 0, max = 1)]
    roughness: f32,
}

/// One material over another.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Coated<'a> {
    /// What is coated.
    #[param(required)]
    base: MaterialRef<'a>,
}

/// An image: PNG, JPEG or EXR.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Image<'a> {
    /// The picture.
    #[param(required)]
    file: File<'a>,
    /// Its colour space.
    #[param(default = "srgb")]
    space: Text<'a>,
}

/// Fog.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Homogeneous<'a> {
    /// Extinction.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_t: Spectrum,
    /// Absorption.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_a: Spectrum,
    /// Scattering.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_s: Spectrum,
    /// Single-scattering albedo.
    #[param(default = 0.5, role = reflectance)]
    albedo: Spectrum,
    /// How it scatters.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

/// Henyey and Greenstein's lobe.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Lobe {
    /// Asymmetry.
    #[param(default = 0.0, min = -1, max = 1)]
    g: f32,
}

/// A point that shines.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Point {
    /// Where it is.
    #[param(default = [0.0; 3], unit = "m")]
    position: glam::DVec3,
    /// Its light.
    #[param(emission(power, intensity))]
    spectrum: Emission,
}

/// A cone of light.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Spot {
    /// Where it stands and points.
    #[param(required)]
    look: Look,
    /// Half the opening angle.
    #[param(default = 0.5, unit = "rad", min = 0, max = 3.2)]
    cone: f32,
    /// The soft edge.
    #[param(default = 0.1, unit = "rad", min = 0)]
    falloff: f32,
    /// Its light.
    #[param(emission(power, intensity))]
    spectrum: Emission,
}

/// A shape that shines.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Area {
    /// The shape.
    #[param(required)]
    shape: ShapeSlot,
    /// Its light.
    #[param(emission(scale, power, radiance))]
    spectrum: Emission,
}

/// Light from one direction.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Sun {
    /// Towards the sun.
    #[param(required)]
    direction: glam::DVec3,
    /// Its light.
    #[param(emission(illuminance))]
    spectrum: Emission,
}

/// The same light from everywhere.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Constant {
    /// Its light.
    #[param(emission(scale, radiance))]
    spectrum: Emission,
}

/// A picture of everywhere.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Environment<'a> {
    /// The picture.
    #[param(required)]
    file: File<'a>,
    /// Factor.
    #[param(default = 1.0, min = 0)]
    scale: f32,
}

/// An ordinary camera, and a lens.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Perspective<'a> {
    /// Where it stands.
    #[param(required)]
    look: Look,
    /// Vertical field of view.
    #[param(optional, unit = "rad", min = 0, max = 3.1)]
    fov: Maybe<f32>,
    /// Focal length.
    #[param(optional, unit = "m")]
    focal_length: Maybe<f32>,
    /// Size of the sensor.
    #[param(default = [0.036, 0.024], unit = "m")]
    sensor: glam::Vec2,
    /// Focal length over opening.
    #[param(optional, min = 0)]
    f_number: Maybe<f32>,
    /// Distance that is sharp.
    #[param(optional, unit = "m")]
    focus: Maybe<f32>,
    /// A name.
    #[param(optional)]
    name: Text<'a>,
}

/// Paths.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Path {
    /// Most segments.
    #[param(default = 64, min = 1)]
    max_depth: u32,
    /// First segment that may end by chance.
    #[param(default = 3)]
    russian_roulette_from: u32,
}

/// Low-discrepancy points.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Sobol {
    /// Per pixel.
    #[param(default = 64, min = 1)]
    samples: u32,
    /// Another order.
    #[param(default = 0)]
    seed: u32,
}

/// A file of another format.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Asset<'a> {
    /// The file.
    #[param(required)]
    file: File<'a>,
    /// How long its unit is.
    #[param(required, unit = "m", min = 0)]
    unit: f64,
    /// Which way is up.
    #[param(default = "y")]
    up: Text<'a>,
    /// The material of everything in it.
    #[param(optional)]
    material: MaterialRef<'a>,
}

/// The registry that the tests evaluate against.
pub(crate) fn registry() -> Registry {
    let mut registry = Registry::new();
    registry
        .add(
            "tests",
            &[
                Class::settings::<Sphere>(Kind::Shape, "sphere"),
                Class::settings::<Rectangle>(Kind::Shape, "rectangle"),
                Class::settings::<Cuboid>(Kind::Shape, "box"),
                Class::settings::<Cylinder>(Kind::Shape, "cylinder"),
                Class::settings::<Mesh<'_>>(Kind::Shape, "mesh"),
                Class::settings::<Diffuse>(Kind::Material, "diffuse"),
                Class::settings::<Conductor>(Kind::Material, "conductor"),
                Class::settings::<Dielectric>(Kind::Material, "dielectric"),
                Class::settings::<Coated<'_>>(Kind::Material, "coated"),
                Class::settings::<Image<'_>>(Kind::Texture, "image"),
                Class::settings::<Homogeneous<'_>>(Kind::Medium, "homogeneous"),
                Class::settings::<Lobe>(Kind::Phase, "henyey_greenstein"),
                Class::settings::<Point>(Kind::Light, "point"),
                Class::settings::<Spot>(Kind::Light, "spot"),
                Class::settings::<Area>(Kind::Light, "area"),
                Class::settings::<Sun>(Kind::Light, "sun"),
                Class::settings::<Constant>(Kind::Light, "constant"),
                Class::settings::<Environment<'_>>(Kind::Light, "environment"),
                Class::settings::<Perspective<'_>>(Kind::Camera, "perspective"),
                Class::settings::<Path>(Kind::Integrator, "path"),
                Class::settings::<Sobol>(Kind::Sampler, "sobol"),
                Class::settings::<Asset<'_>>(Kind::Importer, "gltf"),
                Class::settings::<Asset<'_>>(Kind::Importer, "obj"),
            ],
        )
        .expect("each class stands once");
    registry.add_library("velvet", "1.2.3", &[]).expect("it has no class");
    registry.add_library("gyroid", "0.4.0-beta.1", &[]).expect("it has no class");
    registry
}
