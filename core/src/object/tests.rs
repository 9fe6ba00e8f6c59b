//! Objects of plugins that exist only here.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::{Observer, Palette, Spectrum, Wavelengths, to_xyz};
use luxel_sdk::kind::{
    Eval, Kind, Light, LightForm, Material, MaterialRef, Output, Sample, Texture, TexturePoint,
    TextureRef,
};
use luxel_sdk::params::{Build, BuildContext, Dimension, Emission, Fault, Shared, Unit};

use super::{Builder, ColorMode, Object, Objects, Scratch, Site};
use crate::diag::{SourceId, Span};
use crate::files::MemoryFiles;
use crate::registry::Registry;
use crate::scene::{Argument, Color, Node, NodeId, Scene, Value};

/// Gives back its parameters as an `Eval`.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Echo {
    /// Comes back as `f`.
    #[param(default = 0.25, role = reflectance, textured)]
    reflectance: Spectrum,
    /// Comes back doubled as `pdf`.
    #[param(default = 0.5, min = 0, max = 1, textured)]
    roughness: f32,
    #[param(derived)]
    doubled: f32,
}

impl Material for Echo {
    fn prepare(&mut self) {
        self.doubled = 2.0 * self.roughness;
    }
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval { f: self.reflectance, pdf: self.doubled }
    }
    fn sample(&self, _wo: Vec3, _u: [f32; 3]) -> Option<Sample> {
        None
    }
}

/// Hands on to another material.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Through<'a> {
    /// To which.
    #[param(required)]
    base: MaterialRef<'a>,
}

impl Material for Through<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        self.base.eval(wo, wi)
    }
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        self.base.sample(wo, u)
    }
}

/// Its own coordinates as a colour, scaled.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Coordinates {
    /// By how much.
    #[param(default = 1.0)]
    scale: f32,
}

impl Texture for Coordinates {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        Spectrum::from_rgb(at.uv.extend(0.5) * self.scale)
    }
    fn output(&self) -> Output {
        Output::Rgb
    }
}

/// A lamp that gives back what it emits as radiance.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Lamp {
    /// What.
    #[param(emission(radiance, scale), textured)]
    emission: Emission,
}

impl Light for Lamp {
    fn form(&self) -> LightForm {
        LightForm::Surface
    }
    fn le(&self, _cos_o: f32, _uv: Vec2, _area: f64) -> Spectrum {
        self.emission.spectrum
    }
    fn power(&self, _area: f64, _radius: f64) -> f32 {
        1.0
    }
}

/// Reads a table that lies in the object itself, not behind another pointer.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Tabled<'a> {
    /// What the table is full of.
    #[param(default = 1.0)]
    value: f32,
    #[param(shared)]
    table: Shared<'a, [f32; 512]>,
}

impl Build<[f32; 512]> for Tabled<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<[f32; 512], Vec<Fault>> {
        // In two parts, which add up.
        for bytes in [1500, 548] {
            context.holds(bytes);
        }
        Ok([self.value; 512])
    }
}

impl Texture for Tabled<'_> {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        let (least, most) = self
            .table
            .iter()
            .fold((f32::MAX, f32::MIN), |(least, most), x| (least.min(*x), most.max(*x)));
        Spectrum::new(least, most, 0.0, 0.0)
    }
    fn output(&self) -> Output {
        Output::Value
    }
}

/// Gives back what drives it.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Driven {
    /// By what.
    #[param(default = 0.5, min = 0, max = 10, textured)]
    value: f32,
}

impl Texture for Driven {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        Spectrum::splat(self.value)
    }
}

/// The surface's own colours, or grey.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Own {
    /// Where there are none.
    #[param(default = 0.5)]
    grey: f32,
}

impl Texture for Own {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        Spectrum::splat(self.grey)
    }
    fn output(&self) -> Output {
        Output::Corners
    }
}

/// Asks a texture while it is built; −1 if there is none.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Asking<'a> {
    /// Which.
    #[param(optional)]
    of: TextureRef<'a>,
    #[param(shared)]
    table: Shared<'a, f32>,
}

impl Build<f32> for Asking<'_> {
    fn build(&self, _context: &dyn BuildContext) -> Result<f32, Vec<Fault>> {
        Ok(self.of.number(DVec3::ZERO, Vec2::new(0.25, 4.0)).unwrap_or(-1.0))
    }
}

