//! Materials and their textures.

use std::collections::HashMap;

use gltf::json::Index;
use gltf::json::material::{AlphaMode, Material};
use gltf::json::texture::{Info, MagFilter, Sampler, Texture, WrappingMode};
use gltf::json::validation::Checked;
use luxel_sdk::kind::{ImportValue, Kind};

use super::{Builder, rgb};

/// What a material emits.
#[derive(Clone)]
pub(super) struct Emission {
    /// Colour, or a texture of it.
    pub(super) spectrum: ImportValue,
    /// Factor on it.
    pub(super) strength: f64,
}

/// A material as its primitives need it.
#[derive(Clone)]
pub(super) struct Made {
    /// Its node.
    pub(super) node: usize,
    /// Which set of coordinates its textures use.
    pub(super) uv_set: u32,
    /// What it emits, if it does.
    pub(super) emission: Option<Emission>,
    /// Whether it shines to both sides.
    pub(super) double_sided: bool,
}

/// What multiplies a material's base colour.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Paint {
    /// Nothing.
    Plain,
    /// The colours of the mesh's corners.
    Corners,
}

/// What has been made of the file's materials.
#[derive(Default)]
pub(super) struct Materials {
    made: HashMap<(Option<usize>, Paint), Made>,
    images: HashMap<(usize, &'static str, &'static str, [u32; 4]), usize>,
}

/// What is read of a picture.
#[derive(Clone, Copy)]
struct Channel {
    space: &'static str,
    channel: &'static str,
}

const COLOUR: Channel = Channel { space: "srgb", channel: "rgb" };
const ALPHA: Channel = Channel { space: "srgb", channel: "a" };
const ROUGHNESS: Channel = Channel { space: "raw", channel: "g" };
const METALLIC: Channel = Channel { space: "raw", channel: "b" };

