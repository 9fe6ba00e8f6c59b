use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface<'a> {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
    #[param(derived)]
    //~ a derived field cannot be of type `&'a str`
    //~ zero bytes are no value of it, as far as is known
    //~ derived fields are numbers, bool, vectors, matrices, Spectrum, and arrays of these
    name: &'a str,
}

fn main() {}
