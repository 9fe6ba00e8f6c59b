//! Tables that tests find and docs/accuracy.md shows.

use std::sync::{Mutex, PoisonError};

use crate::disk::{root, text};
use crate::generated::{part, replaced};

const PUBLISHED: &str = "docs/accuracy.md";

/// Holds the document's part of that name to what was found; puts it there first if `LUXEL_WRITE_DOCS` is 1.
pub(crate) fn hold(name: &str, table: &str) {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let place = root().join(PUBLISHED);
    #[expect(clippy::disallowed_methods, reason = "whoever runs the test says so")]
    let is_asked_to_write = std::env::var("LUXEL_WRITE_DOCS").is_ok_and(|value| value == "1");
    if is_asked_to_write {
        let document = replaced(&text(&place), name, table).unwrap();
        #[expect(clippy::disallowed_methods, reason = "whoever runs the test asks for it")]
        std::fs::write(&place, document).unwrap();
    }
    let document = text(&place);
    let again = "LUXEL_WRITE_DOCS=1 cargo test -p luxel-tests intervals_hold_the_truth";
    assert_eq!(part(&document, name).unwrap().trim(), table.trim(), "{again}");
}
