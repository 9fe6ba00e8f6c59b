//! Evaluation under budgets that a few lines spend: a budget only ever refuses.

use luxel_lang::Budgets;

use super::{load, told};

const LARGE: Budgets = Budgets {
    file_bytes: 1 << 16,
    total_bytes: 1 << 18,
    include_depth: 16,
    includes: 64,
    brackets: 128,
    operators: 512,
    steps: 200_000,
    list: 20_000,
    nodes: 5000,
    instances: 1_000_000,
    string: 1 << 14,
    names: 5000,
    statements: 5000,
    pieces: 20_000,
    value_bytes: 4 << 20,
    nesting: 400,
    diagnostics: 100,
};
const SMALL: Budgets = Budgets {
    file_bytes: 2000,
    total_bytes: 3000,
    include_depth: 2,
    includes: 4,
    brackets: 12,
    operators: 16,
    steps: 1000,
    list: 100,
    nodes: 16,
    instances: 100,
    string: 64,
    names: 12,
    statements: 40,
    pieces: 400,
    value_bytes: 4000,
    nesting: 24,
    ..LARGE
};

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let (large, small) = (load(bytes, LARGE), load(bytes, SMALL));
    told::holds(&large);
    told::holds(&small);
    match (&large.scene, &small.scene) {
        (Some(large), Some(small)) => assert!(large.hash() == small.hash(), "another scene"),
        (None, Some(_)) => panic!("only with more room it is refused: {:?}", large.diagnostics),
        (Some(_), None) => {
            let is_budget = |code: &str| code.starts_with("E05") || code == "E0011";
            let told = &small.diagnostics;
            assert!(told.iter().any(|told| is_budget(told.code)), "no budget: {told:?}");
        }
        (None, None) => {}
    }
    large.diagnostics.len() < 10
}
