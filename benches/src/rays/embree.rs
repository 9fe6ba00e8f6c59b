//! Embree 4, where its library is found at run time.
//!
//! Source: its C interface, `embree4/rtcore_*.h`.
#![expect(unsafe_code, reason = "calls a C library")]

use std::ffi::{CString, c_char, c_void};
use std::path::Path;
use std::ptr;
use std::sync::atomic::{AtomicIsize, Ordering};

use libloading::Library;

use super::knot::Soup;
use super::peers::{Tracer, answer};
use super::shots::{Landing, Shot};

type Handle = *mut c_void;

/// `RTCRayHit`; the last three words are what an instance would write.
#[repr(C, align(16))]
struct RayHit {
    o: [f32; 3],
    t_near: f32,
    d: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    ng: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instance: [u32; 2],
    room: [u32; 3],
}

impl RayHit {
    fn new(shot: &Shot) -> Self {
        Self {
            o: shot.o.to_array(),
            t_near: 0.0,
            d: shot.d.to_array(),
            time: 0.0,
            t_far: shot.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            ng: [0.0; 3],
            u: 0.0,
            v: 0.0,
            primitive: u32::MAX,
            geometry: u32::MAX,
            instance: [u32::MAX; 2],
            room: [0; 3],
        }
    }
}

static BYTES: AtomicIsize = AtomicIsize::new(0);

extern "C" fn count(_: Handle, bytes: isize, _: bool) -> bool {
    BYTES.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// How Embree builds: as it does unless told, or so that fewer rays slip between triangles.
#[derive(Clone, Copy)]
pub(crate) enum Flags {
    Default = 0,
    Robust = 4,
}

type Trace = unsafe extern "C" fn(Handle, *mut RayHit, Handle);

/// A device and a scene with one mesh.
pub(crate) struct Embree<'a> {
    library: &'a Library,
    device: Handle,
    scene: Handle,
    intersect: Trace,
    occluded: Trace,
    bytes: usize,
    /// The points with room behind them: Embree reads 16 bytes of each.
    _points: Vec<glam::Vec3>,
}

/// The library, if it is one.
pub(crate) fn load(path: &Path) -> Option<Library> {
    // SAFETY: running a library's initialisers is what the user asked for by naming it.
    unsafe { Library::new(path) }.ok()
}

/// A function of the library by its name, as the type of the C header.
macro_rules! function {
    ($library:expr, $name:literal, $kind:ty) => {{
        // SAFETY: the type is that of the C header for this name.
        let found = unsafe { $library.get::<$kind>($name) };
        *found.ok()?
    }};
}

/// Calls a function of the library.
macro_rules! call {
    ($f:expr $(, $argument:expr)*) => {{
        let f = $f;
        // SAFETY: handles come from this library and arrays outlive the scene that reads them.
        unsafe { f($($argument),*) }
    }};
}

type New = unsafe extern "C" fn(Handle) -> Handle;
type Release = unsafe extern "C" fn(Handle);
type Count = extern "C" fn(Handle, isize, bool) -> bool;
type Share = unsafe extern "C" fn(Handle, u32, u32, u32, *const c_void, usize, usize, usize);

impl<'a> Embree<'a> {
    /// Builds on all cores; `None` for another version's library.
    pub(crate) fn new(library: &'a Library, soup: &'a Soup, flags: Flags) -> Option<Self> {
        Self::with_threads(library, soup, flags, 0)
    }

    /// The same on so many threads; on all cores for 0.
    pub(crate) fn with_threads(
        library: &'a Library,
        soup: &'a Soup,
        flags: Flags,
        threads: usize,
    ) -> Option<Self> {
        let config = CString::new(format!("threads={threads}")).ok()?;
        let new =
            function!(library, b"rtcNewDevice", unsafe extern "C" fn(*const c_char) -> Handle);
        let device = call!(new, config.as_ptr());
        let monitor = function!(
            library,
            b"rtcSetDeviceMemoryMonitorFunction",
            unsafe extern "C" fn(Handle, Count, Handle)
        );
        call!(monitor, device, count, ptr::null_mut());
        let before = BYTES.load(Ordering::Relaxed);
        let scene = call!(function!(library, b"rtcNewScene", New), device);
        let set = function!(library, b"rtcSetSceneFlags", unsafe extern "C" fn(Handle, u32));
        call!(set, scene, flags as u32);
        let new =
            function!(library, b"rtcNewGeometry", unsafe extern "C" fn(Handle, u32) -> Handle);
        let mesh = call!(new, device, 0);
        let mut points = Vec::with_capacity(soup.points.len() + 2);
        points.extend_from_slice(&soup.points);
        let share = function!(library, b"rtcSetSharedGeometryBuffer", Share);
        let (index, vertex) = ((0, 0x5003), (1, 0x9003));
        let n = soup.indices.len();
        call!(share, mesh, index.0, 0, index.1, soup.indices.as_ptr().cast(), 0, 12, n);
        let n = points.len();
        call!(share, mesh, vertex.0, 0, vertex.1, points.as_ptr().cast(), 0, 12, n);
        call!(function!(library, b"rtcCommitGeometry", Release), mesh);
        let attach =
            function!(library, b"rtcAttachGeometry", unsafe extern "C" fn(Handle, Handle) -> u32);
        call!(attach, scene, mesh);
        call!(function!(library, b"rtcReleaseGeometry", Release), mesh);
        call!(function!(library, b"rtcCommitScene", Release), scene);
        let bytes = BYTES.load(Ordering::Relaxed) - before;
        Some(Self {
            library,
            device,
            scene,
            intersect: function!(library, b"rtcIntersect1", Trace),
            occluded: function!(library, b"rtcOccluded1", Trace),
            bytes: usize::try_from(bytes).unwrap_or(0),
            _points: points,
        })
    }

    fn release(&self) -> Option<()> {
        call!(function!(self.library, b"rtcReleaseScene", Release), self.scene);
        call!(function!(self.library, b"rtcReleaseDevice", Release), self.device);
        Some(())
    }
}

impl Drop for Embree<'_> {
    fn drop(&mut self) {
        self.release();
    }
}

impl Tracer for Embree<'_> {
    fn nearest(&self, shots: &[Shot], found: &mut [Landing]) {
        for (shot, found) in shots.iter().zip(found) {
            let mut ray = RayHit::new(shot);
            call!(self.intersect, self.scene, &raw mut ray, ptr::null_mut());
            *found = if ray.geometry == u32::MAX {
                Landing::NOWHERE
            } else {
                Landing { t: ray.t_far, triangle: ray.primitive }
            };
        }
    }

    fn any(&self, shots: &[Shot], found: &mut [Landing]) {
        for (shot, found) in shots.iter().zip(found) {
            let mut ray = RayHit::new(shot);
            call!(self.occluded, self.scene, &raw mut ray, ptr::null_mut());
            *found = answer(ray.t_far < 0.0);
        }
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}
