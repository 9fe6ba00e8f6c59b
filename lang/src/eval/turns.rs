//! A large file: its statements are evaluated and forgotten while later ones are still to be read, so
//! that its whole tree never stands in memory.

use std::path::Path;

use luxel_core::diag::{SourceId, Span};
use luxel_sdk::params::leave;

use super::Evaluator;
use super::by_name::ByName;
use super::exec::{Body, Place};
use super::names::{Facts, Mentions, Odd, tell_odd};
use super::params::PARAM;
use super::resolve::{Around, follows_fn};
use crate::sink::Sink;
use crate::syntax::{self, Cut, Name, Stmt, StmtNode, Tree, Turns};

/// Bytes from which on a file is large, and that are read in one turn.
pub(super) const TURN: usize = 1 << 20;

/// Statements with something wrong about their names that are kept to be looked at; others are counted.
const KEPT: usize = 10_000;

/// Mistakes of names that are counted; with more of them a file is not read to its end.
const COUNTED: usize = 100_000;

impl Evaluator<'_> {
    /// What a large file declares for all of it: its units and parameters. `None` for a file that is
    /// read as a whole.
    pub(super) fn declared(
        &self,
        text: &str,
        source: SourceId,
        set: &[(String, String)],
    ) -> Option<Declared> {
        if text.len() < self.turn {
            return None;
        }
        let (from, _) = syntax::read_head(text, &self.budgets);
        let from = from?;
        let pieces = syntax::cut_whole(text, from, &self.budgets, &self.sink.over());
        let mut out = Tree::default();
        for piece in &pieces {
            let part = &text[piece.range.clone()];
            if !declares(part) {
                continue;
            }
            let stmts = syntax::read_at(text, piece, source, &self.budgets);
            // What cannot be read may have been meant to say units.
            let declares = |stmt: &Stmt| match &stmt.node {
                StmtNode::Units(_) | StmtNode::Param(_) => true,
                _ => syntax::says_units(part),
            };
            out.stmts.extend(stmts.into_iter().filter(declares));
            // Evaluation will end before the last of so many.
            if out.stmts.len() > self.budgets.value_bytes / PARAM {
                break;
            }
        }
        // What is set and not declared here may stand where nothing can be read.
        let is_known = |name: &str| super::include::params(&out).any(|known| *known.text == *name);
        let is_told = set.iter().all(|(name, _)| is_known(name));
        is_told.then_some(Declared { tree: out, from, pieces })
    }

    /// Evaluates the root file, some statements after others. What was told of its text and its names
    /// stands before what evaluation told, as if it had been read as a whole.
    pub(super) fn run_in_turns(
        &mut self,
        (text, source): (&str, SourceId),
        path: &Path,
        Declared { tree, from, pieces }: Declared,
        set: &[(String, String)],
    ) {
        let units = self.units(&tree.stmts);
        let overrides = self.settings(&tree, set);
        self.begin_record(from, pieces);
        let env = Self::file_env(path, units, overrides, true);
        let mut body = Body::new(Place::File);
        let budgets = self.budgets;
        let mut told = Sink::new(budgets.diagnostics).until(self.sink.stop());
        let mut names = Seen::default();
        let bytes = self.turn;
        let mut take = |stmts: Vec<Stmt>| {
            let made = self.stmts_recorded(&stmts, &env, &mut body);
            // What stands in the file itself is no object's.
            body.fields.clear();
            // Where a budget is spent, the rest is not read; nor where so much is wrong that nobody reads
            // all of it.
            let goes_on = self.spent.is_none() && names.n_more < COUNTED;
            self.stopped |= !goes_on;
            if goes_on {
                let mut made = made.into_iter();
                for stmt in stmts {
                    let facts = Facts::of(text, std::slice::from_ref(&stmt));
                    self.record_next(&stmt, &facts, made.next());
                    names.add(stmt, facts);
                }
            }
            goes_on
        };
        let mut turns = Turns { bytes, take: &mut take };
        syntax::parse_in_turns(text, source, &budgets, &mut told, &mut turns);
        let n_written = told.kept().len();
        if told.is_stopped() {
            leave(names);
        } else if self.spent.is_none() {
            names.tell(text, &mut told);
        }
        let n_read = told.kept().len();
        self.stopped |= told.is_full();
        told.absorb(std::mem::replace(&mut self.sink, Sink::new(0)));
        self.sink = told;
        self.end_record(n_written, n_read);
    }
}

/// Whether a statement may be about the whole file.
pub(super) fn declares(part: &str) -> bool {
    part.contains("units") || part.contains("param") || syntax::says_units(part)
}

/// What a large file declares for all of it, and where its statements are.
pub(super) struct Declared {
    /// Units and parameters.
    tree: Tree,
    /// Where statements may begin.
    from: usize,
    pieces: Vec<Cut>,
}

/// The names of the statements so far.
#[derive(Default)]
struct Seen {
    n_stmts: usize,
    /// The statement that defines each name first, and where.
    defines: ByName<(u32, Span)>,
    labels: ByName<(u32, Span)>,
    mentions: Mentions,
    /// Statements with something wrong about their names, with how many mistakes they make.
    odd: Vec<(usize, Stmt, Facts)>,
    /// Mistakes of those that are not kept.
    n_more: usize,
}

