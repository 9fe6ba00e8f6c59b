//! Plugins of every kind that are wrong where a scene tells them to be.

pub(super) mod always;
mod importer;
mod medium;
mod path;
mod settings;
mod shape;
mod surface;

use std::sync::{Once, OnceLock};

use luxel_core::registry::dynamic::Library;
use luxel_sdk::Choice;
use luxel_sdk::abi::{Class, LibraryTable};

/// What a plugin of this library does wrong.
#[derive(Clone, Copy, Choice, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Wrong {
    /// Nothing.
    Nothing,
    /// Panics in `check`.
    Check,
    /// Panics in `prepare`.
    Prepare,
    /// Panics in what the host asks most.
    Eval,
    /// Gives no number there.
    Nan,
    /// Gives less than nothing there.
    Negative,
    /// Gives more than anything there.
    Infinite,
    /// Panics where it samples.
    Sample,
    /// Samples what is no number.
    SampleNan,
    /// Samples without density.
    SampleZero,
    /// Samples what is not of unit length.
    SampleLong,
    /// Panics in a lesser question.
    Other,
    /// Answers a lesser question with no number.
    OtherNan,
    /// Panics in a second lesser question.
    Second,
    /// Answers that with no number.
    SecondNan,
    /// Ends at its origin.
    Zero,
    /// Goes beyond the limit.
    Beyond,
    /// Asks for too much.
    Greedy,
    /// Refers to what is not there.
    Dangling,
    /// Makes what it must not.
    Foreign,
    /// Panics with what panics when it is dropped.
    Bomb,
}

impl Wrong {
    /// Panics if this is the fault.
    pub(super) fn at(self, fault: Self) {
        if self == Self::Bomb && fault == Self::Eval {
            std::panic::panic_any(Bomb);
        }
        assert!(self != fault, "fell over on purpose");
    }

    /// A number that is wrong in the first three ways, or the right one.
    pub(super) fn number(self, right: f32) -> f32 {
        match self {
            Self::Nan => f32::NAN,
            Self::Negative => -1.0,
            Self::Infinite => f32::INFINITY,
            _ => right,
        }
    }
}

/// Panics when it is dropped: as a panic's payload, and as a table.
pub(super) struct Bomb;

impl Drop for Bomb {
    fn drop(&mut self) {
        assert!(std::thread::panicking(), "fell over on purpose");
    }
}

const CLASSES: &[Class] = &[
    Class::material::<surface::Paint>("bad"),
    Class::texture::<surface::Pattern<'_>>("bad"),
    Class::light::<surface::Lamp>("bad"),
    Class::shape::<shape::Square>("bad"),
    Class::medium::<medium::Fog<'_>>("bad"),
    Class::phase::<medium::Haze>("bad"),
    Class::camera::<settings::Lens>("bad"),
    Class::sampler::<settings::Dice>("bad"),
    Class::filter::<settings::Pixel>("bad"),
    Class::integrator::<path::Walk>("bad"),
    Class::importer::<importer::Pour>("bad"),
];

/// The library, through the boundary.
pub(super) fn library() -> &'static Library {
    static TABLE: LibraryTable = LibraryTable {
        // The hook of a library's panics would be that of these tests.
        begin: None,
        ..luxel_sdk::library_table!(&[CLASSES])
    };
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    quiet();
    LIBRARY.get_or_init(|| Library::linked(&TABLE).unwrap())
}

/// What the host takes where a scene says nothing, through the boundary: it always falls over.
pub(super) fn preset() -> Library {
    const CLASSES: &[Class] = &[Class::filter::<settings::Fallen>("blackman_harris")];
    static TABLE: LibraryTable =
        LibraryTable { begin: None, ..luxel_sdk::library_table!(&[CLASSES]) };
    quiet();
    Library::linked(&TABLE).unwrap()
}

/// Panics on purpose are not printed.
pub(super) fn quiet() {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let said = info.payload().downcast_ref::<&str>();
            let on_purpose = said.is_some_and(|said| said.contains("on purpose"));
            if !on_purpose && !info.payload().is::<Bomb>() {
                usual(info);
            }
        }));
    });
}
