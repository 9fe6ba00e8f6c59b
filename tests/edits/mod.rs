//! Whatever is edited, and however often: what is made of what was kept shows what is made anew.
//!
//! `LUXEL_SEEDS=1000 cargo test --release -p luxel-tests edits` takes the long form.

mod draft;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::{self, Anew, Built, Geometry, Stage};
use luxel_sdk::sampling::Rng;

use self::draft::{Draft, Edit, SCENE};
use crate::load::registry;

/// Edits in a sequence.
const EDITS: usize = 16;

/// What came of edits, so that none of the comparisons is about nothing.
#[derive(Debug, Default)]
struct Tally {
    by_edit: BTreeMap<Edit, u32>,
    faulty: u32,
    warned: u32,
    /// Stages with meshes for which no shape was made, and stages for which one was.
    kept: u32,
    made: u32,
}

#[test]
fn edits_show_what_a_new_beginning_shows_and_keep_the_trees_of_meshes() {
    #[expect(clippy::disallowed_methods, reason = "the long form is asked for from outside")]
    let seeds = std::env::var("LUXEL_SEEDS").map_or(8, |seeds| seeds.parse().unwrap());
    let (registry, mut tally) = (registry(), Tally::default());
    for seed in 0..seeds {
        sequence(seed, &registry, &mut tally);
    }
    println!("{seeds} sequences of {EDITS} edits: {tally:?}");
    assert_eq!(tally.by_edit.len(), 10, "{tally:?}");
    let Tally { faulty, warned, kept, made, .. } = tally;
    assert!([faulty, warned, kept, made].iter().all(|n| *n > 0), "{tally:?}");
}

/// Edits a scene; each time it is made ready twice: beside the last good stage, and alone.
fn sequence(seed: u64, registry: &Registry, tally: &mut Tally) {
    let mut rng = Rng::new(seed);
    let mut draft = Draft::new(&mut rng);
    let (mut past, mut before): (Vec<Draft>, Option<Stage>) = (vec![draft.clone()], None);
    // Edits since the last good stage.
    let mut edits = vec![];
    for n in 0..EDITS {
        let files = draft.files();
        let (warm, cold) = (made(registry, &files, before.as_ref()), made(registry, &files, None));
        let told = || format!("seed {seed}, edit {n}, {edits:?}, {draft:#?}");
        assert_eq!(warm.1, cold.1, "{}", told());
        assert_eq!(warm.0.is_some(), cold.0.is_some(), "{}", told());
        tally.warned += u32::from(cold.0.is_some() && !cold.1.is_empty());
        tally.faulty += u32::from(cold.0.is_none());
        if let (Some((warm, anew)), Some((cold, _))) = (warm.0, cold.0) {
            assert!(picture(&warm) == picture(&cold), "another picture: {}", told());
            if before.is_some() && edits.iter().copied().all(Edit::keeps_shapes) {
                assert_eq!(anew.shapes, 0, "trees were built: {}", told());
                let is_mesh = |shape: &Arc<Geometry>| matches!(**shape, Geometry::Mesh(_));
                tally.kept += u32::from(warm.geometries.iter().any(is_mesh));
            }
            tally.made += u32::from(before.is_some() && anew.shapes > 0);
            before = Some(warm);
            edits.clear();
        }
        let edit = draft.edit(&mut rng, &past);
        *tally.by_edit.entry(edit).or_default() += 1;
        edits.push(edit);
        past.push(draft.clone());
    }
}

fn made(
    registry: &Registry,
    files: &dyn Files,
    before: Option<&Stage>,
) -> (Option<(Stage, Anew)>, Vec<Diagnostic>) {
    let read =
        luxel_lang::load(Path::new(SCENE), files, registry, &luxel_lang::Settings::default());
    let mut told = read.diagnostics;
    let built = read.scene.map(|scene| stage::build(&scene, registry, files, before));
    match built {
        Some(Ok(Built { stage, warnings, anew })) => {
            told.extend(warnings);
            (Some((stage, anew)), told)
        }
        Some(Err(found)) => {
            told.extend(found);
            (None, told)
        }
        None => (None, told),
    }
}

/// Every number of the picture, as bits.
fn picture(stage: &Stage) -> Vec<[u64; 8]> {
    let options = Options { threads: std::num::NonZeroUsize::new(1), ..Options::default() };
    let (film, _) = render(stage, &options, &Control::default());
    let pixel = |pixel: &luxel_core::film::Pixel| {
        let (m, v) = (pixel.mean.to_array(), pixel.variance().to_array());
        let [a, b, c] = m.map(f64::to_bits);
        let [d, e, f] = v.map(f64::to_bits);
        [a, b, c, d, e, f, u64::from(pixel.n), u64::from(pixel.bad)]
    };
    film.pixels().map(|(_, it)| pixel(it)).collect()
}
