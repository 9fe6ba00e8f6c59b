use luxel_sdk::Params;

#[derive(Clone)]
struct Handle(u32);

impl Drop for Handle {
    fn drop(&mut self) {}
}

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ E0204
struct Surface {
    /// Does something when it ends.
    #[param(required)]
    //~ a parameter cannot be of type `Handle`
    //~ not a type that the host can write
    handle: Handle,
}

fn main() {}
