//! Documents are written anew as a whole, or stay.

use crate::document::write;

const TEXT: &str = "# A\n\n<!-- begin: a -->\n\nold\n\n<!-- end: a -->\n\nrest\n";

#[test]
fn a_file_without_the_comments_stays_as_it_is() {
    let path = std::env::temp_dir().join(format!("luxel-generated-{}.md", std::process::id()));
    #[expect(clippy::disallowed_methods, reason = "the test makes the file that it writes anew")]
    std::fs::write(&path, TEXT).unwrap();
    let told = write(&path, "b", "new").unwrap_err();
    assert!(told.ends_with("no line `<!-- begin: b -->`"), "{told}");
    assert_eq!(crate::disk::text(&path), TEXT);
    write(&path, "a", "new").unwrap();
    assert_eq!(crate::disk::text(&path), TEXT.replace("old", "new"));
    assert!(!path.with_extension("part").exists());
    std::fs::remove_file(&path).unwrap();
}
