use luxel_sdk::Params;

/// A surface.
#[derive(Params)]
#[repr(C)]
struct Surface {
    /// May be absent.
    #[param(optional)]
    option: Option<f32>,
    /// Owns memory.
    #[param(default = "")]
    string: String,
    /// Owns memory.
    #[param(default = 0.5)]
    boxed: Box<f32>,
    /// Changes.
    #[param(default = 0.5)]
    cell: std::cell::Cell<f32>,
    /// Owns memory.
    #[param(optional)]
    list: Vec<f64>,
}

fn main() {}
