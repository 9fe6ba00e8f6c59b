//! Integrators: closed furnaces, a scene against the suite's own path tracer, and the same picture
//! on any number of threads.

use std::num::NonZeroUsize;

use glam::{DAffine3, DVec3, UVec2};
use luxel_core::diag::{SourceId, Span};
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, can_go_on, render, render_on};
use luxel_core::scene::{Color, NodeId, Placed, Scene, Target, Value};
use luxel_core::stage::{Stage, build};
use luxel_sdk::kind::{Kind, Output, Wants};
use luxel_sdk::params::{Dimension, Unit};

use crate::report::Judge;
use crate::statistics::deviation;
use crate::subject::Subject;
use crate::sweep::{Bench, Given, Set, node};
use crate::values::LOOK;

/// Side of the pictures, pixels, and of the tiles that are compared.
pub(crate) const SIDE: u32 = 24;
pub(crate) const TILE: u32 = 6;

/// Samples of a pixel, and for an integrator as it is by default: 1 % of its light shows.
const SPP: u32 = 32;
const MANY: u32 = 512;

/// And of one in fog, whose noise is less than what a light that is left out takes.
const IN_FOG: u32 = 128;

/// How bright lamps in fog are against those in the open: what is cut off at some value shows.
const BRIGHT: f64 = 64.0;

/// Albedo of the furnace.
const ALBEDO: f64 = 0.5;

/// A furnace of more than this, half way between one bounce and all, shows all.
const MOST_BOUNCES: f64 = 1.75;

/// The suite's own path tracer.
const WALK: &str = "reference_walk";

/// What f32 rounds in a sum of a few dozen terms.
const ROUNDING: f64 = 1e-5;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    let name = subject.class.name;
    let reference = stage(subject.bench, &open_scene, WALK, &vec![]);
    let mut truth = None;
    for (i, (set, _)) in subject.usual().enumerate().take(12) {
        let makes_light = set.ask(|resolved| {
            let integrator = resolved.integrator();
            let wants = integrator.wants();
            let makes = wants.has(Wants::EMISSION) || wants.has(Wants::SIGHT);
            makes && integrator.output() == Output::Value
        });
        let Some(stage) = stage(subject.bench, &open_scene, name, &set.given) else {
            judge.skip("pictures", "the suite's scene cannot be built with it");
            return;
        };
        let spp = if i == 0 { MANY } else { SPP };
        let one = picture(&stage, 1, 1, SPP);
        is_deterministic(&stage, &one, set, judge);
        goes_on(&stage, &one, set, judge);
        let bad = one.bad_samples();
        judge.holds("samples are finite", bad == 0, || format!("{}: {bad}", set.label));
        if !makes_light {
            judge.skip("light", "it shows something else");
            continue;
        }
        if let Some(reference) = &reference {
            if i < 2 {
                truth = Some(picture(reference, 2, 2, spp));
            }
            let found = picture(&stage, 4, 2, spp);
            if let Some(truth) = &truth {
                agrees(&found, truth, i == 0, set, judge);
            }
        }
        if let Some(closed) = self::stage(subject.bench, &furnace, name, &set.given) {
            let film = picture(&closed, 3, 2, spp);
            is_a_sum_of_bounces(&film, i == 0, set, judge);
            if i == 0 && film.mean().0.y > MOST_BOUNCES {
                sees_in_fog(subject.bench, set, name, judge);
            }
        }
    }
}

fn picture(stage: &Stage, seed: u32, threads: usize, spp: u32) -> Film {
    let threads = NonZeroUsize::new(threads);
    let options = Options { spp: Some(spp), seed: Some(seed), threads, ..Options::default() };
    render(stage, &options, &Control::default()).0
}

/// A scene around an integrator; `None` if it cannot be built.
pub(crate) fn stage(
    bench: &Bench,
    fill: &dyn Fn(&mut Scene),
    integrator: &'static str,
    given: &Given,
) -> Option<Stage> {
    let mut scene = bench.scene();
    fill(&mut scene);
    let side = f64::from(SIDE);
    let size = ("resolution", Value::vector([side, side]));
    scene.film = Some(node(&mut scene, Kind::Film, "rgb", &[size]));
    scene.sampler = Some(node(&mut scene, Kind::Sampler, "reference_numbers", &[]));
    scene.filter = Some(node(&mut scene, Kind::Filter, "reference_block", &[]));
    scene.integrator = Some(node(&mut scene, Kind::Integrator, integrator, given));
    Some(build(&scene, &bench.registry, bench.files(), None).ok()?.stage)
}

fn place(scene: &mut Scene, id: NodeId, at: DVec3) {
    let pose = DAffine3::from_translation(at).into();
    let span = Span::new(SourceId(0), 0, 0);
    scene.root.items.push(Placed { target: Target::Node(id), pose, material: None, span });
}

