//! `luxel check --fix`: mends that are sure, written into the files that they stand in.

use std::path::Path;

use luxel_core::diag::{Diagnostic, Fix, Mended, SourceId, Sources, applied, mend};
use luxel_core::files::Files as _;
use luxel_lang::Budgets;
use serde_json::json;

use crate::args::LoadArgs;
use crate::exit::Failure;
use crate::files::DiskFiles;
use crate::interrupt::Guard;
use crate::libraries::Plugins;
use crate::load::{self, Course, Text};
use crate::output::{replace, unwritable};
use crate::report::{self, Form};

/// How often a scene is read again: what one mend uncovers the next may mend.
const ROUNDS: usize = 256;

/// Mistakes that are told each time.
const MISTAKES: usize = 1 << 12;

/// Mends that are tried one by one each time, where all together make nothing better.
const TRIED: usize = 100;

/// Mends that are told each time, the others being counted.
const TOLD: usize = 200;

/// Mends a scene and the files that it includes, and tells what was changed.
///
/// # Errors
/// A file that cannot be written; an interrupt; as `load::read`.
pub(super) fn mended(
    scene: &Path,
    args: &LoadArgs,
    plugins: &Plugins,
    form: Form,
    guard: &Guard,
) -> Result<(), Failure> {
    let budgets = args.budgets.clone().or("diagnostics", MISTAKES as f64);
    let args = LoadArgs { budgets, ..args.clone() };
    for _ in 0..ROUNDS {
        guard.next_file()?;
        let text = load::read(scene, &args, None, plugins, &Course::default())?;
        let Text { diagnostics, sources, files, .. } = &text;
        let may =
            |id| is_scene(diagnostics, id) && is_file(files, sources.name(id), sources.text(id));
        let found = mend(diagnostics, sources, may).into_iter();
        let found: Vec<_> =
            found.filter_map(|mended| bettered(mended, diagnostics, sources)).collect();
        if found.is_empty() {
            return Ok(());
        }
        for mended in &found {
            let path = Path::new(sources.name(mended.source));
            let _whole = guard.saving();
            replace(path, &mended.text).map_err(|error| unwritable(path, &error))?;
            tell(mended, sources, form)?;
        }
    }
    report::note(&format!("{}: mended {ROUNDS} times over; run it again", scene.display()));
    Ok(())
}

/// Whether a text is that of a file which the scene may read: what was set on the command line is
/// none, and neither is what has changed since it was read.
fn is_file(files: &DiskFiles, name: &str, text: &str) -> bool {
    files.read(Path::new(name)).is_ok_and(|bytes| *bytes == *text.as_bytes())
}

/// Whether a text begins as a scene does: another kind of file is not for us to change.
fn is_scene(diagnostics: &[Diagnostic], id: SourceId) -> bool {
    let of_file = |found: &&Diagnostic| found.span().is_some_and(|span| span.source == id);
    let is_other = |found: &Diagnostic| found.code == "E0001" && found.sure().is_none();
    !diagnostics.iter().filter(of_file).any(is_other)
}

/// The mends of a text that make it better: all of them, or else those that do so by themselves. Mends of
/// names and values are not asked for that.
fn bettered(all: Mended, found: &[Diagnostic], sources: &Sources) -> Option<Mended> {
    let text = sources.text(all.source);
    let is_written = |code: &str| code.starts_with("E00");
    if !all.changes.iter().any(|(code, _)| is_written(code)) {
        return Some(all);
    }
    let before = faults(text);
    if is_better(&before, &faults(&all.text)) {
        return Some(all);
    }
    let own = |fix: &Fix| found.iter().find(|found| found.fixes.contains(fix));
    let goes_on = |fix: &Fix| {
        own(fix).is_some_and(|own| goes_on(own, fix, &before, &faults(&fix.applied(text))))
    };
    let Mended { source, mut changes, .. } = all;
    changes.truncate(TRIED);
    changes.retain(|(code, fix)| !is_written(code) || goes_on(fix));
    let text = applied(text, changes.iter().map(|(_, fix)| fix));
    (!changes.is_empty()).then_some(Mended { source, text, changes })
}

/// A mistake of what is written, and where it begins.
type Fault = (String, usize);

fn fault(found: &Diagnostic) -> Fault {
    // Anything may be unexpected: there the words tell what.
    let kind = match found.code {
        "E0023" => found.message.clone(),
        code => code.to_owned(),
    };
    (kind, found.span().map_or(0, |span| span.range().start))
}

fn faults(text: &str) -> Vec<Fault> {
    let budgets = Budgets { diagnostics: MISTAKES, ..Budgets::default() };
    let (_, found) = luxel_lang::parse_only(text, &budgets);
    found.iter().filter(|found| found.is_error() && found.span().is_some()).map(fault).collect()
}

/// Whether a text has fewer mistakes, or the same ones further on: of several missing commas the first is
/// told.
fn is_better(before: &[Fault], after: &[Fault]) -> bool {
    let is_further = || {
        let mut pairs = before.iter().zip(after);
        before.len() == after.len() && pairs.all(|(b, a)| b.0 == a.0 && b.1 < a.1)
    };
    after.is_empty() || after.len() < before.len() || is_further()
}

/// Whether a mend by itself takes its own mistake away, and what is told for it lies further on, or is no
/// more than before: of an inner bracket that is right now, what stands around it may be told.
fn goes_on(own: &Diagnostic, fix: &Fix, before: &[Fault], after: &[Fault]) -> bool {
    let (own, fixed) = (fault(own), fix.span.range());
    let end = fixed.start + fix.replacement.len();
    // Where a place of the new text was in the old one.
    let old = |place: usize| {
        if place < end { place.min(fixed.start) } else { place - end + fixed.end }
    };
    let mut now = after.iter().map(|(kind, place)| (kind, old(*place)));
    let is_gone = now.clone().all(|(kind, place)| (kind, place) != (&own.0, own.1));
    let is_old = |kind: &String, place| before.iter().any(|(of, at)| of == kind && *at == place);
    is_gone
        && (after.len() <= before.len()
            || now.all(|(kind, place)| place > own.1 || is_old(kind, place)))
}

fn tell(mended: &Mended, sources: &Sources, form: Form) -> Result<(), Failure> {
    let file = sources.name(mended.source);
    let most = if form == Form::Text { TOLD } else { usize::MAX };
    for (code, fix) in mended.changes.iter().take(most) {
        let at = sources.line_column(mended.source, fix.span.range().start);
        let old = &sources.text(mended.source)[fix.span.range()];
        match form {
            Form::Text => {
                let change = change(old, fix);
                report::note(&format!("{file}:{}:{}: {code}: {change}", at.line, at.column));
            }
            Form::Json => {
                let told = json!({
                    "fixed": code,
                    "file": file,
                    "line": at.line,
                    "column": at.column,
                    "before": old,
                    "after": fix.replacement,
                });
                report::out(&format!("{told}\n"))?;
            }
        }
    }
    if let Some(n) = mended.changes.len().checked_sub(most).filter(|n| *n > 0) {
        report::note(&format!("{file}: {n} mends more"));
    }
    Ok(())
}

/// What a mend did, in words.
fn change(old: &str, fix: &Fix) -> String {
    let new = fix.replacement.trim();
    match (old, new) {
        (old, "") if old.trim().is_empty() => "a line begun".to_owned(),
        ("", new) => format!("`{new}` added"),
        (old, "") => format!("`{old}` taken out"),
        (old, new) => format!("`{old}` → `{new}`"),
    }
}
