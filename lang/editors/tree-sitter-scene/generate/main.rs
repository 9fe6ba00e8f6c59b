//! Makes the parser of `grammar.js` (which node reads) in `build/made`, as `tree-sitter generate` would.

use std::path::Path;

/// The layout of parsers that tree-sitter 0.25 makes by itself.
const ABI: usize = 15;

fn main() {
    let grammar = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let made = grammar.join("build/made");
    let made = made.to_str().expect("a folder whose path is text");
    tree_sitter_generate::generate_parser_in_directory(&grammar, Some(made), None, ABI, None, None)
        .unwrap_or_else(|error| panic!("{error}"));
}
