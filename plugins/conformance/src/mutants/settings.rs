//! A camera, a sampler, a filter and integrators with a fault.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{
    Arrival, Ask, Camera, CameraRay, Filter, Host, Job, PathIntegrator, Raster, SampleAt, Sampler,
    Samples, Wants, mis,
};
use luxel_sdk::params::Look;

use super::Mutant;
use crate::reference::{Block, Numbers, Pinhole, Walk, Way};

/// A camera whose pictures stand on their head.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Headstand {
    /// Where it stands.
    #[param(required)]
    look: Look,
}

impl Headstand {
    fn pinhole(&self) -> Pinhole {
        Pinhole { look: self.look, tan: 0.5 }
    }
}

fn flipped(raster: Raster, p: DVec2) -> DVec2 {
    DVec2::new(p.x, f64::from(raster.size.y) - p.y)
}

impl Camera for Headstand {
    fn ray(&self, raster: Raster, p: DVec2, lens: [f32; 2]) -> Option<CameraRay> {
        self.pinhole().ray(raster, flipped(raster, p), lens)
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        self.pinhole().project(raster, p).map(|p| flipped(raster, p))
    }
}

/// Numbers that are the same in every dimension.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct OneDimension {
    /// Samples for each pixel.
    #[param(default = 64, min = 1, max = 4_294_967_295u32)]
    samples: u32,
    /// Equal seeds give equal numbers.
    #[param(default = 0, min = 0, max = 4_294_967_295u32)]
    seed: u32,
}

impl OneDimension {
    fn numbers(self) -> Numbers {
        Numbers { samples: self.samples, seed: self.seed }
    }
}

impl Sampler for OneDimension {
    fn samples(&self) -> u32 {
        self.samples
    }

    fn seed(&self) -> u32 {
        self.seed
    }

    fn get_1d(&self, at: SampleAt) -> f32 {
        self.numbers().get_1d(SampleAt { dimension: 0, ..at })
    }

    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        self.numbers().get_2d(SampleAt { dimension: 0, ..at })
    }
}

/// A filter that is sampled more narrowly than it says.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Narrow {
    /// Half the width, pixels.
    #[param(default = 0.5, min = 0.01, max = 16)]
    radius: f32,
}

impl Filter for Narrow {
    fn radius(&self) -> f32 {
        self.radius
    }

    fn eval(&self, offset: [f32; 2]) -> f32 {
        Block { radius: self.radius }.eval(offset)
    }

    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        Block { radius: 0.95 * self.radius }.sample(u)
    }
}

/// A path tracer whose arrivals are changed before it sees them, and whose paths go on by chance.
macro_rules! walk {
    ($name:ident, $seen:expr, $lives:expr) => {
        /// A path tracer with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {}

        impl PathIntegrator for $name {
            type State = Way;

            fn wants(&self) -> Wants {
                PathIntegrator::wants(&Walk {})
            }

            fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Way {
                Walk {}.start(job, ask)
            }

            fn arrive(
                &self,
                way: &mut Way,
                at: &Arrival,
                samples: &mut Samples<'_>,
                host: &dyn Host,
                ask: &mut Ask<'_>,
            ) {
                let lives: fn(&mut Way, &mut Samples<'_>) -> bool = $lives;
                let seen: fn(&Way, &Arrival) -> Arrival = $seen;
                let at = seen(way, at);
                if lives(way, samples) {
                    Walk {}.arrive(way, &at, samples, host, ask);
                }
            }
        }
    };
}

// Light that is found both ways counts in full both times.
walk!(
    CountsTwice,
    |way, at| Arrival { le: at.le / mis(way.pdf, at.le_pdf).max(1e-3), ..*at },
    |_, _| true
);
// Every tenth path ends after its first arrival, and the others do not make up for it.
walk!(Forgetful, |_, at| *at, |way, samples| way.pdf.is_infinite() || samples.next_1d() < 0.9);

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::camera::<Headstand>("headstand"), fault: "upside down" },
    Mutant { class: Class::sampler::<OneDimension>("one_dimension"), fault: "ignores dimensions" },
    Mutant { class: Class::filter::<Narrow>("narrow"), fault: "sampled 5 % too narrowly" },
    Mutant { class: Class::integrator::<CountsTwice>("counts_twice"), fault: "no weights for MIS" },
    Mutant { class: Class::integrator::<Forgetful>("forgetful"), fault: "roulette loses light" },
];
