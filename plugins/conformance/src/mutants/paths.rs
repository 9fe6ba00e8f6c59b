//! Path tracers with a fault.

use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, ArrivalKind, Ask, Host, Job, PathIntegrator, Samples, Wants, mis};
use luxel_sdk::num::Ray;

use super::Mutant;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Sound,
    EndlessShadows,
    StartsOnSurface,
    ShortPaths,
    NoLampsInFog,
    FogIsDark,
    Fireproof,
}

/// A path on its way.
#[derive(Clone, Copy, Default)]
struct Path {
    beta: Spectrum,
    pdf: f32,
    depth: u32,
}

impl Path {
    fn arrive(&mut self, at: &Arrival, samples: &mut Samples<'_>, ask: &mut Ask<'_>, fault: Fault) {
        let mut le = self.beta * at.le * mis(self.pdf, at.le_pdf);
        if fault == Fault::Fireproof && self.depth > 0 {
            le = le.min(Spectrum::splat(2.0));
        }
        ask.add(le);
        if fault != Fault::FogIsDark {
            ask.add_glow(self.beta, at);
        }
        let in_fog = at.kind == ArrivalKind::Medium && fault == Fault::NoLampsInFog;
        if let Some(direct) = at.direct.as_ref().filter(|_| !in_fog) {
            let mut ray = direct.ray;
            if fault == Fault::EndlessShadows {
                ray.t_max = f64::INFINITY;
            }
            ask.add_if_visible(ray, self.beta * direct.f_le * mis(direct.pdf, direct.f_pdf));
        }
        let Some(scatter) = at.scatter.as_ref() else { return };
        self.beta *= scatter.weight;
        self.pdf = scatter.pdf;
        self.depth += 1;
        let chance = self.beta.max_element().min(0.99);
        let ends = fault == Fault::ShortPaths && self.depth > 4;
        if ends || !(chance > 0.0) || samples.next_1d() >= chance {
            return;
        }
        self.beta *= chance.recip();
        if fault == Fault::StartsOnSurface {
            ask.trace(Ray::new(at.p, scatter.wi));
        } else {
            ask.trace(at.ray(scatter.wi));
        }
    }
}

macro_rules! tracer {
    ($name:ident) => {
        /// A path tracer with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {}

        impl PathIntegrator for $name {
            type State = Path;

            fn wants(&self) -> Wants {
                Wants::EMISSION.with(Wants::DIRECT).with(Wants::SCATTER)
            }

            fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Path {
                ask.trace(job.ray);
                Path { beta: Spectrum::ONE, pdf: f32::INFINITY, depth: 0 }
            }

            fn arrive(
                &self,
                path: &mut Path,
                at: &Arrival,
                samples: &mut Samples<'_>,
                _host: &dyn Host,
                ask: &mut Ask<'_>,
            ) {
                path.arrive(at, samples, ask, Fault::$name);
            }
        }
    };
}

tracer!(Sound);
tracer!(EndlessShadows);
tracer!(StartsOnSurface);
tracer!(ShortPaths);
tracer!(NoLampsInFog);
tracer!(FogIsDark);
tracer!(Fireproof);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::integrator::<Sound>("sound_tracer");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::integrator::<EndlessShadows>("endless_shadows"),
        fault: "what is behind a lamp hides it",
    },
    Mutant {
        class: Class::integrator::<StartsOnSurface>("starts_on_surface"),
        fault: "no offset for what is scattered",
    },
    Mutant { class: Class::integrator::<ShortPaths>("short_paths"), fault: "four bounces are all" },
    Mutant {
        class: Class::integrator::<NoLampsInFog>("no_lamps_in_fog"),
        fault: "looks for no light in media",
    },
    Mutant {
        class: Class::integrator::<FogIsDark>("fog_is_dark"),
        fault: "leaves out what media send",
    },
    Mutant {
        class: Class::integrator::<Fireproof>("fireproof"),
        fault: "clamps reflected light at 2",
    },
];
