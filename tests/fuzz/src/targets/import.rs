//! Files of other formats, corrupt: a scene that names one is built or refused.
//!
//! The first line of an input is the file's extension, the rest its bytes.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::stage;
use luxel_lang::Settings;

use super::{registry, told};

const HEAD: &str = "scene 1
camera perspective {
  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0))
  fov  = 40 deg
}
";
/// Beside a glTF file, for its buffers.
const BUFFER: &[u8] = include_bytes!("../../../data/gltf/box_sparse.bin");

/// The statements that read a file, by its extension.
fn body(extension: &str) -> Option<&'static str> {
    Some(match extension {
        "obj" => "shape mesh { file = \"a.obj\", unit = 1 m }",
        "ply" => "let a = asset obj { file = \"a.ply\", unit = 1 m }\nplace a",
        "gltf" => "let a = asset gltf { file = \"a.gltf\", unit = 1 m }\nplace a",
        "glb" => "let a = asset gltf { file = \"a.glb\", unit = 1 m }\nplace a",
        "csv" => {
            "let a = spectrum.file(\"a.csv\")\nlet b = spectrum.file(\"a.csv\", column = \"n\")
            shape sphere { radius = 1 m, material = material diffuse { reflectance = a } }
            shape sphere { radius = 2 m, material = material diffuse { reflectance = b } }"
        }
        "picture" => {
            "shape sphere { radius = 1 m, material = material diffuse {
              reflectance = texture image { file = \"a.picture\" } } }
            shape heightfield { width = 1 m, depth = 1 m, file = \"a.picture\" }
            light environment { file = \"a.picture\" }"
        }
        _ => return None,
    })
}

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let mut parts = bytes.splitn(2, |byte| *byte == b'\n');
    let extension = parts.next().map(String::from_utf8_lossy).unwrap_or_default();
    let Some(body) = body(&extension) else { return false };
    let files = MemoryFiles::default()
        .with("a.scene", format!("{HEAD}{body}").into_bytes())
        .with(format!("a.{extension}"), parts.next().unwrap_or_default())
        .with("box_sparse.bin", BUFFER);
    let loaded = luxel_lang::load(Path::new("a.scene"), &files, registry(), &Settings::default());
    told::holds(&loaded);
    let Some(scene) = loaded.scene else { return true };
    if let Err(told) = stage::build(&scene, registry(), &files, None) {
        // A decoder that gives up in a panic is caught, but is our mistake.
        assert!(told.iter().all(|told| told.code != "E0421"), "{told:?}");
    }
    true
}
