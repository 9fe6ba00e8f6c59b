//! What an object lacks, or is given more than once in different words.

use luxel_core::diag::Diagnostic;
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;

use super::Evaluator;
use super::value::{FieldValue, Head};
use crate::syntax::Name;

impl Evaluator<'_> {
    /// Checks that what must be given is given, and groups exactly once. What is `meant` by a
    /// misspelt name counts as given, and a name that is not near to any may have been meant for any.
    pub(super) fn complete(
        &mut self,
        class: &Class,
        head: &Head,
        fields: &[FieldValue],
        meant: &[Option<&str>],
    ) {
        let given = |name: &str| fields.iter().find(|f| &*f.name.text == name);
        let is_meant =
            |name: &str| meant.iter().any(|meant| meant.is_none_or(|meant| meant == name));
        let missing = |params: &[&str]| params.join("`, `");
        let mut absent = vec![];
        let mut groups: Vec<&'static str> = vec![];
        for param in Registry::params(class) {
            let is_given = given(param.name).is_some() || is_meant(param.name);
            if param.required && param.group.is_empty() && !is_given {
                absent.push(param.name);
            }
            if !param.group.is_empty() && !groups.contains(&param.group) {
                groups.push(param.group);
            }
        }
        for name in absent {
            let unit = name == "unit" && class.kind == Kind::Importer;
            let what = format!("{} {}", class.kind, class.name);
            let found = if unit {
                let message = format!("`{what}` does not say how long its unit is");
                Diagnostic::error("E0415", head.class.span, message)
                    .help("give `unit = 1 m`, `1 cm` or `1 mm`, as the file was made")
            } else {
                let message = format!("`{what}` wants `{name}`");
                let found = Diagnostic::error("E0403", head.class.span, message);
                let param = Registry::params(class).find(|p| p.name == name);
                match param {
                    Some(param) => {
                        found.help(format!("`{name}` is {}", luxel_core::scene::wanted(param)))
                    }
                    None => found,
                }
            };
            self.tell(found);
        }
        for group in groups {
            let members: Vec<&str> =
                Registry::params(class).filter(|p| p.group == group).map(|p| p.name).collect();
            let mut chosen: Vec<&Name> =
                members.iter().filter_map(|m| given(m)).map(|f| &f.name).collect();
            chosen.sort_by_key(|name| name.span);
            if let [first, second, ..] = chosen[..] {
                let (a, b) = (&first.text, &second.text);
                let message = format!("`{a}` and `{b}` are both given; only one can be");
                let found = Diagnostic::error("E0406", second.span, message);
                self.tell(found.label(first.span, "first given here"));
            } else if chosen.is_empty() && !members.iter().any(|member| is_meant(member)) {
                let message = format!("one of `{}` is wanted", missing(&members));
                let found = Diagnostic::error("E0403", head.class.span, message);
                self.tell(if members.contains(&"scale") {
                    found.help("`scale = 1` takes the spectrum as it is")
                } else {
                    found
                });
            }
        }
    }
}
