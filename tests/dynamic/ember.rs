//! The library that pages of the catalogue speak of where no built-in class makes their mistake.

use luxel_core::registry::dynamic::Library;
use luxel_sdk::Params;
use luxel_sdk::abi::{Class, LibraryTable};
use luxel_sdk::kind::{Light, LightForm};

/// A light that once had another parameter, and a mistake of its own.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Ember {
    /// How bright it is.
    #[param(default = 1, min = 0)]
    intensity: u32,
    /// The same, as it was called.
    #[param(default = 0, min = 0, deprecated = "intensity")]
    strength: u32,
    /// What shares the light.
    #[param(default = 1, min = 0)]
    cells: u32,
}

impl Light for Ember {
    fn form(&self) -> LightForm {
        LightForm::Point
    }
    fn power(&self, _: f64, _: f64) -> f32 {
        let intensity = if self.strength > 0 { self.strength } else { self.intensity };
        let cells = self.cells;
        assert!(cells > 0, "divided by zero on purpose");
        (intensity / cells) as f32
    }
}

/// The library, through the boundary.
pub(crate) fn library() -> Library {
    const CLASSES: &[Class] = &[Class::light::<Ember>("ember")];
    // The hook of a library's panics would be that of these tests.
    static TABLE: LibraryTable =
        LibraryTable { begin: None, ..luxel_sdk::library_table!(&[CLASSES]) };
    super::bad::quiet();
    Library::linked(&TABLE).unwrap()
}
