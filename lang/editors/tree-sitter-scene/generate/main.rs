//! Makes the parser of `grammar.js` (which node reads) in the folder that is given, as `tree-sitter
//! generate` would.

use std::path::Path;

/// The layout of parsers that tree-sitter 0.25 makes by itself.
const ABI: usize = 15;

fn main() {
    let folder = std::env::args().nth(1).expect("a folder for the parser");
    let grammar = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    tree_sitter_generate::generate_parser_in_directory(
        &grammar,
        Some(&folder),
        None,
        ABI,
        None,
        None,
    )
    .unwrap_or_else(|error| panic!("{error}"));
}
