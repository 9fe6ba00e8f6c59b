use luxel_sdk::Params;

/// A surface.
#[derive(Params)]
#[repr(C)]
struct Surface {
    /// May be absent.
    #[param(optional)]
    //~ a parameter cannot be of type `Option`: use Maybe<f32>
    option: Option<f32>,
    /// Owns memory.
    #[param(default = "")]
    //~ a parameter cannot be of type `String`: use Text<'a>
    string: String,
    /// Owns memory.
    #[param(default = 0.5)]
    //~ a parameter cannot be of type `Box`: use Table<'a> for numbers, a `shared` table for what is built
    boxed: Box<f32>,
    /// Changes.
    #[param(default = 0.5)]
    //~ a parameter cannot be of type `Cell`: parameters do not change while a scene is rendered
    cell: std::cell::Cell<f32>,
    /// Owns memory.
    #[param(optional)]
    //~ a parameter cannot be of type `Vec`: use Table<'a> for numbers, a `shared` table for what is built
    list: Vec<f64>,
}

fn main() {}
