//! The EXR: linear sRGB radiance, its standard error and the number of samples, per pixel.

use std::io::{self, Seek, Write};

use exr::block::lines::LineRefMut;
use exr::compression::Compression;
use exr::image::Blocks;
use exr::image::write::samples::{SamplesWriter, WritableSamples};
use exr::math::RoundingMode;
use exr::meta::attribute::{
    AttributeValue, Chromaticities, IntegerBounds, LevelMode, LineOrder, SampleType, Text,
};
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, Image, Layer, LayerAttributes, Vec2, WritableImage,
};
use glam::UVec2;
use luxel_core::film::{Film, Pixel, Rect};
use luxel_sdk::color::RgbSpace;

/// What is said about the picture in its header.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    /// A JSON object: version, hashes, settings.
    pub(crate) json: String,
}

/// Writes channels R, G, B (the mean), SE.R, SE.G, SE.B (standard error of the mean, infinite below
/// two samples), N (samples), and those of the film's layers. The data window is the film's window,
/// the display window the whole picture. The notes are the attribute `luxel`: one attribute, so that the same picture has the
/// same bytes.
///
/// # Errors
/// The writer's.
#[expect(clippy::cast_possible_truncation, reason = "the file holds 32 bits")]
#[expect(clippy::cast_sign_loss, reason = "numbers of things are not negative")]
pub(super) fn write(to: impl Write + Seek, film: &Film, notes: &Notes) -> io::Result<()> {
    let floats = |name: &str, value| (name.to_owned(), Source::Pixels(film, value));
    let layers = film.channels().into_iter().map(|(channel, values)| {
        let plane = if channel.is_number() {
            Plane::Counts(values.iter().map(|v| *v as u32).collect())
        } else {
            Plane::Floats(values.iter().map(|v| *v as f32).collect())
        };
        (channel.name.into_owned(), Source::Plane(plane))
    });
    let planes = [
        floats("R", |pixel| pixel.mean.x),
        floats("G", |pixel| pixel.mean.y),
        floats("B", |pixel| pixel.mean.z),
        floats("SE.R", |pixel| pixel.standard_error().x),
        floats("SE.G", |pixel| pixel.standard_error().y),
        floats("SE.B", |pixel| pixel.standard_error().z),
        ("N".to_owned(), Source::Samples(film)),
    ];
    write_sources(to, (film.size, film.window), planes.into_iter().chain(layers), &notes.json)
}

/// The values of a channel, row by row.
#[derive(Clone, Debug)]
pub(crate) enum Plane {
    /// 32-bit floats.
    Floats(Vec<f32>),
    /// Whole numbers.
    Counts(Vec<u32>),
}

/// Where the values of a channel come from.
enum Source<'f> {
    Plane(Plane),
    /// From each pixel of a film, as it is written.
    Pixels(&'f Film, fn(&Pixel) -> f64),
    /// The samples of each pixel of a film.
    Samples(&'f Film),
}

impl<'s> WritableSamples<'s> for Source<'_> {
    type Writer = Lines<'s>;

    fn sample_type(&self) -> SampleType {
        match self {
            Self::Plane(Plane::Floats(_)) | Self::Pixels(..) => SampleType::F32,
            Self::Plane(Plane::Counts(_)) | Self::Samples(_) => SampleType::U32,
        }
    }

    fn infer_level_modes(&self) -> (LevelMode, RoundingMode) {
        (LevelMode::Singular, RoundingMode::Down)
    }

    fn create_samples_writer(&'s self, header: &Header) -> Lines<'s> {
        Lines { source: self, width: header.layer_size.width() }
    }
}

/// Thirty-two lines at a time: of a picture of 512 a quarter of what squares of 256 pixels hold.
const ENCODING: Encoding = Encoding {
    compression: Compression::PIZ,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// The lines of a channel.
struct Lines<'s> {
    source: &'s Source<'s>,
    width: usize,
}

impl SamplesWriter for Lines<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "the file holds 32 bits")]
    fn extract_line(&self, line: LineRefMut<'_>) {
        let Vec2(x, y) = line.location.position;
        let at = |i: usize| y * self.width + x + i;
        let corner = UVec2::new(x as u32, y as u32);
        let place = |film: &Film, i: usize| film.window.min + corner + UVec2::X * i as u32;
        let written = match self.source {
            Source::Plane(Plane::Floats(values)) => line.write_samples(|i| values[at(i)]),
            Source::Plane(Plane::Counts(values)) => line.write_samples(|i| values[at(i)]),
            Source::Pixels(film, value) => {
                line.write_samples(|i| value(film.pixel(place(film, i))) as f32)
            }
            Source::Samples(film) => line.write_samples(|i| film.pixel(place(film, i)).n),
        };
        written.expect("a line has room for its samples");
    }
}

/// Writes channels by name, in the part `window` of a picture of that size, with what is said about
/// them.
///
/// # Errors
/// The writer's.
pub(crate) fn write_planes(
    to: impl Write + Seek,
    (size, window): (UVec2, Rect),
    planes: impl IntoIterator<Item = (String, Plane)>,
    json: &str,
) -> io::Result<()> {
    let sources = planes.into_iter().map(|(name, plane)| (name, Source::Plane(plane)));
    write_sources(to, (size, window), sources, json)
}

