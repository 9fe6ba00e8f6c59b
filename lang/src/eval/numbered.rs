//! Names as numbers, so that those of a hundred thousand statements are looked through at once.

use std::sync::Arc;

use super::by_name::ByName;
use super::names::Facts;

/// Nobody defines it.
const NONE: u32 = u32::MAX;

/// Names, each with its number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    numbers: ByName<u32>,
    names: Vec<Arc<str>>,
}

/// What a statement has to do with names, which are numbers here.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbered {
    /// Those of some statements.
    all: Arc<[u32]>,
    /// Where its own begin: first the names that it uses and how often, by turns, then those that it defines,
    /// then labels.
    start: u32,
    /// How many of them are of the first sort, of the first two, and of all three.
    ends: [u32; 3],
    /// Nothing is wrong with it whatever stands around it.
    pub(super) is_sound: bool,
    /// A function stands in it.
    pub(super) has_functions: bool,
    is_known: bool,
}

impl Known {
    /// The number of a name.
    pub(super) fn number(&mut self, name: &Arc<str>) -> u32 {
        if let Some(number) = self.numbers.get(name) {
            return *number;
        }
        let number = u32::try_from(self.names.len()).expect("fewer than 2^32 names are typed");
        self.names.push(name.clone());
        self.numbers.insert(name.clone(), number);
        number
    }

    /// The number of a name that has one.
    pub(super) fn of(&self, name: &str) -> Option<u32> {
        self.numbers.get(name).copied()
    }

    /// The name of a number.
    pub(super) fn name(&self, number: u32) -> &str {
        &self.names[number as usize]
    }

    /// How many names there are.
    pub(crate) fn len(&self) -> usize {
        self.names.len()
    }

    /// A statement's names.
    pub(crate) fn numbered(&mut self, facts: &Facts) -> Numbered {
        let mut all = vec![];
        for (name, times) in &facts.free {
            all.extend([self.number(name), *times]);
        }
        let first = all.len();
        all.extend(facts.defines.iter().map(|name| self.number(&name.text)));
        let second = all.len();
        all.extend(facts.labels.iter().map(|name| self.number(&name.text)));
        let ends = [first, second, all.len()].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        let (is_sound, has_functions) = (facts.sound, !facts.mentions.is_empty());
        Numbered { all: all.into(), start: 0, ends, is_sound, has_functions, is_known: true }
    }
}

impl PartialEq for Numbered {
    fn eq(&self, other: &Self) -> bool {
        let Self { all: _, start: _, ends, is_sound, has_functions, is_known } = self;
        self.numbers() == other.numbers()
            && *ends == other.ends
            && *is_sound == other.is_sound
            && *has_functions == other.has_functions
            && *is_known == other.is_known
    }
}

impl Numbered {
    /// Makes the numbers of some statements one piece of memory: where they are looked through in this order,
    /// the next are found soon.
    pub(super) fn move_together(each: Vec<&mut Self>) {
        let all: Vec<u32> = each.iter().flat_map(|numbered| numbered.numbers()).copied().collect();
        // Of more, places would not fit.
        if u32::try_from(all.len()).is_err() {
            return;
        }
        let (all, mut start) = (Arc::from(all), 0);
        for numbered in each {
            (numbered.all, numbered.start) = (Arc::clone(&all), start);
            start += numbered.ends[2];
        }
    }

    fn numbers(&self) -> &[u32] {
        let start = self.start as usize;
        &self.all[start..start + self.ends[2] as usize]
    }

    /// Whether its numbers are still to be found.
    pub(crate) fn is_unknown(&self) -> bool {
        !self.is_known
    }

    /// The names that others must define, and how often it uses each.
    pub(super) fn uses(&self) -> impl Iterator<Item = (u32, u32)> {
        self.numbers()[..self.ends[0] as usize].chunks_exact(2).map(|use_| (use_[0], use_[1]))
    }

    /// The names that it defines.
    pub(super) fn defines(&self) -> &[u32] {
        &self.numbers()[self.ends[0] as usize..self.ends[1] as usize]
    }

    /// The labels that it bears itself.
    pub(super) fn labels(&self) -> &[u32] {
        &self.numbers()[self.ends[1] as usize..]
    }
}

