//! What a save changed, in words, and what had to be made anew for it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use luxel_core::scene::Scene;
use luxel_core::stage::Anew;
use serde_json::{Value, json};

use crate::files::{Seen, Watched};
use crate::progress::duration;

/// So many differences are told in words; the others are counted.
const MOST: usize = 4;

/// A save and its consequences.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Edit {
    /// What changed, as people call it; empty at the first load.
    changes: Vec<String>,
    anew: Anew,
    /// From the beginning of the load to a scene that is ready to trace.
    seconds: f64,
}

impl Edit {
    pub(super) fn new(changes: Vec<String>, anew: Anew, seconds: f64) -> Self {
        Self { changes, anew, seconds }
    }

    /// Both, of one picture.
    pub(super) fn then(self, next: Self) -> Self {
        let Self { mut changes, anew, seconds } = self;
        changes.extend(next.changes);
        Self { changes, anew: anew + next.anew, seconds: seconds + next.seconds }
    }

    /// `sphere "ball": radius · made anew: 1 object, 1 shape · 3.2 ms`; trees where there are some.
    pub(super) fn words(&self) -> String {
        let Self { changes, anew: Anew { objects, shapes, trees }, seconds } = self;
        let mut told: Vec<_> = changes.iter().take(MOST).cloned().collect();
        if changes.len() > MOST {
            told.push(format!("{} more", changes.len() - MOST));
        }
        let told = told.join("; ") + if told.is_empty() { "" } else { " · " };
        let mut parts = vec![count(*objects, "object"), count(*shapes, "shape")];
        parts.extend((*trees > 0).then(|| count(*trees, "tree")));
        let is_new = *objects > 0 || *shapes > 0;
        let made = format!("made anew: {}", parts.join(", "));
        let made = if is_new { made } else { "nothing made anew".to_owned() };
        format!("{told}{made} · {}", brief(*seconds))
    }

    /// The same for programs.
    pub(super) fn json(&self) -> Value {
        let Self { changes, anew, seconds } = self;
        json!({
            "changes": changes,
            "objects_made": anew.objects,
            "shapes_made": anew.shapes,
            "trees_made": anew.trees,
            "ready_seconds": seconds,
        })
    }
}

/// What differs between two loads: what the scenes say, and files that they read other than texts.
pub(super) fn changes(
    before: (&Scene, &Watched),
    now: (&Scene, &Watched),
    texts: &BTreeSet<PathBuf>,
) -> Vec<String> {
    let scenes = luxel_core::scene::diff(before.0, now.0);
    let is_other = |(path, seen): &(&PathBuf, &Seen)| {
        !texts.contains(*path) && before.1.get(*path).is_some_and(|it| it != *seen)
    };
    let name = |path: &PathBuf| path.file_name().unwrap_or(path.as_os_str()).display().to_string();
    let files = now.1.iter().filter(is_other).map(|(path, _)| name(path) + " has changed");
    scenes.iter().map(ToString::to_string).chain(files).collect()
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn brief(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", seconds * 1e3) } else { duration(seconds) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_is_told_in_a_line() {
        let told = |changes: &[&str], objects, shapes, seconds| {
            let changes = changes.iter().map(ToString::to_string).collect();
            Edit::new(changes, Anew { objects, shapes, trees: shapes / 2 }, seconds).words()
        };
        let ball = "sphere \"ball\": radius · made anew: 1 object, 1 shape · 3.2 ms";
        assert_eq!(told(&["sphere \"ball\": radius"], 1, 1, 0.0032), ball);
        let [one, two] = [told(&[], 1, 2, 0.001), told(&[], 0, 4, 0.001)];
        assert_eq!(one, "made anew: 1 object, 2 shapes, 1 tree · 1.0 ms");
        assert_eq!(two, "made anew: 0 objects, 4 shapes, 2 trees · 1.0 ms");
        assert_eq!(told(&[], 0, 0, 1.5), "nothing made anew · 1.50 s");
        let many = told(&["a", "b", "c", "d", "e", "f"], 2, 0, 0.1);
        assert_eq!(many, "a; b; c; d; 2 more · made anew: 2 objects, 0 shapes · 100.0 ms");
    }
}
