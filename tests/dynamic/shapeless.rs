//! Lights that shine from a shape's surface, without a shape: they are told, not left out.

use glam::Vec2;
use luxel_core::diag::Diagnostic;
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_sdk::Params;
use luxel_sdk::abi::{Class, LibraryTable};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm};
use luxel_sdk::params::ShapeSlot;

use super::misbehave::{CAMERA, FILM, FLOOR};
use super::{registered, stage};

/// A lamp that forgot what shines.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Bare {
    /// How bright it is.
    #[param(default = 1.0, min = 0)]
    radiance: f32,
}

/// A lamp that may be told what shines.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Clad {
    /// What shines.
    #[param(optional)]
    shape: ShapeSlot,
    /// How bright it is.
    #[param(default = 1.0, min = 0)]
    radiance: f32,
}

macro_rules! shines {
    ($name:ident) => {
        impl Light for $name {
            fn form(&self) -> LightForm {
                LightForm::Surface
            }
            fn le(&self, _: f32, _: Vec2, _: f64) -> Spectrum {
                Spectrum::splat(self.radiance)
            }
            fn power(&self, _: f64, _: f64) -> f32 {
                self.radiance
            }
        }
    };
}
shines!(Bare);
shines!(Clad);

const CLASSES: &[Class] = &[Class::light::<Bare>("bare"), Class::light::<Clad>("clad")];

/// The built-ins and the lamps, through the boundary.
fn registry() -> Registry {
    static TABLE: LibraryTable = LibraryTable {
        // The hook of a library's panics would be that of these tests.
        begin: None,
        ..luxel_sdk::library_table!(&[CLASSES])
    };
    registered(&[&Library::linked(&TABLE).unwrap()])
}

/// A scene with this lamp is refused: the code, the message, and the words that they stand at.
#[track_caller]
fn check(registry: &Registry, lamp: &str, expected: (&str, &str, &str)) {
    let text = format!("scene 1\n{CAMERA}{FILM}{FLOOR}{lamp}\n");
    let found = stage(registry, &text).expect_err(lamp);
    let place = |found: &Diagnostic| {
        found.span().map_or("", |span| &text[span.start as usize..span.end as usize])
    };
    let found: Vec<_> =
        found.iter().map(|found| (found.code, found.message.as_str(), place(found))).collect();
    assert_eq!(found, [expected]);
}

#[test]
fn a_light_of_a_surface_whose_class_takes_no_shape_is_refused() {
    let told = "light `bare` of tests 0.1.0 shines from a shape's surface, but takes no shape: its \
        class lacks the parameter `shape`";
    let lamp = "light bare { radiance = 2 }";
    check(&registry(), lamp, ("E0421", told, lamp));
    // A class of this process is no better.
    let mut linked = registered(&[]);
    linked.add("tests", &[CLASSES[0]]).unwrap();
    check(&linked, lamp, ("E0421", &told.replace(" of tests 0.1.0", ""), lamp));
}

#[test]
fn a_light_of_a_surface_that_is_not_given_its_shape_is_refused() {
    let lamp = "light clad { radiance = 2 }";
    check(&registry(), lamp, ("E0403", "`clad` wants `shape`", lamp));
}

#[test]
fn a_light_of_a_surface_with_its_shape_shines() {
    let lamp = "light clad { radiance = 2, shape = shape sphere { radius = 1 m } }";
    let stage = stage(&registry(), &format!("scene 1\n{CAMERA}{FILM}{FLOOR}{lamp}\n")).unwrap();
    assert_eq!(stage.lights.sources.len(), 1);
    let (film, outcome) = render(&stage, &Options::default(), &Control::default());
    assert_eq!(outcome, Outcome::Complete);
    // The sphere fills the picture's middle.
    assert!((film.pixel(glam::UVec2::splat(3)).mean.y - 2.0).abs() < 1e-6);
}
