//! `#[derive(Choice)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Error, Result};

use crate::attributes::{docs, has_repr, snake_case};

pub(crate) fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let Data::Enum(data) = &input.data else {
        return Err(Error::new_spanned(name, "a choice is an enum without fields"));
    };
    if !has_repr(&input.attrs, "u32") {
        return Err(Error::new_spanned(
            name,
            "a choice needs #[repr(u32)] alone: the host writes it by index",
        ));
    }
    let mut words = vec![];
    let variants = data.variants.iter().map(|variant| &variant.ident);
    for variant in &data.variants {
        if !variant.fields.is_empty() || variant.discriminant.is_some() {
            let message = "a word of a choice has no fields and no number of its own";
            return Err(Error::new_spanned(&variant.ident, message));
        }
        if docs(&variant.attrs).is_empty() {
            let message = "needs a doc comment: what a scene says by this word";
            return Err(Error::new_spanned(&variant.ident, message));
        }
        words.push(snake_case(&variant.ident.to_string()));
    }
    Ok(quote! {
        // The host makes variants by index, which the compiler cannot see.
        const _: &[#name] = &[#(#name::#variants),*];
        // SAFETY: field-less variants count from 0, as checked by the derive.
        #[automatically_derived]
        #[expect(unsafe_code, reason = "the derive has checked that every index is a variant")]
        unsafe impl ::luxel_sdk::params::Choice for #name {
            const WORDS: &'static [::luxel_sdk::params::Text<'static>] =
                &[#(::luxel_sdk::params::Text::new(#words)),*];
        }
        #[automatically_derived]
        #[expect(unsafe_code, reason = "the host writes an index below the number of words")]
        // SAFETY: as above.
        unsafe impl ::luxel_sdk::params::Field for #name {
            const TYPE: ::luxel_sdk::params::Type = ::luxel_sdk::params::Type::Choice;
        }
    })
}
