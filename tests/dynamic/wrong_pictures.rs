//! Integrators that own the picture and fail in it: the render ends and says how, on any thread.

use glam::DVec3;
use luxel_core::registry::dynamic::Library;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_sdk::Params;
use luxel_sdk::abi::{Class, LibraryTable};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, Ask, Host, Job, PathIntegrator, PathsRef, PictureIntegrator, PictureJob, Samples,
    Sight, Wants,
};
use luxel_sdk::num::Ray;

use super::registered;

/// An integrator that fails in one of several ways.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Wrong {
    /// Which.
    #[param(default = 0, min = 0, max = 9)]
    way: u32,
}

impl PictureIntegrator for Wrong {
    fn wants(&self) -> Wants {
        Wants::SCATTER
    }

    fn render(&self, job: &dyn PictureJob) {
        assert!(self.way != 0, "no picture today");
        if self.way == 1 {
            job.run_camera_paths(PathsRef::new(&Paths(1)));
        }
        job.run_light_paths(3000, PathsRef::new(&Paths(self.way)));
        // More passes than were asked for, and results for fewer rays than there are.
        (0..2 * job.samples()).for_each(|_| job.finish_pass());
        let rays = [Ray::new(DVec3::Z * 4.0, DVec3::NEG_Z), Ray::new(DVec3::ZERO, DVec3::NAN)];
        let (mut few, mut hidden) = ([Arrival::default()], [false; 3]);
        job.trace_n(&rays, &mut few);
        job.occluded_n(&rays, &mut hidden);
        assert!((few[0].t - 4.0).abs() < 1e-9 && hidden == [true, false, false]);
    }
}

struct Paths(u32);

impl PathIntegrator for Paths {
    type State = ();

    fn wants(&self) -> Wants {
        // More than the integrator: that is not prepared.
        Wants::SCATTER.with(Wants::SIGHT)
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) {
        assert!(self.0 != 2, "no path begins");
        let ray = if self.0 == 3 { Ray::new(DVec3::NAN, DVec3::Z) } else { job.ray };
        ask.trace(ray);
    }

    fn arrive(
        &self,
        (): &mut (),
        at: &Arrival,
        _: &mut Samples<'_>,
        _: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        assert!(self.0 != 1 && at.sight.get().is_none(), "no path arrives");
        if self.0 == 4 {
            (0..2).for_each(|_| ask.trace(at.ray(DVec3::Z)));
        }
    }
}

/// A path from the camera that leaves light where it has none to leave.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Stray {
    /// Nothing.
    #[param(default = 0, min = 0, max = 9)]
    way: u32,
}

impl PathIntegrator for Stray {
    type State = ();

    fn wants(&self) -> Wants {
        Wants::SIGHT
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) {
        ask.trace(job.ray);
    }

    fn arrive(
        &self,
        (): &mut (),
        at: &Arrival,
        _: &mut Samples<'_>,
        _: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        assert!(at.sight.get().is_none(), "a path from the camera is told what it sees");
        let sight = Sight { ray: at.ray(DVec3::Z), pixel: self.way, f_we: Spectrum::ONE };
        ask.splat_if_visible(&sight, Spectrum::ONE);
    }
}

const PICTURE: Class = Class::picture_integrator::<Wrong>("wrong_picture");
const STRAY: Class = Class::integrator::<Stray>("stray");

fn library() -> Library {
    let table = luxel_sdk::library_table!(&[&[PICTURE, STRAY]]);
    // The hook of a library's panics would be that of these tests.
    let table = LibraryTable { begin: None, last_panic: None, ..table };
    Library::linked(Box::leak(Box::new(table))).unwrap()
}

fn scene(integrator: &str) -> String {
    format!(
        "scene 1
        camera perspective {{ look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}
        film rgb {{ resolution = (6, 6) }}
        sampler sobol {{ samples = 4 }}
        light point {{ position = (0, 0, 3) m, spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }}
        shape rectangle {{ u = (8, 0, 0) m, v = (0, 8, 0) m }}
        integrator {integrator}"
    )
}

#[test]
fn an_integrator_that_fails_in_its_picture_ends_the_render() {
    let registry = registered(&[&library()]);
    for (integrator, told) in [
        ("wrong_picture { way = 0 }", "no picture today"),
        ("wrong_picture { way = 1 }", "no path arrives"),
        ("wrong_picture { way = 2 }", "no path begins"),
        ("wrong_picture { way = 3 }", "asked for a ray that is not finite"),
        ("wrong_picture { way = 4 }", "asked twice for one path"),
        ("stray {}", "left light in another pixel than the path's own"),
    ] {
        let stage = super::stage(&registry, &scene(integrator)).unwrap();
        let (_, outcome) = render(&stage, &Options::default(), &Control::default());
        let said = stage.failures();
        assert_eq!(outcome, Outcome::Failed, "{integrator}");
        assert!(said.len() == 1 && said[0].message.contains(told), "{integrator}: {said:?}");
        let name = integrator.split(' ').next().unwrap();
        assert!(said[0].message.contains(name), "{said:?}");
    }
    let stage = super::stage(&registry, &scene("wrong_picture { way = 9 }")).unwrap();
    let (film, outcome) = render(&stage, &Options::default(), &Control::default());
    assert_eq!(outcome, Outcome::Complete, "{:?}", stage.failures());
    assert!(film.pixels().all(|(_, pixel)| pixel.n == 4));
}
