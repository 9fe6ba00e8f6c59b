//! A picture on its way to the page.
//!
//! A message is `LXL1`, the length of a JSON object (u32, little-endian), the object (padded with
//! spaces to a multiple of eight bytes), then planes, each of all pixels row by row: samples (u32) if
//! they differ, radiance (three halves), standard error (three halves) if there is one.

use glam::UVec2;
use half::f16;
use half::slice::HalfFloatSliceExt;
use luxel_core::film::Rect;
use luxel_core::registry::Display;
use luxel_core::render::Reached;
use luxel_core::stage;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::board::Topic;
use super::exact::Exact;
use crate::picture;

/// Which of two pictures that are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Side {
    /// The first, or the only one.
    #[default]
    A,
    /// The one it is compared with.
    B,
}

impl Side {
    pub(super) fn topic(self) -> Topic {
        match self {
            Self::A => Topic::PictureA,
            Self::B => Topic::PictureB,
        }
    }
}

/// The first bytes of a message.
const MAGIC: &[u8] = b"LXL1";

/// A picture and what is said of it.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    /// Its place in a comparison.
    pub(crate) side: Side,
    /// What the page calls it.
    pub(crate) name: String,
    /// Which of a file's layers it shows; none shows colour.
    pub(crate) layer: Option<String>,
    /// Grows with each edit: the first picture of a new one makes the last the previous picture.
    pub(crate) generation: u64,
    /// The whole picture's size.
    pub(crate) size: UVec2,
    /// The part of it that `pixels` holds.
    pub(crate) window: Rect,
    /// The pixels of the window; fewer in a coarse pass.
    pub(crate) pixels: Pixels,
    /// The film's exposure value at ISO 100.
    pub(crate) exposure: Option<f64>,
    /// How the film shows radiance.
    pub(crate) display: Display,
    /// Samples per pixel so far.
    pub(crate) samples: u32,
    /// Samples per pixel in the end.
    pub(crate) of_samples: u32,
    /// Whether nothing will be added.
    pub(crate) complete: bool,
}

impl Frame {
    /// What a film holds by now, seen so far; `complete` if it has all of `of_samples`.
    pub(crate) fn of_exact(
        exact: &Exact,
        settings: &stage::Film,
        (seen, of_samples): (Reached, u32),
    ) -> Self {
        let (size, n) = (exact.pixels(), exact.n.clone());
        let pixels = Pixels { step: exact.step, ..Pixels::new(size, &exact.rgb, &exact.se, n) };
        Self {
            side: Side::A,
            name: String::new(),
            layer: None,
            generation: 0,
            size: exact.size,
            window: exact.window,
            pixels,
            exposure: settings.exposure,
            display: settings.display,
            samples: seen.samples,
            of_samples,
            complete: seen.step == 1 && seen.samples >= of_samples,
        }
    }

    pub(super) fn encode(&self) -> Vec<u8> {
        let Self { pixels, window, .. } = self;
        let n = pixels.n.first().filter(|first| pixels.n.iter().all(|n| n == *first));
        let planes = [("n", n.is_none()), ("rgb", true), ("se", !pixels.se.is_empty())];
        let planes: Vec<_> = planes.iter().filter(|plane| plane.1).map(|plane| plane.0).collect();
        let mut head = json!({
            "side": self.side,
            "name": self.name,
            "layer": self.layer,
            "generation": self.generation,
            "size": self.size.to_array(),
            "window": [window.min.x, window.min.y, window.size.x, window.size.y],
            "pixels": pixels.size.to_array(),
            "step": pixels.step,
            "planes": planes,
            "n": n,
            "unit": pixels.unit,
            "samples": self.samples,
            "of_samples": self.of_samples,
            "complete": self.complete,
        });
        show(&mut head, self.exposure, self.display);
        let counts = if n.is_none() { pixels.n.len() * 4 } else { 0 };
        let mut bytes = begin(&head, counts + (pixels.rgb.len() + pixels.se.len()) * 2);
        if n.is_none() {
            bytes.extend(pixels.n.iter().flat_map(|n| n.to_le_bytes()));
        }
        bytes.extend(pixels.rgb.iter().chain(&pixels.se).flat_map(|half| half.to_le_bytes()));
        bytes
    }
}

