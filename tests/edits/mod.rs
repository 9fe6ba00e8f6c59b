//! Whatever is edited, and however often: what is made of what was kept shows what is made anew.
//!
//! `LUXEL_SEEDS=1000 cargo test --release -p luxel-tests edits` takes the long form.

mod draft;
mod kept;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, render};
use luxel_core::scene::{Argument, NodeId, Scene, Value};
use luxel_core::stage::{self, Anew, Built, Geometry, Stage};
use luxel_sdk::kind::Kind;
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
    /// Stages with meshes for which no tree was built, and stages for which a shape was made.
    kept: u32,
    made: u32,
    /// Stages that carry colour in another way than the one before, and whose meshes were kept.
    turned: u32,
    /// Stages for which a solid was made, but no tree.
    solids: u32,
    /// Stages whose world is that of the one before.
    taken: u32,
    /// Stages for which a picture was read again.
    pictures: u32,
}

#[test]
fn edits_show_what_a_new_beginning_shows_and_keep_the_trees_of_meshes() {
    #[expect(clippy::disallowed_methods, reason = "the long form is asked for from outside")]
    let seeds = std::env::var("LUXEL_SEEDS").map_or(24, |seeds| seeds.parse().unwrap());
    let (registry, mut tally) = (registry(), Tally::default());
    for seed in 0..seeds {
        sequence(seed, &registry, &mut tally);
    }
    println!("{seeds} sequences of {EDITS} edits: {tally:?}");
    assert_eq!(tally.by_edit.len(), 11, "{tally:?}");
    let Tally { by_edit: _, faulty, warned, kept, made, turned, solids, taken, pictures } = tally;
    let all = [faulty, warned, kept, made, turned, solids, taken, pictures];
    assert!(all.iter().all(|n| *n > 0), "{tally:?}");
}

/// Edits a scene; each time it is made ready twice: beside the last good stage, and alone.
fn sequence(seed: u64, registry: &Registry, tally: &mut Tally) {
    let mut rng = Rng::new(seed);
    let mut draft = Draft::new(&mut rng);
    let (mut past, mut before): (Vec<Draft>, Option<(Stage, Draft)>) = (vec![draft.clone()], None);
    // Edits since the last good stage.
    let mut edits = vec![];
    for n in 0..EDITS {
        let files = draft.files();
        let last = before.as_ref().map(|(stage, _)| stage);
        let (warm, cold) = (made(registry, &files, last), made(registry, &files, None));
        let told = || format!("seed {seed}, edit {n}, {edits:?}, {draft:#?}");
        assert_eq!(warm.1, cold.1, "{}", told());
        assert_eq!(warm.0.is_some(), cold.0.is_some(), "{}", told());
        tally.warned += u32::from(cold.0.is_some() && !cold.1.is_empty());
        tally.faulty += u32::from(cold.0.is_none());
        if let (Some((warm, anew)), Some((cold, _))) = (warm.0, cold.0) {
            assert!(picture(&warm) == picture(&cold), "another picture: {}", told());
            if let Some((last, then)) = &before {
                let changed: Vec<_> = draft.other_files(then).collect();
                tally.count(&edits, &changed, (last, &warm), anew).unwrap_or_else(|wrong| {
                    panic!("{wrong}, {anew:?}: {}", told());
                });
            }
            before = Some((warm, draft.clone()));
            edits.clear();
        }
        let edit = draft.edit(&mut rng, &past);
        *tally.by_edit.entry(edit).or_default() += 1;
        edits.push(edit);
        past.push(draft.clone());
    }
}

impl Tally {
    /// Holds what was made for edits against what they are about.
    ///
    /// # Errors
    /// What need not have been made.
    fn count(
        &mut self,
        edits: &[Edit],
        changed: &[&str],
        (before, now): (&Stage, &Stage),
        anew: Anew,
    ) -> Result<(), &'static str> {
        let all = |keeps: fn(Edit) -> bool| edits.iter().copied().all(keeps);
        let kept = all(Edit::keeps_trees) && now.geometries.iter().any(is_mesh);
        if all(Edit::keeps_shapes) && anew.shapes > 0 {
            return Err("shapes were made");
        }
        if all(Edit::keeps_trees) && anew.trees > 0 {
            return Err("trees were built");
        }
        let is_taken = Arc::ptr_eq(&before.placements, &now.placements);
        if all(Edit::keeps_world) && !is_taken {
            return Err("the world was made");
        }
        self.taken += u32::from(is_taken);
        if let ([Edit::Contents], [file]) = (edits, changed)
            && Path::new(file).extension().is_some_and(|it| it == "hdr")
        {
            let readers = readers(&now.scene, file);
            let shapes = readers.iter().filter(|kind| **kind == Kind::Shape).count();
            if anew.objects > readers.len() || anew.shapes > shapes || anew.trees > shapes {
                return Err("what does not read the picture was made");
            }
            self.pictures += u32::from(anew.objects > 0);
        }
        self.kept += u32::from(kept);
        self.turned += u32::from(kept && before.mode != now.mode);
        self.solids += u32::from(kept && edits.contains(&Edit::Part) && anew.shapes > 0);
        self.made += u32::from(anew.shapes > 0);
        Ok(())
    }
}

fn is_mesh(shape: &Arc<Geometry>) -> bool {
    matches!(**shape, Geometry::Mesh(_))
}

/// Kinds of what reads a file, itself or by what it is made of: each content once.
fn readers(scene: &Scene, file: &str) -> Vec<Kind> {
    let mut found = BTreeMap::new();
    let mut reads = vec![false; scene.nodes.len()];
    for (i, node) in scene.nodes.iter().enumerate() {
        // What a shape looks like and what fills it are objects of their own.
        let own = |argument: &&Argument| {
            node.kind != Kind::Shape || !["material", "interior"].contains(&argument.name)
        };
        reads[i] = node.params.iter().filter(own).any(|argument| match &argument.value {
            Value::Path(path) => path.as_os_str() == file,
            Value::Node(id) | Value::Moved(id, _) => reads[id.0 as usize],
            _ => false,
        });
        if reads[i] {
            found.insert(scene.own_hash(NodeId(u32::try_from(i).unwrap())), node.kind);
        }
    }
    found.into_values().collect()
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
