//! The file itself: its JSON, its buffers and what they hold.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use gltf::binary::Glb;
use gltf::json::{Index, Root, buffer, image};
use luxel_sdk::params::{BuildContext, apart};

use super::{EXTENSIONS, uri};
use crate::sniff;

/// What a file may unfold to: numbers for each byte of its buffers. A sound file has at most one;
/// accessors that share bytes have more.
const UNFOLDING: u64 = 16;
/// What even the smallest file may unfold to.
const LEAST_BUDGET: u64 = 1 << 20;

/// An opened file.
pub(super) struct Source<'a> {
    path: &'a str,
    pub(super) context: &'a dyn BuildContext,
    /// The description.
    pub(super) root: Root,
    buffers: Vec<Arc<[u8]>>,
    /// Extensions that the file both declares and uses, and that are not understood.
    strange: Vec<String>,
    /// Numbers that may still be made of it.
    budget: Cell<u64>,
}

impl<'a> Source<'a> {
    /// Parses the file and fetches its buffers.
    ///
    /// # Errors
    /// All that is wrong with the file as a whole.
    pub(super) fn open(
        path: &'a str,
        bytes: &[u8],
        context: &'a dyn BuildContext,
    ) -> Result<Self, Vec<String>> {
        let (json, bin) = split(bytes).map_err(|message| vec![message])?;
        let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&json);
        if json.iter().find(|b| !b.is_ascii_whitespace()) != Some(&b'{') {
            let found = sniff::what(json);
            return Err(vec![format!(
                "not glTF, which is JSON or begins with `glTF`, but {found}"
            )]);
        }
        let root = parsed(json, context).map_err(|message| vec![message])?;
        let unknown: Vec<String> = root
            .extensions_required
            .iter()
            .filter(|name| !EXTENSIONS.contains(&name.as_str()))
            .map(|name| format!("it requires the extension `{name}`, which is not supported"))
            .collect();
        if !unknown.is_empty() {
            return Err(unknown);
        }
        let budget = Cell::new(0);
        let strange = |name: &&String| !EXTENSIONS.contains(&name.as_str()) && is_used(json, name);
        let strange = root.extensions_used.iter().filter(strange).cloned().collect();
        let mut out = Self { path, context, root, buffers: vec![], strange, budget };
        let mut faults = vec![];
        for (i, buffer) in out.root.buffers.iter().enumerate() {
            let bin = if i == 0 { bin.as_deref() } else { None };
            match out.fetch(buffer, bin) {
                Ok(bytes) => out.buffers.push(bytes),
                Err(message) => faults.push(format!("buffers[{i}]: {message}")),
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let size: usize = out.buffers.iter().map(|b| b.len()).sum();
        out.budget = Cell::new(LEAST_BUDGET + UNFOLDING * size as u64);
        Ok(out)
    }

    fn fetch(&self, buffer: &buffer::Buffer, bin: Option<&[u8]>) -> Result<Arc<[u8]>, String> {
        let bytes = match (&buffer.uri, bin) {
            (Some(uri), _) => self.resource(uri)?,
            (None, Some(bin)) => Arc::from(bin),
            (None, None) => return Err("it has no `uri`".to_owned()),
        };
        let wanted = buffer.byte_length.0;
        if (bytes.len() as u64) < wanted {
            return Err(format!("{wanted} bytes were promised and {} are there", bytes.len()));
        }
        Ok(bytes)
    }

    fn resource(&self, uri: &str) -> Result<Arc<[u8]>, String> {
        match uri::data(uri) {
            Some(bytes) => bytes.map(Arc::from),
            None => self.context.read_beside(self.path, &uri::file_name(uri)),
        }
    }

    /// Counts numbers that are about to be made.
    ///
    /// # Errors
    /// The file asks for far more of them than its size warrants.
    pub(super) fn spend(&self, numbers: u64) -> Result<(), String> {
        let Some(left) = self.budget.get().checked_sub(numbers) else {
            return Err(format!("{numbers} numbers are more than the file's size warrants"));
        };
        self.budget.set(left);
        Ok(())
    }

    /// The bytes of a buffer view.
    pub(super) fn view(
        &self,
        index: Index<buffer::View>,
    ) -> Result<(&[u8], &buffer::View), String> {
        let i = index.value();
        let view = self.root.get(index).ok_or_else(|| format!("there is no bufferViews[{i}]"))?;
        let buffer = self.buffers.get(view.buffer.value());
        let buffer = buffer.ok_or_else(|| format!("bufferViews[{i}]: there is no such buffer"))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let bytes = sub_slice(buffer, start, view.byte_length.0);
        let bytes = bytes.ok_or_else(|| format!("bufferViews[{i}] reaches beyond its buffer"))?;
        Ok((bytes, view))
    }

    /// The bytes of an image, with a name for them that no other has.
    pub(super) fn image(&self, index: Index<image::Image>) -> Result<(String, Arc<[u8]>), String> {
        let i = index.value();
        let image = self.root.get(index).ok_or_else(|| format!("there is no images[{i}]"))?;
        let located = |message| format!("images[{i}]: {message}");
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                let bytes = self.resource(uri).map_err(located)?;
                let inside = uri.starts_with("data:");
                let name = if inside { format!("images[{i}]") } else { uri::file_name(uri) };
                Ok((format!("{}#{name}", self.path), bytes))
            }
            (None, Some(view)) => {
                let (bytes, _) = self.view(view).map_err(located)?;
                Ok((format!("{}#images[{i}]", self.path), Arc::from(bytes)))
            }
            (None, None) => Err(located("it has neither `uri` nor `bufferView`".to_owned())),
        }
    }

    /// What the file holds that is not supported.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut out = vec![];
        for name in &self.strange {
            out.push(format!("the extension `{name}` is not supported: it is passed over"));
        }
        if !self.root.animations.is_empty() {
            out.push("animations are not supported: the file's rest pose is used".to_owned());
        }
        if !self.root.skins.is_empty() {
            out.push("skins are not supported: the bind pose is used".to_owned());
        }
        out
    }
}

