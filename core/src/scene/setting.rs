//! What a scene has at most once, and how it is replaced from outside.

use glam::UVec2;
use luxel_sdk::kind::Kind;

use super::{Argument, Arguments, Node, NodeId, Scene, Value};
use crate::accel::Precision;
use crate::diag::{SourceId, Span};
use crate::film::Layer;

/// What decides how a picture is measured, whatever the scene shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// Size, colour, precision.
    Film,
    /// How light is followed.
    Integrator,
    /// Where the random numbers come from.
    Sampler,
    /// How samples make a pixel.
    Filter,
}

impl Setting {
    /// The kind of its classes.
    pub fn kind(self) -> Kind {
        match self {
            Self::Film => Kind::Film,
            Self::Integrator => Kind::Integrator,
            Self::Sampler => Kind::Sampler,
            Self::Filter => Kind::Filter,
        }
    }

    /// The class where a scene gives none.
    pub fn default_class(self) -> &'static str {
        match self {
            Self::Film => "auto",
            Self::Integrator => "path",
            Self::Sampler => "sobol",
            Self::Filter => "blackman_harris",
        }
    }
}

impl Scene {
    /// The camera, film, … of a scene, by its kind; `None` for kinds of which it may have many.
    pub fn slot_mut(&mut self, kind: Kind) -> Option<&mut Option<NodeId>> {
        Some(match kind {
            Kind::Camera => &mut self.camera,
            Kind::Film => &mut self.film,
            Kind::Integrator => &mut self.integrator,
            Kind::Sampler => &mut self.sampler,
            Kind::Filter => &mut self.filter,
            Kind::Medium => &mut self.medium,
            _ => return None,
        })
    }

    /// Its node, if the scene gives one.
    pub fn setting(&self, setting: Setting) -> Option<&Node> {
        let id = match setting {
            Setting::Film => self.film,
            Setting::Integrator => self.integrator,
            Setting::Sampler => self.sampler,
            Setting::Filter => self.filter,
        };
        id.map(|id| self.node(id))
    }

    /// Gives the film another size, in pixels; a scene without a film gets one.
    pub fn set_resolution(&mut self, size: UVec2) {
        let size = Value::vector(size.as_dvec2().to_array());
        self.set_param(Setting::Film, "resolution", size);
    }

    /// Replaces how rays meet the triangles of meshes.
    pub fn set_precision(&mut self, precision: Precision) {
        self.set_param(Setting::Film, "precision", Value::Text(precision.word().into()));
    }

    /// Records a layer beside colour.
    pub fn add_layer(&mut self, layer: Layer) {
        self.set_param(Setting::Film, layer.name(), Value::Bool(true));
    }

    /// Gives a parameter of a setting another value, which fits its class.
    pub fn set_param(&mut self, setting: Setting, name: &'static str, value: Value) {
        let mut node = self.own(setting);
        node.params.to_mut().retain(|argument| argument.name != name);
        node.params.to_mut().push(Argument { name, value, span: NOWHERE });
        self.put(setting, node);
    }

    /// Gives a setting another class. Its parameters go with the old one, but for the film, whose
    /// classes have the same.
    pub fn set_class(&mut self, setting: Setting, class: &'static str) {
        let mut node = self.own(setting);
        if node.class == class {
            return;
        }
        node.class = class;
        if setting != Setting::Film {
            node.params = Arguments::default();
        }
        self.put(setting, node);
    }

    /// Its node, or the one that stands for it.
    fn own(&self, setting: Setting) -> Node {
        self.setting(setting).cloned().unwrap_or_else(|| Node {
            kind: setting.kind(),
            class: setting.default_class(),
            label: None,
            params: Arguments::default(),
            overrides: vec![],
            span: NOWHERE,
            hash: [0; 32],
        })
    }

    fn put(&mut self, setting: Setting, node: Node) {
        let id: Option<NodeId> = Some(self.add(node));
        match setting {
            Setting::Film => self.film = id,
            Setting::Integrator => self.integrator = id,
            Setting::Sampler => self.sampler = id,
            Setting::Filter => self.filter = id,
        }
    }
}

/// Where what comes from outside is written.
const NOWHERE: Span = Span { source: SourceId(0), start: 0, end: 0 };

#[cfg(test)]
mod tests {
    use luxel_sdk::params::Dimension;

    use super::*;

    #[test]
    fn what_is_set_replaces_the_films() {
        let mut scene = Scene::default();
        for size in [UVec2::new(3, 4), UVec2::new(5, 6)] {
            scene.set_resolution(size);
            let film = crate::stage::Film::of_node(scene.setting(Setting::Film));
            assert_eq!(film.resolution, size);
        }
        for precision in [Precision::Exact, Precision::Fast] {
            scene.set_precision(precision);
            let film = crate::stage::Film::of_node(scene.setting(Setting::Film));
            assert_eq!((film.precision, film.resolution), (precision, UVec2::new(5, 6)));
        }
    }

    #[test]
    fn another_class_loses_the_parameters_of_the_old_one_and_a_film_keeps_them() {
        let mut scene = Scene::default();
        let depth = || Value::Number(3.0, Dimension::NONE);
        scene.set_param(Setting::Integrator, "max_depth", depth());
        scene.set_class(Setting::Integrator, "path");
        let path = scene.setting(Setting::Integrator).unwrap();
        assert!(path.class == "path" && path.get("max_depth").unwrap().value == depth());
        scene.set_class(Setting::Integrator, "direct");
        let direct = scene.setting(Setting::Integrator).unwrap();
        assert!(direct.class == "direct" && direct.params.is_empty());
        scene.set_precision(Precision::Exact);
        scene.set_class(Setting::Film, "rgb");
        let film = scene.setting(Setting::Film).unwrap();
        assert!(film.class == "rgb" && film.get("precision").is_some());
    }
}
