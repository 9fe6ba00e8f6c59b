//! What a plugin's author is told by the compiler: each file of `refused` beside its messages.
//!
//! `TRYBUILD=overwrite cargo test -p luxel-sdk --test refused` writes the messages anew.

#[test]
fn what_a_parameter_cannot_be_is_told_by_the_compiler() {
    trybuild::TestCases::new().compile_fail("tests/refused/*.rs");
}
