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
    axis: Axis,
}

fn main() {}
