//! What an object is: its kind and its class.

use luxel_core::diag::{Diagnostic, Grade, Near, Span, near};
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;

use super::Evaluator;
use super::elsewhere::meant;
use super::env::Env;
use super::stray::takers;
use super::unseen::is_slip;
use super::value::{Head, Value};
use crate::syntax::{Name, Object};

/// Libraries that a message lists, at most.
const SHOWN: usize = 8;

impl Evaluator<'_> {
    /// What an object is; where nothing is that, which is told, what it surely was meant to be. `env` has
    /// the names that may be meant by its kind.
    pub(super) fn head(
        &mut self,
        object: &Object,
        span: Span,
        within: Option<&Class>,
        env: Option<&Env>,
    ) -> Result<Head, Option<Head>> {
        let category = &object.category;
        let Some(kind) = Kind::of_word(&category.text) else {
            self.no_category(object, within);
            return Err(None);
        };
        let names = || self.registry.of_kind(kind).map(|e| e.class.name).collect::<Vec<_>>();
        let Some(class) = &object.kind else {
            let message = format!("which {kind}? its name is missing after `{kind}`");
            let mut found = Diagnostic::error("E0401", category.span, message);
            // `material "diffuse" { … }`
            let quoted = object.label.as_ref();
            let class = quoted.filter(|it| self.registry.class(kind, &it.text).is_some());
            if let Some(class) = class {
                let message = format!("the name of a {kind} stands without quotes");
                found = Diagnostic::error("E0401", class.span, message);
                found = found.fix(class.span, &*class.text);
            }
            let meant = class.map(|class| Head {
                kind: Some(kind),
                class: Name { text: class.text.clone(), span: class.span },
                label: None,
                span,
            });
            let names = names().join(", ");
            self.tell(found.help(format!("known are {names}")));
            return Err(meant);
        };
        let (class, label) = (class.clone(), object.label.clone());
        let head = Head { kind: Some(kind), class, label, span };
        if self.registry.class(kind, &head.class.text).is_some() {
            return Ok(head);
        }
        let near = self.no_class(kind, &head.class, &names(), env);
        let sure = near.filter(|near| near.grade == Grade::Sure);
        let named = |near: Near<'_>| Name { text: near.name.into(), ..head.class.clone() };
        Err(sure.map(|near| Head { class: named(near), ..head.clone() }))
    }

    /// Tells of a word that is no kind of object, and what may be meant by it.
    fn no_category(&mut self, object: &Object, within: Option<&Class>) {
        let category = &object.category;
        let words = || Kind::ALL.iter().map(|(_, word)| *word).chain(["group"]);
        let meant = near(&category.text, words().chain(["units"]));
        let is_other = meant.is_some_and(|meant| !is_slip(meant.name));
        self.unseen.thing |= !is_other;
        let message = format!("there is no kind of object `{}`", category.text);
        let found = Diagnostic::error("E0401", category.span, message).meant(category.span, meant);
        let kinds = Kind::ALL.iter().filter(|(kind, _)| {
            let name = category.text.to_lowercase();
            let is_one = object.kind.is_none() || object.label.is_none();
            self.registry.class(*kind, &name).is_some() && is_one
        });
        let start = Span { end: category.span.start, ..category.span };
        let found = kinds.fold(found, |found, (kind, word)| {
            let name = category.text.to_lowercase();
            let param = within.and_then(|class| takers(class, *kind).next());
            let given = param.map_or(String::new(), |param| format!("{} = ", param.name));
            // `sphere ball { … }` and `sphere shape { … }`
            if let Some(label) = &object.kind {
                let all = category.span.to(label.span);
                if *label.text == **word {
                    return found.guess(all, format!("{given}{word} {name}"));
                }
                return found.guess(all, format!("{given}{word} {name} \"{}\"", label.text));
            }
            if name == *category.text {
                return found.guess(start, format!("{given}{word} "));
            }
            found.guess(category.span, format!("{given}{word} {name}"))
        });
        let known: Vec<_> = words().collect();
        self.tell(found.help(format!("known are {}", known.join(", "))));
    }

    /// Tells of a class that nobody has, and which libraries that are not loaded may have it; gives the one
    /// that was probably meant.
    fn no_class<'n>(
        &mut self,
        kind: Kind,
        class: &Name,
        names: &[&'n str],
        env: Option<&Env>,
    ) -> Option<Near<'n>> {
        let near = meant(&class.text, names);
        // It may be of the plugin that is asked for and not there, which has been told.
        if near.is_none() && self.n_unmet > 0 {
            return None;
        }
        let namesake = self.unloaded.iter().any(|library| *library.stem == *class.text);
        let missing = namesake || (near.is_none() && !self.unloaded.is_empty());
        let code = if missing { "E0414" } else { "E0401" };
        let message = format!("there is no {kind} `{}`", class.text);
        let mut found = Diagnostic::error(code, class.span, message).meant(class.span, near);
        if missing {
            let advice = self.unloaded.iter().take(SHOWN).map(|library| library.advice.clone());
            found = advice.fold(found, Diagnostic::help);
        }
        // `material red { }`, where `let red = material diffuse { … }` stands above
        if let Some(Value::Object(_)) = env.and_then(|env| env.get(&class.text)) {
            let name = &class.text;
            let help =
                format!("`{name}` is the name of an object: `{name}`, or `{name} with {{ … }}`");
            found = found.help(help);
        }
        self.tell(found.help(format!("known are {}", names.join(", "))));
        near
    }
}
