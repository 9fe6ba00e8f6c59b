//! The header of a PLY file.

use super::value::{Encoding, Reader, Scalar};

/// One number, or a list of them, of every element of a kind.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// How the length of a list is stored; `None` for one number.
    pub(super) list: Option<Scalar>,
    pub(super) value: Scalar,
}

/// Elements of one kind.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Bytes of one in a binary file; `None` if they differ.
    pub(super) fn stride(&self) -> Option<usize> {
        let sizes = self.properties.iter().map(|p| p.list.is_none().then(|| p.value.size()));
        sizes.sum()
    }

    /// Refuses a count that the rest of the file cannot hold, before anything is made room for.
    pub(super) fn check_count(&self, reader: &Reader<'_>) -> Result<(), String> {
        let least = self.properties.iter().map(|p| match reader.encoding {
            // A digit and a space.
            Encoding::Text => 2,
            _ => p.list.unwrap_or(p.value).size(),
        });
        let least: usize = least.sum();
        let room = reader.rest().len();
        // The last space of a text may be missing.
        if self.count.checked_mul(least).is_some_and(|size| size <= room + 1) {
            return Ok(());
        }
        let Self { count, name, .. } = self;
        Err(format!("{count} of element `{name}` do not fit into the {room} bytes that are left"))
    }
}

/// What a PLY file says of itself.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the data begin.
    pub(super) length: usize,
}

impl Header {
    /// Reads up to and with `end_header`.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let mut encoding = None;
        let mut elements: Vec<Element> = vec![];
        let mut at = 0;
        for number in 1.. {
            let Some(end) = bytes[at..].iter().position(|b| *b == b'\n') else {
                return Err("a header without `end_header`".to_owned());
            };
            let line = String::from_utf8_lossy(&bytes[at..at + end]).trim().to_owned();
            at += end + 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => {}
                ["ply"] if number == 1 => {}
                ["format", word, "1.0"] => encoding = Encoding::of(word),
                ["element", name, count] => {
                    let count = count.parse().map_err(|_| format!("header: `{line}`"))?;
                    elements.push(Element { name: name.to_owned(), count, properties: vec![] });
                }
                ["property", ..] => {
                    let property = property(&words).ok_or_else(|| format!("header: `{line}`"))?;
                    let last = elements.last_mut().ok_or("header: a property of no element")?;
                    last.properties.push(property);
                }
                _ => return Err(format!("header: line {number} is not understood: `{line}`")),
            }
        }
        let encoding = encoding.ok_or(
            "header: no format `ascii`, `binary_little_endian` or `binary_big_endian` 1.0",
        )?;
        Ok(Self { encoding, elements, length: at })
    }
}

fn property(words: &[&str]) -> Option<Property> {
    let (list, value, name) = match words {
        ["property", "list", count, value, name] => (Some(Scalar::of(count)?), value, name),
        ["property", value, name] => (None, value, name),
        _ => return None,
    };
    Some(Property { name: (*name).to_owned(), list, value: Scalar::of(value)? })
}