impl Builder<'_> {
    /// A material, or that of primitives without one; made once for each paint.
    pub(super) fn material(
        &mut self,
        index: Option<Index<Material>>,
        paint: Paint,
    ) -> Result<Made, String> {
        let key = (index.map(|index| index.value()), paint);
        if let Some(made) = self.materials.made.get(&key) {
            return Ok(made.clone());
        }
        let source = self.source;
        let plain = Material::default();
        let material = match index {
            Some(index) => {
                let found = source.root.get(index);
                found.ok_or_else(|| format!("there is no materials[{}]", index.value()))?
            }
            None => &plain,
        };
        let made = self.make_material(material, paint)?;
        self.materials.made.insert(key, made.clone());
        Ok(made)
    }

    fn make_material(&mut self, material: &Material, paint: Paint) -> Result<Made, String> {
        let name = material.name.as_deref().unwrap_or("");
        let pbr = &material.pbr_metallic_roughness;
        let [r, g, b, a] = pbr.base_color_factor.0;
        let base = pbr.base_color_texture.as_ref();
        let both = pbr.metallic_roughness_texture.as_ref();
        let (metallic, roughness) = (pbr.metallic_factor.0, pbr.roughness_factor.0);
        let base_color = self.textured(base, COLOUR, [r, g, b])?;
        let mut params = vec![
            ("base_color", self.painted(base_color, paint)),
            ("metallic", self.textured_number(both, METALLIC, metallic)?),
            ("roughness", self.textured_number(both, ROUGHNESS, roughness)?),
        ];
        let mode = match material.alpha_mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err("a material with an unknown alphaMode".to_owned()),
        };
        if mode != AlphaMode::Opaque {
            params.push(("alpha", self.textured_number(base, ALPHA, a)?));
        }
        if mode == AlphaMode::Mask {
            let cutoff = material.alpha_cutoff.unwrap_or_default().0;
            params.push(("alpha_cutoff", ImportValue::Number(unit(cutoff))));
        }
        if material.normal_texture.is_some() {
            self.warn(format!("material `{name}`: its normal map is not supported"));
        }
        let emission = self.emission(material)?;
        let infos = [base, both, material.emissive_texture.as_ref()];
        let mut sets = infos.into_iter().flatten().map(uv_set);
        let uv_set = sets.next().unwrap_or(0);
        if sets.any(|set| set != uv_set) {
            let which = format!("TEXCOORD_{uv_set} is used for all of its textures");
            self.warn(format!("material `{name}`: {which}"));
        }
        let node = self.add(Kind::Material, "metallic_roughness", name, params);
        Ok(Made { node, uv_set, emission, double_sided: material.double_sided })
    }

    fn emission(&mut self, material: &Material) -> Result<Option<Emission>, String> {
        let factor = material.emissive_factor.0;
        let extension = material.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = extension.map_or(1.0, |e| f64::from(e.emissive_strength.0));
        let shines = factor.iter().any(|x| *x > 0.0) && strength > 0.0 && strength.is_finite();
        if !shines {
            return Ok(None);
        }
        let spectrum = self.textured(material.emissive_texture.as_ref(), COLOUR, factor)?;
        Ok(Some(Emission { spectrum, strength }))
    }

    /// A colour, or a texture times a colour.
    fn textured(
        &mut self,
        info: Option<&Info>,
        channel: Channel,
        factor: [f32; 3],
    ) -> Result<ImportValue, String> {
        let Some(info) = info else { return Ok(rgb(factor)) };
        let image = self.image(info, channel)?;
        let plain = factor.iter().all(|x| *x >= 1.0);
        Ok(ImportValue::Node(if plain { image } else { self.scaled(image, rgb(factor)) }))
    }

    /// A colour times that of the corners (glTF 2.0 §3.9.2).
    fn painted(&mut self, color: ImportValue, paint: Paint) -> ImportValue {
        if paint == Paint::Plain {
            return color;
        }
        let corners = self.add(Kind::Texture, "vertex_color", "", vec![]);
        ImportValue::Node(self.scaled(corners, color))
    }

    /// A number in [0, 1], or a channel of a texture times it.
    fn textured_number(
        &mut self,
        info: Option<&Info>,
        channel: Channel,
        factor: f32,
    ) -> Result<ImportValue, String> {
        let number = ImportValue::Number(unit(factor));
        let Some(info) = info else { return Ok(number) };
        let image = self.image(info, channel)?;
        Ok(ImportValue::Node(if factor >= 1.0 { image } else { self.scaled(image, number) }))
    }

    fn scaled(&mut self, image: usize, factor: ImportValue) -> usize {
        let params = vec![("value", ImportValue::Node(image)), ("factor", factor)];
        self.add(Kind::Texture, "scale", "", params)
    }

    /// A texture node; one for each picture, channel and transform.
    fn image(&mut self, info: &Info, channel: Channel) -> Result<usize, String> {
        let i = info.index.value();
        let Channel { space, channel } = channel;
        let key = (i, space, channel, transform(info).map(f32::to_bits));
        if let Some(made) = self.materials.images.get(&key) {
            return Ok(*made);
        }
        let source = self.source;
        let texture = source.root.get(info.index);
        let texture = texture.ok_or_else(|| format!("there is no textures[{i}]"))?;
        let (name, bytes) = source.image(texture.source)?;
        let text = |word: &str| ImportValue::Text(word.to_owned());
        let mut params = vec![
            ("file", ImportValue::Bytes(name, bytes)),
            ("space", text(space)),
            ("channel", text(channel)),
        ];
        for (param, word) in self.sampler(texture, i)? {
            params.push((param, text(word)));
        }
        let [sx, sy, ox, oy] = transform(info).map(f64::from);
        if transform(info).map(f32::to_bits) != [1.0, 1.0, 0.0, 0.0].map(f32::to_bits) {
            params.push(("scale", ImportValue::Vector(vec![sx, sy])));
            // Rows count from the top there: v' = 1 − (oy + sy (1 − v)).
            params.push(("offset", ImportValue::Vector(vec![ox, 1.0 - oy - sy])));
        }
        let rotation = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        if rotation.is_some_and(|t| t.rotation.0 != 0.0) {
            self.warn(format!("textures[{i}]: its rotation is not supported"));
        }
        let node = self.add(Kind::Texture, "image", "", params);
        self.materials.images.insert(key, node);
        Ok(node)
    }

    /// How a texture goes on beyond its edges and between its pixels, where not as usual.
    fn sampler(
        &mut self,
        texture: &Texture,
        i: usize,
    ) -> Result<Vec<(&'static str, &'static str)>, String> {
        let source = self.source;
        let Some(index) = texture.sampler else { return Ok(vec![]) };
        let sampler: &Sampler =
            source.root.get(index).ok_or_else(|| format!("textures[{i}]: no such sampler"))?;
        let mut out = vec![];
        let wrap = |w: &Checked<WrappingMode>| match w {
            Checked::Valid(WrappingMode::ClampToEdge) => "clamp",
            Checked::Valid(WrappingMode::MirroredRepeat) => "mirror",
            _ => "repeat",
        };
        let (s, t) = (wrap(&sampler.wrap_s), wrap(&sampler.wrap_t));
        if s != t {
            self.warn(format!("textures[{i}]: `{s}` is used both ways, though one is `{t}`"));
        }
        if s != "repeat" {
            out.push(("wrap", s));
        }
        if sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)) {
            out.push(("filter", "nearest"));
        }
        Ok(out)
    }
}

fn uv_set(info: &Info) -> u32 {
    let moved = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    moved.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord)
}

/// Scale and offset of the coordinates.
fn transform(info: &Info) -> [f32; 4] {
    let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    transform.map_or([1.0, 1.0, 0.0, 0.0], |t| {
        let ([sx, sy], [ox, oy]) = (t.scale.0, t.offset.0);
        [sx, sy, ox, oy]
    })
}

/// A factor kept to [0, 1]; NaN counts as 0.
fn unit(x: f32) -> f64 {
    if x.is_nan() { 0.0 } else { f64::from(x).clamp(0.0, 1.0) }
}
