//! What a parameter cannot be, told while the plugin compiles.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote, quote_spanned};
use syn::{Error, Expr, GenericArgument, Ident, PathArguments, Result, Type};

use crate::attributes::Attributes;

/// Types that are met often and that the host cannot write, each with what serves instead.
const INSTEAD: [(&str, &str); 10] = [
    ("Option", "use Maybe<f32>"),
    ("String", "use Text<'a>"),
    ("Box", "use Table<'a> for numbers, a `shared` table for what is built"),
    ("Vec", "use Table<'a> for numbers, a `shared` table for what is built"),
    ("Rc", "use a `shared` table"),
    ("Arc", "use a `shared` table"),
    ("Cell", "parameters do not change while a scene is rendered"),
    ("RefCell", "parameters do not change while a scene is rendered"),
    ("Mutex", "parameters do not change while a scene is rendered"),
    ("PathBuf", "use File<'a>"),
];

/// Refuses the types of `INSTEAD`; all others are judged by the trait `Field`.
pub(crate) fn known_type(ty: &Type, name: &str) -> Result<()> {
    match INSTEAD.iter().find(|(known, _)| *known == name) {
        Some((_, instead)) => {
            let message = format!("a parameter cannot be of type `{name}`: {instead}");
            Err(Error::new_spanned(ty, message))
        }
        None => Ok(()),
    }
}

/// Refuses `Text<'static>`: what the host lends does not live that long.
pub(crate) fn static_lifetime(ty: &Type) -> Result<()> {
    let Type::Path(path) = ty else { return Ok(()) };
    let Some(last) = path.path.segments.last() else { return Ok(()) };
    let PathArguments::AngleBracketed(list) = &last.arguments else { return Ok(()) };
    for argument in &list.args {
        if let GenericArgument::Lifetime(lifetime) = argument
            && lifetime.ident == "static"
        {
            let message = "the host lends this for less than 'static: give the struct a lifetime";
            return Err(Error::new_spanned(lifetime, message));
        }
    }
    Ok(())
}

/// What holds of the descriptor `SCHEMA[at]` of a field, as assertions at the field.
pub(crate) fn asserts(id: &Ident, at: usize, a: &Attributes) -> Vec<TokenStream> {
    let claim = |place: &dyn ToTokens, check: TokenStream, message: String| {
        // The message is a format string.
        let message = message.replace('{', "{{").replace('}', "}}");
        let span = syn::spanned::Spanned::span(&place.to_token_stream());
        quote_spanned! { span => const _: () = assert!(#check, #message); }
    };
    let param = quote!(&SCHEMA[#at]);
    let range = format!("{} to {}", bound(a.min.as_ref()), bound(a.max.as_ref()));
    let mut out = vec![
        claim(
            id,
            quote!(::luxel_sdk::params::range_is_ordered(#param)),
            format!("the range of `{id}` is empty: {range}"),
        ),
        claim(
            id,
            quote!(::luxel_sdk::params::choice_is_said(#param)),
            format!("`{id}` is a choice: it needs the key `choice`"),
        ),
        claim(
            id,
            quote!(::luxel_sdk::params::unit_is_known(#param)),
            format!("unknown unit `{}` of `{id}`; units are m, s, rad, W, … and products", a.unit),
        ),
        claim(
            id,
            quote!(::luxel_sdk::params::name_is_free(SCHEMA, #at)),
            format!("another parameter has the name of `{id}`"),
        ),
        // An alias may hide the lifetime that `static_lifetime` looks for.
        claim(
            id,
            quote!(LENDS || !::luxel_sdk::params::is_lent(#param)),
            format!("the host lends `{id}` for less than 'static: give the struct a lifetime"),
        ),
    ];
    if let Some(default) = &a.default {
        let default_text = text(default);
        let range = match (&a.min, &a.max, &a.role) {
            (None, None, Some(role)) => format!("that of the role `{role}`"),
            (None, None, None) => "what its type holds".to_owned(),
            _ => range,
        };
        out.push(claim(
            id,
            quote!(::luxel_sdk::params::default_is_in_range(#param)),
            format!("the default of `{id}` is outside its range: {default_text}, not {range}"),
        ));
    }
    out
}

fn bound(limit: Option<&Expr>) -> String {
    limit.map_or_else(|| "…".to_owned(), text)
}

/// An expression as it was written, but for some spaces.
fn text(expression: &Expr) -> String {
    expression.to_token_stream().to_string().replace("- ", "-").replace(" :: ", "::")
}
