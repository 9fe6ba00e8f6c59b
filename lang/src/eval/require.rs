//! `use plugin "name" version "^1"`: what a scene requires of whoever renders it. It opens nothing
//! and looks for nothing: a scene never says where code comes from.

use luxel_core::diag::{Diagnostic, nearest};
use semver::{Version, VersionReq};

use super::Evaluator;
use crate::syntax::Name;

/// At most so many libraries are listed.
const SHOWN: usize = 8;

impl Evaluator<'_> {
    /// Tells if no such library is loaded.
    pub(super) fn require(&mut self, name: &Name, version: Option<&Name>) {
        let wanted = version.map(|version| self.versions(version));
        if !is_name(&name.text) {
            let message = format!("`{}` is not the name of a plugin library", name.text);
            let help = "a name has a to z, 0 to 9 and _; where a library is, only the command line \
                        and the configuration say";
            self.tell(Diagnostic::error("E0115", name.span, message).help(help));
            return;
        }
        // Versions that cannot be understood have been told.
        if matches!(wanted, Some(None)) {
            return;
        }
        let wanted = wanted.flatten();
        let fits = |found: &str| match &wanted {
            Some(wanted) => Version::parse(found).is_ok_and(|found| wanted.matches(&found)),
            None => true,
        };
        let mut loaded = self.registry.libraries();
        if loaded.any(|(found, version)| *found == *name.text && fits(version)) {
            return;
        }
        self.n_unmet += 1;
        self.unmet(name, version);
    }

    /// The versions that are wanted; `None` if that was no requirement.
    fn versions(&mut self, text: &Name) -> Option<VersionReq> {
        match VersionReq::parse(&text.text) {
            Ok(wanted) => Some(wanted),
            Err(error) => {
                let message = format!("`{}` is not a requirement of versions: {error}", text.text);
                let help = "as in \"^1\", \">=1.2, <3\" or \"~0.4.1\"";
                self.tell(Diagnostic::error("E0115", text.span, message).help(help));
                None
            }
        }
    }

    fn unmet(&mut self, name: &Name, version: Option<&Name>) {
        let loaded: Vec<_> = self.registry.libraries().collect();
        let own = loaded.iter().find(|(found, _)| **found == *name.text);
        let span = version.map_or(name.span, |version| name.span.to(version.span));
        let wanted =
            version.map_or(String::new(), |version| format!(" version `{}`", version.text));
        let message = format!("the scene requires plugin `{}`{wanted}", name.text);
        let mut found = Diagnostic::error("E0414", span, message);
        // Two libraries may differ in what they call themselves: its own file's advice comes first.
        let (same, other): (Vec<_>, Vec<_>) =
            self.unloaded.iter().partition(|library| *library.stem == *name.text);
        let near = nearest(&name.text, loaded.iter().map(|(found, _)| *found));
        let shown: Vec<_> =
            loaded.iter().take(SHOWN).map(|(name, version)| format!("{name} {version}")).collect();
        found = match (own, near) {
            (Some((name, version)), _) => found.help(format!("loaded is `{name}` {version}")),
            (None, Some(near)) => found.help(format!("did you mean `{near}`?")),
            (None, None) if loaded.is_empty() => found.help("no plugin library is loaded"),
            (None, None) => found.help(format!("loaded are {}", shown.join(", "))),
        };
        // Where some version is loaded, strangers have nothing to do with it.
        let strangers = if own.is_some() { vec![] } else { other };
        let advice = same.into_iter().chain(strangers).take(SHOWN);
        found = advice.fold(found, |found, library| found.help(library.advice.clone()));
        self.tell(found);
    }
}

fn is_name(text: &str) -> bool {
    let legal = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_';
    !text.is_empty() && text.bytes().all(legal)
}
