//! What one load may cost, so that every input ends in bounded time and memory.

use luxel_core::diag::near;
use luxel_core::scene::MOST_INSTANCES;

/// Limits of one load. Every field may be changed; the defaults suit an ordinary machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budgets {
    /// Bytes of one scene file.
    pub file_bytes: usize,
    /// Bytes of all scene files together.
    pub total_bytes: usize,
    /// How deep files may include one another.
    pub include_depth: usize,
    /// How often files may be included or imported, one file counted each time.
    pub includes: usize,
    /// How deep brackets may nest; far above the default the stack may not suffice.
    pub brackets: usize,
    /// Operators in one expression.
    pub operators: usize,
    /// Steps of evaluation: an expression, statement or list element costs one.
    pub steps: u64,
    /// Elements of one list.
    pub list: usize,
    /// Nodes and placements of the scene.
    pub nodes: usize,
    /// Placements when shared groups are counted as often as they stand; each takes half a kilobyte.
    pub instances: u64,
    /// Bytes of one string or word.
    pub string: usize,
    /// Names that one block defines.
    pub names: usize,
    /// Statements of one file, those in blocks left out.
    pub statements: usize,
    /// Words, marks, texts and lines of doc comments of one statement, numbers left out.
    pub pieces: usize,
    /// Bytes that large lists, comprehensions and records hold, all that were made counted, and the objects
    /// that can still be named.
    pub value_bytes: usize,
    /// How deep evaluation may nest: blocks, calls and brackets together.
    pub nesting: usize,
    /// Diagnostics that are kept.
    pub diagnostics: usize,
}

impl Default for Budgets {
    fn default() -> Self {
        Self {
            file_bytes: 64 << 20,
            total_bytes: 128 << 20,
            include_depth: 32,
            includes: 10_000,
            brackets: 128,
            operators: 4096,
            steps: 30_000_000,
            list: 10_000_000,
            nodes: 1_000_000,
            instances: MOST_INSTANCES as u64,
            string: 1 << 20,
            names: 500_000,
            statements: 2_000_000,
            pieces: 300_000,
            value_bytes: 96 << 20,
            nesting: 640,
            diagnostics: 100,
        }
    }
}

/// Where a budget is kept, and how far it may be raised.
enum Place<'a> {
    Bytes(&'a mut usize),
    Steps(&'a mut u64),
    /// The stack has room for no more than the default.
    Stack(&'a mut usize),
}

impl Budgets {
    /// Their names, by which each may be changed.
    pub const NAMES: [&'static str; 17] = [
        "nodes",
        "instances",
        "steps",
        "value_bytes",
        "list",
        "names",
        "string",
        "statements",
        "pieces",
        "file_bytes",
        "total_bytes",
        "includes",
        "include_depth",
        "diagnostics",
        "brackets",
        "operators",
        "nesting",
    ];

    /// The same with one of them changed.
    ///
    /// # Errors
    /// A name that none has, with the known ones; no whole number from 1 to 10¹⁵; more than the default
    /// for what the stack bounds.
    pub fn with(mut self, name: &str, amount: f64) -> Result<Self, String> {
        let Some(place) = self.place(name) else {
            let near =
                near(name, Self::NAMES).map(|near| format!("; did you mean `{}`?", near.name));
            let known = Self::NAMES.join(", ");
            let near = near.unwrap_or_default();
            return Err(format!("there is no budget `{name}`{near}; known are {known}"));
        };
        if amount.fract().abs() > 0.0 || !(1.0..=1e15).contains(&amount) {
            return Err(format!("`{name}` is a whole number from 1 to 1e15, as in `{name}=3e6`"));
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 10^15")]
        let amount = amount as u64;
        let narrow = usize::try_from(amount).unwrap_or(usize::MAX);
        match place {
            Place::Steps(steps) => *steps = amount,
            Place::Stack(most) if narrow > *most => {
                return Err(format!("`{name}` is at most {most}: the stack has room for no more"));
            }
            Place::Bytes(most) | Place::Stack(most) => *most = narrow,
        }
        Ok(self)
    }

    fn place(&mut self, name: &str) -> Option<Place<'_>> {
        Some(match name {
            "file_bytes" => Place::Bytes(&mut self.file_bytes),
            "total_bytes" => Place::Bytes(&mut self.total_bytes),
            "include_depth" => Place::Stack(&mut self.include_depth),
            "includes" => Place::Bytes(&mut self.includes),
            "brackets" => Place::Stack(&mut self.brackets),
            "operators" => Place::Stack(&mut self.operators),
            "steps" => Place::Steps(&mut self.steps),
            "list" => Place::Bytes(&mut self.list),
            "nodes" => Place::Bytes(&mut self.nodes),
            "instances" => Place::Steps(&mut self.instances),
            "string" => Place::Bytes(&mut self.string),
            "names" => Place::Bytes(&mut self.names),
            "statements" => Place::Bytes(&mut self.statements),
            "pieces" => Place::Bytes(&mut self.pieces),
            "value_bytes" => Place::Bytes(&mut self.value_bytes),
            "nesting" => Place::Stack(&mut self.nesting),
            "diagnostics" => Place::Bytes(&mut self.diagnostics),
            _ => return None,
        })
    }

    /// What to do where a budget is spent: twice of it, to a digit.
    pub(crate) fn allows(mut self, name: &str) -> String {
        let amount = match self.place(name) {
            Some(Place::Bytes(amount)) => *amount as f64,
            Some(Place::Steps(amount)) => *amount as f64,
            Some(Place::Stack(_)) | None => {
                return format!("`{name}` is bounded by the stack, and no flag raises it");
            }
        };
        format!("`--budget {name}={:.0e}` allows more", 2.0 * amount)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_budget_is_changed_by_its_name_and_names_the_flag_that_raises_it() {
        for name in Budgets::NAMES {
            let changed = Budgets::default().with(name, 20.0).unwrap();
            assert!(changed != Budgets::default(), "{name}");
            let advice = Budgets::default().allows(name);
            let flag = advice.strip_prefix("`--budget ").and_then(|rest| rest.split('`').next());
            match flag.and_then(|flag| flag.split_once('=')) {
                Some((found, amount)) => {
                    let most = Budgets::default().with(found, amount.parse().unwrap()).unwrap();
                    assert!(found == name && most != Budgets::default(), "{advice}");
                }
                None => assert!(Budgets::default().with(name, 1e6).is_err(), "{advice}"),
            }
        }
    }

    #[test]
    fn other_names_and_amounts_are_refused_with_what_is_known() {
        let refused = |name, amount| Budgets::default().with(name, amount).unwrap_err();
        let told = refused("node", 1.0);
        assert!(told.contains("did you mean `nodes`?") && told.contains("value_bytes"), "{told}");
        for amount in [0.0, -1.0, 1.5, 1e16, f64::NAN, f64::INFINITY] {
            assert!(refused("nodes", amount).contains("`nodes=3e6`"), "{amount}");
        }
        assert!(refused("brackets", 129.0).contains("at most 128"));
    }
}
