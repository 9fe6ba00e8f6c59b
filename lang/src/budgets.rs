//! What one load may cost, so that every input ends in bounded time and memory.

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
    /// Placements when shared groups are counted as often as they stand.
    pub instances: u64,
    /// Bytes of one string or word.
    pub string: usize,
    /// Names that one block defines.
    pub names: usize,
    /// Words, marks, texts and lines of doc comments of one statement, numbers left out.
    pub pieces: usize,
    /// Bytes that large lists, comprehensions and records hold, all that were made counted.
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
            instances: 100_000_000,
            string: 1 << 20,
            names: 500_000,
            pieces: 300_000,
            value_bytes: 96 << 20,
            nesting: 640,
            diagnostics: 100,
        }
    }
}
