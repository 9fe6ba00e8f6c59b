//! Reading doc comments and `#[param(…)]`.

use syn::{Attribute, Error, Expr, ExprLit, Ident, Lit, LitStr, Meta, Result, Token};

/// The doc comment as text: lines joined by newlines, one leading space removed.
pub(crate) fn docs(attributes: &[Attribute]) -> String {
    let mut lines = vec![];
    for attribute in attributes.iter().filter(|a| a.path().is_ident("doc")) {
        if let Meta::NameValue(pair) = &attribute.meta
            && let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value
        {
            let text = text.value();
            lines.push(text.strip_prefix(' ').unwrap_or(&text).to_owned());
        }
    }
    lines.join("\n").trim().to_owned()
}

/// Whether `#[repr(wanted)]` is there, without `packed`, `align` or others beside it.
pub(crate) fn has_repr(attributes: &[Attribute], wanted: &str) -> bool {
    let mut reprs = attributes.iter().filter(|a| a.path().is_ident("repr"));
    let only = |a: &Attribute| a.parse_args::<Ident>().is_ok_and(|word| word == wanted);
    reprs.next().is_some_and(only) && reprs.next().is_none()
}

/// `HenyeyGreenstein` as `henyey_greenstein`.
pub(crate) fn snake_case(name: &str) -> String {
    let mut out = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            out.push('_');
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// What `#[param(…)]` says of one field.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a key that is there or not")]
pub(crate) struct Attributes {
    pub(crate) derived: bool,
    pub(crate) shared: bool,
    pub(crate) required: bool,
    pub(crate) optional: bool,
    pub(crate) textured: bool,
    pub(crate) choice: bool,
    pub(crate) default: Option<Expr>,
    pub(crate) min: Option<Expr>,
    pub(crate) max: Option<Expr>,
    pub(crate) unit: String,
    pub(crate) role: Option<Ident>,
    pub(crate) name: Option<String>,
    pub(crate) group: String,
    pub(crate) deprecated: String,
    pub(crate) emission: Vec<Ident>,
    /// The keys as they came, to tell repeated ones.
    keys: Vec<String>,
}

/// Every key, as messages list them.
const KEYS: &str = "default, required, optional, min, max, unit, role, textured, choice, name, \
                    group, deprecated, emission, derived, shared";

/// Every role, as scenes know them.
const ROLES: [&str; 8] =
    ["plain", "reflectance", "illuminant", "ior", "complex_ior", "coefficient", "waves", "count"];

impl Attributes {
    /// Reads the field's attribute.
    pub(crate) fn read(field: &syn::Field) -> Result<Self> {
        let mut out = Self::default();
        let mut tagged = false;
        for attribute in field.attrs.iter().filter(|a| a.path().is_ident("param")) {
            tagged = true;
            attribute.parse_nested_meta(|meta| out.key(&meta))?;
        }
        if !tagged {
            let message = "this field is not a parameter yet: it needs #[param(…)], or \
                           #[param(derived)] where `prepare` computes it";
            return Err(match &field.ident {
                Some(id) => Error::new_spanned(id, message),
                None => Error::new_spanned(&field.ty, message),
            });
        }
        out.agree(field)?;
        Ok(out)
    }

    /// Refuses keys that contradict each other.
    fn agree(&self, field: &syn::Field) -> Result<()> {
        let at = |message: String| {
            let place: &dyn quote::ToTokens = field.ident.as_ref().map_or(field, |id| id);
            Err(Error::new_spanned(place, message))
        };
        for alone in ["derived", "shared"] {
            if let Some(other) = self.keys.iter().find(|key| *key != alone)
                && self.keys.iter().any(|key| key == alone)
            {
                return at(format!("a `{alone}` field is not a parameter: without `{other}`"));
            }
        }
        if self.derived || self.shared {
            return Ok(());
        }
        let is_waves = self.role.as_ref().is_some_and(|role| role == "waves");
        let is_length = self.default.is_none() && !self.textured && self.unit == "m";
        if is_waves && !(is_length && is_spectrum(&field.ty)) {
            return at(
                "`role = waves` is for a Spectrum with `unit = \"m\"`, without `default` and \
                       `textured`"
                    .to_owned(),
            );
        }
        let given: Vec<_> = ["default", "required", "optional"]
            .into_iter()
            .filter(|word| self.keys.iter().any(|key| key == word))
            .map(|word| format!("`{word}`"))
            .collect();
        match given.len() {
            // An emission is given by its amounts.
            0 if self.emission.is_empty() => {
                at("needs one of `default = …`, `required` and `optional`".to_owned())
            }
            0 | 1 => Ok(()),
            _ => at(format!(
                "{} exclude each other: keep one of `default = …`, `required` and `optional`",
                given.join(" and ")
            )),
        }
    }

    fn key(&mut self, meta: &syn::meta::ParseNestedMeta<'_>) -> Result<()> {
        let text = |meta: &syn::meta::ParseNestedMeta<'_>| -> Result<String> {
            Ok(meta.value()?.parse::<LitStr>()?.value())
        };
        let key = meta.path.get_ident().map(ToString::to_string).unwrap_or_default();
        if self.keys.contains(&key) {
            return Err(meta.error(format!("`{key}` is given twice")));
        }
        match key.as_str() {
            "derived" => self.derived = true,
            "shared" => self.shared = true,
            "required" => self.required = true,
            "optional" => self.optional = true,
            "textured" => self.textured = true,
            "choice" => self.choice = true,
            "default" => self.default = Some(meta.value()?.parse()?),
            "min" => self.min = Some(meta.value()?.parse()?),
            "max" => self.max = Some(meta.value()?.parse()?),
            "unit" => self.unit = text(meta)?,
            "role" => self.role = Some(role(meta.value()?.parse()?)?),
            "name" => self.name = Some(text(meta)?),
            "group" => self.group = text(meta)?,
            "deprecated" => self.deprecated = text(meta)?,
            "emission" => {
                let list;
                syn::parenthesized!(list in meta.input);
                let words =
                    list.parse_terminated(<Ident as syn::parse::Parse>::parse, Token![,])?;
                self.emission = words.into_iter().collect();
            }
            _ => return Err(meta.error(format!("unknown key `{key}`; the keys are {KEYS}"))),
        }
        self.keys.push(key);
        Ok(())
    }
}

fn is_spectrum(ty: &syn::Type) -> bool {
    let syn::Type::Path(path) = ty else { return false };
    path.path.segments.last().is_some_and(|last| last.ident == "Spectrum")
}

fn role(word: Ident) -> Result<Ident> {
    if ROLES.iter().any(|known| word == known) {
        return Ok(word);
    }
    let message = format!("unknown role `{word}`; the roles are {}", ROLES.join(", "));
    Err(Error::new_spanned(word, message))
}
