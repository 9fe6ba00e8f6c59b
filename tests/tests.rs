//! Whole-system tests.

#[cfg(test)]
mod again;
mod asked;
#[cfg(test)]
mod assets;
#[cfg(test)]
#[path = "../benches/src/attack_texts.rs"]
mod attack_texts;
#[cfg(test)]
mod bad_input;
#[cfg(test)]
mod builder;
#[cfg(test)]
#[path = "../lang/tests/language/case.rs"]
mod case;
#[cfg(test)]
mod cli;
#[cfg(test)]
mod coverage;
#[cfg(test)]
mod curvature;
#[cfg(test)]
mod curves;
mod determinism;
mod diff;
#[cfg(test)]
mod dynamic;
#[cfg(test)]
mod disk;
#[cfg(test)]
mod edits;
#[cfg(test)]
mod extremes;
#[cfg(test)]
mod features;
#[cfg(test)]
#[path = "../lang/tests/language/fenced.rs"]
mod fenced;
#[cfg(test)]
mod fuzz;
#[cfg(test)]
#[path = "../cli/src/generated.rs"]
mod generated;
#[cfg(test)]
mod goals;
#[cfg(test)]
mod house;
#[cfg(test)]
mod lamps;
#[cfg(test)]
mod layers;
#[cfg(test)]
mod load;
#[cfg(test)]
mod manual;
#[cfg(test)]
mod motion;
#[cfg(test)]
mod pages;
#[cfg(test)]
#[path = "../lang/tests/language/plant.rs"]
mod plant;
#[cfg(test)]
mod probe;
#[cfg(test)]
mod published;
#[cfg(test)]
mod scenes;
#[cfg(test)]
mod seeded;
#[cfg(test)]
mod side_by_side;
#[cfg(test)]
mod skies;
#[cfg(test)]
mod slips;
#[cfg(test)]
mod solids;
#[cfg(test)]
mod stage_cases;
#[cfg(test)]
mod truths;
#[cfg(test)]
mod tutorial;
