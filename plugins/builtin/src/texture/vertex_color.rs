//! Colours that a mesh brings along.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Output, Texture, TexturePoint};

/// The colours that the corners of a mesh have, interpolated over its triangles.
///
/// They are the mesh's `colors`, a PLY file's `red green blue` (whole numbers in sRGB, others linear)
/// or the three numbers behind each point of an OBJ file (sRGB, as programs write them).
///
/// ```scene
/// let painted = material diffuse { reflectance = texture vertex_color {} }
/// shape mesh "leaf" {
///   points = #[ 0 0 0  1 0 0  0 1 0 ] cm, indices = #[ 0 1 2 ]
///   colors = #[ 0.1 0.4 0.1  0.2 0.5 0.1  0.5 0.4 0.1 ], material = painted
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct VertexColor {
    /// The value where a surface has no colours of its own, in a light and in `displace`.
    #[param(default = 0.5, min = 0, max = 1)]
    otherwise: f32,
}

impl Texture for VertexColor {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        Spectrum::splat(self.otherwise)
    }

    fn output(&self) -> Output {
        Output::Corners
    }
}
