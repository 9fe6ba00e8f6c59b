//! What tests find and documents show.
//!
//! Shared with the tests of the program, as a file that they take in.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::generated::{part, replaced};

const DOCUMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs");

/// Holds a document's part of that name to what was found; puts it there first if `LUXEL_WRITE_DOCS` is 1.
#[expect(clippy::disallowed_methods, reason = "whoever runs the test asks for it")]
pub(crate) fn hold(document: &str, name: &str, found: &str) {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let place = Path::new(DOCUMENTS).join(document);
    let text = || std::fs::read_to_string(&place).unwrap();
    if std::env::var("LUXEL_WRITE_DOCS").is_ok_and(|value| value == "1") {
        std::fs::write(&place, replaced(&text(), name, found).unwrap()).unwrap();
    }
    let again = format!("`{name}` is written by this test with LUXEL_WRITE_DOCS=1");
    assert_eq!(part(&text(), name).unwrap().trim(), found.trim(), "{again}");
}
