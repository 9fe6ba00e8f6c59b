//! The texts of the truths.

use luxel_core::files::MemoryFiles;

/// Cases that are tested on whole pictures.
pub(super) const LIST: &str = include_str!("truths.txt");

/// Measured reflectances of a colour chart.
pub(super) const CHART: &str = include_str!("colour/colorchecker_n_ohta.csv");

const SCENES: [(&str, &str); 21] = [
    ("absorbing.scene", include_str!("absorbing.scene")),
    ("beer.scene", include_str!("beer.scene")),
    ("checker.scene", include_str!("checker.scene")),
    ("cos4.scene", include_str!("cos4.scene")),
    ("discs.scene", include_str!("discs.scene")),
    ("edge.scene", include_str!("edge.scene")),
    ("furnace_closed.scene", include_str!("furnace_closed.scene")),
    ("furnace_convex.scene", include_str!("furnace_convex.scene")),
    ("intsphere.scene", include_str!("intsphere.scene")),
    ("media_furnace.scene", include_str!("media_furnace.scene")),
    ("media_outside.scene", include_str!("media_outside.scene")),
    ("radiance_n2.scene", include_str!("radiance_n2.scene")),
    ("receiver.scene", include_str!("receiver.scene")),
    ("rects.scene", include_str!("rects.scene")),
    ("roof.scene", include_str!("roof.scene")),
    ("single_slab.scene", include_str!("single_slab.scene")),
    ("slab.scene", include_str!("slab.scene")),
    ("tilted.scene", include_str!("tilted.scene")),
    ("units.scene", include_str!("units.scene")),
    ("visible_sphere.scene", include_str!("visible_sphere.scene")),
    ("wheel.scene", include_str!("wheel.scene")),
];

/// Everything that a scene may read.
pub(super) fn files() -> MemoryFiles {
    let files = MemoryFiles::default().with("colour/colorchecker_n_ohta.csv", CHART.as_bytes());
    SCENES.iter().fold(files, |files, (name, text)| files.with(*name, text.as_bytes()))
}