/// How a picture is exposed and shown.
fn show(head: &mut Value, exposure: Option<f64>, display: Display) {
    head["exposure"] = exposure.into();
    head["scale"] = picture::scale(exposure).into();
    head["display"] = match display {
        Display::Srgb => "srgb",
        Display::Linear => "linear",
        Display::Filmic => "filmic",
    }
    .into();
}

/// The beginning of a message, with room for so many bytes of planes.
fn begin(head: &Value, planes: usize) -> Vec<u8> {
    let mut head = head.to_string();
    head.extend(std::iter::repeat_n(' ', head.len().wrapping_neg() % 8));
    let length = u32::try_from(head.len()).expect("a head is a few hundred bytes");
    let mut bytes = Vec::with_capacity(8 + head.len() + planes);
    bytes.extend(MAGIC);
    bytes.extend(length.to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes
}

/// A picture on its way, shown as a film wants it; `None` if these bytes are no picture.
pub(super) fn shown_as(bytes: &[u8], settings: &stage::Film) -> Option<Vec<u8>> {
    let (length, rest) = bytes.strip_prefix(MAGIC)?.split_first_chunk()?;
    let (head, planes) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let mut head = serde_json::from_slice(head).ok()?;
    show(&mut head, settings.exposure, settings.display);
    let mut bytes = begin(&head, planes.len());
    bytes.extend(planes);
    Some(bytes)
}

/// Radiance in halves, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Pixels {
    /// Columns and rows.
    size: UVec2,
    /// Pixels of the window from one of these to the next; each stands for a square of that side.
    step: u32,
    /// Three for each pixel, times `unit`.
    rgb: Vec<f16>,
    /// Standard error likewise, or empty.
    se: Vec<f16>,
    /// Samples of each pixel, or empty.
    n: Vec<u32>,
    /// A power of two that gives halves their whole range: the largest finite value lies between
    /// 2¹⁴ and 2¹⁵ units, so that 29 stops below it keep 11 bits.
    unit: f64,
}

impl Pixels {
    /// From linear sRGB radiance and its standard error, three floats for each pixel, and samples.
    /// The latter two may be empty.
    ///
    /// # Panics
    /// If the lengths do not fit the size.
    pub(crate) fn new(size: UVec2, rgb: &[f32], se: &[f32], n: Vec<u32>) -> Self {
        let area = size.x as usize * size.y as usize;
        assert!(rgb.len() == area * 3 && [0, area * 3].contains(&se.len()), "planes do not fit");
        assert!([0, area].contains(&n.len()), "counts do not fit");
        let finite = rgb.iter().map(|v| v.abs()).filter(|v| v.is_finite());
        let largest = finite.fold(0.0, f32::max);
        let exponent = if largest > 0.0 { f64::from(largest).log2().floor() - 14.0 } else { 0.0 };
        let unit = exponent.exp2();
        Self { size, step: 1, rgb: halves(rgb, unit), se: halves(se, unit), n, unit }
    }
}

/// Infinity and what is not a number stay so; what is finite stays finite.
#[expect(clippy::cast_possible_truncation, reason = "halves have fewer bits yet")]
fn halves(values: &[f32], unit: f64) -> Vec<f16> {
    let most = f16::MAX.to_f32();
    let scaled: Vec<f32> = values
        .iter()
        .map(|&v| {
            let v_units = (f64::from(v) / unit) as f32;
            if v.is_finite() { v_units.clamp(-most, most) } else { v_units }
        })
        .collect();
    let mut halves = vec![f16::ZERO; scaled.len()];
    halves.convert_from_f32_slice(&scaled);
    halves
}

#[cfg(test)]
mod tests {
    use luxel_core::film::Film;

    use super::*;

    const ONE: Reached = Reached { step: 1, samples: 1, left: 0, is_whole: true };

    fn of_film(film: &Film, settings: &stage::Film, now: (Reached, u32)) -> Frame {
        Frame::of_exact(&Exact::of_film(film, now.0.step), settings, now)
    }

    fn read(bytes: &[u8]) -> (Value, &[u8]) {
        assert_eq!(&bytes[..4], b"LXL1");
        let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
        let (head, planes) = bytes[8..].split_at(length);
        (serde_json::from_slice(head).unwrap(), planes)
    }

