//! Whole-system tests.

mod bad_input;
mod cli;
mod determinism;
mod disk;
mod house;
mod load;
mod manual;
mod scenes;
mod truths;
