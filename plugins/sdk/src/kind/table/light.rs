use glam::{DVec3, Vec2};

use super::table;
use crate::color::Spectrum;
use crate::kind::{Escaped, Light, LightQuery, LightSample};

table! {
    /// A source of light, in its own frame.
    Light => LightTable "luxel_light_table" {
        /// What form of source it is: 0 a shape's surface, 1 a point, 2 far away.
        fn form(light) -> u32 { Some(light.form() as u32) }
        /// Radiance that leaves a shining surface of `area` m² (world) at cosine `cos_o`.
        fn le(light, cos_o: f32, uv: &Vec2, area: f64) -> Spectrum {
            Some(light.le(cos_o, *uv, area))
        }
        /// Light that may reach a point.
        fn sample(light, query: &LightQuery) -> LightSample { light.sample(query) }
        /// What a ray that leaves the scene along `d` finds.
        fn escaped(light, d: &DVec3) -> Escaped { Some(light.escaped(*d)) }
        /// About how much power it gives, W.
        fn power(light, area: f64, scene_radius: f64) -> f32 {
            Some(light.power(area, scene_radius))
        }
        /// What the lanes of its radiance mean: 0 values as they are, 1 linear sRGB.
        fn output(light) -> u32 { Some(light.output() as u32) }
    }
}
