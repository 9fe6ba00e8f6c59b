use luxel_sdk::Params;

#[derive(Clone)]
struct Handle(u32);

impl Drop for Handle {
    fn drop(&mut self) {}
}

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Does something when it ends.
    #[param(required)]
    handle: Handle,
}

fn main() {}
