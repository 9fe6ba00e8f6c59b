//! The EXR: linear sRGB radiance, its standard error and the number of samples, per pixel.

use std::io::{self, Seek, Write};

use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2,
    WritableImage,
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
    let floats = |name: &str, value: &dyn Fn(&Pixel) -> f64| {
        let samples = film.pixels().map(|(_, pixel)| value(pixel) as f32).collect();
        (name.to_owned(), Plane::Floats(samples))
    };
    let counts = film.pixels().map(|(_, pixel)| pixel.n).collect();
    let layers = film.channels().into_iter().map(|(channel, values)| {
        let plane = if channel.is_number() {
            Plane::Counts(values.iter().map(|v| *v as u32).collect())
        } else {
            Plane::Floats(values.iter().map(|v| *v as f32).collect())
        };
        (channel.name.to_owned(), plane)
    });
    let planes = [
        floats("R", &|pixel| pixel.mean.x),
        floats("G", &|pixel| pixel.mean.y),
        floats("B", &|pixel| pixel.mean.z),
        floats("SE.R", &|pixel| pixel.standard_error().x),
        floats("SE.G", &|pixel| pixel.standard_error().y),
        floats("SE.B", &|pixel| pixel.standard_error().z),
        ("N".to_owned(), Plane::Counts(counts)),
    ];
    write_planes(to, (film.size, film.window), planes.into_iter().chain(layers), &notes.json)
}

/// The values of a channel, row by row.
#[derive(Clone, Debug)]
pub(crate) enum Plane {
    /// 32-bit floats.
    Floats(Vec<f32>),
    /// Whole numbers.
    Counts(Vec<u32>),
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
    let channel = |(name, plane): (String, Plane)| {
        let samples = match plane {
            Plane::Floats(values) => FlatSamples::F32(values),
            Plane::Counts(values) => FlatSamples::U32(values),
        };
        AnyChannel::new(name.as_str(), samples)
    };
    let channels = AnyChannels::sort(planes.into_iter().map(channel).collect());
    let corner = |v: UVec2| (v.x as usize, v.y as usize);
    let min = window.min.as_ivec2();
    let about = LayerAttributes {
        layer_position: Vec2(min.x, min.y),
        software_name: Some(Text::from("luxel")),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(corner(window.size), about, Encoding::SMALL_FAST_LOSSLESS, channels);
    let mut image = Image::from_layer(layer);
    image.attributes.display_window = IntegerBounds::new((0, 0), corner(size));
    image.attributes.chromaticities = Some(srgb());
    let json = AttributeValue::Text(Text::new_or_panic(json));
    image.layer_data.attributes.other.insert(Text::from("luxel"), json);
    image.write().to_buffered(to).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

#[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
fn srgb() -> Chromaticities {
    let place = |xy: glam::DVec2| Vec2(xy.x as f32, xy.y as f32);
    let [red, green, blue] = RgbSpace::LinearSrgb.primaries().map(place);
    Chromaticities { red, green, blue, white: place(RgbSpace::LinearSrgb.white()) }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::prelude::{ReadChannels, ReadLayers, read};

    use super::*;

    fn bytes(film: &Film) -> Vec<u8> {
        let mut file = Cursor::new(vec![]);
        write(&mut file, film, &Notes { json: r#"{"é":1}"#.into() }).unwrap();
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
        assert_eq!(notes.to_string(), r#"{"é":1}"#);
    }

    #[test]
    fn the_same_picture_has_the_same_bytes() {
        let film = Film::new(UVec2::new(9, 9), Rect::new(UVec2::ZERO, UVec2::splat(9)));
        assert_eq!(bytes(&film), bytes(&film));
    }
}
