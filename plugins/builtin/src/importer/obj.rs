//! A Wavefront OBJ file as an asset.

use glam::DAffine3;
use luxel_sdk::Params;
use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Importer, Kind};
use luxel_sdk::params::{BuildContext, Fault, File};

use crate::shape::up::Up;

/// An OBJ or PLY file, to be placed any number of times as one mesh.
///
/// Its material is that of the place or of the group around it; materials of the file are not read.
///
/// ```scene
/// let bust = asset obj { file = "assets/bust.obj", unit = 1 mm, up = "z" }
/// place bust { material = white, transform = [move((0, 1, 0) m)] }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Obj<'a> {
    /// The file.
    #[param(required)]
    file: File<'a>,
    /// Length of one unit of the file; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    unit: f64,
    /// Which axis of the file is up.
    #[param(choice, default = Up::Y)]
    up: Up,
}

impl Importer for Obj<'_> {
    fn check(&self) -> Result<(), Fault> {
        check_unit(self.unit)
    }

    fn import(&self, context: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        let path = self.file.path.get();
        let bytes = context.read(path).map_err(|message| vec![Fault::file("file", message)])?;
        let up = match self.up {
            Up::X => "x",
            Up::Y => "y",
            Up::Z => "z",
        };
        let params = vec![
            ("file".into(), ImportValue::Bytes(path.to_owned(), bytes)),
            ("unit".into(), ImportValue::Number(self.unit)),
            ("up".into(), ImportValue::Text(up.to_owned())),
        ];
        let (kind, class, label) = (Kind::Shape, "mesh".to_owned(), String::new());
        Ok(Imported {
            nodes: vec![ImportNode { kind, class, label, params }],
            placed: vec![(0, DAffine3::IDENTITY)],
            warnings: vec![],
        })
    }
}

/// Refuses a file whose unit is not a length.
pub(super) fn check_unit(unit: f64) -> Result<(), Fault> {
    if unit > 0.0 {
        return Ok(());
    }
    let message = format!("a unit of {unit} m: state the length of one unit of the file");
    Err(Fault { field: "unit", code: "E0415", message })
}
