//! The language against a registry of made-up classes: every case is a snippet with the mistakes
//! that are told of it, exact in code and place.

mod case;
mod cases;
mod damage;
mod fenced;
mod limits;
mod plant;
mod readers;
mod registry;
mod scenes;
mod seeded;
#[path = "../../../tests/fuzz/src/targets/told.rs"]
mod told;
