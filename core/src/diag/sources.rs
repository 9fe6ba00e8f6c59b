//! The texts that spans point into.

use std::sync::Arc;

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

/// Every text that was read, by name, in reading order.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<(String, Arc<str>)>,
}

impl Sources {
    /// Keeps a text and names it.
    ///
    /// # Panics
    /// From 2³² texts on, which no budget allows.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> SourceId {
        self.files.push((name.into(), text.into()));
        SourceId(u32::try_from(self.files.len() - 1).expect("fewer than 2^32 files are read"))
    }

    /// Adds the texts of `all` that come after as many as there are here.
    pub fn add_rest(&mut self, all: &Self) {
        self.files.extend(all.files.iter().skip(self.files.len()).cloned());
    }

    /// Gives a text that is known another content.
    pub fn replace(&mut self, id: SourceId, text: Arc<str>) {
        if let Some(file) = self.files.get_mut(id.0 as usize) {
            file.1 = text;
        }
    }

    /// The text of that name and content, if it is here.
    pub fn find(&self, name: &str, text: &str) -> Option<SourceId> {
        let found = self.files.iter().position(|(known, it)| known == name && **it == *text)?;
        u32::try_from(found).ok().map(SourceId)
    }

    /// How many texts there are.
    pub fn n_texts(&self) -> usize {
        self.files.len()
    }

    /// The name of a text, as the author wrote it; empty when unknown.
    pub fn name(&self, id: SourceId) -> &str {
        self.files.get(id.0 as usize).map_or("", |(name, _)| name)
    }

    /// The name of the first text, which is the scene.
    pub fn first(&self) -> Option<&str> {
        self.files.first().map(|(name, _)| name.as_str())
    }

    /// The text; empty when unknown.
    pub fn text(&self, id: SourceId) -> &str {
        self.files.get(id.0 as usize).map_or("", |(_, text)| text)
    }

    /// The text, shared; empty when unknown.
    pub fn shared(&self, id: SourceId) -> Arc<str> {
        self.files.get(id.0 as usize).map_or_else(|| "".into(), |(_, text)| text.clone())
    }

    /// Every text, in reading order.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(_, text)| &**text)
    }

    /// Line and column of a byte; a byte past the end is taken as the end.
    pub fn line_column(&self, id: SourceId, byte: usize) -> LineColumn {
        let text = self.text(id);
        let mut end = byte.min(text.len());
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &text[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        LineColumn {
            line: memchr::memchr_iter(b'\n', before.as_bytes()).count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
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
    }
}
