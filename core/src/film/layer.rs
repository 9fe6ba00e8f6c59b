//! What else a picture may hold: what each pixel's paths met first, and what they cost.

/// Something that is recorded beside colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// How much of the light is scattered on, as linear sRGB: what leaves over what arrives. Of
    /// integrators that scatter; black where light ends.
    Albedo,
    /// Shading normal, world space; shorter than 1 where a pixel sees several.
    Normal,
    /// World space, metres.
    Position,
    /// Distance from where the ray begins, metres.
    Depth,
    /// Number of the material from 1, of the first sample; 0 for none.
    Material,
    /// Number of the shape in its place from 1, of the first sample; 0 for none.
    Object,
    /// From where a place is seen as the shutter opens to where as it closes, pixels.
    Motion,
    /// Steps of tracing, nodes and primitives, of the whole path.
    Cost,
}

/// One number of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// In the EXR.
    pub name: &'static str,
    /// How samples become a pixel's.
    pub(crate) of: Of,
}

impl Channel {
    /// Whether it says which, and not how much.
    pub fn is_number(&self) -> bool {
        self.of == Of::First
    }
}

/// How samples become a pixel's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    /// Mean over all samples.
    All,
    /// Mean over the samples that met something; 0 where none did.
    Met,
    /// That of the first sample.
    First,
}

const fn channel(name: &'static str, of: Of) -> Channel {
    Channel { name, of }
}

/// How many of the samples met something: recorded with any layer, before all others.
pub(crate) const COVERAGE: Channel = channel("coverage.A", Of::All);

impl Layer {
    /// All of them, in the order of a film's.
    pub const ALL: [Self; 8] = [
        Self::Albedo,
        Self::Normal,
        Self::Position,
        Self::Depth,
        Self::Material,
        Self::Object,
        Self::Motion,
        Self::Cost,
    ];

    /// As the film's parameter is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Position => "position",
            Self::Depth => "depth",
            Self::Material => "material_id",
            Self::Object => "object_id",
            Self::Motion => "motion",
            Self::Cost => "cost",
        }
    }

    /// The layer of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|layer| layer.name() == name)
    }

    /// Its numbers.
    pub fn channels(self) -> &'static [Channel] {
        const ALBEDO: &[Channel] = &[
            channel("albedo.R", Of::All),
            channel("albedo.G", Of::All),
            channel("albedo.B", Of::All),
        ];
        const NORMAL: &[Channel] = &[
            channel("normal.X", Of::Met),
            channel("normal.Y", Of::Met),
            channel("normal.Z", Of::Met),
        ];
        const POSITION: &[Channel] = &[
            channel("position.X", Of::Met),
            channel("position.Y", Of::Met),
            channel("position.Z", Of::Met),
        ];
        const DEPTH: &[Channel] = &[channel("depth.Z", Of::Met)];
        const MATERIAL: &[Channel] = &[channel("material.ID", Of::First)];
        const OBJECT: &[Channel] = &[channel("object.ID", Of::First)];
        const MOTION: &[Channel] = &[channel("motion.X", Of::Met), channel("motion.Y", Of::Met)];
        const COST: &[Channel] = &[channel("cost.steps", Of::All)];
        match self {
            Self::Albedo => ALBEDO,
            Self::Normal => NORMAL,
            Self::Position => POSITION,
            Self::Depth => DEPTH,
            Self::Material => MATERIAL,
            Self::Object => OBJECT,
            Self::Motion => MOTION,
            Self::Cost => COST,
        }
    }
}

/// The channels of some layers, coverage first; none of none.
pub(crate) fn channels(layers: &[Layer]) -> Vec<Channel> {
    let all = layers.iter().flat_map(|layer| layer.channels()).copied();
    let coverage = (!layers.is_empty()).then_some(COVERAGE);
    coverage.into_iter().chain(all).collect()
}

/// A pixel's number, of the sum over `n` samples of which `met` met something.
pub(crate) fn resolve(channel: Channel, sum: f64, (n, met): (f64, f64)) -> f64 {
    match channel.of {
        Of::All if n > 0.0 => sum / n,
        Of::Met if met > 0.0 => sum / met,
        Of::First => sum,
        Of::All | Of::Met => 0.0,
    }
}
