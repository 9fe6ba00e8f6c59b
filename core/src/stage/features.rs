//! What a scene requires and who requires it, so that nothing else is modelled.

use std::collections::BTreeMap;

use crate::diag::{Diagnostic, Span};
use crate::film::Layer;
use crate::object::ColorMode;
use crate::scene::{Color, Feature, Node, NodeId, Scene, Value};

use super::{ColorChoice, Film, Stage};

/// What chooses code when rays are followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked for on its own")]
pub struct Features {
    pub(super) media: bool,
    pub(super) open_surfaces: bool,
    pub(super) nested: bool,
    pub(super) motion: bool,
    pub(super) light_choice: bool,
}

impl Features {
    /// Something absorbs or scatters between surfaces.
    #[inline(always)]
    pub fn media(&self) -> bool {
        Feature::Media.is_compiled() && self.media
    }

    /// Refracting shapes may lie within each other.
    #[inline(always)]
    pub fn nested(&self) -> bool {
        Feature::Nested.is_compiled() && self.nested
    }

    /// Something moves while the shutter is open.
    #[inline(always)]
    pub fn motion(&self) -> bool {
        Feature::Motion.is_compiled() && self.motion
    }

    /// There are several lights, or triangles of one, to choose from.
    #[inline(always)]
    pub fn light_choice(&self) -> bool {
        Feature::LightChoice.is_compiled() && self.light_choice
    }

    /// Whether paths have to know what they are inside of.
    #[inline(always)]
    pub fn is_tracked(&self) -> bool {
        self.media() || self.nested()
    }

    /// Whether rays may pass surfaces on their way, some of which are only the boundary of a medium.
    #[inline(always)]
    pub fn is_open(&self) -> bool {
        Feature::OpenSurfaces.is_compiled() && self.open_surfaces || self.nested()
    }

    /// These, and those that a scene is to be rendered with in any case.
    pub(super) fn and_required(self, scene: &Scene) -> Self {
        Self {
            media: self.media || scene.is_required(Feature::Media),
            open_surfaces: self.open_surfaces || scene.is_required(Feature::OpenSurfaces),
            nested: self.nested || scene.is_required(Feature::Nested),
            motion: self.motion || scene.is_required(Feature::Motion),
            light_choice: self.light_choice || scene.is_required(Feature::LightChoice),
        }
    }
}

impl Stage {
    /// Whether a feature is modelled: the scene requires it and it is not dropped.
    pub fn needs(&self, feature: Feature) -> bool {
        self.of(self.needed, feature)
    }

    /// Whether the code for a feature runs: it is modelled, or was required from outside.
    pub fn has(&self, feature: Feature) -> bool {
        self.of(self.features, feature)
    }

    /// Whether the code of a feature that is modelled and cannot be dropped may be left out all the same,
    /// to measure what that code takes: there is a wrong picture without it, but one that takes as long
    /// in everything else.
    pub fn may_run_without(&self, feature: Feature) -> bool {
        match feature {
            Feature::OpenSurfaces => self.needed.open_surfaces,
            // In media it is not compiled apart, and of a lamp of triangles nothing would be looked for.
            Feature::LightChoice => {
                let Features { media, open_surfaces, nested, light_choice, .. } = self.needed;
                light_choice && !(media || open_surfaces || nested) && self.lights.is_first_whole()
            }
            _ => false,
        }
    }

    /// Leaves the code of such a feature out: shadow rays do not look for surfaces that only bound a
    /// medium, or one light alone is looked for.
    pub fn run_without(&mut self, feature: Feature) {
        match feature {
            _ if !self.may_run_without(feature) => {}
            Feature::OpenSurfaces => self.features.open_surfaces = false,
            Feature::LightChoice => self.features.light_choice = false,
            _ => {}
        }
    }

    fn of(&self, features: Features, feature: Feature) -> bool {
        match feature {
            Feature::Spectral => self.mode == ColorMode::Spectral,
            Feature::Media => features.media,
            Feature::OpenSurfaces => features.open_surfaces,
            Feature::Nested => features.nested,
            Feature::Motion => features.motion,
            Feature::LightChoice => features.light_choice,
            Feature::Layers => !(self.film.layers.is_empty() && self.lights.groups.is_empty()),
        }
    }
}

