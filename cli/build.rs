//! A name of this build: a hash of all that its code comes from.
//!
//! The version alone does not tell two builds apart whose pictures differ. Equal sources, options and
//! compilers give equal names, wherever and however often they are built; nothing is asked of version
//! control, and nothing is read when the program runs. Features of `luxel-core` are not in it: they change
//! no bit.

use std::hash::{DefaultHasher, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of, below the workspace.
const PARTS: [&str; 14] = [
    "Cargo.lock",
    "Cargo.toml",
    "cli/Cargo.toml",
    "cli/build.rs",
    "cli/src",
    "core/Cargo.toml",
    "core/src",
    "lang/Cargo.toml",
    "lang/src",
    "plugins/builtin/Cargo.toml",
    "plugins/builtin/src",
    "plugins/conformance/src",
    "plugins/sdk/src",
    "plugins/sdk-derive/src",
];

/// What else decides which code comes of it.
const OPTIONS: [&str; 5] = [
    "TARGET",
    "OPT_LEVEL",
    "CARGO_CFG_DEBUG_ASSERTIONS",
    "CARGO_CFG_TARGET_FEATURE",
    "CARGO_ENCODED_RUSTFLAGS",
];

fn main() -> io::Result<()> {
    let workspace = PathBuf::from(asked("CARGO_MANIFEST_DIR")).join("..");
    let mut hash = DefaultHasher::new();
    for part in PARTS {
        told(&format!("rerun-if-changed={}", workspace.join(part).display()));
        add(&workspace, Path::new(part), &mut hash)?;
    }
    for name in OPTIONS {
        said(name, asked(name).as_bytes(), &mut hash);
    }
    let compiler = Command::new(asked("RUSTC")).arg("-vV").output()?;
    said("rustc", &compiler.stdout, &mut hash);
    told(&format!("rustc-env=LUXEL_BUILD={:016x}", hash.finish()));
    Ok(())
}

/// Adds a file, or all files of a folder in the order of their names.
fn add(workspace: &Path, part: &Path, hash: &mut DefaultHasher) -> io::Result<()> {
    let place = workspace.join(part);
    if !place.is_dir() {
        #[expect(clippy::disallowed_methods, reason = "sources, read when they are compiled")]
        let bytes = std::fs::read(place)?;
        // With the same separators everywhere.
        let names: Vec<_> = part.iter().map(|name| name.to_string_lossy()).collect();
        said(&names.join("/"), &bytes, hash);
        return Ok(());
    }
    let entries = std::fs::read_dir(place)?.collect::<io::Result<Vec<_>>>()?;
    let mut names: Vec<_> = entries.iter().map(std::fs::DirEntry::file_name).collect();
    names.sort();
    names.iter().try_for_each(|name| add(workspace, &part.join(name), hash))
}

/// A name with what it stands for; lengths keep neighbours apart.
fn said(name: &str, bytes: &[u8], hash: &mut DefaultHasher) {
    for bytes in [name.as_bytes(), bytes] {
        hash.write_usize(bytes.len());
        hash.write(bytes);
    }
}

fn asked(name: &str) -> String {
    #[expect(clippy::disallowed_methods, reason = "how cargo talks to what it runs")]
    std::env::var(name).unwrap_or_default()
}

fn told(words: &str) {
    println!("cargo::{words}");
}
