//! Reading an EXR: ours with standard error and samples, others with R, G and B or Y alone.

use std::io::{BufRead, BufReader, Read, Seek};
use std::path::Path;

use exr::image::FlatSamples;
use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{AnyChannel, AnyChannels, Layer, LayerAttributes, ReadChannels, ReadLayers};
use glam::UVec2;
use luxel_core::film::Rect;
use luxel_core::registry::Display;
use luxel_core::stage;
use serde_json::Value;

use super::exr::Plane;
use crate::exit::{Exit, Failure};
use crate::files::open_regular;

/// Values of the largest picture, all channels together: 4 GiB of them.
const MOST_VALUES: usize = 1 << 30;

/// What a file holds.
pub(crate) struct Picture {
    /// The whole picture's size.
    pub(crate) size: UVec2,
    /// The part of it that is there.
    pub(crate) window: Rect,
    /// Three for each pixel.
    pub(crate) rgb: Vec<f32>,
    /// As `rgb`, or empty.
    pub(crate) se: Vec<f32>,
    /// Samples, or empty.
    pub(crate) n: Vec<u32>,
    /// All other channels.
    pub(crate) others: Vec<(String, Plane)>,
    /// What the file says about itself; null if nothing.
    pub(crate) notes: Value,
}

impl Picture {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that is missing, no EXR, too large, or without colour.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let wrong = |what: &dyn std::fmt::Display| {
            Failure::new(Exit::Input, format!("cannot read the picture {}: {what}", path.display()))
        };
        let (file, _) = open_regular(path, u64::MAX).map_err(|error| wrong(&error))?;
        let mut file = BufReader::new(file);
        let begin = file.fill_buf().map_err(|error| wrong(&error))?.to_vec();
        if let Some(other) = other_than_exr(&begin) {
            return Err(wrong(&other)
                .help("pictures are read from EXR files, as `luxel render` writes them"));
        }
        Self::read(file).map_err(|what| match what {
            what if what.contains("missing bytes") => {
                wrong(&"it ends too early").help("copy or render it again")
            }
            what => wrong(&what)
                .help("it takes channels R, G and B, or Y alone; ours has SE.R … and N too"),
        })
    }

    /// Reads what a file holds.
    ///
    /// # Errors
    /// As `open`, without the name.
    pub(crate) fn read(from: impl Read + Seek) -> Result<Self, String> {
        let (layer, display) = decode(from)?;
        Self::of_layer(layer, display)
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
        let others = others(&layer.channel_data.list);
        let extent = UVec2::new(side(layer.size.0)?, side(layer.size.1)?);
        let area = extent.x as usize * extent.y as usize;
        if rgb.len() != area * 3 || ![0, area * 3].contains(&se.len()) {
            return Err("its channels are of different sizes".into());
        }
        let LayerAttributes { layer_position: at, other, .. } = layer.attributes;
        let from = glam::IVec2::new(at.0, at.1).as_i64vec2() - display.1.as_i64vec2();
        let outside = (-from).max(glam::I64Vec2::ZERO).min(extent.as_i64vec2()).as_uvec2();
        // What lies left of the display window or above it is no part of the picture.
        let part = Rect::new(outside, extent - outside);
        if part.area() == 0 {
            return Err("all of it lies outside of its display window".into());
        }
        let min = from.max(glam::I64Vec2::ZERO).as_uvec2();
        let notes = match other.get(&Text::from("luxel")) {
            Some(AttributeValue::Text(text)) => serde_json::from_str(&text.to_string()).ok(),
            _ => None,
        };
        let window = Rect::new(min, part.size);
        let size = display.0.max(min.saturating_add(part.size));
        let n = if n.len() == area { n } else { vec![] };
        let others = others.into_iter().map(|(name, plane)| match plane {
            Plane::Floats(values) => (name, Plane::Floats(cropped(values, extent, part))),
            Plane::Counts(values) => (name, Plane::Counts(cropped(values, extent, part))),
        });
        Ok(Self {
            size,
            window,
            rgb: cropped(rgb, extent, part),
            se: cropped(se, extent, part),
            n: cropped(n, extent, part),
            others: others.collect(),
            notes: notes.unwrap_or_default(),
        })
    }

    /// Whether its values were smoothed after they were measured; its errors are of before.
    pub(crate) fn is_denoised(&self) -> bool {
        self.notes["denoised"] == true
    }

    /// How it is to be shown.
    pub(crate) fn settings(&self) -> stage::Film {
        stage::Film {
            exposure: self.notes["exposure"].as_f64(),
            display: match self.notes["display"].as_str() {
                Some("linear") => Display::Linear,
                Some("filmic") => Display::Filmic,
                _ => Display::Srgb,
            },
            ..stage::Film::default()
        }
    }

    /// Where a pixel is in `n`; nothing outside.
    pub(crate) fn index(&self, at: UVec2) -> Option<usize> {
        let from = at.checked_sub(self.window.min)?;
        let inside = from.cmplt(self.window.size).all();
        inside.then(|| from.y as usize * self.window.size.x as usize + from.x as usize)
    }
}