impl Texture for Asking<'_> {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        Spectrum::splat(*self.table)
    }
}

struct World {
    registry: Registry,
    scene: Scene,
}

impl World {
    fn new() -> Self {
        let mut registry = Registry::default();
        let classes = [
            Class::material::<Echo>("echo"),
            Class::material::<Through<'_>>("through"),
            Class::texture::<Coordinates>("coordinates"),
            Class::texture::<Tabled<'_>>("tabled"),
            Class::texture::<Own>("own"),
            Class::texture::<Driven>("driven"),
            Class::texture::<Asking<'_>>("asking"),
            Class::light::<Lamp>("lamp"),
        ];
        registry.add("test", &classes).unwrap();
        Self { registry, scene: Scene::default() }
    }

    fn node(
        &mut self,
        kind: Kind,
        class: &'static str,
        params: &[(&'static str, Value)],
    ) -> NodeId {
        let span = Span::new(SourceId(0), 0, 0);
        let params =
            params.iter().map(|(name, value)| Argument { name, value: value.clone(), span });
        self.scene.add(Node {
            kind,
            class,
            label: None,
            params: params.collect(),
            overrides: vec![],
            span,
            hash: [0; 32],
        })
    }

    fn build(&self, id: NodeId, mode: ColorMode) -> Result<Arc<Object>, Vec<&'static str>> {
        let (files, before) = (MemoryFiles::default(), Objects::default());
        let mut builder = Builder::new(&self.registry, &self.scene, &files, mode, &before);
        let object = builder.build(id);
        object.ok_or_else(|| builder.diagnostics.iter().map(|d| d.code).collect())
    }
}

fn echo(object: &Object, uv: Vec2, palette: &Palette) -> Eval {
    let scratch = Scratch::default();
    let site = Site { p: DVec3::ZERO, uv, palette, color: None };
    object.resolve(&site, &scratch).material().eval(Vec3::Z, Vec3::Z)
}

#[test]
fn what_does_not_vary_is_the_template_itself() {
    let mut world = World::new();
    let id = world.node(Kind::Material, "echo", &[("roughness", number(0.75))]);
    let object = world.build(id, ColorMode::Spectral).unwrap();
    assert!(object.is_constant() && !object.takes_colors());
    let got = echo(&object, Vec2::ZERO, &Palette::rgb());
    assert_eq!((got.f, got.pdf.to_bits()), (Spectrum::splat(0.25), 1.5f32.to_bits()));
}

#[test]
fn a_texture_is_clamped_to_the_range_and_prepared_at_the_hit() {
    let mut world = World::new();
    let texture = world.node(Kind::Texture, "coordinates", &[("scale", number(2.0))]);
    let params = [("roughness", Value::Node(texture)), ("reflectance", Value::Node(texture))];
    let id = world.node(Kind::Material, "echo", &params);
    let object = world.build(id, ColorMode::Rgb).unwrap();
    let got = echo(&object, Vec2::new(0.25, 0.75), &Palette::rgb());
    assert_eq!(got.f.rgb(), Vec3::new(0.5, 1.0, 1.0));
    // A luminance of 1.25, clamped to 1 and doubled.
    assert_eq!(got.pdf.to_bits(), 2.0f32.to_bits());
}

#[test]
fn a_colour_where_a_number_is_wanted_counts_by_its_luminance() {
    let mut world = World::new();
    let texture = world.node(Kind::Texture, "coordinates", &[]);
    let id = world.node(Kind::Material, "echo", &[("roughness", Value::Node(texture))]);
    for mode in [ColorMode::Rgb, ColorMode::Spectral] {
        let object = world.build(id, mode).unwrap();
        let roughness = |uv| echo(&object, uv, &Palette::rgb()).pdf / 2.0;
        assert_eq!(roughness(Vec2::splat(0.5)).to_bits(), 0.5f32.to_bits());
        // ITU-R BT.709: 0.2126, 0.7152 and 0.0722, the last of 0.5. A few roundings of f32.
        for (uv, expected) in [(Vec2::X, 0.2126 + 0.0361), (Vec2::Y, 0.7152 + 0.0361)] {
            assert!((roughness(uv) - expected).abs() < 5e-5, "{uv}: {}", roughness(uv));
        }
    }
}

#[test]
fn a_nested_material_is_resolved_at_the_same_point() {
    let mut world = World::new();
    let texture = world.node(Kind::Texture, "coordinates", &[]);
    let inner = world.node(Kind::Material, "echo", &[("reflectance", Value::Node(texture))]);
    let mut id = inner;
    for _ in 0..10 {
        id = world.node(Kind::Material, "through", &[("base", Value::Node(id))]);
    }
    let object = world.build(id, ColorMode::Rgb).unwrap();
    let got = echo(&object, Vec2::new(0.25, 0.75), &Palette::rgb());
    assert_eq!(got.f.rgb(), Vec3::new(0.25, 0.75, 0.5));
}

#[test]
fn nesting_beyond_the_scratch_is_refused() {
    let mut world = World::new();
    let texture = world.node(Kind::Texture, "coordinates", &[]);
    let mut id = world.node(Kind::Material, "echo", &[("reflectance", Value::Node(texture))]);
    for _ in 0..64 {
        id = world.node(Kind::Material, "through", &[("base", Value::Node(id))]);
    }
    assert_eq!(world.build(id, ColorMode::Rgb).unwrap_err(), ["E0507"]);
}

#[test]
fn a_shared_table_stays_where_it_was_while_its_object_moves() {
    let mut world = World::new();
    let ids: Vec<_> = (0..32_u8)
        .map(|i| world.node(Kind::Texture, "tabled", &[("value", number(f64::from(i)))]))
        .collect();
    let objects = ids.iter().map(|id| world.build(*id, ColorMode::Rgb).unwrap());
    // Whatever was given back too early is taken and written over by these, of the same size.
    let objects: Vec<_> = objects.map(|object| (object, Box::new([-1.0_f32; 512]))).collect();
    let palette = Palette::rgb();
    for ((object, other), i) in objects.iter().zip(0_u8..) {
        let scratch = Scratch::default();
        let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
        let at = TexturePoint { p: site.p, uv: site.uv, lambda: palette.wavelengths };
        let found = object.resolve(&site, &scratch).texture().eval(&at).to_array();
        assert_eq!(found[..2], [f32::from(i); 2]);
        assert!(other.iter().all(|x| *x < 0.0));
    }
}

#[test]
fn radiance_means_the_same_light_in_both_modes_and_both_systems() {
    // 1 W/m²/sr of equal-energy light has Y = 1, and is 155.3 cd/m².
    let nit = luxel_sdk::color::luminance_cd_m2(1.0);
    for (amount, unit) in [(1.0, "W/m^2/sr"), (nit, "nit")] {
        let mut world = World::new();
        let amount = Value::Number(amount, Unit::parse(unit).unwrap().dimension);
        let white = Value::Color(Color::Constant(7.0), Dimension::NONE);
        let id = world.node(Kind::Light, "lamp", &[("radiance", amount), ("spectrum", white)]);
        let luminance = |mode| {
            let object = world.build(id, mode).unwrap();
            let palette = Palette::new(Wavelengths::sample(0.3));
            let scratch = Scratch::default();
            let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
            object.resolve(&site, &scratch).light().le(1.0, Vec2::ZERO, 1.0)
        };
        let rgb = luminance(ColorMode::Rgb).rgb().as_dvec3();
        let weights = luxel_sdk::color::RgbSpace::LinearSrgb.luminance_weights();
        // Lanes are f32: a few roundings.
        assert!((weights.dot(rgb) - 1.0).abs() < 1e-6, "{unit}: {rgb}");
        let lanes = luminance(ColorMode::Spectral);
        assert!((lanes - Spectrum::ONE).max_element().abs() < 1e-6, "{unit}: {lanes:?}");
    }
}

#[test]
fn rgb_light_of_scale_one_is_white_in_both_modes() {
    let mut world = World::new();
    let id = world.node(Kind::Light, "lamp", &[("scale", number(1.0))]);
    let object = world.build(id, ColorMode::Spectral).unwrap();
    // The mean of Y over stratified hero wavelengths: a rectangle rule over the whole band.
    let n = 4096_u16;
    let mean: f64 = (0..n)
        .map(|i| {
            let w = Wavelengths::sample((f32::from(i) + 0.5) / f32::from(n) / 4.0);
            let palette = Palette::new(w);
            let scratch = Scratch::default();
            let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
            let le = object.resolve(&site, &scratch).light().le(1.0, Vec2::ZERO, 1.0);
            to_xyz(Observer::Cie1931, le, &w).y
        })
        .sum();
    // D65 is piecewise linear at 1 nm, the rule has 35 points in each: error far below 1e-4.
    assert!((mean / f64::from(n) - 1.0).abs() < 1e-4, "{}", mean / f64::from(n));
}

#[test]
fn the_colours_of_a_surface_go_before_what_a_texture_says() {
    let mut world = World::new();
    let own = world.node(Kind::Texture, "own", &[]);
    let through = world.node(Kind::Texture, "driven", &[("value", Value::Node(own))]);
    let weights = luxel_sdk::color::RgbSpace::LinearSrgb.luminance_weights().as_vec3();
    let red = Vec3::new(0.75, 0.25, 0.0);
    for (texture, color, expected) in [
        (own, Some(red), red),
        (own, None, Vec3::splat(0.5)),
        (through, Some(red), Vec3::splat(weights.dot(red))),
    ] {
        let id = world.node(Kind::Material, "echo", &[("reflectance", Value::Node(texture))]);
        let object = world.build(id, ColorMode::Rgb).unwrap();
        let (palette, scratch) = (Palette::rgb(), Scratch::default());
        let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color };
        let got = object.resolve(&site, &scratch).material().eval(Vec3::Z, Vec3::Z).f.rgb();
        assert!(object.takes_colors());
        // Three products and their sum.
        assert!((got - expected).abs().max_element() <= 4.0 * f32::EPSILON, "{got} {expected}");
    }
}

