//! The example plugins: each is opened, judged, and makes the picture of its own scene.

use glam::UVec2;
use luxel_conformance::{Options as Judging, run};
use luxel_core::render::{Control, Options, Outcome, render};

use super::{open, registered};
use crate::disk::{OnDisk, root};
use crate::load::stage_with;

/// Every example in Rust that has a scene of its own.
const EXAMPLES: [&str; 4] = ["gyroid", "noise", "pleats", "velvet"];

#[test]
fn every_example_keeps_what_its_kind_promises() {
    for name in EXAMPLES {
        let library = open(name);
        assert_eq!((library.name.as_str(), library.classes.len()), (name, 1));
        let registry = registered(&[&library]);
        // Fewer than a judge takes, so that the test stays short.
        let options = Judging { samples: 4096, sets: 3, ..Judging::default() };
        let report = run(&registry, |class| class.name == name, &options);
        assert!(report.rows.len() > 5 && report.is_clean(), "{name}: {report}");
    }
}

#[test]
fn every_example_makes_the_picture_of_its_scene() {
    for name in EXAMPLES {
        let library = open(name);
        let path = root().join(format!("plugins/examples/{name}/{name}.scene"));
        let stage = stage_with(&registered(&[&library]), &path, &OnDisk, UVec2::splat(24))
            .unwrap_or_else(|found| panic!("{name}: {found:?}"));
        let options = Options { spp: Some(4), ..Options::default() };
        let (film, outcome) = render(&stage, &options, &Control::default());
        assert_eq!((outcome, film.bad_samples()), (Outcome::Complete, 0), "{name}");
        assert!(film.mean().0.y > 0.0, "{name} is black");
    }
}
