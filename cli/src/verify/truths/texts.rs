//! The texts of the truths.

use luxel_core::files::MemoryFiles;

/// Cases that are tested on whole pictures.
pub(super) const LIST: &str = include_str!("truths.txt");

/// Measured reflectances of a colour chart.
const CHART: &str = include_str!("colour/colorchecker_n_ohta.csv");

const SCENES: [(&str, &str); 42] = [
    ("absorbing.scene", include_str!("absorbing.scene")),
    ("ball_disk.scene", include_str!("ball_disk.scene")),
    ("beer.scene", include_str!("beer.scene")),
    ("checker.scene", include_str!("checker.scene")),
    ("coat.scene", include_str!("coat.scene")),
    ("cos4.scene", include_str!("cos4.scene")),
    ("discs.scene", include_str!("discs.scene")),
    ("edge.scene", include_str!("edge.scene")),
    ("filter.scene", include_str!("filter.scene")),
    ("flux_disc.scene", include_str!("flux_disc.scene")),
    ("furnace_closed.scene", include_str!("furnace_closed.scene")),
    ("furnace_convex.scene", include_str!("furnace_convex.scene")),
    ("glowing.scene", include_str!("glowing.scene")),
    ("half_disk.scene", include_str!("half_disk.scene")),
    ("half_moon.scene", include_str!("half_moon.scene")),
    ("halfspace.scene", include_str!("halfspace.scene")),
    ("intsphere.scene", include_str!("intsphere.scene")),
    ("lens.scene", include_str!("lens.scene")),
    ("media_furnace.scene", include_str!("media_furnace.scene")),
    ("media_outside.scene", include_str!("media_outside.scene")),
    ("opening.scene", include_str!("opening.scene")),
    ("plates.scene", include_str!("plates.scene")),
    ("port.scene", include_str!("port.scene")),
    ("prism.scene", include_str!("prism.scene")),
    ("radiance_n2.scene", include_str!("radiance_n2.scene")),
    ("rainbow.scene", include_str!("rainbow.scene")),
    ("receiver.scene", include_str!("receiver.scene")),
    ("rects.scene", include_str!("rects.scene")),
    ("rects_square.scene", include_str!("rects_square.scene")),
    ("roof.scene", include_str!("roof.scene")),
    ("rough_albedo.scene", include_str!("rough_albedo.scene")),
    ("shadow_sphere.scene", include_str!("shadow_sphere.scene")),
    ("single_slab.scene", include_str!("single_slab.scene")),
    ("slab.scene", include_str!("slab.scene")),
    ("sphere_room.scene", include_str!("sphere_room.scene")),
    ("spherical_mirror.scene", include_str!("spherical_mirror.scene")),
    ("sun.scene", include_str!("sun.scene")),
    ("tilted.scene", include_str!("tilted.scene")),
    ("torus.scene", include_str!("torus.scene")),
    ("units.scene", include_str!("units.scene")),
    ("visible_sphere.scene", include_str!("visible_sphere.scene")),
    ("wheel.scene", include_str!("wheel.scene")),
];

/// Everything that a scene may read.
pub(super) fn files() -> MemoryFiles {
    let files = MemoryFiles::default().with("colour/colorchecker_n_ohta.csv", CHART.as_bytes());
    SCENES.iter().fold(files, |files, (name, text)| files.with(*name, text.as_bytes()))
}
