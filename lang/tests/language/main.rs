//! The language against a registry of made-up classes: every case is a snippet with the mistakes
//! that are told of it, exact in code and place.

mod case;
mod cases;
mod fenced;
mod limits;
mod plant;
mod readers;
mod registry;
mod scenes;
mod seeded;
