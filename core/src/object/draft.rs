//! A template in the making: parameters written where the schema says, and what varies noted.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::color::{RgbSpace, Spectrum};
use luxel_sdk::kind::{Output, TextureRef};
use luxel_sdk::params::{File, Maybe, Param, Preset, Role, Table, Text, Type};

use super::asked::Asked;
use super::block::Block;
use super::colour::Lanes;
use super::part::OWN_BITS;
use super::patch::{ChildPatch, CurvePatch, Patches, RgbPatch, Target, TexturePatch, Uplift};
use super::{ColorMode, Object};
use crate::cast::{self, narrow, whole};
use crate::scene::Value;

/// A template in the making.
pub(super) struct Draft {
    pub(super) block: Block,
    pub(super) patches: Patches,
    pub(super) owned: Vec<Arc<dyn std::any::Any + Send + Sync>>,
    pub(super) parts: Vec<Arc<Object>>,
    pub(super) face_bits: u32,
    /// Whether a part is missing, with which something is wrong: it cannot be made.
    pub(super) lacks: bool,
    /// How colour is carried, and whether anything here depends on that.
    mode: ColorMode,
    pub(super) is_by_mode: bool,
}

impl Draft {
    /// Nothing yet, of so many bytes.
    pub(super) fn new(size: usize, mode: ColorMode) -> Self {
        Self {
            block: Block::zeroed(size),
            patches: Patches::default(),
            owned: vec![],
            parts: vec![],
            face_bits: OWN_BITS,
            lacks: false,
            mode,
            is_by_mode: false,
        }
    }

    /// How colour is carried: whoever asks depends on it.
    pub(super) fn mode(&mut self) -> ColorMode {
        self.is_by_mode = true;
        self.mode
    }

    pub(super) fn lanes(&mut self, offset: usize, lanes: Lanes) -> Result<(), String> {
        let finite = match &lanes {
            Lanes::Constant(value) => value.is_finite(),
            Lanes::Curve(curve) => curve.max().is_finite(),
            Lanes::Rgb(rgb, _) => rgb.is_finite(),
        };
        if !finite {
            return Err("a value beyond single precision".to_owned());
        }
        match lanes {
            Lanes::Constant(value) => self.block.write(offset, value),
            Lanes::Curve(curve) => self.patches.curves.push(CurvePatch { offset, curve }),
            Lanes::Rgb(rgb, uplift) => self.patches.colours.push(RgbPatch { offset, rgb, uplift }),
        }
        Ok(())
    }

    pub(super) fn child(&mut self, offset: usize, child: &Arc<Object>) {
        // A handle is never null: where the child varies, this one is replaced at each point.
        self.block.write_raw(offset, child.fixed().handle());
        self.parts.push(child.clone());
        if !child.is_constant() {
            self.patches.children.push(ChildPatch { offset, child: child.clone() });
        }
    }

    pub(super) fn asked(&mut self, offset: usize, texture: &Arc<Object>) {
        let asked = Arc::new(Asked::new(texture.clone()));
        self.block.write_raw(offset, TextureRef::new(&*asked));
        self.parts.push(texture.clone());
        self.owned.push(asked);
    }

    pub(super) fn texture(
        &mut self,
        param: &Param,
        texture: Arc<Object>,
        factor: f32,
    ) -> Result<(), String> {
        let output = texture.fixed().texture().output();
        let target = match param.ty {
            Type::Float if output != Output::Value => {
                Target::Luminance(RgbSpace::LinearSrgb.luminance_weights().as_vec3())
            }
            Type::Float => Target::Float,
            Type::Vec3 => Target::Vec3,
            Type::Spectrum | Type::Emission | Type::ComplexIor => Target::Spectrum,
            _ => return Err(format!("`{}` cannot be textured", param.name)),
        };
        let uplift = match target {
            Target::Float | Target::Luminance(_) | Target::Vec3 => Uplift::None,
            Target::Spectrum => match (self.mode(), param.role) {
                (ColorMode::Rgb, _) => Uplift::None,
                (_, Role::Illuminant) => Uplift::Illuminant,
                _ => Uplift::Reflectance,
            },
        };
        self.parts.push(texture.clone());
        self.patches.textures.push(TexturePatch {
            offset: param.offset,
            output,
            texture,
            uplift,
            factor,
            range: [narrow(param.min), narrow(param.max)],
            target,
        });
        Ok(())
    }

