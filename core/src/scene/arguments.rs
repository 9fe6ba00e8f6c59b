//! The parameters of a node, which many nodes may hold in one piece of memory.

use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

use super::Argument;

/// The parameters that a node was given: a run of a list that other nodes may have runs of too, so that a
/// large scene is copied, and given back, as few pieces of memory.
#[derive(Clone, Default)]
pub struct Arguments {
    all: Arc<Vec<Argument>>,
    range: Range<u32>,
}

impl Arguments {
    /// Runs of a list, which follow one another and have these lengths.
    pub(super) fn runs(all: Vec<Argument>, lengths: Vec<u32>) -> impl Iterator<Item = Self> {
        let mut end = 0;
        let range = move |length| {
            let start = end;
            end += length;
            start..end
        };
        Self::of_one(all, lengths.into_iter().map(range))
    }

    /// These runs of a list.
    pub(super) fn of_one(
        all: Vec<Argument>,
        ranges: impl IntoIterator<Item = Range<u32>>,
    ) -> impl Iterator<Item = Self> {
        let all = Arc::new(all);
        ranges.into_iter().map(move |range| Self { all: all.clone(), range })
    }

    /// Whether both are runs of one list.
    pub(super) fn is_beside(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.all, &other.all)
    }

    /// Takes runs of one list: the list, which is copied only if there are others, and where they are.
    pub(super) fn taken<'a>(
        runs: impl Iterator<Item = &'a mut Self>,
    ) -> (Vec<Argument>, Vec<Range<u32>>) {
        let (mut all, nothing) = (Arc::default(), Self::default());
        let mut ranges = vec![];
        for run in runs {
            let taken = std::mem::replace(run, nothing.clone());
            all = taken.all;
            ranges.push(taken.range);
        }
        (Arc::unwrap_or_clone(all), ranges)
    }

    /// A list of its own, to be changed.
    pub fn to_mut(&mut self) -> &mut Vec<Argument> {
        let is_whole = self.len() == self.all.len() && Arc::get_mut(&mut self.all).is_some();
        if !is_whole {
            self.all = Arc::new(self.to_vec());
        }
        // Its length may change under the hands of whoever has it.
        self.range = 0..u32::MAX;
        Arc::make_mut(&mut self.all)
    }
}

impl Deref for Arguments {
    type Target = [Argument];

    fn deref(&self) -> &[Argument] {
        let end = (self.range.end as usize).min(self.all.len());
        &self.all[self.range.start as usize..end]
    }
}

impl From<Vec<Argument>> for Arguments {
    fn from(all: Vec<Argument>) -> Self {
        Self { all: Arc::new(all), range: 0..u32::MAX }
    }
}

impl FromIterator<Argument> for Arguments {
    fn from_iter<I: IntoIterator<Item = Argument>>(all: I) -> Self {
        all.into_iter().collect::<Vec<_>>().into()
    }
}

impl<'a> IntoIterator for &'a Arguments {
    type Item = &'a Argument;
    type IntoIter = std::slice::Iter<'a, Argument>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl PartialEq for Arguments {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Arguments {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{SourceId, Span};
    use crate::scene::Value;

    fn argument(name: &'static str) -> Argument {
        Argument { name, value: Value::Bool(true), span: Span::new(SourceId(0), 0, 0) }
    }

    #[test]
    fn runs_of_one_list_change_each_for_itself() {
        let all: Vec<_> = ["a", "b", "c"].map(argument).into();
        let mut runs: Vec<_> = Arguments::runs(all, vec![2, 0, 1]).collect();
        runs[0].to_mut().push(argument("d"));
        runs[1].to_mut().push(argument("e"));
        runs[1].to_mut().insert(0, argument("f"));
        let names = |run: &Arguments| run.iter().map(|it| it.name).collect::<Vec<_>>();
        let all: Vec<_> = runs.iter().map(names).collect();
        assert_eq!(all, [vec!["a", "b", "d"], vec!["f", "e"], vec!["c"]]);
        assert_eq!(runs[2], Arguments::from(vec![argument("c")]));
        assert_ne!(runs[2], runs[1]);
        assert_eq!(Arguments::default().to_mut().len(), 0);
    }

    #[test]
    fn runs_are_taken_and_put_back_without_a_copy_unless_others_have_some() {
        let all: Vec<_> = ["a", "b", "c"].map(argument).into();
        let at = all.as_ptr();
        let mut runs: Vec<_> = Arguments::runs(all, vec![2, 0, 1]).collect();
        let same = runs.clone();
        assert!(runs[0].is_beside(&runs[2]) && !runs[0].is_beside(&Arguments::default()));
        let (all, ranges) = Arguments::taken(runs.iter_mut());
        assert!(all.as_ptr() != at && runs.iter().all(|run| run.is_empty()));
        let at = all.as_ptr();
        runs = Arguments::of_one(all, ranges).collect();
        assert_eq!(runs, same);
        assert_eq!(Arguments::taken(runs.iter_mut()).0.as_ptr(), at);
    }
}
