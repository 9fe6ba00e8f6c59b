//! The built-ins as one dynamic library: the same sources, the same pictures.

use glam::UVec2;
use luxel_core::film::Pixel;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_core::stage::Stage;

use crate::disk::{OnDisk, files_below, root};
use crate::load::{Builtins, registry_of, stage_with};

/// Mean and variance of every pixel of a short render, as bits.
fn bits(stage: &Stage) -> Vec<[u64; 6]> {
    let options = Options { spp: Some(4), ..Options::default() };
    let (film, outcome) = render(stage, &options, &Control::default());
    assert_eq!(outcome, Outcome::Complete, "{:?}", stage.failures());
    let pixel = |pixel: &Pixel| {
        let (m, v) = (pixel.mean, pixel.variance());
        [m.x, m.y, m.z, v.x, v.y, v.z].map(f64::to_bits)
    };
    film.pixels().map(|(_, p)| pixel(p)).collect()
}

#[test]
fn every_scene_has_the_same_bits_with_built_ins_linked_and_loaded() {
    let registries = [Builtins::Linked, Builtins::Loaded].map(registry_of);
    for path in files_below(&root().join("scenes"), "scene") {
        let [linked, loaded] = registries.each_ref().map(|registry| {
            let stage = stage_with(registry, &path, &OnDisk, UVec2::splat(24));
            bits(&stage.unwrap_or_else(|found| panic!("{}: {found:?}", path.display())))
        });
        assert!(linked.iter().any(|pixel| f64::from_bits(pixel[0]) > 0.0), "{}", path.display());
        assert!(linked == loaded, "{}", path.display());
    }
}

#[test]
fn a_loaded_class_has_the_schema_of_the_linked_one() {
    let [linked, loaded] = [Builtins::Linked, Builtins::Loaded].map(registry_of);
    let mut n = 0;
    for entry in linked.all().filter(|entry| entry.origin == "builtin") {
        let class = &entry.class;
        let other = loaded.class(class.kind, class.name).unwrap();
        assert_eq!((class.doc, class.params.len()), (other.doc, other.params.len()), "{class:?}");
        for (a, b) in class.params.iter().zip(other.params) {
            let (mut a, mut b) = (*a, *b);
            (a.offset, b.offset) = (0, 0);
            assert_eq!(format!("{a:?}"), format!("{b:?}"), "{class:?}");
        }
        n += 1;
    }
    assert!(n > 30, "only {n} classes were compared");
}
