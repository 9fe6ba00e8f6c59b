//! Integrators that own the whole picture: they say what is followed and when, the host follows it.

use super::{Arrival, Ask, Host, Job, Output, PathIntegrator, PathsRef, Raster, Samples, Wants};
use crate::num::Ray;
use crate::params::Fault;

/// An integrator of picture size: light tracers, photon maps, whatever a single path cannot tell.
///
/// It makes the picture in passes. What follows paths is a [`PathIntegrator`] too, made for the
/// pass: it may hold what earlier passes have found.
pub trait PictureIntegrator: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// What its paths want of the host, all kinds together: more is not prepared. A scene whose
    /// camera has no `SIGHT` to give is refused before it is rendered.
    fn wants(&self) -> Wants;

    /// What the lanes of its light mean.
    fn output(&self) -> Output {
        Output::Value
    }

    /// Whether a pass depends on nothing that earlier ones found or counted, nor on how many there are to
    /// be. Then a picture that was left unfinished can be gone on with, for more samples too: the host
    /// counts the passes that it has.
    fn has_independent_passes(&self) -> bool {
        false
    }

    /// Makes the picture: `job.samples()` times, what a pass consists of and `job.finish_pass()`.
    fn render(&self, job: &dyn PictureJob);
}

/// What the host does for an integrator that owns the picture. Every call may take many threads; the
/// results do not depend on how many.
pub trait PictureJob {
    /// The picture's size.
    fn raster(&self) -> Raster;

    /// Passes that were asked for: each gives every pixel one sample.
    fn samples(&self) -> u32;

    /// The seed.
    fn seed(&self) -> u32;

    /// Whether nothing more is wanted: an end was asked for, or every pass is done. What is asked of the
    /// host then does nothing.
    fn is_cancelled(&self) -> bool;

    /// Where rays arrive: positions alone, as `Wants::POSITION`. Media do not count, nor do surfaces
    /// that only bound them. As many results as rays: what is longer is left alone.
    fn trace_n(&self, rays: &[Ray], out: &mut [Arrival]);

    /// Whether something lies along rays, as `Host::occluded`.
    fn occluded_n(&self, rays: &[Ray], out: &mut [bool]);

    /// Follows one path from the camera through every pixel; what it adds is added to this pass.
    fn run_camera_paths(&self, paths: PathsRef<'_>);

    /// Follows `n` paths from the lights; what they splat, divided by `n`, is added to this pass.
    /// What they add to no pixel is lost.
    fn run_light_paths(&self, n: u32, paths: PathsRef<'_>);

    /// Ends the pass: its light becomes one sample of every pixel. Passes beyond `samples`, and one
    /// that was cancelled, do not count.
    fn finish_pass(&self);
}

impl<J: PictureJob + ?Sized> PictureJob for &J {
    fn raster(&self) -> Raster {
        (**self).raster()
    }
    fn samples(&self) -> u32 {
        (**self).samples()
    }
    fn seed(&self) -> u32 {
        (**self).seed()
    }
    fn is_cancelled(&self) -> bool {
        (**self).is_cancelled()
    }
    fn trace_n(&self, rays: &[Ray], out: &mut [Arrival]) {
        (**self).trace_n(rays, out);
    }
    fn occluded_n(&self, rays: &[Ray], out: &mut [bool]) {
        (**self).occluded_n(rays, out);
    }
    fn run_camera_paths(&self, paths: PathsRef<'_>) {
        (**self).run_camera_paths(paths);
    }
    fn run_light_paths(&self, n: u32, paths: PathsRef<'_>) {
        (**self).run_light_paths(n, paths);
    }
    fn finish_pass(&self) {
        (**self).finish_pass();
    }
}

/// An integrator of picture size in the place of one of path size: its paths end at once.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Picture<T>(pub T);

impl<T: PictureIntegrator> PathIntegrator for Picture<T> {
    type State = ();

    fn wants(&self) -> Wants {
        self.0.wants()
    }

    fn output(&self) -> Output {
        self.0.output()
    }

    fn start(&self, _job: &Job, _ask: &mut Ask<'_>) {}

    fn arrive(
        &self,
        (): &mut (),
        _at: &Arrival,
        _samples: &mut Samples<'_>,
        _host: &dyn Host,
        _ask: &mut Ask<'_>,
    ) {
    }

    fn as_picture(&self) -> Option<&dyn PictureIntegrator> {
        Some(&self.0)
    }
}