/// Whether anything in the file gives this extension: whether its name stands before a colon.
/// Exporters declare more than they use.
fn is_used(json: &[u8], name: &str) -> bool {
    let key = format!("\"{name}\"");
    let is_key = |at: usize| {
        let after = json[at + key.len()..].iter().find(|b| !b.is_ascii_whitespace());
        after == Some(&b':')
    };
    let places = json.windows(key.len()).enumerate();
    places.filter(|(_, word)| *word == key.as_bytes()).any(|(at, _)| is_key(at))
}

/// Part of `bytes`; `None` beyond their end.
pub(super) fn sub_slice(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(start).ok()?;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    bytes.get(start..end)
}

type Chunk<'a> = std::borrow::Cow<'a, [u8]>;

/// Bytes of JSON from which on they are parsed apart: some milliseconds' work.
const LARGE: usize = 1 << 18;

fn parsed(json: &[u8], context: &dyn BuildContext) -> Result<Root, String> {
    let parse = |json: &[u8]| {
        let damaged = |error| format!("its JSON is damaged or not glTF 2.0 ({error})");
        Root::from_slice(json).map_err(damaged)
    };
    if json.len() < LARGE {
        return parse(json);
    }
    let json = json.to_vec();
    let work = move |_: &AtomicBool| parse(&json);
    apart(&|| !context.cancelled(), work).map_err(|error| error.to_string())?
}

/// The JSON and the binary chunk, if there is one.
fn split(bytes: &[u8]) -> Result<(Chunk<'_>, Option<Chunk<'_>>), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.into(), None));
    }
    // `Glb` subtracts the size of its header from the length without looking.
    let length = bytes.get(8..12).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
    if length < 12 {
        return Err("binary glTF without a length".to_owned());
    }
    let glb = Glb::from_slice(bytes).map_err(|error| format!("binary glTF: {error}"))?;
    Ok((glb.json, glb.bin))
}
