//! Reading an EXR: ours with standard error and samples, others with R, G and B or Y alone.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use exr::image::FlatSamples;
use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{AnyChannels, Layer, LayerAttributes, ReadChannels, ReadLayers, read};
use glam::UVec2;
use luxel_core::film::Rect;
use luxel_core::registry::Display;
use serde_json::Value;

use crate::exit::{Exit, Failure};
use crate::preview::{Frame, Pixels, Side};

/// Pixels of the largest picture: 4 GiB of planes.
const MOST_PIXELS: usize = 1 << 27;

/// What a file holds.
pub(super) struct Picture {
    size: UVec2,
    window: Rect,
    /// Three for each pixel.
    rgb: Vec<f32>,
    /// As `rgb`, or empty.
    se: Vec<f32>,
    /// Samples, or empty.
    n: Vec<u32>,
    notes: Value,
}

impl Picture {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that is missing, no EXR, too large, or without colour.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let wrong = |what: &dyn std::fmt::Display| {
            Failure::new(Exit::Input, format!("cannot read the picture {}: {what}", path.display()))
        };
        #[expect(clippy::disallowed_methods, reason = "named by the person, read by no scene")]
        let file = File::open(path).map_err(|error| wrong(&error))?;
        let (layer, display) = decode(BufReader::new(file)).map_err(|error| wrong(&error))?;
        Self::of_layer(layer, display).map_err(|what| {
            wrong(&what).help("it takes channels R, G and B, or Y alone; ours has SE.R … and N too")
        })
    }

    fn of_layer(
        layer: Layer<AnyChannels<FlatSamples>>,
        display: (UVec2, glam::IVec2),
    ) -> Result<Self, String> {
        let plane = |name: &str| {
            let mut channels = layer.channel_data.list.iter();
            Some(&channels.find(|channel| channel.name == *name)?.sample_data)
        };
        let three = |names: [&str; 3]| names.map(plane).into_iter().collect::<Option<Vec<_>>>();
        let colour = three(["R", "G", "B"]).or_else(|| three(["Y", "Y", "Y"]));
        let rgb = interleaved(&colour.ok_or("it has no channels R, G and B")?);
        let se = three(["SE.R", "SE.G", "SE.B"]).map_or(vec![], |planes| interleaved(&planes));
        let n = plane("N").map_or(vec![], counts);
        let extent = UVec2::new(side(layer.size.0)?, side(layer.size.1)?);
        let area = extent.x as usize * extent.y as usize;
        if rgb.len() != area * 3 || ![0, area * 3].contains(&se.len()) {
            return Err("its channels are of different sizes".into());
        }
        let LayerAttributes { layer_position: at, other, .. } = layer.attributes;
        let min = (glam::IVec2::new(at.0, at.1) - display.1).max(glam::IVec2::ZERO).as_uvec2();
        let notes = match other.get(&Text::from("luxel")) {
            Some(AttributeValue::Text(text)) => serde_json::from_str(&text.to_string()).ok(),
            _ => None,
        };
        let window = Rect::new(min, extent);
        let size = display.0.max(min + extent);
        let n = if n.len() == area { n } else { vec![] };
        Ok(Self { size, window, rgb, se, n, notes: notes.unwrap_or_default() })
    }

    pub(super) fn frame(&self) -> Frame {
        let pixels = Pixels::new(self.window.size, &self.rgb, &self.se, self.n.clone());
        let samples = self.n.iter().copied().max().unwrap_or(0);
        let of_samples = self.notes["spp"].as_u64().and_then(|spp| spp.try_into().ok());
        Frame {
            side: Side::A,
            name: String::new(),
            generation: 0,
            size: self.size,
            window: self.window,
            pixels,
            exposure: self.notes["exposure"].as_f64(),
            display: match self.notes["display"].as_str() {
                Some("linear") => Display::Linear,
                Some("filmic") => Display::Filmic,
                _ => Display::Srgb,
            },
            samples,
            of_samples: of_samples.unwrap_or(samples),
            complete: self.notes["complete"].as_bool().unwrap_or(true),
        }
    }

    /// The values of a pixel as they stand in the file; nothing outside.
    pub(super) fn facts(&self, at: UVec2) -> Vec<(String, String)> {
        let Some(i) = self.index(at) else { return vec![] };
        let three = |plane: &[f32]| {
            plane.get(i * 3..i * 3 + 3).map(|v| format!("{} {} {}", v[0], v[1], v[2]))
        };
        let n = self.n.get(i).map(u32::to_string);
        [("radiance", three(&self.rgb)), ("standard error", three(&self.se)), ("samples", n)]
            .into_iter()
            .filter_map(|(name, value)| Some((name.to_owned(), value?)))
            .collect()
    }

    fn index(&self, at: UVec2) -> Option<usize> {
        let from = at.checked_sub(self.window.min)?;
        let inside = from.cmplt(self.window.size).all();
        inside.then(|| from.y as usize * self.window.size.x as usize + from.x as usize)
    }

    /// A line about it.
    pub(super) fn about(&self) -> String {
        let mut parts = vec![format!("{} × {}", self.size.x, self.size.y)];
        let spp = self.n.iter().copied().max().map(|n| format!("{n} samples per pixel"));
        parts.extend(spp);
        let words = ["color", "integrator"].map(|key| self.notes[key].as_str().map(str::to_owned));
        parts.extend(words.into_iter().flatten());
        parts.join(" · ")
    }
}

type Decoded = (Layer<AnyChannels<FlatSamples>>, (UVec2, glam::IVec2));

/// The first layer, and the display window's size and place.
fn decode(from: BufReader<File>) -> Result<Decoded, String> {
    let told = |error: exr::error::Error| error.to_string();
    let reader = exr::block::read(from, false).map_err(told)?;
    for header in reader.headers() {
        let area = header.layer_size.0.checked_mul(header.layer_size.1);
        if area.is_none_or(|area| area > MOST_PIXELS) {
            let size = header.layer_size;
            return Err(format!("{} × {} pixels are more than 2^27", size.0, size.1));
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_chunks(reader)
        .map_err(told)?;
    let window = image.attributes.display_window;
    let size = UVec2::new(side(window.size.0)?, side(window.size.1)?);
    Ok((image.layer_data, (size, glam::IVec2::new(window.position.0, window.position.1))))
}

fn side(length: usize) -> Result<u32, String> {
    u32::try_from(length).map_err(|_| format!("{length} pixels in a row are too many"))
}

fn interleaved(planes: &[&FlatSamples]) -> Vec<f32> {
    let n = planes.iter().map(|plane| plane.len()).min().unwrap_or(0);
    let mut all = vec![0.0; n * planes.len()];
    for (i, plane) in planes.iter().enumerate() {
        for (pixel, value) in all.chunks_exact_mut(planes.len()).zip(plane.values_as_f32()) {
            pixel[i] = value;
        }
    }
    all
}

fn counts(plane: &FlatSamples) -> Vec<u32> {
    match plane {
        FlatSamples::U32(counts) => counts.clone(),
        #[expect(clippy::cast_possible_truncation, reason = "saturates")]
        #[expect(clippy::cast_sign_loss, reason = "saturates")]
        floats => floats.values_as_f32().map(|v| v as u32).collect(),
    }
}