/// What a stage requires and this program has no code for: nothing, unless it was built to be measured.
pub(super) fn lacking(stage: &Stage) -> Option<Diagnostic> {
    let is_lacking = |feature: &Feature| !feature.is_compiled() && stage.needs(*feature);
    let missing = Feature::ALL.into_iter().find(is_lacking)?;
    let message = format!("this program was built without `{}`", missing.name());
    Some(
        Diagnostic::unplaced("E0414", message).help("it was built to measure what that code costs"),
    )
}

/// Which nodes require a feature, each with the place that says so.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reasons(BTreeMap<Feature, BTreeMap<NodeId, Span>>);

impl Reasons {
    /// Those of a feature that is modelled, in the order in which the scene made them. None where the
    /// shapes are too many to tell which of them lie within each other.
    pub fn of(&self, feature: Feature) -> impl Iterator<Item = (NodeId, Span)> + '_ {
        self.0.get(&feature).into_iter().flatten().map(|(id, span)| (*id, *span))
    }

    /// A node requires a feature; its first place counts.
    pub(super) fn add(&mut self, feature: Feature, id: NodeId, span: Span) {
        self.0.entry(feature).or_default().entry(id).or_insert(span);
    }

    /// Others, each where its node is written in this scene.
    pub(super) fn add_all(&mut self, others: &Self, scene: &Scene) {
        for (feature, ids) in &others.0 {
            for id in ids.keys() {
                self.add(*feature, *id, scene.node(*id).span);
            }
        }
    }

    /// The feature is not modelled after all.
    pub(super) fn clear(&mut self, feature: Feature) {
        self.0.remove(&feature);
    }

    /// The arguments, or the film, that ask for wavelengths, and the layers of the film.
    pub(super) fn add_settings(&mut self, scene: &Scene, (mode, film): (ColorMode, &Film)) {
        if let (Some(id), ColorChoice::Spectral) = (scene.film, film.color) {
            self.add(Feature::Spectral, id, scene.node(id).span);
        }
        for (id, node) in (0..).map(NodeId).zip(&scene.nodes) {
            if let Some(span) = spectrum(node) {
                self.add(Feature::Spectral, id, span);
            }
        }
        if let Some(id) = scene.film {
            let params = &scene.node(id).params;
            let is_layer = |name| Layer::of_name(name).is_some();
            for it in params.iter().filter(|it| is_layer(it.name) && it.value == Value::Bool(true))
            {
                self.add(Feature::Layers, id, it.span);
            }
        }
        if mode == ColorMode::Rgb {
            self.clear(Feature::Spectral);
        }
        if scene.leaves_out(Feature::Layers) {
            self.clear(Feature::Layers);
        }
    }
}

/// How colour is carried: as asked, or RGB only where every colour of the scene is given as RGB and
/// nothing depends on wavelength.
pub(super) fn color_mode(scene: &Scene, choice: ColorChoice) -> ColorMode {
    match choice {
        _ if scene.leaves_out(Feature::Spectral) => ColorMode::Rgb,
        ColorChoice::Spectral => ColorMode::Spectral,
        ColorChoice::Auto if scene.nodes.iter().any(|node| spectrum(node).is_some()) => {
            ColorMode::Spectral
        }
        ColorChoice::Rgb | ColorChoice::Auto => ColorMode::Rgb,
    }
}

/// Where a node says something by wavelength.
fn spectrum(node: &Node) -> Option<Span> {
    let by_wavelength = |value: &Value| match value {
        Value::Color(color, _) => is_spectral(color),
        _ => false,
    };
    Some(node.params.iter().find(|argument| by_wavelength(&argument.value))?.span)
}

fn is_spectral(color: &Color) -> bool {
    match color {
        Color::Rgb(_) | Color::Constant(_) => false,
        Color::Scaled(inner, _) => is_spectral(inner),
        _ => true,
    }
}
