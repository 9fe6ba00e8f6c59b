//! Cameras and punctual lights, as they stand in their own frames.

use glam::DVec3;
use gltf::json::Index;
use gltf::json::camera::Camera;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf::json::validation::Checked;
use luxel_sdk::kind::{ImportValue, Kind};
use luxel_sdk::params::Look;

use super::{Builder, rgb, vector};

/// Cameras and lights look along −Z.
const LOOK: ImportValue =
    ImportValue::Look(Look { from: DVec3::ZERO, to: DVec3::NEG_Z, up: DVec3::Y });

impl Builder<'_> {
    /// A camera's node.
    pub(super) fn camera(&mut self, index: Index<Camera>) -> Result<usize, String> {
        let i = index.value();
        let source = self.source;
        let camera = source.root.get(index).ok_or_else(|| format!("there is no cameras[{i}]"))?;
        let name = camera.name.as_deref().unwrap_or("");
        let (class, param, x) = match (&camera.perspective, &camera.orthographic) {
            (Some(p), _) => ("perspective", "fov", f64::from(p.yfov)),
            (None, Some(o)) => ("orthographic", "height", 2.0 * f64::from(o.ymag) * self.unit),
            (None, None) => {
                return Err(format!("cameras[{i}] is neither perspective nor orthographic"));
            }
        };
        if !(x > 0.0 && x.is_finite()) {
            return Err(format!("cameras[{i}]: a {param} of {x}"));
        }
        let params = vec![("look", LOOK), (param, ImportValue::Number(x))];
        Ok(self.add(Kind::Camera, class, name, params))
    }

    /// A light's node; `None` for one that is switched off.
    ///
    /// The amount is photometric and comes before the colour: what arrives is their product.
    pub(super) fn light(&mut self, index: Index<Light>) -> Result<Option<usize>, String> {
        let i = index.value();
        let source = self.source;
        let light = source.root.get(index).ok_or_else(|| format!("there is no lights[{i}]"))?;
        let name = light.name.as_deref().unwrap_or("");
        // Luminance of linear sRGB, as the amount given to the scene counts the colour in.
        let [r, g, b] = light.color.map(f64::from);
        let amount = f64::from(light.intensity) * (0.2126 * r + 0.7152 * g + 0.0722 * b);
        if !amount.is_finite() || light.intensity < 0.0 {
            return Err(format!("lights[{i}]: an intensity of {}", light.intensity));
        }
        if amount <= 0.0 {
            return Ok(None);
        }
        let candela = ("intensity", ImportValue::Quantity(amount, "cd".into()));
        let mut params = vec![("spectrum", rgb(light.color))];
        let class = match light.type_ {
            Checked::Valid(Type::Point) => {
                params.extend([candela, ("position", vector(DVec3::ZERO))]);
                "point"
            }
            Checked::Valid(Type::Spot) => {
                let spot = light.spot.as_ref();
                let spot = spot.ok_or_else(|| format!("lights[{i}]: a spot without `spot`"))?;
                let [inner, outer] = [spot.inner_cone_angle, spot.outer_cone_angle].map(f64::from);
                let half_turn = std::f64::consts::FRAC_PI_2;
                if !(inner >= 0.0 && inner < outer && outer <= half_turn) {
                    return Err(format!("lights[{i}]: cone angles {inner} and {outer}"));
                }
                let cone = ImportValue::Number(outer);
                let falloff = ImportValue::Number(outer - inner);
                params.extend([candela, ("look", LOOK), ("cone", cone), ("falloff", falloff)]);
                "spot"
            }
            Checked::Valid(Type::Directional) => {
                let lux = ImportValue::Quantity(amount, "lx".into());
                params.extend([("illuminance", lux), ("direction", vector(DVec3::NEG_Z))]);
                "directional"
            }
            Checked::Invalid => return Err(format!("lights[{i}]: an unknown type")),
        };
        Ok(Some(self.add(Kind::Light, class, name, params)))
    }
}
