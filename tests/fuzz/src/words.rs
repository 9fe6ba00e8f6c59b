//! The dictionary: from the grammar, the registry and the file formats, made anew at each start.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use luxel_core::registry::Registry;

use crate::targets::registry;

const GRAMMAR: &str = include_str!("../../../lang/src/scene.pest");
/// What formats begin with and are made of, and numbers at the edge of something.
const FORMATS: [&[u8]; 40] = [
    b"IHDR",
    b"PLTE",
    b"IDAT",
    b"IEND",
    b"tRNS",
    b"gAMA",
    b"sRGB",
    b"acTL",
    b"\xff\xd8",
    b"\xff\xc0",
    b"\xff\xc2",
    b"\xff\xc4",
    b"\xff\xda",
    b"\xff\xdb",
    b"\xff\xdd",
    b"\xff\xd9",
    b"#?RADIANCE\n",
    b"FORMAT=32-bit_rle_rgbe\n",
    b"-Y ",
    b" +X ",
    b"\x76\x2f\x31\x01",
    b"channels\0chlist\0",
    b"compression\0",
    b"dataWindow\0",
    b"displayWindow\0",
    b"tiles\0",
    b"ply\n",
    b"element vertex ",
    b"element face ",
    b"property list uchar int vertex_indices\n",
    b"end_header\n",
    b"glTF",
    b"JSON",
    b"BIN\0",
    b"\"byteOffset\":",
    b"\"bufferView\":",
    b"\xff\xff\xff\xff",
    b"\0\0\0\x80",
    b"1e999",
    b"nan",
];
/// What begins an escape in a literal of the grammar, and what it stands for.
const ESCAPES: [(&str, &str); 4] = [("\\n", "\n"), ("\\t", "\t"), ("\\\"", "\""), ("\\\\", "\\")];

/// Words and marks of the grammar, names of classes, parameters and choices.
pub(crate) fn of_scenes() -> Vec<String> {
    let mut out: BTreeSet<String> = BTreeSet::new();
    for line in GRAMMAR.lines().filter(|line| !line.starts_with("//")) {
        let mut rest = line;
        while let Some(start) = rest.find('"') {
            let body = &rest[start + 1..];
            let ends = |at: &usize| !body[..*at].ends_with('\\') || body[..*at].ends_with("\\\\");
            let Some(end) = body.match_indices('"').map(|(at, _)| at).find(ends) else { break };
            let plain = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
            out.insert(ESCAPES.iter().fold(body[..end].to_owned(), plain));
            rest = &body[end + 1..];
        }
    }
    for entry in registry().all() {
        out.insert(entry.class.kind.word().to_owned());
        out.insert(entry.class.name.to_owned());
        out.extend(Registry::params(&entry.class).map(|param| param.name.to_owned()));
    }
    out.remove("");
    out.into_iter().collect()
}

/// All words as libFuzzer reads them: one in a line, between quotes.
pub(crate) fn dictionary() -> String {
    let mut out = String::new();
    let scenes = of_scenes();
    for word in scenes.iter().map(String::as_bytes).chain(FORMATS) {
        out.push('"');
        for byte in word {
            let _ = match byte {
                b'"' | b'\\' => write!(out, "\\{}", char::from(*byte)),
                b' '..=b'~' => write!(out, "{}", char::from(*byte)),
                _ => write!(out, "\\x{byte:02x}"),
            };
        }
        out.push_str("\"\n");
    }
    out
}
