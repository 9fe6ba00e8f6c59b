//! Studies of three scenes, as they are told.

use std::path::Path;

use super::{Form, answer, luxel, told};
use crate::process::Luxel;

/// A scene, and the error that its settings are to reach.
pub(super) struct Study {
    scene: &'static str,
    target: &'static str,
}

pub(super) const STUDIES: [Study; 3] = [
    Study { scene: "cornell", target: "5%" },
    Study { scene: "shapes", target: "5%" },
    Study { scene: "caustic", target: "10%" },
];

/// What every study begins with.
///
/// # Errors
/// The program's words.
pub(super) fn calibration(program: &Luxel, root: &Path) -> Result<String, String> {
    let told = told(&mut luxel(program, root, &["study", "--calibrate"]))?;
    Ok(format!("```text\n{}\n```\n", told.trim_end()))
}

impl Study {
    /// Of its place in the document, and of its files.
    pub(super) fn name(&self) -> String {
        format!("study-{}", self.scene)
    }

    /// What the program tells, without what all studies begin with; its files are written to `images`.
    ///
    /// # Errors
    /// The program's words.
    pub(super) fn run(
        &self,
        program: &Luxel,
        root: &Path,
        images: &Path,
        form: Form,
    ) -> Result<String, String> {
        let scene = format!("scenes/{}.scene", self.scene);
        let out = images.join(self.name()).display().to_string();
        let time = form.pick("2min", "5s");
        let words = ["study", &scene, "--target", self.target, "--time", time, "-o", &out];
        // A missed target is an answer too.
        let told = answer(&mut luxel(program, root, &words), &[0, 3])?;
        let from = told.find("configuration ").ok_or("the study told no table")?;
        Ok(format!("```text\n{}\n```\n", told[from..].trim_end()))
    }
}
