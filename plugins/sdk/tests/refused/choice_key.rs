use luxel_sdk::{Choice, Params};

/// Which axis.
#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum Axis {
    /// Along x.
    X,
}

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Without the key.
    #[param(required)]
    //~ `axis` is a choice: it needs the key `choice`
    axis: Axis,
}

fn main() {}
