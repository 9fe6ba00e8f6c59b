//! What a pixel shows, for those who ask.

use std::path::Path;

use glam::{DVec3, UVec2};
use luxel_core::files::MemoryFiles;
use luxel_core::stage::Skin;

use crate::load::stage_of;

#[test]
fn the_middle_of_a_pixel_tells_its_surface_and_passes_the_bounds_of_fog() {
    let text = "scene 1
        camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 60 deg }
        film rgb { resolution = (9, 9) }
        light constant { scale = 1 }
        let grey = material diffuse { reflectance = 0.5 }
        shape sphere \"fog\" { radius = 2 m, interior = medium homogeneous { sigma_t = 0.1 / (1 m) } }
        shape sphere \"ball\" { radius = 1 m, material = grey }";
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let stage = stage_of(Path::new("a.scene"), &files, &[], None).unwrap();
    let (first, placement) = stage.probe(UVec2::splat(4)).unwrap();
    // The ball is met at z = 1, four metres from the camera; each leg rounds a few times.
    assert!((first.t - 4.0).abs() < 64.0 * f64::EPSILON, "{}", first.t);
    assert!((first.surface.p - DVec3::Z).length() < 64.0 * f64::EPSILON);
    assert!((first.surface.ns - DVec3::Z).length() < 64.0 * f64::EPSILON);
    assert_eq!(stage.scene.node(placement.node).label.as_deref(), Some("ball"));
    let Skin::Material(material) = placement.skin else { panic!("{placement:?}") };
    let node = stage.material_nodes[material as usize];
    assert_eq!(stage.scene.node(node).class, "diffuse");
    assert!(stage.probe(UVec2::ZERO).is_none(), "the corner shows the sky through the fog");
}
