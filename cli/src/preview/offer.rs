//! What may be changed on the page beside the file: the scene's `param`s and its camera.

use serde::Serialize;

/// A `param` of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Param {
    /// Its name.
    pub(crate) name: String,
    /// What its author says of it.
    pub(crate) doc: String,
    /// Whether it is set on the page.
    pub(crate) set: bool,
    /// What it is.
    #[serde(flatten)]
    pub(crate) field: Field,
}

/// The value of a `param`, and what it may be.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum Field {
    /// A number.
    Number {
        /// In `unit`.
        value: f64,
        /// As its author writes it, or empty.
        unit: String,
        /// Whether only whole numbers are legal.
        whole: bool,
        /// The least and the most that it may be, in `unit`.
        limits: Option<[f64; 2]>,
        /// Whether it may be the most.
        inclusive: bool,
    },
    /// True or false.
    Bool {
        /// Which.
        value: bool,
    },
    /// Text.
    Text {
        /// Without quotes.
        value: String,
    },
    /// A vector or a list of numbers.
    Numbers {
        /// In `unit`.
        value: Vec<f64>,
        /// As its author writes it, or empty.
        unit: String,
        /// Whether it is written `[1, 2]` and not `(1, 2)`.
        list: bool,
    },
    /// A colour.
    Color {
        /// Linear sRGB.
        value: [f64; 3],
    },
}

/// Where the camera stands when the shutter opens.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Camera {
    /// Its place, in the world, metres.
    pub(crate) from: [f64; 3],
    /// Straight ahead, where the first thing is seen: about this it is turned.
    pub(crate) to: [f64; 3],
    /// Which way is up.
    pub(crate) up: [f64; 3],
    /// By how much the rays of neighbouring pixels in the middle differ: in metres at their
    /// beginning, and in metres for each metre of their length.
    pub(crate) spread: [f64; 2],
    /// How many times as much is seen as the file says, if its rays are parallel: such a camera comes no
    /// closer, but can show less.
    pub(crate) zoom: Option<f64>,
    /// Whether it stands where the page wants it and not where the file says.
    pub(crate) moved: bool,
    /// The camera as a scene file writes it.
    pub(crate) text: String,
}
