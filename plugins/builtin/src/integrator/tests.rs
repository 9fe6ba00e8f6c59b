//! Integrators in a furnace that is no more than an arrival: every ray meets the same matt wall.

use glam::DVec3;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, ArrivalKind, Direct as Light, Host, Integrator, Job, Lane, Requests, Round, SampleAt,
    Sampler, Scatter,
};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

use super::ambient_occlusion::AmbientOcclusion;
use super::path::PathTracer;

struct Numbers;

impl Sampler for Numbers {
    fn samples(&self) -> u32 {
        1
    }
    fn seed(&self) -> u32 {
        0
    }
    fn get_1d(&self, at: SampleAt) -> f32 {
        self.get_2d(at)[0]
    }
    #[expect(clippy::cast_possible_truncation, reason = "two halves")]
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        let bits = hash_combine64(u64::from(at.index), u64::from(at.dimension));
        [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
    }
}

struct Open;

impl Host for Open {
    fn occluded(&self, _ray: &Ray) -> bool {
        false
    }
    fn scene_sphere(&self) -> (DVec3, f64) {
        (DVec3::ZERO, 1.0)
    }
}

/// A wall of the given albedo that shines with radiance 1, and half of it is found by light
/// sampling: both techniques have the same density.
fn wall(albedo: f32, sampled: bool) -> Arrival {
    let ray = Ray::new(DVec3::ZERO, DVec3::Z);
    let weight = Spectrum::splat(albedo);
    let light = Light { ray, f_le: weight, pdf: 0.3, f_pdf: 0.3 };
    Arrival {
        kind: ArrivalKind::Surface,
        ng: DVec3::Z,
        ns: DVec3::Z,
        wo: DVec3::Z,
        le: Spectrum::ONE,
        le_pdf: 0.3,
        direct: sampled.then_some(light).into(),
        scatter: Maybe::some(Scatter { weight, wi: DVec3::Z, pdf: 0.3, eta: 1.0 }),
        ..Arrival::default()
    }
}

/// Radiance of path number `index`, where every ray arrives at `at` and no shadow ray is blocked.
fn radiance(integrator: &dyn Integrator, at: &Arrival, index: u32) -> f64 {
    let numbers = SampleAt { stream: 0, index, dimension: 0 };
    let mut lanes = [Lane { at: *at, l: Spectrum::ZERO, glow: Spectrum::ZERO, numbers }];
    let mut states = integrator.lanes(1);
    let round = Round { host: &Open, sampler: &Numbers };
    let (mut requests, mut shadows) = (Requests::default(), Spectrum::ZERO);
    let job = Job::of_camera(Ray::new(DVec3::ZERO, DVec3::NEG_Z));
    states.start(0, &job, &mut lanes[0].l, &mut requests);
    while !requests.rays.is_empty() {
        requests.clear();
        states.arrive_n(&mut lanes, &[0], round, &mut requests);
        shadows += requests.shadows.iter().map(|shadow| shadow.l).sum::<Spectrum>();
    }
    f64::from((lanes[0].l + shadows).lane(0))
}

fn path(max_depth: u32, russian_roulette_from: u32, light_sampling: bool) -> PathTracer {
    PathTracer { max_depth, russian_roulette_from, russian_roulette_below: 1.0, light_sampling }
}

/// Mean and variance of the radiance of so many paths.
fn moments(tracer: &PathTracer, at: &Arrival, n: u32) -> (f64, f64) {
    let (mut mean, mut square) = (0.0, 0.0);
    for i in 0..n {
        let l = radiance(tracer, at, i);
        mean += l / f64::from(n);
        square += l * l / f64::from(n);
    }
    (mean, square - mean * mean)
}