    pub(super) fn value(&mut self, param: &Param, value: &Value) -> Result<(), String> {
        let at = param.offset;
        match (param.ty, value) {
            (Type::Float | Type::MaybeFloat, Value::Number(x, _)) if narrow(*x).is_infinite() => {
                return Err(format!("`{}` = {x:e} is beyond single precision", param.name));
            }
            (Type::Float, Value::Number(x, _)) => self.block.write(at, narrow(*x)),
            (Type::Double, Value::Number(x, _)) => self.block.write(at, *x),
            (Type::Int, Value::Number(x, _)) => self.block.write(at, whole(*x)),
            (Type::Bool, Value::Bool(b)) => self.block.write(at, *b),
            (Type::MaybeFloat, Value::Number(x, _)) => {
                self.block.write(at, Maybe { given: true, value: narrow(*x) });
            }
            (Type::Spectrum | Type::ComplexIor, Value::Number(x, _)) => {
                self.block.write(at, Spectrum::splat(narrow(*x)));
            }
            (Type::Vec2 | Type::Vec3 | Type::DVec3, Value::Vector(v)) => self.vector(param, v),
            (Type::Choice, Value::Text(word)) => {
                let index = param.words().position(|choice| choice == &**word);
                let index = index.ok_or_else(|| format!("`{word}` is not among the choices"))?;
                self.block.write_raw(at, cast::index(index));
            }
            (Type::Text, Value::Text(text)) => {
                self.block.write_raw(at, Text::new(text));
                self.owned.push(Arc::new(text.clone()));
            }
            (Type::File, Value::Path(path)) => self.file(at, path.to_string_lossy().into()),
            (Type::File, Value::Bytes(name, _)) => self.file(at, name.clone()),
            (Type::Table, Value::Table(table)) => {
                self.block.write_raw(at, Table::new(table));
                self.owned.push(Arc::new(table.clone()));
            }
            (Type::Look, Value::Look(look)) => self.block.write(at, **look),
            _ => return Err(format!("`{}` has a value of the wrong type", param.name)),
        }
        Ok(())
    }

    pub(super) fn file(&mut self, offset: usize, path: Arc<str>) {
        self.block.write_raw(offset, File { path: Text::new(&path) });
        self.owned.push(Arc::new(path));
    }

    pub(super) fn vector(&mut self, param: &Param, v: &[f64]) {
        let get = |i: usize| v.get(i).copied().unwrap_or(0.0);
        let v = DVec3::new(get(0), get(1), get(2));
        match param.ty {
            Type::Vec2 => self.block.write::<Vec2>(param.offset, v.truncate().as_vec2()),
            Type::Vec3 => self.block.write::<Vec3>(param.offset, v.as_vec3()),
            _ => self.block.write(param.offset, v),
        }
    }

    pub(super) fn preset(&mut self, param: &Param) {
        let at = param.offset;
        match (param.default, param.ty) {
            (Preset::Numbers(n), Type::Float) => self.block.write(at, narrow(n[0])),
            (Preset::Numbers(n), Type::Double) => self.block.write(at, n[0]),
            (Preset::Numbers(n), Type::Int) => self.block.write(at, whole(n[0])),
            (Preset::Numbers(n), Type::Bool) => self.block.write(at, n[0] > 0.5),
            (Preset::Numbers(n), Type::Vec2 | Type::Vec3 | Type::DVec3) => self.vector(param, &n),
            (Preset::Numbers(n), Type::Spectrum | Type::ComplexIor) => {
                self.block.write(at, Spectrum::splat(narrow(n[0])));
            }
            (Preset::Numbers(n), Type::MaybeFloat) => {
                self.block.write(at, Maybe { given: true, value: narrow(n[0]) });
            }
            (Preset::Index(index), Type::Choice) => self.block.write_raw(at, index),
            (Preset::Text(text), Type::Text) => self.block.write_raw(at, Text::new(text)),
            // Absent: zero bytes, which every optional type takes for nothing.
            _ => {}
        }
    }
}