    fn half(planes: &[u8], i: usize) -> f16 {
        f16::from_le_bytes([planes[2 * i], planes[2 * i + 1]])
    }

    #[test]
    fn a_film_is_read_back_with_its_head_and_planes() {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(7, 4));
        let film = Film::new(UVec2::new(32, 16), window);
        let bytes = of_film(&film, &stage::Film::default(), (ONE, 4)).encode();
        let (head, planes) = read(&bytes);
        assert_eq!((bytes.len() - planes.len()) % 8, 0);
        assert_eq!(head["window"], json!([5, 3, 7, 4]));
        assert_eq!((&head["side"], &head["n"]), (&json!("a"), &json!(0)));
        assert_eq!((&head["complete"], &head["planes"]), (&json!(false), &json!(["rgb", "se"])));
        assert_eq!(planes.len(), 7 * 4 * 3 * 2 * 2);
        assert!(half(planes, 7 * 4 * 3).is_infinite());
    }

    #[test]
    fn a_picture_is_shown_otherwise_without_another_film() {
        let film = Film::new(UVec2::new(8, 4), Rect::new(UVec2::ZERO, UVec2::new(8, 4)));
        let [plain, brighter] = [None, Some(3.0)].map(|exposure| stage::Film {
            exposure,
            display: if exposure.is_some() { Display::Filmic } else { Display::Srgb },
            ..stage::Film::default()
        });
        let [before, wanted] = [&plain, &brighter].map(|it| of_film(&film, it, (ONE, 4)).encode());
        assert_ne!(before, wanted);
        assert_eq!(shown_as(&before, &brighter), Some(wanted));
        assert_eq!(shown_as(b"", &plain), None);
        assert_eq!(shown_as(b"LXL1\xff\xff\xff\xff", &plain), None);
    }

    #[test]
    fn a_coarse_pass_sends_the_pixels_that_it_measured() {
        let film = Film::new(UVec2::new(32, 16), Rect::new(UVec2::new(5, 3), UVec2::new(17, 8)));
        let seen = Reached { step: 8, samples: 1, left: 0, is_whole: true };
        let frame = of_film(&film, &stage::Film::default(), (seen, 1));
        let bytes = frame.encode();
        let (head, planes) = read(&bytes);
        assert_eq!((&head["pixels"], &head["step"]), (&json!([3, 1]), &json!(8)));
        assert_eq!((planes.len(), frame.complete), (3 * 3 * 2 * 2, false));
    }

    #[test]
    fn halves_keep_eleven_bits_of_radiance_at_any_scale() {
        for scale in [1e-30_f32, 1e-3, 1.0, 1e9, 1e30] {
            let values = [scale, scale * 1e-8, -scale * 0.3, f32::INFINITY, f32::NAN, 0.0];
            let pixels = Pixels::new(UVec2::new(2, 1), &values, &values, vec![]);
            for (value, half) in values.iter().zip(&pixels.rgb) {
                let back = half.to_f64() * pixels.unit;
                // Half a unit in the last of eleven places.
                let most = f64::from(value.abs()) * 2f64.powi(-11);
                let close = (back - f64::from(*value)).abs() <= most;
                assert!(close || !value.is_finite(), "{value} {back}");
            }
            assert!(pixels.rgb[3].is_infinite() && pixels.rgb[4].is_nan());
            assert_eq!(pixels.se.len(), 6);
        }
    }

    #[test]
    fn counts_are_sent_where_they_differ() {
        let pixels = Pixels::new(UVec2::new(2, 1), &[1.0; 6], &[], vec![3, 4]);
        let film = Film::new(UVec2::ONE, Rect::new(UVec2::ZERO, UVec2::ONE));
        let frame = Frame { pixels, ..of_film(&film, &stage::Film::default(), (ONE, 4)) };
        let bytes = frame.encode();
        let (head, planes) = read(&bytes);
        assert_eq!((&head["n"], &head["planes"]), (&Value::Null, &json!(["n", "rgb"])));
        assert_eq!(planes[..8], [3, 0, 0, 0, 4, 0, 0, 0]);
        let back = half(&planes[8..], 0).to_f64() * head["unit"].as_f64().unwrap();
        assert!((back - 1.0).abs() <= 0.0, "{back}");
    }
}
