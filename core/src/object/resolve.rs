//! Parameters at a point.
#![expect(unsafe_code, reason = "templates are copied and filled by offset")]

use std::cell::{Cell, UnsafeCell};
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::abi::{Class, View};
use luxel_sdk::color::{Palette, Spectrum};
use luxel_sdk::kind::{
    Camera, Filter, Importer, Integrator, Light, Material, Medium, Output, Phase, Sampler, Shape,
    Texture, TexturePoint,
};

use luxel_sdk::params::{BuildContext, ComplexIor, Fault, Kind, Param, Role, Type};

use super::Object;
use super::block::Chunk;
use crate::scene::Feature;

use super::patch::{Target, TexturePatch};

/// Chunks in a scratch: 4 KiB.
pub(super) const SCRATCH: usize = 64;

/// Room for the parameters of everything that is resolved at one point.
///
/// Nested objects are resolved while their parent is half filled, so the room is shared by
/// reference and hands out separate pieces.
pub struct Scratch {
    room: Box<[UnsafeCell<MaybeUninit<Chunk>>; SCRATCH]>,
    used: Cell<usize>,
}

impl Default for Scratch {
    fn default() -> Self {
        let room = std::array::from_fn(|_| UnsafeCell::new(MaybeUninit::uninit()));
        Self { room: Box::new(room), used: Cell::new(0) }
    }
}

impl Scratch {
    /// Forgets everything: nothing that was resolved is still borrowed, says the borrow.
    pub fn reset(&mut self) {
        self.used.set(0);
    }

    /// A copy of `template`, in a piece of its own.
    fn copy(&self, template: &[Chunk]) -> *mut u8 {
        let at = self.used.get();
        let end = at + template.len();
        assert!(end <= SCRATCH, "the builder bounds what one point needs");
        self.used.set(end);
        for (slot, chunk) in self.room[at..end].iter().zip(template) {
            // SAFETY: `used` has passed this slot, so no one else refers to it.
            unsafe { slot.get().write(MaybeUninit::new(*chunk)) };
        }
        self.room[at..].as_ptr().cast_mut().cast()
    }
}

/// Where, and on which path, parameters are asked for.
#[derive(Clone, Copy)]
pub struct Site<'a> {
    /// World space, metres.
    pub p: DVec3,
    /// Surface coordinates.
    pub uv: Vec2,
    /// The path's wavelengths.
    pub palette: &'a Palette,
    /// The surface's own colour, linear sRGB, where its corner points have any.
    pub color: Option<Vec3>,
}

/// An object's parameters at one point: a valid struct of its class, lent for `'a`.
#[derive(Clone, Copy)]
pub struct Resolved<'a> {
    at: *const u8,
    class: &'a Class,
}

/// What a parameter that takes another object holds: a `MaterialRef`, a `PhaseRef` or a
/// `ShapeRef`.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Handle {
    behaviour: *const u8,
    at: *const u8,
}

