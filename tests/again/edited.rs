//! A file that is edited and loaded again, and at each step loaded from nothing too.

use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Sources};
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_lang::{Kept, Loaded, Settings, load};

use crate::load::registry;

pub(super) const CAMERA: &str = "camera perspective { fov = 40 deg, look = look_at(from = (0, 0, 9) m, \
                      to = (0, 0, 0) m, up = (0, 1, 0)) }";

pub(super) const OTHER: &str = "scene 1\nparam far: length = 2 m\nlet red = material diffuse { reflectance = rgb.linear_srgb(1, 0, 0) }\n\
                     shape sphere { radius = far, material = red }\n";

/// What the file begins with, and what makes it large at no cost.
pub(super) fn text_of(lines: &[String]) -> String {
    let head = "scene 1\nparam size: float = 0.4 in 0..=1\nunits { length = mm }\n";
    format!("{head}\n{}\n//{}\n", lines.join("\n"), " ".repeat(1 << 18))
}

pub(super) fn is_good(loaded: &Loaded) -> bool {
    !loaded.diagnostics.iter().any(Diagnostic::is_error)
}

/// What a load gives, in words that can be compared.
fn told(loaded: &Loaded) -> String {
    let texts: Vec<_> = Sources::texts(&loaded.sources).map(str::len).collect();
    let Loaded { scene, diagnostics, params, values, .. } = loaded;
    let values = values.all();
    format!("{scene:#?}\n{diagnostics:#?}\n{params:#?}\n{texts:?}\n{values:#?}")
}

/// A file that is edited, and another one that it reads.
pub(super) struct Edited {
    pub(super) registry: Registry,
    pub(super) kept: Kept,
    settings: Settings,
    pub(super) other: String,
    pub(super) n_short: usize,
    /// Short ones with a mistake.
    pub(super) n_told: usize,
}

impl Edited {
    pub(super) fn new(settings: Settings) -> Self {
        let (registry, kept, other) = (registry(), Kept::default(), OTHER.to_owned());
        Self { registry, kept, settings, other, n_short: 0, n_told: 0 }
    }

    /// How many statements are evaluated after an edit, and how many diagnostics there are.
    pub(super) fn counted(&mut self, lines: &[String]) -> (usize, usize) {
        let loaded = self.load(&text_of(lines), "an edit");
        (self.kept.n_evaluated().unwrap_or_default(), loaded.diagnostics.len())
    }

    pub(super) fn load(&mut self, text: &str, step: &str) -> Loaded {
        let files = || {
            let other: Arc<[u8]> = self.other.as_bytes().into();
            MemoryFiles::default().with("a.scene", text.as_bytes()).with("other.scene", other)
        };
        let path = Path::new("a.scene");
        let (short, whole) = (files(), files());
        let again = self.kept.load(path, &short, &self.registry, &self.settings);
        let mut fresh = load(path, &whole, &self.registry, &self.settings);
        if self.settings.without_scene && again.scene.is_none() && is_good(&fresh) {
            fresh.scene = None;
        }
        let shown = text.trim_end_matches(['/', ' ', '\n']);
        assert!(again.scene == fresh.scene, "{step}\n{shown}\n{}\n{}", told(&again), told(&fresh));
        assert_eq!(told(&again), told(&fresh), "{step}\n{shown}");
        let mut asked = [short.asked(), whole.asked()];
        for asked in &mut asked {
            asked.sort();
            asked.dedup();
        }
        // Where it cannot go on from the last one, it has asked for what that one had read.
        assert!(asked[1].iter().all(|path| asked[0].contains(path)), "{step}\n{shown}");
        let n_stmts = text.lines().count();
        let is_short = self.kept.n_evaluated().is_some_and(|n| n < n_stmts / 3);
        self.n_short += usize::from(is_short && is_good(&again));
        self.n_told += usize::from(is_short && !is_good(&again));
        again
    }
}
