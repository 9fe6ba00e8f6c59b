//! An importer, to be made your own.

use glam::DAffine3;
use luxel_sdk::Params;
use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Importer, Kind};
use luxel_sdk::params::{BuildContext, Fault, File};

/// Balls from a text file: a line for each with x, y, z and radius. Empty lines, and lines that begin
/// with `#`, do not count.
///
/// ```scene
/// let balls = asset template_name { file = "balls.txt", unit = 1 cm }
/// place balls {}
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName<'a> {
    /// The file.
    #[param(required)]
    file: File<'a>,
    /// Length of one unit of the file; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    unit: f64,
}

/// Faults that are told at once.
const MAX_FAULTS: usize = 20;

impl Importer for TemplateName<'_> {
    fn check(&self) -> Result<(), Fault> {
        if self.unit > 0.0 {
            return Ok(());
        }
        Err(Fault::range("unit", format!("a unit of {} m is no length", self.unit)))
    }

    /// Tells everything that is wrong with the file, and never panics on what it holds.
    fn import(&self, context: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        let wrong = |message: String| Fault::file("file", message);
        let bytes = context.read(self.file.path.get()).map_err(|why| vec![wrong(why)])?;
        let text = String::from_utf8_lossy(&bytes);
        let (mut nodes, mut faults) = (vec![], vec![]);
        for (i, line) in text.lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            match ball(line, self.unit) {
                Ok(node) => nodes.push(node),
                Err(why) if faults.len() < MAX_FAULTS => {
                    faults.push(wrong(format!("line {}: {why}", i + 1)));
                }
                Err(_) => break,
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let placed = (0..nodes.len()).map(|i| (i, DAffine3::IDENTITY)).collect();
        Ok(Imported { nodes, placed, warnings: vec![] })
    }
}

/// The ball that a line describes.
fn ball(line: &str, unit: f64) -> Result<ImportNode, String> {
    let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
    let Ok(&[x, y, z, radius]) = numbers.as_deref() else {
        return Err(format!("four numbers are wanted, found `{line}`"));
    };
    let size = radius * unit;
    if !(size > 0.0 && [x, y, z, size].iter().all(|number| (number * unit).is_finite())) {
        return Err(format!("a radius above 0 and finite numbers are wanted, found `{line}`"));
    }
    let center = vec![x * unit, y * unit, z * unit];
    Ok(ImportNode {
        kind: Kind::Shape,
        class: "sphere".into(),
        label: String::new(),
        params: vec![
            ("center".into(), ImportValue::Vector(center)),
            ("radius".into(), ImportValue::Number(size)),
        ],
    })
}

luxel_sdk::plugin! { importer "template_name" => TemplateName<'static>; }
