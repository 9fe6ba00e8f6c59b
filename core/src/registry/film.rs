//! The film: what is measured, and how it is shown. The host's own class.

use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Maybe, Text};
use luxel_sdk::{Choice, Params};

use crate::accel::Precision;

/// Which colour-matching functions turn spectra into colours.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Observer {
    /// CIE 1931, 2 degrees.
    Cie1931,
    /// CIE 1964, 10 degrees.
    Cie1964,
    /// CIE 2015, 2 degrees.
    Cie2015,
}

/// How radiance becomes the PNG's colours.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Display {
    /// sRGB's transfer function, clipped.
    Srgb,
    /// Linear, clipped.
    Linear,
    /// A filmic curve that rolls highlights off and keeps hues.
    Filmic,
}

/// The picture: its size, exposure and files. The name says how colour is carried: `auto` is `rgb`
/// where every colour of the scene is given as RGB and nothing depends on wavelength, else
/// `spectral`.
///
/// ```scene
/// film spectral { resolution = (512, 512), exposure = 9.5 EV }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub struct FilmSettings<'a> {
    /// Width and height in pixels.
    #[param(role = count, default = [640.0, 480.0], min = 1, max = 65536)]
    pub resolution: glam::Vec2,
    /// Exposure value at ISO 100 for the PNG: luminance 1.2·2^EV cd/m² is white. Without it a
    /// radiance of 1 W/m²/sr is white. The EXR is never exposed.
    #[param(optional, unit = "EV", min = -100, max = 100)]
    pub exposure: Maybe<f32>,
    /// The standard observer that turns spectra into colours.
    #[param(choice, default = Observer::Cie1931)]
    pub observer: Observer,
    /// How the PNG shows radiance.
    #[param(choice, default = Display::Srgb)]
    pub display: Display,
    /// How rays meet the triangles of meshes: `fast` may let them slip between two, `exact` does all
    /// of it in double precision.
    #[param(choice, default = Precision::Standard)]
    pub precision: Precision,
    /// When the shutter opens.
    #[param(unit = "s", default = 0.0)]
    pub time: f64,
    /// How long it stays open: what moves meanwhile is blurred, and no brighter. Without it the
    /// picture is that of one moment.
    #[param(unit = "s", default = 0.0, min = 0)]
    pub shutter: f64,
    /// Beside colour, how much of the light is scattered on where a path first arrives.
    #[param(default = false)]
    pub albedo: bool,
    /// Beside colour, the shading normal there, in the world.
    #[param(default = false)]
    pub normal: bool,
    /// Beside colour, the place itself, in the world, metres.
    #[param(default = false)]
    pub position: bool,
    /// Beside colour, how far it is, metres.
    #[param(default = false)]
    pub depth: bool,
    /// Beside colour, which material it has: numbers from 1, named in the EXR's attribute.
    #[param(default = false)]
    pub material_id: bool,
    /// Beside colour, which shape it is of: numbers from 1, named in the EXR's attribute.
    #[param(default = false)]
    pub object_id: bool,
    /// Beside colour, how far it moves over the picture while the shutter is open, pixels.
    #[param(default = false)]
    pub motion: bool,
    /// Beside colour, the steps that tracing a path takes, nodes and primitives, without those of shadow
    /// rays.
    #[param(default = false)]
    pub cost: bool,
    /// Where the EXR is written; the PNG stands beside it. The scene's name if absent.
    #[param(optional)]
    pub file: Text<'a>,
}

/// The film's classes: one struct, three ways of carrying colour.
pub(super) const CLASSES: &[Class] = &[
    Class::settings::<FilmSettings<'_>>(Kind::Film, "auto"),
    Class::settings::<FilmSettings<'_>>(Kind::Film, "rgb"),
    Class::settings::<FilmSettings<'_>>(Kind::Film, "spectral"),
];
