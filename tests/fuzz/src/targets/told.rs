//! What is told of a load.

use luxel_core::diag::Diagnostic;
use luxel_lang::Loaded;

/// Holds a load against what every one promises: there is a scene if and only if there is no error,
/// and whatever is told points into its text.
///
/// # Panics
/// If it does not.
pub(crate) fn holds(loaded: &Loaded) {
    let faulty = loaded.diagnostics.iter().any(Diagnostic::is_error);
    assert_eq!(loaded.scene.is_none(), faulty, "{:?}", loaded.diagnostics);
    for told in &loaded.diagnostics {
        let labels = told.labels.iter().map(|label| label.span);
        for span in labels.chain(told.fixes.iter().map(|fix| fix.span)) {
            let text = loaded.sources.text(span.source);
            assert!(text.get(span.range()).is_some(), "{told:?} in {} bytes", text.len());
        }
    }
}
