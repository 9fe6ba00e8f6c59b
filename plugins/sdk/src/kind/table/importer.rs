//! Imported nodes on their way through the boundary, one call each.

use std::borrow::Cow;

use glam::{DAffine3, DVec3};

use super::table;
use crate::kind::{ImportNode, ImportValue, Imported, Importer, Kind};
use crate::params::{BuildContext, ContextRef, FaultSink, Look, Text};
use crate::wire::Slice;

/// Where an importer's nodes go: the host's functions. Node indices count from 0.
#[repr(C)]
pub struct ImportSink {
    /// The host's.
    pub owner: *mut u8,
    /// A node: kind, class and label. Its index is the number of calls before.
    pub node: unsafe extern "C" fn(*mut u8, u32, Text<'_>, Text<'_>),
    /// A parameter of the last node: its name, and which of `luxel_import_value` it is.
    pub value: unsafe extern "C" fn(*mut u8, Text<'_>, &Value),
    /// A node stands in the scene: its index, and its placement as three columns and an origin.
    pub place: unsafe extern "C" fn(*mut u8, u32, &[f64; 12]),
    /// Something in the file that is not supported.
    pub warn: unsafe extern "C" fn(*mut u8, Text<'_>),
}

/// A value of an imported node; `tag` says which field holds.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Value {
    /// 0 bool, 1 number, 2 quantity, 3 vector, 4 text, 5 rgb, 6 table, 7 look, 8 bytes, 9 node.
    pub tag: u32,
    /// The index of a node, or a bool as 0 or 1.
    pub index: u32,
    /// A number or quantity; from, to and up of a look; red, green and blue.
    pub numbers: [f64; 9],
    /// The unit of a quantity; a text; the name of bytes.
    pub text: Text<'static>,
    /// A vector or table.
    pub table: Slice<f64>,
    /// The bytes of a file inside the file.
    pub bytes: Slice<u8>,
}

const NONE: Value = Value {
    tag: 0,
    index: 0,
    numbers: [0.0; 9],
    text: Text::new(""),
    table: Slice::new(&[]),
    bytes: Slice::new(&[]),
};

impl Value {
    fn lend(value: &ImportValue, give: impl FnOnce(&Self)) {
        let mut out = NONE;
        let number = |n: f64| [n, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        match value {
            ImportValue::Bool(b) => out.index = u32::from(*b),
            ImportValue::Number(n) => (out.tag, out.numbers) = (1, number(*n)),
            ImportValue::Quantity(n, unit) => {
                (out.tag, out.numbers, out.text) = (2, number(*n), lent(unit));
            }
            ImportValue::Vector(v) => (out.tag, out.table) = (3, Slice::new(v)),
            ImportValue::Text(text) => (out.tag, out.text) = (4, lent(text)),
            ImportValue::Rgb([r, g, b]) => {
                (out.tag, out.numbers) = (5, [*r, *g, *b, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            }
            ImportValue::Table(table) => (out.tag, out.table) = (6, Slice::new(table)),
            ImportValue::Look(look) => {
                let (f, t, u) = (look.from, look.to, look.up);
                out.tag = 7;
                out.numbers = [f.x, f.y, f.z, t.x, t.y, t.z, u.x, u.y, u.z];
            }
            ImportValue::Bytes(name, bytes) => {
                (out.tag, out.text, out.bytes) = (8, lent(name), Slice::new(bytes));
            }
            ImportValue::Node(index) => {
                (out.tag, out.index) = (9, u32::try_from(*index).unwrap_or(u32::MAX));
            }
        }
        give(&out);
    }

    /// The value, copied; `None` for a tag that is none.
    ///
    /// # Safety
    /// Its text, table and bytes are lent for the call.
    pub unsafe fn take(&self) -> Option<ImportValue> {
        let n = self.numbers;
        if self.table.len().max(self.bytes.len()).max(self.text.bytes().len()) > MOST {
            return None;
        }
        // SAFETY: the caller says so.
        let table = unsafe { self.table.get() };
        // SAFETY: as above.
        let bytes = unsafe { self.bytes.get() };
        Some(match self.tag {
            0 => ImportValue::Bool(self.index != 0),
            1 => ImportValue::Number(n[0]),
            2 => ImportValue::Quantity(n[0], Cow::Owned(said(self.text))),
            3 => ImportValue::Vector(table.to_vec()),
            4 => ImportValue::Text(said(self.text)),
            5 => ImportValue::Rgb([n[0], n[1], n[2]]),
            6 => ImportValue::Table(table.into()),
            7 => ImportValue::Look(Look {
                from: DVec3::new(n[0], n[1], n[2]),
                to: DVec3::new(n[3], n[4], n[5]),
                up: DVec3::new(n[6], n[7], n[8]),
            }),
            8 => ImportValue::Bytes(said(self.text), bytes.into()),
            9 => ImportValue::Node(self.index as usize),
            _ => return None,
        })
    }
}

/// Most items of a list that a file holds: a longer one is none.
const MOST: usize = u32::MAX as usize;

/// An importer's words, which need not be UTF-8.
fn said(text: Text<'_>) -> String {
    if text.bytes().len() > MOST {
        return String::new();
    }
    // SAFETY: the importer lends it to the call.
    String::from_utf8_lossy(unsafe { text.bytes().get() }).into_owned()
}

/// The same text, for a value that is gone before it.
fn lent(text: &str) -> Text<'static> {
    Text::new(text).for_as_long_as_it_lives()
}

impl ImportSink {
    /// Gives everything away, node by node.
    fn pour(&mut self, imported: &Imported) {
        for node in &imported.nodes {
            let (class, label) = (Text::new(&node.class), Text::new(&node.label));
            // SAFETY: functions and owner were made together by the host; texts and values live.
            unsafe { (self.node)(self.owner, node.kind as u32, class, label) };
            for (name, value) in &node.params {
                // SAFETY: as above.
                Value::lend(value, |value| unsafe {
                    (self.value)(self.owner, Text::new(name), value);
                });
            }
        }
        for (node, placement) in &imported.placed {
            let index = u32::try_from(*node).unwrap_or(u32::MAX);
            // SAFETY: as above.
            unsafe { (self.place)(self.owner, index, &placement.to_cols_array()) };
        }
        for warning in &imported.warnings {
            // SAFETY: as above.
            unsafe { (self.warn)(self.owner, Text::new(warning)) };
        }
    }

    /// A sink that collects what is poured into it. `Imported` outlives the sink.
    pub fn into_imported(imported: &mut Imported) -> Self {
        Self { owner: std::ptr::from_mut(imported).cast(), node, value, place, warn }
    }
}

/// # Safety
/// `owner` is what `into_imported` made, and nobody else uses it meanwhile.
unsafe fn collected<'a>(owner: *mut u8) -> &'a mut Imported {
    // SAFETY: the caller says so.
    unsafe { &mut *owner.cast() }
}

unsafe extern "C" fn node(owner: *mut u8, kind: u32, class: Text<'_>, label: Text<'_>) {
    // SAFETY: the sink's own owner.
    let imported = unsafe { collected(owner) };
    // A kind that is none becomes one that no importer may make: the host tells it.
    let kind = Kind::ALL.get(kind as usize).map_or(Kind::Film, |(kind, _)| *kind);
    let (class, label) = (said(class), said(label));
    imported.nodes.push(ImportNode { kind, class, label, params: vec![] });
}

unsafe extern "C" fn value(owner: *mut u8, name: Text<'_>, value: &Value) {
    // SAFETY: the sink's own owner.
    let imported = unsafe { collected(owner) };
    // SAFETY: the importer lends what the value points to.
    let value = unsafe { value.take() };
    // A value that is none becomes a node that is none: the host tells it.
    let value = value.unwrap_or(ImportValue::Node(usize::MAX));
    if let Some(node) = imported.nodes.last_mut() {
        node.params.push((Cow::Owned(said(name)), value));
    }
}

unsafe extern "C" fn place(owner: *mut u8, node: u32, columns: &[f64; 12]) {
    // SAFETY: the sink's own owner.
    let imported = unsafe { collected(owner) };
    imported.placed.push((node as usize, DAffine3::from_cols_array(columns)));
}

unsafe extern "C" fn warn(owner: *mut u8, message: Text<'_>) {
    // SAFETY: the sink's own owner.
    let imported = unsafe { collected(owner) };
    imported.warnings.push(said(message));
}

table! {
    /// Bytes of another format into nodes of a scene.
    Importer => ImporterTable "luxel_importer_table" {
        /// Reads the file that the parameters name, pours nodes into `sink`, tells faults; the
        /// number of nodes, or nothing where there were faults.
        fn import(
            importer, context: &ContextRef<'_>, sink: &mut ImportSink, faults: &FaultSink
        ) -> u64 {
            let context: &dyn BuildContext = context;
            match importer.import(context) {
                Ok(imported) => {
                    sink.pour(&imported);
                    Some(imported.nodes.len() as u64)
                }
                Err(found) => {
                    faults.judge(&found);
                    None
                }
            }
        }
    }
}