/// Which statement defines each name first, and which bears each label first, by the names' numbers.
#[derive(Debug, Default)]
pub(super) struct Tables {
    defines: Vec<u32>,
    labels: Vec<u32>,
}

/// The same by name.
pub(super) struct Firsts<'k> {
    known: &'k Known,
    tables: &'k Tables,
}

impl Tables {
    /// Looks through statements in order; gives also the numbers of those that something is wrong with.
    pub(super) fn of<'n>(
        known: &Known,
        all: impl Iterator<Item = &'n Numbered>,
    ) -> (Self, Vec<usize>) {
        let none = || vec![NONE; known.names.len()];
        let mut out = Self { defines: none(), labels: none() };
        let mut odd = vec![];
        for (i, numbered) in all.enumerate() {
            let place = u32::try_from(i).unwrap_or(NONE);
            let is_fine = numbered.uses().all(|(name, _)| out.defines[name as usize] != NONE);
            let mut is_fine = is_fine && numbered.is_sound;
            for name in numbered.defines() {
                is_fine &= first(&mut out.defines[*name as usize], place);
            }
            for label in numbered.labels() {
                is_fine &= first(&mut out.labels[*label as usize], place);
            }
            if !is_fine {
                odd.push(i);
            }
        }
        (out, odd)
    }
}

impl<'k> Firsts<'k> {
    /// Names, and what has been found of them.
    pub(super) fn new(known: &'k Known, tables: &'k Tables) -> Self {
        Self { known, tables }
    }

    /// The statement that first defines a name.
    pub(super) fn definer(&self, name: &str) -> Option<usize> {
        self.place(&self.tables.defines, name)
    }

    /// The same for a name by its number.
    pub(super) fn definer_of(&self, name: u32) -> Option<usize> {
        place_of(&self.tables.defines, name)
    }

    /// The statements that first define a name, in order.
    pub(super) fn definers(&self) -> Vec<usize> {
        let places = self.tables.defines.iter().filter(|place| **place != NONE);
        let mut places: Vec<usize> = places.map(|place| *place as usize).collect();
        places.sort_unstable();
        places.dedup();
        places
    }

    /// The statement that first bears a label.
    pub(super) fn labeller(&self, label: &str) -> Option<usize> {
        self.place(&self.tables.labels, label)
    }

    /// The same for a label by its number.
    pub(super) fn labeller_of(&self, label: u32) -> Option<usize> {
        place_of(&self.tables.labels, label)
    }

    fn place(&self, places: &[u32], name: &str) -> Option<usize> {
        place_of(places, self.known.of(name)?)
    }

    /// The names that are defined before a statement.
    pub(super) fn before(&self, statement: usize) -> Vec<&'k str> {
        let names = self.known.names.iter().zip(&self.tables.defines);
        names.filter(|(_, at)| (**at as usize) < statement).map(|(name, _)| &**name).collect()
    }

    /// How many mistakes a statement makes, if that can be told without looking at it: names that it
    /// uses and that nothing before it defines.
    pub(super) fn count(&self, statement: usize, numbered: &Numbered) -> Option<usize> {
        let is_before = |places: &[u32], name: u32| (places[name as usize] as usize) < statement;
        let is_new = |name: &u32| self.tables.defines[*name as usize] as usize == statement;
        let is_own = |label: &u32| self.tables.labels[*label as usize] as usize == statement;
        let simple = numbered.is_sound
            && numbered.defines().len() + numbered.labels().len() < 2
            && numbered.defines().iter().all(is_new)
            && numbered.labels().iter().all(is_own);
        let unknown = numbered.uses().filter(|(name, _)| !is_before(&self.tables.defines, *name));
        simple.then(|| unknown.map(|(_, times)| times as usize).sum())
    }
}

fn place_of(places: &[u32], name: u32) -> Option<usize> {
    // Names that became known later have no place.
    let place = *places.get(name as usize)?;
    (place != NONE).then_some(place as usize)
}

/// Puts a statement in as the first; whether it is.
fn first(place: &mut u32, statement: u32) -> bool {
    let is_first = *place == NONE;
    if is_first {
        *place = statement;
    }
    is_first
}