macro_rules! views {
    ($($(#[$doc:meta])* $name:ident: $kind:ident),* $(,)?) => { $(
        $(#[$doc])*
        ///
        /// # Panics
        /// If the object is of another kind: the builder has checked it.
        pub fn $name(self) -> &'a (dyn $kind + 'a) {
            let View::$kind(view) = self.class.view else { panic!("an object of another kind") };
            // SAFETY: `at` is a valid struct of the class that this view belongs to, for 'a.
            unsafe { view(self.at, PhantomData) }
        }
    )* };
}

impl<'a> Resolved<'a> {
    views! {
        /// As a shape.
        shape: Shape,
        /// As a material.
        material: Material,
        /// As a texture.
        texture: Texture,
        /// As a light.
        light: Light,
        /// As a medium.
        medium: Medium,
        /// As a phase function.
        phase: Phase,
        /// As a camera.
        camera: Camera,
        /// As a sampler.
        sampler: Sampler,
        /// As a filter.
        filter: Filter,
        /// As an integrator.
        integrator: Integrator,
        /// As an importer.
        importer: Importer,
    }

    /// As a parameter of another object.
    pub(super) fn handle(self) -> Handle {
        Handle { behaviour: self.class.table.behaviour, at: self.at }
    }
}

impl Object {
    /// Its parameters where nothing varies: those that are written in the scene. Varying fields
    /// hold their defaults.
    pub fn fixed(&self) -> Resolved<'_> {
        Resolved { at: self.template.address(), class: &self.class }
    }

    /// Its parameters at a point.
    pub fn resolve<'a>(&'a self, at: &Site<'_>, scratch: &'a Scratch) -> Resolved<'a> {
        if self.patches.is_empty() {
            return self.fixed();
        }
        self.resolve_varying(at, scratch)
    }

    #[inline(never)]
    fn resolve_varying<'a>(&'a self, at: &Site<'_>, scratch: &'a Scratch) -> Resolved<'a> {
        let write = self.fill(at, scratch);
        self.prepared(write)
    }

    /// Its parameters at a point, where what lies around the shape has the index of refraction
    /// `around`: its own indices are told relative to that.
    #[inline(never)]
    pub fn resolve_within<'a>(
        &'a self,
        at: &Site<'_>,
        scratch: &'a Scratch,
        around: Spectrum,
    ) -> Resolved<'a> {
        let write = self.fill(at, scratch);
        for param in self.indices() {
            match param.ty {
                Type::Spectrum => write.change(param.offset, |ior: Spectrum| ior / around),
                Type::ComplexIor => write.change(param.offset, |ior: ComplexIor| ComplexIor {
                    eta: ior.eta / around,
                    k: ior.k / around,
                }),
                _ => write.change(param.offset, |ior: f32| ior / around.lane(0)),
            }
        }
        self.prepared(write)
    }

    /// Its index of refraction at a point, if it lets light in.
    pub fn index(&self, at: &Site<'_>, scratch: &Scratch) -> Option<Spectrum> {
        let param = self.indices().find(|param| param.role == Role::Ior)?;
        let write = self.fill(at, scratch);
        Some(match param.ty {
            Type::Spectrum => write.get(param.offset),
            _ => Spectrum::splat(write.get(param.offset)),
        })
    }

    /// Whether it is a material that lets light in, and bends it.
    pub fn bends(&self) -> bool {
        self.indices().any(|param| param.role == Role::Ior)
    }

    /// Whether it is a material to which it matters what lies around a shape.
    pub fn has_index(&self) -> bool {
        self.indices().next().is_some()
    }

    /// A material's own parameters that count relative to what lies around a shape.
    fn indices(&self) -> impl Iterator<Item = &Param> {
        let is_material = self.class.kind == Kind::Material;
        let is_index = |param: &&Param| matches!(param.role, Role::Ior | Role::ComplexIor);
        self.class.params.iter().filter(move |_| is_material).filter(is_index)
    }

    /// A copy of its parameters with those that vary filled in, not prepared yet.
    fn fill(&self, at: &Site<'_>, scratch: &Scratch) -> Writer {
        let base = scratch.copy(self.template.chunks());
        let write = Writer { base, size: self.class.size };
        if Feature::Spectral.is_compiled() {
            self.fill_curves(write, at.palette);
            self.fill_colours(write, at.palette);
        }
        for patch in &self.patches.textures {
            fill_texture(write, patch, at, scratch);
        }
        for patch in &self.patches.children {
            let child = patch.child.resolve(at, scratch);
            write.put(patch.offset, child.handle());
        }
        write
    }

    /// The filled copy, its derived fields computed.
    fn prepared(&self, Writer { base, .. }: Writer) -> Resolved<'_> {
        if let Some(prepare) = self.class.prepare {
            // SAFETY: `base` is a valid struct of this class that no one else refers to.
            unsafe { prepare(base) };
        }
        Resolved { at: base, class: &self.class }
    }

    #[inline(never)]
    fn fill_curves(&self, write: Writer, palette: &Palette) {
        for patch in &self.patches.curves {
            write.put(patch.offset, palette.curve(&patch.curve));
        }
    }

    #[inline(never)]
    fn fill_colours(&self, write: Writer, palette: &Palette) {
        for patch in &self.patches.colours {
            write.put(patch.offset, patch.uplift.lanes(patch.rgb, palette));
        }
    }
}

