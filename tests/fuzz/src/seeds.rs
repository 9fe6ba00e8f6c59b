//! Where fuzzing begins: made at each start of what the project holds already.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::UVec2;
use image::{DynamicImage, ImageFormat};
use luxel_core::film::{Film, Rect};

use crate::words;

/// Names and inputs.
pub(crate) type Seeds = Vec<(String, Vec<u8>)>;

/// The largest input from a file, bytes.
const LARGEST: usize = 1 << 16;

/// Writes the seeds of a target and the dictionary below the folder that `LUXEL_FUZZ_SEEDS` names.
pub(crate) fn write(target: &str, seeds: Seeds) {
    let Some(folder) = std::env::var_os("LUXEL_FUZZ_SEEDS").map(PathBuf::from) else { return };
    let put = || {
        fs::create_dir_all(folder.join(target))?;
        for (name, bytes) in seeds {
            fs::write(folder.join(target).join(name), bytes)?;
        }
        fs::write(folder.join("words"), words::dictionary())
    };
    put().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: impl AsRef<Path>) -> Vec<u8> {
    let path = root().join(path);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Every scene of the project that is not long, each case of the language and of the formatter.
pub(crate) fn texts() -> Seeds {
    let mut out = vec![];
    for folder in ["scenes", "lang/tests/scenes", "lang/tests/scenes/lib", "cli/src/verify/truths"]
    {
        for entry in fs::read_dir(root().join(folder)).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|extension| extension == "scene") {
                out.push((path.file_name().unwrap_or_default().display().to_string(), read(path)));
            }
        }
    }
    for entry in fs::read_dir(root().join("lang/tests/cases")).into_iter().flatten().flatten() {
        let text = String::from_utf8_lossy(&read(entry.path())).into_owned();
        for (i, case) in text.split("\n--- ").skip(1).enumerate() {
            let body = case.split_once(" ---\n").map_or(case, |(_, body)| body);
            let body = body.split("\n=>\n").next().unwrap_or_default();
            let head = if body.contains("scene 1") { "" } else { "scene 1\n" };
            let name = format!("{}-{i}", entry.path().file_stem().unwrap_or_default().display());
            out.push((name, format!("{head}{body}\n").into_bytes()));
        }
    }
    for (code, _) in luxel_lang::CATALOGUE {
        let page = luxel_lang::page(code);
        let both = page.map(|page| [page.example.wrong, page.example.right]);
        for (i, text) in both.into_iter().flatten().enumerate() {
            out.push((format!("{code}-{i}"), text.as_bytes().to_vec()));
        }
    }
    out.retain(|(_, text)| text.len() < LARGEST);
    out
}

/// Texts with three edits each: something typed, something deleted, something pasted.
pub(crate) fn edits() -> Seeds {
    const EDITS: &[u8] = b"\xFF\x80\0\0{ a = \xFF\x40\0\x08\xFF\xC0\0\x01\nlet b = 1\n";
    let with = |(name, text)| (name, [text, EDITS.to_vec()].concat());
    texts().into_iter().map(with).collect()
}

/// Bytes that choose anything.
pub(crate) fn noise() -> Seeds {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        state.to_le_bytes()[7]
    };
    (0..32).map(|i| (format!("noise-{i}"), (0..1024).map(|_| next()).collect())).collect()
}

/// What opens, what stands within, and what closes.
pub(crate) fn nested() -> Seeds {
    const TEXTS: [&str; 14] = [
        "material x { b = ~1 +~ }",
        "let a = [~1~]\n",
        "(1 + 2 * -~~)",
        "if true { ~1~ } else { 2 }",
        "group {\n~a = = 1\n~}\n",
        "f(a = ~,~)",
        "[for i in a => ~~]",
        "let a = 5 +\n~~",
        "/* ~~ */",
        "a with { b = ~1.2.3~ }",
        "fn g() {\n~let let = 1~\n}\n",
        "expect mean = ~1~ where {\n",
        "/// doc\n~~@off ",
        "shape \"~~\" { radius 5 cm }\n",
    ];
    TEXTS.iter().enumerate().map(|(i, text)| (format!("{i}"), text.as_bytes().to_vec())).collect()
}

