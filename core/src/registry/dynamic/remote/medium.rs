use std::mem::{MaybeUninit, offset_of};

use glam::Vec3;
use luxel_sdk::abi::{Answer, MediumTable, PhaseRef, PhaseTable, SamplesRef};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, FreeFlight, Medium, Phase, Sample, SampleAt, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;

use super::material::{is_light, is_sample};
use super::{Head, NO_BOOL, is_bool};

/// A library's medium.
#[repr(transparent)]
pub(super) struct RemoteMedium(Head);

// SAFETY: the SDK demands of media that they are `Send + Sync`.
unsafe impl Send for RemoteMedium {}
// SAFETY: as above.
unsafe impl Sync for RemoteMedium {}

impl RemoteMedium {
    fn table(&self) -> &'static MediumTable {
        // SAFETY: the view was made for media.
        unsafe { self.0.table() }
    }

    /// Lends random numbers to a call. Those of others stay theirs.
    fn lend<T>(
        &self,
        samples: &mut Samples<'_>,
        call: impl FnOnce(&mut SamplesRef<'_>) -> Answer<T>,
    ) -> Option<T> {
        let before = samples.at();
        let found = self.0.found(SamplesRef::lend(samples, call));
        if goes_on(before, samples.at()) {
            return found;
        }
        *samples = Samples::new(samples.source(), before);
        self.0.wrong(NOT_ITS_OWN);
        None
    }

    /// What a question about a ray is answered with; `none`, and the render ends with `wrong`, where that
    /// is no light.
    fn light(
        &self,
        samples: &mut Samples<'_>,
        (none, wrong): (Spectrum, &'static str),
        ask: impl FnOnce(&MediumTable, *const u8, &mut SamplesRef<'_>) -> Answer<Spectrum>,
    ) -> Spectrum {
        if self.0.is_poisoned() {
            return none;
        }
        let table = self.table();
        let found = self.lend(samples, |samples| ask(table, self.0.at(), samples));
        let found = found.unwrap_or(none);
        if is_light(found) {
            return found;
        }
        self.0.wrong(wrong);
        none
    }
}

/// Numbers that one call may take: enough for any walk, too few to run out of dimensions.
const MOST_NUMBERS: u32 = 1 << 16;
pub(super) const NOT_ITS_OWN: &str = "took random numbers that are not its own";

/// Whether a call has left the numbers of a path where they may be after it.
pub(super) fn goes_on(before: SampleAt, now: SampleAt) -> bool {
    (before.stream, before.index) == (now.stream, now.index)
        && now.dimension.checked_sub(before.dimension).is_some_and(|taken| taken <= MOST_NUMBERS)
}

/// What flies on.
pub(in super::super) const THROUGH: FreeFlight =
    FreeFlight { t: Maybe { given: false, value: 0.0 }, weight: Spectrum::ONE };

impl Medium for RemoteMedium {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        if self.0.is_poisoned() {
            return THROUGH;
        }
        let table = self.table();
        let found = self.lend(samples, |samples| {
            let mut out = MaybeUninit::uninit();
            // SAFETY: the struct behind the head is of the class that the table belongs to.
            let status = unsafe { (table.sample)(self.0.at(), ray, samples, &mut out) };
            if !self.0.is_ok(status) {
                return Ok(None);
            }
            // SAFETY: where it says.
            if !unsafe { is_bool(&out, offset_of!(FreeFlight, t.given)) } {
                self.0.wrong(NO_BOOL);
                return Ok(None);
            }
            // SAFETY: the library has written a result.
            Ok(Some(unsafe { out.assume_init() }))
        });
        let flight = found.unwrap_or(THROUGH);
        let inside = flight.t.as_ref().is_none_or(|t| *t >= 0.0 && *t <= ray.t_max);
        if inside && is_light(flight.weight) {
            return flight;
        }
        self.0.wrong("gave a flight that is negative, not finite or too long");
        THROUGH
    }

    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        let wrong = "gave a transmittance that is negative or not finite";
        self.light(samples, (Spectrum::ONE, wrong), |table, at, samples| {
            // SAFETY: the struct behind the head is of the class that the table belongs to.
            unsafe { table.transmittance(at, ray, samples) }
        })
    }

    fn glow(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        let wrong = "gave a glow that is negative or not finite";
        self.light(samples, (Spectrum::ZERO, wrong), |table, at, samples| {
            // SAFETY: as above.
            unsafe { table.glow(at, ray, samples) }
        })
    }

    fn phase(&self) -> PhaseRef<'_> {
        PhaseRef::new(Scattering::of(&self.0))
    }
}

/// How a library's medium scatters. The handle that it gives may name a phase function of its own:
/// what that answers is not taken on trust either.
#[repr(transparent)]
struct Scattering(Head);

// SAFETY: the SDK demands of media that they are `Send + Sync`.
unsafe impl Send for Scattering {}
// SAFETY: as above.
unsafe impl Sync for Scattering {}

impl Scattering {
    fn of(medium: &Head) -> &Self {
        // SAFETY: of the same layout.
        unsafe { &*std::ptr::from_ref(medium).cast() }
    }

    /// The medium's phase function: its table and its struct.
    fn phase(&self) -> Option<(&PhaseTable, *const u8)> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: the head is that of a medium.
        let table = unsafe { self.0.table::<MediumTable>() };
        let mut out = MaybeUninit::<PhaseRef<'static>>::zeroed();
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let status = unsafe { (table.phase)(self.0.at(), &mut out) };
        // SAFETY: a handle is a table's address and a struct's; zero where nothing was written.
        let (table, at) = unsafe { out.as_ptr().cast::<(*const PhaseTable, *const u8)>().read() };
        if self.0.is_ok(status) && !table.is_null() {
            // SAFETY: the library lends the table as long as the medium's parameters.
            return Some((unsafe { &*table }, at));
        }
        if !self.0.is_poisoned() {
            self.0.wrong("gave no phase function");
        }
        None
    }
}

impl Phase for Scattering {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        let Some((table, at)) = self.phase() else { return Eval::ZERO };
        // SAFETY: the medium gave table and struct together.
        let eval = self.0.found(unsafe { table.eval(at, &wo, &wi) }).unwrap_or(Eval::ZERO);
        if is_light(eval.f) && (0.0..f32::INFINITY).contains(&eval.pdf) {
            return eval;
        }
        self.0.wrong("gave an eval that is negative or not finite");
        Eval::ZERO
    }

    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let (table, at) = self.phase()?;
        // SAFETY: as above.
        let sample = self.0.found(unsafe { table.sample(at, &wo, &u) })?;
        if is_sample(&sample) {
            return Some(sample);
        }
        self.0.wrong("gave a sample that is negative, not finite or not of unit length");
        None
    }
}
