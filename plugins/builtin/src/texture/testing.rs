//! Files of pictures for tests.

use std::io::Cursor;

use ::image::{DynamicImage, ImageFormat};

/// A picture as a file of that format would hold it.
pub(crate) fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(vec![]);
    picture.into().write_to(&mut out, format).unwrap();
    out.into_inner()
}
