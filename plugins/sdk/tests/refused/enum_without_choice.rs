use luxel_sdk::Params;

#[derive(Clone, Copy)]
#[repr(u32)]
enum Axis {
    X,
    Y,
}

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Which axis.
    #[param(required)]
    //~ a parameter cannot be of type `Axis`
    //~ not a type that the host can write
    //~ parameters are f32, f64, u32, bool, Vec2, Vec3, DVec3, Spectrum, ComplexIor, Emission, Maybe<f32>, Text, File, Table, Look, MaterialRef, PhaseRef, ShapeRef, TextureRef, or derive `Choice`
    axis: Axis,
}

fn main() {}