#[test]
fn a_texture_is_asked_while_an_object_is_built() {
    let mut world = World::new();
    let colour = world.node(Kind::Texture, "coordinates", &[("scale", number(2.0))]);
    let varying = world.node(Kind::Texture, "driven", &[("value", Value::Node(colour))]);
    let fixed = world.node(Kind::Texture, "driven", &[("value", number(3.0))]);
    let weights = luxel_sdk::color::RgbSpace::LinearSrgb.luminance_weights().as_vec3();
    // Of the colour (1/2, 8, 1), which the parameter's range leaves as it is.
    let luminance = weights.dot(Vec3::new(0.5, 8.0, 1.0));
    for mode in [ColorMode::Rgb, ColorMode::Spectral] {
        for (of, expected) in [
            (Some(colour), luminance),
            (Some(varying), luminance),
            (Some(fixed), 3.0),
            (None, -1.0),
        ] {
            let given: Vec<_> = of.map(|of| ("of", Value::Node(of))).into_iter().collect();
            let id = world.node(Kind::Texture, "asking", &given);
            let object = world.build(id, mode).unwrap();
            let at =
                TexturePoint { p: DVec3::ZERO, uv: Vec2::ZERO, lambda: Wavelengths::sample(0.3) };
            let found = object.fixed().texture().eval(&at).lane(0);
            // A few roundings of a number below 10.
            assert!((found - expected).abs() <= 40.0 * f32::EPSILON, "{found} {expected}");
        }
    }
}

fn number(x: f64) -> Value {
    Value::Number(x, Dimension::NONE)
}

#[test]
fn what_an_object_holds_counts_against_what_is_kept() {
    let mut world = World::new();
    let [one, other] = [1.0, 2.0].map(|x| {
        let value = Value::Number(x, Dimension::NONE);
        world.node(Kind::Texture, "tabled", &[("value", value)])
    });
    let files = MemoryFiles::default();
    let built = |id, before: &Objects| {
        let World { registry, scene } = &world;
        let mut builder = Builder::new(registry, scene, &files, ColorMode::Rgb, before);
        builder.build(id).unwrap();
        builder.objects
    };
    let first = built(one, &Objects::default());
    // No file was read: its table has 512 numbers of 4 bytes.
    let left = |most| {
        let mut second = built(other, &first);
        (second.inherit(&first, most), built(one, &second).made)
    };
    assert_eq!([2047, 2048, 9999].map(left), [(0, 1), (2048, 0), (2048, 0)]);
}
