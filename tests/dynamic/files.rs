//! Files that are no libraries, or not the ones they are called after: told before anything runs.

use std::sync::{Arc, OnceLock};

use luxel_core::files::Files;
use luxel_core::registry::dynamic::{Library, SYMBOL, inspect};

use super::compiler::{Folder, library, opened};
use crate::disk::{OnDisk, root};

/// The bytes of a small library of the stem `tiny`.
fn tiny() -> &'static (Folder, Arc<[u8]>) {
    static TINY: OnceLock<(Folder, Arc<[u8]>)> = OnceLock::new();
    TINY.get_or_init(|| {
        let folder = Folder::new();
        let source = folder.write("tiny.c", TABLE.as_bytes());
        let out = folder.library("tiny");
        library(&source, &["-DSYMBOL=luxel_plugin_v1_tiny"], &out);
        let bytes = OnDisk.read(&out).unwrap();
        (folder, bytes)
    })
}

const TABLE: &str = "#include \"luxel.h\"
LUXEL_EXPORT const luxel_library SYMBOL = {
    .magic = LUXEL_MAGIC, .abi_major = LUXEL_ABI_MAJOR, .layout_hash = LUXEL_LAYOUT_HASH,
    .size = sizeof(luxel_library), .name = LUXEL_TEXT(\"tiny\"), .panic = 1,
};
";

/// What is said of these bytes before they are opened.
fn said(bytes: &[u8]) -> String {
    inspect(bytes, "tiny").map_or_else(|error| error.message, |()| String::new())
}

#[test]
fn a_whole_library_is_let_through_and_opens() {
    let (folder, bytes) = tiny();
    assert_eq!(said(bytes), "");
    let library = Library::open(&folder.library("tiny"), "tiny", 3).unwrap();
    assert_eq!((&*library.name, library.generation, library.classes.len()), ("tiny", 3, 0));
}

#[test]
fn what_is_no_library_is_told_so() {
    let png = OnDisk.read(&root().join("scenes/assets/spot/spot_texture.png")).unwrap();
    let zeros = [0; 4096];
    let mut magic = zeros;
    magic[..4].copy_from_slice(b"\x7fELF");
    for bytes in [&b""[..], b"x", b"no library, but a text\n", &png, &zeros, &magic, &[0xff; 999]] {
        let said = said(bytes);
        assert!(said.starts_with("not a dynamic library, or cut off: "), "{said}");
    }
}

#[test]
fn a_library_that_is_cut_off_is_told_so_wherever_it_ends() {
    let (_, bytes) = tiny();
    // Every length near the start, where the headers are, and then in steps.
    let lengths = (0..1024).chain((1024..bytes.len()).step_by(61));
    for n in lengths {
        let said = said(&bytes[..n]);
        // A library whose tables of sections alone are missing can still be opened.
        assert!(!said.is_empty() || n > bytes.len() / 2, "{n} of {} bytes", bytes.len());
    }
}

#[test]
fn a_library_with_one_wrong_byte_never_ends_the_program() {
    let (_, bytes) = tiny();
    let mut broken = bytes.to_vec();
    for i in 0..bytes.len().min(4096) {
        for wrong in [0, 0xff, bytes[i] ^ 0x80] {
            broken[i] = wrong;
            said(&broken);
        }
        broken[i] = bytes[i];
    }
}

#[test]
fn a_library_that_was_renamed_is_told_its_name() {
    let (folder, bytes) = tiny();
    let renamed = inspect(bytes, "small").unwrap_err().message;
    assert_eq!(
        renamed,
        format!(
            "its table is `{SYMBOL}tiny`, and `{SYMBOL}small` is wanted: a library is called as it \
             was when it was built, `tiny`"
        )
    );
    let none = format!("no Luxel plugin: it has no symbol `{SYMBOL}small`");
    let found = Library::open(&folder.library("tiny"), "small", 0).unwrap_err();
    assert_eq!(found.message, none);
}

#[test]
fn a_library_without_a_table_is_told_so() {
    let folder = Folder::new();
    let source = folder.write("none.c", b"extern int nothing; int nothing = 1;\n");
    let found = opened(&folder, &source, "none", &[]).unwrap_err();
    let none = format!("no Luxel plugin: it has no symbol `{SYMBOL}none`");
    assert_eq!(found.message, none);
    let bytes = OnDisk.read(&folder.library("none")).unwrap();
    assert_eq!(inspect(&bytes, "none").unwrap_err().message, none);
}

#[test]
fn a_table_of_zeros_is_no_table() {
    let folder = Folder::new();
    let text =
        "#include \"luxel.h\"\nLUXEL_EXPORT const luxel_library luxel_plugin_v1_zero = {0};\n";
    let source = folder.write("zero.c", text.as_bytes());
    let found = opened(&folder, &source, "zero", &[]).unwrap_err();
    assert!(found.message.starts_with("no Luxel plugin: its table begins with 0x0"), "{found}");
}

#[test]
fn a_library_that_needs_what_is_not_there_is_not_loaded() {
    let folder = Folder::new();
    let text = "extern void missing_from_everywhere(void); void call(void);\n\
        void call(void) { missing_from_everywhere(); }\n";
    let source = folder.write("lost.c", text.as_bytes());
    let found = opened(&folder, &source, "lost", &[]).unwrap_err();
    assert!(found.message.starts_with("not loaded: "), "{found}");
    assert!(found.message.contains("missing_from_everywhere"), "{found}");
}