fn write_sources<'f>(
    to: impl Write + Seek,
    (size, window): (UVec2, Rect),
    sources: impl Iterator<Item = (String, Source<'f>)>,
    json: &str,
) -> io::Result<()> {
    let channel = |(name, source): (String, Source<'f>)| AnyChannel::new(name.as_str(), source);
    let channels = AnyChannels::sort(sources.map(channel).collect());
    let corner = |v: UVec2| (v.x as usize, v.y as usize);
    let min = window.min.as_ivec2();
    let about = LayerAttributes {
        layer_position: Vec2(min.x, min.y),
        software_name: Some(Text::from("luxel")),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(corner(window.size), about, ENCODING, channels);
    let mut image = Image::from_layer(layer);
    image.attributes.display_window = IntegerBounds::new((0, 0), corner(size));
    image.attributes.chromaticities = Some(srgb());
    let json = Text::new_or_none(ascii(json)).ok_or_else(|| io::Error::other("odd notes"))?;
    let json = AttributeValue::Text(json);
    image.layer_data.attributes.other.insert(Text::from("luxel"), json);
    // One block after the other: all at once they are the picture a second time.
    image.write().non_parallel().to_buffered(to).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

/// The same JSON in ASCII alone: an EXR's texts know no letters beyond Latin-1.
fn ascii(json: &str) -> String {
    use std::fmt::Write;

    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() {
            out.push(c);
            continue;
        }
        for unit in c.encode_utf16(&mut [0; 2]) {
            // Nothing fails that writes to a text.
            let _ = write!(out, "\\u{unit:04x}");
        }
    }
    out
}

#[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
fn srgb() -> Chromaticities {
    let place = |xy: glam::DVec2| Vec2(xy.x as f32, xy.y as f32);
    let [red, green, blue] = RgbSpace::LinearSrgb.primaries().map(place);
    Chromaticities { red, green, blue, white: place(RgbSpace::LinearSrgb.white()) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::io::Cursor;
    use std::path::Path;

    use exr::prelude::{ReadChannels, ReadLayers, read};
    use glam::DVec3;
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;
    use luxel_core::render::{Control, Options, render};
    use luxel_core::stage;

    use super::*;
    use crate::picture::read::Picture;

    fn bytes(film: &Film) -> Vec<u8> {
        let mut file = Cursor::new(vec![]);
        write(&mut file, film, &Notes { json: r#"{"é球𝄞":1}"#.into() }).unwrap();
        file.into_inner()
    }

    #[test]
    fn a_crop_is_read_back_with_its_place_channels_and_notes() {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(7, 4));
        let film = Film::new(UVec2::new(32, 16), window);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes(&film)))
            .unwrap();
        let layer = &image.layer_data;
        assert_eq!(image.attributes.display_window.size, Vec2(32, 16));
        assert_eq!(layer.attributes.layer_position, Vec2(5, 3));
        assert_eq!(layer.size, Vec2(7, 4));
        let channels = &layer.channel_data.list;
        let names: Vec<_> = channels.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["B", "G", "N", "R", "SE.B", "SE.G", "SE.R"]);
        // No sample was taken: the mean is zero and its error unknown.
        let first = |name: &str| {
            let channel = channels.iter().find(|channel| channel.name == *name);
            channel.unwrap().sample_data.value_by_flat_index(0).to_f32()
        };
        assert_eq!([first("R"), first("N")].map(f32::to_bits), [0, 0]);
        assert!(first("SE.G").is_infinite());
        let AttributeValue::Text(notes) = &layer.attributes.other[&Text::from("luxel")] else {
            panic!("the notes are text")
        };
        assert_eq!(notes.to_string(), r#"{"\u00e9\u7403\ud834\udd1e":1}"#);
        let read: serde_json::Value = serde_json::from_str(&notes.to_string()).unwrap();
        assert_eq!(read["é球𝄞"], 1);
    }

    #[test]
    fn every_pixel_stands_where_it_was_measured() {
        // More lines than a block has, at a place of their own, each pixel with a light of its own.
        let files = MemoryFiles::default().with(
            "a.scene",
            *b"scene 1\n\
              camera perspective { look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, \
              up = (0, 1, 0)), fov = 40 deg }\n\
              film rgb { resolution = (40, 90) }\n\
              integrator debug { show = \"normals\" }\n\
              sampler independent { samples = 3 }\n\
              shape sphere { radius = 9 m }\n\
              light constant { radiance = 1 W/m^2/sr }\n",
        );
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).unwrap();
        }
        let settings = luxel_lang::Settings::default();
        let loaded = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
        let scene = loaded.scene.unwrap();
        let stage = stage::build(&scene, &registry, &files, None).unwrap().stage;
        let crop = Some(Rect::new(UVec2::new(5, 3), UVec2::new(21, 75)));
        let options = Options { crop, ..Options::default() };
        let (film, _) = render(&stage, &options, &Control::default());
        let read = Picture::read(Cursor::new(bytes(&film))).unwrap();
        let written = |v: DVec3| v.as_vec3().to_array().map(f32::to_bits);
        let kept = |values: &[f32], i: usize| [0, 1, 2].map(|k| values[3 * i + k].to_bits());
        for (i, (at, pixel)) in film.pixels().enumerate() {
            assert_eq!(kept(&read.rgb, i), written(pixel.mean), "{at}");
            assert_eq!(kept(&read.se, i), written(pixel.standard_error()), "{at}");
            assert_eq!(read.n[i], pixel.n, "{at}");
        }
        let means: BTreeSet<_> = film.pixels().map(|(_, pixel)| written(pixel.mean)).collect();
        assert!(means.len() > 1000, "{} kinds of pixels", means.len());
    }

    #[test]
    fn the_same_picture_has_the_same_bytes() {
        let film = Film::new(UVec2::new(9, 9), Rect::new(UVec2::ZERO, UVec2::splat(9)));
        assert_eq!(bytes(&film), bytes(&film));
    }
}
