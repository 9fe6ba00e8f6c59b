//! What may be written in a string.

use std::ops::Range;

use luxel_sdk::color;

use super::super::texts::{Said, said};
use super::{Asked, Completion, Item, ItemKind, OnDisk};

impl Asked<'_> {
    /// What may be written in the string whose bytes so far are these.
    pub(super) fn in_text(&self, range: &Range<usize>) -> Completion {
        let mut out = Completion { range: range.clone(), ..Completion::default() };
        let value = |name: &str| Item::new(name, ItemKind::Value);
        let libraries = || self.around.registry.libraries();
        match said(self.around, self.here) {
            Said::File(ends) => {
                let written = self.around.document.text()[range.clone()].to_owned();
                out.on_disk = Some(OnDisk::Files { written, ends });
            }
            Said::Named("metal") => out.items = color::metal_names().map(value).collect(),
            Said::Named("glass") => {
                out.items = color::GLASSES.iter().map(|glass| value(glass.name)).collect();
            }
            Said::Named(_) => out.items = color::illuminant_names().map(value).collect(),
            Said::Word(param, _) => out.items = param.words().map(value).collect(),
            Said::Library => {
                let of = |(name, version): (&str, &str)| value(name).detail(version).rank(1);
                out.items = libraries().map(of).collect();
                out.on_disk = Some(OnDisk::Libraries);
            }
            Said::Version(wanted) => {
                let own = libraries().filter(|(name, _)| *name == wanted);
                out.items = own.map(|(_, version)| value(&format!("^{version}"))).collect();
            }
            Said::Other => {}
        }
        out
    }
}
