//! A scene of many placements, whose camera is edited.

use std::path::PathBuf;
use std::time::Instant;

use super::subject::{Way, put};
use crate::ply::grid;
use crate::process::scratch;

/// Rows and columns: 100,000 placements of a mesh of 2,048 triangles.
const PLACES: [u32; 2] = [250, 400];
const SIDE: u32 = 33;

/// The scene on the disk.
pub(super) struct Crowd {
    folder: PathBuf,
    edits: u32,
}

impl Crowd {
    /// Puts it into a folder of its own.
    ///
    /// # Errors
    /// The system's words.
    pub(super) fn new() -> Result<Self, String> {
        let folder = scratch()?.join("crowd");
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        put(&folder.join("small.ply"), &grid(SIDE), Way::InPlace)?;
        let mut crowd = Self { folder, edits: 0 };
        crowd.edit()?;
        Ok(crowd)
    }

    pub(super) fn scene(&self) -> PathBuf {
        self.folder.join("a.scene")
    }

    /// Moves the camera a little; the moment in which the save is done.
    ///
    /// # Errors
    /// The system's words.
    pub(super) fn edit(&mut self) -> Result<Instant, String> {
        self.edits += 1;
        let z = 30.0 + 0.01 * f64::from(self.edits % 50);
        let [rows, columns] = PLACES;
        let text = format!(
            "scene 1
camera perspective {{ look = look_at(from = (0, 20, {z}) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}
film rgb {{ resolution = (960, 540) }}
sampler sobol {{ samples = 4096 }}
light constant {{ radiance = 0.5 W/m^2/sr }}
let one = group {{ shape mesh {{ file = \"small.ply\", unit = 5 cm, material = material diffuse {{ reflectance = 0.5 }} }} }}
for i in 0..{rows} {{ for j in 0..{columns} {{ place one {{ transform = move((0.1 * j - 20, 0, 0.1 * i - 12) m) }} }} }}
"
        );
        put(&self.scene(), text.as_bytes(), Way::Renamed)
    }
}
