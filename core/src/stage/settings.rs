//! The film's settings, read from its node.

use glam::UVec2;
use luxel_sdk::color::Observer;

use crate::accel::Precision;
use crate::cast::whole;
use crate::film::Layer;
use crate::registry::Display;
use crate::scene::{Argument, Feature, Node, Scene, Value};

/// How the scene wants colour to be carried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorChoice {
    /// RGB where nothing depends on wavelength, else spectral.
    Auto,
    /// Linear sRGB.
    Rgb,
    /// Four wavelengths.
    Spectral,
}

/// What is measured, and how it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels.
    pub resolution: UVec2,
    /// How colour is carried.
    pub color: ColorChoice,
    /// Exposure value of the PNG at ISO 100.
    pub exposure: Option<f64>,
    /// Which eye turns spectra into colours.
    pub observer: Observer,
    /// How the PNG shows radiance.
    pub display: Display,
    /// How rays meet the triangles of meshes.
    pub precision: Precision,
    /// When the shutter opens, seconds.
    pub time: f64,
    /// How long it stays open, seconds.
    pub shutter: f64,
    /// What is recorded beside colour.
    pub layers: Vec<Layer>,
    /// Where the EXR is written.
    pub file: Option<String>,
}

impl Default for Film {
    fn default() -> Self {
        Self {
            resolution: UVec2::new(640, 480),
            color: ColorChoice::Auto,
            exposure: None,
            observer: Observer::Cie1931,
            display: Display::Srgb,
            precision: Precision::Standard,
            time: 0.0,
            shutter: 0.0,
            layers: vec![],
            file: None,
        }
    }
}

impl Film {
    /// When the shutter opens and closes, seconds.
    pub fn during(&self) -> [f64; 2] {
        [self.time, self.time + self.shutter]
    }

    /// Reads the film of a scene, without what the scene leaves out.
    pub(super) fn of_scene(scene: &Scene) -> Self {
        let mut film = Self::of_node(scene.film.map(|id| scene.node(id)));
        if scene.leaves_out(Feature::Motion) {
            film.shutter = 0.0;
        }
        if scene.leaves_out(Feature::Layers) {
            film.layers.clear();
        }
        film
    }

    /// Reads a film node; what it does not give keeps its default. The node fits its schema.
    pub fn of_node(node: Option<&Node>) -> Self {
        let mut film = Self::default();
        let Some(node) = node else { return film };
        film.color = match node.class {
            "rgb" => ColorChoice::Rgb,
            "spectral" => ColorChoice::Spectral,
            _ => ColorChoice::Auto,
        };
        for Argument { name, value, .. } in &node.params {
            match (*name, value) {
                ("resolution", Value::Vector(v)) if v.len() == 2 => {
                    film.resolution = UVec2::new(whole(v[0]), whole(v[1]));
                }
                ("time", Value::Number(time, _)) => film.time = *time,
                ("shutter", Value::Number(shutter, _)) => film.shutter = *shutter,
                ("exposure", Value::Number(ev, _)) => film.exposure = Some(*ev),
                ("observer", Value::Text(word)) => {
                    film.observer = match &**word {
                        "cie1964" => Observer::Cie1964,
                        "cie2015" => Observer::Cie2015,
                        _ => Observer::Cie1931,
                    };
                }
                ("display", Value::Text(word)) => {
                    film.display = match &**word {
                        "linear" => Display::Linear,
                        "filmic" => Display::Filmic,
                        _ => Display::Srgb,
                    };
                }
                ("precision", Value::Text(word)) => {
                    film.precision = Precision::of_word(word).unwrap_or_default();
                }
                (name, Value::Bool(true)) => film.layers.extend(Layer::of_name(name)),
                ("file", Value::Text(name)) => film.file = Some(name.to_string()),
                _ => {}
            }
        }
        film.layers.sort_by_key(|layer| Layer::ALL.iter().position(|other| other == layer));
        film
    }
}
