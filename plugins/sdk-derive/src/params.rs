//! `#[derive(Params)]`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote, quote_spanned};
use syn::{Data, DeriveInput, Error, Field, GenericArgument, Ident, PathArguments, Result, Type};

use crate::attributes::{Attributes, docs, has_repr};
use crate::refuse;

/// Names of field types whose values a texture may drive.
const TEXTURED: [&str; 5] = ["f32", "Vec3", "Spectrum", "Emission", "ComplexIor"];

struct Parts {
    descriptors: Vec<TokenStream>,
    /// What the compiler must find true, each at the place that it speaks of.
    asserts: Vec<TokenStream>,
    /// Types of derived fields, each of which must be `Plain`.
    derived: Vec<Type>,
    shared: TokenStream,
    /// The field that holds the shared table, and the table's type.
    table: Option<(Ident, Type)>,
}

pub(crate) fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let doc = docs(&input.attrs);
    let Data::Struct(data) = &input.data else {
        return Err(Error::new_spanned(name, "parameters are a struct, not an enum or a union"));
    };
    if !has_repr(&input.attrs, "C") {
        return Err(Error::new_spanned(name, "needs #[repr(C)] alone: the host writes fields"));
    }
    let others = input.generics.type_params().count() + input.generics.const_params().count();
    if others > 0 || input.generics.lifetimes().count() > 1 {
        let message = "parameters have one layout: at most one lifetime and nothing else here";
        return Err(Error::new_spanned(&input.generics, message));
    }
    if doc.is_empty() {
        return Err(Error::new_spanned(name, "needs a doc comment: it is the manual page"));
    }
    let mut parts = Parts {
        descriptors: vec![],
        asserts: vec![],
        derived: vec![],
        shared: quote!(None),
        table: None,
    };
    let mut errors: Option<Error> = None;
    for field in &data.fields {
        if let Err(error) = parts.field(field) {
            match &mut errors {
                Some(all) => all.combine(error),
                None => errors = Some(error),
            }
        }
    }
    match errors {
        Some(error) => Err(error),
        None => Ok(parts.finish(input, &doc)),
    }
}

impl Parts {
    fn field(&mut self, field: &Field) -> Result<()> {
        let attributes = Attributes::read(field)?;
        let Some(id) = &field.ident else {
            return Err(Error::new_spanned(
                &field.ty,
                "needs a name: scenes give parameters by name",
            ));
        };
        refuse::static_lifetime(&field.ty)?;
        if attributes.derived {
            self.derived.push(field.ty.clone());
            return Ok(());
        }
        if attributes.shared {
            return self.shared_field(id, &field.ty);
        }
        let doc = docs(&field.attrs);
        if doc.is_empty() {
            return Err(Error::new_spanned(id, "needs a doc comment: it becomes the manual"));
        }
        let type_name = last_segment(&field.ty);
        refuse::known_type(&field.ty, &type_name)?;
        if attributes.textured && !TEXTURED.contains(&type_name.as_str()) {
            let message = format!("a texture cannot drive this, only {}", TEXTURED.join(", "));
            return Err(Error::new_spanned(&field.ty, message));
        }
        if (type_name == "Emission") == attributes.emission.is_empty() {
            let message = "an Emission and the key `emission(…)` with its amounts go together";
            return Err(Error::new_spanned(&field.ty, message));
        }
        let at = self.descriptors.len();
        self.asserts.extend(refuse::asserts(id, at, &attributes));
        self.descriptors.push(descriptor(id, &field.ty, &type_name, &doc, &attributes));
        if type_name == "ComplexIor" {
            self.descriptors.push(extinction(id, &attributes));
        }
        for amount in &attributes.emission {
            self.descriptors.push(amount_descriptor(id, amount)?);
        }
        Ok(())
    }