/// A struct that is being filled.
#[derive(Clone, Copy)]
struct Writer {
    base: *mut u8,
    size: usize,
}

impl Writer {
    fn put<T: Copy>(self, offset: usize, value: T) {
        assert!(offset + size_of::<T>() <= self.size, "a field outside its struct");
        // SAFETY: inside the struct, as just asserted.
        let at = unsafe { self.base.add(offset) };
        // SAFETY: the schema says that a `T` stands there; no one else refers to the struct.
        unsafe { at.cast::<T>().write_unaligned(value) }
    }

    fn get<T: Copy>(self, offset: usize) -> T {
        assert!(offset + size_of::<T>() <= self.size, "a field outside its struct");
        // SAFETY: inside the struct, as just asserted.
        let at = unsafe { self.base.add(offset) };
        // SAFETY: the schema says that a `T` stands there, and the copy is filled.
        unsafe { at.cast::<T>().read_unaligned() }
    }

    fn change<T: Copy>(self, offset: usize, change: impl Fn(T) -> T) {
        self.put(offset, change(self.get(offset)));
    }
}

#[inline(never)]
fn fill_texture(write: Writer, patch: &TexturePatch, at: &Site<'_>, scratch: &Scratch) {
    let point = TexturePoint { p: at.p, uv: at.uv, lambda: at.palette.wavelengths };
    let value = match at.color {
        Some(color) if patch.output == Output::Corners => Spectrum::from_rgb(color),
        _ => patch.texture.resolve(at, scratch).texture().eval(&point),
    };
    let lanes = match (patch.output, patch.target) {
        (_, Target::Luminance(weights)) => Spectrum::splat(luminance(value.rgb(), weights)),
        (Output::Rgb | Output::Corners, _) => patch.uplift.lanes(value.rgb(), at.palette),
        (Output::Value, _) => value,
    };
    let lanes: Spectrum = (lanes * patch.factor).clamp(patch.range[0], patch.range[1]);
    match patch.target {
        Target::Float | Target::Luminance(_) => write.put(patch.offset, lanes.lane(0)),
        Target::Vec3 => write.put(patch.offset, lanes.rgb()),
        Target::Spectrum => write.put(patch.offset, lanes),
    }
}

/// A weighted mean: of three equal numbers exactly that number.
fn luminance(rgb: Vec3, weights: Vec3) -> f32 {
    rgb.y + weights.x * (rgb.x - rgb.y) + weights.z * (rgb.z - rgb.y)
}

impl Object {
    /// The class's rules between parameters.
    pub(super) fn run_check(&self) -> Result<(), Fault> {
        // SAFETY: the template is a valid struct of this class: every field has been written.
        unsafe { (self.class.check)(self.template.address()) }
    }

    /// Computes the derived fields of the template.
    pub(super) fn prepare(&mut self) {
        if let Some(prepare) = self.class.prepare {
            // SAFETY: as above, and `&mut self` says that no one else refers to it.
            unsafe { prepare(self.template.address_mut()) };
        }
    }

    /// Builds the shared table, if the class has one.
    pub(super) fn build_shared(&mut self, context: &dyn BuildContext) -> Result<(), Vec<Fault>> {
        let Some(shared) = self.class.shared else { return Ok(()) };
        // SAFETY: the template is a valid struct of this class.
        let table = unsafe { (shared.build)(self.template.address(), context) }?;
        self.template.write_raw(shared.offset, table.address);
        // Boxed still: an `Arc` made from the box would move the table away from its address.
        self.owned.push(Arc::new(table.owner));
        Ok(())
    }
}