fn plain(x: f64) -> Value {
    Value::Color(Color::Constant(x), Dimension::NONE)
}

fn number(x: f64, unit: &str) -> Value {
    let dimension = Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension);
    Value::Number(x, dimension)
}

fn matt(scene: &mut Scene, albedo: f64) -> Value {
    Value::Node(node(scene, Kind::Material, "reference_matt", &[("reflectance", plain(albedo))]))
}

fn ball(scene: &mut Scene, radius: f64, material: Option<Value>) -> NodeId {
    let mut given = vec![("radius", number(radius, "m"))];
    given.extend(material.map(|material| ("material", material)));
    node(scene, Kind::Shape, "reference_ball", &given)
}

/// A matt ball and a lamp, each convex, under a sky: what arrives was scattered once at most.
pub(crate) fn open_scene(scene: &mut Scene) {
    ball_and_lamp(scene, 1.0);
}

/// The same, brighter, in fog that shines with radiance `glow`: what arrives was scattered any number of
/// times.
fn foggy_scene(scene: &mut Scene, glow: f64) {
    ball_and_lamp(scene, BRIGHT);
    let given = [
        ("density", number(0.1, "1/m")),
        ("albedo", plain(0.8)),
        ("glow", number(glow, "W/m^2/sr")),
    ];
    scene.medium = Some(node(scene, Kind::Medium, "reference_fog", &given));
}

fn ball_and_lamp(scene: &mut Scene, brightness: f64) {
    let look = ("look", Value::look(LOOK));
    scene.camera = Some(node(scene, Kind::Camera, "reference_pinhole", &[look]));
    let material = matt(scene, 0.6);
    let body = ball(scene, 1.0, Some(material));
    place(scene, body, DVec3::new(-0.4, 0.0, 0.0));
    let shape = ball(scene, 0.4, None);
    let radiance = ("radiance", number(4.0 * brightness, "W/m^2/sr"));
    let spectrum = ("spectrum", Value::Color(Color::Rgb([1.0; 3]), Dimension::NONE));
    let given = [("shape", Value::Node(shape)), radiance.clone(), spectrum.clone()];
    let lamp = node(scene, Kind::Light, "reference_lamp", &given);
    place(scene, lamp, DVec3::new(1.3, 0.9, 0.5));
    let dim = ("radiance", number(0.3 * brightness, "W/m^2/sr"));
    let sky = node(scene, Kind::Light, "reference_sky", &[dim, spectrum]);
    place(scene, sky, DVec3::ZERO);
}

/// The inside of a ball that shines with radiance 1 and reflects: everywhere Σ albedoᵏ.
fn furnace(scene: &mut Scene) {
    let look = ("look", Value::look(luxel_sdk::params::Look { from: DVec3::X, ..LOOK }));
    scene.camera = Some(node(scene, Kind::Camera, "reference_pinhole", &[look]));
    let material = matt(scene, ALBEDO);
    let shape = ball(scene, 5.0, Some(material));
    let white = Value::Color(Color::Rgb([1.0; 3]), Dimension::NONE);
    let given = [
        ("shape", Value::Node(shape)),
        ("scale", number(1.0, "")),
        ("spectrum", white),
        ("inside", Value::Bool(true)),
    ];
    let lamp = node(scene, Kind::Light, "reference_lamp", &given);
    place(scene, lamp, DVec3::ZERO);
}

/// The same seed gives the same bits on one thread and on several, and again.
fn is_deterministic(stage: &Stage, one: &Film, set: &Set, judge: &mut Judge) {
    for threads in [1, 3] {
        let other = picture(stage, 1, threads, SPP);
        let same = are_same(one, &other);
        judge.holds("same bits on all threads", same, || format!("{}: {threads}", set.label));
    }
}

fn are_same(one: &Film, other: &Film) -> bool {
    one.pixels().zip(other.pixels()).all(|((_, a), (_, b))| {
        a.n == b.n && a.mean.to_array().map(f64::to_bits) == b.mean.to_array().map(f64::to_bits)
    })
}

/// A picture that was left half done goes on to the same bits, where the integrator says that it can.
fn goes_on(stage: &Stage, one: &Film, set: &Set, judge: &mut Judge) {
    if !can_go_on(stage) {
        judge.skip("a picture goes on", "its passes depend on what it has seen before");
        return;
    }
    let mut film = picture(stage, 1, 1, SPP / 2);
    let options = Options { spp: Some(SPP), seed: Some(1), ..Options::default() };
    render_on(&mut film, stage, &options, &Control::default(), &mut |_, _| {});
    judge.holds("a picture goes on", are_same(one, &film), || set.label.clone());
}

