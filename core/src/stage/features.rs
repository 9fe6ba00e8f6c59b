//! What a scene requires, so that nothing else is modelled.

use crate::object::ColorMode;
use crate::scene::{Color, Node, Scene, Value};

use super::ColorChoice;

/// What the render has to do for this scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked for on its own")]
pub struct Features {
    /// Something absorbs or scatters between surfaces.
    pub media: bool,
    /// Some surfaces are only the boundary of a medium.
    pub open_surfaces: bool,
    /// Refracting shapes may lie within each other.
    pub nested: bool,
    /// Something moves while the shutter is open.
    pub motion: bool,
}

impl Features {
    /// Whether paths have to know what they are inside of.
    #[inline(always)]
    pub fn is_tracked(&self) -> bool {
        self.media || self.nested
    }

    /// Whether rays may pass surfaces on their way.
    #[inline(always)]
    pub fn is_open(&self) -> bool {
        self.open_surfaces || self.nested
    }
}

/// How colour is carried: as asked, or RGB only where every colour of the scene is given as RGB and
/// nothing depends on wavelength.
pub(super) fn color_mode(scene: &Scene, choice: ColorChoice) -> ColorMode {
    match choice {
        ColorChoice::Spectral => ColorMode::Spectral,
        ColorChoice::Auto if scene.nodes.iter().any(has_spectrum) => ColorMode::Spectral,
        ColorChoice::Rgb | ColorChoice::Auto => ColorMode::Rgb,
    }
}

fn has_spectrum(node: &Node) -> bool {
    node.params.iter().any(|argument| match &argument.value {
        Value::Color(color, _) => is_spectral(color),
        _ => false,
    })
}

fn is_spectral(color: &Color) -> bool {
    match color {
        Color::Rgb(_) | Color::Constant(_) => false,
        Color::Scaled(inner, _) => is_spectral(inner),
        _ => true,
    }
}