    fn shared_field(&mut self, id: &Ident, ty: &Type) -> Result<()> {
        if let Some((other, _)) = &self.table {
            let message = format!("`{other}` is the shared table already: put both into one type");
            return Err(Error::new_spanned(id, message));
        }
        let table = match ty {
            Type::Path(path) if last_segment(ty) == "Shared" => {
                path.path.segments.last().and_then(|last| match &last.arguments {
                    PathArguments::AngleBracketed(list) => list.args.last(),
                    _ => None,
                })
            }
            _ => None,
        };
        let Some(GenericArgument::Type(table)) = table else {
            return Err(Error::new_spanned(ty, "a `shared` field is a Shared<'a, T>"));
        };
        self.table = Some((id.clone(), table.clone()));
        self.shared = quote! {
            Some(::luxel_sdk::params::SharedFns {
                offset: ::core::mem::offset_of!(Self, #id),
                build: ::luxel_sdk::abi::build_shared::<Self, #table>,
                build_abi: ::luxel_sdk::abi::build_shared_abi::<Self, #table>,
                free_abi: ::luxel_sdk::abi::free_shared::<#table>,
            })
        };
        Ok(())
    }

    fn finish(self, input: &DeriveInput, doc: &str) -> TokenStream {
        let name = &input.ident;
        let (impl_generics, type_generics, bounds) = input.generics.split_for_impl();
        let (at, still) = match input.generics.lifetimes().next() {
            Some(_) => (quote!(#name<'x>), quote!(#name<'static>)),
            None => (quote!(#name), quote!(#name)),
        };
        let Self { descriptors, asserts, derived, shared, table } = self;
        let table_of_schema = if descriptors.is_empty() {
            quote!(&[])
        } else {
            let n = descriptors.len();
            quote! {
                &::luxel_sdk::abi::param_tables::<#n>(
                    <#still as ::luxel_sdk::params::Params>::SCHEMA
                )
            }
        };
        let has_derived = !derived.is_empty();
        let lends = input.generics.lifetimes().next().is_some();
        let layout = layout(name, &still);
        let table = table.map(|(id, table)| {
            quote! {
                // By its type, not by its name alone.
                fn _table #impl_generics (at: #name #type_generics) #bounds {
                    let _: ::luxel_sdk::params::Shared<'_, #table> = at.#id;
                }
            }
        });
        quote! {
            #layout
            const _: () = {
                const SCHEMA: &[::luxel_sdk::params::Param] =
                    <#still as ::luxel_sdk::params::Params>::SCHEMA;
                const LENDS: bool = #lends;
                #(#asserts)*
                fn _derived #impl_generics () #bounds {
                    fn plain<T: ::luxel_sdk::params::Plain>() {}
                    #(plain::<#derived>();)*
                }
                #table
            };
            #[automatically_derived]
            #[expect(unsafe_code, reason = "the derive states the struct's layout")]
            // SAFETY: offsets and types are taken from the struct itself.
            unsafe impl #impl_generics ::luxel_sdk::params::Params for #name #type_generics #bounds {
                type At<'x> = #at;
                const DOC: &'static str = #doc;
                const SCHEMA: &'static [::luxel_sdk::params::Param] = &[#(#descriptors),*];
                const TABLE: &'static [::luxel_sdk::abi::ParamTable] = #table_of_schema;
                const DERIVED: bool = #has_derived;
                const SHARED: Option<::luxel_sdk::params::SharedFns> = #shared;
            }
        }
    }
}

/// What the host's scratch memory has room for.
fn layout(name: &Ident, still: &TokenStream) -> TokenStream {
    quote_spanned! { name.span() =>
        const _: () = assert!(
            ::core::mem::size_of::<#still>() <= 256,
            "parameters take at most 256 bytes: put large data into a `shared` table"
        );
        const _: () = assert!(
            ::core::mem::align_of::<#still>() <= 16,
            "parameters are aligned to at most 16 bytes"
        );
    }
}

fn last_segment(ty: &Type) -> String {
    match ty {
        Type::Path(path) => path.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    }
    .unwrap_or_default()
}

fn descriptor(id: &Ident, ty: &Type, type_name: &str, doc: &str, a: &Attributes) -> TokenStream {
    let emission = !a.emission.is_empty();
    let name = a.name.clone().unwrap_or_else(|| match type_name {
        "Emission" => "spectrum".to_owned(),
        _ => id.to_string().trim_start_matches("r#").to_owned(),
    });
    let (unit, group, deprecated) = (&a.unit, &a.group, &a.deprecated);
    let role = role(a, emission);
    let (low, high) = match role.to_string().as_str() {
        "Reflectance" => (quote!(0.0), quote!(1.0)),
        "Plain" => (quote!(f64::NEG_INFINITY), quote!(f64::INFINITY)),
        _ => (quote!(0.0), quote!(f64::INFINITY)),
    };
    let min = a.min.as_ref().map_or(low, |e| quote!((#e) as f64));
    let max = a.max.as_ref().map_or(high, |e| quote!((#e) as f64));
    let choices =
        if a.choice { quote!(<#ty as ::luxel_sdk::params::Choice>::WORDS) } else { quote!(&[]) };
    let default = default(ty, type_name, a);
    let (required, textured) = (a.required, a.textured);
    quote! {
        ::luxel_sdk::params::Param {
            name: #name, doc: #doc, ty: <#ty as ::luxel_sdk::params::Field>::TYPE, unit: #unit,
            role: ::luxel_sdk::params::Role::#role, default: #default, min: #min, max: #max,
            choices: #choices, group: #group, required: #required, textured: #textured,
            deprecated: #deprecated, offset: ::core::mem::offset_of!(Self, #id),
        }
    }
}

fn role(a: &Attributes, emission: bool) -> Ident {
    let word = match &a.role {
        Some(word) => word.to_string(),
        None if emission => "illuminant".to_owned(),
        None => "plain".to_owned(),
    };
    let mut camel = String::new();
    for part in word.split('_') {
        let mut letters = part.chars();
        camel.extend(letters.next().map(|c| c.to_ascii_uppercase()));
        camel.extend(letters);
    }
    format_ident!("{camel}")
}

fn default(ty: &Type, type_name: &str, a: &Attributes) -> TokenStream {
    let numbers = |list: TokenStream| quote!(::luxel_sdk::params::Preset::Numbers(#list));
    match (&a.default, type_name) {
        (None, _) => quote!(::luxel_sdk::params::Preset::Absent),
        (Some(e), _) if a.choice => {
            quote!(::luxel_sdk::params::Preset::Index({ let choice: #ty = #e; choice as u32 }))
        }
        (Some(e), "Text") => quote!(::luxel_sdk::params::Preset::Text(#e)),
        (Some(e), "Vec2") => numbers(quote!({ let a: [f64; 2] = #e; [a[0], a[1], 0.0, 0.0] })),
        (Some(e), "Vec3" | "DVec3") => {
            numbers(quote!({ let a: [f64; 3] = #e; [a[0], a[1], a[2], 0.0] }))
        }
        (Some(e), "bool") => numbers(quote!([(#e) as u8 as f64, 0.0, 0.0, 0.0])),
        (Some(e), _) => numbers(quote!([(#e) as f64; 4])),
    }
}

/// The parameter `k` beside a metal's `eta`.
fn extinction(id: &Ident, a: &Attributes) -> TokenStream {
    let textured = a.textured;
    quote! {
        ::luxel_sdk::params::Param {
            name: "k", doc: "Extinction coefficient; not needed where `eta` names a measured metal.",
            ty: ::luxel_sdk::params::Type::Spectrum, unit: "",
            role: ::luxel_sdk::params::Role::ComplexIor,
            default: ::luxel_sdk::params::Preset::Absent, min: 0.0, max: f64::INFINITY,
            choices: &[], group: "", required: false, textured: #textured, deprecated: "",
            offset: ::core::mem::offset_of!(Self, #id)
                + ::core::mem::offset_of!(::luxel_sdk::params::ComplexIor, k),
        }
    }
}

/// One of the amounts that go with an emission's spectrum.
fn amount_descriptor(id: &Ident, amount: &Ident) -> Result<TokenStream> {
    let (unit, doc) = match amount.to_string().as_str() {
        "scale" => ("", "Factor on the spectrum taken as it is: a white of 1 gives pixels of 1."),
        "power" => ("W|lm", "Power in all directions together, radiometric or photometric."),
        "radiance" => ("W/m^2/sr|nit", "Radiance, radiometric or photometric."),
        "intensity" => ("W/sr|cd", "Intensity, radiometric or photometric."),
        "illuminance" => {
            ("W/m^2|lx", "Irradiance or illuminance on a surface that faces the light.")
        }
        _ => {
            let message = format!(
                "unknown amount `{amount}`; \
                 the amounts are scale, power, radiance, intensity, illuminance"
            );
            return Err(Error::new_spanned(amount, message));
        }
    };
    let name = amount.to_string();
    Ok(quote! {
        ::luxel_sdk::params::Param {
            name: #name, doc: #doc, ty: ::luxel_sdk::params::Type::Emission, unit: #unit,
            role: ::luxel_sdk::params::Role::Illuminant,
            default: ::luxel_sdk::params::Preset::Absent, min: 0.0, max: f64::INFINITY,
            choices: &[], group: "amount", required: false, textured: false, deprecated: "",
            offset: ::core::mem::offset_of!(Self, #id),
        }
    })
}
