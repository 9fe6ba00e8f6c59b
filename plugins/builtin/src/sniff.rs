//! What a file most likely is, by its first bytes: for messages about files of the wrong kind.

/// Beginnings that tell a format.
const MAGIC: [(&[u8], &str); 20] = [
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"#?RADIANCE", "a Radiance HDR picture"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    (b"glTF", "a binary glTF file"),
    (b"ply", "a PLY mesh"),
    (b"GIF8", "a GIF picture"),
    (b"BM", "a BMP picture"),
    (b"II*\0", "a TIFF picture"),
    (b"MM\0*", "a TIFF picture"),
    (b"RIFF", "a RIFF file (WebP, sound or film)"),
    (b"\xabKTX ", "a KTX texture"),
    (b"DDS ", "a DDS texture"),
    (b"8BPS", "a Photoshop document"),
    (b"Kaydara FBX", "an FBX file"),
    (b"BLENDER", "a Blender file"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"%PDF", "a PDF document"),
    (b"solid ", "an STL mesh"),
];
/// How many bytes are looked at where no beginning tells.
const LOOKED_AT: usize = 4096;

/// What the bytes are, with its article: `a PNG picture`, `text`, `binary data`, `an empty file`.
/// A guess by the first bytes, good for a message and for nothing else.
pub(crate) fn what(bytes: &[u8]) -> &'static str {
    let told = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic));
    let first = bytes.iter().find(|b| !b.is_ascii_whitespace());
    match (told, first) {
        (Some((b"BM", _)), _) if !is_binary(bytes) => "text",
        (Some((_, name)), _) => name,
        (None, None) => "an empty file",
        _ if is_binary(bytes) => "binary data",
        (None, Some(b'{')) => "JSON, perhaps glTF",
        (None, Some(b'<')) => "XML or HTML",
        _ => "text",
    }
}

/// Whether a NUL byte, which no text holds, stands near the beginning.
pub(crate) fn is_binary(bytes: &[u8]) -> bool {
    bytes.iter().take(LOOKED_AT).any(|b| *b == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_their_beginnings_and_text_by_what_it_lacks() {
        for (bytes, told) in [
            (&b"\x89PNG\r\n\x1a\n\0"[..], "a PNG picture"),
            (b"\xff\xd8\xff\xe0\0", "a JPEG picture"),
            (b"glTF\x02\0\0\0", "a binary glTF file"),
            (b" {\"asset\":{}}", "JSON, perhaps glTF"),
            (b"BMW drives", "text"),
            (b"BM\x36\0\0\0", "a BMP picture"),
            (b"v 0 0 0\n", "text"),
            (b"v 0\0", "binary data"),
            (b" \n", "an empty file"),
        ] {
            assert_eq!(what(bytes), told);
        }
    }
}
