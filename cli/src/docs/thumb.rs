//! Pictures of what manuals show.

use std::path::Path;

use glam::{DVec3, UVec2};
use luxel_core::diag::Diagnostic;
use luxel_core::film::Film;
use luxel_core::registry::{Display, Entry, Registry};
use luxel_core::render::Options;
use luxel_core::stage::{self, Stage};
use luxel_lang::manual::Word;
use luxel_sdk::color::RgbSpace;
use luxel_sdk::kind::Kind;

use super::scene::around;
use super::stand_in;
use crate::exit::{Exit, Failure, blaming};
use crate::picture::{show, write_signal};
use crate::verify::Run;

/// What a scene in a manual begins with.
pub(super) const SNIPPET: &str = "```scene";

const SIZE: UVec2 = UVec2::new(240, 160);
const SPP: u32 = 32;
/// Field of view of the camera that sees all of a snippet's shapes, degrees.
const FOV: f64 = 34.0;
/// Where it stands, seen from the middle of them.
const FROM: DVec3 = DVec3::new(0.45, 0.35, 0.82);
/// Share of the pixels that may be brighter than white, where the light is the manual's own.
const BRIGHTEST: f64 = 0.03;

/// What a manual shows.
pub(super) struct Shown<'m> {
    /// Whose manual it is of: `shape sphere`.
    pub(super) of: String,
    /// Its place among what that shows, from 0.
    pub(super) number: usize,
    kind: Kind,
    snippet: &'m str,
}

impl<'m> Shown<'m> {
    /// All that the manual of a class shows.
    pub(super) fn of_class(entry: &'m Entry) -> impl Iterator<Item = Self> {
        let kind = entry.class.kind;
        let of = format!("{kind} {}", entry.class.name);
        let snippets = entry.class.doc.split(SNIPPET).skip(1);
        let snippets = snippets.filter_map(|from| Some(from.split("```").next()?.trim()));
        snippets.enumerate().map(move |(number, snippet)| Self {
            of: of.clone(),
            number,
            kind,
            snippet,
        })
    }

    /// What the language's own words show are shapes in their places.
    pub(super) fn of_word(word: &'m Word) -> Self {
        Self { of: word.name.to_owned(), number: 0, kind: Kind::Shape, snippet: word.parts().1 }
    }

    /// The picture's place in the folder.
    pub(super) fn file(&self) -> String {
        let of = self.of.replace(' ', "-");
        if self.number == 0 { format!("{of}.png") } else { format!("{of}-{}.png", self.number + 1) }
    }

    /// The files that it names and that another stands for in the picture.
    pub(super) fn stand_ins(&self) -> Vec<&'static str> {
        stand_in::names(self.snippet).collect()
    }
}

/// A PNG of what a manual shows; `None` where it needs files that nothing stands for, or shows
/// nothing.
///
/// # Errors
/// Ctrl-C; a panic below, with the name of what the manual is of.
pub(super) fn png(shown: &Shown<'_>, run: &Run) -> Result<Option<Vec<u8>>, Failure> {
    let name = format!("the manual of {}", shown.of);
    let stage = blaming(&name, || of_manual(shown, &run.plugins.registry))?;
    let Some(stage) = stage else { return Ok(None) };
    let options = Options { spp: Some(SPP), ..run.options.clone() };
    match run.film((Path::new(&name), &stage), &options) {
        Ok(film) => Ok(drawn(&film, shown.kind)),
        Err(failure) if failure.exit == Exit::Incomplete => Err(failure),
        Err(_) => Ok(None),
    }
}

/// The stage of what a manual shows.
fn of_manual(shown: &Shown<'_>, registry: &Registry) -> Option<Stage> {
    let staged = |camera: &str| stage_of(&around(shown.kind, shown.snippet, camera), registry);
    // Once to see where its shapes are, and once more to look at them.
    let (centre, radius) = staged(&camera((DVec3::ZERO, 1.0)))?.sphere;
    let is_somewhere = centre.is_finite() && radius.is_finite() && radius > 0.0;
    staged(&camera(if is_somewhere { (centre, radius) } else { (DVec3::ZERO, 2.0) }))
}