/// Files of every format that a scene may name.
pub(crate) fn files() -> Seeds {
    const OBJ: &[u8] = b"o a\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\n\
        f 1/1/1 2/1/1 3//1\ns 1\nusemtl m\nf -1 -2 -3\nf 1 2 4 3\nl 1 2\n";
    const PLY: &[u8] = b"ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\n\
        property double y\nproperty float z\nproperty uchar red\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n";
    const CSV: &[u8] = b"# c\nnm, n, k\n400, 1.5, 2\n500 1.4 // c\n700,1.3,1e3\n";
    let mut out = vec![("obj", OBJ.to_vec()), ("ply", PLY.to_vec()), ("csv", CSV.to_vec())];
    for little in [true, false] {
        out.push(("ply", binary_ply(little)));
    }
    out.push(("obj", read("tests/data/mesh/spot_control_mesh.obj")));
    out.push(("gltf", read("tests/data/gltf/box_sparse.gltf")));
    out.push(("glb", read("tests/data/gltf/box_sparse.glb")));
    out.push(("glb", read("tests/data/gltf/CornellBox.glb")));
    out.extend(pictures().into_iter().map(|picture| ("picture", picture)));
    let name = |(i, (kind, bytes)): (usize, (&str, Vec<u8>))| {
        (format!("{i}"), [kind.as_bytes(), b"\n", &bytes].concat())
    };
    out.into_iter().enumerate().map(name).collect()
}

fn binary_ply(little: bool) -> Vec<u8> {
    let order = if little { "little" } else { "big" };
    let mut out = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty float x\n\
         property float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for x in [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        out.extend(if little { x.to_le_bytes() } else { x.to_be_bytes() });
    }
    out.push(3);
    for i in 0..3u32 {
        out.extend(if little { i.to_le_bytes() } else { i.to_be_bytes() });
    }
    out
}

/// The same picture in every format and depth.
fn pictures() -> Vec<Vec<u8>> {
    let rgba = image::Rgba32FImage::from_fn(9, 7, |x, y| {
        image::Rgba([x as f32 / 9.0, y as f32 / 7.0, 0.5, 1.0 - x as f32 / 18.0])
    });
    let picture = DynamicImage::ImageRgba32F(rgba);
    let rgb = DynamicImage::from(picture.to_rgb32f());
    let made = [
        (ImageFormat::Png, DynamicImage::from(picture.to_rgba8())),
        (ImageFormat::Png, DynamicImage::from(picture.to_luma16())),
        (ImageFormat::Jpeg, DynamicImage::from(picture.to_rgb8())),
        (ImageFormat::Jpeg, DynamicImage::from(picture.to_luma8())),
        (ImageFormat::Hdr, rgb.clone()),
        (ImageFormat::OpenExr, rgb),
        (ImageFormat::OpenExr, picture),
    ];
    let encoded = |(format, picture): (ImageFormat, DynamicImage)| {
        let mut out = Cursor::new(vec![]);
        picture.write_to(&mut out, format).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        out.into_inner()
    };
    made.into_iter().map(encoded).collect()
}

/// An empty film, whole and with a window.
pub(crate) fn films() -> Seeds {
    let windows = [([0, 0], [3, 2]), ([1, 1], [2, 1])];
    let film = |(i, (min, size)): (usize, ([u32; 2], [u32; 2]))| {
        let film = Film::new(UVec2::new(3, 2), Rect::new(min.into(), size.into()));
        let mut out = vec![];
        film.save(&mut out).expect("memory takes everything");
        (format!("{i}"), out)
    };
    windows.into_iter().enumerate().map(film).collect()
}
