//! What the frozen types look like: for the layout hash, and for the C header.

use std::fmt::Write;
use std::mem::MaybeUninit;

/// A type that C can name.
pub(crate) trait CType {
    /// Declares something of this type: `float x`, `const luxel_ray *ray`.
    fn declare(name: &str) -> String;
}

/// A type that the header defines.
pub(crate) trait Described {
    /// Its definition in C.
    fn describe(out: &mut String);
}

/// A field of a frozen struct: its name and where it stands.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The name.
    pub(crate) name: &'static str,
    /// Bytes from the start of the struct.
    pub(crate) offset: usize,
}

/// A frozen struct.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    /// The name in C.
    pub(crate) name: &'static str,
    /// Bytes.
    pub(crate) size: usize,
    /// Bytes.
    pub(crate) align: usize,
    /// The fields, in order.
    pub(crate) fields: &'static [Place],
}

/// An argument of a function: as declared, or an array's address.
pub(crate) fn argument<T: CType>(name: &str) -> String {
    T::declare(name)
}

/// A comment in the header, from doc lines.
pub(crate) fn comment(out: &mut String, indent: &str, lines: &[&str]) {
    let text: Vec<_> = lines.iter().map(|line| line.trim()).collect();
    let text = text.join(&format!("\n{indent}   "));
    let _ = writeln!(out, "{indent}/* {text} */");
}

/// Types by their names in C.
macro_rules! c_types {
    ($($ty:ty => $c:literal),* $(,)?) => { $(
        impl $crate::wire::layout::CType for $ty {
            fn declare(name: &str) -> String {
                format!(concat!($c, " {}"), name)
            }
        }
    )* };
}
pub(crate) use c_types;
c_types! {
    f32 => "float", f64 => "double", u8 => "uint8_t", u32 => "uint32_t", u64 => "uint64_t",
    usize => "size_t", bool => "bool", i8 => "int8_t",
    glam::Vec2 => "luxel_vec2", glam::Vec3 => "luxel_vec3", glam::DVec2 => "luxel_dvec2",
    glam::DVec3 => "luxel_dvec3", glam::UVec2 => "luxel_uvec2",
    crate::color::Spectrum => "luxel_spectrum", super::Status => "luxel_status",
    super::Slice<u8> => "luxel_bytes", super::Slice<u32> => "luxel_u32s",
    super::Slice<f64> => "luxel_doubles", super::Slice<glam::Vec2> => "luxel_vec2s",
    super::Slice<glam::Vec3> => "luxel_vec3s", super::Slice<[u32; 3]> => "luxel_triangles_of",
}

impl<T: CType, const N: usize> CType for [T; N] {
    fn declare(name: &str) -> String {
        // An array of pointers needs brackets; there is none.
        let name = if name.starts_with('*') { format!("({name})") } else { name.to_owned() };
        T::declare(&format!("{name}[{N}]"))
    }
}
impl<T: CType> CType for &T {
    fn declare(name: &str) -> String {
        format!("const {}", T::declare(&format!("*{name}")))
    }
}
impl<T: CType> CType for Option<&T> {
    fn declare(name: &str) -> String {
        <&T>::declare(name)
    }
}
impl<T: CType> CType for &mut T {
    fn declare(name: &str) -> String {
        T::declare(&format!("*{name}"))
    }
}
impl<T: CType> CType for &mut MaybeUninit<T> {
    fn declare(name: &str) -> String {
        T::declare(&format!("*{name}"))
    }
}
impl CType for *mut bool {
    fn declare(name: &str) -> String {
        bool::declare(&format!("*{name}"))
    }
}
impl CType for Option<super::TellPanic> {
    fn declare(name: &str) -> String {
        format!("void (*{name})(luxel_byte_sink *sink)")
    }
}
impl CType for *const u8 {
    fn declare(name: &str) -> String {
        format!("const void *{name}")
    }
}
impl CType for *mut u8 {
    fn declare(name: &str) -> String {
        format!("void *{name}")
    }
}

