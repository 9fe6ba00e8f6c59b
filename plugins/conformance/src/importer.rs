//! Importers: what they make fits together, and damaged files are refused or read, never a panic.

use std::path::PathBuf;
use std::sync::Arc;

use luxel_core::scene::Value;
use luxel_sdk::kind::{ImportValue, Imported, Importer};
use luxel_sdk::params::BuildContext;

use crate::report::Judge;
use crate::subject::Subject;
use crate::sweep::Set;
use crate::{files, sweep};

/// Damaged copies of each kind.
const COPIES: usize = 200;

/// Most bytes of a file of garbage.
const GARBAGE: usize = 4096;

/// One file under every name.
struct Only(Arc<[u8]>);

impl BuildContext for Only {
    fn read(&self, _path: &str) -> Result<Arc<[u8]>, String> {
        Ok(self.0.clone())
    }

    fn read_beside(&self, _base: &str, _path: &str) -> Result<Arc<[u8]>, String> {
        Ok(self.0.clone())
    }

    fn warn(&self, _message: &str) {}
}

/// No file at all.
struct Nothing;

impl BuildContext for Nothing {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
        Err(format!("`{path}`: there is no such file"))
    }

    fn read_beside(&self, _base: &str, path: &str) -> Result<Arc<[u8]>, String> {
        self.read(path)
    }

    fn warn(&self, _message: &str) {}
}

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    let Some((given, whole)) = readable(subject) else {
        return judge.skip("whole files", "it reads none of the suite's files");
    };
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let importer = resolved.importer();
            let mut tried = |bytes: &[u8], what: &str| one(importer, bytes, what, set, judge);
            tried(&whole, "whole");
            for i in 0..COPIES {
                tried(&whole[..whole.len() * i / COPIES], "cut off");
                let mut flipped = whole.clone();
                for _ in 0..=i % 4 {
                    let at = rng.u32() as usize % flipped.len();
                    flipped[at] ^= 1 << (rng.u32() % 8);
                }
                tried(&flipped, "flipped bits");
                let n = rng.u32() as usize % GARBAGE;
                let mut garbage: Vec<u8> = (0..n).map(|_| rng.u32().to_le_bytes()[0]).collect();
                let head = (i % 64).min(n).min(whole.len());
                garbage[..head].copy_from_slice(&whole[..head]);
                tried(&garbage, "garbage");
            }
            let missing = importer.import(&Nothing);
            let told = missing.err().is_some_and(|faults| !faults.is_empty());
            judge.holds("a missing file is told", told, || set.label.clone());
        });
    }
    let object = subject.bench.build(&subject.class, &given, luxel_core::object::ColorMode::Rgb);
    if let Ok(object) = object {
        let read = object.fixed().importer().import(&Only(whole.into()));
        judge.holds("whole files", read.is_ok_and(|made| !made.placed.is_empty()), || {
            sweep::said(&[])
        });
    }
}

/// The parameters and the bytes of a file that the class reads.
fn readable(subject: &Subject<'_>) -> Option<(sweep::Given, Vec<u8>)> {
    let nominal = subject.sets.first()?;
    files::all().into_iter().find_map(|(name, bytes)| {
        let mut given = nominal.given.clone();
        let file = given.iter_mut().find(|(_, value)| matches!(value, Value::Path(_)))?;
        file.1 = Value::Path(PathBuf::from(name));
        let mode = luxel_core::object::ColorMode::Rgb;
        let object = subject.bench.build(&subject.class, &given, mode).ok()?;
        let made = object.fixed().importer().import(&Only(bytes.clone().into())).ok()?;
        // An importer that hands the bytes on reads anything: a mesh fits it best.
        let hands_on = made.nodes.iter().flat_map(|node| &node.params);
        let raw = hands_on.into_iter().any(|(_, v)| matches!(v, ImportValue::Bytes(..)));
        (!raw || name.ends_with("obj")).then_some((given, bytes))
    })
}

fn one(importer: &dyn Importer, bytes: &[u8], what: &str, set: &Set, judge: &mut Judge) {
    let at = || format!("{}: {what}, {} bytes", set.label, bytes.len());
    let context = Only(bytes.into());
    let made = importer.import(&context);
    match &made {
        Ok(made) => judge.holds("what it makes fits together", fits(made), at),
        Err(faults) => {
            let told = !faults.is_empty() && faults.iter().all(|f| !f.message.is_empty());
            judge.holds("refusals say why", told, at);
        }
    }
    judge.holds("the same each time", importer.import(&context) == made, at);
}

/// Every reference names a node, and placements are finite.
fn fits(made: &Imported) -> bool {
    let n = made.nodes.len();
    let values = made.nodes.iter().flat_map(|node| &node.params);
    let refers = values.into_iter().all(|(_, value)| match value {
        ImportValue::Node(index) => *index < n,
        ImportValue::Number(x) | ImportValue::Quantity(x, _) => x.is_finite(),
        ImportValue::Rgb(rgb) => rgb.iter().all(|x| x.is_finite()),
        _ => true,
    });
    refers && made.placed.iter().all(|(index, transform)| *index < n && transform.is_finite())
}