/// The stage of a text that needs no files but those that something stands for; names that it does not make are brown materials.
fn stage_of(text: &str, registry: &Registry) -> Option<Stage> {
    let load = |text: &str| {
        let files = stand_in::files(text).with("manual.scene", text.as_bytes());
        let settings = luxel_lang::Settings::default();
        luxel_lang::load(Path::new("manual.scene"), &files, registry, &settings)
    };
    let first = load(text);
    let missing = |found: &Diagnostic| {
        let name = &text[found.span().filter(|_| found.code == "E0101")?.range()];
        Some(format!(
            "let {name} = material diffuse {{ reflectance = rgb.linear_srgb(0.55, 0.35, 0.2) }}\n"
        ))
    };
    let mut lets: Vec<String> = first.diagnostics.iter().filter_map(missing).collect();
    lets.sort();
    lets.dedup();
    let whole = text.replacen("scene 1\n", &format!("scene 1\n{}", lets.concat()), 1);
    let mut scene = load(&whole).scene?;
    scene.set_resolution(SIZE);
    let built = stage::build(&scene, registry, &stand_in::files(text), None);
    built.ok().map(|built| built.stage)
}

/// A camera that sees a ball whole.
fn camera((centre, radius): (DVec3, f64)) -> String {
    let away = 1.15 * radius / (0.5 * FOV.to_radians()).sin();
    let from = centre + FROM.normalize() * away;
    let point = |p: DVec3| format!("({:?}, {:?}, {:?}) m", p.x, p.y, p.z);
    format!(
        "camera perspective {{ look = look_at(from = {}, to = {}, up = (0, 1, 0)), fov = {FOV:?} deg }}\n",
        point(from),
        point(centre),
    )
}

/// The picture, under a light of its own exposed so that few pixels are clipped; `None` if it is black.
fn drawn(film: &Film, kind: Kind) -> Option<Vec<u8>> {
    let weights = RgbSpace::LinearSrgb.luminance_weights();
    let mut bright: Vec<f64> = film.pixels().map(|(_, pixel)| weights.dot(pixel.mean)).collect();
    bright.sort_by(f64::total_cmp);
    #[expect(clippy::cast_possible_truncation, reason = "a share of a small number of pixels")]
    #[expect(clippy::cast_sign_loss, reason = "a share of a small number of pixels")]
    let clipped = (bright.len() as f64 * BRIGHTEST) as usize;
    let white = if kind == Kind::Light { bright[bright.len() - 1 - clipped] } else { 1.0 };
    if white.is_nan() || white <= 0.0 || bright[bright.len() - 1] <= 0.0 {
        return None;
    }
    let signal = film.pixels().map(|(_, pixel)| show(pixel.mean / white, Display::Srgb));
    let mut bytes = vec![];
    write_signal(&mut bytes, film.window.size, signal).ok().map(|()| bytes)
}

#[cfg(test)]
mod tests {
    use luxel_lang::manual::WORDS;

    use super::super::manual;
    use super::*;

    fn registry() -> Registry {
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).unwrap();
        }
        registry
    }

    #[test]
    fn what_every_built_in_and_every_word_shows_can_be_drawn() {
        let registry = registry();
        for entry in registry.all() {
            let all: Vec<_> = Shown::of_class(entry).collect();
            assert!(!all.is_empty(), "{} {} shows nothing", entry.class.kind, entry.class.name);
            for shown in all {
                assert!(of_manual(&shown, &registry).is_some(), "{}", shown.file());
            }
        }
        for word in &WORDS {
            assert!(of_manual(&Shown::of_word(word), &registry).is_some(), "{}", word.name);
        }
    }

    #[test]
    fn each_picture_stands_above_what_it_is_of() {
        let registry = registry();
        let entry = registry.all().find(|entry| entry.class.name == "mesh").unwrap();
        let all: Vec<_> = Shown::of_class(entry).collect();
        let page = manual::class(entry, &all).body;
        let places = ["shape-mesh.png", "cow", "shape-mesh-2.png", "pebble"];
        let places = places.map(|word| page.find(word).unwrap_or_else(|| panic!("no {word}")));
        assert!(places.is_sorted(), "{places:?}");
        // Without the second picture all is there but that.
        let fewer = manual::class(entry, &all[..1]).body;
        assert!(fewer.contains("pebble") && !fewer.contains("shape-mesh-2.png"));
    }

    #[test]
    fn what_needs_another_file_is_not_drawn() {
        let snippet = "shape mesh { file = \"assets/other.obj\", unit = 1 m }";
        let shown = Shown { of: "shape mesh".to_owned(), number: 0, kind: Kind::Shape, snippet };
        assert!(shown.stand_ins().is_empty());
        assert!(of_manual(&shown, &registry()).is_none());
        let snippet = "shape mesh { file = \"assets/spot.obj\", unit = 1 m }";
        assert_eq!(Shown { snippet, ..shown }.stand_ins(), ["assets/spot.obj"]);
    }
}
