//! Luxel.
fn main() {}
