//! Small files of the formats that plugins may read: a picture, two meshes and an asset.

use std::path::PathBuf;

use luxel_core::files::MemoryFiles;

/// Names of the files, in the order in which they are offered to a class that wants one.
pub(crate) const NAMES: [&str; 5] =
    ["sample.hdr", "sample.ply", "sample.obj", "sample.gltf", "sample.csv"];

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n\
0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// One triangle, its corners in a data URI: (0,0,0), (1,0,0), (0,1,0).
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// A picture of 8 × 4 pixels between 0 and 1, one of them brighter than the others.
fn hdr() -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n".to_vec();
    for i in 0..32u8 {
        // Mantissas over 256 times 2^(128 − 128): below 1.
        let [r, g, b] = if i == 11 { [250, 240, 230] } else { [130 + i, 140, 160 - i] };
        bytes.extend([r, g, b, 128]);
    }
    bytes
}

/// All of them, by the name that a scene gives.
pub(crate) fn all() -> Vec<(&'static str, Vec<u8>)> {
    let text = [(NAMES[1], PLY), (NAMES[2], OBJ), (NAMES[3], GLTF), (NAMES[4], "400,0.5\n700,1\n")];
    let text = text.map(|(name, text)| (name, text.as_bytes().to_vec()));
    std::iter::once((NAMES[0], hdr())).chain(text).collect()
}

/// All of them as the suite's file system.
pub(crate) fn memory() -> MemoryFiles {
    all()
        .into_iter()
        .fold(MemoryFiles::default(), |files, (name, bytes)| files.with(PathBuf::from(name), bytes))
}