impl Seen {
    fn add(&mut self, stmt: Stmt, facts: Facts) {
        let n = u32::try_from(self.n_stmts).unwrap_or(u32::MAX);
        let unknown = facts.free.iter().filter(|(name, _)| !self.defines.contains_key(*name));
        let n_unknown: usize = unknown.map(|(_, times)| *times as usize).sum();
        let n_twice =
            first(&mut self.defines, &facts.defines, n) + first(&mut self.labels, &facts.labels, n);
        if !facts.sound || n_unknown + n_twice > 0 {
            if self.odd.len() < KEPT {
                self.mentions.extend(facts.mentions.iter().cloned());
                self.odd.push((self.n_stmts, stmt, facts));
            } else {
                self.n_more += (n_unknown + n_twice).max(1);
            }
        } else {
            self.mentions.extend(facts.mentions);
        }
        self.n_stmts += 1;
    }

    /// Tells what is wrong with names.
    fn tell(mut self, text: &str, sink: &mut Sink) {
        if self.odd.is_empty() {
            return;
        }
        let mut mentions = Some(std::mem::take(&mut self.mentions));
        let around = InOrder::of(&self, text);
        for (i, stmt, facts) in &self.odd {
            let stmts = std::slice::from_ref(stmt);
            let odd = Odd { i: *i, text, stmts, facts };
            let mut part = sink.rest();
            tell_odd(&odd, &around, &mut mentions, &mut part);
            sink.absorb(part);
        }
        sink.count(self.n_more);
    }
}

/// Puts in names that are not there; how many are.
fn first(seen: &mut ByName<(u32, Span)>, names: &[Name], stmt: u32) -> usize {
    let mut n_twice = 0;
    for name in names {
        let there = seen.entry(name.text.clone()).or_insert((stmt, name.span));
        n_twice += usize::from(there.1 != name.span);
    }
    n_twice
}

/// The names of all statements, those that they define in their order too.
struct InOrder<'s> {
    seen: &'s Seen,
    text: &'s str,
    /// The statement that defines each name first.
    defines: Vec<(u32, &'s str)>,
}

impl<'s> InOrder<'s> {
    fn of(seen: &'s Seen, text: &'s str) -> Self {
        let defines = seen.defines.iter().map(|(name, (stmt, _))| (*stmt, &**name));
        let mut defines: Vec<_> = defines.collect();
        defines.sort_unstable_by_key(|(stmt, _)| *stmt);
        Self { seen, text, defines }
    }
}

impl Around for InOrder<'_> {
    fn definer(&self, name: &str) -> Option<(usize, Span)> {
        self.seen.defines.get(name).map(|(stmt, span)| (*stmt as usize, *span))
    }

    fn labeller(&self, label: &str) -> Option<(usize, Span)> {
        self.seen.labels.get(label).map(|(stmt, span)| (*stmt as usize, *span))
    }

    fn before(&self, stmt: usize) -> Vec<&str> {
        let end = self.defines.partition_point(|(at, _)| (*at as usize) < stmt);
        self.defines[..end].iter().map(|(_, name)| *name).collect()
    }

    fn has_function_before(&self, stmt: usize, name: &str) -> bool {
        let definer = self.definer(name).filter(|(definer, _)| *definer < stmt);
        definer.is_some_and(|(_, at)| follows_fn(self.text, at))
    }
}

#[cfg(test)]
mod tests {
    use luxel_core::diag::Diagnostic;
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;

    use super::*;
    use crate::chance::next;
    use crate::{Budgets, Loaded, Settings, eval};

    /// Lines that depend on others, in all ways.
    const LINES: [&str; 21] = [
        "let a = 1",
        "let b = a + c",
        "let c = (a, b, a)",
        "param a: length = 1 m in 1 m..=3 m",
        "param p: int = 2",
        "units { length = mm, depth = 3 }",
        "fn b(y: length = c) = a(y)",
        "fn c() { group \"a\" { place b } }",
        "for b in 0..3 { let a = b assert a < 2, \"large\" }",
        "if a { let c = b } else { group \"b\" { } }",
        "group \"a\" { transform = move((0, 1, 2) m) }",
        "let g = group \"b\" { }",
        "place g { transform = move((p, a, 1)) }",
        "set a.material = c",
        "set b.c.d = 1",
        "@off let b = nope",
        "radius = = 1",
        "c = b",
        "se}t a.material = c",
        "let d = [for i in 0..p => i / 0]",
        "}",
    ];

    fn loaded(text: &str, turn: usize, settings: &Settings) -> Loaded {
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        eval::load_in_turns(Path::new("a.scene"), &files, &Registry::new(), settings, turn)
    }

    /// How many are not shown depends on where reading ended, once so many were found.
    fn shown(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        diagnostics.retain(|found| found.code != "E0508");
        diagnostics
    }

    #[test]
    fn what_is_read_in_turns_is_told_as_what_is_read_as_a_whole() {
        let mut told = 0;
        for seed in 0..150 {
            let mut state = seed;
            let lines: Vec<_> = (0..20).map(|_| LINES[next(&mut state, LINES.len())]).collect();
            let text = format!("scene 1\n{}\n", lines.join("\n"));
            let set = ["", "3", "3 +"][next(&mut state, 3)];
            let set = if set.is_empty() { vec![] } else { vec![("p".to_owned(), set.to_owned())] };
            let diagnostics = [3, 100][next(&mut state, 2)];
            let budgets = Budgets { diagnostics, ..Budgets::default() };
            let settings = Settings { set, budgets, ..Settings::default() };
            let whole = loaded(&text, usize::MAX, &settings);
            let turns = loaded(&text, 1 + next(&mut state, 80), &settings);
            told += whole.diagnostics.len();
            // Of what is refused early, it may know more.
            let is_cut = whole.diagnostics.len() >= diagnostics;
            assert!(is_cut || turns.params == whole.params, "seed {seed}\n{text}");
            assert_eq!(shown(turns.diagnostics), shown(whole.diagnostics), "seed {seed}\n{text}");
        }
        assert!(told > 500, "{told}");
    }
}