#[test]
fn a_cut_off_furnace_gives_the_partial_sum() {
    for light_sampling in [false, true] {
        for n in [0, 1, 5, 40] {
            let tracer = path(n, u32::MAX, light_sampling);
            let got = radiance(&tracer, &wall(0.5, light_sampling), 0);
            // Sampling a light and arriving at it by chance both count as one scattering: neither
            // half may go one event further than the other.
            let full = (1.0 - 0.5f64.powi(i32::try_from(n).unwrap() + 1)) / 0.5;
            assert!((got - full).abs() < 1e-5, "{light_sampling} {n} {got} {full}");
        }
    }
}

#[test]
fn russian_roulette_by_throughput_has_variance_ninety_at_albedo_nine_tenths() {
    // Truth stat.rr_furnace: geometric numbers of bounces, mean 10, variance 90, fourth central
    // moment 9·90² + 90.
    let tracer = path(1_000_000, 0, false);
    let n = 200_000;
    let (mean, variance) = moments(&tracer, &wall(0.9, false), n);
    assert!((mean - 10.0).abs() < 5.0 * (90.0 / f64::from(n)).sqrt(), "{mean}");
    let error = 5.0 * ((9.0 * 8100.0 + 90.0 - 8100.0) / f64::from(n)).sqrt();
    assert!((variance - 90.0).abs() < error, "{variance}");
}

#[test]
fn a_window_of_weights_has_the_variance_of_its_tail() {
    let (albedo, below) = (0.9f64, 0.25f64);
    // Fourteen events bring the throughput below the window; from there on it is that of the window,
    // for a geometric number of events, mean 10, or the path ends at once.
    let first = albedo.powi(14) / below;
    let power = |k: i32| {
        let geometric = (1..2000).map(|n| 0.1 * albedo.powi(n - 1) * f64::from(n).powi(k));
        first * below.powi(k) * geometric.sum::<f64>()
    };
    let (m1, m2, m3, m4) = (power(1), power(2), power(3), power(4));
    let truth = m2 - m1 * m1;
    let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1.powi(4);
    let tracer = PathTracer { russian_roulette_below: 0.25, ..path(1_000_000, 0, false) };
    let n = 200_000;
    let (mean, variance) = moments(&tracer, &wall(0.9, false), n);
    assert!((mean - 10.0).abs() < 5.0 * (truth / f64::from(n)).sqrt(), "{mean}");
    let error = 5.0 * ((fourth - truth * truth) / f64::from(n)).sqrt();
    assert!((variance - truth).abs() < error, "{variance} instead of {truth}");
}

#[test]
fn a_window_at_zero_ends_no_path() {
    let tracer = PathTracer { russian_roulette_below: 0.0, ..path(40, 0, false) };
    let full = (1.0 - 0.5f64.powi(41)) / 0.5;
    let got = radiance(&tracer, &wall(0.5, false), 0);
    assert!((got - full).abs() < 1e-5, "{got} {full}");
}

#[test]
fn light_sampling_and_chance_share_the_light() {
    let tracer = path(1_000_000, 3, true);
    let n = 20_000;
    let mean: f64 = (0..n).map(|i| radiance(&tracer, &wall(0.8, true), i) / f64::from(n)).sum();
    // The number of bounces beyond the third varies by .8/.04 = 20 at most.
    assert!((mean - 5.0).abs() < 5.0 * (20.0 / f64::from(n)).sqrt(), "{mean}");
}

#[test]
fn dark_and_broken_paths_end() {
    for weight in [0.0, f32::NAN, f32::INFINITY] {
        let got = radiance(&path(1_000_000, 3, false), &wall(weight, false), 0);
        assert!((got - 1.0).abs() <= 0.0, "{got}");
    }
}

#[test]
fn an_open_place_sees_the_whole_sky() {
    let integrator = AmbientOcclusion { distance: Maybe::default() };
    for i in 0..20 {
        assert!((radiance(&integrator, &wall(0.0, false), i) - 1.0).abs() <= 0.0);
    }
    assert!(radiance(&integrator, &Arrival::default(), 0).abs() <= 0.0);
}
