//! Assets in their places.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use luxel_core::files::{FileError, Files, MemoryFiles};
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::Stage;

use crate::load::stage_of;

/// Files, and how often each was read.
#[derive(Default)]
struct Counted {
    files: MemoryFiles,
    reads: Mutex<BTreeMap<PathBuf, usize>>,
}

impl Files for Counted {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        *self.reads.lock().unwrap().entry(path.to_path_buf()).or_default() += 1;
        self.files.read(path)
    }

    fn hash(&self, path: &Path) -> Option<[u8; 32]> {
        self.files.hash(path)
    }
}

/// A triangle three metres before a camera that looks at it along the file's -z.
const ASSET: &str = r#"{ "asset": { "version": "2.0" },
    "buffers": [{ "byteLength": 36, "uri": "a.bin" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
    "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
    "nodes": [{ "mesh": 0 }, { "camera": 0, "translation": [0.25, 0.5, 3] }],
    "scenes": [{ "nodes": [0, 1] }] }"#;

/// What is seen of it: white around its black shape.
fn picture(place: &str) -> Vec<DVec3> {
    let corners = [-0.5_f32, 0.0, 0.0, 1.0, 0.1, 0.0, 0.2, 1.0, 0.0];
    let bin: Vec<u8> = corners.into_iter().flat_map(f32::to_le_bytes).collect();
    let text = format!(
        "scene 1
        let a = asset gltf {{ file = \"a.gltf\", unit = 1 m }}
        film rgb {{ resolution = (24, 24) }}
        integrator path {{ max_depth = 0 }}
        sampler sobol {{ samples = 4 }}
        light constant {{ scale = 1 }}
        {place}"
    );
    let files = MemoryFiles::default()
        .with("a.scene", text.as_bytes())
        .with("a.gltf", ASSET.as_bytes())
        .with("a.bin", bin);
    let stage = stage_of(Path::new("a.scene"), &files, &[], None).expect(place);
    let (film, _) = render(&stage, &Options::default(), &Control::default());
    film.pixels().map(|(_, pixel)| pixel.mean).collect()
}

#[test]
fn the_camera_of_an_asset_moves_with_it() {
    let here = picture("place a");
    assert!(here.iter().any(|p| p.y <= 0.0) && here.iter().any(|p| p.y > 0.5));
    for place in [
        "place a { transform = move((0, 80, 7) m) }",
        "place a { transform = [rotate((1, 2, 3), 50 deg), scale(3), move((-9, 0, 4) m)] }",
        "group { group { place a { transform = rotate((0, 1, 0), 90 deg) } }
            transform = move((5, 5, 5) m) }",
        "let both = group { place a { transform = move((0, 1, 0) m) } }
            place both { transform = rotate((0, 0, 1), 1 rad) }",
    ] {
        // The same rays meet the same triangle: white and black are exact, and of 2304 samples
        // none comes within rounding (1e-14 of a pixel) of an edge.
        let there = picture(place);
        let apart = there.iter().zip(&here).map(|(a, b)| (a - b).abs().max_element());
        assert!(apart.fold(0.0, f64::max) <= 1e-12, "{place}");
    }
}

#[test]
fn an_asset_is_read_again_only_where_its_files_or_words_are_others() {
    let files = |width: f32, text: &str| {
        let corners = [-0.5_f32, 0.0, 0.0, width, 0.1, 0.0, 0.2, 1.0, 0.0];
        let bin: Vec<u8> = corners.into_iter().flat_map(f32::to_le_bytes).collect();
        let files = MemoryFiles::default()
            .with("a.scene", text.as_bytes())
            .with("a.gltf", ASSET.as_bytes())
            .with("a.bin", bin);
        Counted { files, ..Counted::default() }
    };
    let text = "scene 1
        let a = asset gltf { file = \"a.gltf\", unit = 1 m }
        film rgb { resolution = (16, 16) }
        integrator path { max_depth = 2 }
        sampler sobol { samples = 4 }
        light constant { scale = 1 }
        place a { material = material diffuse { reflectance = 0.5 } }";
    let picture = |stage: &Stage| {
        let (film, _) = render(stage, &Options::default(), &Control::default());
        film.pixels().map(|(_, pixel)| pixel.mean).collect::<Vec<_>>()
    };
    let mut before = None;
    // A comment moves all spans; another colour, another corner, another unit, and back to what is
    // still kept.
    for (width, from, to, reads) in [
        (1.0, "scene 1", "scene 1", 1),
        (1.0, "scene 1", "scene 1 // words", 0),
        (1.0, "0.5 }", "0.25 }", 0),
        (1.5, "0.5 }", "0.25 }", 1),
        (1.5, "unit = 1 m", "unit = 2 m", 1),
        (1.0, "scene 1", "scene 1", 0),
        (1.5, "0.5 }", "0.75 }", 0),
    ] {
        let files = files(width, &text.replace(from, to));
        let load = |before| stage_of(Path::new("a.scene"), &files, &[], before).unwrap();
        let warm = load(before.as_ref());
        let read = |name: &str| files.reads.lock().unwrap().get(Path::new(name)).copied();
        let count = [read("a.gltf"), read("a.bin")].map(Option::unwrap_or_default);
        assert_eq!(count, [reads; 2], "a width of {width}, {to}");
        let cold = load(None);
        assert_eq!(warm.scene, cold.scene, "{to}");
        assert_eq!(picture(&warm), picture(&cold), "{to}");
        before = Some(warm);
    }
}
