//! `#[derive(Params)]`: a struct is its own schema. `#[derive(Choice)]`: an enum is a list of words.

mod attributes;
mod choice;
mod params;
mod refuse;

use proc_macro::TokenStream;

/// Makes a field-less `#[repr(u32)]` enum a choice between words: its variants in `snake_case`.
#[proc_macro_derive(Choice)]
pub fn choice(input: TokenStream) -> TokenStream {
    let input = syn::parse_macro_input!(input as syn::DeriveInput);
    choice::expand(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}

/// Makes a `#[repr(C)]` struct a plugin's parameters.
///
/// Every field is one of
/// - `#[param(…)]`: a parameter, with a doc comment and `default = …`, `required` or `optional`;
///   further keys are `min`, `max`, `unit = "m"`, `role = reflectance`, `textured`, `choice`,
///   `name = "…"`, `group = "…"`, `deprecated = "new_name"`, `emission(radiance, power)`;
/// - `#[param(derived)]`: computed by `prepare`;
/// - `#[param(shared)]`: a `Shared<'a, T>` table made by `Build<T>`.
#[proc_macro_derive(Params, attributes(param))]
pub fn params(input: TokenStream) -> TokenStream {
    let input = syn::parse_macro_input!(input as syn::DeriveInput);
    params::expand(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}