macro_rules! functions {
    ($(($($arg:ident),*)),* $(,)?) => { $(
        impl<R: CType, $($arg: CType),*> CType for unsafe extern "C" fn($($arg),*) -> R {
            fn declare(name: &str) -> String {
                let arguments: Vec<String> = vec![$($arg::declare("").trim_end().to_owned()),*];
                R::declare(&format!("(*{name})({})", arguments.join(", ")))
            }
        }
    )* };
}
functions!((A), (A, B), (A, B, C), (A, B, C, D), (A, B, C, D, E));

impl CType for () {
    fn declare(name: &str) -> String {
        format!("void {name}")
    }
}

/// Lists frozen structs: their names in C and their layout.
macro_rules! layouts {
    ($list:ident { $($ty:ty => $c_name:literal { $($field:ident),* $(,)? })* }) => {
        const $list: &[$crate::wire::layout::Layout] = &[$(
            $crate::wire::layout::Layout {
                name: $c_name,
                size: size_of::<$ty>(),
                align: align_of::<$ty>(),
                fields: &[$($crate::wire::layout::Place {
                    name: stringify!($field),
                    offset: std::mem::offset_of!($ty, $field),
                }),*],
            }
        ),*];
    };
}
pub(crate) use layouts;

/// Describes frozen structs, whose fields say all that C needs: a list of layouts, and one of C.
macro_rules! describe {
    ($list:ident, $c_list:ident {
        $($(#[doc = $doc:literal])* $ty:ty => $c_name:literal { $($field:ident),* $(,)? })*
    }) => {
        $(
            impl $crate::wire::layout::CType for $ty {
                fn declare(name: &str) -> String {
                    format!(concat!($c_name, " {}"), name)
                }
            }
            impl $crate::wire::layout::Described for $ty {
                fn describe(out: &mut String) {
                    $crate::wire::layout::comment(out, "", &[$($doc),*]);
                    out.push_str("typedef struct {\n");
                    $(out.push_str(&format!(
                        "    {};\n",
                        $crate::wire::layout::field(|s: &$ty| &s.$field, stringify!($field))
                    ));)*
                    out.push_str(concat!("} ", $c_name, ";\n\n"));
                }
            }
        )*
        $crate::wire::layout::layouts! { $list { $($ty => $c_name { $($field),* })* } }
        const $c_list: &[fn(&mut String)] =
            &[$(<$ty as $crate::wire::layout::Described>::describe),*];
    };
}
pub(crate) use describe;

/// Declares a field by the type that a way to it has.
pub(crate) fn field<S, F: CType>(_: fn(&S) -> &F, name: &str) -> String {
    F::declare(name)
}

/// FNV-1a over names, sizes, alignments and offsets: two sides that differ in any do not talk.
pub(crate) const fn hash(lists: &[&[Layout]]) -> u64 {
    let mut h = 0xcbf2_9ce4_8422_2325;
    let mut i = 0;
    while i < lists.len() {
        h = hash_list(h, lists[i]);
        i += 1;
    }
    h
}

const fn hash_list(mut h: u64, layouts: &[Layout]) -> u64 {
    let mut i = 0;
    while i < layouts.len() {
        let layout = &layouts[i];
        h = number(text(h, layout.name), layout.size);
        h = number(h, layout.align);
        let mut j = 0;
        while j < layout.fields.len() {
            h = number(text(h, layout.fields[j].name), layout.fields[j].offset);
            j += 1;
        }
        i += 1;
    }
    h
}

const fn text(mut h: u64, text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut i = 0;
    while i < bytes.len() {
        h = byte(h, bytes[i]);
        i += 1;
    }
    byte(h, 0)
}

const fn number(mut h: u64, n: usize) -> u64 {
    let bytes = (n as u64).to_le_bytes();
    let mut i = 0;
    while i < bytes.len() {
        h = byte(h, bytes[i]);
        i += 1;
    }
    h
}

const fn byte(h: u64, b: u8) -> u64 {
    (h ^ b as u64).wrapping_mul(0x0000_0100_0000_01b3)
}
