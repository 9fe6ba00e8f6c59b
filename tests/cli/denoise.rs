//! A picture smoothed, as a person does it.

use super::program::{Folder, SCENE};

#[test]
fn a_denoised_picture_stands_beside_the_measured_one_and_gets_no_verdict() {
    let folder = Folder::new("denoise").with("a.scene", SCENE);
    assert_eq!(folder.luxel(&["render", "a.scene", "-q"]).code, 0);
    let measured = folder.read("a.exr");
    let done = folder.luxel(&["denoise", "a.exr"]);
    assert!(done.code == 0 && done.out.contains("wrote a-denoised.exr"), "{done:?}");
    assert!(done.out.contains("those of the measured picture"), "{done:?}");
    assert_eq!(folder.read("a.exr"), measured);
    assert!(folder.read("a-denoised.png").starts_with(b"\x89PNG"));
    let compared = folder.luxel(&["compare", "a-denoised.exr", "a.exr"]);
    assert!(compared.code == 3 && compared.out.contains("A is denoised"), "{compared:?}");
    let again = folder.luxel(&["denoise", "a-denoised.exr"]);
    assert!(again.code == 1 && again.err.contains("denoised already"), "{again:?}");
    let over = folder.luxel(&["denoise", "a.exr", "-o", "a"]);
    assert!(over.code == 2 && over.err.contains("would take the place"), "{over:?}");
    assert_eq!(folder.read("a.exr"), measured);
}

#[test]
fn a_picture_that_says_nothing_of_its_error_is_not_denoised() {
    let folder = Folder::new("denoise-foreign").with("a.scene", SCENE);
    assert_eq!(folder.luxel(&["render", "a.scene", "-q"]).code, 0);
    assert_eq!(folder.luxel(&["denoise", "a.exr"]).code, 0);
    // A difference from a denoised picture has no standard errors.
    let compared = ["compare", "a-denoised.exr", "a.exr", "--picture", "plain"];
    assert_eq!(folder.luxel(&compared).code, 3);
    let before = folder.names();
    let done = folder.luxel(&["denoise", "plain.exr"]);
    assert!(done.code == 1 && done.err.contains("does not say how wrong it is"), "{done:?}");
    assert_eq!(folder.names(), before);
}