type Decoded = (Layer<AnyChannels<FlatSamples>>, (UVec2, glam::IVec2));

/// What a file that begins so is, if it is no EXR.
fn other_than_exr(begin: &[u8]) -> Option<&'static str> {
    const KNOWN: [(&[u8], &str); 4] = [
        (b"\x89PNG", "it is a PNG, not an EXR"),
        (b"\xff\xd8\xff", "it is a JPEG, not an EXR"),
        (b"#?RADIANCE", "it is a Radiance picture, not an EXR"),
        (b"scene", "it is a scene, not a picture"),
    ];
    let known = KNOWN.iter().find(|(magic, _)| begin.starts_with(magic));
    match begin {
        [] => Some("it is empty"),
        [0x76, 0x2f, 0x31, 0x01, ..] => None,
        _ => Some(known.map_or("it is no EXR", |(_, what)| what)),
    }
}

/// The first layer, and the display window's size and place.
fn decode(from: impl Read + Seek) -> Result<Decoded, String> {
    let told = |error: exr::error::Error| error.to_string();
    let reader = exr::block::read(from, false).map_err(told)?;
    for header in reader.headers() {
        let (size, n) = (header.layer_size, header.channels.list.len());
        let values = size.0.checked_mul(size.1).and_then(|area| area.checked_mul(n));
        if values.is_none_or(|values| values > MOST_VALUES) {
            let pixels = format!("{} × {} pixels of {n} channels", size.0, size.1);
            return Err(format!("{pixels} are more than 2^30 values"));
        }
    }
    let image = exr::prelude::read()
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

/// The values of a part of a picture, as many for each pixel as there are.
fn cropped<T: Copy>(values: Vec<T>, extent: UVec2, part: Rect) -> Vec<T> {
    if part.size == extent {
        return values;
    }
    let width = extent.x as usize;
    let each = values.len() / (width * extent.y as usize);
    let pixel = |at: UVec2| {
        let first = (at.y as usize * width + at.x as usize) * each;
        values[first..first + each].iter().copied()
    };
    part.points().flat_map(pixel).collect()
}

/// The channels that are neither colour nor what is known of its error.
fn others(list: &[AnyChannel<FlatSamples>]) -> Vec<(String, Plane)> {
    const KNOWN: [&str; 7] = ["R", "G", "B", "SE.R", "SE.G", "SE.B", "N"];
    let others = list.iter().filter(|channel| KNOWN.iter().all(|name| channel.name != **name));
    let plane = |samples: &FlatSamples| match samples {
        FlatSamples::U32(values) => Plane::Counts(values.clone()),
        floats => Plane::Floats(floats.values_as_f32().collect()),
    };
    others.map(|channel| (channel.name.to_string(), plane(&channel.sample_data))).collect()
}

fn counts(plane: &FlatSamples) -> Vec<u32> {
    match plane {
        FlatSamples::U32(counts) => counts.clone(),
        #[expect(clippy::cast_possible_truncation, reason = "saturates")]
        #[expect(clippy::cast_sign_loss, reason = "saturates")]
        floats => floats.values_as_f32().map(|v| v as u32).collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::prelude::{Encoding, Image, Vec2, WritableImage, f16};

    use super::*;
    use crate::testing::Folder;

    /// An EXR with these channels, 3 × 2 pixels at (-1, 4), as another program may write it.
    fn foreign(names: &[&str]) -> Vec<u8> {
        let plane = |name: &&str| {
            let values = (0..6_u8).map(|i| f16::from_f32(f32::from(i) + 0.5)).collect();
            AnyChannel::new(*name, FlatSamples::F16(values))
        };
        let channels = AnyChannels::sort(names.iter().map(plane).collect());
        let about = LayerAttributes { layer_position: Vec2(-1, 4), ..LayerAttributes::default() };
        let layer = Layer::new((3, 2), about, Encoding::SMALL_FAST_LOSSLESS, channels);
        let mut file = Cursor::new(vec![]);
        Image::from_layer(layer).write().to_buffered(&mut file).unwrap();
        file.into_inner()
    }

    #[test]
    fn what_lies_before_the_display_window_is_cut_off() {
        let named = |name: &str| {
            let values = (0..6_u8).map(f32::from).collect();
            AnyChannel::new(name, FlatSamples::F32(values))
        };
        let read = |x, y| {
            let about =
                LayerAttributes { layer_position: Vec2(x, y), ..LayerAttributes::default() };
            let channels = AnyChannels::sort(["R", "G", "B", "Z"].map(named).into_iter().collect());
            let layer = Layer::new((3, 2), about, Encoding::SMALL_FAST_LOSSLESS, channels);
            let mut image = Image::from_layer(layer);
            image.attributes.display_window.position = Vec2(0, 0);
            let mut file = Cursor::new(vec![]);
            image.write().to_buffered(&mut file).unwrap();
            of_bytes(file.get_ref())
        };
        let picture = read(-1, -1).unwrap();
        assert_eq!(picture.window, Rect::new(UVec2::ZERO, UVec2::new(2, 1)));
        assert_eq!(picture.rgb, [4.0, 4.0, 4.0, 5.0, 5.0, 5.0]);
        let Plane::Floats(z) = &picture.others[0].1 else { panic!("Z is no plane of floats") };
        assert_eq!(z[..], [4.0, 5.0]);
        assert_eq!(read(1, 0).unwrap().window.min, UVec2::new(1, 0));
        let wrong = read(-3, 0).err().unwrap();
        assert!(wrong.contains("outside of its display window"), "{wrong}");
    }

    fn of_bytes(bytes: &[u8]) -> Result<Picture, String> {
        Picture::read(Cursor::new(bytes))
    }

    #[test]
    fn pictures_of_others_are_read_if_they_have_colour_or_luminance() {
        let grey = of_bytes(&foreign(&["Y", "Z"])).unwrap();
        assert_eq!(grey.rgb[3..6], [1.5; 3]);
        assert!(grey.notes.is_null() && grey.se.is_empty() && grey.n.is_empty());
        let at = grey.window.min + UVec2::new(2, 1);
        assert_eq!(grey.index(at), Some(5));
        assert_eq!(grey.rgb[15..], [5.5; 3]);
        assert!(of_bytes(&foreign(&["R", "G", "B", "A"])).is_ok());
        let wrong = of_bytes(&foreign(&["Z"])).err().unwrap();
        assert!(wrong.contains("no channels R, G and B"), "{wrong}");
    }

    #[test]
    fn files_that_are_no_picture_are_told_by_name() {
        let folder = Folder::new("view-wrong");
        folder.write("a.exr", b"no picture");
        // A device is neither waited for nor read to its end.
        let device = std::path::PathBuf::from(if cfg!(unix) { "/dev/zero" } else { "none" });
        for name in ["a.exr", "none.exr", device.to_str().unwrap()] {
            let wrong = Picture::open(&folder.path(name)).err().unwrap();
            assert_eq!(wrong.exit, Exit::Input);
            assert!(wrong.message.contains(name), "{}", wrong.message);
        }
        let whole = foreign(&["R", "G", "B"]);
        let told: [(&[u8], &str); 5] = [
            (b"", "it is empty"),
            (b"\x89PNG\r\n\x1a\n", "it is a PNG, not an EXR"),
            (b"scene 1\n", "it is a scene, not a picture"),
            (b"no picture", "it is no EXR"),
            (&whole[..whole.len() / 2], "it ends too early"),
        ];
        for (bytes, what) in told {
            folder.write("a.exr", bytes);
            let wrong = Picture::open(&folder.path("a.exr")).err().unwrap();
            assert!(wrong.message.ends_with(what), "{}", wrong.message);
        }
    }

    #[test]
    fn a_damaged_file_is_an_error_or_another_picture_but_no_panic() {
        let whole = foreign(&["R", "G", "B"]);
        for end in 0..whole.len() {
            assert!(of_bytes(&whole[..end]).is_err(), "{end} bytes");
        }
        for i in 0..whole.len() {
            for flip in [1, 0x80, 0xff] {
                let mut damaged = whole.clone();
                damaged[i] ^= flip;
                let _ = of_bytes(&damaged);
            }
        }
    }
}
