//! Results whose bytes are no values: a library in C may leave a `bool` as it finds it.
#![expect(unsafe_code, reason = "results are written as C would write them")]

use std::mem::{MaybeUninit, offset_of};

use luxel_core::registry::dynamic::Library;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_sdk::Params;
use luxel_sdk::abi::{
    Class, ClassTable, LibraryTable, LightTable, MediumTable, PhaseRef, SamplesRef, Slice, Status,
};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Light, LightForm, LightQuery, LightSample, Medium, Samples};
use luxel_sdk::num::Ray;

use super::misbehave::{CAMERA, FILM, FLOOR};
use super::{registered, stage};

/// Its functions are replaced.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Odd<'a> {
    /// How it scatters.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

impl Light for Odd<'_> {
    fn form(&self) -> LightForm {
        LightForm::Point
    }
    fn power(&self, _: f64, _: f64) -> f32 {
        1.0
    }
}

impl Medium for Odd<'_> {
    fn sample(&self, _: &Ray, _: &mut Samples<'_>) -> FreeFlight {
        FreeFlight { t: luxel_sdk::params::Maybe::default(), weight: Spectrum::ONE }
    }
    fn transmittance(&self, _: &Ray, _: &mut Samples<'_>) -> Spectrum {
        Spectrum::ONE
    }
    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

/// The render with this class in it fails and says so at the object.
fn check(class: ClassTable, body: &str) {
    let library = luxel_sdk::library_table!(&[&[Class::light::<Odd<'_>>("unused")]]);
    let classes = Slice::new(vec![class].leak());
    let table = LibraryTable { begin: None, last_panic: None, classes, ..library };
    let library = Library::linked(Box::leak(Box::new(table))).unwrap();
    let text = format!("scene 1\n{CAMERA}{FILM}{FLOOR}{body}");
    let stage = stage(&registered(&[&library]), &text).unwrap();
    let (_, outcome) = render(&stage, &Options::default(), &Control::default());
    let found = stage.failures();
    assert_eq!((outcome, found.len()), (Outcome::Failed, 1), "{found:?}");
    assert!(found[0].message.contains("gave neither yes nor no"), "{found:?}");
    assert!(found[0].span().is_some());
}

/// Every byte of a result.
fn fill<T>(out: &mut MaybeUninit<T>, byte: u8) {
    // SAFETY: the result's own bytes.
    unsafe { out.as_mut_ptr().cast::<u8>().write_bytes(byte, size_of::<T>()) };
}

#[test]
fn a_light_sample_that_is_neither_delta_nor_not_ends_the_render() {
    unsafe extern "C" fn sample(
        _: *const u8,
        _: &LightQuery,
        out: &mut MaybeUninit<LightSample>,
    ) -> Status {
        fill(out, 0);
        // SAFETY: the result's own bytes, here and below.
        let mut at = |offset| unsafe { out.as_mut_ptr().byte_add(offset) };
        // SAFETY: as above.
        unsafe { at(offset_of!(LightSample, wi.z)).cast::<f64>().write(1.0) };
        // SAFETY: as above.
        unsafe { at(offset_of!(LightSample, distance)).cast::<f64>().write(1.0) };
        // SAFETY: as above.
        unsafe { at(offset_of!(LightSample, pdf)).cast::<f32>().write(1.0) };
        // SAFETY: as above.
        unsafe { at(offset_of!(LightSample, delta)).cast::<u8>().write(2) };
        Status::OK
    }
    let table: &'static _ =
        Box::leak(Box::new(LightTable { sample, ..*LightTable::of::<Odd<'_>>() }));
    let behaviour = std::ptr::from_ref(table).cast();
    check(ClassTable { behaviour, ..Class::light::<Odd<'_>>("odd").table }, "light odd {}");
}

#[test]
fn a_flight_that_neither_ends_nor_not_ends_the_render() {
    unsafe extern "C" fn sample(
        _: *const u8,
        _: &Ray,
        _: &mut SamplesRef<'_>,
        out: &mut MaybeUninit<FreeFlight>,
    ) -> Status {
        fill(out, 0xcd);
        Status::OK
    }
    let table: &'static _ =
        Box::leak(Box::new(MediumTable { sample, ..*MediumTable::of::<Odd<'_>>() }));
    let behaviour = std::ptr::from_ref(table).cast();
    check(ClassTable { behaviour, ..Class::medium::<Odd<'_>>("odd").table }, "medium odd {}");
}
