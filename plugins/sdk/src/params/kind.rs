//! The kinds of plugin, by name: what handles and schemas speak of.

use std::fmt;

/// What a plugin is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum Kind {
    /// Geometry.
    Shape,
    /// How a surface scatters light.
    Material,
    /// A value that varies over a surface.
    Texture,
    /// A source of light.
    Light,
    /// What fills space.
    Medium,
    /// How a medium scatters light.
    Phase,
    /// Where pictures are taken from.
    Camera,
    /// Where random numbers come from.
    Sampler,
    /// How samples become pixels.
    Filter,
    /// How light is followed.
    Integrator,
    /// Bytes of another format into nodes of a scene.
    Importer,
    /// What is measured: resolution, colour mode, output. Provided by the host.
    Film,
}

impl Kind {
    /// Every kind with its word in a scene, in the order of `luxel list`.
    pub const ALL: [(Self, &'static str); 12] = [
        (Self::Shape, "shape"),
        (Self::Material, "material"),
        (Self::Texture, "texture"),
        (Self::Light, "light"),
        (Self::Medium, "medium"),
        (Self::Phase, "phase"),
        (Self::Camera, "camera"),
        (Self::Sampler, "sampler"),
        (Self::Filter, "filter"),
        (Self::Integrator, "integrator"),
        (Self::Importer, "asset"),
        (Self::Film, "film"),
    ];

    /// The word in a scene.
    pub fn word(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// The kind of a word.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == word).map(|(kind, _)| *kind)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}
