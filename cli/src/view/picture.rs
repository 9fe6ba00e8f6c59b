//! A picture of a file, for the page.

use glam::UVec2;

use crate::picture::Picture;
use crate::preview::{Frame, Pixels, Side, told};

use super::layers::{Layer, layers};

/// What the page shows: colour, or one of its layers.
pub(super) fn frame(picture: &Picture, layer: Option<&Layer<'_>>) -> Frame {
    let (size, n) = (picture.window.size, picture.n.clone());
    let pixels = match layer {
        Some(layer) => Pixels::new(size, &layer.rgb(picture), &[], n),
        None => Pixels::new(size, &picture.rgb, &picture.se, n),
    };
    let samples = picture.n.iter().copied().max().unwrap_or(0);
    let of_samples = picture.notes["spp"].as_u64().and_then(|spp| spp.try_into().ok());
    let settings = picture.settings();
    Frame {
        side: Side::A,
        name: String::new(),
        generation: 0,
        layer: layer.map(|layer| layer.name.to_owned()),
        size: picture.size,
        window: picture.window,
        pixels,
        exposure: settings.exposure.filter(|_| layer.is_none_or(Layer::is_light)),
        display: settings.display,
        samples,
        of_samples: of_samples.unwrap_or(samples),
        complete: picture.notes["complete"].as_bool().unwrap_or(true),
    }
}

/// The values of a pixel as they stand in the file; nothing outside.
pub(super) fn facts(picture: &Picture, at: UVec2) -> Vec<(String, String)> {
    let Some(i) = picture.index(at) else { return vec![] };
    let mut facts = told(i, (&picture.rgb, &picture.se, &picture.n));
    let layers = layers(picture);
    let of_layer = |layer: &Layer<'_>| Some((layer.name.to_owned(), layer.fact(picture, at)?));
    facts.extend(layers.iter().filter_map(of_layer));
    facts
}

/// A line about it.
pub(super) fn about(picture: &Picture) -> String {
    let mut parts = vec![format!("{} × {}", picture.size.x, picture.size.y)];
    let spp = picture.n.iter().copied().max().map(|n| format!("{n} samples per pixel"));
    parts.extend(spp);
    let words = ["color", "integrator"].map(|key| picture.notes[key].as_str().map(str::to_owned));
    parts.extend(words.into_iter().flatten());
    parts.extend(picture.is_denoised().then(|| "denoised, errors of before".to_owned()));
    parts.join(" · ")
}

#[cfg(test)]
mod tests {
    use luxel_core::film::{Film, Rect};
    use luxel_core::registry::Display;
    use luxel_core::stage;

    use super::*;
    use crate::output::Output;
    use crate::picture;
    use crate::testing::Folder;

    #[test]
    fn a_picture_of_ours_is_shown_with_error_samples_and_settings() {
        let folder = Folder::new("view-own");
        let output = Output { exr: folder.path("a.exr"), png: folder.path("a.png") };
        let film = Film::new(UVec2::new(9, 8), Rect::new(UVec2::new(2, 3), UVec2::new(4, 5)));
        let json = r#"{"exposure":9.5,"display":"filmic","spp":7,"complete":false}"#.to_owned();
        picture::write(&output, &film, &stage::Film::default(), &picture::Notes { json }).unwrap();
        let picture = Picture::open(&output.exr).unwrap();
        let frame = frame(&picture, None);
        assert_eq!((frame.size, frame.window), (film.size, film.window));
        assert_eq!((frame.exposure, frame.display), (Some(9.5), Display::Filmic));
        assert_eq!((frame.of_samples, frame.complete), (7, false));
        let told = facts(&picture, UVec2::new(5, 7));
        assert_eq!(told[0], ("radiance".to_owned(), "0 0 0".to_owned()));
        assert_eq!(told[1], ("standard error".to_owned(), "inf inf inf".to_owned()));
        assert_eq!(told[2], ("samples".to_owned(), "0".to_owned()));
        for outside in [UVec2::new(6, 7), UVec2::new(1, 7), UVec2::MAX] {
            assert!(facts(&picture, outside).is_empty());
        }
    }
}