/// What shows all bounces shows bright light in fog, as the suite's own path tracer does; and the light of
/// the fog, but for what owns the picture, whose paths may begin at lamps alone.
fn sees_in_fog(bench: &Bench, set: &Set, name: &'static str, judge: &mut Judge) {
    let glow = set.ask(|resolved| {
        let owns_picture = resolved.integrator().as_picture().is_some();
        if owns_picture { 0.0 } else { BRIGHT }
    });
    let foggy = |scene: &mut Scene| foggy_scene(scene, glow);
    let found = stage(bench, &foggy, name, &set.given);
    let truth = stage(bench, &foggy, WALK, &vec![]);
    let (Some(found), Some(truth)) = (found, truth) else {
        judge.skip("fog is right", "the suite's fog cannot be built with it");
        return;
    };
    let [found, truth] = [(&found, 6), (&truth, 5)].map(|(s, seed)| picture(s, seed, 2, IN_FOG));
    let ((a, ea), (b, eb)) = (found.mean(), truth.mean());
    let z = deviation(a.y - b.y, ROUNDING * b.y, ea.y.hypot(eb.y));
    judge.statistic("fog is right", z, || {
        format!("{}: {} ± {} instead of {} ± {}", set.label, a.y, ea.y, b.y, eb.y)
    });
}

/// Sum over a tile of means and of squared standard errors.
fn tile(film: &Film, tile: UVec2) -> (f64, f64) {
    let mut out = (0.0, 0.0);
    for i in 0..TILE * TILE {
        let pixel = film.pixel(tile * TILE + UVec2::new(i % TILE, i / TILE));
        let error = pixel.standard_error().y;
        out = (out.0 + pixel.mean.y, out.1 + error * error);
    }
    out
}

/// Tile by tile against the suite's own path tracer (Welch 1947). With other parameters than its
/// defaults an integrator may leave light out, but not add any.
fn agrees(found: &Film, truth: &Film, nominal: bool, set: &Set, judge: &mut Judge) {
    let ((a, ea), (b, eb)) = (found.mean(), truth.mean());
    if nominal {
        let z = deviation(a.y - b.y, ROUNDING * b.y, ea.y.hypot(eb.y));
        judge.statistic("the picture is right", z, || {
            format!("{}: {} instead of {}", set.label, a.y, b.y)
        });
    }
    let tiles = SIDE / TILE;
    for i in 0..tiles * tiles {
        let at = UVec2::new(i % tiles, i / tiles);
        let ((a, va), (b, vb)) = (tile(found, at), tile(truth, at));
        let sigma = (va + vb).sqrt().max(b / f64::from(TILE * TILE * SPP));
        let shown = || format!("{}: tile {at}: {a} instead of {b}", set.label);
        if nominal {
            let z = deviation(a - b, ROUNDING * b, sigma);
            judge.statistic("the picture is right", z, shown);
        }
        let z = deviation((a - b).max(0.0), ROUNDING * b, sigma);
        judge.statistic("no light is added", z, shown);
    }
}

/// What a furnace of albedo ½ shows: all bounces, or the first few where the integrator says so by
/// leaving the others out entirely.
fn is_a_sum_of_bounces(film: &Film, nominal: bool, set: &Set, judge: &mut Judge) {
    let (mean, error) = film.mean();
    // By its defaults it tells all bounces or the first; parameters may cut it off anywhere, at both
    // ends: what no bounce is left of is black.
    if !nominal && mean.y <= 0.0 {
        return;
    }
    let (first, last) = if nominal { (0..1, 1..2) } else { (0..16, 0..16) };
    let all = (1.0 - ALBEDO).recip();
    let sums = first.flat_map(|i| {
        let from_here_on = ALBEDO.powi(i) * all;
        let cut_off = last.clone().map(move |j| from_here_on * (1.0 - ALBEDO.powi(j + 1)));
        cut_off.chain([from_here_on])
    });
    let sigma = error.y.max(mean.y / f64::from(SIDE * SIDE * SPP));
    let z = sums
        .map(|sum| deviation(mean.y - sum, ROUNDING * sum, sigma))
        .fold(f64::INFINITY, f64::min);
    judge.statistic("a furnace is a sum of bounces", z, || {
        format!("{}: {} ± {}", set.label, mean.y, error.y)
    });
    // Every place of it looks alike.
    let tiles = SIDE / TILE;
    for i in 0..tiles * tiles {
        let at = UVec2::new(i % tiles, i / tiles);
        let (sum, variance) = tile(film, at);
        let area = f64::from(TILE * TILE);
        let sigma = (variance / area / area + sigma * sigma).sqrt();
        let z = deviation(sum / area - mean.y, ROUNDING, sigma);
        judge.statistic("a furnace is even", z, || format!("{}: tile {at}", set.label));
    }
}
