//! The texts that spans point into.

use std::sync::{Arc, OnceLock};

use serde::Serialize;

/// Names one text among `Sources`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Default)]
pub struct SourceId(pub u32);

/// A place as people count: both from 1, the column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct LineColumn {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// Bytes of a text between places whose line and column are kept.
const STEP: usize = 1 << 16;

/// Every text that was read, by name, in reading order.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<File>,
}

/// A text that was read.
#[derive(Clone, Debug)]
struct File {
    name: String,
    text: Arc<str>,
    /// Where every `STEP`th byte stands, found when one is asked for.
    places: OnceLock<Vec<LineColumn>>,
}

impl File {
    fn places(&self) -> &[LineColumn] {
        self.places.get_or_init(|| {
            let mut places = vec![LineColumn { line: 1, column: 1 }];
            for part in self.text.as_bytes().chunks(STEP) {
                places.push(places[places.len() - 1].after(part));
            }
            places
        })
    }
}

impl Sources {
    /// Keeps a text and names it.
    ///
    /// # Panics
    /// From 2³² texts on, which no budget allows.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> SourceId {
        let (name, text, places) = (name.into(), text.into(), OnceLock::new());
        self.files.push(File { name, text, places });
        SourceId(u32::try_from(self.files.len() - 1).expect("fewer than 2^32 files are read"))
    }

    /// Adds the texts of `all` that come after as many as there are here.
    pub fn add_rest(&mut self, all: &Self) {
        self.files.extend(all.files.iter().skip(self.files.len()).cloned());
    }

    /// Gives a text that is known another content.
    pub fn replace(&mut self, id: SourceId, text: Arc<str>) {
        if let Some(file) = self.files.get_mut(id.0 as usize) {
            (file.text, file.places) = (text, OnceLock::new());
        }
    }

    /// The text of that name and content, if it is here.
    pub fn find(&self, name: &str, text: &str) -> Option<SourceId> {
        let found = self.files.iter().position(|file| file.name == name && *file.text == *text)?;
        u32::try_from(found).ok().map(SourceId)
    }

    /// How many texts there are.
    pub fn n_texts(&self) -> usize {
        self.files.len()
    }

    /// The name of a text, as the author wrote it; empty when unknown.
    pub fn name(&self, id: SourceId) -> &str {
        self.files.get(id.0 as usize).map_or("", |file| &file.name)
    }

    /// The name of the first text, which is the scene.
    pub fn first(&self) -> Option<&str> {
        self.files.first().map(|file| file.name.as_str())
    }

    /// The text; empty when unknown.
    pub fn text(&self, id: SourceId) -> &str {
        self.files.get(id.0 as usize).map_or("", |file| &file.text)
    }

    /// The text, shared; empty when unknown.
    pub fn shared(&self, id: SourceId) -> Arc<str> {
        self.files.get(id.0 as usize).map_or_else(|| "".into(), |file| file.text.clone())
    }

    /// Every text, in reading order.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|file| &*file.text)
    }

    /// Line and column of a byte; a byte past the end is taken as the end.
    pub fn line_column(&self, id: SourceId, byte: usize) -> LineColumn {
        let Some(file) = self.files.get(id.0 as usize) else {
            return LineColumn { line: 1, column: 1 };
        };
        let mut end = byte.min(file.text.len());
        while !file.text.is_char_boundary(end) {
            end -= 1;
        }
        let known = end / STEP;
        file.places()[known].after(&file.text.as_bytes()[known * STEP..end])
    }
}

impl LineColumn {
    /// Where what follows these bytes stands, if they stand here.
    fn after(self, bytes: &[u8]) -> Self {
        let n_begun = |bytes: &[u8]| bytes.iter().filter(|byte| !is_continued(**byte)).count();
        let line = self.line + memchr::memchr_iter(b'\n', bytes).count();
        let column = match memchr::memrchr(b'\n', bytes) {
            Some(end) => 1 + n_begun(&bytes[end + 1..]),
            None => self.column + n_begun(bytes),
        };
        Self { line, column }
    }
}

/// Whether a byte of UTF-8 goes on with a character.
fn is_continued(byte: u8) -> bool {
    byte & 0xC0 == 0x80
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_start_at_one() {
        let mut sources = Sources::default();
        let id = sources.add("a.scene", "scene 1\né = 漢x");
        assert_eq!(sources.line_column(id, 0), LineColumn { line: 1, column: 1 });
        let at_x = sources.text(id).find('x').unwrap();
        assert_eq!(sources.line_column(id, at_x), LineColumn { line: 2, column: 6 });
        assert_eq!(sources.line_column(id, 999), LineColumn { line: 2, column: 7 });
        sources.replace(id, "\nx".into());
        assert_eq!(sources.line_column(id, 999), LineColumn { line: 2, column: 2 });
        assert_eq!(sources.line_column(SourceId(9), 5), LineColumn { line: 1, column: 1 });
    }

    #[test]
    fn far_into_a_text_places_are_what_counting_from_its_beginning_gives() {
        let mut text = "é漢x\n".repeat(STEP / 4);
        text.push_str(&"漢".repeat(STEP));
        let mut sources = Sources::default();
        let id = sources.add("a.scene", text.as_str());
        let near = (1..=5).flat_map(|k| k * STEP - 3..k * STEP + 3);
        for byte in near.chain([0, text.len()]).filter(|byte| text.is_char_boundary(*byte)) {
            let before = &text[..byte];
            let (line, last) = (before.matches('\n').count() + 1, before.rsplit('\n').next());
            let column = last.unwrap_or_default().chars().count() + 1;
            assert_eq!(sources.line_column(id, byte), LineColumn { line, column }, "{byte}");
        }
    }
}
