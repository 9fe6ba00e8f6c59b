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

/// Whether `#[repr(wanted)]` is there.
pub(crate) fn has_repr(attributes: &[Attribute], wanted: &str) -> bool {
    let mut found = false;
    for attribute in attributes.iter().filter(|a| a.path().is_ident("repr")) {
        let read = attribute.parse_nested_meta(|meta| {
            found |= meta.path.is_ident(wanted);
            Ok(())
        });
        found &= read.is_ok();
    }
    found
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
}

impl Attributes {
    /// Reads the field's attribute.
    pub(crate) fn read(field: &syn::Field) -> Result<Self> {
        let mut out = Self::default();
        let mut tagged = false;
        for attribute in field.attrs.iter().filter(|a| a.path().is_ident("param")) {
            tagged = true;
            attribute.parse_nested_meta(|meta| out.key(&meta))?;
        }
        if tagged {
            return Ok(out);
        }
        Err(Error::new_spanned(
            field,
            "every field is #[param(…)]; computed ones #[param(derived)]",
        ))
    }

    fn key(&mut self, meta: &syn::meta::ParseNestedMeta<'_>) -> Result<()> {
        let text = |meta: &syn::meta::ParseNestedMeta<'_>| -> Result<String> {
            Ok(meta.value()?.parse::<LitStr>()?.value())
        };
        let key = meta.path.get_ident().map(ToString::to_string).unwrap_or_default();
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
            "role" => self.role = Some(meta.value()?.parse()?),
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
            _ => {
                return Err(meta.error(
                    "known keys: default, required, optional, min, max, unit, role, textured, \
                     choice, name, group, deprecated, emission, derived, shared",
                ));
            }
        }
        Ok(())
    }
}
