//! URIs: data inside them, and names of files.

/// The bytes of a `data:` URI, or `None` if it is another.
///
/// # Errors
/// What is wrong with its data.
pub(super) fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = uri.strip_prefix("data:")?;
    let Some((_, text)) = rest.split_once(";base64,") else {
        return Some(Err("a data URI that is not base64".to_owned()));
    };
    Some(base64(text).ok_or_else(|| "a data URI with damaged base64".to_owned()))
}

/// # Source
/// RFC 4648 §4; padding may be missing, bits beyond the last byte are passed over.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=');
    if text.len() % 4 == 1 {
        return None;
    }
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 2);
    let (mut bits, mut n_bits) = (0u32, 0);
    for c in text.bytes() {
        let digit = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = (bits << 6 | u32::from(digit)) & 0xffff;
        n_bits += 6;
        if n_bits >= 8 {
            n_bits -= 8;
            out.push((bits >> n_bits).to_le_bytes()[0]);
        }
    }
    Some(out)
}

/// A file's name with `%20` and the like written out; what is no such code stays.
pub(super) fn file_name(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let code = bytes.get(i + 1..i + 3).and_then(|hex| std::str::from_utf8(hex).ok());
        let code = code.filter(|_| bytes[i] == b'%');
        let byte = code.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(byte.unwrap_or(bytes[i]));
        i += if byte.is_some() { 3 } else { 1 };
    }
    String::from_utf8(out).unwrap_or_else(|_| uri.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_follows_the_vectors_of_rfc_4648() {
        let cases = [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob")];
        for (text, expected) in cases {
            assert_eq!(base64(text).unwrap(), expected.as_bytes());
        }
        assert_eq!(base64("+/+/").unwrap(), [0xfb, 0xff, 0xbf]);
        for bad in ["Z", "Zm9v!", "Zm 9v", "Zm9vY"] {
            assert!(base64(bad).is_none(), "{bad}");
        }
        assert_eq!(data("data:application/octet-stream;base64,Zm9v"), Some(Ok(b"foo".to_vec())));
        assert!(data("a.bin").is_none() && data("data:,foo").unwrap().is_err());
    }

    #[test]
    fn percent_codes_become_characters() {
        let cases =
            [("a%20b.bin", "a b.bin"), ("caf%C3%A9", "café"), ("100%", "100%"), ("%zz", "%zz")];
        for (uri, expected) in cases {
            assert_eq!(file_name(uri), expected);
        }
        assert_eq!(file_name("%ff"), "%ff");
    }
}
